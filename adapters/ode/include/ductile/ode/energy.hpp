// SPDX-License-Identifier: MIT
//
// Keeps the core's energy ledger for an ODE world, step by step.
//
//   EnergyMeter meter(world_id);
//   meter.add(body);                                  // every dynamic body, once
//   ... collide: meter.add_contact(joint, geometry);  // every contact joint of this step
//   meter.before_step();
//   stepper.step(dt);
//   meter.after_step(dt);
//
// ODE's update is v' = v + M⁻¹ Σ impulses, so each impulse's work is impulse × (u + u')/2 at its
// point, and the sum is the change of kinetic energy to round-off. Booked:
//   plastic      what every PlasticConstraint added to the meter says it absorbed
//   joints       work of all joints of the bodies (their feedback and what a plastic constraint
//   applies
//                beside it), less what is plastic and what is stored
//   contact      normal part of the contact joints' work
//   friction     tangential part of the contact joints' work
//   integration  gravity's work against the change of potential energy; gyroscopic torque and the
//                turning of inertia tensors; motion that ends because ODE puts a body to sleep
// What plastic constraints store is held as elastic energy.
// ODE's damping and its limit of angular speed are not booked: where a scene uses them they stay
// unexplained.
//
// The meter turns on joint feedback for joints that have none (the user's own is only read).
//
// Cost: O(bodies + joints) per step. Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <Eigen/LU>
#include <cstddef>
#include <deque>
#include <unordered_map>
#include <vector>

#include "ductile/energy.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/plastic_constraint.hpp"

namespace ductile::ode {

class EnergyMeter {
  public:
    explicit EnergyMeter(dWorldID world) : world_(world) {}

    EnergyMeter(const EnergyMeter&) = delete;
    EnergyMeter& operator=(const EnergyMeter&) = delete;

    /// Watches a dynamic body.
    void add(dBodyID body) { bodies_.push_back(body); }
    /// To be called before the body is destroyed: what it holds leaves the ledger as supplied
    /// (negative).
    void remove(dBodyID body) { std::erase(bodies_, body); }
    /// Watches a plastic constraint, so that its share of the joints' work is booked as plastic.
    void add(PlasticConstraint& constraint) { plastic_.emplace_back(&constraint); }
    /// To be called before the constraint is destroyed; what it stores leaves as with a body.
    void remove(PlasticConstraint& constraint) {
        std::erase_if(plastic_, [&](const auto& p) { return p.constraint == &constraint; });
    }
    /// Names a contact joint of the coming step, so that its work is booked as contact and
    /// friction.
    void add_contact(dJointID joint, const dContactGeom& geometry) {
        contacts_[joint] = {to_core(geometry.pos), to_core(geometry.normal)};
    }

    /// Starts a new account with what the bodies hold now.
    void open() {
        ledger_.open(held());
        last_ = ledger_.held();
    }
    [[nodiscard]] const Ledger<double>& ledger() const noexcept { return ledger_; }
    /// Energy that all rows of a joint took from the bodies since the meter was made [J].
    [[nodiscard]] double taken_by(dJointID joint) const {
        const auto entry = taken_.find(joint);
        return entry != taken_.end() ? entry->second : 0;
    }

    void before_step() {
        // what somebody changed between the steps came from outside
        ledger_.supply(held().total() - last_.total());
        take_feedback_back(); // of a step that was never made
        start_.clear();
        for (dBodyID body : bodies_) start_.emplace(body, BodyStart(body));
        feedback_.clear();
        for (dBodyID body : bodies_) {
            for (int i = 0; i < dBodyGetNumJoints(body); ++i) watch(dBodyGetJoint(body, i), body);
        }
        for (PlasticShare& share : plastic_) {
            share.absorbed = share.constraint->absorbed_energy();
            share.stored = share.constraint->stored_energy();
            share.released = share.constraint->release().energy;
        }
        plastic_of_.clear();
        for (std::size_t i = 0; i < plastic_.size(); ++i) {
            plastic_of_.emplace(plastic_[i].constraint->id(), i);
        }
    }

    /// Books the step of `dt` [s] that was opened by `before_step`, for the share `share` of which
    /// forces acted (force_share.hpp).
    void after_step(double dt, double share = 1) {
        for (auto& [body, start] : start_) start.finish(body);
        for (const PlasticShare& share : plastic_) undo_release(share);
        for (dBodyID body : bodies_) {
            const auto start = start_.find(body);
            if (start != start_.end()) book_body(body, start->second, dt, share);
        }
        for (const WatchedJoint& joint : joints_) book_joint(joint, dt);
        take_feedback_back();
        contacts_.clear();
        last_ = held();
        ledger_.update(last_);
    }

