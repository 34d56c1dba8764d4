// SPDX-License-Identifier: MIT
//
// Bodies of structure_course.hpp.
#pragma once

#include <algorithm>
#include <limits>

#include "ductile/member/active_sections.hpp"
#include "ductile/structure/refuse.hpp"
#include "ductile/structure/structure_course.hpp"

namespace ductile {

namespace detail {

/// By an elastic joint that carries `force` [J].
[[nodiscard]] inline double stored(const SectionJoint<double>& joint,
                                   const Vector6<double>& force) noexcept {
    return force.cwiseAbs2().cwiseQuotient(joint.parameters().stiffness).sum() / 2;
}

} // namespace detail

DUCTILE_INLINE StructureCourse::StructureCourse(const StructurePlan& plan)
    : plan_(plan), body_there_(plan.bodies.size(), true) {
    unmissed_work_ = std::numeric_limits<double>::infinity();
    for (const PlanJoint& joint : plan.joints) {
        if (joint.b.kind == PlanSeat::Kind::own) {
            detail::refuse("Structure.own", joint.name,
                           "no body of the user's where members are one body until they yield");
        }
        const auto& rows = joint.joint.parameters();
        constexpr double rigid = std::numeric_limits<double>::infinity();
        if (!is_elastic(joint.joint) && rows.stiffness.minCoeff() < rigid) {
            detail::refuse("MemberOptions.free_at", joint.name,
                           "empty in a rigid structure that is one body until it yields: a row "
                           "that passes nothing on is an elastic one");
        }
        const JointFrame<double>& a = plan.bodies[joint.a].pose;
        const auto in = [&joint](const JointFrame<double>& body) {
            return JointFrame<double>{
                transposed_times(body.axes, difference(joint.frame.origin, body.origin)),
                transposed_times(body.axes, joint.frame.axes)};
        };
        frames_.emplace_back(in(a), joint.b.kind == PlanSeat::Kind::body
                                        ? in(plan.bodies[joint.b.index].pose)
                                        : joint.frame);
        const double least = joint.joint.law().value(0) * rows.least_travel;
        unmissed_work_ = std::min(unmissed_work_, least);
    }
    state_.joints.resize(plan.joints.size());
    state_.forces.assign(plan.joints.size(), Vector6<double>::Zero());
    std::vector<PlacedBody> bodies;
    for (const PlanBody& body : plan.bodies) bodies.push_back({body.pose, {}});
    clusters_ = find_clusters(bodies, made_at_);
    make_forces();
}

DUCTILE_INLINE int StructureCourse::open_joints() const noexcept {
    return int(std::count_if(state_.joints.begin(), state_.joints.end(),
                             [](const JointCourse& joint) { return joint.there && joint.open; }));
}

DUCTILE_INLINE std::size_t StructureCourse::nearest(std::size_t c, const JointFrame<double>& pose,
                                                    const Vector3<double>& point) const {
    const Cluster& cluster = clusters_[c];
    std::size_t result = cluster.bodies.front();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < cluster.bodies.size(); ++i) {
        const PlanBody& body = plan_.bodies[cluster.bodies[i]];
        if (!body.collides) continue;
        const JointFrame<double> box = placed(placed(pose, cluster.places[i]), body.box);
        Vector3<double> off = transposed_times(box.axes, difference(point, box.origin));
        for (int k = 0; k < 3; ++k) {
            off[k] -= std::clamp(off[k], -body.half_lengths[k], body.half_lengths[k]);
        }
        if (dot(off, off) >= least) continue;
        least = dot(off, off);
        result = cluster.bodies[i];
    }
    return result;
}

DUCTILE_INLINE double StructureCourse::stored_by(std::size_t which) const noexcept {
    return detail::stored(plan_.joints[which].joint, force(which));
}

DUCTILE_INLINE double StructureCourse::closed_work() const noexcept {
    double sum = 0;
    for (const JointCourse& joint : state_.joints) {
        if (joint.there && !joint.open && joint.state) sum += joint.state->joint.plastic_work;
    }
    return sum;
}

// ---- which bodies it is

