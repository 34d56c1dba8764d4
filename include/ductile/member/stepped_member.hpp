// SPDX-License-Identifier: MIT
//
// A member through the steps of any engine: which sections its joints are of, what holds on to it,
// what of a step the world asks. The adapter makes bodies and joints, ends them, and says where
// they are, how a step moved them, and what acted on them.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/member/divided_member.hpp"
#include "ductile/member/divisible.hpp"

namespace ductile {

/// `Engine` names the adapter's types:
///   Divisible           as its world sees it
///   Joint, OpenSection  its plastic joints; one that flows, as DividedMember asks
///   Piece               a body of it: has the `body`, its `run`, and whether it is its `own`, not
///                       the user's or the ground
///   Hold                a joint of the user's that holds on
template <class Engine>
class SteppedMember : public DividedMember<typename Engine::OpenSection>, public Engine::Divisible {
    using Base = DividedMember<typename Engine::OpenSection>;

  public:
    using Base::description;
    [[nodiscard]] bool whole() const override { return course_.whole(); }

  protected:
    using OpenSection = typename Engine::OpenSection;
    using Piece = typename Engine::Piece;
    using Base::course_, Base::forces_, Base::joints_;

    /// Of the user's.
    struct Hold : Engine::Hold {
        MemberPlace at;
    };

    explicit SteppedMember(Member member) : Base(std::move(member)) {}
    ~SteppedMember() override = default;

    /// The piece that has a segment.
    [[nodiscard]] const Piece& piece_of(int segment) const {
        return pieces_[course_.piece_of(segment)];
    }
    [[nodiscard]] bool is_open(int section) const {
        return std::any_of(joints_.begin(), joints_.end(),
                           [section](const OpenSection& open) { return open.section == section; });
    }
    /// Where its pieces are, and how they move.
    [[nodiscard]] std::vector<PlacedPiece> placed_pieces() const {
        std::vector<PlacedPiece> all;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            PlacedPiece& piece =
                all.emplace_back(PlacedPiece{&course_.pieces()[i], frame_of(i), {}});
            if (!piece.piece->held) piece.motion = motion_of(i);
        }
        if (whole() && !description().clamped()) {
            all[0].motion.spin =
                times(all[0].piece->inverse_inertia_in_world(all[0].pose.axes), momentum());
        }
        return all;
    }
    /// Those of open sections that have none.
    void make_joints(bool ahead) {
        for (std::size_t i = 0; i + 1 < pieces_.size(); ++i) {
            const int section = pieces_[i].run.last;
            if (is_open(section)) continue;
            const MemberPiece &lower = course_.pieces()[i], &upper = course_.pieces()[i + 1];
            const JointFrame<double> in_upper = upper.section(description(), section + 1, false);
            JointFrame<double> in_lower = lower.section(description(), section, true);
            if (!pieces_[i].own) in_lower = placed(frame_of(i), in_lower); // the ground's
            OpenSection open = make_joint(i, hinge_frame(in_lower), hinge_frame(in_upper));
            go_on(*open.hinge, course_.section(section));
            enter_joint(open, ahead);
            joints_.push_back(std::move(open));
        }
    }
    /// A section that a blow yields, after steps_ and loads_ were read; `strike`: by its contacts.
    void look_blow(double dt, const MemberStrike& strike, std::vector<int>& sections) {
        MemberStrike by_joints;
        for (const Hold& hold : holds_) {
            if (!hold.acts()) continue;
            const Vector3<double> place = point_of(hold.at);
            by_joints.add(hold.side(true, place, dt), hold.side(false, place, dt), hold.at.segment);
        }
        const int section = course_.struck(steps_, loads_, strike, by_joints);
        if (section != no_section) sections.push_back(section);
    }

    std::vector<Piece> pieces_; ///< from its start
    std::vector<Hold> holds_;
    std::vector<PieceStep> steps_; ///< of the last step, by piece
    std::vector<MemberLoad> loads_;

  private:
    // ---- the engine's

    /// Where a piece is, and how one that moves does.
    [[nodiscard]] virtual JointFrame<double> frame_of(std::size_t piece) const = 0;
    [[nodiscard]] virtual BodyMotion motion_of(std::size_t piece) const = 0;
    /// Angular, of the user's body, whose inertia is the user's [N m s].
    [[nodiscard]] virtual Vector3<double> momentum() const = 0;
    /// World [m].
    [[nodiscard]] virtual Vector3<double> point_of(const MemberPlace& at) const = 0;
    /// Its bodies are from now on these.
    virtual void become(const std::vector<PlacedPiece>& pieces, bool ahead) = 0;
    /// Between a piece, or the ground that it is, and the next one.
    [[nodiscard]] virtual OpenSection make_joint(std::size_t lower,
                                                 const JointFrame<double>& in_lower,
                                                 const JointFrame<double>& in_upper) = 0;
    /// It is as its section was, and goes into the world.
    virtual void enter_joint(OpenSection& open, bool ahead) = 0;
    /// What open sections went through was noted.
    virtual void see_open() {}
    /// In the coming step; on a body that does not move nothing.
    virtual void add_force(int segment, const Vector3<double>& force,
                           const Vector3<double>& at) = 0;

    // ---- what the world asks

    [[nodiscard]] int section_of(const typename Engine::Joint& joint) const override {
        for (const OpenSection& open : joints_) {
            if (open.hinge.get() == &joint) return open.section;
        }
        return no_section;
    }
    [[nodiscard]] const void* key_of(int /*section*/) const override {
        return static_cast<const typename Engine::Divisible*>(this);
    }
    [[nodiscard]] double closed_work() const override { return course_.closed_work(); }
    [[nodiscard]] double unmissed_work() const override { return course_.unmissed_work(); }
    void apply_forces() override {
        for (const typename Base::Force& force : forces_) {
            add_force(force.at.segment, force.force, point_of(force.at));
        }
    }
    void drop_forces() override { forces_.clear(); }
    void driven_through() override { course_.doubt(Unmodelled::driven); }
    void begin_blow(double noticed) override { course_.begin_blow(noticed); }
    void over_holds(const typename Engine::Divisible::VisitHold& visit) override {
        for (Hold& hold : holds_) visit(hold);
    }
    void open(std::span<const int> sections, bool ahead) override {
        Base::note_sections();
        become(course_.open(sections, placed_pieces()), ahead);
    }
    double count_vibration() override {
        if (joints_.empty()) return 0;
        Base::note_sections();
        return course_.count_vibration();
    }
    std::vector<int> close_held(Closing when, bool ahead) override {
        if (joints_.empty()) return {};
        Base::note_sections();
        see_open();
        std::vector<int> held = course_.held(when);
        if (!held.empty()) become(course_.close(held, placed_pieces()), ahead);
        return held;
    }
};

} // namespace ductile
