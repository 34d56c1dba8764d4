// SPDX-License-Identifier: MIT
//
// Channel (U section) without fillets: a web t_w along y at the left, flanges t_f along x at top and
// bottom, b × h overall. x is the axis of symmetry. The shear centre lies outside, left of the web: a
// shear force along y through the centroid also twists the member, which these properties leave out.
//
//   A_v,y = A_s,y = h t_w,  A_v,x = 2 b t_f,  A_s,x = 5/6 A_v,x
//   J = (2 (b - t_w/2) t_f³ + (h - t_f) t_w³)/3
//
// W_T is the sand heap over the outline (sand_heap.hpp), ridges at the corners included.
//
// Source: J Canadian Institute of Steel Construction (2002), Torsional Section Properties of Steel
// Shapes, case 2; shear areas AISC 360-16, G2 and G6. Bending: strips.hpp.
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
struct ChannelParameters {
    S width = std::numeric_limits<S>::quiet_NaN(); ///< b [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h [m], > 0
    S web_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_w [m], in (0, b)
    S flange_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_f [m], in (0, h/2)
};

/// Immutable value; all members are noexcept after construction. Bending, shear, torsion and width:
/// see StripSection.
template <std::floating_point S>
class Channel : public StripSection<S> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit Channel(const ChannelParameters<S>& parameters)
        : Channel(checked(parameters), detail::Checked{}) {}

    [[nodiscard]] const ChannelParameters<S>& parameters() const noexcept { return parameters_; }

    /// Corners, counterclockwise, the centroid at the origin [m].
    [[nodiscard]] std::array<Point<S>, 8> outline() const noexcept {
        return this->placed(corners(parameters_));
    }

  private:
    using Parameters = ChannelParameters<S>;

    Channel(const Parameters& p, detail::Checked) noexcept
        : StripSection<S>(
              {{p.width, p.flange_thickness},
               {p.web_thickness, p.height - 2 * p.flange_thickness},
               {p.width, p.flange_thickness}},
              {{p.height, p.web_thickness}, {2 * p.flange_thickness, p.width - p.web_thickness}},
              constants(p)),
          parameters_(p) {}

    static const Parameters& checked(const Parameters& p) {
        check::positive("Channel.width", p.width, "m");
        check::positive("Channel.height", p.height, "m");
        check::between("Channel.web_thickness", p.web_thickness, S(0), p.width, "m");
        check::between("Channel.flange_thickness", p.flange_thickness, S(0), p.height / 2, "m");
        return p;
    }

    static StripConstants<S> constants(const Parameters& p) noexcept {
        const auto outline = corners(p);
        const S heap = sand_heap_volume(std::span<const Point<S>>(outline));
        const S b = p.width;
        const S tw = p.web_thickness;
        const S tf = p.flange_thickness;
        const S flanges = 2 * (b - tw / 2) * tf * tf * tf;
        return {.product_of_inertia = 0,
                .shear_area_x = 2 * b * tf,
                .shear_area_y = p.height * tw,
                .elastic_shear_area_x = 5 * b * tf / 3,
                .elastic_shear_area_y = p.height * tw,
                .torsion_constant = (flanges + (p.height - tf) * tw * tw * tw) / 3,
                .plastic_torsion_modulus = 2 * heap};
    }

    /// From the lower left corner of the bounding box.
    static std::array<Point<S>, 8> corners(const Parameters& p) noexcept {
        const S b = p.width;
        const S h = p.height;
        const S tw = p.web_thickness;
        const S tf = p.flange_thickness;
        return {{{0, 0}, {b, 0}, {b, tf}, {tw, tf}, {tw, h - tf}, {b, h - tf}, {b, h}, {0, h}}};
    }

    Parameters parameters_;
};

template <std::floating_point S>
Channel(const ChannelParameters<S>&) -> Channel<S>;

static_assert(FullSection<Channel<double>> && FullSection<Channel<float>>);

} // namespace ductile
