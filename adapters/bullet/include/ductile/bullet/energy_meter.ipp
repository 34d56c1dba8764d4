// SPDX-License-Identifier: MIT
//
// Bodies of energy_meter.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>

#include <cmath>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/energy_meter.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/soft_contacts.hpp"

namespace ductile::bullet {

namespace detail {

/// Of a point of a kinematic body, else none [m/s].
[[nodiscard]] DUCTILE_INLINE Vector3<double> driven_velocity(const btCollisionObject& object,
                                                             const Vector3<double>& point) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    if (body == nullptr || !body->isKinematicObject()) return Vector3<double>::Zero();
    return contact_body(*body).at(difference(point, to_core(body->getCenterOfMassPosition())));
}

/// May bring energy in by itself, as a motor or a spring does.
[[nodiscard]] DUCTILE_INLINE bool drives(btTypedConstraint& constraint) {
    const auto axes_drive = [](btGeneric6DofSpring2Constraint& axes) {
        const btTranslationalLimitMotor2& move = *axes.getTranslationalLimitMotor();
        for (int i = 0; i < 3; ++i) {
            const btRotationalLimitMotor2& turn = *axes.getRotationalLimitMotor(i);
            if (move.m_enableMotor[i] || move.m_enableSpring[i]) return true;
            if (turn.m_enableMotor || turn.m_enableSpring) return true;
        }
        return false;
    };
    switch (constraint.getConstraintType()) {
        case POINT2POINT_CONSTRAINT_TYPE:
            return false;
        case HINGE_CONSTRAINT_TYPE:
            return static_cast<btHingeConstraint&>(constraint).getEnableAngularMotor();
        case SLIDER_CONSTRAINT_TYPE: {
            auto& slider = static_cast<btSliderConstraint&>(constraint);
            return slider.getPoweredLinMotor() || slider.getPoweredAngMotor();
        }
        case D6_SPRING_2_CONSTRAINT_TYPE:
            return axes_drive(static_cast<btGeneric6DofSpring2Constraint&>(constraint));
        default:
            return true;
    }
}
/// No motor, spring or limit of it may act; of others than these it is not told.
[[nodiscard]] DUCTILE_INLINE bool has_rigid_rows_alone(btTypedConstraint& constraint) {
    if (constraint.getConstraintType() == POINT2POINT_CONSTRAINT_TYPE) return true;
    if (constraint.getConstraintType() != HINGE_CONSTRAINT_TYPE) return false;
    auto& hinge = static_cast<btHingeConstraint&>(constraint);
    return !hinge.getEnableAngularMotor() && !hinge.hasLimit();
}

} // namespace detail

DUCTILE_INLINE EnergyMeter::EnergyMeter(btDiscreteDynamicsWorld& world) : world_(world) { open(); }

DUCTILE_INLINE EnergyMeter::~EnergyMeter() {
    if (lent_.empty()) return; // nothing to ask of a world that may have ended
    for (int i = 0; i < world_.getNumConstraints(); ++i) forget(*world_.getConstraint(i));
}

DUCTILE_INLINE void EnergyMeter::forget(btTypedConstraint& constraint) {
    const auto lent = lent_.find(&constraint);
    if (lent == lent_.end()) return;
    if (constraint.getJointFeedback() == lent->second.get()) constraint.setJointFeedback(nullptr);
    lent_.erase(lent);
}

DUCTILE_INLINE void EnergyMeter::list_bodies(std::vector<MeteredBody>& bodies) const {
    if (scope_ != nullptr) {
        for (const btRigidBody* body : scope_->bodies()) list_body(*body, bodies);
        return;
    }
    const auto& objects = world_.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        const btRigidBody* body = btRigidBody::upcast(objects[i]);
        if (body != nullptr && !body->isStaticOrKinematicObject()) list_body(*body, bodies);
    }
}

DUCTILE_INLINE void EnergyMeter::list_body(const btRigidBody& body,
                                           std::vector<MeteredBody>& bodies) {
    const Matrix3<double> axes = to_core(body.getCenterOfMassTransform().getBasis());
    MeteredBody& entry = bodies.emplace_back();
    entry.body = &body;
    entry.position = to_core(body.getCenterOfMassPosition());
    entry.velocity = to_core(body.getLinearVelocity());
    entry.spin = to_core(body.getAngularVelocity());
    entry.mass = double(body.getMass());
    entry.inertia = sandwiched(axes, to_core(body.getLocalInertia()));
    entry.weight = scaled(entry.mass, to_core(body.getGravity()));
    entry.force = to_core(body.getTotalForce());
    entry.torque = to_core(body.getTotalTorque());
    entry.asleep = !body.isActive();
}

