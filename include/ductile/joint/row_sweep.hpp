// SPDX-License-Identifier: MIT
//
// Up to six rows between two bodies, taken up one after the other: what a joint needs to take part
// in an engine's sweeps (sequential impulses) by itself, with nothing of the engine's but the
// velocities of the two bodies. Each row asks for
//
//   J y + C λ = b,   lower <= λ <= upper,   y = (v_A - v_B, ω_A, ω_B),
//
// and is given, in each sweep,
//
//   λ <- clamp(λ + (b - J y - C λ) / (k + C)),   y <- y + M⁻¹ Jᵀ Δλ,   k = J M⁻¹ Jᵀ.
//
// Any C >= 0 converges, since k + C is the row's own diagonal. Rows that do not push each other
// (decoupled_rows.hpp) are solved by a single sweep. A block of rows that do is, where the first
// sweep was not enough, also taken up at once, unless one of them would meet a bound:
//
//   Δλ = (K + C)⁻¹ (b - J y - C λ),   K = J M⁻¹ Jᵀ.
//
// All rows act in one point: a sweep reads from the bodies how A moves there beside B, J y = W w,
// and at its end gives them one force and one moment; what its rows do to each other is in K.
//
// Symbols
//   J    Jacobian: (n, r_A × n + m, -(r_B × n + m)) of a force n and a moment m at the joint
//   W    n and m of each row
//   w    (v_A + ω_A × r_A - v_B - ω_B × r_B, ω_A - ω_B)   [m/s, rad/s]
//   λ    impulse of a row                    [N s | N m s]
//   b    target velocity                     [m/s | rad/s]
//   C    compliance of the impulse           [1/kg | 1/(kg m²)]
//   k    inverse mass that the row feels     [1/kg | 1/(kg m²)]
//   r    joint minus centre of mass          [m], world axes as all else
//
// Source: Catto (2005), Iterative Dynamics with Temporal Coherence, GDC: projected Gauss-Seidel.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/numeric/cholesky.hpp"
#include "ductile/vocabulary/row.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// What a row moves one of its bodies by. Default: a body that cannot be moved.
template <std::floating_point S>
struct SweptBody {
    Vector3<S> inverse_mass = Vector3<S>::Zero();    ///< along x, y, z, world [1/kg]
    Matrix3<S> inverse_inertia = Matrix3<S>::Zero(); ///< world axes [1/(kg m²)]
    Vector3<S> arm = Vector3<S>::Zero();             ///< r [m]
};

/// Velocities of the two bodies, of their centres of mass, or changes of these, world axes.
template <std::floating_point S>
struct SweptVelocities {
    Vector3<S> linear_a = Vector3<S>::Zero();  ///< [m/s]
    Vector3<S> angular_a = Vector3<S>::Zero(); ///< [rad/s]
    Vector3<S> linear_b = Vector3<S>::Zero();
    Vector3<S> angular_b = Vector3<S>::Zero();

    [[nodiscard]] S squared_norm() const noexcept {
        return dot(linear_a, linear_a) + dot(angular_a, angular_a) + dot(linear_b, linear_b) +
               dot(angular_b, angular_b);
    }
};

/// Not thread-safe. Nothing allocates or throws; O(rows).
template <std::floating_point S>
class RowSweep {
  public:
    using Impulses = Vector6<S>;

    /// Begins with no rows, between these bodies.
    void open(const SweptBody<S>& a, const SweptBody<S>& b) noexcept {
        a_ = a;
        b_ = b;
        count_ = block_ = 0;
        swept_ = has_mass_ = has_factor_ = false;
    }

    /// A row of the force `along` and the moment `about`; at most six of them. One that neither
    /// body can follow stays without impulse. `limits.bias`: b; bounds are of the impulse, may be
    /// infinite.
    void add(const Vector3<S>& along, const Vector3<S>& about,
             const RowLimits<S>& limits) noexcept {
        set(count_++, along, about, limits);
    }
    /// The last `count` > 0 of the rows added are a block.
    void join_last(int count) noexcept { block_ = count; }

