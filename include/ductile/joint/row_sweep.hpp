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
//   Δλ = (J M⁻¹ Jᵀ + C)⁻¹ (b - J y - C λ).
//
// Symbols
//   J    Jacobian: (n, r_A × n + m, -(r_B × n + m)) of a force n and a moment m at the joint
//   λ    impulse of a row                    [N s | N m s]
//   b    target velocity                     [m/s | rad/s]
//   C    compliance of the impulse           [1/kg | 1/(kg m²)]
//   k    inverse mass that the row feels     [1/kg | 1/(kg m²)]
//   r    joint minus centre of mass          [m], world axes as all else
//
// Source: Catto (2005), Iterative Dynamics with Temporal Coherence, GDC: projected Gauss-Seidel.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "ductile/joint/pair.hpp"
#include "ductile/vocabulary/row.hpp"

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
        return linear_a.squaredNorm() + angular_a.squaredNorm() + linear_b.squaredNorm() +
               angular_b.squaredNorm();
    }
};

/// Not thread-safe. Nothing allocates or throws; O(rows).
template <std::floating_point S>
class RowSweep {
  public:
    using Impulses = std::array<S, 6>;

    /// Begins with no rows, between these bodies.
    void open(const SweptBody<S>& a, const SweptBody<S>& b) noexcept {
        a_ = a;
        b_ = b;
        both_ = a.inverse_mass + b.inverse_mass;
        for (int i = 0; i < 3; ++i)
            share_a_[i] = both_[i] > 0 ? a.inverse_mass[i] / both_[i] : S(0);
        count_ = 0;
        block_ = 0;
        swept_ = false;
    }

    /// A row of the force `along` and the moment `about`; at most six of them. One that neither
    /// body can follow stays without impulse. `limits.bias`: b; bounds are of the impulse, may be
    /// infinite.
    void add(const Vector3<S>& along, const Vector3<S>& about,
             const RowLimits<S>& limits) noexcept {
        Line& line = next(limits);
        line.jacobian.template head<3>() = along;
        line.moved.template head<3>() = both_.cwiseProduct(along);
        turn(line, about + a_.arm.cross(along), about + b_.arm.cross(along),
             along.dot(line.moved.template head<3>()));
    }
    /// The same of a force alone.
    void add_force(const Vector3<S>& along, const RowLimits<S>& limits) noexcept {
        Line& line = next(limits);
        line.jacobian.template head<3>() = along;
        line.moved.template head<3>() = both_.cwiseProduct(along);
        turn(line, a_.arm.cross(along), b_.arm.cross(along),
             along.dot(line.moved.template head<3>()));
    }
    /// The same of a moment alone.
    void add_moment(const Vector3<S>& about, const RowLimits<S>& limits) noexcept {
        Line& line = next(limits);
        line.jacobian.template head<3>().setZero();
        line.moved.template head<3>().setZero();
        turn(line, about, about, S(0));
    }

    /// The last `count` > 0 of the rows added are a block.
    void join_last(int count) noexcept {
        block_ = count;
        factored_ = false;
    }

    /// One sweep over the rows, on top of `impulses`, which it changes, from the velocities `now`.
    /// Returns by how much it changed these; `asked` becomes the largest change of a row's own
    /// velocity that was asked for within its bounds [m/s | rad/s].
    SweptVelocities<S> sweep(const SweptVelocities<S>& now, Impulses& impulses, S& asked) noexcept {
        Stacked y;
        y << now.linear_a - now.linear_b, now.angular_a, now.angular_b, S(0);
        const Stacked before = y;
        asked = 0;
        const int single = count_ - block_;
        for (int i = 0; i < single; ++i) take_up(i, y, impulses, asked);
        S of_block = 0;
        for (int i = single; i < count_; ++i) take_up(i, y, impulses, of_block);
        constexpr S round_off = 4 * std::numeric_limits<S>::epsilon();
        if (swept_ && of_block > round_off * y.cwiseAbs().maxCoeff()) {
            take_up_block(single, y, impulses);
        }
        asked = std::max(asked, of_block);
        swept_ = true;
        if (asked == 0) return {};
        const Stacked changed = y - before;
        const Vector3<S> linear = changed.template head<3>();
        const Vector3<S> linear_a = share_a_.cwiseProduct(linear);
        // of a direction in which neither is moved nothing is changed
        return {linear_a, changed.template segment<3>(3), linear_a - linear,
                changed.template segment<3>(6)};
    }

