// SPDX-License-Identifier: MIT
//
// What a member is in any engine beside its bodies: its course, the joints of its open sections and
// what it says of both; and what an adapter has to refuse, to look up and to hand over. The adapter
// makes bodies and joints and moves them.
//
// Not thread-safe, but for MemberBook.
#pragma once

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ductile/member/member_course.hpp"
#include "ductile/vocabulary/number_text.hpp"
#include "ductile/world/joint_report.hpp"

namespace ductile {

/// Of the boxes that pieces collide with, along x and y of the member [m], > 0; both 0: there are
/// none.
struct MemberBox {
    double half_width = 0, half_height = 0;

    [[nodiscard]] bool is_there() const noexcept { return half_width > 0; }
    /// @throws std::invalid_argument where one is out of range: as wide as `of` is long.
    void validate(const Member& of) const {
        if (half_width == 0 && half_height == 0) return;
        check::between("Member.box.half_width", half_width, 0.0, of.length(), "m");
        check::between("Member.box.half_height", half_height, 0.0, of.length(), "m");
    }
};

/// @throws std::invalid_argument where `mass` [kg] is another than that of a member that moves.
inline void require_mass(const Member& of, double mass) {
    constexpr double share = 1e-3;
    if (of.clamped() || std::abs(mass - of.mass()) <= share * of.mass()) return;
    check::fail("Member.body.mass", mass, "kg",
                "that of the member, " + number_text(of.mass(), 6) + " kg");
}

/// The frame of the whole member in its body, of mass `mass` [kg] where it moves; `start_in_body`:
/// the member's frame in that of the body's centre of mass.
/// @throws std::invalid_argument where the mass or the centre is another than the member's.
[[nodiscard]] inline JointFrame<double> whole_in_body(const Member& of, const MemberPiece& whole,
                                                      const JointFrame<double>& start_in_body,
                                                      double mass) {
    JointFrame<double> frame = frame_around(start_in_body, whole.section(of, 0, false));
    require_mass(of, mass);
    if (of.clamped()) return frame;
    constexpr double share = 1e-3;
    const double off = norm(frame.origin);
    if (!(off <= share * of.length())) {
        check::fail("Member.start_in_body", off, "m", "0: the member's centre is to be the body's");
    }
    frame.origin.setZero();
    return frame;
}

/// What a World says of a member that is kept from turning `at` a place: nothing where a section is
/// beside it.
[[nodiscard]] inline std::string said_of_fixed(const Member& member, const MemberPlace& at) {
    constexpr double beside = 2e-3; // of its length: by twice that what it bears may be too much
    const double off = member.from_section(at);
    if (!(off > beside * member.length())) return {};
    return "ductile: a member is fixed " + number_text(off, 3) +
           " m from its nearest section, and bears more than its plastic moment there; give it a "
           "section beside the joint (BeamParameters::fixed_end)";
}

/// An engine's hinge turns about z, a member bends about x.
[[nodiscard]] inline JointFrame<double> hinge_frame(const JointFrame<double>& section) {
    JointFrame<double> turned{.origin = section.origin};
    for (int i = 0; i < 3; ++i) {
        turned.axes(i, 0) = section.axes(i, 1);
        turned.axes(i, 1) = section.axes(i, 2);
        turned.axes(i, 2) = section.axes(i, 0);
    }
    return turned;
}

/// A hinge that was just made where its bodies are goes on as its section did.
template <class Hinge>
void go_on(Hinge& hinge, const SectionState& section) {
    typename Hinge::State state = hinge.state();
    const double bend = state.joint.plastic_offset;
    state.joint = section.joint;
    state.joint.plastic_offset = bend;
    hinge.restore(state);
}

/// Members by their bodies, of the whole program. Thread-safe.
template <class EngineMember>
class MemberBook {
  public:
    static MemberBook& all() {
        static MemberBook book;
        return book;
    }
    void enter(const void* body, EngineMember* member) {
        const std::lock_guard lock(mutex_);
        members_[body] = member;
    }
    void leave(const void* body) {
        const std::lock_guard lock(mutex_);
        members_.erase(body);
    }
    /// Null: it belongs to none.
    [[nodiscard]] EngineMember* find(const void* body) {
        const std::lock_guard lock(mutex_);
        const auto found = members_.find(body);
        return found != members_.end() ? found->second : nullptr;
    }

  private:
    std::mutex mutex_;
    std::unordered_map<const void*, EngineMember*> members_;
};

/// `OpenSection`: has the `section` [index] and, by a pointer, the engine's plastic `hinge` there.
template <class OpenSection>
class DividedMember {
    using HingeState = decltype(std::declval<OpenSection>().hinge->state());

