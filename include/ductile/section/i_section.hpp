// SPDX-License-Identifier: MIT
//
// I section, doubly symmetric, without fillets: flanges b × t_f along x at top and bottom, a web t_w
// along y between them, h overall.
//
//   A_v,y = A_s,y = h t_w,  A_v,x = 2 b t_f,  A_s,x = 5/6 A_v,x
//   J = (2 b t_f³ + (h - t_f) t_w³)/3
//
// W_T is the sand heap over the outline (sand_heap.hpp), ridges at the corners included.
//
// Source: J Canadian Institute of Steel Construction (2002), Torsional Section Properties of Steel
// Shapes, case 1; shear areas AISC 360-16, G2 and G6. Bending: strips.hpp.
#pragma once

#include <array>
#include <concepts>
#include <limits>

#include "ductile/section/point.hpp"
#include "ductile/section/section.hpp"
#include "ductile/section/strips.hpp"

namespace ductile {

template <std::floating_point S>
struct ISectionParameters {
    S width = std::numeric_limits<S>::quiet_NaN(); ///< b [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h [m], > 0
    S web_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_w [m], in (0, b)
    S flange_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_f [m], in (0, h/2)
};

template <std::floating_point S>
struct ISectionShape {
    using Scalar = S;
    using Parameters = ISectionParameters<S>;

    static void require(const Parameters& p) {
        check_walls("ISection", p, p.width, p.height / 2);
    }
    static Strips<S> about_x(const Parameters& p) noexcept {
        return {{p.width, p.flange_thickness},
                {p.web_thickness, p.height - 2 * p.flange_thickness},
                {p.width, p.flange_thickness}};
    }
    static Strips<S> about_y(const Parameters& p) noexcept {
        return {{2 * p.flange_thickness, (p.width - p.web_thickness) / 2},
                {p.height, p.web_thickness},
                {2 * p.flange_thickness, (p.width - p.web_thickness) / 2}};
    }
    static StripConstants<S> constants(const Parameters& p) noexcept {
        const S b = p.width;
        const S tw = p.web_thickness;
        const S tf = p.flange_thickness;
        return {.product_of_inertia = 0,
                .shear_area_x = 2 * b * tf,
                .shear_area_y = p.height * tw,
                .elastic_shear_area_x = 5 * b * tf / 3,
                .elastic_shear_area_y = p.height * tw,
                .torsion_constant = (2 * b * tf * tf * tf + (p.height - tf) * tw * tw * tw) / 3};
    }

    /// From the lower left corner of the bounding box.
    static std::array<Point<S>, 12> corners(const Parameters& p) noexcept {
        const S b = p.width;
        const S h = p.height;
        const S tf = p.flange_thickness;
        const S left = (b - p.web_thickness) / 2;
        const S right = (b + p.web_thickness) / 2;
        return {{{0, 0}, {b, 0}, {b, tf}, {right, tf}, {right, h - tf}, {b, h - tf},
                 {b, h}, {0, h}, {0, h - tf}, {left, h - tf}, {left, tf}, {0, tf}}};
    }
};

/// Immutable value; all members are noexcept after construction: see StripSection, ShapedSection.
template <std::floating_point S>
class ISection : public ShapedSection<ISectionShape<S>> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit ISection(const ISectionParameters<S>& parameters)
        : ShapedSection<ISectionShape<S>>(parameters) {}
};

template <std::floating_point S>
ISection(const ISectionParameters<S>&) -> ISection<S>;

static_assert(FullSection<ISection<double>> && FullSection<ISection<float>>);

} // namespace ductile
