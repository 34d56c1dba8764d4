// SPDX-License-Identifier: MIT
//
// Rectangular hollow section with sharp corners: walls t_f along x at top and bottom, t_w along y at
// both sides, b × h overall.
//
//   A_v,y = A_s,y = 2 h t_w,  A_v,x = A_s,x = 2 b t_f
//   J = 2 (b_m h_m)²/(b_m/t_f + h_m/t_w) + 2/3 (b_m t_f³ + h_m t_w³),  b_m = b - t_w, h_m = h - t_f
//
// Sand heap of a section with a hole: the stress function is constant over the hole, at the highest
// level a slope of 1 can reach there, t = min(t_w, t_f). Walls of that thickness slope up to it;
// over thicker walls the heap rises on to a ridge and falls back to it. Derived at `heap`.
//
// Source: J Bredt (1896) with the walls' own part, EN 10210-2:2019, annex A; sand heap Nadai (1950),
// Theory of Flow and Fracture of Solids, ch. 35; shear areas AISC 360-16, G4, corners included.
// Bending: strips.hpp. Limit case t_w = t_f: W_T is that of the outer rectangle less the inner one.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>

#include "ductile/section/section.hpp"
#include "ductile/section/strips.hpp"

namespace ductile {

template <std::floating_point S>
struct BoxParameters {
    S width = std::numeric_limits<S>::quiet_NaN(); ///< b [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h [m], > 0
    S web_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_w [m], in (0, b/2)
    S flange_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_f [m], in (0, h/2)
};

template <std::floating_point S>
struct BoxShape {
    using Scalar = S;
    using Parameters = BoxParameters<S>;

    static void require(const Parameters& p) {
        check_walls("Box", p, p.width / 2, p.height / 2);
    }
    static Strips<S> about_x(const Parameters& p) noexcept {
        return {{p.width, p.flange_thickness},
                {2 * p.web_thickness, p.height - 2 * p.flange_thickness},
                {p.width, p.flange_thickness}};
    }
    static Strips<S> about_y(const Parameters& p) noexcept {
        return {{p.height, p.web_thickness},
                {2 * p.flange_thickness, p.width - 2 * p.web_thickness},
                {p.height, p.web_thickness}};
    }
    static StripConstants<S> constants(const Parameters& p) noexcept {
        const S tw = p.web_thickness;
        const S tf = p.flange_thickness;
        const S bm = p.width - tw;
        const S hm = p.height - tf;
        const S cell = 2 * bm * hm * bm * hm / (bm / tf + hm / tw);
        const S walls = 2 * (bm * tf * tf * tf + hm * tw * tw * tw) / 3;
        return {.product_of_inertia = 0,
                .shear_area_x = 2 * p.width * tf,
                .shear_area_y = 2 * p.height * tw,
                .elastic_shear_area_x = 2 * p.width * tf,
                .elastic_shear_area_y = 2 * p.height * tw,
                .torsion_constant = cell + walls,
                .plastic_torsion_modulus = 2 * heap(p)};
    }

    /// With t the thinner and T the thicker wall, l the clear length of the thick walls and k that of
    /// the thin ones, the heap consists of
    ///   the hole            l k t
    ///   two thin walls      k t²/2 each
    ///   four corners        min(x, y) over t × T: t² T/2 - t³/6 each
    ///   two thick walls     across, min(y, t + T - y): m² - t²/2 with ridge m = (t + T)/2. At distance
    ///                       s < m from the outer face of a thin wall, s itself cuts (m - s)² off, so
    ///                       each end lacks ∫ (m - s)² ds from s = t to m, or to mid-length if nearer.
    static S heap(const Parameters& p) noexcept {
        const bool webs_are_thin = p.web_thickness <= p.flange_thickness;
        const S t = std::min(p.web_thickness, p.flange_thickness);
        const S thick = std::max(p.web_thickness, p.flange_thickness);
        const S clear_width = p.width - 2 * p.web_thickness;
        const S clear_height = p.height - 2 * p.flange_thickness;
        const S l = webs_are_thin ? clear_width : clear_height;
        const S k = webs_are_thin ? clear_height : clear_width;
        const S m = (t + thick) / 2;
        const S reach = m - t;
        const S short_of = std::max(reach - l / 2, S(0));
        const S lack = (reach * reach * reach - short_of * short_of * short_of) / 3;
        return l * k * t + k * t * t + 4 * (t * t * thick / 2 - t * t * t / 6) +
               2 * (l * (m * m - t * t / 2) - 2 * lack);
    }
};

/// Immutable value; all members are noexcept after construction: see StripSection, ShapedSection.
template <std::floating_point S>
class Box : public ShapedSection<BoxShape<S>> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit Box(const BoxParameters<S>& parameters)
        : ShapedSection<BoxShape<S>>(parameters) {}
};

template <std::floating_point S>
Box(const BoxParameters<S>&) -> Box<S>;

static_assert(FullSection<Box<double>> && FullSection<Box<float>>);

} // namespace ductile
