// SPDX-License-Identifier: MIT
//
// What a world says in one line where joints cannot be relied on: which is the worst, how many
// others there are, and what to do. It is said at the end of the step in which the first one is
// met, and again each time that their number has doubled: never a line for every joint. What helps
// depends on whether steps are frames with a tolerance: those are as short as their budget allows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>

#include "ductile/world/joint_event.hpp"

namespace ductile {

[[nodiscard]] inline const char* unmodelled_warning(Unmodelled what) {
    switch (what) {
        case Unmodelled::stretch:
            return "is beyond its strength between supports that hold it along, where it would "
                   "have to stretch, and stands";
        case Unmodelled::off_plane:
            return "had to bear more than it can along its axis, about it or across the plane in "
                   "which it bends, of which it knows nothing";
        case Unmodelled::rough_blow:
            return "took a blow of which it is not known within 12 % of its energy how much flowed";
        case Unmodelled::driven:
            return "does not move, and a driven body passes through it: the engine solves no "
                   "contacts between them";
        default:
            return "moved as the loads that it knows of do not explain";
    }
}
[[nodiscard]] inline const char* unmodelled_advice(Unmodelled what) {
    switch (what) {
        case Unmodelled::stretch:
            return "let one of its ends slide";
        case Unmodelled::off_plane:
            return "a structure (StructureInTime) yields whichever way it is loaded";
        case Unmodelled::rough_blow:
            return "take what it absorbed as an estimate; shorter segments where it is struck "
                   "(BeamParameters) take less of a light body's blow";
        case Unmodelled::driven:
            return "strike it with a body that has a mass, as large as it may be";
        default:
            return "push it by its apply_force or apply, hold it by attach, and leave its bodies "
                   "the masses that it gave them";
    }
}
[[nodiscard]] inline std::string unreliable_warning(const JointEvent<double>& event) {
    std::ostringstream line;
    if (event.report.unmodelled != Unmodelled::nothing) {
        line << unmodelled_warning(event.report.unmodelled) << " (t = " << event.time << " s)";
    } else if (!(event.report.residual <= std::numeric_limits<double>::max())) {
        line << "was shown numbers that are not finite at t = " << event.time
             << " s, and keeps its state";
    } else if (event.report.unseen_turn > 0) {
        line << "turned by " << event.report.unseen_turn
             << " rad in the step that ended at t = " << event.time
             << " s, which its engine or its angle cannot follow";
    } else if (event.report.gained > 0) {
        line << "has given its bodies " << event.report.gained
             << " J more than it took, at t = " << event.time << " s";
    } else if (event.report.island_unsolved > event.report.residual) {
        line << "hangs together with contacts or joints that were left unsolved by the solver at t "
                "= "
             << event.time << " s (off by " << event.report.island_unsolved << " m/s or rad/s)";
    } else {
        line << "was left unsolved by the solver at t = " << event.time << " s (off by "
             << event.report.residual << " m/s or rad/s)";
    }
    return line.str();
}
[[nodiscard]] inline const char* coarse_advice(const JointEvent<double>& /*event*/,
                                               bool in_frames) {
    return in_frames ? "give a frame more solves (budget), or take shorter frames"
                     : "take shorter steps, or let the World do so (tolerance)";
}
[[nodiscard]] inline const char* unreliable_advice(const JointEvent<double>& event,
                                                   bool in_frames) {
    const JointReport<double>& report = event.report;
    if (report.unmodelled != Unmodelled::nothing) return unmodelled_advice(report.unmodelled);
    if (!(report.residual <= std::numeric_limits<double>::max())) {
        return "look for what moved or pushed its bodies so";
    }
    const bool unsolved = !(report.unseen_turn > 0) && !(report.gained > 0);
    if (!unsolved) return coarse_advice(event, in_frames);
    if (report.island_unsolved > report.residual) {
        return in_frames ? "shorter frames do not help: look for bodies that are jammed, or masses "
                           "more than 1e4 times apart"
                         : "take shorter steps, or let the World do so (tolerance); where neither "
                           "helps, look for bodies that are jammed";
    }
    return in_frames ? "shorter frames do not help: look for joints that hold the same bodies "
                       "against each other, or strengths more than 1e4 times apart"
                     : "take shorter steps, or let the World do so (tolerance); where neither "
                       "helps, look for joints that hold the same bodies against each other";
}

[[nodiscard]] inline std::string coarse_warning(const JointEvent<double>& event) {
    std::ostringstream line;
    if (event.report.borne > 0) {
        line << "bore a blow of up to " << event.report.borne
             << " J, to which it should have yielded, within one step that ended before t = "
             << event.time << " s";
        return line.str();
    }
    line << "moved too much in the step that ended at t = " << event.time
         << " s: its plastic travel may be off by " << 100 * event.report.step_error << " %";
    return line.str();
}

/// Of one kind of event. Not thread-safe.
class JointWarning {
  public:
    using Words = std::string (*)(const JointEvent<double>&);

    using Advice = const char* (*)(const JointEvent<double>&, bool in_frames);

    JointWarning(Words words, Advice advice) : words_(words), advice_(advice) {}

    /// Each joint once.
    void add(const JointEvent<double>& event) {
        if (since_++ == 0 || badness(event) > badness(worst_)) worst_ = event;
        ++joints_;
    }
    /// At the end of a step: whether the line is to be said. Until the next time it is due it
    /// counts from here.
    [[nodiscard]] bool due() noexcept {
        if (since_ == 0 || 2 * since_ < joints_) return false;
        since_ = 0;
        return true;
    }
    /// Of the worst joint since the line before; `in_frames`: steps are frames with a tolerance.
    [[nodiscard]] std::string line(bool in_frames) const {
        std::string text = "ductile: joint \"" + worst_.name + "\" " + words_(worst_);
        if (joints_ > 1) {
            text += ", and " + std::to_string(joints_ - 1) + (joints_ > 2 ? " others" : " other");
        }
        return text + "; " + advice_(worst_, in_frames);
    }

  private:
    /// NaN is the worst.
    [[nodiscard]] static double badness(const JointEvent<double>& event) noexcept {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const JointReport<double>& report = event.report;
        const double off = event.kind == EventKind::coarse
                               ? report.step_error
                               : std::max(report.residual, report.island_unsolved);
        return off <= infinity ? off : infinity;
    }

    Words words_;
    Advice advice_;
    JointEvent<double> worst_;
    std::size_t joints_ = 0, since_ = 0; ///< of them all; since the line before
};

} // namespace ductile
