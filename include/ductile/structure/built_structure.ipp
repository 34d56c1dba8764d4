// SPDX-License-Identifier: MIT
//
// Bodies of built_structure.hpp.
#pragma once

#include <algorithm>
#include <utility>

#include "ductile/structure/built_structure.hpp"
#include "ductile/structure/refuse.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

DUCTILE_INLINE BuiltStructure::BuiltStructure(StructurePlan plan)
    : plan_(std::move(plan)),
      joint_there_(plan_.joints.size(), true),
      body_there_(plan_.bodies.size(), true) {}

DUCTILE_INLINE void BuiltStructure::made() {
    for (std::size_t b = 0; b < plan_.bodies.size(); ++b) {
        body_made_.push_back(frame_of({PlanSeat::Kind::body, b}));
    }
    own_made_.resize(plan_.seats.size());
    for (const PlanSeat& seat : plan_.seats) {
        if (seat.kind == PlanSeat::Kind::own) own_made_[seat.index] = frame_of(seat);
    }
}

DUCTILE_INLINE void BuiltStructure::over_joints(
    const std::function<void(std::size_t)>& visit) const {
    for (std::size_t i = 0; i < joint_there_.size(); ++i) {
        if (joint_there_[i]) visit(i);
    }
}

DUCTILE_INLINE double BuiltStructure::utilisation() const {
    double most = 0;
    over_joints([&](std::size_t i) { most = std::max(most, utilisation_of(i)); });
    return most;
}

DUCTILE_INLINE std::string BuiltStructure::most_used() const {
    double most = -1;
    std::string name;
    over_joints([&](std::size_t i) {
        const double used = utilisation_of(i);
        if (!(used > most)) return;
        most = used;
        name = plan_.joints[i].name;
    });
    return name;
}

DUCTILE_INLINE double BuiltStructure::absorbed_energy() const {
    double all = 0;
    over_joints([&](std::size_t i) { all += absorbed_by(i); });
    return all;
}

DUCTILE_INLINE double BuiltStructure::stored_energy() const {
    double all = 0;
    over_joints([&](std::size_t i) { all += stored_by(i); });
    return all;
}

DUCTILE_INLINE std::size_t BuiltStructure::present_joint(std::size_t index) const {
    if (!joint_there_[index]) {
        detail::refuse("Structure.joint", plan_.joints[index].name, "one that was not removed");
    }
    return index;
}

DUCTILE_INLINE std::size_t BuiltStructure::present_body(std::size_t index) const {
    if (!body_there_[index]) {
        detail::refuse("Structure.body", plan_.bodies[index].name, "one that was not removed");
    }
    return index;
}

// ---- where it is

DUCTILE_INLINE BuiltStructure::Point BuiltStructure::point(NodeId node) const {
    if (node.index >= plan_.places.size()) {
        detail::refuse("Structure.node", detail::numbered("node", node.index),
                       "a node of the model, which has " + std::to_string(plan_.places.size()));
    }
    const PlanSeat& seat = plan_.seats[node.index];
    if (seat.kind == PlanSeat::Kind::body) (void)present_body(seat.index);
    return {seat, plan_.places[node.index]};
}

DUCTILE_INLINE BuiltStructure::Point BuiltStructure::point(std::string_view member,
                                                           double share) const {
    const PlanMember& of = plan_.members[plan_.member(member)];
    check::between("Structure.place(" + of.name + ").share", share, 0.0, 1.0, "", true);
    const Vector3<double> way = difference(of.to, of.from);
    std::size_t piece = 0; // the first that reaches so far
    for (std::size_t i = 0; i < of.joints; ++i) {
        const Vector3<double> at =
            difference(plan_.joints[of.first_joint + i].frame.origin, of.from);
        const double place = dot(at, way) / dot(way, way);
        if (place < share && !(i == 0 && of.start_jointed)) ++piece;
    }
    piece = std::min(piece, of.bodies - 1);
    return {{PlanSeat::Kind::body, present_body(of.first_body + piece)},
            sum(of.from, scaled(share, way))};
}

