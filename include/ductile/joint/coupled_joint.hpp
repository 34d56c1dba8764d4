// SPDX-License-Identifier: MIT
//
// Up to six plastic axes that share one yield surface: a joint that bends about two axes, twists,
// shears and stretches, and flows in all of them together.
//
//   before the solve   prepare(motion, dt)   -> one RowLimits per axis
//   after the solve    commit(reaction, dt)  -> CoupledStep
//
// Symbols (vectors with one entry per axis of the surface; "x | y": translational | rotational
// axis)
//   q, q_p, q_e  position, plastic rest position, elastic part q - q_p      [m | rad]
//   u, u'        velocity at the start and end of the step                  [m/s | rad/s]
//   f            forces of the rows over the step, λ/dt                     [N | N m]
//   M            effective mass of the rows, (J m⁻¹ Jᵀ)⁻¹                   [kg | kg m²]
//   γ            gauge of the surface, 1 where it flows                     [-]
//   p            equivalent plastic travel, dp = dD/R(p)                    [m | rad of the law]
//   D            dissipated work                                            [J]
//
// Rows. The surface is mapped onto a box of independent bounds around the force predicted for this
// step (row_box.hpp, where the error is measured); it grows with the law, γ(f) R(0)/R(p) <= 1. Each
// row is rigid or elastic as that of a one-axis joint, whose account and certificate these are.
// Where the section's stiffness is known a rigid row is a spring a million times as stiff, with a
// damper: what strains it is no flow, and near its limit load a redundant structure does not creep.
//
// Finite rotation: angular entries of q are sums of rotation increments (rotation.hpp), without
// wrap.
//
// Break. Life is counted by p, and by the way along axes that have a limit (axis_life.hpp). Bounds
// are lowered as those of one axis; excess is CoupledStep::release, along the step's direction. A
// criterion's cap bounds the equivalent force γ R(0): met before yield, it breaks without flow.
//
// Limit cases: one axis is OneAxisJoint; independent axes are as many of them with one life.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <utility>

#include "ductile/fracture/event.hpp"
#include "ductile/fracture/fracture.hpp"
#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/axis_life.hpp"
#include "ductile/joint/coupled_row.hpp"
#include "ductile/joint/coupled_state.hpp"
#include "ductile/joint/elastic_row.hpp"
#include "ductile/joint/mean_flow.hpp"
#include "ductile/joint/remaining_travel.hpp"
#include "ductile/joint/step_end.hpp"
#include "ductile/law/law.hpp"
#include "ductile/numeric/small_vector.hpp"
#include "ductile/surface/grown.hpp"
#include "ductile/surface/impedance.hpp"
#include "ductile/surface/row_box.hpp"
#include "ductile/surface/stopping_force.hpp"
#include "ductile/surface/surface.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// Not thread-safe: one joint belongs to one thread at a time. After construction nothing allocates
/// or throws. Cost of a step with six rigid rows on an ellipsoid: 0.13 µs where it holds, 0.7 µs
/// where all flow; elastic rows 0.2 to 0.4 µs more, surfaces without closed chords some µs.
template <YieldSurface Surface, StrengthLaw Law,
          FractureCriterion Criterion = TravelLimit<typename Surface::Scalar>>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
class CoupledJoint {
  public:
    using Scalar = typename Surface::Scalar;
    static constexpr int dimension = Surface::dimension;
    using Vector = typename Surface::Vector;
    using Matrix = typename Surface::Matrix;
    using Rows = std::array<RowLimits<Scalar>, std::size_t(dimension)>;
    using Motion = CoupledMotion<Scalar, dimension>;
    using Reaction = CoupledReaction<Scalar, dimension>;
    using Step = CoupledStep<Scalar, dimension>;
    using State = CoupledState<Scalar, dimension, typename Criterion::State>;
    using Parameters = CoupledParameters<Scalar, dimension>;

    /// `law`: strength over the equivalent travel, in the unit of the axis it is told for; the
    /// surface is that at R(0).
    /// @throws std::invalid_argument where a parameter is out of range.
    explicit CoupledJoint(Surface surface, Law law, Criterion criterion = Criterion(),
                          Parameters parameters = {})
        : surface_(std::move(surface)),
          law_(std::move(law)),
          criterion_(std::move(criterion)),
          parameters_(std::move(parameters)),
          lives_(parameters_.largest_travel) {
        parameters_.validate();
        for (int i = 0; i < dimension; ++i) {
            all_rigid_ = all_rigid_ && rigid(i);
            holds_strain_ = holds_strain_ && std::isfinite(parameters_.section_stiffness[i]);
        }
        first_strength_ = check::positive("CoupledJoint.law.value(0)", law_.value(0), "N or N m");
    }

