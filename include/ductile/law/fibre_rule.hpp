// SPDX-License-Identifier: MIT
//
// Rules that integrate over the height of a section.
//
//   MidpointFibres  n strips of equal height, each with the stress and the width at its middle: the
//                   fibre model of frame programs. Error of order 2 in 1/n where the width is
//                   continuous, also across the kink at first yield; 1.5 at the rounded ends of a
//                   circle, 1 where the width jumps inside a strip.
//   AdaptiveFibres  Simpson's rule that halves its panels until the answer holds to a tolerance:
//   order 4
//                   between kinks, and kinks and jumps of stress or width are closed in upon, so
//                   that they do not limit the result. The effort follows the section by itself.
//
// Source: Lyness (1969), J. ACM 16, 483-495 (adaptive Simpson with extrapolation).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// `integrate(low, high, f)` is the integral of f from low to high. Deterministic.
template <class T, class S>
concept FibreRule = requires(const T rule, S height, S (*f)(S)) {
    { rule.integrate(height, height, f) } -> std::same_as<S>;
};

template <std::floating_point S>
class MidpointFibres {
  public:
    /// @throws std::invalid_argument where `count` is zero.
    explicit MidpointFibres(std::size_t count) : count_(count) {
        if (count == 0) check::fail("MidpointFibres.count", S(0), "", ">= 1");
    }

    template <class F>
    [[nodiscard]] S integrate(S low, S high, F&& f) const {
        const S thickness = (high - low) / S(count_);
        S sum = 0;
        for (std::size_t i = 0; i < count_; ++i) sum += f(low + (S(i) + S(0.5)) * thickness);
        return sum * thickness;
    }

  private:
    std::size_t count_;
};

template <std::floating_point S>
class AdaptiveFibres {
  public:
    /// Near round-off for float, well above it for double.
    static constexpr S default_tolerance =
        std::max(S(1e-9), 16 * std::numeric_limits<S>::epsilon());

    /// `tolerance` [-]: error over the integral of |f|.
    /// @throws std::invalid_argument where it is not in (0, 0.1).
    explicit AdaptiveFibres(S tolerance = default_tolerance)
        : tolerance_(check::between("AdaptiveFibres.tolerance", tolerance, S(0), S(0.1), "")) {}

    template <class F>
    [[nodiscard]] S integrate(S low, S high, F&& f) const {
        Panel panels[first_panels];
        S scale = 0;
        S right = f(low);
        for (int i = 0; i < first_panels; ++i) {
            const S a = low + (high - low) * S(i) / S(first_panels);
            const S b = low + (high - low) * S(i + 1) / S(first_panels);
            panels[i] = {a, b, right, f(a + (b - a) / 2), f(b)};
            right = panels[i].right;
            scale += std::abs(panels[i].left) + 4 * std::abs(panels[i].middle) + std::abs(right);
        }
        scale *= (high - low) / S(6 * first_panels);
        S sum = 0;
        for (const Panel& panel : panels) {
            sum += refine(panel, tolerance_ * scale / S(first_panels), deepest, f);
        }
        return sum;
    }

  private:
    static constexpr int first_panels = 16; ///< so that nothing as thick as h/32 is overlooked
    static constexpr int deepest = 40; ///< halvings: a jump is closed in to 1e-13 of the height

    struct Panel {
        S low, high;
        S left, middle, right;

        [[nodiscard]] S simpson() const noexcept {
            return (left + 4 * middle + right) * (high - low) / 6;
        }
    };

    template <class F>
    static S refine(const Panel& whole, S tolerance, int depth, F& f) {
        const S centre = whole.low + (whole.high - whole.low) / 2;
        const S lower = whole.low + (centre - whole.low) / 2;
        const S upper = centre + (whole.high - centre) / 2;
        const Panel a{whole.low, centre, whole.left, f(lower), whole.middle};
        const Panel b{centre, whole.high, whole.middle, f(upper), whole.right};
        const S halves = a.simpson() + b.simpson();
        const S change = halves - whole.simpson();
        const bool closed = !(lower > whole.low && upper < whole.high);
        if (depth == 0 || closed || std::abs(change) <= 15 * tolerance) return halves + change / 15;
        return refine(a, tolerance / 2, depth - 1, f) + refine(b, tolerance / 2, depth - 1, f);
    }

    S tolerance_;
};

static_assert(FibreRule<MidpointFibres<double>, double> && FibreRule<AdaptiveFibres<float>, float>);

} // namespace ductile
