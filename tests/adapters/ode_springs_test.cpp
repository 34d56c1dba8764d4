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

TEST_CASE("A motor of ODE's that has its speed within a frame pushed no less till then",
          "[frame]") {
    test::drive_apart<Rig>(0.01, [](Rig& rig, dxBody& a, dxBody& b, double speed, double force) {
        const dJointID motor = rig.own(&a, &b);
        dJointSetSliderParam(motor, dParamVel, dReal(speed));
        dJointSetSliderParam(motor, dParamFMax, dReal(force));
    });
}
