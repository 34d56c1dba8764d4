// SPDX-License-Identifier: MIT
//
// What a joint of any kind and engine says of the step just done.
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <string>

#include "ductile/fracture/event.hpp"
#include "ductile/joint/joint_totals.hpp"
#include "ductile/vocabulary/finite.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// What a member or a structure met that its description knows nothing of.
enum class Unmodelled : unsigned char {
    nothing,
    stretch,    ///< a member would flow that nothing lets stretch (member/member_course.hpp)
    off_plane,  ///< more along, about or across a member than it bears, but bending about its x
    rough_blow, ///< of a blow it is known roughly what flowed of it (member/blow.hpp)
    driven,     ///< what does not move of it and a driven body passed through each other
    forces      ///< it went as no load that it was told of explains
};

/// Plain value, of one joint after one step.
template <std::floating_point S>
struct JointReport {
    Outcome outcome = Outcome::elastic;
    bool first_yield = false; ///< it flowed in this step for the first time
    bool coarse = false;      ///< steps were too long for it: step_error.hpp, borne_blow.hpp
    S residual = 0;           ///< worst violation of any of its rows, as Step::residual
    /// By how much something else that was solved with it was missed, such as a contact of its
    /// body, where that is left unsolved, else 0 [m/s | rad/s].
    S island_unsolved = 0;
    S unseen_turn = 0; ///< turn of the step, where the joint could not follow it, else 0 [rad]
    S gained = 0; ///< energy given beyond all that was taken, where too much to be believed [J]
    S borne = 0;  ///< the most of a blow that a step just bore, where it is coarse by that [J]
    Unmodelled unmodelled = Unmodelled::nothing; ///< of a member or a structure
    S plastic_travel = 0;                        ///< p [m | rad]
    S absorbed_energy = 0;                       ///< D [J]
    S step_error = 0;  ///< share of p that the steps so far may have misplaced [-]
    S after_break = 0; ///< where it broke in this step: time of it that was left then [s]
    std::optional<FractureEvent<S>> fracture{}; ///< once it is broken
};

/// Report of a joint of the core after a step of it.
/// @param outcome         of all rows, rigid ones included
/// @param rigid_residual  worst of the rigid rows [m/s | rad/s]
template <std::floating_point S>
[[nodiscard]] JointReport<S> joint_report(const JointTotals<S>& totals, const Step<S>& last,
                                          const std::optional<FractureEvent<S>>& fracture,
                                          Outcome outcome, S rigid_residual) noexcept {
    return {.outcome = totals.broken ? Outcome::broken : outcome,
            .first_yield = last.first_yield,
            .coarse = last.coarse,
            .residual = worse(last.residual, rigid_residual),
            .gained = last.gained,
            .plastic_travel = totals.plastic_travel,
            .absorbed_energy = totals.plastic_work,
            .step_error = last.step_error,
            .after_break = last.after_break,
            .fracture = fracture};
}

/// Report of a joint that the engine left out of the step: it did nothing. A broken one stays so,
/// and still says whether it yielded in its last step.
template <std::floating_point S>
[[nodiscard]] JointReport<S> idle_report(JointReport<S> last) noexcept {
    last.residual = last.island_unsolved = 0;
    last.unseen_turn = 0;
    last.gained = last.borne = 0;
    last.coarse = false;
    if (last.outcome == Outcome::broken) return last;
    last.first_yield = false;
    last.outcome = Outcome::elastic;
    return last;
}

/// Of what may open: under which key it is reported, as what, how it went.
struct DivisionReport {
    const void* key;
    std::string name;
    std::function<JointReport<double>()> ask;
};

} // namespace ductile
