// SPDX-License-Identifier: MIT
//
// Springs and motors of ODE's own joints beside plastic ones, in frames with a tolerance.
#include <ode/ode.h>

#include <catch2/catch.hpp>
#include <memory>

#include "adapters/spring_runs.hpp"
#include "ductile/ode/ode.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;
using Slider = ode::PlasticSlider<Law>;

/// A body on a plastic slider along x, and what it hangs together with.
struct Rig {
    int ready = dInitODE2(0);
    dWorldID id = dWorldCreate();
    std::unique_ptr<ode::World> world =
        std::make_unique<ode::World>(id, ode::WorldParameters{.tolerance = 0.01, .warn = {}});
    std::unique_ptr<Slider> slider;
    dJointID spring = nullptr;
    double rest = 0; ///< of the spring [m]
    dBodyID loaded = nullptr;
    double force = 0;

    Rig() = default;
    ~Rig() {
        slider.reset();
        world.reset();
        dWorldDestroy(id);
    }
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    dxBody& body(double mass, double x) {
        const dBodyID body = dBodyCreate(id);
        dMass of;
        dMassSetParameters(&of, dReal(mass), 0, 0, 0, 1, 1, 1, 0, 0, 0);
        dBodySetMass(body, &of);
        dBodySetPosition(body, dReal(x), 0, 0);
        dBodySetAutoDisableFlag(body, 0);
        world->add(body);
        return *body;
    }
    void hold(dxBody& body, double strength) {
        slider = std::make_unique<Slider>(id, &body, nullptr, Vector3<double>(1, 0, 0),
                                          Law(Perfect<double>({.strength = strength})));
        slider->add_to(*world);
    }
    [[nodiscard]] double absorbed() const { return slider->absorbed_energy(); }
    static void push(dxBody& body, double speed) { dBodySetLinearVel(&body, dReal(speed), 0, 0); }
    void load(dxBody& body, double pull) {
        loaded = &body;
        force = pull;
    }
    void check() const {
        CHECK(dJointGetSliderParam(spring, dParamLoStop) == rest);
        CHECK(dJointGetSliderParam(spring, dParamStopERP) == 1);
    }
    /// ODE's, along x.
    dJointID own(dBodyID a, dBodyID b) {
        const dJointID joint = dJointCreateSlider(id, nullptr);
        dJointAttach(joint, a, b);
        dJointSetSliderAxis(joint, 1, 0, 0);
        return joint;
    }
    void run(double duration, double frame) {
        double time = 0;
        while (time < duration - 1e-9) {
            if (loaded != nullptr) dBodyAddForce(loaded, dReal(force), 0, 0);
            world->step(frame);
            time += frame;
        }
    }
};

/// Two stops at `rest` that are a spring of `stiffness` in frames of `frame`.
void add_spring(Rig& rig, dBodyID a, dBodyID b, double rest, double stiffness, double frame) {
    rig.rest = rest;
    rig.spring = rig.own(a, b);
    dJointSetSliderParam(rig.spring, dParamLoStop, dReal(rest));
    dJointSetSliderParam(rig.spring, dParamHiStop, dReal(rest));
    dJointSetSliderParam(rig.spring, dParamStopERP, 1);
    dJointSetSliderParam(rig.spring, dParamStopCFM, dReal(1 / (frame * stiffness)));
}

/// A motor that drives `b` away from `a`, or towards it where `speed` < 0, and a stop where they
/// are, if there is to be one.
void drive(Rig& rig, dxBody& a, dxBody& b, double speed, double force, bool stops) {
    const dJointID motor = rig.own(&b, &a);
    if (stops) dJointSetSliderParam(motor, dParamLoStop, 0);
    dJointSetSliderParam(motor, dParamVel, dReal(speed));
    dJointSetSliderParam(motor, dParamFMax, dReal(force));
}

/// The same of bodies that turn about z, where all of them are.
struct Rotors : Rig {
    using Hinge = ode::PlasticHinge<Law>;
    std::unique_ptr<Hinge> hinge;

    Rotors() = default;
    ~Rotors() { hinge.reset(); }
    dxBody& body(double inertia, double /*x*/) {
        dxBody& made = Rig::body(1, 0);
        const auto of = dReal(inertia);
        dMass about;
        dMassSetParameters(&about, 1, 0, 0, 0, of, of, of, 0, 0, 0);
        dBodySetMass(&made, &about);
        return made;
    }
    void hold(dxBody& body, double strength) {
        hinge = std::make_unique<Hinge>(id, &body, nullptr, ode::HingeFrame{.axis = {0, 0, 1}},
                                        Law(Perfect<double>({.strength = strength})));
        hinge->add_to(*world);
    }
    [[nodiscard]] double absorbed() const { return hinge->absorbed_energy(); }
};

enum class Drive { universal, universal_second, wheel, angular };

