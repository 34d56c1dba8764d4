// SPDX-License-Identifier: MIT
//
// A structure that is as few rigid bodies as its yielding joints need, while it is in an engine:
// which bodies these are now, and, after a step, whether that was enough. The engine's side asks:
//
//   after a step   beyond(steps, loads, dt)   joints that have to open: put the step back,
//                  open(joints, bodies)       the bodies that it is from then on; do it again
//   after a blow   struck(steps, loads, energy)  the same
//   it stands      held(), close(joints, bodies) the bodies that it is from then on
//
// and writes what open joints went through into `joint(i).state` and `.force` before.
//
// Which open. A joint without which its cluster falls in two alone; one of a closed frame with all
// of that frame, as where it flows others have to, and the jointed solve says which. Those that
// hold close again after `hold` steps, and what they carried is the proof that they may stay
// closed (closed_forces.hpp).
//
// Blow. An elastic structure takes up the energy E that a rigid contact annihilates as strain
// energy of the very profile of forces that the blow has, as a member does (member/blow.hpp). One
// that yields takes it as the jointed one: what is loaded opens.
//
// Elastic joints. A closed one carries what the frame's stiffness gives it (closed_forces.hpp), and
// has that when it opens: from the first yield on the frame is the elastic-plastic one. It is one
// body again when it rests (joint/swing.hpp), with what its joints store then. What a closed frame
// bends is not seen, and it does not swing: a load that comes at once yields it as one that comes
// slowly.
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/joint/link.hpp"
#include "ductile/structure/closed_forces.hpp"
#include "ductile/structure/cluster.hpp"
#include "ductile/structure/structure_plan.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

/// How a cluster went through a step. Plain value.
struct ClusterStep {
    JointFrame<double> pose; ///< where the rows were solved
    /// Of its centre, what gravity gave it left out; of one that is held less g dt.
    BodyMotion change{};
    Vector3<double> spin = Vector3<double>::Zero(); ///< ω before
    double dt = 0;                                  ///< in which it turned [s]; 0 in a blow
};

/// Acts on a body of the plan in a step. Plain value.
struct BodyLoad {
    std::size_t body = 0;
    Vector3<double> point = Vector3<double>::Zero();   ///< [m]
    Vector3<double> impulse = Vector3<double>::Zero(); ///< [N s]
    Vector3<double> moment = Vector3<double>::Zero();  ///< [N m s]
};

class StructureCourse {
  public:
    using Joint = SectionJoint<double>;
    using LinkState = Link<Joint>::State;

    struct JointCourse {
        bool there = true; ///< false: removed
        bool open = false;
        int held = 0;                     ///< steps in which it held since it last flowed
        std::optional<LinkState> state{}; ///< once it was open
    };
    /// All that it remembers beside the bodies. Plain value.
    struct State {
        std::vector<JointCourse> joints;
        std::vector<Vector6<double>> forces; ///< by joint, on A along its axes [N | N m]
    };

    /// @throws std::invalid_argument where a rigid joint passes nothing on along some axis, or one
    /// hangs on a body of the user's.
    explicit StructureCourse(const StructurePlan& plan);
    StructureCourse(const StructureCourse&) = delete;
    StructureCourse& operator=(const StructureCourse&) = delete;

    [[nodiscard]] const StructurePlan& plan() const noexcept { return plan_; }
    [[nodiscard]] const std::vector<Cluster>& clusters() const noexcept { return clusters_; }
    /// By cluster, where it was put when it was made.
    [[nodiscard]] const std::vector<PlacedBody>& made_at() const noexcept { return made_at_; }
    [[nodiscard]] std::size_t cluster_of(std::size_t body) const noexcept {
        return cluster_of_[body];
    }
    /// The joint's frame in body A, in body B (of the ground: in the world).
    [[nodiscard]] const std::pair<JointFrame<double>, JointFrame<double>>& frames(
        std::size_t joint) const noexcept {
        return frames_[joint];
    }
    [[nodiscard]] JointCourse& joint(std::size_t i) noexcept { return state_.joints[i]; }
    [[nodiscard]] const JointCourse& joint(std::size_t i) const noexcept {
        return state_.joints[i];
    }
    /// What it carried in the last step that was looked at [N | N m].
    [[nodiscard]] Vector6<double>& force(std::size_t i) noexcept { return state_.forces[i]; }
    [[nodiscard]] const Vector6<double>& force(std::size_t i) const noexcept {
        return state_.forces[i];
    }
    [[nodiscard]] bool has_body(std::size_t body) const noexcept { return body_there_[body]; }
    /// Of a cluster that is at `pose`, the body whose shape is the nearest to a point.
    [[nodiscard]] std::size_t nearest(std::size_t cluster, const JointFrame<double>& pose,
                                      const Vector3<double>& point) const;
    [[nodiscard]] int open_joints() const noexcept;
    /// Bodies that move, and those that are held as one.
    [[nodiscard]] bool whole() const noexcept { return open_joints() == 0; }
    /// By a closed joint, of its elastic energy [J].
    [[nodiscard]] double stored_by(std::size_t joint) const noexcept;
    /// Of closed joints: energy that they absorbed [J].
    [[nodiscard]] double closed_work() const noexcept;
    /// Strength x travel that nobody misses, the least of closed joints [J].
    [[nodiscard]] double unmissed_work() const noexcept { return unmissed_work_; }
    [[nodiscard]] double left_over() const noexcept { return left_over_; }
    /// Whether the looks since the last call of begin_step knew of what moved it.
    [[nodiscard]] bool knows_loads() const noexcept { return knows_loads_; }
    void begin_step() noexcept { knows_loads_ = true; }

