// SPDX-License-Identifier: MIT
//
// ODE's own joints as rows of an island, against ODE's step of the same: each kind, on a body or
// the static world, either way round, out of line, with motors and at stops.
#include <ode/ode.h>

#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "ductile/ode/ode.hpp"

namespace {

namespace ode = ductile::ode;
using V3 = ductile::Vector3<double>;
using Six = ductile::CoupledJoint<ductile::Ellipsoid<double, 6>, ductile::Perfect<double>>;

constexpr double dt = 1.0 / 60;

/// The same numbers again.
class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double real(double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(engine_);
    }
    bool coin() { return real(0, 1) < 0.5; }
    V3 vector(double most) { return {real(-most, most), real(-most, most), real(-most, most)}; }

  private:
    std::mt19937 engine_;
};

enum class Attached { two_bodies, to_the_world, from_the_world };

/// Two bodies, or one, on a joint of ODE's, and a third on the first by a rigid plastic joint.
class Scene {
  public:
    Scene(dJointType kind, Attached how, unsigned seed, bool left_to_ode) : random_(seed) {
        dWorldSetGravity(id_, 0, 0, -9.81);
        a_ = body(3, random_.vector(0.5));
        b_ = how == Attached::two_bodies ? body(5, random_.vector(0.5)) : nullptr;
        other_ = body(2, random_.vector(1));
        const Six law(
            ductile::Ellipsoid<double, 6>({.capacity = ductile::Vector6<double>::Constant(1e8)}),
            ductile::Perfect<double>({.strength = 1}));
        plastic_ = std::make_unique<ode::PlasticJoint<Six>>(
            id_, a_, other_, ode::PlasticJoint<Six>::Frame{.origin = random_.vector(1)}, law);
        world_->add(*plastic_);
        const dBodyID first = how == Attached::from_the_world ? nullptr : a_;
        const dBodyID second = how == Attached::from_the_world ? a_ : b_;
        joint_ = make(kind, first, second);
        dJointSetFeedback(joint_, &feedback_);
        if (left_to_ode) { // not known, and without a row
            const dJointID unknown = dJointCreateLMotor(id_, nullptr);
            dJointAttach(unknown, first, second);
        }
        world_->step(dt); // as it was made
        shake();
        rule(kind);
        feedback_ = {};
        world_->step(dt);
    }
    ~Scene() {
        plastic_.reset();
        world_.reset();
        dWorldDestroy(id_);
        dCloseODE();
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Velocities, and what the joint did [m/s, rad/s, N, N m].
    [[nodiscard]] std::vector<double> velocities() const {
        std::vector<double> all;
        for (dBodyID body : {a_, b_, other_}) {
            if (body == nullptr) continue;
            all.insert(all.end(), dBodyGetLinearVel(body), dBodyGetLinearVel(body) + 3);
            all.insert(all.end(), dBodyGetAngularVel(body), dBodyGetAngularVel(body) + 3);
        }
        return all;
    }
    [[nodiscard]] std::vector<double> forces() const {
        std::vector<double> all;
        for (const dReal* each : {feedback_.f1, feedback_.t1, feedback_.f2, feedback_.t2}) {
            all.insert(all.end(), each, each + 3);
        }
        return all;
    }
    [[nodiscard]] bool pushed_at_stop() const { return pushed_at_stop_; }
    [[nodiscard]] bool enabled() const { return dJointIsEnabled(joint_) != 0; }

  private:
    dBodyID body(double mass, const V3& at) {
        dBodyID made = dBodyCreate(id_);
        dMass inertia;
        dMassSetBoxTotal(&inertia, mass, 0.3, 0.7, 1);
        dBodySetMass(made, &inertia);
        dBodySetPosition(made, at.x(), at.y(), at.z());
        const V3 axis = random_.vector(1);
        dQuaternion turn;
        dQFromAxisAndAngle(turn, axis.x(), axis.y(), axis.z(), random_.real(0, 3));
        dBodySetQuaternion(made, turn);
        dBodySetFiniteRotationMode(made, 1);
        world_->add(made);
        return made;
    }

    dJointID make(dJointType kind, dBodyID first, dBodyID second) {
        const V3 pin = random_.vector(0.5);
        const V3 e = random_.vector(1).normalized(),
                 across = e.cross(random_.vector(1)).normalized();
        const auto attached = [&](dJointID joint) {
            dJointAttach(joint, first, second);
            return joint;
        };
        switch (kind) {
            case dJointTypeBall: {
                const dJointID ball = attached(dJointCreateBall(id_, nullptr));
                dJointSetBallAnchor(ball, pin.x(), pin.y(), pin.z());
                return ball;
            }
            case dJointTypeHinge: {
                const dJointID hinge = attached(dJointCreateHinge(id_, nullptr));
                dJointSetHingeAnchor(hinge, pin.x(), pin.y(), pin.z());
                dJointSetHingeAxis(hinge, e.x(), e.y(), e.z());
                return hinge;
            }
            case dJointTypeSlider: {
                const dJointID slider = attached(dJointCreateSlider(id_, nullptr));
                dJointSetSliderAxis(slider, e.x(), e.y(), e.z());
                return slider;
            }
            case dJointTypeUniversal: {
                const dJointID cross = attached(dJointCreateUniversal(id_, nullptr));
                dJointSetUniversalAnchor(cross, pin.x(), pin.y(), pin.z());
                dJointSetUniversalAxis1(cross, e.x(), e.y(), e.z());
                dJointSetUniversalAxis2(cross, across.x(), across.y(), across.z());
                return cross;
            }
            case dJointTypeHinge2: {
                const dJointID wheel = attached(dJointCreateHinge2(id_, nullptr));
                const V3 leaning = (across + 0.3 * e).normalized();
                const dReal axis1[4] = {e.x(), e.y(), e.z(), 0};
                const dReal axis2[4] = {leaning.x(), leaning.y(), leaning.z(), 0};
                dJointSetHinge2Anchor(wheel, pin.x(), pin.y(), pin.z());
                dJointSetHinge2Axes(wheel, axis1, axis2);
                return wheel;
            }
            case dJointTypeFixed: {
                const dJointID fixed = attached(dJointCreateFixed(id_, nullptr));
                dJointSetFixed(fixed);
                return fixed;
            }
            default: {
                const dJointID motor = attached(dJointCreateAMotor(id_, nullptr));
                dJointSetAMotorNumAxes(motor, 2);
                dJointSetAMotorAxis(motor, 0, 0, e.x(), e.y(), e.z());
                dJointSetAMotorAxis(motor, 1, 1, across.x(), across.y(), across.z());
                return motor;
            }
        }
    }

    /// Out of line, and with velocities that no row allows.
    void shake() {
        for (dBodyID body : {a_, b_, other_}) {
            if (body == nullptr) continue;
            const dReal* at = dBodyGetPosition(body);
            const V3 by = random_.vector(0.003), axis = random_.vector(1);
            dBodySetPosition(body, at[0] + by.x(), at[1] + by.y(), at[2] + by.z());
            dQuaternion turn, turned;
            dQFromAxisAndAngle(turn, axis.x(), axis.y(), axis.z(), random_.real(-0.01, 0.01));
            dQMultiply0(turned, turn, dBodyGetQuaternion(body));
            dBodySetQuaternion(body, turned);
            const V3 v = random_.vector(2), w = random_.vector(3);
            dBodySetLinearVel(body, v.x(), v.y(), v.z());
            dBodySetAngularVel(body, w.x(), w.y(), w.z());
        }
    }

    /// Motors, stops near to where it is, springs.
    void rule(dJointType kind) {
        const ode::JointCalls calls = ode::joint_calls(kind);
        if (calls.rows) {
            calls.set(joint_, dParamERP, random_.real(0.1, 0.8));
            calls.set(joint_, dParamCFM, random_.coin() ? 1e-9 : random_.real(1e-3, 1e-1));
        }
        if (calls.suspension) {
            calls.set(joint_, dParamSuspensionERP, random_.real(0.1, 0.8));
            calls.set(joint_, dParamSuspensionCFM, random_.real(1e-4, 1e-2));
        }
        const int axes = kind == dJointTypeAMotor ? 2 : kind == dJointTypeHinge2 ? 2 : calls.stops;
        for (int i = 0; i < axes; ++i) {
            const auto set = [&](int name, double value) {
                calls.set(joint_, name + dParamGroup * i, value);
            };
            const bool motor = random_.coin();
            if (motor) {
                set(dParamFMax, random_.real(1, 200));
                set(dParamVel, random_.real(-3, 3));
                set(dParamCFM, random_.coin() ? 1e-9 : random_.real(1e-3, 1e-1));
                set(dParamFudgeFactor, random_.real(0, 1));
            }
            if (kind == dJointTypeAMotor || !random_.coin()) continue;
            const double stop = random_.real(-0.02, 0.02);
            const bool both = random_.real(0, 1) < 0.2, low = random_.coin();
            if (both || low) set(dParamLoStop, stop);
            if (both || !low) set(dParamHiStop, stop);
            set(dParamStopERP, random_.real(0.1, 0.8));
            set(dParamStopCFM, random_.coin() ? 1e-9 : random_.real(1e-3, 1e-1));
            if (random_.coin()) set(dParamBounce, random_.real(0.1, 1));
            pushed_at_stop_ = pushed_at_stop_ || motor;
        }
    }

    int library_ = dInitODE2(0);
    dWorldID id_ = dWorldCreate();
    std::unique_ptr<ode::World> world_ =
        std::make_unique<ode::World>(id_, ode::WorldParameters{.warn = nullptr});
    std::unique_ptr<ode::PlasticJoint<Six>> plastic_;
    Random random_;
    dBodyID a_ = nullptr, b_ = nullptr, other_ = nullptr;
    dJointID joint_ = nullptr;
    dJointFeedback feedback_{};
    bool pushed_at_stop_ = false;
};

double apart(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

} // namespace

TEST_CASE("ODE's own joints do in an island what they do in ODE", "[ode][own]") {
    struct Kind {
        const char* name;
        dJointType type;
    };
    for (const auto& [name, kind] :
         {Kind{"ball", dJointTypeBall}, Kind{"hinge", dJointTypeHinge},
          Kind{"slider", dJointTypeSlider}, Kind{"universal", dJointTypeUniversal},
          Kind{"hinge-2", dJointTypeHinge2}, Kind{"fixed", dJointTypeFixed},
          Kind{"motor", dJointTypeAMotor}}) {
        for (const Attached how :
             {Attached::two_bodies, Attached::to_the_world, Attached::from_the_world}) {
            if (kind == dJointTypeHinge2 && how != Attached::two_bodies) continue;
            for (unsigned seed = 1; seed <= 60; ++seed) {
                const Scene here(kind, how, seed, false), ode(kind, how, seed, true);
                INFO(name << ", attached " << int(how) << ", seed " << seed);
                CHECK(here.enabled());
                CHECK(apart(here.velocities(), ode.velocities()) < 1e-6);
                // a motor at its stop is no row in ODE, and none of its feedback
                if (!here.pushed_at_stop()) CHECK(apart(here.forces(), ode.forces()) < 1e-3);
            }
        }
    }
}
