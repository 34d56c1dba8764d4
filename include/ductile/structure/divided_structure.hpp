// SPDX-License-Identifier: MIT
//
// What a structure that is as few bodies as its yielding joints need is in any engine beside its
// bodies: its course, its open joints, the forces on it, and what it says of them. How it goes
// through steps: stepped_structure.hpp.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/member/member_course.hpp"
#include "ductile/structure/built_structure.hpp"
#include "ductile/structure/refuse.hpp"
#include "ductile/structure/structure_course.hpp"
#include "ductile/structure/structure_save.hpp"
#include "ductile/world/joint_report.hpp"

namespace ductile {

/// Where a joint of the user's holds on to a structure, and what it gave it when it was last
/// solved: what sleeps carries on so. Plain value.
struct StructureHold {
    std::size_t body = 0;       ///< of the plan
    JointFrame<double> in_body; ///< axes: the world's when the structure was made
    /// On it, about where it holds, world axes [N], [N m].
    Vector3<double> force{0, 0, 0}, moment{0, 0, 0};
};

/// `OpenJoint`: has the `joint` [index in the plan] and, by a pointer, the engine's plastic joint
/// of six axes there, `constraint`.
template <class OpenJoint>
class DividedStructure : public BuiltStructure {
  public:
    [[nodiscard]] int open_joints() const noexcept { return course_.open_joints(); }
    /// What a joint carried in the last step that was looked at, on its body A [N | N m]: of open
    /// ones what the solve gave, of closed ones forces in equilibrium, of which a closed frame has
    /// many.
    /// @throws std::invalid_argument as StructurePlan::joint, and where it was removed.
    [[nodiscard]] Vector6<double> force(std::string_view member, MemberEnd end) const {
        const std::size_t j = present_joint(plan().joint(member, end));
        const OpenJoint* open = open_joint(j);
        return open != nullptr ? forces_of(*open) : course_.force(j);
    }
    [[nodiscard]] double plastic_travel(std::string_view member, MemberEnd end) const {
        return report(present_joint(plan().joint(member, end))).plastic_travel;
    }
    [[nodiscard]] bool is_open(std::string_view member, MemberEnd end) const {
        return course_.joint(present_joint(plan().joint(member, end))).open;
    }
    /// Share of the loads of a moving body that no forces in it carry, in the last look.
    [[nodiscard]] double left_over() const noexcept { return course_.left_over(); }

  protected:
    /// On a body of the plan, until the step that it is for is over.
    struct Force {
        std::size_t body;
        Vector3<double> force, in_body; ///< world axes [N]; where, in its frame [m]
    };

    /// @throws std::invalid_argument as make_plan and StructureCourse.
    explicit DividedStructure(const StructureModel& model)
        : BuiltStructure(make_plan(model)), course_(plan()) {
        for (std::size_t j = 0; j < plan().joints.size(); ++j) {
            reports_.push_back(
                {&plan().joints[j], plan().joints[j].name, [this, j] { return report(j); }});
        }
    }
    ~DividedStructure() = default;

