// SPDX-License-Identifier: MIT
//
// Many one-axis rigid-plastic joints at once: the law of OneAxisJoint (perfect or linear isotropic
// hardening, travel limit) over structure-of-arrays spans.
//
//   before the solve   batch.prepare(dt)   reads motion and state, writes rows
//   after the solve    batch.commit(dt)    reads reaction, rows and state, writes state and step
//
// The loops have no branch, no call and no alias, so g++ and clang++ run them on a whole register
// of joints at -O3. Results are those of OneAxisJoint to round-off; they are the same operations in
// another order.
//
// Bytes per joint, with s = sizeof(S) and shared parameters; a PerJoint parameter adds s to the
// reads of each call:
//
//   prepare   reads 6 s + 1    writes 4 s        float  25 + 16, double  49 + 32
//   commit    reads 13 s + 1   writes 8 s + 1    float  53 + 33, double 105 + 65
//
// A call is O(n), about 25 instructions per joint and step in float on registers of 32 bytes, which
// are used wherever the processor has them (each_joint.hpp). In the cache it is bound by their number,
// with registers of 16 bytes beyond it too.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <utility>

#include "ductile/batch/arrays.hpp"
#include "ductile/batch/batch_law.hpp"
#include "ductile/batch/each_joint.hpp"
#include "ductile/batch/row_rule.hpp"
#include "ductile/batch/status.hpp"
#include "ductile/fracture/event.hpp"
#include "ductile/joint/one_axis_joint.hpp"

namespace ductile {

namespace batch_detail {

// The status bytes are widened to masks block by block, in the first cache level: bytes and scalars
// in one loop would make g++ unroll it to 16 joints and run out of registers.

inline constexpr std::size_t block = 256;

template <std::floating_point S>
using MaskBlock = std::array<Mask<S>, block>;

template <std::floating_point S>
void widen(const BatchStatus* __restrict status, std::size_t joints, MaskBlock<S>& wide) noexcept {
    for (std::size_t i = 0; i < joints; ++i) wide[i] = status[i];
}

template <std::floating_point S>
void narrow(const MaskBlock<S>& wide, std::size_t joints, BatchStatus* __restrict status) noexcept {
    for (std::size_t i = 0; i < joints; ++i) status[i] = static_cast<BatchStatus>(wide[i]);
}

template <std::floating_point S, class Law>
[[gnu::always_inline]] constexpr RowLaw<S> row_law(const Law& law, std::size_t joint) noexcept {
    return {law.strength()[joint], law.hardening()[joint], law.limit()[joint]};
}

template <std::floating_point S, class Law>
struct PrepareRow {
    StepNumbers<S> step;
    Law law;

    /// Joint i, its status in entry n of the block.
    [[gnu::always_inline]] void operator()(std::size_t i, std::size_t n, const S* position,
                                           const S* velocity, const S* offset, const S* travel,
                                           const S* last_velocity, const Mask<S>* status, S* start,
                                           S* lower, S* upper, S* bias) const noexcept {
        const Prepared<S> now =
            prepare_row<S>(row_law<S>(law, i), step, position[i], velocity[i], offset[i], travel[i],
                           start[i], last_velocity[i], status[n]);
        lower[i] = now.lower;
        upper[i] = now.upper;
        bias[i] = now.bias;
        start[i] = now.start_velocity;
    }
};

template <std::floating_point S, class Law>
struct CommitRow {
    StepNumbers<S> step;
    Law law;

    /// Joint i, its status in entry n of the block.
    [[gnu::always_inline]] void operator()(std::size_t i, std::size_t n, const S* force,
                                           const S* velocity, const S* position, const S* lower,
                                           const S* upper, const S* bias, const S* start, S* offset,
                                           S* travel, S* plastic_work, S* other_work,
                                           S* last_velocity, S* residual_max, Mask<S>* status,
                                           S* release, S* residual) const noexcept {
        const RowState<S> old{offset[i],        travel[i],       plastic_work[i], other_work[i],
                              last_velocity[i], residual_max[i], status[n]};
        const Committed<S> now =
            commit_row<S>(row_law<S>(law, i), step, force[i], velocity[i], position[i], lower[i],
                          upper[i], bias[i], start[i], old);
        offset[i] = now.state.offset;
        travel[i] = now.state.travel;
        plastic_work[i] = now.state.plastic_work;
        other_work[i] = now.state.other_work;
        last_velocity[i] = now.state.velocity;
        residual_max[i] = now.state.residual_max;
        status[n] = now.state.status;
        release[i] = now.release;
        residual[i] = now.residual;
    }
};

} // namespace batch_detail

/// A view: the arrays are the caller's and must outlive it. Not thread-safe, but views of disjoint
/// subspans may run in different threads. After construction nothing allocates or throws.
template <class Law>
class OneAxisBatch {
  public:
    using Scalar = typename Law::Scalar;
    /// As the scalar joint of a Perfect or Linear law and a TravelLimit keeps it.
    using State = typename OneAxisJoint<Perfect<Scalar>>::State;

    /// @throws std::invalid_argument where array sizes differ, a written array overlaps another, a
    /// parameter is out of range, or the stiffness is finite: the batch is rigid-plastic.
    OneAxisBatch(Law law, const BatchArrays<Scalar>& arrays,
                 const OneAxisParameters<Scalar>& parameters = {})
        : law_(std::move(law)), arrays_(arrays), parameters_(parameters) {
        // the scalar joint's checks are the batch's
        (void)OneAxisJoint(Perfect<Scalar>({.strength = 1}), TravelLimit<Scalar>{}, parameters);
        require_rigid(parameters.stiffness);
        check_arrays(arrays);
        law_.check_size(size());
    }

