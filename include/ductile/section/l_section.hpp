// SPDX-License-Identifier: MIT
//
// L section (angle) without fillets: legs of thickness t, b along x at the bottom and h along y at the
// left, both lengths overall. x and y are parallel to the legs, not principal axes: see principal.hpp.
// Its plastic and elastic moduli are those of a neutral axis held parallel to x or y, which needs a
// moment about the other axis as well; Polygon::plastic_bending on outline() tells how much.
//
//   I_xy = -A_1 A_2/(A_1 + A_2) (b - t) h/4,  A_1 = b t, A_2 = (h - t) t
//   A_v,y = h t,  A_v,x = b t,  A_s = 5/6 A_v
//   J = (b + h - t) t³/3
//
// W_T is the sand heap over the outline (sand_heap.hpp), ridges at the corners included.
//
// Source: J Canadian Institute of Steel Construction (2002), Torsional Section Properties of Steel
// Shapes, case 3; shear areas AISC 360-16, G3. Bending: strips.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>

#include "ductile/section/point.hpp"
#include "ductile/section/section.hpp"
#include "ductile/section/strips.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct LSectionParameters {
    S width = std::numeric_limits<S>::quiet_NaN(); ///< b, leg along x [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h, leg along y [m], > 0
    S thickness = std::numeric_limits<S>::quiet_NaN(); ///< t [m], in (0, min(b, h))
};

template <std::floating_point S>
struct LSectionShape {
    using Scalar = S;
    using Parameters = LSectionParameters<S>;

    static void require(const Parameters& p) {
        check::positive("LSection.width", p.width, "m");
        check::positive("LSection.height", p.height, "m");
        check::between("LSection.thickness", p.thickness, S(0), std::min(p.width, p.height), "m");
    }
    static Strips<S> about_x(const Parameters& p) noexcept {
        return {{p.width, p.thickness}, {p.thickness, p.height - p.thickness}};
    }
    static Strips<S> about_y(const Parameters& p) noexcept {
        return {{p.height, p.thickness}, {p.thickness, p.width - p.thickness}};
    }
    static StripConstants<S> constants(const Parameters& p) noexcept {
        const S b = p.width;
        const S h = p.height;
        const S t = p.thickness;
        const S lower = b * t;
        const S upper = (h - t) * t;
        return {.product_of_inertia = -lower * upper / (lower + upper) * (b - t) * h / 4,
                .shear_area_x = b * t,
                .shear_area_y = h * t,
                .elastic_shear_area_x = 5 * b * t / 6,
                .elastic_shear_area_y = 5 * h * t / 6,
                .torsion_constant = (b + h - t) * t * t * t / 3};
    }

    /// From the lower left corner of the bounding box.
    static std::array<Point<S>, 6> corners(const Parameters& p) noexcept {
        const S t = p.thickness;
        return {{{0, 0}, {p.width, 0}, {p.width, t}, {t, t}, {t, p.height}, {0, p.height}}};
    }
};

/// Immutable value; all members are noexcept after construction: see StripSection, ShapedSection.
template <std::floating_point S>
class LSection : public ShapedSection<LSectionShape<S>> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit LSection(const LSectionParameters<S>& parameters)
        : ShapedSection<LSectionShape<S>>(parameters) {}
};

template <std::floating_point S>
LSection(const LSectionParameters<S>&) -> LSection<S>;

static_assert(FullSection<LSection<double>> && FullSection<LSection<float>>);

} // namespace ductile