    [[nodiscard]] const Surface& surface() const noexcept { return surface_; }
    [[nodiscard]] const Law& law() const noexcept { return law_; }
    [[nodiscard]] const Criterion& criterion() const noexcept { return criterion_; }
    [[nodiscard]] const Parameters& parameters() const noexcept { return parameters_; }
    [[nodiscard]] const State& state() const noexcept { return state_; }
    void restore(const State& state) noexcept { state_ = state; }
    /// The velocity that the step left, seen along the axes as they are now: not a jump [m/s |
    /// rad/s].
    void carry(const Vector& u) noexcept { state_.velocity = is_finite(u) ? u : state_.velocity; }

    /// γ of the last step's forces on the present surface: 1 where it flows, or snaps [-].
    [[nodiscard]] Scalar utilisation() const noexcept {
        const Scalar most = std::min(growth(), cap());
        return state_.broken ? Scalar(0) : surface_.value(state_.force) / most;
    }
    /// It snaps before it flows.
    [[nodiscard]] bool snaps() const noexcept { return cap() < growth(); }
    /// What broke the joint, or is the nearest to do so.
    [[nodiscard]] CriterionKind governing() const noexcept {
        const bool ended = state_.broken && faded(law_, state_.plastic_travel);
        if (ended) return CriterionKind::exhausted_strength;
        return state_.life > criterion_.damage(state_.criterion)
                   ? CriterionKind::plastic_travel
                   : criterion_.governing(state_.criterion);
    }
    /// How the joint broke; nothing while it is intact. The axis is the one that did most of the
    /// breaking step's plastic work, or in a brittle break has the largest share of γ; the travel
    /// is the equivalent one.
    [[nodiscard]] std::optional<FractureEvent<Scalar>> fracture() const noexcept {
        if (!state_.broken) return std::nullopt;
        return FractureEvent<Scalar>{.axis = std::size_t(state_.broken_axis),
                                     .criterion = governing(),
                                     .time = state_.time,
                                     .plastic_travel = state_.plastic_travel,
                                     .absorbed_energy = state_.plastic_work,
                                     .released_energy = state_.lost,
                                     .force = state_.force[state_.broken_axis]};
    }

    /// Of the step that `prepare` opened: the forces are admissible where the gauge of the surface
    /// is at most this [-].
    [[nodiscard]] Scalar reach() const noexcept { return cap_ < grown_ ? cap_ : grown_ * share_; }
    /// Rules the rows for a step of `dt` > 0 [s]; no force once broken, or where `motion` is not
    /// finite.
    [[nodiscard]] Rows prepare(const Motion& motion, Scalar dt) noexcept;

    /// Rules them anew for a solver that meets the surface itself, not the bounds. Nothing where
    /// that cannot be, as the step gives the force of a row. `passes`: no force of the surface
    /// stops it in this step, so that rigid rows too flow along the normal with their mean
    /// velocity.
    [[nodiscard]] std::optional<Rows> meet_surface(Scalar dt, bool passes = false) noexcept;

    /// Books the step that `prepare` opened; same `dt` [s]. `granted`: of its flow
    /// (work_share.hpp). Not finite: see Step::residual.
    Step commit(const Reaction& reaction, Scalar dt, Scalar granted = 1) noexcept;

  private:
    /// What all rows together did in a step.
    struct Taken {
        Vector force;     ///< f; once the step has broken the joint, that just before [N | N m]
        Scalar flow = 0;  ///< that is booked [J]
        Scalar asked = 0; ///< all of it [J]
        StepError<Scalar> error{};
        int axis = 0; ///< that did most of it
        Eigen::Array<bool, dimension, 1> at_bound = Eigen::Array<bool, dimension, 1>::Zero();
    };

    static constexpr Scalar bound_tolerance = Scalar(4e-6); // as OneAxisJoint

    [[nodiscard]] bool rigid(int i) const noexcept { return std::isinf(parameters_.stiffness[i]); }

    [[nodiscard]] Scalar rigid_stiffness_of(int i) const noexcept {
        return rigid_stiffness<Scalar> * parameters_.section_stiffness[i];
    }

    /// R of flow by the coming `travel`, softened by the criterion [N | N m].
    [[nodiscard]] Scalar mean_strength_of(Scalar travel) const noexcept {
        const Scalar from = state_.plastic_travel;
        const auto at = [&](Scalar way) noexcept { return law_.value(from + way); };
        return mean_strength(law_, from, from + travel) *
               mean_factor(criterion_, state_.criterion, travel, at);
    }
    /// R/R(0) now.
    [[nodiscard]] Scalar growth() const noexcept { return mean_strength_of(0) / first_strength_; }

