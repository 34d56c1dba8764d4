// SPDX-License-Identifier: MIT
//
// Keeps the core's energy ledger for a Bullet world, step by step.
//
//   EnergyMeter meter(world);
//   meter.before_step();
//   world.stepSimulation(dt, 0);
//   meter.after_step(dt);
//
// The solver's update is v' = v + M⁻¹ Σ impulses, so each impulse's work is impulse × (u + u')/2 at
// its point, and the sum is the change of kinetic energy to round-off. Booked:
//   plastic      what every PlasticConstraint says it absorbed
//   joints       work of all constraints (their joint feedback), less the plastic part and what
//                elastic joints store, which the world holds
//   contact      normal impulses of all manifold points
//   friction     lateral impulses of all manifold points
//   integration  gravity's work against the change of potential energy; damping; gyroscopic torque
//                and the turning of inertia tensors
// Rolling and spinning friction are not booked: where a scene uses them they stay unexplained.
//
// The meter turns on joint feedback for constraints that have none (the user's own is only read).
// Contact impulses are written back by Bullet only in SOLVER_USE_WARMSTARTING mode, its default.
// One internal tick per before/after pair: call stepSimulation with maxSubSteps 0.
//
// Cost: O(bodies + constraints + contact points) per step. Not thread-safe.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/LU>
#include <cmath>
#include <deque>
#include <unordered_map>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/energy.hpp"

namespace ductile::bullet {

class EnergyMeter {
  public:
    /// The world must outlive the meter. Opens the ledger with what the world holds now.
    explicit EnergyMeter(btDiscreteDynamicsWorld& world) : world_(world) { open(); }

    /// Takes the feedback it lent away from the constraints again.
    ~EnergyMeter() {
        for (int i = 0; i < world_.getNumConstraints(); ++i) {
            btTypedConstraint& constraint = *world_.getConstraint(i);
            const auto lent = feedback_of_.find(&constraint);
            if (lent != feedback_of_.end() && constraint.getJointFeedback() == lent->second) {
                constraint.setJointFeedback(nullptr);
            }
        }
    }
    EnergyMeter(const EnergyMeter&) = delete;
    EnergyMeter& operator=(const EnergyMeter&) = delete;

    /// To be called for a constraint that leaves the world: takes back the feedback lent to it.
    void forget(btTypedConstraint& constraint) {
        const auto lent = feedback_of_.find(&constraint);
        if (lent == feedback_of_.end()) return;
        if (constraint.getJointFeedback() == lent->second) constraint.setJointFeedback(nullptr);
        feedback_of_.erase(lent);
    }

    void open() {
        ledger_.open(held());
        last_ = ledger_.held();
    }
    [[nodiscard]] const Ledger<double>& ledger() const noexcept { return ledger_; }
    /// Energy that all rows of a constraint took from the bodies since the meter was made [J].
    [[nodiscard]] double taken_by(const btTypedConstraint& constraint) const {
        const auto entry = taken_.find(&constraint);
        return entry != taken_.end() ? entry->second : 0;
    }

    void before_step() {
        // what somebody changed between the steps came from outside
        const HeldEnergy<double> now = held();
        ledger_.supply(now.total() - last_.total());
        start_.clear();
        for_each_body([this](btRigidBody& body) { start_.emplace(&body, BodyStart(body)); });
        for (int i = 0; i < world_.getNumConstraints(); ++i) {
            btTypedConstraint& constraint = *world_.getConstraint(i);
            if (constraint.getJointFeedback() == nullptr) lend_feedback(constraint);
            *constraint.getJointFeedback() = no_feedback();
            if (auto* plastic = dynamic_cast<PlasticConstraint*>(&constraint)) {
                plastic_start_[plastic] = {plastic->absorbed_energy(), plastic->stored_energy(),
                                           plastic->release().energy};
            }
        }
    }

    /// Books the step of `dt` [s] that was opened by `before_step`, for the share `share` of which
    /// forces acted (force_share.hpp).
    void after_step(double dt, double share = 1) {
        for (auto& [body, start] : start_) start.finish(*body, dt);
        for (int i = 0; i < world_.getNumConstraints(); ++i) undo_release(*world_.getConstraint(i));
        for (auto& [body, start] : start_) book_body(*body, start, dt, share);
        for (int i = 0; i < world_.getNumConstraints(); ++i) {
            book_constraint(*world_.getConstraint(i), dt);
        }
        book_contacts();
        last_ = held();
        ledger_.update(last_);
    }

    /// What the world's dynamic bodies and elastic joints hold now. Potential energy is measured
    /// from the origin, with each body's own gravity.
    [[nodiscard]] HeldEnergy<double> held() const {
        HeldEnergy<double> result;
        for_each_body([&result](const btRigidBody& body) {
            const Vector3<double> v = to_core(body.getLinearVelocity());
            const Vector3<double> w = to_core(body.getAngularVelocity());
            result.kinetic += mass(body) * v.squaredNorm() / 2 + w.dot(inertia(body) * w) / 2;
            result.potential -=
                mass(body) *
                to_core(body.getGravity()).dot(to_core(body.getCenterOfMassPosition()));
        });
        for (int i = 0; i < world_.getNumConstraints(); ++i) {
            if (auto* plastic = dynamic_cast<PlasticConstraint*>(world_.getConstraint(i))) {
                result.elastic += plastic->stored_energy();
            }
        }
        return result;
    }

