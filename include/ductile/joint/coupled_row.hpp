// SPDX-License-Identifier: MIT
//
// One row of a coupled joint: what it did in a step. The rules are those of a one-axis joint
// (one_axis_joint.hpp), but what is life and what breaks is decided for all rows together.
//
// Symbols as in coupled_joint.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/joint/elastic_row.hpp"
#include "ductile/joint/step_error.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// What one row did in a step [J], and how far it flowed [m | rad].
template <std::floating_point S>
struct RowBooking {
    S flow = 0, elastic = 0, damped = 0, other = 0, residual = 0, travel = 0;
    StepError<S> error{};
    bool at_bound = false;
    bool moved = false; ///< a rigid row that goes on from where it is, strained by `strained`
    S strained = 0;     ///< of a rigid row that moved [m | rad]
};

/// A row as its step began.
template <std::floating_point S>
struct OpenRow {
    RowLimits<S> limits; ///< as the solver got them
    S lower, upper;      ///< bounds of the force; those of a given force are narrower [N | N m]
    S share;             ///< of the strength that the bounds allow
    S tolerance;         ///< a force this close to its bound is at it [N | N m]
    S stiffness;         ///< k; infinite: rigid [N/m | N m/rad]
    S rigid_stiffness;   ///< of a rigid row (elastic_row.hpp) [N/m | N m/rad]
    S implicit;          ///< θ of an elastic row
    S start;             ///< u [m/s | rad/s]
    S drift;             ///< as Motion's [m/s | rad/s]
    S noise;             ///< speed below which nothing moves [m/s | rad/s]
    S elastic;           ///< q_e [m | rad]
    S offset;            ///< q_p [m | rad]
    bool ahead;          ///< as Motion's
    SpringRow<S> spring; ///< of an elastic row
    bool may_stop;       ///< it flowed in the last step or was kicked since, and is not at rest

    [[nodiscard]] RowBooking<S> book(const Reaction<S>& reaction, S dt) const noexcept {
        const S f = reaction.force;
        const S near =
            std::min(tolerance, (upper - lower) / 4); // of a narrow row one bound, not both
        const bool at_upper = f >= upper - near, at_lower = f <= lower + near;
        const S travel = (start + reaction.velocity) / 2 * dt;
        const S work = -f * travel;
        const bool rigid = stiffness == std::numeric_limits<S>::infinity();
        RowBooking<S> booked;
        booked.at_bound = at_upper || at_lower;
        if (rigid || limits.lower != limits.upper) {
            const S excess = reaction.velocity + limits.compliance * f * dt - limits.bias;
            booked.residual = at_upper && at_lower ? S(0) // no room: the bounds say all
                              : at_upper           ? std::max(excess, S(0))
                              : at_lower           ? std::max(-excess, S(0))
                                                   : std::abs(excess);
        }
        if (rigid) {
            const S slip = slip_of(f, travel);
            const bool slips = (at_lower && slip > 0) || (at_upper && slip < 0);
            return book_rigid(booked, f, travel, slips, dt);
        }
        const S trial = reaction.position - offset;
        S strained = std::clamp(trial, -upper / (share * stiffness), -lower / (share * stiffness));
        if (ahead && share == 1) { // the bounds are those of the mean force, not of its end
            const S slip = booked.at_bound ? spring.flow(f, reaction.velocity - drift) : S(0);
            strained = slip * f <= 0 ? trial - slip : trial;
        }
        booked.travel = trial - strained;
        booked.elastic = stiffness * (strained * strained - elastic * elastic) / 2;
        booked.damped = spring.damped(reaction.velocity - drift, booked.travel, strained, dt);
        const S rest = work - booked.elastic - booked.damped;
        const S slipped = std::abs(stiffness * strained * booked.travel);
        if (booked.travel != 0) {
            const S by_work = ahead ? S(1) : implicit;
            booked.flow = (1 - by_work) * slipped + by_work * std::max(rest, S(0));
        }
        booked.other = rest - booked.flow;
        booked.error = error_of(booked, f, travel, dt);
        return booked;
    }

