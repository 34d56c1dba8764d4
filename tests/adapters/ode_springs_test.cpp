// SPDX-License-Identifier: MIT
//
// Springs and motors of ODE's own joints beside plastic ones, in frames with a tolerance.
#include <ode/ode.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>

#include "ductile/ode/ode.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;
using Slider = ode::PlasticSlider<Law>;

constexpr double some_frames[] = {1.0 / 6000, 1.0 / 240, 1.0 / 60, 1.0 / 30};

/// A body on a plastic slider along x, and what it hangs together with.
struct Rig {
    int ready = dInitODE2(0);
    dWorldID id = dWorldCreate();
    std::unique_ptr<ode::World> world =
        std::make_unique<ode::World>(id, ode::WorldParameters{.tolerance = 0.01, .warn = {}});
    std::unique_ptr<Slider> slider;

    Rig() = default;
    ~Rig() {
        slider.reset();
        world.reset();
        dWorldDestroy(id);
    }
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    dBodyID body(double mass, double x) {
        const dBodyID body = dBodyCreate(id);
        dMass of;
        dMassSetParameters(&of, dReal(mass), 0, 0, 0, 1, 1, 1, 0, 0, 0);
        dBodySetMass(body, &of);
        dBodySetPosition(body, dReal(x), 0, 0);
        dBodySetAutoDisableFlag(body, 0);
        world->add(body);
        return body;
    }
    void hold(dBodyID body, double strength) {
        slider = std::make_unique<Slider>(id, body, nullptr, Vector3<double>(1, 0, 0),
                                          Law(Perfect<double>({.strength = strength})));
        slider->add_to(*world);
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
void set_spring(dJointID slider, double rest, double stiffness, double frame) {
    dJointSetSliderParam(slider, dParamLoStop, dReal(rest));
    dJointSetSliderParam(slider, dParamHiStop, dReal(rest));
    dJointSetSliderParam(slider, dParamStopERP, 1);
    dJointSetSliderParam(slider, dParamStopCFM, dReal(1 / (frame * stiffness)));
}

} // namespace

TEST_CASE("A spring of ODE's swings a mass against a weak slider", "[frame]") {
    // from rest at A₀: each half swing, of π/ω, ends at A - 2 R/k, and R went over both
    constexpr double mass = 4, first = 0.3, weaker = 25; // k A₀/R
    constexpr int half_swings = 6;
    const bool reversed = GENERATE(false, true);
    for (const double frequency : {15.0, 60.0, 180.0}) { // ω [rad/s]; ω h up to 6
        for (const double wanted : some_frames) {
            CAPTURE(frequency, wanted, reversed);
            const double stiffness = mass * frequency * frequency;
            const double strength = stiffness * first / weaker;
            double path = 0, amplitude = first;
            for (int i = 0; i < half_swings; ++i) {
                path += 2 * (amplitude - strength / stiffness);
                amplitude -= 2 * strength / stiffness;
            }
            Rig rig;
            const dBodyID body = rig.body(mass, 0);
            rig.hold(body, strength);
            const double duration = half_swings * std::numbers::pi / frequency;
            const double frame = duration / std::max(1.0, std::round(duration / wanted));
            const dJointID spring = reversed ? rig.own(nullptr, body) : rig.own(body, nullptr);
            set_spring(spring, first, stiffness, frame);
            rig.run(duration, frame);
            const double taken = strength * path;
            CHECK(rig.slider->absorbed_energy() == Approx(taken).epsilon(0.01));
            CHECK(rig.world->run().believed());
            CHECK(dJointGetSliderParam(spring, dParamLoStop) == first);
            CHECK(dJointGetSliderParam(spring, dParamStopERP) == 1);
        }
    }
}

TEST_CASE("A spring of ODE's that a rigid slider holds is met at its peak", "[frame]") {
    // as of Bullet's, at frames of 1/6000 s [J] (bullet_springs_test.cpp)
    struct Case {
        double held, mass, strength, stiffness, speed, duration, work;
    };
    for (const Case& scene : {Case{2.61552, 1.02808, 278.172, 42683.3, 4.40948, 1, 9.071},
                              Case{11.5728, 3.25694, 604.727, 55084.3, 3.63024, 5.0 / 6, 17.966}}) {
        for (const double frame : some_frames) {
            CAPTURE(scene.work, frame);
            Rig rig;
            const dBodyID a = rig.body(scene.held, 0), b = rig.body(scene.mass, 1);
            dBodySetLinearVel(b, dReal(scene.speed), 0, 0);
            rig.hold(a, scene.strength);
            set_spring(rig.own(a, b), 0, scene.stiffness, frame);
            rig.run(scene.duration, frame);
            CHECK(rig.slider->absorbed_energy() == Approx(scene.work).epsilon(0.02));
            CHECK(rig.world->run().believed());
        }
    }
}

TEST_CASE("A motor of ODE's that has its speed within a frame pushed no less till then",
          "[frame]") {
    // F drives two masses apart until they have the speed v, against R < F on one of them:
    //   t = v/(F/m₂ + (F - R)/m₁),  v₁ = (F - R) t/m₁,  W = R (v₁ t/2 + (m₁ + m₂) v₁²/(2 R))
    constexpr double m_1 = 5, m_2 = 2, strength = 40, force = 100;
    for (const double speed : {0.05, 0.4, 3.0}) {
        const double time = speed / (force / m_2 + (force - strength) / m_1);
        const double reached = (force - strength) * time / m_1;
        const double work = strength * reached * time / 2 + (m_1 + m_2) * reached * reached / 2;
        for (const double frame : some_frames) {
            CAPTURE(speed, frame);
            Rig rig;
            const dBodyID a = rig.body(m_1, 0), b = rig.body(m_2, 1);
            rig.hold(a, strength);
            const dJointID motor = rig.own(a, b);
            dJointSetSliderParam(motor, dParamVel, dReal(speed));
            dJointSetSliderParam(motor, dParamFMax, dReal(force));
            rig.run(0.2, frame);
            CHECK(rig.slider->absorbed_energy() == Approx(work).epsilon(0.01));
            CHECK(rig.world->run().believed());
        }
    }
}