    /// What the watched bodies hold now; potential energy is measured from the origin.
    [[nodiscard]] HeldEnergy<double> held() const {
        HeldEnergy<double> result;
        for (const PlasticShare& share : plastic_) {
            result.elastic += share.constraint->stored_energy();
        }
        for (dBodyID body : bodies_) {
            const Vector3<double> v = linear_velocity(body);
            const Vector3<double> w = angular_velocity(body);
            result.kinetic += mass(body) * v.squaredNorm() / 2 + w.dot(inertia(body) * w) / 2;
            result.potential -= weight(body).dot(to_core(dBodyGetPosition(body)));
        }
        return result;
    }

  private:
    /// A body's motion over one step, in the frame in which the solver saw it.
    struct BodyStart {
        explicit BodyStart(dBodyID body)
            : position(to_core(dBodyGetPosition(body))),
              linear(linear_velocity(body)),
              angular(angular_velocity(body)),
              inertia_world(inertia(body)),
              force(to_core(dBodyGetForce(body))),
              torque(to_core(dBodyGetTorque(body))),
              awake(dBodyIsEnabled(body) != 0) {}

        void finish(dBodyID body) {
            linear_after = linear_velocity(body);
            angular_after = angular_velocity(body);
        }

        Vector3<double> position;
        Vector3<double> linear;
        Vector3<double> angular;
        Matrix3<double> inertia_world;
        Vector3<double> force; ///< applied by the user
        Vector3<double> torque;
        bool awake;
        Vector3<double> linear_after{0, 0, 0}; ///< after the solve, before a break's release
        Vector3<double> angular_after{0, 0, 0};
    };

    /// A joint's two bodies and feedback in this step.
    struct WatchedJoint {
        dJointID id;
        dBodyID first;
        dBodyID second;
        const dJointFeedback* feedback;
        bool lent;
    };

    struct Contact {
        Vector3<double> point;
        Vector3<double> normal; ///< into the first body
    };

    /// A plastic constraint and its totals at the start of the step [J].
    struct PlasticShare {
        explicit PlasticShare(PlasticConstraint* of) : constraint(of) {}

        PlasticConstraint* constraint;
        double absorbed = 0;
        double stored = 0;
        double released = 0;
    };

    [[nodiscard]] Vector3<double> weight(dBodyID body) const {
        if (dBodyGetGravityMode(body) == 0) return Vector3<double>::Zero();
        dVector3 gravity;
        dWorldGetGravity(world_, gravity);
        return mass(body) * to_core(gravity);
    }

    void watch(dJointID id, dBodyID from) {
        const auto [first, second, reversed] = attached_bodies(id);
        // each joint once: from its first watched body
        if (from != first && start_.count(first) > 0) return;
        if (dJointIsEnabled(id) == 0) return;
        const bool lend = dJointGetFeedback(id) == nullptr;
        if (lend) dJointSetFeedback(id, &feedback_.emplace_back());
        joints_.push_back({id, first, second, dJointGetFeedback(id), lend});
    }

    void take_feedback_back() {
        for (const WatchedJoint& joint : joints_) {
            if (joint.lent) dJointSetFeedback(joint.id, nullptr);
        }
        joints_.clear();
    }

    /// A break's release acted after the solve; the rows' work wants the velocities before it.
    void undo_release(const PlasticShare& share) {
        const BreakRelease<double>& release = share.constraint->release();
        if (release.energy == share.released) return;
        const auto [a, b, reversed] = attached_bodies(share.constraint->id());
        take_back(a, release.a);
        take_back(b, release.b);
    }
    void take_back(dBodyID body, const VelocityChange<double>& change) {
        const auto start = start_.find(body);
        if (start == start_.end()) return;
        start->second.linear_after -= change.linear;
        start->second.angular_after -= change.angular;
    }

    void book_body(dBodyID body, const BodyStart& start, double dt, double share) {
        if (dBodyIsEnabled(body) == 0) {
            if (start.awake) ledger_.book(Account::integration, kinetic(body, start));
            return;
        }
        const Vector3<double> mean_linear = (start.linear + start.linear_after) / 2;
        const Vector3<double> mean_angular = (start.angular + start.angular_after) / 2;
        ledger_.supply(share * dt *
                       (start.force.dot(mean_linear) + start.torque.dot(mean_angular)));

        const Vector3<double> moved = to_core(dBodyGetPosition(body)) - start.position;
        const double potential = weight(body).dot(moved - share * dt * mean_linear);
        const Vector3<double>& w = start.angular_after;
        const double turning = w.dot((start.inertia_world - inertia(body)) * w) / 2;
        const double gyroscopic = -gyroscopic_impulse(body, start, dt).dot(mean_angular);
        ledger_.book(Account::integration, potential + turning + gyroscopic);
    }

