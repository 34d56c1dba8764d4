// SPDX-License-Identifier: MIT
//
// The core's energy ledger of a Bullet world (world/energy_meter.hpp): which bodies, constraints
// and contacts there are. Joints are booked by their joint feedback, contacts by the impulses of
// their manifold points. Rolling and spinning friction are not booked: where a scene uses them they
// stay unexplained.
//
//   EnergyMeter meter(world);
//   meter.before_step();
//   world.stepSimulation(dt, 0);
//   meter.after_step(dt);
//
// The meter turns on joint feedback for constraints that have none (the user's own is only read).
// Contact impulses are written back by Bullet only in SOLVER_USE_WARMSTARTING mode, its default.
// One internal tick per before/after pair: call stepSimulation with maxSubSteps 0.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>
#include <memory>
#include <unordered_map>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/local_scope.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/soft_contacts.hpp"
#include "ductile/world/energy_meter.hpp"

namespace ductile::bullet {

namespace detail {

/// Of a point of a kinematic body, else none [m/s].
[[nodiscard]] inline Vector3<double> driven_velocity(const btCollisionObject& object,
                                                     const Vector3<double>& point) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    if (body == nullptr || !body->isKinematicObject()) return Vector3<double>::Zero();
    return contact_body(*body).at(difference(point, to_core(body->getCenterOfMassPosition())));
}

/// May bring energy in by itself, as a motor or a spring does.
[[nodiscard]] inline bool drives(btTypedConstraint& constraint) {
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
[[nodiscard]] inline bool has_rigid_rows_alone(btTypedConstraint& constraint) {
    if (constraint.getConstraintType() == POINT2POINT_CONSTRAINT_TYPE) return true;
    if (constraint.getConstraintType() != HINGE_CONSTRAINT_TYPE) return false;
    auto& hinge = static_cast<btHingeConstraint&>(constraint);
    return !hinge.getEnableAngularMotor() && !hinge.hasLimit();
}

} // namespace detail

class EnergyMeter final : public ductile::EnergyMeter {
  public:
    /// The world must outlive the meter. Opens the ledger with what the world holds now.
    explicit EnergyMeter(btDiscreteDynamicsWorld& world) : world_(world) { open(); }
    /// Takes the feedback it lent away from the constraints again.
    ~EnergyMeter() {
        if (lent_.empty()) return; // nothing to ask of a world that may have ended
        for (int i = 0; i < world_.getNumConstraints(); ++i) forget(*world_.getConstraint(i));
    }

    /// From now on it lists these alone; null: all again.
    void set_scope(const LocalScope* scope) noexcept { scope_ = scope; }
    /// To be called for a constraint that leaves the world: takes back the feedback lent to it.
    void forget(btTypedConstraint& constraint) {
        const auto lent = lent_.find(&constraint);
        if (lent == lent_.end()) return;
        if (constraint.getJointFeedback() == lent->second.get()) {
            constraint.setJointFeedback(nullptr);
        }
        lent_.erase(lent);
    }
    /// Energy that all rows of a constraint took from the bodies since the meter was made [J].
    [[nodiscard]] double taken_by(const btTypedConstraint& constraint) const {
        return taken_by_address(&constraint);
    }

  private:
    void list_bodies(std::vector<MeteredBody>& bodies) const override {
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
    void list_plastic_joints(std::vector<MeteredPlasticJoint>& joints) const override {
        for (btTypedConstraint* constraint : constraints_of(world_, scope_)) {
            const PlasticConstraint* plastic = as_plastic(*constraint);
            if (plastic == nullptr) continue;
            joints.push_back(
                {&plastic->queries(), &plastic->getRigidBodyA(), &plastic->getRigidBodyB()});
        }
    }
    void watch_step() override {
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
    void list_joints(std::vector<MeteredJoint>& joints) const override {
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
    void list_contacts(double /*dt*/, std::vector<MeteredContact>& contacts) const override {
        for (const btPersistentManifold* manifold : manifolds_of(*world_.getDispatcher(), scope_)) {
            list_contacts_of(*manifold, contacts);
        }
    }
    [[nodiscard]] Vector3<double> gyroscopic_impulse(const MeteredBody& body,
                                                     double dt) const override {
        return bullet::gyroscopic_impulse(*static_cast<const btRigidBody*>(body.body), body.inertia,
                                          body.spin, dt);
    }
    void damp(MeteredBody& body, double dt) const override {
        const auto& of = *static_cast<const btRigidBody*>(body.body);
        if (of.getLinearDamping() != 0) {
            body.velocity = scaled(std::pow(1 - double(of.getLinearDamping()), dt), body.velocity);
        }
        if (of.getAngularDamping() != 0) {
            body.spin = scaled(std::pow(1 - double(of.getAngularDamping()), dt), body.spin);
        }
    }

    static void list_body(const btRigidBody& body, std::vector<MeteredBody>& bodies) {
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
    static void list_contacts_of(const btPersistentManifold& manifold,
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

    btDiscreteDynamicsWorld& world_;
    const LocalScope* scope_ = nullptr;
    std::unordered_map<const btTypedConstraint*, std::unique_ptr<btJointFeedback>> lent_;
};

} // namespace ductile::bullet
