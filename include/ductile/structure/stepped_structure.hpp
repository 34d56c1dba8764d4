// SPDX-License-Identifier: MIT
//
// A structure that is as few bodies as its yielding joints need, through the steps of any engine:
// which bodies it becomes, what joints and forces load it, what of the user's holds on to it, when
// it is proved that it rests. The adapter makes bodies and joints, ends them, and says where they
// are, how a step moved them, and what contacts and joints gave them.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/member/divisible.hpp"
#include "ductile/structure/divided_structure.hpp"
#include "ductile/vocabulary/number_text.hpp"

namespace ductile {

/// @throws std::logic_error where a body of a structure is no more as that made it: of mass `made`
/// [kg], 0: it stands.
inline void require_body(double made, double mass, bool kinematic) {
    constexpr double share = 1e-3;
    if (!kinematic && std::abs(mass - made) <= share * made) return;
    throw std::logic_error(
        "StructureInTime.bodies: must move as they did when they were made, with " +
        number_text(made, 6) + " kg");
}

/// `Engine` names the adapter's types:
///   Divisible         as its world sees it
///   Joint, OpenJoint  its plastic joints; one that flows, as DividedStructure asks
///   Body, Piece       how it names a body, null: none; one that the structure made and keeps
///   Hold, Holder      a joint of the user's that holds on; what the user gives for it
///   Touches           contacts that act on it in a step
///   body(piece)       of it
///   is_asleep(touch)  nothing solved it in the step
template <class Engine>
class SteppedStructure : public DividedStructure<typename Engine::OpenJoint>,
                         protected Engine::Divisible {
    using Base = DividedStructure<typename Engine::OpenJoint>;

  public:
    using Base::plan;
    [[nodiscard]] bool whole() const override { return course_.whole(); }
    /// `holder`, of a body of it, holds at a node, or at `share` of a member's axis, of the
    /// structure as it was made, now and whenever bodies change. To be called between steps.
    /// @throws std::invalid_argument as place(), and where the node is the ground's or the holder
    /// none.
    void attach(NodeId node, typename Engine::Holder holder) {
        hold_on(Base::hold_at(Base::point(node)), std::move(holder));
    }
    void attach(std::string_view member, double share, typename Engine::Holder holder) {
        hold_on(Base::hold_at(Base::point(member, share)), std::move(holder));
    }

  protected:
    using OpenJoint = typename Engine::OpenJoint;
    using Body = typename Engine::Body;
    using Piece = typename Engine::Piece;
    using Change = StructureCourse::Change;
    using Base::course_, Base::forces_, Base::joints_, Base::placed_clusters, Base::place_of,
        Base::point_of, Base::stands_on_ground;

    /// Of the user's.
    struct Hold : Engine::Hold {
        StructureHold at;
    };

    /// @throws std::invalid_argument as make_plan and StructureCourse.
    explicit SteppedStructure(const StructureModel& model) : Base(model) {}
    ~SteppedStructure() override = default;

    // ---- its bodies

    [[nodiscard]] bool held(std::size_t cluster) const { return course_.clusters()[cluster].held; }
    [[nodiscard]] Body body(std::size_t cluster) const { return Engine::body(pieces_[cluster]); }
    [[nodiscard]] Body body(const StructureHold& hold) const {
        return body(course_.cluster_of(hold.body));
    }
    /// By its number from the member's start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] Body body(std::string_view member, std::size_t piece) const {
        return body(course_.cluster_of(Base::present_body(plan().body(member, piece))));
    }
    /// Which of them a body is; how many there are: none.
    template <class Named>
    [[nodiscard]] std::size_t cluster_on(const Named* body) const {
        return std::size_t(
            std::find_if(pieces_.begin(), pieces_.end(),
                         [body](const Piece& piece) { return Engine::body(piece) == body; }) -
            pieces_.begin());
    }
    void make_pieces() {
        for (std::size_t c = 0; c < course_.clusters().size(); ++c) {
            pieces_.push_back(make_piece(c, {}));
        }
        Base::made();
    }
    void end_pieces() {
        for (Piece& piece : pieces_) end_piece(piece);
        pieces_.clear();
    }
    void become(const Change& change, bool ahead) override {
        proved_.reset();
        Base::end_joints(change); // before their bodies do
        std::vector<Piece> old = std::exchange(pieces_, {});
        const Body like = old.empty() ? Body{} : Engine::body(old.front());
        for (std::size_t c = 0; c < change.kept.size(); ++c) {
            pieces_.push_back(change.kept[c] ? std::exchange(old[*change.kept[c]], {})
                                             : make_piece(c, like));
        }
        hand_over(); // before their bodies end
        std::erase_if(holds_, [this](const Hold& hold) { return !course_.has_body(hold.at.body); });
        for (Piece& piece : old) {
            if (Engine::body(piece) != Body{}) end_piece(piece);
        }
        hold_again();
        make_joints(ahead);
        meet();
    }

