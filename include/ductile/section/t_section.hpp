// SPDX-License-Identifier: MIT
//
// T section without fillets: a flange b × t_f along x on top, a stem t_w along y below it, h overall.
//
//   A_v,y = h t_w,  A_v,x = b t_f,  A_s = 5/6 A_v
//   J = (b t_f³ + (h - t_f/2) t_w³)/3
//
// W_T is the sand heap over the outline (sand_heap.hpp), ridges at the corners included.
//
// Source: J Canadian Institute of Steel Construction (2002), Torsional Section Properties of Steel
// Shapes, case 4; shear areas AISC 360-16, G3 and G6. Bending: strips.hpp.
#pragma once

#include <array>
#include <concepts>
#include <limits>

#include "ductile/section/point.hpp"
#include "ductile/section/section.hpp"
#include "ductile/section/strips.hpp"

namespace ductile {

template <std::floating_point S>
struct TSectionParameters {
    S width = std::numeric_limits<S>::quiet_NaN(); ///< b [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h [m], > 0
    S web_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_w [m], in (0, b)
    S flange_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_f [m], in (0, h)
};

template <std::floating_point S>
struct TSectionShape {
    using Scalar = S;
    using Parameters = TSectionParameters<S>;

    static void require(const Parameters& p) {
        check_walls("TSection", p, p.width, p.height);
    }
    static Strips<S> about_x(const Parameters& p) noexcept {
        return {{p.web_thickness, p.height - p.flange_thickness}, {p.width, p.flange_thickness}};
    }
    static Strips<S> about_y(const Parameters& p) noexcept {
        return {{p.flange_thickness, (p.width - p.web_thickness) / 2},
                {p.height, p.web_thickness},
                {p.flange_thickness, (p.width - p.web_thickness) / 2}};
    }
    static StripConstants<S> constants(const Parameters& p) noexcept {
        const S b = p.width;
        const S tw = p.web_thickness;
        const S tf = p.flange_thickness;
        return {.product_of_inertia = 0,
                .shear_area_x = b * tf,
                .shear_area_y = p.height * tw,
                .elastic_shear_area_x = 5 * b * tf / 6,
                .elastic_shear_area_y = 5 * p.height * tw / 6,
                .torsion_constant = (b * tf * tf * tf + (p.height - tf / 2) * tw * tw * tw) / 3};
    }

    /// From the lower left corner of the bounding box.
    static std::array<Point<S>, 8> corners(const Parameters& p) noexcept {
        const S b = p.width;
        const S h = p.height;
        const S under = h - p.flange_thickness;
        const S left = (b - p.web_thickness) / 2;
        const S right = (b + p.web_thickness) / 2;
        return {{{left, 0}, {right, 0}, {right, under}, {b, under},
                 {b, h}, {0, h}, {0, under}, {left, under}}};
    }
};

/// Immutable value; all members are noexcept after construction: see StripSection, ShapedSection.
template <std::floating_point S>
class TSection : public ShapedSection<TSectionShape<S>> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit TSection(const TSectionParameters<S>& parameters)
        : ShapedSection<TSectionShape<S>>(parameters) {}
};

template <std::floating_point S>
TSection(const TSectionParameters<S>&) -> TSection<S>;

static_assert(FullSection<TSection<double>> && FullSection<TSection<float>>);

} // namespace ductile