  private:
    /// A body's motion over one step, in the frame in which the solver saw it.
    struct BodyStart {
        explicit BodyStart(const btRigidBody& body)
            : position(to_core(body.getCenterOfMassPosition())),
              linear(to_core(body.getLinearVelocity())),
              angular(to_core(body.getAngularVelocity())),
              inertia_world(inertia(body)),
              force(to_core(body.getTotalForce())),
              torque(to_core(body.getTotalTorque())) {}

        void finish(const btRigidBody& body, double dt) {
            raw_linear = linear;
            raw_angular = angular;
            linear *= std::pow(1 - double(body.getLinearDamping()), dt);
            angular *= std::pow(1 - double(body.getAngularDamping()), dt);
            linear_after = to_core(body.getLinearVelocity());
            angular_after = to_core(body.getAngularVelocity());
        }

        [[nodiscard]] double kinetic(const btRigidBody& body, const Vector3<double>& v,
                                     const Vector3<double>& w) const {
            return mass(body) * v.squaredNorm() / 2 + w.dot(inertia_world * w) / 2;
        }

        Vector3<double> position;
        Vector3<double> linear; ///< at the start of the solve, after damping
        Vector3<double> angular;
        Matrix3<double> inertia_world;
        Vector3<double> force; ///< applied by the user
        Vector3<double> torque;
        Vector3<double> raw_linear{0, 0, 0}; ///< before damping
        Vector3<double> raw_angular{0, 0, 0};
        Vector3<double> linear_after{0, 0, 0}; ///< after the solve, before a break's release
        Vector3<double> angular_after{0, 0, 0};
    };

    /// A plastic constraint's totals at the start of the step [J].
    struct PlasticStart {
        double absorbed = 0;
        double stored = 0;
        double released = 0;
    };

    static double mass(const btRigidBody& body) { return double(body.getMass()); }

    static Matrix3<double> inertia(const btRigidBody& body) {
        const Matrix3<double> basis = to_core(body.getCenterOfMassTransform().getBasis());
        return basis * to_core(body.getLocalInertia()).asDiagonal() * basis.transpose();
    }

    template <class Action>
    void for_each_body(Action&& action) const {
        const auto& objects = world_.getCollisionObjectArray();
        for (int i = 0; i < objects.size(); ++i) {
            btRigidBody* body = btRigidBody::upcast(objects[i]);
            if (body != nullptr && !body->isStaticOrKinematicObject()) action(*body);
        }
    }

    static btJointFeedback no_feedback() {
        btJointFeedback feedback;
        feedback.m_appliedForceBodyA.setZero();
        feedback.m_appliedTorqueBodyA.setZero();
        feedback.m_appliedForceBodyB.setZero();
        feedback.m_appliedTorqueBodyB.setZero();
        return feedback;
    }

    void lend_feedback(btTypedConstraint& constraint) {
        btJointFeedback& feedback = feedback_.emplace_back(no_feedback());
        feedback_of_[&constraint] = &feedback;
        constraint.setJointFeedback(&feedback);
    }

    /// A break's release acted after the solve; the rows' work wants the velocities before it.
    void undo_release(btTypedConstraint& constraint) {
        auto* plastic = dynamic_cast<PlasticConstraint*>(&constraint);
        if (plastic == nullptr) return;
        const BreakRelease<double>& release = plastic->release();
        if (release.energy == plastic_start_.at(plastic).released) return;
        take_back(constraint.getRigidBodyA(), release.a);
        take_back(constraint.getRigidBodyB(), release.b);
    }
    void take_back(const btRigidBody& body, const VelocityChange<double>& change) {
        const auto start = start_.find(&body);
        if (start == start_.end()) return;
        start->second.linear_after -= change.linear;
        start->second.angular_after -= change.angular;
    }

    void book_body(const btRigidBody& body, const BodyStart& start, double dt, double share) {
        const Vector3<double> mean_linear = (start.linear + start.linear_after) / 2;
        const Vector3<double> mean_angular = (start.angular + start.angular_after) / 2;
        const Vector3<double> weight = mass(body) * to_core(body.getGravity());
        ledger_.supply(share * dt *
                       (start.force.dot(mean_linear) + start.torque.dot(mean_angular)));

        const double damping = start.kinetic(body, start.raw_linear, start.raw_angular) -
                               start.kinetic(body, start.linear, start.angular);
        const Vector3<double> moved = to_core(body.getCenterOfMassPosition()) - start.position;
        const double potential = weight.dot(moved) - share * dt * weight.dot(mean_linear);
        const Vector3<double>& w = start.angular_after;
        const double turning = w.dot((start.inertia_world - inertia(body)) * w) / 2;
        const double gyroscopic = -gyroscopic_impulse(body, start, dt).dot(mean_angular);
        ledger_.book(Account::integration, damping + potential + turning + gyroscopic);
    }