/// A motor about z, and what else holds its two bodies together.
void drive(Drive kind, Rotors& rig, dBodyID a, dBodyID b, double speed, double moment) {
    const auto v = dReal(speed), most = dReal(moment);
    switch (kind) {
        case Drive::universal:
        case Drive::universal_second: {
            const dJointID joint = dJointCreateUniversal(rig.id, nullptr);
            const bool first = kind == Drive::universal;
            dJointAttach(joint, a, b);
            dJointSetUniversalAnchor(joint, 0, 0, 0);
            dJointSetUniversalAxis1(joint, first ? 0 : 1, 0, first ? 1 : 0);
            dJointSetUniversalAxis2(joint, first ? 1 : 0, 0, first ? 0 : 1);
            dJointSetUniversalParam(joint, first ? dParamVel1 : dParamVel2, v);
            dJointSetUniversalParam(joint, first ? dParamFMax1 : dParamFMax2, most);
            break;
        }
        case Drive::wheel: {
            const dJointID joint = dJointCreateHinge2(rig.id, nullptr);
            const dReal steers[] = {1, 0, 0}, turns[] = {0, 0, 1};
            dJointAttach(joint, a, b);
            dJointSetHinge2Anchor(joint, 0, 0, 0);
            dJointSetHinge2Axes(joint, steers, turns);
            dJointSetHinge2Param(joint, dParamLoStop, 0);
            dJointSetHinge2Param(joint, dParamHiStop, 0);
            dJointSetHinge2Param(joint, dParamVel2, v);
            dJointSetHinge2Param(joint, dParamFMax2, most);
            break;
        }
        case Drive::angular: {
            const dJointID ball = dJointCreateBall(rig.id, nullptr),
                           motor = dJointCreateAMotor(rig.id, nullptr);
            dJointAttach(ball, a, b);
            dJointSetBallAnchor(ball, 0, 0, 0);
            dJointAttach(motor, a, b);
            dJointSetAMotorNumAxes(motor, 1);
            dJointSetAMotorAxis(motor, 0, 1, 0, 0, 1);
            dJointSetAMotorParam(motor, dParamVel, v);
            dJointSetAMotorParam(motor, dParamFMax, most);
        }
    }
}

} // namespace

TEST_CASE("A spring of ODE's swings a mass against a weak slider", "[frame]") {
    const bool reversed = GENERATE(false, true);
    CAPTURE(reversed);
    test::swing_against_a_weak_slider<Rig>(
        0.01, [reversed](Rig& rig, dxBody& body, double rest, double stiffness, double frame) {
            add_spring(rig, reversed ? nullptr : &body, reversed ? &body : nullptr, rest, stiffness,
                       frame);
        });
}

TEST_CASE("A spring of ODE's that a rigid slider holds is met at its peak", "[frame]") {
    test::meet_at_the_peak<Rig>([](Rig& rig, dxBody& a, dxBody& b, double stiffness, double frame) {
        add_spring(rig, &a, &b, 0, stiffness, frame);
    });
}

TEST_CASE("A suspension of ODE's that a rigid slider holds is met at its peak", "[frame]") {
    test::meet_at_the_peak<Rig>([](Rig& rig, dxBody& a, dxBody& b, double stiffness, double frame) {
        const dJointID wheel = dJointCreateHinge2(rig.id, nullptr);
        const dReal springs[] = {1, 0, 0}, turns[] = {0, 0, 1};
        dJointAttach(wheel, &a, &b);
        dJointSetHinge2Anchor(wheel, dReal(0.5), 0, 0);
        dJointSetHinge2Axes(wheel, springs, turns);
        dJointSetHinge2Param(wheel, dParamLoStop, 0);
        dJointSetHinge2Param(wheel, dParamHiStop, 0);
        dJointSetHinge2Param(wheel, dParamSuspensionERP, 1);
        dJointSetHinge2Param(wheel, dParamSuspensionCFM, dReal(1 / (frame * stiffness)));
    });
}

TEST_CASE("A motor of ODE's that has its speed within a frame pushed no less till then",
          "[frame]") {
    const bool at_a_stop = GENERATE(false, true); // that it leaves
    CAPTURE(at_a_stop);
    test::drive_apart<Rig>(
        0.01, [at_a_stop](Rig& rig, dxBody& a, dxBody& b, double speed, double force,
                          double /*frame*/) { drive(rig, a, b, speed, force, at_a_stop); });
}

TEST_CASE("A motor of ODE's that is at its stop goes on to push", "[frame]") {
    test::press_against_a_stop<Rig>(
        0.01, [](Rig& rig, dxBody& a, dxBody& b, double speed, double force, double /*frame*/) {
            drive(rig, a, b, -speed, force, true);
        });
}

TEST_CASE("A motor of ODE's that turns has its speed within a frame as one that slides",
          "[frame]") {
    const Drive kind =
        GENERATE(Drive::universal, Drive::universal_second, Drive::wheel, Drive::angular);
    CAPTURE(int(kind));
    test::drive_apart<Rotors>(
        0.01, [kind](Rotors& rig, dxBody& a, dxBody& b, double speed, double moment,
                     double /*frame*/) { drive(kind, rig, &a, &b, speed, moment); });
}