DUCTILE_INLINE void StructureCourse::reach(std::size_t from, std::size_t without,
                                           std::vector<bool>& reached) const {
    std::vector<std::size_t> next{from};
    reached[from] = true;
    while (!next.empty()) {
        const std::size_t node = next.back();
        next.pop_back();
        for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
            if (j == without || !closed(j)) continue;
            const std::size_t a = plan_.joints[j].a, b = node_b(j);
            if (a != node && b != node) continue;
            const std::size_t other = a == node ? b : a;
            if (reached[other]) continue;
            reached[other] = true;
            next.push_back(other);
        }
    }
}

DUCTILE_INLINE bool StructureCourse::in_a_closed_frame(std::size_t joint) const {
    std::vector<bool> reached(plan_.bodies.size() + 1, false);
    reach(plan_.joints[joint].a, joint, reached);
    return reached[node_b(joint)];
}

DUCTILE_INLINE std::vector<Cluster> StructureCourse::find_clusters(
    std::span<const PlacedBody> bodies, std::vector<PlacedBody>& made_at) {
    const std::size_t count = plan_.bodies.size();
    constexpr auto none = std::size_t(-1);
    std::vector<Cluster> result;
    made_at.clear();
    cluster_of_.assign(count, none);
    const auto add = [&](std::size_t from, bool held) {
        std::vector<bool> reached(count + 1, false);
        reach(from, none, reached);
        std::vector<std::size_t> members;
        for (std::size_t b = 0; b < count; ++b) {
            if (!reached[b] || !body_there_[b]) continue;
            members.push_back(b);
            cluster_of_[b] = result.size();
        }
        if (members.empty()) return;
        made_at.emplace_back();
        result.push_back(
            make_cluster(std::move(members), held, plan_.bodies, bodies, made_at.back()));
    };
    add(count, true);
    for (std::size_t b = 0; b < count; ++b) {
        if (body_there_[b] && cluster_of_[b] == none) add(b, false);
    }
    return result;
}

DUCTILE_INLINE void StructureCourse::make_forces() {
    closed_forces_.clear();
    for (const Cluster& cluster : clusters_) {
        std::vector<std::size_t> inside;
        for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
            if (!closed(j) || !body_there_[plan_.joints[j].a]) continue;
            if (&clusters_[cluster_of_[plan_.joints[j].a]] == &cluster) inside.push_back(j);
        }
        closed_forces_.emplace_back(cluster, inside, plan_, frames_);
    }
}

DUCTILE_INLINE StructureCourse::Change StructureCourse::rearrange(
    std::span<const PlacedBody> clusters) {
    std::vector<PlacedBody> bodies(plan_.bodies.size());
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
        const Cluster& cluster = clusters_[c];
        for (std::size_t i = 0; i < cluster.bodies.size(); ++i) {
            PlacedBody& body = bodies[cluster.bodies[i]];
            body = within(clusters[c], cluster.held, cluster.places[i]);
            body.pose.axes = squared_up(body.pose.axes);
        }
    }
    const std::vector<Cluster> before = std::exchange(clusters_, {});
    clusters_ = find_clusters(bodies, made_at_);
    for (std::size_t j = 0; j < plan_.joints.size(); ++j) { // others hold what it joins
        JointCourse& one = state_.joints[j];
        const bool broken = one.state && one.state->joint.broken;
        const std::size_t a = plan_.joints[j].a;
        if (!one.there || !one.open || broken) continue;
        const std::size_t b = node_b(j);
        const bool together = b == plan_.bodies.size() ? clusters_[cluster_of_[a]].held
                                                       : cluster_of_[a] == cluster_of_[b];
        if (together) one.open = false;
    }
    Change change;
    for (Cluster& cluster : clusters_) {
        auto& kept = change.kept.emplace_back();
        for (std::size_t c = 0; c < before.size(); ++c) {
            if (before[c].bodies != cluster.bodies || before[c].held != cluster.held) continue;
            kept = c;
            cluster = before[c];
            made_at_[change.kept.size() - 1] = clusters[c];
        }
    }
    make_forces();
    return change;
}