    [[nodiscard]] const OpenJoint* open_joint(std::size_t joint) const {
        const auto found = std::find_if(joints_.begin(), joints_.end(),
                                        [joint](const auto& open) { return open.joint == joint; });
        return found != joints_.end() ? &*found : nullptr;
    }
    [[nodiscard]] static Vector6<double> forces_of(const OpenJoint& open) {
        Vector6<double> six;
        for (const JointAxis axis : all_joint_axes) {
            six[Eigen::Index(index(axis))] = open.constraint->force(axis);
        }
        return six;
    }
    [[nodiscard]] JointReport<double> report(std::size_t joint) const {
        JointReport<double> report = report_alone(joint);
        // of all of it, said by its first joint
        if ((driven_through_ || !course_.knows_loads()) && joint == first_joint()) {
            report.outcome = Outcome::unreliable;
            report.unmodelled = driven_through_ ? Unmodelled::driven : Unmodelled::forces;
        }
        return report;
    }
    [[nodiscard]] std::size_t first_joint() const {
        std::size_t j = 0;
        while (j + 1 < plan().joints.size() && !course_.joint(j).there) ++j;
        return j;
    }
    [[nodiscard]] JointReport<double> report_alone(std::size_t joint) const {
        if (const OpenJoint* open = open_joint(joint)) return open->constraint->report();
        JointReport<double> report;
        const auto& state = course_.joint(joint).state;
        if (!state) return report;
        if (state->joint.broken) report.outcome = Outcome::broken;
        report.plastic_travel = state->joint.plastic_travel;
        report.absorbed_energy = state->joint.plastic_work;
        return report;
    }
    [[nodiscard]] bool stands_on_ground(std::size_t joint) const {
        return plan().joints[joint].b.kind == PlanSeat::Kind::ground;
    }
    [[nodiscard]] JointFrame<double> pose_of(std::size_t cluster) const {
        return course_.clusters()[cluster].held ? JointFrame<double>{} : cluster_now(cluster).pose;
    }
    [[nodiscard]] JointFrame<double> frame_of(const PlanSeat& seat) const override {
        const std::size_t c = course_.cluster_of(seat.index);
        return placed(pose_of(c), course_.clusters()[c].place(seat.index));
    }
    [[nodiscard]] std::vector<PlacedBody> placed_clusters() const {
        std::vector<PlacedBody> all;
        for (std::size_t c = 0; c < course_.clusters().size(); ++c) {
            all.push_back(course_.clusters()[c].held ? PlacedBody{} : cluster_now(c));
        }
        return all;
    }
    /// Into the course what open joints went through and carry.
    void note_joints() {
        for (const OpenJoint& open : joints_) {
            course_.joint(open.joint).state = noted(open);
            course_.force(open.joint) = forces_of(open);
        }
    }
    [[nodiscard]] static StructureCourse::LinkState noted(const OpenJoint& open) {
        auto state = open.constraint->state();
        if (!open.constraint->is_awake_member()) state.joint.flowing = false; // not any more
        return state;
    }
    [[nodiscard]] StructureSave save() const {
        StructureCourse::Saved saved = course_.save();
        for (const OpenJoint& open : joints_) {
            saved.state.joints[open.joint].state = noted(open);
            saved.state.forces[open.joint] = forces_of(open);
        }
        return {course_, std::move(saved), placed_clusters()};
    }
    /// All bodies and joints anew: what follows must not hang on what there is now.
    /// @throws std::invalid_argument as StructureSave.
    void put_back(const StructureSave& saved) {
        saved.require_of(course_);
        find_holds();
        joints_.clear();
        become(course_.restore(saved.saved(), saved.bodies()), false);
        rearranged();
    }
    /// Those that closed, or are between other bodies than they were.
    void end_joints(const StructureCourse::Change& change) {
        std::erase_if(joints_, [&](const OpenJoint& open) {
            const auto& course = course_.joint(open.joint);
            if (!course.there || !course.open) return true;
            const PlanJoint& joint = plan().joints[open.joint];
            const auto kept = [&](std::size_t body) {
                return change.kept[course_.cluster_of(body)].has_value();
            };
            return !kept(joint.a) || (!stands_on_ground(open.joint) && !kept(joint.b.index));
        });
    }

    // ---- what of the user's holds on to it

    /// @throws std::invalid_argument where the point is the ground's.
    [[nodiscard]] StructureHold hold_at(const Point& point) const {
        if (point.seat.kind != PlanSeat::Kind::body) {
            detail::refuse("StructureInTime.attach.node", detail::text(point.at) + " m",
                           "a node of the structure that is not the ground");
        }
        const JointFrame<double>& made = made_at(point.seat);
        return {point.seat.index,
                {transposed_times(made.axes, difference(point.at, made.origin)),
                 transposed_times(made.axes, Matrix3<double>(Matrix3<double>::Identity()))}};
    }