    void bound(const Motion& motion, Scalar dt) noexcept {
        using Met = Impedance<Scalar, dimension>;
        Vector compliance;
        for (int i = 0; i < dimension; ++i) {
            const Scalar lead = ahead_ ? spring(i, dt).lead : dt + damping(i);
            compliance[i] = 1 / (parameters_.stiffness[i] * lead * dt);
        }
        const Met impedance = all_rigid_ ? Met(motion.mass, dt) : Met(motion.mass, dt, compliance);
        const Grown<Surface> now{surface_, growth()};
        // an elastic row starts from its spring: a resolved one acts a step late, and a box around
        // its last force would let it follow at half the rate
        Vector predicted = state_.force;
        for (int i = 0; i < dimension; ++i) {
            if (!rigid(i)) predicted[i] = -parameters_.stiffness[i] * spring(i, dt).reach;
        }
        predicted = stopping_force(predicted, start_, state_.start_velocity, impedance);
        const Scalar use = now.value(predicted);
        if (ahead_ && use > 1) { // it passes: see meet_surface
            Vector passing = start_;
            for (int i = 0; i < dimension; ++i) {
                if (!rigid(i)) passing[i] = 0;
            }
            predicted -= impedance * passing;
        }
        // a joint that will hold needs neither a projection nor the matrix for it, only its chords
        if (use > 1 + on_surface<Scalar>) predicted = now.project(predicted, impedance.shape());
        const bool flows = use >= 1 - bound_tolerance;
        will_flow_ = flows;
        const Scalar rate = flows ? dt / (first_strength_ * now.by) : Scalar(0);
        const Scalar power = std::abs(numeric::dot(predicted, start_));
        if constexpr (requires { surface_.semi_axes(); }) {
            if (flows && ahead_ && !parameters_.stiffness.allFinite()) // of rigid rows alone
                passing_ = flow_at_start(surface_, predicted, start_, motion.mass, dt);
        }
        const Scalar before = std::abs(numeric::dot(predicted, state_.start_velocity));
        const Scalar after = std::abs(numeric::dot(predicted, state_.velocity));
        const Scalar least = travel_ahead(power, before, after, state_.flowing, rate);
        const bool fades = ExhaustibleLaw<Law> && state_.flowing; // where a slope may be steep
        const Scalar ahead = fades ? least : power * rate;
        left_ = travel_to_break(criterion_, state_.criterion, ahead, Scalar(0),
                                [&](Scalar way) noexcept { return mean_strength_of(way); });
        left_ = std::min(left_, travel_to_nothing(law_, state_.plastic_travel));
        if (flows && lives_.limited()) { // along the normal a travel of one has the work R
            const Scalar life = lives_.of(first_strength_ * surface_.normal(predicted));
            left_ = std::min(left_, travel_left(Scalar(1), life, state_.life));
        }
        grown_ = flows ? mean_strength_of(std::min(ahead, left_)) / first_strength_ : now.by;
        share_ = unspent_share(left_, least);
        cap_ = cap();
        const bool capped = cap_ <= grown_ * share_;
        if (capped) share_ = 1; // the cap is met before the travel left is used up
        const Grown<Surface> reached{surface_, capped ? cap_ : grown_};
        const auto box = box_along(reached, Vector(predicted * (grown_ / now.by)));
        lower_ = box.lower * share_;
        upper_ = box.upper * share_;
        tolerance_ = bound_tolerance * std::max(numeric::largest(upper_), numeric::largest(lower_));
    }

    [[nodiscard]] RowLimits<Scalar> row(int i, Scalar dt) const noexcept;

    /// τ; the springs of steps as they are lose more than steel by themselves.
    [[nodiscard]] Scalar damping(int i) const noexcept {
        return ahead_ ? std::max(parameters_.damping_time[i], damping_) : damping_;
    }
    [[nodiscard]] SpringRow<Scalar> spring(int i, Scalar dt) const noexcept {
        using Spring = SpringRow<Scalar>;
        const Scalar k = parameters_.stiffness[i];
        return ahead_ ? Spring::half_ahead(k, damping(i), elastic_[i], middle_[i], mass_[i],
                                           start_[i], dt)
                      : Spring::now(k, damping(i), elastic_[i], implicit_[i], dt);
    }

    /// `jump`: a change of velocity between the steps by more is somebody's [m/s | rad/s].
    [[nodiscard]] OpenRow<Scalar> open_row(int i, Scalar jump, Scalar dt) const noexcept {
        const bool jumped = std::abs(start_[i] - state_.velocity[i]) > jump;
        return {.limits = rows_[std::size_t(i)],
                .lower = lower_[i],
                .upper = upper_[i],
                .share = share_,
                .tolerance = tolerance_,
                .stiffness = parameters_.stiffness[i],
                .rigid_stiffness = rigid_stiffness_of(i),
                .implicit = implicit_[i],
                .start = start_[i],
                .drift = drift_[i],
                .noise = parameters_.absolute_residual,
                .elastic = elastic_[i],
                .offset = state_.plastic_offset[i],
                .ahead = ahead_,
                .spring = spring(i, dt),
                .may_stop = (state_.flowing || jumped) &&
                            std::abs(start_[i]) > parameters_.absolute_residual};
    }