/// Where its bodies are an elastic joint that opens has what it carried while it was closed.
DUCTILE_INLINE void StructureCourse::strain(std::size_t which) {
    const Joint& of = plan_.joints[which].joint;
    const Vector6<double>& stiffness = of.parameters().stiffness;
    std::optional<LinkState>& state = joint(which).state;
    if (!state) state = LinkState{.joint = of.state()};
    auto& went = state->joint;
    const Vector6<double> more = (force(which) - went.force).cwiseQuotient(stiffness);
    went.plastic_offset.head<3>() += more.head<3>();
    state->rest = turned_by<double>(angular(more), state->rest);
    went.stored += detail::stored(of, force(which)) - detail::stored(of, went.force);
    went.force = force(which);
    state->swing.stir();
}

DUCTILE_INLINE StructureCourse::Change StructureCourse::open(std::span<const int> joints,
                                                             std::span<const PlacedBody> clusters) {
    for (const int j : joints) {
        joint(std::size_t(j)).open = true;
        joint(std::size_t(j)).held = 0;
        if (is_elastic(plan_.joints[std::size_t(j)].joint)) strain(std::size_t(j));
    }
    return rearrange(clusters);
}
DUCTILE_INLINE StructureCourse::Change StructureCourse::close(
    std::span<const int> joints, std::span<const PlacedBody> clusters) {
    for (const int j : joints) joint(std::size_t(j)).open = false;
    return rearrange(clusters);
}
DUCTILE_INLINE StructureCourse::Change StructureCourse::remove_joint(
    std::size_t which, std::span<const PlacedBody> clusters) {
    joint(which).there = false;
    return rearrange(clusters);
}
DUCTILE_INLINE StructureCourse::Change StructureCourse::remove_body(
    std::size_t body, std::span<const PlacedBody> clusters) {
    body_there_[body] = false;
    return rearrange(clusters);
}
DUCTILE_INLINE StructureCourse::Change StructureCourse::restore(
    const Saved& saved, std::span<const PlacedBody> clusters) {
    state_ = saved.state;
    clusters_ = saved.clusters;
    made_at_.assign(clusters.begin(), clusters.end());
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
        for (const std::size_t body : clusters_[c].bodies) cluster_of_[body] = c;
    }
    make_forces();
    return {std::vector<std::optional<std::size_t>>(clusters_.size())};
}

// ---- after a step

/// What acts on the bodies of a cluster and is not in their motion, in its frame, of a step of one
/// second.
DUCTILE_INLINE void StructureCourse::gather(std::size_t c, const ClusterStep& step,
                                            std::span<const BodyLoad> loads, double dt) {
    const Cluster& cluster = clusters_[c];
    std::vector<Vector6<double>>& all = closed_forces_[c].loads();
    const Matrix3<double>& axes = step.pose.axes;
    for (std::size_t i = 0; i < cluster.bodies.size(); ++i) {
        const std::size_t b = cluster.bodies[i];
        const PlanBody& body = plan_.bodies[b];
        const JointFrame<double> at = placed(step.pose, cluster.places[i]);
        const Vector3<double> r =
            cluster.held ? Vector3<double>::Zero() : difference(at.origin, step.pose.origin);
        const Vector3<double> bent = scaled(step.dt, cross(step.spin, cross(step.spin, r)));
        Vector3<double> force = scaled(-body.mass, sum(step.change.at(r), bent));
        Vector3<double> moment = Vector3<double>::Zero();
        if (!cluster.held) {
            const Matrix3<double> inertia = along_axes(body.inertia, at.axes);
            moment = scaled(-1, sum(times(inertia, step.change.spin),
                                    scaled(step.dt, cross(step.spin, times(inertia, step.spin)))));
        }
        for (const BodyLoad& load : loads) {
            if (load.body != b) continue;
            force = sum(force, load.impulse);
            moment = sum(moment,
                         sum(load.moment, cross(difference(load.point, at.origin), load.impulse)));
        }
        all[i] = twist_of(scaled(1 / dt, transposed_times(axes, force)),
                          scaled(1 / dt, transposed_times(axes, moment)));
    }
}