    // ---- what of the user's holds on to it

    /// Of the plan, where both are there: bodies of two clusters that meet at a node.
    template <class Visit>
    void over_neighbours(const Visit& visit) const {
        for (const auto& pair : plan().neighbours) {
            if (!course_.has_body(pair.first) || !course_.has_body(pair.second)) continue;
            visit(body(course_.cluster_of(pair.first)), body(course_.cluster_of(pair.second)));
        }
    }

    // ---- a step

    void begin_step() {
        course_.begin_step();
        Base::driven_through_ = false;
    }
    /// False: it stays as it is, that is proved.
    [[nodiscard]] bool is_unproved(const Vector3<double>& gravity) const {
        if (!proved_ || *proved_ != gravity || proved_acting_ != acting() || !rests()) return true;
        for (std::size_t c = 0; c < pieces_.size(); ++c) {
            if (was_solved(c)) return true;
        }
        return false;
    }
    /// As Divisible's find_beyond and find_struck, by all that acted.
    void look(double dt, const Vector3<double>& gravity, std::vector<int>& sections) {
        read(dt, gravity);
        sections = course_.beyond(steps_, loads_, dt);
        proved_.reset();
        proved_acting_ = acting();
        if (sections.empty() && joints_.empty() && rests()) proved_ = gravity;
    }
    void look_blow(double dt, const Vector3<double>& gravity, std::vector<int>& sections) {
        proved_.reset();
        read(dt, gravity);
        MemberStrike by_joints;
        for (const Hold& hold : holds_) {
            if (!hold.acts()) continue;
            const Vector3<double> place = point_of(hold.at);
            by_joints.add(hold.side(true, place, dt), hold.side(false, place, dt), 0);
        }
        const double more = by_joints.energy > noticed_ ? by_joints.energy : 0.0;
        sections = course_.struck(steps_, loads_, by_touches_ + more);
    }
    /// About the centre of its cluster's body, for `dt` [s].
    void add_load(std::size_t body, const Wrench& wrench, double dt) {
        loads_.push_back({body, steps_[course_.cluster_of(body)].pose.origin,
                          scaled(dt, wrench.force), scaled(dt, wrench.torque)});
    }

    // ---- what the world asks

    void drop_forces() override { forces_.clear(); }
    void apply_forces() override {
        for (const typename Base::Force& force : forces_) {
            const std::size_t c = course_.cluster_of(force.body);
            if (held(c)) continue;
            const JointFrame<double> at = Base::frame_of({PlanSeat::Kind::body, force.body});
            add_force(c, force.force, sum(at.origin, times(at.axes, force.in_body)));
        }
    }