    /// True of a rigid joint of a known section that what it moved strains, and no more.
    [[nodiscard]] bool stands(const Reaction& reaction, Scalar dt) const noexcept;

    /// Of the velocities beyond u' + C f dt = b: where the joint flows, what is not along the
    /// normal.
    [[nodiscard]] Vector off_normal(const Reaction& reaction, bool flows, Scalar dt) const noexcept;

    [[nodiscard]] Scalar allowed_residual(const Vector& velocity) const noexcept {
        const Scalar speed = std::max(numeric::largest(start_), numeric::largest(velocity));
        return parameters_.absolute_residual + parameters_.relative_residual * speed;
    }

    /// That of the parameters, or the equivalent of the elastic rows' energy at yield.
    [[nodiscard]] Scalar least_travel() const noexcept {
        if (all_rigid_) return parameters_.least_travel;
        return parameters_.yield_energy(upper_.cwiseMax(-lower_)) / (first_strength_ * grown_);
    }

    /// γ at which it snaps.
    [[nodiscard]] Scalar cap() const noexcept {
        return criterion_.force_cap(state_.criterion, 0) / first_strength_;
    }

    /// The forces at `time` of a step of springs that did not flow.
    [[nodiscard]] Vector force_at(Scalar time, const Reaction& reaction, Scalar dt) const noexcept;

    /// When the forces reached the cap, at the mean, at the end of the step or where they turned
    /// round within it [s]; longer than the step: they did not.
    [[nodiscard]] Scalar snapped(const Reaction& reaction, Scalar dt) const noexcept;

    /// Breaks without flow at `time`: what the rows took beyond their elastic energy is handed
    /// back.
    void snap(Step& step, Taken& taken, const Reaction& reaction, Scalar time, Scalar dt) noexcept;

    /// Uses up life for the work of flow of all rows together.
    void flow(Step& step, Taken& taken, const Reaction& reaction, Scalar dt) noexcept;
    /// Equivalent travel of what its rows moved, whatever force they had.
    [[nodiscard]] Scalar way_of(const Reaction& reaction, Scalar dt) const noexcept {
        const Vector moved = (start_ + reaction.velocity) * (dt / 2);
        return numeric::dot(surface_.support(moved), moved) / first_strength_;
    }

    /// Of the work of springs that reached the surface within the step: what they lacked of it
    /// until then, by the chord of their forces (1 - γ)/2 τ of it, γ the gauge they began with, τ
    /// the share of their way until they met it [J].
    [[nodiscard]] Scalar missed_onset(const Reaction& reaction, Scalar dt) const noexcept;

    /// The joint broke after the equivalent `travel` of this step.
    void end_after(Step& step, Taken& taken, const Reaction& reaction, Scalar travel,
                   Scalar dt) noexcept;

    Surface surface_;
    Law law_;
    Criterion criterion_;
    Parameters parameters_;
    AxisLife<Scalar, dimension> lives_;
    Scalar first_strength_ = 0; ///< R(0)
    bool all_rigid_ = true;     ///< no row is elastic
    bool holds_strain_ = true;  ///< the section's stiffness is known of all rows
    State state_;

    // between prepare and commit
    bool sound_ = true; ///< the input of `prepare` was finite
    Rows rows_{};
    Vector start_ = Vector::Zero(), elastic_ = Vector::Zero(); ///< u, q_e at the start
    Vector middle_ = Vector::Zero();                           ///< q_e where the rows are solved
    Vector passing_ = Vector::Zero();                          ///< u where they flow by their mean
    Vector lower_ = Vector::Zero(), upper_ = Vector::Zero();   ///< bounds of the forces
    Vector implicit_ = Vector::Ones();                         ///< θ of the elastic rows
    Scalar grown_ = 1, tolerance_ = 0; ///< R/R(0) of this step; this close to a bound is at it
    Scalar left_ = 0,
           share_ = 1;       ///< travel left before a break; of the strength, what bounds allow
    Scalar cap_ = 0;         ///< γ of a brittle break
    bool ahead_ = false;     ///< Motion::ahead
    bool will_flow_ = false; ///< as predicted
    bool passes_ = false;    ///< as meet_surface was told
    Scalar turning_ = 0, damping_ = 0; ///< Motion's
    Vector drift_ = Vector::Zero();    ///< Motion's
    Vector mass_ = Vector::Zero();     ///< of each row, the others held
};
} // namespace ductile

#include "ductile/joint/coupled_joint.ipp" // IWYU pragma: export
