// SPDX-License-Identifier: MIT
//
// Bodies of structure.hpp.
#pragma once

#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/structure.hpp"

namespace ductile::bullet {

DUCTILE_INLINE Structure::Structure(World& world, const StructureModel& model,
                                    const std::vector<OwnBody>& own)
    : JointedStructure(world, model, own), gravity_(world.engine().getGravity()) {
    for (const PlanBody& body : plan().bodies) make_body(body);
    for (const auto& [a, b] : plan().neighbours) {
        parts_[a].body->setIgnoreCollisionCheck(parts_[b].body.get(), true);
    }
    for (const PlanJoint& joint : plan().joints) make_joint(joint);
    made();
}

DUCTILE_INLINE Structure::~Structure() {
    joints_.clear();
    for (const Part& part : parts_) {
        if (part.body != nullptr) world_.engine().removeRigidBody(part.body.get());
    }
}

DUCTILE_INLINE void Structure::make_body(const PlanBody& plan) {
    Part part;
    part.box = std::make_unique<btBoxShape>(to_bullet(plan.half_lengths));
    btCollisionShape* shape = part.box.get();
    if (!is_zero(plan.box.origin) || plan.box.axes != Matrix3<double>::Identity()) {
        part.around = std::make_unique<btCompoundShape>();
        part.around->addChildShape(to_bullet(plan.box), shape);
        shape = part.around.get();
    }
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(plan.mass), nullptr, shape,
                                                  to_bullet(plan.inertia));
    info.m_startWorldTransform = to_bullet(plan.pose);
    part.body = std::make_unique<btRigidBody>(info);
    if (plan.collides) {
        world_.engine().addRigidBody(part.body.get());
    } else {
        world_.engine().addRigidBody(part.body.get(), 0, 0);
    }
    parts_.push_back(std::move(part));
}

DUCTILE_INLINE void Structure::make_joint(const PlanJoint& plan) {
    btRigidBody& a = *parts_[plan.a].body;
    btRigidBody& b =
        plan.b.kind == PlanSeat::Kind::ground ? btTypedConstraint::getFixedBody() : *at(plan.b);
    const auto frame_in = [&plan](const JointFrame<double>& body) {
        return to_bullet(JointFrame<double>{
            transposed_times(body.axes, difference(plan.frame.origin, body.origin)),
            transposed_times(body.axes, plan.frame.axes)});
    };
    // of the plan's bodies from the plan: those of the engine may be rounded to float
    const auto frame_in_b = plan.b.kind == PlanSeat::Kind::body
                                ? frame_in(this->plan().bodies[plan.b.index].pose)
                                : frame_in(to_core(b.getCenterOfMassTransform()));
    joints_.push_back(std::make_unique<Joint>(a, b, frame_in(this->plan().bodies[plan.a].pose),
                                              frame_in_b, plan.joint));
    joints_.back()->add_to(world_.engine(), plan.b.kind != PlanSeat::Kind::ground);
    world_.add(*joints_.back(), plan.name);
}

DUCTILE_INLINE btRigidBody& Structure::body(std::string_view member, std::size_t piece) const {
    return *parts_[present_body(plan().body(member, piece))].body;
}

// ---- what BuiltStructure asks of Bullet

DUCTILE_INLINE JointFrame<double> Structure::frame_of(const PlanSeat& seat) const {
    return to_core(at(seat)->getCenterOfMassTransform());
}

DUCTILE_INLINE void Structure::push(const PlanSeat& seat, const Vector3<double>& force,
                                    const Vector3<double>& at_place) {
    world_.apply_force(*at(seat), force, at_place);
}

DUCTILE_INLINE void Structure::drop_body(std::size_t body) {
    btRigidBody* gone = parts_[body].body.get();
    for (const auto& [a, b] : plan().neighbours) {
        if (b == body && parts_[a].body != nullptr) {
            parts_[a].body->setIgnoreCollisionCheck(gone, false);
        }
    }
    world_.engine().removeRigidBody(gone);
    parts_[body] = {};
}

DUCTILE_INLINE void Structure::wake() {
    for (const Part& part : parts_) {
        if (part.body != nullptr) part.body->activate(true);
    }
}

DUCTILE_INLINE void Structure::set_gravity(double factor) {
    const btVector3 gravity = gravity_ * btScalar(factor);
    btDiscreteDynamicsWorld& engine = world_.engine();
    for (int i = 0; i < engine.getNumCollisionObjects(); ++i) {
        engine.getCollisionObjectArray()[i]->activate(); // Bullet leaves out those asleep
    }
    engine.setGravity(gravity);
}

} // namespace ductile::bullet
