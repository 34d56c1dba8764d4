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
#include <span>

#include "ductile/section/point.hpp"
#include "ductile/section/sand_heap.hpp"
#include "ductile/section/section.hpp"
#include "ductile/section/strips.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct ISectionParameters {
    S width = std::numeric_limits<S>::quiet_NaN(); ///< b [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h [m], > 0
    S web_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_w [m], in (0, b)
    S flange_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_f [m], in (0, h/2)
};

/// Immutable value; all members are noexcept after construction. Bending, shear, torsion and width:
/// see StripSection.
template <std::floating_point S>
class ISection : public StripSection<S> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit ISection(const ISectionParameters<S>& parameters)
        : ISection(checked(parameters), detail::Checked{}) {}

    [[nodiscard]] const ISectionParameters<S>& parameters() const noexcept { return parameters_; }

    /// Corners, counterclockwise, the centroid at the origin [m].
    [[nodiscard]] std::array<Point<S>, 12> outline() const noexcept {
        return this->placed(corners(parameters_));
    }

  private:
    using Parameters = ISectionParameters<S>;

    ISection(const Parameters& p, detail::Checked) noexcept
        : StripSection<S>(
              {{p.width, p.flange_thickness},
               {p.web_thickness, p.height - 2 * p.flange_thickness},
               {p.width, p.flange_thickness}},
              {{2 * p.flange_thickness, (p.width - p.web_thickness) / 2},
               {p.height, p.web_thickness},
               {2 * p.flange_thickness, (p.width - p.web_thickness) / 2}},
              constants(p)),
          parameters_(p) {}

    static const Parameters& checked(const Parameters& p) {
        check::positive("ISection.width", p.width, "m");
        check::positive("ISection.height", p.height, "m");
        check::between("ISection.web_thickness", p.web_thickness, S(0), p.width, "m");
        check::between("ISection.flange_thickness", p.flange_thickness, S(0), p.height / 2, "m");
        return p;
    }

    static StripConstants<S> constants(const Parameters& p) noexcept {
        const auto outline = corners(p);
        const S heap = sand_heap_volume(std::span<const Point<S>>(outline));
        const S b = p.width;
        const S tw = p.web_thickness;
        const S tf = p.flange_thickness;
        return {.product_of_inertia = 0,
                .shear_area_x = 2 * b * tf,
                .shear_area_y = p.height * tw,
                .elastic_shear_area_x = 5 * b * tf / 3,
                .elastic_shear_area_y = p.height * tw,
                .torsion_constant = (2 * b * tf * tf * tf + (p.height - tf) * tw * tw * tw) / 3,
                .plastic_torsion_modulus = 2 * heap};
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

    Parameters parameters_;
};

template <std::floating_point S>
ISection(const ISectionParameters<S>&) -> ISection<S>;

static_assert(FullSection<ISection<double>> && FullSection<ISection<float>>);

} // namespace ductile