    std::vector<Piece> pieces_; ///< by cluster
    std::vector<Hold> holds_;
    typename Engine::Touches touches_{};    ///< of a step
    std::vector<ClusterStep> steps_;        ///< of the last one, by cluster
    std::vector<BodyLoad> loads_;           ///< of it
    std::optional<Vector3<double>> proved_; ///< gravity under which it stays as it is [m/s²]
    bool left_ = false;                     ///< the world

  private:
    // ---- the engine's

    /// In the world, where the course has it made, with the manners of `like`, none: its own.
    [[nodiscard]] virtual Piece make_piece(std::size_t cluster, Body like) = 0;
    virtual void end_piece(Piece& piece) = 0;
    /// Between clusters a and b, none: the ground.
    [[nodiscard]] virtual OpenJoint make_joint(std::size_t joint, std::size_t a,
                                               const JointFrame<double>& in_a,
                                               std::optional<std::size_t> b,
                                               const JointFrame<double>& in_b) = 0;
    /// It is as it was, and goes into the world.
    virtual void enter_joint(OpenJoint& open, bool ahead) = 0;
    /// `holder` holds on from now on.
    virtual void hold_on(const StructureHold& at, typename Engine::Holder holder) = 0;
    /// What holds on to it leaves bodies that end.
    virtual void hand_over() = 0;
    /// It holds on to those that there are now.
    virtual void hold_again() {}
    /// Which of its bodies meet each other and what hangs on them, anew.
    virtual void let_pass() {}
    virtual void add_force(std::size_t cluster, const Vector3<double>& force,
                           const Vector3<double>& at) = 0;

    /// In this step.
    [[nodiscard]] virtual bool was_solved(std::size_t cluster) const = 0;
    /// Of one that moves.
    [[nodiscard]] virtual ClusterStep step_of(std::size_t cluster, const Vector3<double>& gravity,
                                              double dt) const = 0;
    /// What contacts gave it, into loads_; energy that they took [J].
    virtual double read_touches(double dt) = 0;
    /// What a joint gave its bodies, of the second one none: as its first one, turned round.
    [[nodiscard]] virtual bool was_solved(const OpenJoint& open) const = 0;
    [[nodiscard]] virtual std::optional<Wrench> given(const OpenJoint& open, bool to_a) const = 0;

    // ---- its bodies

    void make_joints(bool ahead) {
        for (std::size_t j = 0; j < plan().joints.size(); ++j) {
            const PlanJoint& joint = plan().joints[j];
            const auto& course = course_.joint(j);
            if (!course.there || !course.open || Base::open_joint(j) != nullptr) continue;
            const std::size_t a = course_.cluster_of(joint.a);
            std::optional<std::size_t> b;
            if (!stands_on_ground(j)) b = course_.cluster_of(joint.b.index);
            // what it joins hangs together by other joints, too
            if (b ? *b == a : held(a)) continue;
            const auto& frames = course_.frames(j);
            const auto in_cluster = [&](std::size_t c, std::size_t body, const auto& frame) {
                return placed(course_.clusters()[c].place(body), frame);
            };
            OpenJoint open =
                make_joint(j, a, in_cluster(a, joint.a, frames.first), b,
                           b ? in_cluster(*b, joint.b.index, frames.second) : frames.second);
            if (course.state) open.constraint->restore(*course.state);
            enter_joint(open, ahead);
            joints_.push_back(std::move(open));
        }
    }
    [[nodiscard]] auto broken_joints() const {
        return std::count_if(joints_.begin(), joints_.end(),
                             [](const OpenJoint& open) { return open.constraint->broken(); });
    }
    void meet() {
        broken_ = broken_joints();
        let_pass();
    }

    // ---- a step

