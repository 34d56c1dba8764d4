// SPDX-License-Identifier: MIT
//
// The portal of reference problem P31: four bars, five hinges, pushed by 40 kN at the eave and
// 60 kN down at mid-beam, times a factor. Included after a structure rig.
#pragma once

#include "ductile/section/rectangle.hpp"
#include "ductile/structure/structure_model.hpp"

namespace ductile::test {

/// Of a rectangle so thin that its shear and axial strength do not count, of M_p = 100 kN m; hinges
/// a hundred times stiffer than the problem's, so that rotations are small.
struct Portal {
    StructureModel model;
    NodeId b, c; ///< the eave, mid-beam

    explicit Portal(bool elastic) : model({.elastic = elastic}) {
        constexpr double k = 5e8, thin = 0.01;
        const Rectangle<double> strip({.width = 1, .height = thin});
        const Material<double> strong({.density = 200 / thin,
                                       .youngs_modulus = k / strip.second_moment(),
                                       .poisson_ratio = 0.3,
                                       .yield_stress = 100e3 / strip.plastic_modulus()});
        const NodeId a = model.node({0, 0, 0}), d = model.node({8, 0, 4}),
                     e = model.node({8, 0, 0});
        b = model.node({0, 0, 4});
        c = model.node({4, 0, 4});
        const MemberOptions as_told{
            .joint_length = 1.0, .up = Vector3<double>(1, 0, 1), .collides = false};
        model.member("AB", a, b, strip, strong, as_told);
        model.member("ED", e, d, strip, strong, as_told);
        model.member("BC", b, c, strip, strong, as_told);
        model.member("CD", c, d, strip, strong, as_told);
        model.support(a);
        model.support(e);
    }
    /// Steps of `dt` [s].
    template <class Rig, class Structure>
    void push(Rig& rig, Structure& portal, double factor, int steps, double dt) const {
        for (int i = 0; i < steps; ++i) {
            portal.apply(b, {40e3 * factor, 0, 0});
            portal.apply(c, {0, 0, -60e3 * factor});
            rig.step(dt);
        }
    }
};

} // namespace ductile::test