    /// On the body of a cluster whose shape is the nearest to a point [m].
    [[nodiscard]] StructureHold hold_near(std::size_t cluster, const Vector3<double>& at) const {
        StructureHold hold;
        hold.body = course_.nearest(cluster, pose_of(cluster), at);
        const JointFrame<double> body = frame_of({PlanSeat::Kind::body, hold.body});
        hold.in_body.origin = transposed_times(body.axes, difference(at, body.origin));
        return hold;
    }
    /// Where it holds now, world [m].
    [[nodiscard]] Vector3<double> point_of(const StructureHold& hold) const {
        return placed(pose_of(course_.cluster_of(hold.body)), place_of(hold)).origin;
    }
    /// In the frame of its cluster.
    [[nodiscard]] JointFrame<double> place_of(const StructureHold& hold) const {
        const Cluster& cluster = course_.clusters()[course_.cluster_of(hold.body)];
        return placed(cluster.place(hold.body), hold.in_body);
    }
    /// `wrench`: on the cluster's body where that was solved at `pose`.
    void note(StructureHold& hold, const JointFrame<double>& pose, const Wrench& wrench) const {
        const Vector3<double> arm = difference(placed(pose, place_of(hold)).origin, pose.origin);
        hold.force = wrench.force;
        hold.moment = difference(wrench.torque, cross(arm, wrench.force));
    }
    /// Those that hang together with one, itself among them, by open joints that did not break.
    [[nodiscard]] std::vector<bool> hanging_on(std::size_t cluster) const {
        std::vector<bool> reached(course_.clusters().size(), false);
        reached[cluster] = true;
        for (bool more = true; more;) {
            more = false;
            for (const OpenJoint& open : joints_) {
                if (stands_on_ground(open.joint) || open.constraint->broken()) continue;
                const PlanJoint& joint = plan().joints[open.joint];
                const std::size_t a = course_.cluster_of(joint.a),
                                  b = course_.cluster_of(joint.b.index);
                if (reached[a] == reached[b]) continue;
                reached[a] = reached[b] = more = true;
            }
        }
        return reached;
    }

    StructureCourse course_;
    std::vector<DivisionReport> reports_; ///< by joint
    std::vector<OpenJoint> joints_;
    std::vector<Force> forces_;
    bool driven_through_ = false; ///< in this step, by a driven body

  private:
    // ---- the engine's

    /// Of one that moves.
    [[nodiscard]] virtual PlacedBody cluster_now(std::size_t cluster) const = 0;
    virtual void wake_cluster(std::size_t cluster) = 0;
    /// Its bodies are from now on what `course_` has; `change`: which of them they are already.
    virtual void become(const StructureCourse::Change& change, bool ahead) = 0;
    /// It became others, and not by a step.
    virtual void rearranged() = 0;
    /// It is to: joints of the user's may have come and gone.
    virtual void find_holds() {}

    // ---- what BuiltStructure asks

    [[nodiscard]] const PairQueries& queries(std::size_t joint) const override {
        return *open_joint(joint)->constraint;
    }
    [[nodiscard]] double utilisation_of(std::size_t joint) const override {
        if (open_joint(joint) != nullptr) return queries(joint).utilisation();
        return plan().joints[joint].joint.surface().value(course_.force(joint));
    }
    [[nodiscard]] double absorbed_by(std::size_t joint) const override {
        return report(joint).absorbed_energy;
    }
    [[nodiscard]] double stored_by(std::size_t joint) const override {
        return open_joint(joint) != nullptr ? queries(joint).stored_energy()
                                            : course_.stored_by(joint);
    }
    void push(const PlanSeat& seat, const Vector3<double>& force,
              const Vector3<double>& at) override {
        const JointFrame<double> frame = frame_of(seat);
        forces_.push_back(
            {seat.index, force, transposed_times(frame.axes, difference(at, frame.origin))});
        wake_cluster(course_.cluster_of(seat.index));
    }
    void drop_joint(std::size_t joint) override {
        find_holds();
        note_joints();
        become(course_.remove_joint(joint, placed_clusters()), false);
        rearranged();
    }
    void drop_body(std::size_t body) override {
        find_holds();
        note_joints();
        std::erase_if(forces_, [body](const Force& force) { return force.body == body; });
        become(course_.remove_body(body, placed_clusters()), false);
        rearranged();
    }
};

} // namespace ductile