  private:
    /// y, and a row of J: padded, to be had two or four at a time.
    using Stacked = Eigen::Matrix<S, 10, 1>;
    using BlockMatrix = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
    using BlockVector = Eigen::Matrix<S, Eigen::Dynamic, 1, 0, 6, 1>;
    struct Line {
        Stacked jacobian = Stacked::Zero(), moved = Stacked::Zero(); ///< J and M⁻¹ Jᵀ
        S inverse_mass, gain;
        RowLimits<S> limits;
    };

    Line& next(const RowLimits<S>& limits) noexcept {
        Line& line = lines_[std::size_t(count_++)];
        line.limits = limits;
        return line;
    }
    /// The turning part of a row whose moment is `on_a` on A and the opposite of `on_b` on B.
    void turn(Line& line, const Vector3<S>& on_a, const Vector3<S>& on_b,
              S inverse_mass) const noexcept {
        constexpr S least = std::numeric_limits<S>::min();
        const Vector3<S> turned_a = a_.inverse_inertia * on_a, turned_b = b_.inverse_inertia * on_b;
        line.inverse_mass = inverse_mass + on_a.dot(turned_a) + on_b.dot(turned_b);
        line.gain =
            line.inverse_mass > least ? 1 / (line.inverse_mass + line.limits.compliance) : S(0);
        line.jacobian.template segment<3>(3) = on_a;
        line.jacobian.template segment<3>(6) = -on_b;
        line.moved.template segment<3>(3) = turned_a;
        line.moved.template segment<3>(6) = -turned_b;
    }

    /// What row i is off by.
    [[nodiscard]] S missing(int i, const Stacked& y, const Impulses& impulses) const noexcept {
        const Line& line = lines_[std::size_t(i)];
        return line.limits.bias - line.jacobian.dot(y) -
               line.limits.compliance * impulses[std::size_t(i)];
    }
    void take_up(int i, Stacked& y, Impulses& impulses, S& asked) const noexcept {
        const Line& line = lines_[std::size_t(i)];
        S& impulse = impulses[std::size_t(i)];
        const S wanted = std::clamp(impulse + line.gain * missing(i, y, impulses),
                                    line.limits.lower, line.limits.upper);
        const S change = wanted - impulse;
        if (change == 0) return;
        impulse = wanted;
        y += change * line.moved;
        asked = std::max(asked, std::abs(change) * line.inverse_mass);
    }
    /// All rows from `first` on at once, unless one would meet a bound.
    void take_up_block(int first, Stacked& y, Impulses& impulses) noexcept {
        if (!factored_) factor(first);
        if (block_mass_.info() != Eigen::Success) return;
        BlockVector change(block_);
        for (int i = 0; i < block_; ++i) change[i] = missing(first + i, y, impulses);
        block_mass_.solveInPlace(change);
        for (int i = 0; i < block_; ++i) {
            const RowLimits<S>& limits = lines_[std::size_t(first + i)].limits;
            const S wanted = impulses[std::size_t(first + i)] + change[i];
            if (!(wanted >= limits.lower && wanted <= limits.upper)) return;
        }
        for (int i = 0; i < block_; ++i) {
            impulses[std::size_t(first + i)] += change[i];
            y += change[i] * lines_[std::size_t(first + i)].moved;
        }
    }
    void factor(int first) noexcept {
        BlockMatrix k(block_, block_);
        for (int i = 0; i < block_; ++i) {
            const Line& line = lines_[std::size_t(first + i)];
            for (int j = 0; j < i; ++j) {
                k(i, j) = line.jacobian.dot(lines_[std::size_t(first + j)].moved);
            }
            k(i, i) = line.inverse_mass + line.limits.compliance;
        }
        block_mass_.compute(k);
        factored_ = true;
    }

    SweptBody<S> a_, b_;
    Vector3<S> both_ = Vector3<S>::Zero();    ///< inverse mass that v_A - v_B feels [1/kg]
    Vector3<S> share_a_ = Vector3<S>::Zero(); ///< what A has of a change of it
    std::array<Line, 6> lines_;
    int count_ = 0;
    int block_ = 0; ///< how many of the last rows are taken up together
    bool swept_ = false;
    bool factored_ = false;
    Eigen::LLT<BlockMatrix> block_mass_; ///< of J M⁻¹ Jᵀ + C, where factored
};

} // namespace ductile