DUCTILE_INLINE void EnergyMeter::list_plastic_joints(
    std::vector<MeteredPlasticJoint>& joints) const {
    for (btTypedConstraint* constraint : constraints_of(world_, scope_)) {
        const PlasticConstraint* plastic = as_plastic(*constraint);
        if (plastic == nullptr) continue;
        joints.push_back(
            {&plastic->queries(), &plastic->getRigidBodyA(), &plastic->getRigidBodyB()});
    }
}

DUCTILE_INLINE void EnergyMeter::watch_step() {
    for (btTypedConstraint* constraint : constraints_of(world_, scope_)) {
        if (constraint->getJointFeedback() == nullptr) {
            auto& lent = lent_[constraint];
            if (lent == nullptr) lent = std::make_unique<btJointFeedback>();
            constraint->setJointFeedback(lent.get());
        }
        btJointFeedback& feedback = *constraint->getJointFeedback();
        feedback.m_appliedForceBodyA.setZero();
        feedback.m_appliedTorqueBodyA.setZero();
        feedback.m_appliedForceBodyB.setZero();
        feedback.m_appliedTorqueBodyB.setZero();
    }
}

DUCTILE_INLINE void EnergyMeter::list_joints(std::vector<MeteredJoint>& joints) const {
    for (btTypedConstraint* each : constraints_of(world_, scope_)) {
        btTypedConstraint& constraint = *each;
        const btJointFeedback* feedback = constraint.getJointFeedback();
        if (feedback == nullptr) continue;
        const PlasticConstraint* plastic = as_plastic(constraint);
        MeteredJoint& joint = joints.emplace_back();
        joint = {&constraint,
                 feedback, // what hangs on a member keeps it (attachment.hpp)
                 &constraint.getRigidBodyA(),
                 &constraint.getRigidBodyB(),
                 to_core(feedback->m_appliedForceBodyA),
                 to_core(feedback->m_appliedTorqueBodyA),
                 to_core(feedback->m_appliedForceBodyB),
                 to_core(feedback->m_appliedTorqueBodyB),
                 plastic != nullptr ? &plastic->queries() : nullptr,
                 constraint.getRigidBodyA().isKinematicObject() ||
                     constraint.getRigidBodyB().isKinematicObject() ||
                     (plastic == nullptr && detail::drives(constraint))};
        if (plastic != nullptr || detail::has_rigid_rows_alone(constraint)) continue;
        joint.own_force = joint.force_a;
        joint.own_torque_a = joint.torque_a;
        joint.own_torque_b = scaled(-1, joint.torque_b);
    }
}

DUCTILE_INLINE void EnergyMeter::list_contacts(double /*dt*/,
                                               std::vector<MeteredContact>& contacts) const {
    for (const btPersistentManifold* manifold : manifolds_of(*world_.getDispatcher(), scope_)) {
        list_contacts_of(*manifold, contacts);
    }
}

DUCTILE_INLINE void EnergyMeter::list_contacts_of(const btPersistentManifold& manifold,
                                                  std::vector<MeteredContact>& contacts) {
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
        const btManifoldPoint& point = manifold.getContactPoint(j);
        // the second one is zero where only one direction was solved (front_solver.hpp)
        const btVector3 lateral = point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                  point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
        const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
        MeteredContact& contact = contacts.emplace_back();
        contact = {btRigidBody::upcast(&a),
                   btRigidBody::upcast(&b),
                   to_core(point.getPositionWorldOnA()),
                   to_core(point.getPositionWorldOnB()),
                   scaled(double(point.m_appliedImpulse), to_core(point.m_normalWorldOnB)),
                   to_core(lateral),
                   a.isKinematicObject() || b.isKinematicObject()};
        contact.gives = gives_way(point);
        if (!contact.driven) continue;
        contact.driven_velocity = difference(detail::driven_velocity(a, contact.point_a),
                                             detail::driven_velocity(b, contact.point_b));
    }
}

DUCTILE_INLINE Vector3<double> EnergyMeter::gyroscopic_impulse(const MeteredBody& body,
                                                               double dt) const {
    return bullet::gyroscopic_impulse(*static_cast<const btRigidBody*>(body.body), body.inertia,
                                      body.spin, dt);
}

DUCTILE_INLINE void EnergyMeter::damp(MeteredBody& body, double dt) const {
    const auto& of = *static_cast<const btRigidBody*>(body.body);
    if (of.getLinearDamping() != 0) {
        body.velocity = scaled(std::pow(1 - double(of.getLinearDamping()), dt), body.velocity);
    }
    if (of.getAngularDamping() != 0) {
        body.spin = scaled(std::pow(1 - double(of.getAngularDamping()), dt), body.spin);
    }
}

} // namespace ductile::bullet