    /// Closed joints that would have carried more than they can in a step of `dt` [s]; `steps`: by
    /// cluster. Valid until the next call.
    const std::vector<int>& beyond(std::span<const ClusterStep> steps,
                                   std::span<const BodyLoad> loads, double dt);
    /// A blow begins: the next `struck` is its first.
    void begin_blow() noexcept { yields_ = false; }
    /// The same of a blow in which contacts took `energy` [J].
    const std::vector<int>& struck(std::span<const ClusterStep> steps,
                                   std::span<const BodyLoad> loads, double energy);
    /// Counts a step that stands, and says which open joints it would close.
    const std::vector<int>& held();

    /// `clusters`: where they are now. Those that the change makes: `kept`, by new cluster, which
    /// of the old ones it still is, or none.
    struct Change {
        std::vector<std::optional<std::size_t>> kept;
    };
    Change open(std::span<const int> joints, std::span<const PlacedBody> clusters);
    Change close(std::span<const int> joints, std::span<const PlacedBody> clusters);
    Change remove_joint(std::size_t joint, std::span<const PlacedBody> clusters);
    Change remove_body(std::size_t body, std::span<const PlacedBody> clusters);
    /// What it is now. Plain value.
    struct Saved {
        State state;
        std::vector<Cluster> clusters;
    };
    [[nodiscard]] Saved save() const { return {state_, clusters_}; }
    /// Of the same plan, the same of its joints being there; `clusters`: where they are to be.
    Change restore(const Saved& saved, std::span<const PlacedBody> clusters);

  private:
    Change rearrange(std::span<const PlacedBody> clusters);
    std::vector<Cluster> find_clusters(std::span<const PlacedBody> bodies,
                                       std::vector<PlacedBody>& made_at);
    void make_forces();
    void gather(std::size_t cluster, const ClusterStep& step, std::span<const BodyLoad> loads,
                double dt);
    void open_with(std::size_t joint);
    void strain(std::size_t joint);
    [[nodiscard]] bool closed(std::size_t joint) const noexcept {
        return state_.joints[joint].there && !state_.joints[joint].open;
    }
    /// The node of a joint's side in the graph: a body, or the ground after all of them.
    [[nodiscard]] std::size_t node_b(std::size_t joint) const noexcept {
        const PlanSeat& seat = plan_.joints[joint].b;
        return seat.kind == PlanSeat::Kind::body ? seat.index : plan_.bodies.size();
    }
    /// True where its bodies hang together without it, too.
    [[nodiscard]] bool in_a_closed_frame(std::size_t joint) const;
    /// Marks what hangs together with `from` by closed joints but `without`.
    void reach(std::size_t from, std::size_t without, std::vector<bool>& reached) const;

    const StructurePlan& plan_;
    std::vector<std::pair<JointFrame<double>, JointFrame<double>>> frames_; ///< by joint
    State state_;
    std::vector<bool> body_there_;
    std::vector<Cluster> clusters_;
    std::vector<PlacedBody> made_at_;
    std::vector<std::size_t> cluster_of_; ///< by body
    std::vector<ClosedForces> closed_forces_;
    std::vector<Vector6<double>> trial_; ///< forces of this look
    std::vector<int> found_;
    double unmissed_work_ = 0, left_over_ = 0;
    bool knows_loads_ = true;
    bool yields_ = false; ///< this blow was seen to yield it
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/structure/structure_course.ipp"
#endif
