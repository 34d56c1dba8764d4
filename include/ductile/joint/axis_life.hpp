// SPDX-License-Identifier: MIT
//
// Life counted axis by axis: how far a joint of several axes may flow along each of them, whatever its
// equivalent travel, which is work over one strength, says: a thin open section that twists by a radian
// does hardly any work.
//
//   dL = √(Σ_i (dq_i / l_i)²),   breaks at L = 1
//
// Limit cases: flow along one axis ends at its limit; along axes of equal limits at that length of path,
// so that two axes of bending may be turned against each other; an infinite limit uses up no life.
//
// Symbols ("x | y": translational | rotational axis)
//   q_i  plastic travel along axis i               [m | rad]
//   l_i  largest plastic travel along it alone     [m | rad]
//   L    share of life used                        [-]
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <concepts>
#include <limits>

#include "ductile/numeric/small_vector.hpp"

namespace ductile {

template <std::floating_point S, int N>
class AxisLife {
  public:
    using Vector = Eigen::Matrix<S, N, 1>;

    /// `largest`: l, > 0 [m | rad].
    explicit AxisLife(const Vector& largest) noexcept
        : share_(largest.cwiseInverse()), limited_(share_.maxCoeff() > 0) {}

    /// False where no axis has a limit.
    [[nodiscard]] bool limited() const noexcept { return limited_; }
    /// Life that the flow `travel` along all axes uses up, >= 0 [-].
    [[nodiscard]] S of(const Vector& travel) const noexcept {
        if (!limited_) return 0;
        return numeric::length(Vector(travel.cwiseProduct(share_)));
    }

  private:
    Vector share_; ///< 1/l
    bool limited_;
};

/// What is left of the equivalent `travel` where that much would use up `life`, of which `used` is
/// gone; infinity where it uses up none [m | rad].
template <std::floating_point S>
[[nodiscard]] S travel_left(S travel, S life, S used) noexcept {
    return life > 0 ? travel * (std::max(1 - used, S(0)) / life)
                    : std::numeric_limits<S>::infinity();
}

} // namespace ductile