DUCTILE_INLINE const JointFrame<double>& BuiltStructure::made_at(const PlanSeat& seat) const {
    return seat.kind == PlanSeat::Kind::body ? body_made_[seat.index] : own_made_[seat.index];
}

DUCTILE_INLINE Vector3<double> BuiltStructure::moved(const Point& point) const {
    if (point.seat.kind == PlanSeat::Kind::ground) return Vector3<double>::Zero();
    const JointFrame<double>& then = made_at(point.seat);
    const JointFrame<double> now = frame_of(point.seat);
    const Vector3<double> arm = transposed_times(then.axes, difference(point.at, then.origin));
    return sum(difference(now.origin, then.origin), times(difference(now.axes, then.axes), arm));
}

DUCTILE_INLINE Vector3<double> BuiltStructure::displacement(NodeId node) const {
    return moved(point(node));
}
DUCTILE_INLINE Vector3<double> BuiltStructure::place(NodeId node) const {
    return sum(plan_.places[node.index], displacement(node));
}
DUCTILE_INLINE double BuiltStructure::sag(NodeId node) const {
    return -dot(plan_.up, displacement(node));
}
DUCTILE_INLINE Vector3<double> BuiltStructure::displacement(std::string_view member,
                                                            double share) const {
    return moved(point(member, share));
}
DUCTILE_INLINE Vector3<double> BuiltStructure::place(std::string_view member, double share) const {
    const Point at = point(member, share);
    return sum(at.at, moved(at));
}
DUCTILE_INLINE double BuiltStructure::sag(std::string_view member, double share) const {
    return -dot(plan_.up, displacement(member, share));
}

// ---- what is done to it

DUCTILE_INLINE void BuiltStructure::apply(const Point& point, const Vector3<double>& force) {
    detail::require_vector("Structure.apply.force", force, false);
    if (point.seat.kind == PlanSeat::Kind::ground) return;
    push(point.seat, force, sum(point.at, moved(point)));
}
DUCTILE_INLINE void BuiltStructure::apply(NodeId node, const Vector3<double>& force) {
    apply(point(node), force);
}
DUCTILE_INLINE void BuiltStructure::apply(std::string_view member, double share,
                                          const Vector3<double>& force) {
    apply(point(member, share), force);
}

DUCTILE_INLINE void BuiltStructure::cut_joint(std::size_t index) {
    if (!joint_there_[index]) return;
    drop_joint(index);
    joint_there_[index] = false;
}

DUCTILE_INLINE void BuiltStructure::cut(std::string_view member, MemberEnd end) {
    cut_joint(plan_.joint(member, end));
    wake();
}
DUCTILE_INLINE void BuiltStructure::cut(std::string_view member, std::size_t number) {
    cut_joint(plan_.joint(member, number));
    wake();
}

DUCTILE_INLINE void BuiltStructure::remove(std::string_view member) {
    const PlanMember& of = plan_.members[plan_.member(member)];
    if (!body_there_[of.first_body]) {
        detail::refuse("Structure.remove.member", of.name, "one that was not removed");
    }
    const auto goes = [&of](std::size_t body) {
        return body >= of.first_body && body < of.first_body + of.bodies;
    };
    for (std::size_t i = 0; i < plan_.joints.size(); ++i) {
        const PlanJoint& joint = plan_.joints[i];
        const bool on_it = joint.b.kind == PlanSeat::Kind::body && goes(joint.b.index);
        if (on_it || goes(joint.a)) cut_joint(i);
    }
    for (std::size_t b = of.first_body; b < of.first_body + of.bodies; ++b) {
        if (!body_there_[b]) continue;
        body_there_[b] = false;
        drop_body(b);
    }
    wake();
}

DUCTILE_INLINE void BuiltStructure::scale_weights(double factor) {
    set_gravity(check::finite("Structure.scale_weights.factor", factor, ""));
    wake();
}

} // namespace ductile
