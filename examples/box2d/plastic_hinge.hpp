// SPDX-License-Identifier: MIT
//
// A plastic hinge over the motor of a b2RevoluteJoint, for Box2D 2.4. The motor is a row of Box2D's
// own solver with a target speed and a bound of its torque, and the core rules both; the account of
// work, travel and break is the core's, in double, whatever Box2D's float leaves of the motion.
//
// Box2D's bound is the same both ways, which symmetric_row mends. Its motor has no compliance, so
// that joints with an elastic part are refused. While the hinge is intact the motor is its own.
//
//   hinge.prepare(dt);  world.Step(dt, 8, 3);  hinge.commit(dt);
//
// A hinge is as right as its row is solved. A wheel on its axle needs one iteration; where the pin
// is off a centre of mass, its rows and the hinge's wait for each other: a cantilever of 1, 2, 3, 6
// links of stiff hinges stays still with 50, 200, 500, 5000 iterations a step, and with Box2D's
// usual 8 it sinks. Then steps are Outcome::unreliable, and state().residual_max says by how much.
#pragma once

#include <box2d/box2d.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/planar_release.hpp"
#include "ductile/vocabulary/symmetric_row.hpp"

/// `Joint`: a OneAxisJoint of double. Body B turns against body A. The pin must outlive the hinge.
template <class Joint>
class PlasticHinge {
  public:
    /// @throws std::invalid_argument where the joint has a finite stiffness.
    PlasticHinge(b2RevoluteJoint& pin, Joint joint)
        : pin_(pin), joint_(std::move(joint)), rest_(pin.GetJointAngle()) {
        ductile::require_rigid(joint_.parameters().stiffness);
        pin_.EnableMotor(true);
    }
    const Joint& joint() const { return joint_; }
    bool broken() const { return joint_.state().broken; }

    void prepare(float dt) {
        if (broken()) return;
        const auto row = ductile::symmetric_row(
            joint_.prepare({.position = angle(), .velocity = pin_.GetJointSpeed()}, dt), dt);
        pin_.SetMotorSpeed(float(row.velocity));
        pin_.SetMaxMotorTorque(float(row.strength));
        couple_ = float(row.centre);
        pin_.GetBodyB()->ApplyTorque(couple_, couple_ != 0); // wakes only where there is one
        pin_.GetBodyA()->ApplyTorque(-couple_, couple_ != 0);
    }
    void commit(float dt) {
        if (broken()) return;
        const double moment = couple_ + double(pin_.GetMotorTorque(1)) / dt; // its impulse over dt
        const auto step = joint_.commit({moment, pin_.GetJointSpeed(), angle()}, dt);
        if (!broken()) return;
        pin_.EnableMotor(false);
        b2Body &a = *pin_.GetBodyA(), &b = *pin_.GetBodyB();
        const auto back = ductile::planar_release(at_joint(a, pin_.GetAnchorA()),
                                                  at_joint(b, pin_.GetAnchorB()), step.release);
        change(a, back.a);
        change(b, back.b);
    }

  private:
    double angle() const { return double(pin_.GetJointAngle()) - rest_; }

    static ductile::PlanarBody<double> at_joint(const b2Body& body, const b2Vec2& joint) {
        const auto inverse = [](float value) { return value > 0 ? 1.0 / value : 0.0; };
        const b2Vec2 arm = joint - body.GetWorldCenter(), centre = body.GetLocalCenter();
        const float inertia = body.GetInertia() - body.GetMass() * b2Dot(centre, centre);
        const b2Vec2 moves = body.GetLinearVelocity();
        return {inverse(body.GetMass()),
                body.IsFixedRotation() ? 0 : inverse(inertia),
                arm.x,
                arm.y,
                {moves.x, moves.y, body.GetAngularVelocity()}};
    }
    static void change(b2Body& body, const ductile::PlanarVelocity<double>& by) {
        body.SetLinearVelocity(body.GetLinearVelocity() + b2Vec2(float(by.x), float(by.y)));
        body.SetAngularVelocity(float(body.GetAngularVelocity() + by.spin));
    }

    b2RevoluteJoint& pin_;
    Joint joint_;
    double rest_;
    float couple_ = 0; // [N m]
};