    /// One sweep over the rows, on top of `impulses`, which it changes, from the velocities `now`.
    /// Returns by how much it changed these; `asked` becomes the largest change of a row's own
    /// velocity that was asked for within its bounds [m/s | rad/s].
    SweptVelocities<S> sweep(const SweptVelocities<S>& now, Impulses& impulses, S& asked) noexcept;

  private:
    void set(int i, const Vector3<S>& along, const Vector3<S>& about,
             const RowLimits<S>& limits) noexcept {
        directions_.template block<3, 1>(0, i) = along;
        directions_.template block<3, 1>(3, i) = about;
        bias_[i] = limits.bias;
        lower_[i] = limits.lower;
        upper_[i] = limits.upper;
        compliance_[i] = limits.compliance;
    }
    /// Rows that were not added ask for nothing.
    void leave_out_the_rest() noexcept {
        const Vector3<S> none = Vector3<S>::Zero();
        for (int i = count_; i < 6; ++i) set(i, none, none, {});
    }
    [[nodiscard]] bool within_bounds(const Impulses& impulses) const noexcept {
        bool within = true;
        for (int i = 0; i < 6; ++i) {
            within = within && impulses[i] >= lower_[i] && impulses[i] <= upper_[i];
        }
        return within;
    }

    /// Row i alone; what it does to those after it is taken off `missing`.
    void sweep_row(int i, Vector6<S>& missing, Impulses& impulses, S& asked) const noexcept {
        const S wanted = std::clamp(impulses[i] + gain_[i] * missing[i], lower_[i], upper_[i]);
        const S change = wanted - impulses[i];
        if (change == 0) return;
        impulses[i] = wanted;
        for (int j = i + 1; j < count_; ++j) missing[j] -= mass_(j, i) * change;
        asked = std::max(asked, std::abs(change) * mass_(i, i));
    }
    /// All rows from `first` on at once, unless one would meet a bound. `missing` is of when they
    /// were taken up one by one, which changed their impulses by `changed`.
    void sweep_block(int first, const Vector6<S>& missing, const Vector6<S>& changed,
                     Impulses& impulses) noexcept;
    /// K, and from it the gains.
    void find_mass() noexcept;

    SweptBody<S> a_, b_;
    Matrix6<S> directions_; ///< Wᵀ: n above m of each row
    Vector6<S> bias_, lower_, upper_, compliance_;
    int count_ = 0;
    int block_ = 0; ///< how many of the last rows are taken up together
    bool swept_ = false;
    bool has_mass_ = false, has_factor_ = false;
    Vector6<S> gain_;                ///< 1/(k + C)
    Matrix6<S> mass_;                ///< K, from when a row first changed
    numeric::Cholesky<S, 6> factor_; ///< of K + C of the block, from when first needed
};

