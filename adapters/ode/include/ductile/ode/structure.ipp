// SPDX-License-Identifier: MIT
//
// Bodies of structure.hpp.
#pragma once

#include <algorithm>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/piece.hpp"
#include "ductile/ode/structure.hpp"

namespace ductile::ode {

DUCTILE_INLINE Structure::Structure(World& world, dSpaceID space, const StructureModel& model,
                                    const std::vector<OwnBody>& own)
    : JointedStructure(world, model, own), gravity_(gravity_of(world.id())) {
    for (const PlanBody& body : plan().bodies) make_body(body, space);
    for (const PlanJoint& joint : plan().joints) make_joint(joint);
    made();
}

DUCTILE_INLINE Structure::~Structure() {
    joints_.clear();
    for (std::size_t b = 0; b < parts_.size(); ++b) {
        if (parts_[b].body != nullptr) Structure::drop_body(b);
    }
}

DUCTILE_INLINE void Structure::make_body(const PlanBody& plan, dSpaceID space) {
    Part part{.body = dBodyCreate(world_.id())};
    detail::set_mass(part.body, plan.mass, plan.inertia);
    detail::put(part.body, plan.pose, {});
    dBodySetFiniteRotationMode(part.body, 1);
    part.box = detail::box_of(plan, space);
    if (part.box != nullptr) detail::put_on(part.box, part.body, plan.box);
    world_.add(part.body);
    parts_.push_back(part);
}

DUCTILE_INLINE void Structure::make_joint(const PlanJoint& plan) {
    joints_.push_back(std::make_unique<Joint>(world_.id(), parts_[plan.a].body, at(plan.b),
                                              plan.frame, plan.joint));
    world_.add(*joints_.back(), plan.name);
}

DUCTILE_INLINE dBodyID Structure::body(std::string_view member, std::size_t piece) const {
    return parts_[present_body(plan().body(member, piece))].body;
}

DUCTILE_INLINE bool Structure::meet(dBodyID a, dBodyID b) const {
    if (a == nullptr || b == nullptr) return false;
    if (dAreConnected(a, b) != 0) return true;
    return std::any_of(plan().neighbours.begin(), plan().neighbours.end(), [&](const auto& pair) {
        const dBodyID first = parts_[pair.first].body, second = parts_[pair.second].body;
        return (first == a && second == b) || (first == b && second == a);
    });
}

// ---- what BuiltStructure asks of ODE

DUCTILE_INLINE JointFrame<double> Structure::frame_of(const PlanSeat& seat) const {
    const BodyState<double> now = body_motion(at(seat));
    return {now.position, now.orientation};
}

DUCTILE_INLINE void Structure::push(const PlanSeat& seat, const Vector3<double>& force,
                                    const Vector3<double>& at_place) {
    world_.apply_force(at(seat), force, at_place);
}

DUCTILE_INLINE void Structure::drop_body(std::size_t body) {
    Part& part = parts_[body];
    world_.remove(part.body);
    if (part.box != nullptr) dGeomDestroy(part.box);
    dBodyDestroy(part.body);
    part = {};
}

DUCTILE_INLINE void Structure::wake() {
    for (const Part& part : parts_) {
        if (part.body != nullptr) dBodyEnable(part.body);
    }
}

DUCTILE_INLINE void Structure::set_gravity(double factor) {
    dWorldSetGravity(world_.id(), dReal(factor * gravity_.x()), dReal(factor * gravity_.y()),
                     dReal(factor * gravity_.z()));
}

} // namespace ductile::ode
