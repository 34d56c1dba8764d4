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
#include <span>

#include "ductile/section/point.hpp"
#include "ductile/section/sand_heap.hpp"
#include "ductile/section/section.hpp"
#include "ductile/section/strips.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct TSectionParameters {
    S width = std::numeric_limits<S>::quiet_NaN(); ///< b [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h [m], > 0
    S web_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_w [m], in (0, b)
    S flange_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_f [m], in (0, h)
};

/// Immutable value; all members are noexcept after construction. Bending, shear, torsion and width:
/// see StripSection.
template <std::floating_point S>
class TSection : public StripSection<S> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit TSection(const TSectionParameters<S>& parameters)
        : TSection(checked(parameters), detail::Checked{}) {}

    [[nodiscard]] const TSectionParameters<S>& parameters() const noexcept { return parameters_; }

    /// Corners, counterclockwise, the centroid at the origin [m].
    [[nodiscard]] std::array<Point<S>, 8> outline() const noexcept {
        return this->placed(corners(parameters_));
    }

  private:
    using Parameters = TSectionParameters<S>;

    TSection(const Parameters& p, detail::Checked) noexcept
        : StripSection<S>(
              {{p.web_thickness, p.height - p.flange_thickness}, {p.width, p.flange_thickness}},
              {{p.flange_thickness, (p.width - p.web_thickness) / 2},
               {p.height, p.web_thickness},
               {p.flange_thickness, (p.width - p.web_thickness) / 2}},
              constants(p)),
          parameters_(p) {}

    static const Parameters& checked(const Parameters& p) {
        check::positive("TSection.width", p.width, "m");
        check::positive("TSection.height", p.height, "m");
        check::between("TSection.web_thickness", p.web_thickness, S(0), p.width, "m");
        check::between("TSection.flange_thickness", p.flange_thickness, S(0), p.height, "m");
        return p;
    }

    static StripConstants<S> constants(const Parameters& p) noexcept {
        const auto outline = corners(p);
        const S heap = sand_heap_volume(std::span<const Point<S>>(outline));
        const S b = p.width;
        const S tw = p.web_thickness;
        const S tf = p.flange_thickness;
        return {.product_of_inertia = 0,
                .shear_area_x = b * tf,
                .shear_area_y = p.height * tw,
                .elastic_shear_area_x = 5 * b * tf / 6,
                .elastic_shear_area_y = 5 * p.height * tw / 6,
                .torsion_constant = (b * tf * tf * tf + (p.height - tf / 2) * tw * tw * tw) / 3,
                .plastic_torsion_modulus = 2 * heap};
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

    Parameters parameters_;
};

template <std::floating_point S>
TSection(const TSectionParameters<S>&) -> TSection<S>;

static_assert(FullSection<TSection<double>> && FullSection<TSection<float>>);

} // namespace ductile