DUCTILE_INLINE void StructureCourse::open_with(std::size_t which) {
    if (!in_a_closed_frame(which)) {
        found_.push_back(int(which));
        return;
    }
    // the closed frame that it is in: what hangs together without the joints that alone hold
    const std::size_t cluster = cluster_of_[plan_.joints[which].a];
    std::vector<std::size_t> frame;
    for (const ClosedJoint& one : closed_forces_[cluster].joints()) {
        if (in_a_closed_frame(one.joint)) frame.push_back(one.joint);
    }
    std::vector<bool> reached(plan_.bodies.size() + 1, false);
    reached[plan_.joints[which].a] = true;
    for (bool more = true; more;) {
        more = false;
        for (const std::size_t j : frame) {
            const std::size_t a = plan_.joints[j].a, b = node_b(j);
            if (reached[a] == reached[b]) continue;
            reached[a] = reached[b] = more = true;
        }
    }
    for (const std::size_t j : frame) {
        if (reached[plan_.joints[j].a]) found_.push_back(int(j));
    }
}

DUCTILE_INLINE const std::vector<int>& StructureCourse::beyond(std::span<const ClusterStep> steps,
                                                               std::span<const BodyLoad> loads,
                                                               double dt) {
    constexpr double hair = 1e-6; // of the bound, as what is solved is off by
    found_.clear();
    left_over_ = 0;
    trial_ = state_.forces;
    const auto use = [this](std::size_t j, const Vector6<double>& force) {
        return plan_.joints[j].joint.surface().value(force);
    };
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
        if (closed_forces_[c].joints().empty()) continue;
        gather(c, steps[c], loads, dt);
        const std::size_t worst = closed_forces_[c].find(trial_, use, hair);
        left_over_ = std::max(left_over_, closed_forces_[c].left_over());
        constexpr double noticed = 1e-3, borne = 0.01; // of the loads, of a joint's strength
        knows_loads_ = knows_loads_ && !(closed_forces_[c].left_over() > noticed &&
                                         closed_forces_[c].left_over_use() > borne);
        if (worst != ClosedForces::no_joint) open_with(worst);
    }
    state_.forces = trial_;
    return found_;
}

DUCTILE_INLINE const std::vector<int>& StructureCourse::struck(std::span<const ClusterStep> steps,
                                                               std::span<const BodyLoad> loads,
                                                               double energy) {
    found_.clear();
    if (!(energy > 0)) return found_;
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
        ClosedForces& forces = closed_forces_[c];
        if (forces.joints().empty()) continue;
        const bool here = std::any_of(loads.begin(), loads.end(), [&](const BodyLoad& load) {
            return cluster_of_[load.body] == c;
        });
        if (!here) continue;
        gather(c, steps[c], loads, 1);
        trial_.assign(state_.forces.size(), Vector6<double>::Zero());
        const auto nothing = [](std::size_t, const Vector6<double>&) { return 0.0; };
        (void)forces.find(trial_, nothing, 0);
        double stored = 0; // of a blow of one second
        for (const ClosedJoint& one : forces.joints()) {
            const Vector6<double>& f = trial_[one.joint];
            const auto& stiffness = plan_.joints[one.joint].joint.parameters().section_stiffness;
            for (int i = 0; i < 6; ++i) stored += f[i] * f[i] / (2 * stiffness[i]);
        }
        std::size_t worst = ClosedForces::no_joint;
        double most = 0;
        for (const ClosedJoint& one : forces.joints()) {
            const double use = plan_.joints[one.joint].joint.surface().value(trial_[one.joint]);
            if (!(use > most)) continue;
            most = use;
            worst = one.joint;
        }
        if (worst == ClosedForces::no_joint) continue;
        // once any joint flows, so does what is loaded
        constexpr double noticed = 1e-4;
        if (most * most * energy > (yields_ ? noticed : 1) * stored) {
            yields_ = true;
            open_with(worst);
        }
    }
    return found_;
}

DUCTILE_INLINE const std::vector<int>& StructureCourse::held() {
    found_.clear();
    const int hold = ActiveSections{}.hold;
    bool swings = false;
    for (std::size_t j = 0; j < state_.joints.size(); ++j) {
        JointCourse& one = state_.joints[j];
        if (!one.there || !one.open || !one.state) continue;
        const auto& went = one.state->joint;
        one.held = went.flowing || went.broken ? 0 : one.held + 1;
        if (one.held >= hold) found_.push_back(int(j));
        swings = swings ||
                 (is_elastic(plan_.joints[j].joint) && !went.broken && !one.state->swing.rests());
    }
    if (swings) found_.clear();
    return found_;
}

} // namespace ductile
