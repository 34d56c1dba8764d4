// SPDX-License-Identifier: MIT
//
// I-section of three plates, without fillets, under axial force and bending about its strong or its
// weak axis. Exact: the half section is a strip of the width w₁ up to the height c, and of w₂ from
// there to 1 (half the height is 1):
//
//   A = w₁ c + w₂ (1-c),   Z = (w₁ c² + w₂ (1-c²))/2,   a = A/Z
//   y ≤ c:  n = w₁ y/A,           m = 1 - w₁ y²/(2Z)
//   y ≥ c:  n = 1 - w₂ (1-y)/A,   m = w₂ (1-y²)/(2Z)
//
//   strong axis: w₁ = t_w, w₂ = b,    c = 1 - 2 t_f/h        (height h, flange width b)
//   weak axis:   w₁ = h,   w₂ = 2 t_f, c = t_w/b
//
// Limit case w₁ = w₂: the rectangle, m = 1 - n².
//
// Source: e.g. Neal (1977), The Plastic Methods of Structural Analysis, chapter 6; written out
// here.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/surface/axial_bending.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// Two strips. Widths may be in any unit, c in (0, 1).
template <std::floating_point S>
class StripProfile {
  public:
    using Scalar = S;

    StripProfile(S inner_width, S outer_width, S inner_height) noexcept
        : w1_(inner_width),
          w2_(outer_width),
          c_(inner_height),
          area_(w1_ * c_ + w2_ * (1 - c_)),
          modulus_((w1_ * c_ * c_ + w2_ * (1 - c_) * (1 + c_)) / 2) {}

    [[nodiscard]] S axial(S y) const noexcept {
        return y < c_ ? w1_ * y / area_ : 1 - w2_ * (1 - y) / area_;
    }
    [[nodiscard]] S bending(S y) const noexcept {
        return y < c_ ? 1 - w1_ * y * y / (2 * modulus_) : w2_ * (1 - y) * (1 + y) / (2 * modulus_);
    }
    [[nodiscard]] S density(S y) const noexcept { return (y < c_ ? w1_ : w2_) / area_; }
    [[nodiscard]] S lever() const noexcept { return area_ / modulus_; }

  private:
    S w1_, w2_, c_;
    S area_, modulus_;
};

template <std::floating_point S>
struct IAxialBendingParameters {
    S height = std::numeric_limits<S>::quiet_NaN();           ///< h, whole [m], > 0
    S width = std::numeric_limits<S>::quiet_NaN();            ///< b, of the flanges [m], > 0
    S web_thickness = std::numeric_limits<S>::quiet_NaN();    ///< t_w [m], in (0, b)
    S flange_thickness = std::numeric_limits<S>::quiet_NaN(); ///< t_f [m], in (0, h/2)
};

enum class BendingAxis { strong, weak };

/// Normalised surface in (n, m).
template <std::floating_point S>
class IAxialBending : public AxialBending<StripProfile<S>> {
  public:
    /// `strong`: about the axis parallel to the flanges; `weak`: parallel to the web.
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    IAxialBending(const IAxialBendingParameters<S>& parameters, BendingAxis axis)
        : AxialBending<StripProfile<S>>(half_section(parameters, axis)) {}

  private:
    static StripProfile<S> half_section(const IAxialBendingParameters<S>& p, BendingAxis axis) {
        check::positive("IAxialBending.height", p.height, "m");
        check::positive("IAxialBending.width", p.width, "m");
        check::between("IAxialBending.web_thickness", p.web_thickness, S(0), p.width, "m");
        check::between("IAxialBending.flange_thickness", p.flange_thickness, S(0), p.height / 2,
                       "m");
        return axis == BendingAxis::strong
                   ? StripProfile<S>(p.web_thickness, p.width,
                                     1 - 2 * p.flange_thickness / p.height)
                   : StripProfile<S>(p.height, 2 * p.flange_thickness, p.web_thickness / p.width);
    }
};

static_assert(YieldSurface<IAxialBending<double>> && YieldSurface<IAxialBending<float>>);

} // namespace ductile
