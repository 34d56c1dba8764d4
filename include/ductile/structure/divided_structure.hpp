// SPDX-License-Identifier: MIT
//
// What a structure that is as few bodies as its yielding joints need is in any engine beside its
// bodies: its course, its open joints, the forces on it, and what it says of them. The adapter
// makes bodies and joints, moves them and reads what acted on them.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cmath>
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
#include "ductile/vocabulary/number_text.hpp"
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

/// @throws std::logic_error where a body of a structure is no more as that made it: of mass `made`
/// [kg], 0: it stands.
inline void require_body(double made, double mass, bool kinematic) {
    constexpr double share = 1e-3;
    if (!kinematic && std::abs(mass - made) <= share * made) return;
    throw std::logic_error(
        "StructureInTime.bodies: must move as they did when they were made, with " +
        number_text(made, 6) + " kg");
}

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
            reports_.push_back({key_of(j), plan().joints[j].name, [this, j] { return report(j); }});
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
    /// Of a joint of its own.
    template <class Constraint>
    [[nodiscard]] std::optional<std::size_t> index_of(const Constraint& joint) const {
        for (const OpenJoint& open : joints_) {
            if (open.constraint.get() == &joint) return open.joint;
        }
        return std::nullopt;
    }
    /// Under which it is reported.
    [[nodiscard]] const void* key_of(std::size_t joint) const { return &plan().joints[joint]; }
    [[nodiscard]] bool stands_on_ground(std::size_t joint) const {
        return plan().joints[joint].b.kind == PlanSeat::Kind::ground;
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
    /// `make(joint, a, in_a, b, in_b)`: an OpenJoint between clusters a and b, none: the ground;
    /// `enter`: it is as it was, and goes into the world.
    template <class Make, class Enter>
    void make_joints(const Make& make, const Enter& enter) {
        for (std::size_t j = 0; j < plan().joints.size(); ++j) {
            const PlanJoint& joint = plan().joints[j];
            const auto& course = course_.joint(j);
            if (!course.there || !course.open || open_joint(j) != nullptr) continue;
            const std::size_t a = course_.cluster_of(joint.a);
            std::optional<std::size_t> b;
            if (!stands_on_ground(j)) b = course_.cluster_of(joint.b.index);
            // what it joins hangs together by other joints, too
            if (b ? *b == a : course_.clusters()[a].held) continue;
            const auto& [in_a, in_b] = course_.frames(j);
            const auto in_cluster = [&](std::size_t c, std::size_t body, const auto& frame) {
                return placed(course_.clusters()[c].place(body), frame);
            };
            OpenJoint open = make(j, a, in_cluster(a, joint.a, in_a), b,
                                  b ? in_cluster(*b, joint.b.index, in_b) : in_b);
            if (course.state) open.constraint->restore(*course.state);
            enter(open);
            joints_.push_back(std::move(open));
        }
    }
    /// Forces that were applied to it act in the coming solve; `add(cluster, force, at)`.
    template <class Add>
    void add_forces(const Add& add) const {
        for (const Force& force : forces_) {
            const std::size_t c = course_.cluster_of(force.body);
            if (course_.clusters()[c].held) continue;
            const JointFrame<double> at = frame_of({PlanSeat::Kind::body, force.body});
            add(c, force.force, sum(at.origin, times(at.axes, force.in_body)));
        }
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
    /// `force`, `torque`: on the cluster's body, about its centre, where that was solved at `pose`.
    void note(StructureHold& hold, const JointFrame<double>& pose, const Vector3<double>& force,
              const Vector3<double>& torque) const {
        const Vector3<double> arm = difference(placed(pose, place_of(hold)).origin, pose.origin);
        hold.force = force;
        hold.moment = difference(torque, cross(arm, force));
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

    // ---- how a step went: steps_ has to have the poses of the clusters that move

    void begin_read() {
        loads_.clear();
        steps_.assign(course_.clusters().size(), {});
    }
    /// About the centre of the cluster's body, for `dt` [s].
    void add_load(std::size_t body, const Vector3<double>& force, const Vector3<double>& moment,
                  double dt) {
        loads_.push_back({body, steps_[course_.cluster_of(body)].pose.origin, scaled(dt, force),
                          scaled(dt, moment)});
    }
    void add_load(const StructureHold& hold, double dt) {
        const JointFrame<double>& pose = steps_[course_.cluster_of(hold.body)].pose;
        loads_.push_back({hold.body, placed(pose, place_of(hold)).origin, scaled(dt, hold.force),
                          scaled(dt, hold.moment)});
    }
    /// A blow: joints of the user's that take no more than `noticed` [J] do not count, as their
    /// bodies came with what a part left of their velocities.
    void expect_blow(double noticed) noexcept {
        noticed_ = noticed;
        course_.begin_blow();
    }
    /// Joints to open after it was read: contacts took `energy` [J].
    [[nodiscard]] const std::vector<int>& struck(double energy, const MemberStrike& by_joints) {
        const double more = by_joints.energy > noticed_ ? by_joints.energy : 0.0;
        return course_.struck(steps_, loads_, energy + more);
    }
    /// Those that were applied to it.
    void read_forces(double dt) {
        for (const Force& force : forces_) {
            const std::size_t c = course_.cluster_of(force.body);
            const JointFrame<double> at =
                placed(steps_[c].pose, course_.clusters()[c].place(force.body));
            loads_.push_back({force.body, sum(at.origin, times(at.axes, force.in_body)),
                              scaled(dt, force.force), Vector3<double>::Zero()});
        }
    }

    StructureCourse course_;
    std::vector<DivisionReport> reports_; ///< by joint
    std::vector<OpenJoint> joints_;
    std::vector<Force> forces_;
    std::vector<ClusterStep> steps_; ///< of the last step, by cluster
    std::vector<BodyLoad> loads_;    ///< of it
    double noticed_ = 0;             ///< [J]
    bool driven_through_ = false;    ///< in this step, by a driven body

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

    [[nodiscard]] JointFrame<double> pose_of(std::size_t cluster) const {
        return course_.clusters()[cluster].held ? JointFrame<double>{} : cluster_now(cluster).pose;
    }

    // ---- what BuiltStructure asks

    [[nodiscard]] JointFrame<double> frame_of(const PlanSeat& seat) const override {
        const std::size_t c = course_.cluster_of(seat.index);
        return placed(pose_of(c), course_.clusters()[c].place(seat.index));
    }
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