    [[nodiscard]] std::size_t size() const noexcept { return arrays_.motion.position.size(); }
    [[nodiscard]] const Law& law() const noexcept { return law_; }
    [[nodiscard]] const BatchArrays<Scalar>& arrays() const noexcept { return arrays_; }

    /// Rules all rows for a step of `dt` > 0 [s]. Call once per step, before commit.
    void prepare(Scalar dt) noexcept {
        const auto& [motion, rows, reaction, state, step] = arrays_;
        const batch_detail::PrepareRow<Scalar, Law> rule{numbers(dt), law_};
        for (std::size_t from = 0; from < size(); from += batch_detail::block) {
            const std::size_t joints = std::min(batch_detail::block, size() - from);
            batch_detail::MaskBlock<Scalar> status;
            batch_detail::widen<Scalar>(state.status.data() + from, joints, status);
            batch_detail::each_joint(rule, from, joints, motion.position.data(),
                                     motion.velocity.data(), state.plastic_offset.data(),
                                     state.plastic_travel.data(), state.velocity.data(),
                                     status.data(),
                                     state.start_velocity.data(), rows.lower.data(),
                                     rows.upper.data(), rows.bias.data());
        }
    }

    /// Books the step that `prepare` opened; same `dt` [s], rows as prepare wrote them.
    void commit(Scalar dt) noexcept {
        const auto& [motion, rows, reaction, state, step] = arrays_;
        const batch_detail::CommitRow<Scalar, Law> rule{numbers(dt), law_};
        for (std::size_t from = 0; from < size(); from += batch_detail::block) {
            const std::size_t joints = std::min(batch_detail::block, size() - from);
            batch_detail::MaskBlock<Scalar> status;
            batch_detail::widen<Scalar>(state.status.data() + from, joints, status);
            batch_detail::each_joint(
                rule, from, joints, reaction.force.data(), reaction.velocity.data(),
                reaction.position.data(), rows.lower.data(), rows.upper.data(), rows.bias.data(),
                state.start_velocity.data(), state.plastic_offset.data(),
                state.plastic_travel.data(), state.plastic_work.data(), state.other_work.data(),
                state.velocity.data(), state.residual_max.data(), status.data(),
                step.release.data(), step.residual.data());
            batch_detail::narrow<Scalar>(status, joints, state.status.data() + from);
        }
        time_ += dt;
    }

    /// State of joint i, as OneAxisJoint keeps it, but for the time and the force, which a batch
    /// does not keep: zero. O(1).
    [[nodiscard]] State state(std::size_t i) const noexcept {
        const auto& s = arrays_.state;
        State one;
        one.plastic_offset = s.plastic_offset[i];
        one.plastic_travel = s.plastic_travel[i];
        one.law.plastic_travel = s.plastic_travel[i];
        one.criterion.travel = s.plastic_travel[i];
        one.plastic_work = s.plastic_work[i];
        one.other_work = s.other_work[i];
        one.start_velocity = s.start_velocity[i];
        one.velocity = s.velocity[i];
        one.residual_max = s.residual_max[i];
        one.flowing = is_flowing(s.status[i]);
        one.broken = is_broken(s.status[i]);
        return one;
    }

    [[nodiscard]] Outcome outcome(std::size_t i) const noexcept {
        return outcome_of(arrays_.state.status[i]);
    }

    /// Sum of dt over all steps of this view [s].
    [[nodiscard]] double time() const noexcept { return time_; }
    void set_time(double time) noexcept { time_ = time; }

    /// True in the step in which joint i began to yield.
    [[nodiscard]] bool first_yield(std::size_t i) const noexcept {
        return began_to_yield(arrays_.state.status[i]);
    }
    /// How joint i broke, where it did in the step last committed. Its time is the end of that
    /// step.
    [[nodiscard]] std::optional<FractureEvent<Scalar>> fracture(std::size_t i) const noexcept {
        const auto& s = arrays_.state;
        if (!has_just_broken(s.status[i])) return std::nullopt;
        const Scalar strength = law_.strength()[i] + law_.hardening()[i] * s.plastic_travel[i];
        const Scalar moved = s.start_velocity[i] + s.velocity[i];
        return FractureEvent<Scalar>{.criterion = CriterionKind::plastic_travel,
                                     .time = time_,
                                     .plastic_travel = s.plastic_travel[i],
                                     .absorbed_energy = s.plastic_work[i],
                                     .force = std::copysign(strength, -moved)};
    }

    void restore(std::size_t i, const State& one) noexcept {
        const auto& s = arrays_.state;
        s.plastic_offset[i] = one.plastic_offset;
        s.plastic_travel[i] = one.plastic_travel;
        s.plastic_work[i] = one.plastic_work;
        s.other_work[i] = one.other_work;
        s.start_velocity[i] = one.start_velocity;
        s.velocity[i] = one.velocity;
        s.residual_max[i] = one.residual_max;
        s.status[i] = batch_status(one.broken ? Outcome::broken : Outcome::elastic, one.flowing);
    }

  private:
    batch_detail::StepNumbers<Scalar> numbers(Scalar dt) const noexcept {
        return {.dt = dt,
                .half_dt = dt / 2,
                .drift_rate = 1 / std::max(parameters_.drift_time, 5 * dt),
                .absolute_residual = parameters_.absolute_residual,
                .relative_residual = parameters_.relative_residual,
                .least_travel = parameters_.least_travel};
    }

    Law law_;
    BatchArrays<Scalar> arrays_;
    OneAxisParameters<Scalar> parameters_;
    double time_ = 0; ///< [s]
};

} // namespace ductile