    /// Angular impulse [N m s] that Bullet adds for ω × Iω, by the implicit rule in body axes.
    static Vector3<double> gyroscopic_impulse(const btRigidBody& body, const BodyStart& start,
                                              double dt) {
        if ((body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) == 0) {
            return Vector3<double>::Zero();
        }
        // one Newton step on I(ω' - ω) + dt ω' × Iω' = 0 in body axes, as Bullet takes it
        const Matrix3<double>& inertia = start.inertia_world;
        const Vector3<double>& w = start.angular;
        const Vector3<double> momentum = inertia * w;
        const Matrix3<double> jacobian = inertia + dt * (cross(w) * inertia - cross(momentum));
        const Vector3<double> change = -jacobian.partialPivLu().solve(dt * w.cross(momentum));
        return inertia * change;
    }
    static Matrix3<double> cross(const Vector3<double>& v) {
        Matrix3<double> m;
        m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
        return m;
    }

    /// Work that a force and a torque about the centre of mass do on a body over the step [J].
    [[nodiscard]] double work(const btRigidBody& body, const Vector3<double>& force,
                              const Vector3<double>& torque, double dt) const {
        const auto start = start_.find(&body);
        if (start == start_.end()) return 0;
        const BodyStart& s = start->second;
        return dt / 2 *
               (force.dot(s.linear + s.linear_after) + torque.dot(s.angular + s.angular_after));
    }

    void book_constraint(btTypedConstraint& constraint, double dt) {
        const btJointFeedback* feedback = constraint.getJointFeedback();
        if (feedback == nullptr) return;
        const double taken =
            -work(constraint.getRigidBodyA(), to_core(feedback->m_appliedForceBodyA),
                  to_core(feedback->m_appliedTorqueBodyA), dt) -
            work(constraint.getRigidBodyB(), to_core(feedback->m_appliedForceBodyB),
                 to_core(feedback->m_appliedTorqueBodyB), dt);
        double named = 0;
        if (auto* plastic = dynamic_cast<PlasticConstraint*>(&constraint)) {
            const PlasticStart& before = plastic_start_.at(plastic);
            const double flow = plastic->absorbed_energy() - before.absorbed;
            ledger_.book(Account::plastic, flow);
            // what a break released was taken by the row and given back after the solve; what was
            // stored then is set free inside the part
            named = flow + plastic->stored_energy() - before.stored + plastic->release().energy -
                    before.released;
        }
        ledger_.book(Account::joints, taken - named);
        taken_[&constraint] += taken;
    }

    void book_contacts() {
        btDispatcher& dispatcher = *world_.getDispatcher();
        for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
            const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
            const btRigidBody* a = btRigidBody::upcast(manifold.getBody0());
            const btRigidBody* b = btRigidBody::upcast(manifold.getBody1());
            for (int j = 0; j < manifold.getNumContacts(); ++j) {
                const btManifoldPoint& point = manifold.getContactPoint(j);
                const Vector3<double> sum = relative_velocity_sum(a, point.getPositionWorldOnA()) -
                                            relative_velocity_sum(b, point.getPositionWorldOnB());
                const auto lost = [&sum](btScalar impulse, const btVector3& direction) {
                    return -double(impulse) * to_core(direction).dot(sum) / 2;
                };
                ledger_.book(Account::contact,
                             lost(point.m_appliedImpulse, point.m_normalWorldOnB));
                ledger_.book(Account::friction,
                             lost(point.m_appliedImpulseLateral1, point.m_lateralFrictionDir1));
                if (world_.getSolverInfo().m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) {
                    ledger_.book(Account::friction,
                                 lost(point.m_appliedImpulseLateral2, point.m_lateralFrictionDir2));
                }
            }
        }
    }

    /// Sum of the velocities before and after the step at a world point of the body [m/s].
    [[nodiscard]] Vector3<double> relative_velocity_sum(const btRigidBody* body,
                                                        const btVector3& point) const {
        const auto start = body != nullptr ? start_.find(body) : start_.end();
        if (start == start_.end()) return Vector3<double>::Zero();
        const BodyStart& s = start->second;
        const Vector3<double> arm = to_core(point) - s.position;
        return s.linear + s.linear_after + (s.angular + s.angular_after).cross(arm);
    }

    btDiscreteDynamicsWorld& world_;
    Ledger<double> ledger_;
    HeldEnergy<double> last_;
    std::unordered_map<const btRigidBody*, BodyStart> start_;
    std::unordered_map<const PlasticConstraint*, PlasticStart> plastic_start_;
    std::unordered_map<const btTypedConstraint*, double> taken_;
    std::deque<btJointFeedback> feedback_;
    std::unordered_map<const btTypedConstraint*, btJointFeedback*> feedback_of_;
};

} // namespace ductile::bullet