    /// Nothing acts on it but what it carried before.
    [[nodiscard]] bool rests() const {
        return forces_.empty() &&
               std::all_of(touches_.begin(), touches_.end(), Engine::is_asleep) &&
               std::none_of(holds_.begin(), holds_.end(),
                            [](const Hold& hold) { return hold.is_solved(); });
    }
    /// Contacts, and joints of the user's.
    [[nodiscard]] std::size_t acting() const {
        return touches_.size() +
               std::size_t(std::count_if(holds_.begin(), holds_.end(),
                                         [](const Hold& hold) { return hold.acts(); }));
    }
    /// How it went through a step, and all that acted on it.
    void read(double dt, const Vector3<double>& gravity) {
        steps_.clear();
        for (std::size_t c = 0; c < pieces_.size(); ++c) {
            if (held(c)) {
                steps_.emplace_back().change.velocity = scaled(-dt, gravity);
            } else {
                steps_.push_back(step_of(c, gravity, dt));
            }
        }
        loads_.clear();
        by_touches_ = read_touches(dt);
        for (const Hold& hold : holds_) {
            if (!hold.acts()) continue;
            const JointFrame<double>& pose = steps_[course_.cluster_of(hold.at.body)].pose;
            loads_.push_back({hold.at.body, placed(pose, place_of(hold.at)).origin,
                              scaled(dt, hold.at.force), scaled(dt, hold.at.moment)});
        }
        for (const OpenJoint& open : joints_) {
            if (!was_solved(open)) continue;
            const PlanJoint& joint = plan().joints[open.joint];
            add_load(joint.a, *given(open, true), dt);
            if (stands_on_ground(open.joint)) continue;
            if (const std::optional<Wrench> on_b = given(open, false)) {
                add_load(joint.b.index, *on_b, dt);
                continue;
            }
            const BodyLoad on_a = loads_.back();
            loads_.push_back(
                {joint.b.index, on_a.point, scaled(-1, on_a.impulse), scaled(-1, on_a.moment)});
        }
        for (const typename Base::Force& force : forces_) {
            const std::size_t c = course_.cluster_of(force.body);
            const JointFrame<double> at =
                placed(steps_[c].pose, course_.clusters()[c].place(force.body));
            loads_.push_back({force.body, sum(at.origin, times(at.axes, force.in_body)),
                              scaled(dt, force.force), Vector3<double>::Zero()});
        }
    }

    // ---- what the world asks

    [[nodiscard]] int section_of(const typename Engine::Joint& joint) const override {
        for (const OpenJoint& open : joints_) {
            if (open.constraint.get() == &joint) return int(open.joint);
        }
        return no_section;
    }
    [[nodiscard]] const void* key_of(int section) const override {
        return &plan().joints[std::size_t(section)];
    }
    [[nodiscard]] double closed_work() const override { return course_.closed_work(); }
    [[nodiscard]] double unmissed_work() const override { return course_.unmissed_work(); }
    void leave() override { left_ = true; }
    void driven_through() override { Base::driven_through_ = true; }
    /// Joints of the user's that take no more do not count: their bodies came with what a part left
    /// of their velocities.
    void begin_blow(double noticed) override {
        noticed_ = noticed;
        course_.begin_blow();
    }
    void over_holds(const typename Engine::Divisible::VisitHold& visit) override {
        for (Hold& hold : holds_) visit(hold);
    }
    void open(std::span<const int> sections, bool ahead) override {
        Base::note_joints();
        become(course_.open(sections, placed_clusters()), ahead);
    }
    double count_vibration() override { return 0; }
    std::vector<int> close_held(Closing when, bool ahead) override {
        if (whole() || when == Closing::before_blow) return {};
        Base::note_joints();
        if (broken_ != broken_joints()) meet();
        std::vector<int> held = course_.held();
        if (!held.empty()) become(course_.close(held, placed_clusters()), ahead);
        return held;
    }

    double noticed_ = 0;    ///< [J]
    double by_touches_ = 0; ///< energy that contacts took in the last step that was read [J]
    std::size_t proved_acting_ = 0; ///< with as many, where that is proved
    std::ptrdiff_t broken_ = 0;     ///< joints, when that was last told
};

} // namespace ductile