    /// Kinetic energy at the start of the step [J].
    static double kinetic(dBodyID body, const BodyStart& start) {
        return mass(body) * start.linear.squaredNorm() / 2 +
               start.angular.dot(start.inertia_world * start.angular) / 2;
    }

    /// Angular impulse [N m s] that ODE adds for ω × Iω, by its implicit rule (Lacoursière 2006):
    /// (I (I - dt [L]ₓ)⁻¹ - 1) L with L = I ω.
    static Vector3<double> gyroscopic_impulse(dBodyID body, const BodyStart& start, double dt) {
        if (dBodyGetGyroscopicMode(body) == 0) return Vector3<double>::Zero();
        const Vector3<double> momentum = start.inertia_world * start.angular;
        Matrix3<double> cross;
        cross << 0, -momentum.z(), momentum.y(), momentum.z(), 0, -momentum.x(), -momentum.y(),
            momentum.x(), 0;
        const Matrix3<double> tilde = start.inertia_world - dt * cross;
        return start.inertia_world * tilde.partialPivLu().solve(momentum) - momentum;
    }

    /// Work that a force and a torque about the centre of mass do on a body over the step [J].
    [[nodiscard]] double work(dBodyID body, const Vector3<double>& force,
                              const Vector3<double>& torque, double dt) const {
        const auto start = start_.find(body);
        // ODE leaves the feedback of a joint that sleeps as it was
        if (start == start_.end() || dBodyIsEnabled(body) == 0) return 0;
        const BodyStart& s = start->second;
        return dt / 2 *
               (force.dot(s.linear + s.linear_after) + torque.dot(s.angular + s.angular_after));
    }

    void book_joint(const WatchedJoint& joint, double dt) {
        const dJointFeedback& f = *joint.feedback;
        double taken = -work(joint.first, to_core(f.f1), to_core(f.t1), dt) -
                       work(joint.second, to_core(f.f2), to_core(f.t2), dt);
        if (const auto contact = contacts_.find(joint.id); contact != contacts_.end()) {
            const auto& [point, normal] = contact->second;
            const Vector3<double> sum =
                velocity_sum(joint.first, point) - velocity_sum(joint.second, point);
            const double pressed = -to_core(f.f1).dot(normal) * normal.dot(sum) * dt / 2;
            ledger_.book(Account::contact, pressed);
            ledger_.book(Account::friction, taken - pressed);
            return;
        }
        double named = 0;
        const auto [begin, end] = plastic_of_.equal_range(joint.id);
        for (auto entry = begin; entry != end; ++entry) {
            const PlasticShare& share = plastic_[entry->second];
            const PlasticConstraint& constraint = *share.constraint;
            const OutsideForce& outside = constraint.outside_force();
            taken -= work(joint.first, outside.force, outside.torque_a, dt) +
                     work(joint.second, -outside.force, outside.torque_b, dt);
            const double flow = constraint.absorbed_energy() - share.absorbed;
            ledger_.book(Account::plastic, flow);
            // what a break released was taken by the row and given back after the solve
            named += flow + constraint.stored_energy() - share.stored +
                     constraint.release().energy - share.released;
        }
        ledger_.book(Account::joints, taken - named);
        taken_[joint.id] += taken;
    }

    /// Sum of the velocities before and after the step at a world point of the body [m/s].
    [[nodiscard]] Vector3<double> velocity_sum(dBodyID body, const Vector3<double>& point) const {
        const auto start = start_.find(body);
        if (start == start_.end()) return Vector3<double>::Zero();
        const BodyStart& s = start->second;
        return s.linear + s.linear_after + (s.angular + s.angular_after).cross(point - s.position);
    }

    dWorldID world_;
    Ledger<double> ledger_;
    HeldEnergy<double> last_;
    std::vector<dBodyID> bodies_;
    std::unordered_map<dBodyID, BodyStart> start_;
    std::vector<PlasticShare> plastic_;
    std::unordered_multimap<dJointID, std::size_t> plastic_of_; ///< place in plastic_, this step
    std::unordered_map<dJointID, Contact> contacts_;
    std::unordered_map<dJointID, double> taken_;
    std::vector<WatchedJoint> joints_;
    std::deque<dJointFeedback> feedback_;
};

} // namespace ductile::ode