  public:
    [[nodiscard]] const Member& description() const noexcept { return course_.member(); }
    [[nodiscard]] bool whole() const noexcept { return course_.whole(); }
    [[nodiscard]] int open_sections() const noexcept { return course_.open_sections(); }
    /// Of a section, accumulated plastic rotation [rad], and how far it is bent now [rad].
    [[nodiscard]] double plastic_rotation(int section) const {
        return state()[std::size_t(section)].joint.plastic_travel;
    }
    [[nodiscard]] double bend(int section) const { return state()[std::size_t(section)].bend; }
    /// By all sections, what blows leave in vibration left out [J].
    [[nodiscard]] double absorbed_energy() const {
        double sum = course_.closed_work() - vibration();
        for (const OpenSection& open : joints_) sum += open.hinge->absorbed_energy();
        if (!joints_.empty()) return sum;
        for (const SectionState& section : course_.state()) { // of one that left its world
            if (section.open) sum += section.joint.plastic_work;
        }
        return sum;
    }
    /// What an elastic member gives back of what its sections took (member/blow.hpp) [J].
    [[nodiscard]] double vibration() const noexcept { return course_.vibration().lost; }
    /// Of its sections; where its bodies are is not in it.
    [[nodiscard]] MemberState state() const {
        MemberState state = course_.state();
        for (const OpenSection& open : joints_) {
            SectionState& section = state[std::size_t(open.section)];
            section.joint = open.hinge->joint().state();
            section.bend = open.hinge->rotation();
        }
        return state;
    }
    /// As an engine's snapshot keeps it. Plain value.
    struct Saved {
        MemberState state;
        MemberVibration vibration;
        RedundantForces redundant;
        std::vector<HingeState> joints; ///< of open sections, from the start
        std::vector<PlacedBody> bodies; ///< by piece
    };
    /// Largest share of what acted on it that was left over in the last step that was looked at
    /// closely (internal_forces.hpp): impulses that it does not know of.
    [[nodiscard]] double left_over() const noexcept { return course_.left_over(); }

  protected:
    /// For the next step.
    struct Force {
        Vector3<double> force; ///< world axes [N]
        MemberPlace at;
    };

    explicit DividedMember(Member member) : course_(std::move(member)) {}
    ~DividedMember() = default;

    /// Of all sections.
    [[nodiscard]] JointReport<double> report() const {
        constexpr double hair = 1e-6; // [rad]; rows that hold move by less
        JointReport<double> all;
        for (const OpenSection& open : joints_) {
            JointReport<double> report = open.hinge->queries().report();
            if (report.outcome == Outcome::yielding && report.plastic_travel > hair &&
                course_.is_locked(open.section)) {
                report.outcome = Outcome::unreliable;
                all.unmodelled = Unmodelled::stretch;
            }
            all.first_yield = all.first_yield || report.first_yield;
            all.coarse = all.coarse || report.coarse;
            all.residual = std::max(all.residual, report.residual);
            all.island_unsolved = std::max(all.island_unsolved, report.island_unsolved);
            all.step_error = std::max(all.step_error, report.step_error);
            all.plastic_travel += report.plastic_travel;
            if (int(report.outcome) > int(all.outcome)) all.outcome = report.outcome;
            if (report.fracture) all.fracture = report.fracture;
        }
        if (course_.unmodelled() != Unmodelled::nothing) {
            all.outcome = Outcome::unreliable;
            all.unmodelled = course_.unmodelled();
        }
        all.absorbed_energy = absorbed_energy();
        all.plastic_travel += course_.closed_travel();
        return all;
    }
    /// Into the course's state what the joints of open sections went through.
    void note_sections() {
        for (const OpenSection& open : joints_) {
            SectionState& section = course_.section(open.section);
            section.joint = open.hinge->joint().state();
            if (!open.hinge->is_awake_member()) section.joint.flowing = false; // not any more
            section.bend = open.hinge->rotation();
        }
    }
    /// With a joint or, where that could not be made, without.
    [[nodiscard]] std::vector<int> all_open() const {
        std::vector<int> all;
        for (int i = 0; i < description().sections(); ++i) {
            if (course_.section(i).open) all.push_back(i);
        }
        return all;
    }
    [[nodiscard]] Saved save(std::vector<PlacedBody> bodies) const {
        Saved saved{state(), course_.vibration(), course_.redundant(), {}, std::move(bodies)};
        for (std::size_t section = 0; section < saved.state.size(); ++section) {
            for (const OpenSection& open : joints_) {
                if (open.section == int(section)) saved.joints.push_back(open.hinge->state());
            }
        }
        return saved;
    }
    /// The adapter then makes its bodies, and calls put_joints_back.
    /// @throws std::invalid_argument where that was of a member of other sections, or a body was
    /// nowhere or moved at no finite velocity.
    void put_back(const Saved& saved) {
        if (saved.state.size() != std::size_t(description().sections())) {
            check::fail("MemberSnapshot.member.sections", double(description().sections()), "",
                        std::to_string(saved.state.size()) + ", as of the member that was saved");
        }
        require_finite("MemberSnapshot", saved.bodies);
        joints_.clear(); // all anew: what follows must not hang on what there is now
        course_.restore(saved.state);
        course_.restore(saved.vibration);
        course_.restore(saved.redundant);
    }
    void put_joints_back(const Saved& saved) {
        for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].hinge->restore(saved.joints[i]);
    }
    /// @throws std::invalid_argument where the place is beyond the ends, the force not finite.
    [[nodiscard]] Force force_at(const Vector3<double>& force, double place) const {
        check::finite("Member.apply_force.force",
                      is_finite(force) ? double(force.cwiseAbs().maxCoeff()) : norm(force), "N");
        return {force, description().on_axis("Member.apply_force.place", place)};
    }
    /// Of its forces, as a piece that is at `pose` has them in a step of `dt` [s].
    [[nodiscard]] MemberLoad load(const Force& force, const JointFrame<double>& pose,
                                  double dt) const {
        const MemberPiece& piece = course_.pieces()[course_.piece_of(force.at.segment)];
        const JointFrame<double> at = placed(pose, piece.segment(force.at.segment));
        return {.segment = force.at.segment,
                .point = sum(at.origin, times(at.axes, force.at.in_segment)),
                .impulse = scaled(dt, force.force)};
    }

    MemberCourse course_;
    std::vector<OpenSection> joints_;
    std::vector<Force> forces_;
};

} // namespace ductile