    /// The same where the solver met the surface. `flows`: the forces are on it; `slips`: and what
    /// is rigid flows with them; `residual`: of the velocity beyond u' + C f dt = b, what is not
    /// along the normal [m/s | rad/s].
    [[nodiscard]] RowBooking<S> book_on_surface(const Reaction<S>& reaction, S dt, bool flows,
                                                bool slips, S residual) const noexcept {
        const S f = reaction.force;
        const S travel = (start + reaction.velocity) / 2 * dt;
        const S work = -f * travel;
        RowBooking<S> booked;
        booked.at_bound = flows;
        booked.residual = residual;
        if (stiffness == std::numeric_limits<S>::infinity()) {
            return book_rigid(booked, f, travel, slips, dt);
        }
        const S trial = reaction.position - offset;
        booked.travel = flows ? spring.flow(f, reaction.velocity - drift) : S(0);
        // one that is about to break keeps its strain: of its strength the step had but a share
        if (flows && share < 1) booked.travel = trial - elastic;
        const S strained = trial - booked.travel;
        booked.elastic = stiffness * (strained * strained - elastic * elastic) / 2;
        booked.damped = spring.damped(reaction.velocity - drift, booked.travel, strained, dt);
        const S rest = work - booked.elastic - booked.damped;
        const S slipped = -f * booked.travel;
        const S by_work = ahead ? S(0) : implicit;
        // an implicit spring whose strain changes takes this beside what it stores
        const S strain = strained - elastic, lost = stiffness * strain * strain / 2;
        if (flows) booked.flow = (1 - by_work) * slipped + by_work * (rest - lost);
        booked.other = rest - booked.flow;
        booked.error = error_of(booked, f, travel, dt);
        return booked;
    }

    /// Plastic travel of a rigid row that flows under `force`: of what it moved, what does not
    /// strain it [m | rad].
    [[nodiscard]] S slip_of(S force, S travel) const noexcept {
        return holds_strain() ? elastic + travel + force / rigid_stiffness : travel;
    }

  private:
    [[nodiscard]] bool holds_strain() const noexcept {
        return rigid_stiffness < std::numeric_limits<S>::infinity();
    }

    /// `slips`: at its bound, and moving the way that resists.
    [[nodiscard]] RowBooking<S> book_rigid(RowBooking<S> booked, S f, S travel, bool slips,
                                           S dt) const noexcept {
        const S work = -f * travel;
        // a row that stood does not stop: round-off must not decide where it rests
        const bool stops = !booked.at_bound && work > 0 && may_stop;
        // one that turned round within the step moved as it liked
        const bool turned =
            booked.at_bound && !(std::abs(travel) <= 2 * std::abs(f / rigid_stiffness));
        booked.moved = slips || stops || turned;
        booked.at_bound = booked.at_bound && (booked.moved || !holds_strain());
        if (slips || stops) {
            booked.travel = slip_of(f, travel);
            booked.flow = -f * booked.travel;
            // one that holds misplaces nothing
            if (booked.travel != 0) booked.error = error_of(booked, f, travel, dt);
        }
        booked.other = work - booked.flow; // a row may also be driven by the flow of the others
        booked.strained = -f / rigid_stiffness;
        return booked;
    }

    [[nodiscard]] StepError<S> error_of(const RowBooking<S>& booked, S force, S moved,
                                        S dt) const noexcept {
        if (ahead) return {}; // the frame judges its parts
        return step_error<S>({.force = force,
                              .start = start,
                              .travel = moved,
                              .dt = dt,
                              .noise = noise,
                              .strength = std::max(upper, -lower) / share,
                              .stiffness = stiffness,
                              .implicit = implicit,
                              .other_work = booked.other,
                              .flowed = booked.travel != 0});
    }
};

} // namespace ductile