template <std::floating_point S>
SweptVelocities<S> RowSweep<S>::sweep(const SweptVelocities<S>& now, Impulses& impulses,
                                      S& asked) noexcept {
    if (!swept_) leave_out_the_rest();
    const Vector3<S> on_a = sum(now.linear_a, cross(now.angular_a, a_.arm));
    const Vector3<S> on_b = sum(now.linear_b, cross(now.angular_b, b_.arm));
    const Vector6<S> w = twist_of(difference(on_a, on_b), difference(now.angular_a, now.angular_b));
    // Eigen's own product here, which is the sweep's work: it uses packets
    Vector6<S> missing = bias_ - compliance_.cwiseProduct(impulses);
    missing.noalias() -= directions_.transpose() * w;

    asked = 0;
    if (!has_mass_) {
        if (missing.isZero(0) && within_bounds(impulses)) return {};
        find_mass();
    }
    const Impulses before = impulses;
    const int single = count_ - block_;
    for (int i = 0; i < single; ++i) sweep_row(i, missing, impulses, asked);
    S of_block = 0;
    for (int i = single; i < count_; ++i) sweep_row(i, missing, impulses, of_block);
    constexpr S round_off = 4 * std::numeric_limits<S>::epsilon();
    if (swept_ && of_block * of_block > round_off * round_off * now.squared_norm()) {
        Vector6<S> changed;
        for (int i = 0; i < 6; ++i) changed[i] = impulses[i] - before[i];
        sweep_block(single, missing, changed, impulses);
    }
    asked = std::max(asked, of_block);
    swept_ = true;
    if (asked == 0) return {};
    const Vector6<S> change = impulses - before;
    const Vector6<S> given = directions_ * change;
    const auto moved = [](const SweptBody<S>& body, const Vector3<S>& force) {
        return Vector3<S>(body.inverse_mass[0] * force[0], body.inverse_mass[1] * force[1],
                          body.inverse_mass[2] * force[2]);
    };
    const Vector3<S> force = linear(given), moment = angular(given);
    const Vector3<S> turn_a = sum(cross(a_.arm, force), moment);
    const Vector3<S> turn_b = sum(cross(b_.arm, force), moment);
    return {moved(a_, force), times(a_.inverse_inertia, turn_a), scaled(-1, moved(b_, force)),
            scaled(-1, times(b_.inverse_inertia, turn_b))};
}

template <std::floating_point S>
void RowSweep<S>::sweep_block(int first, const Vector6<S>& missing, const Vector6<S>& changed,
                              Impulses& impulses) noexcept {
    if (!has_factor_) {
        Matrix6<S> system = Matrix6<S>::Identity();
        for (int j = 0; j < block_; ++j) {
            for (int i = 0; i < block_; ++i) system(i, j) = mass_(first + i, first + j);
            system(j, j) += compliance_[first + j];
        }
        factor_ = numeric::Cholesky<S, 6>(system);
        has_factor_ = true;
    }
    if (!factor_.succeeded()) return;
    Vector6<S> wanted = Vector6<S>::Zero();
    for (int i = 0; i < block_; ++i) {
        const int row = first + i;
        wanted[i] = missing[row] - compliance_[row] * changed[row];
        for (int j = row; j < count_; ++j) wanted[i] -= mass_(j, row) * changed[j];
    }
    wanted = factor_.solve(wanted);
    Impulses next = impulses;
    for (int i = 0; i < block_; ++i) {
        const int row = first + i;
        next[row] += wanted[i];
        if (!(next[row] >= lower_[row] && next[row] <= upper_[row])) return;
    }
    impulses = next;
}

template <std::floating_point S>
void RowSweep<S>::find_mass() noexcept {
    constexpr S least = std::numeric_limits<S>::min();
    Matrix6<S> at_joint =
        inverse_mass_at_joint(BodyAtJoint<S>{.inverse_inertia = a_.inverse_inertia, .arm = a_.arm},
                              BodyAtJoint<S>{.inverse_inertia = b_.inverse_inertia, .arm = b_.arm});
    for (int i = 0; i < 3; ++i) at_joint(i, i) += a_.inverse_mass[i] + b_.inverse_mass[i];
    for (int j = 0; j < 6; ++j) {
        Vector6<S> moved = Vector6<S>::Zero(); // by a unit impulse of row j
        for (int k = 0; k < 6; ++k) {
            for (int i = 0; i < 6; ++i) moved[i] += at_joint(i, k) * directions_(k, j);
        }
        for (int i = 0; i < 6; ++i) {
            S entry = 0;
            for (int k = 0; k < 6; ++k) entry += directions_(k, i) * moved[k];
            mass_(i, j) = entry;
        }
    }
    for (int i = 0; i < 6; ++i) {
        gain_[i] = mass_(i, i) > least ? 1 / (mass_(i, i) + compliance_[i]) : S(0);
    }
    has_mass_ = true;
}

} // namespace ductile
