// SPDX-License-Identifier: MIT
//
// Springs and motors of Bullet's own beside plastic joints, in frames with a tolerance.
#include <btBulletDynamicsCommon.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "adapters/bullet_engine.hpp"
#include "ductile/bullet/bullet.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;
using Slider = bullet::PlasticSlider<Law>;

constexpr bool rough = sizeof(btScalar) == sizeof(float);
constexpr double some_frames[] = {1.0 / 6000, 1.0 / 240, 1.0 / 60, 1.0 / 30};

struct Rig : test::BulletEngine {
    std::vector<std::unique_ptr<btTypedConstraint>> own;
    std::vector<std::unique_ptr<Slider>> sliders;
    std::unique_ptr<bullet::World> world;

    Rig() : BulletEngine({0, 0, 0}) {
        shapes.push_back(std::make_unique<btSphereShape>(btScalar(0.1)));
        world = std::make_unique<bullet::World>(engine, bullet::WorldParameters{.warn = {}});
    }
    ~Rig() {
        for (auto& slider : sliders) world->remove(*slider);
        world.reset();
        for (auto& constraint : own) engine.removeConstraint(constraint.get());
    }
    /// That meets nothing.
    btRigidBody& body(double mass, double x) {
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shapes[0].get(),
                                                      {1, 1, 1});
        info.m_startWorldTransform.setIdentity();
        info.m_startWorldTransform.setOrigin({btScalar(x), 0, 0});
        btRigidBody& body = *bodies.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        engine.addRigidBody(&body, 0, 0);
        return body;
    }
    /// To the static world, along x.
    Slider& slider(btRigidBody& body, double strength) {
        btTransform along_x(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI));
        sliders.push_back(
            std::make_unique<Slider>(body, along_x, Law(Perfect<double>({.strength = strength}))));
        world->add(*sliders.back());
        return *sliders.back();
    }
    void add(std::unique_ptr<btTypedConstraint> constraint) {
        engine.addConstraint(constraint.get(), true);
        own.push_back(std::move(constraint));
    }
    void run(double duration, double frame) {
        while (world->time() < duration - 1e-9) world->step(frame);
    }
};

[[nodiscard]] btTransform at(double x) {
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), 0, 0));
}

/// One of Bullet's two kinds, along x, all else free or held.
template <class SixAxes>
[[nodiscard]] std::unique_ptr<SixAxes> six(btRigidBody& a, btRigidBody& b, double in_a, double in_b,
                                           bool held) {
    std::unique_ptr<SixAxes> axes;
    if constexpr (std::is_same_v<SixAxes, btGeneric6DofSpring2Constraint>) {
        axes = std::make_unique<SixAxes>(a, b, at(in_a), at(in_b));
    } else {
        axes = std::make_unique<SixAxes>(a, b, at(in_a), at(in_b), true);
    }
    for (int i = 0; i < 6; ++i) axes->setLimit(i, held && i > 0 ? 0 : 1, held && i > 0 ? 0 : -1);
    return axes;
}
template <class SixAxes>
void set_spring(SixAxes& axes, double stiffness, double rest) {
    axes.enableSpring(0, true);
    axes.setStiffness(0, btScalar(stiffness));
    axes.setEquilibriumPoint(0, btScalar(rest));
}

} // namespace

TEMPLATE_TEST_CASE("A spring of Bullet's swings a mass against a weak slider", "[frame]",
                   btGeneric6DofSpring2Constraint, btGeneric6DofSpringConstraint) {
    // from rest at A₀: each half swing, of π/ω, ends at A - 2 R/k, and R went over both
    constexpr double mass = 4, first = 0.3, weaker = 25; // k A₀/R
    constexpr int half_swings = 6;
    for (const double frequency : {15.0, 60.0, 180.0}) { // ω [rad/s]; ω h up to 6
        for (const double frame : some_frames) {
            CAPTURE(frequency, frame);
            const double stiffness = mass * frequency * frequency;
            const double strength = stiffness * first / weaker;
            double path = 0, amplitude = first;
            for (int i = 0; i < half_swings; ++i) {
                path += 2 * (amplitude - strength / stiffness);
                amplitude -= 2 * strength / stiffness;
            }
            Rig rig;
            btRigidBody& body = rig.body(mass, 0);
            const Slider& slider = rig.slider(body, strength);
            auto spring = six<TestType>(btTypedConstraint::getFixedBody(), body, 0, 0, false);
            set_spring(*spring, stiffness, first);
            rig.add(std::move(spring));
            const double duration = half_swings * std::numbers::pi / frequency;
            const double frames = std::max(1.0, std::round(duration / frame));
            rig.run(duration, duration / frames);
            const double taken = strength * path;
            CHECK(slider.absorbed_energy() == Approx(taken).epsilon(rough ? 0.03 : 0.01));
            CHECK(rig.world->run().believed());
        }
    }
}

TEST_CASE("A spring of Bullet's that a rigid slider holds is met at its peak", "[frame]") {
    // what frames of 1/6000 s take [J]
    struct Case {
        double held, mass, strength, stiffness, speed, duration, work;
    };
    for (const Case& scene : {Case{2.61552, 1.02808, 278.172, 42683.3, 4.40948, 1, 9.071},
                              Case{11.5728, 3.25694, 604.727, 55084.3, 3.63024, 5.0 / 6, 17.966}}) {
        for (const double frame : some_frames) {
            CAPTURE(scene.work, frame);
            Rig rig;
            btRigidBody &a = rig.body(scene.held, 0), &b = rig.body(scene.mass, 1);
            b.setLinearVelocity({btScalar(scene.speed), 0, 0});
            const Slider& slider = rig.slider(a, scene.strength);
            auto spring = six<btGeneric6DofSpring2Constraint>(a, b, 0.5, -0.5, true);
            set_spring(*spring, scene.stiffness, 0);
            rig.add(std::move(spring));
            rig.run(scene.duration, frame);
            CHECK(slider.absorbed_energy() == Approx(scene.work).epsilon(0.02));
            CHECK(rig.world->run().believed());
        }
    }
}

TEMPLATE_TEST_CASE("A motor of Bullet's that has its speed within a frame pushed no less till then",
                   "[frame]", btGeneric6DofSpring2Constraint, btGeneric6DofConstraint) {
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
            btRigidBody &a = rig.body(m_1, 0), &b = rig.body(m_2, 1);
            const Slider& slider = rig.slider(a, strength);
            auto axes = six<TestType>(a, b, 0.5, -0.5, true);
            if constexpr (std::is_same_v<TestType, btGeneric6DofSpring2Constraint>) {
                auto* with_springs = axes.get();
                with_springs->enableMotor(0, true);
                with_springs->setTargetVelocity(0, btScalar(-speed));
                with_springs->setMaxMotorForce(0, btScalar(force));
            } else {
                auto* motor = axes->getTranslationalLimitMotor();
                motor->m_enableMotor[0] = true;
                motor->m_targetVelocity[0] = btScalar(-speed);
                motor->m_maxMotorForce[0] = btScalar(force);
            }
            rig.add(std::move(axes));
            rig.run(0.2, frame);
            CHECK(slider.absorbed_energy() == Approx(work).epsilon(rough ? 0.03 : 0.01));
            CHECK(rig.world->run().believed());
        }
    }
}
