// SPDX-License-Identifier: MIT
//
// Whether a rigid joint bore in one step what it should have yielded to. A blow of the impulse J
// needs no more than the force J/dt in a step of dt: one that is long enough bears any blow, and
// takes nothing. What it bore is told a step later, when the force has fallen again: a load that
// rests is no blow. With f₁, f₂, f₃ the forces of three steps in a row, nothing having flowed in
// the second,
//
//   J = (f₂ - max(f₁, f₃, 0)) dt,  f₂ > 0,      E <= J²/(2 M),   M = (K⁻¹)_ii
//
// with M the mass of the joint's two bodies alone along the axis while its other axes hold. What
// hangs on them, and what struck them, comes on top of it, so that E is a bound.
//
// Symbols as in any_link.hpp. Not thread-safe.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>

#include "ductile/joint/link_types.hpp"
#include "ductile/numeric/ldlt.hpp"

namespace ductile {

template <std::floating_point S>
class BorneBlow {
  public:
    /// The last step may have borne one: the next one needs its masses.
    [[nodiscard]] bool may_have() const noexcept { return may_have_; }
    /// M of the plastic axes, from K of all.
    void take_mass(const Matrix6<S>& k, const std::array<bool, 6>& plastic) noexcept {
        mass_.setZero();
        for (std::size_t i = 0; i < plastic.size(); ++i) {
            if (!plastic[i]) continue;
            const auto axis = Eigen::Index(i);
            mass_[axis] = numeric::solve_semidefinite(k, Vector6<S>(Vector6<S>::Unit(axis)))[axis];
        }
    }
    /// After a step of `dt` [s] with these forces of the rows, of which `strength(axis)` could have
    /// been borne and those of an axis that is not plastic do not count.
    template <class Strength>
    void see(const Vector6<S>& force, bool flowed, S dt, const std::array<bool, 6>& plastic,
             const Strength& strength) noexcept {
        constexpr S share = S(0.1); // of the strength
        most_ = 0;
        bool rose = false;
        for (std::size_t i = 0; i < plastic.size(); ++i) {
            if (!plastic[i]) continue;
            const auto k = Eigen::Index(i);
            const S noticed = share * strength(i);
            const S before = pulse(borne_[k], before_[k], force[k]);
            if (may_have_ && before > noticed && mass_[k] > 0) {
                most_ = std::max(most_, before * before * dt_ * dt_ / (2 * mass_[k]));
            }
            rose = rose || pulse(force[k], borne_[k], S(0)) > noticed;
        }
        may_have_ = rose && !flowed;
        before_ = borne_;
        borne_ = force;
        dt_ = dt;
    }
    /// The most that it may be that the step before that one bore; 0: nothing [J].
    [[nodiscard]] S most() const noexcept { return most_; }
    /// What comes next has no step before it.
    void forget() noexcept { *this = {}; }

  private:
    /// By how much a force is farther from zero than it was, and is afterwards [N | N m].
    [[nodiscard]] static S pulse(S force, S before, S after) noexcept {
        const S sign = force < 0 ? S(-1) : S(1);
        return sign * force - std::max({sign * before, sign * after, S(0)});
    }

    Vector6<S> before_ = Vector6<S>::Zero(), borne_ = Vector6<S>::Zero(); ///< f₁, f₂
    Vector6<S> mass_ = Vector6<S>::Zero();                                ///< M
    S dt_ = 0;                                                            ///< of the last step [s]
    S most_ = 0;                                                          ///< E [J]
    bool may_have_ = false;
};

} // namespace ductile
