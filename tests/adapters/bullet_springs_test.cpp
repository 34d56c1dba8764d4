// SPDX-License-Identifier: MIT
//
// Springs and motors of Bullet's own beside plastic joints, in frames with a tolerance.
#include <btBulletDynamicsCommon.h>

#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "adapters/bullet_engine.hpp"
#include "adapters/spring_runs.hpp"
#include "ductile/bullet/bullet.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;
using Slider = bullet::PlasticSlider<Law>;

constexpr double accuracy = sizeof(btScalar) == sizeof(float) ? 0.03 : 0.01;

struct Rig : test::BulletEngine {
    std::vector<std::unique_ptr<btTypedConstraint>> own;
    std::unique_ptr<Slider> slider;
    std::unique_ptr<bullet::World> world;

    Rig() : BulletEngine({0, 0, 0}) {
        shapes.push_back(std::make_unique<btSphereShape>(btScalar(0.1)));
        world = std::make_unique<bullet::World>(engine, bullet::WorldParameters{.warn = {}});
    }
    ~Rig() {
        if (slider != nullptr) world->remove(*slider);
        world.reset();
        for (auto& constraint : own) engine.removeConstraint(constraint.get());
    }
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
    void hold(btRigidBody& body, double strength) {
        btTransform along_x(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI));
        slider =
            std::make_unique<Slider>(body, along_x, Law(Perfect<double>({.strength = strength})));
        world->add(*slider);
    }
    [[nodiscard]] double absorbed() const { return slider->absorbed_energy(); }
    static void push(btRigidBody& body, double speed) {
        body.setLinearVelocity({btScalar(speed), 0, 0});
    }
    static void check() {}
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
    test::swing_against_a_weak_slider<Rig>(
        accuracy, [](Rig& rig, btRigidBody& body, double rest, double stiffness, double /*frame*/) {
            auto spring = six<TestType>(btTypedConstraint::getFixedBody(), body, 0, 0, false);
            set_spring(*spring, stiffness, rest);
            rig.add(std::move(spring));
        });
}

TEST_CASE("A spring of Bullet's that a rigid slider holds is met at its peak", "[frame]") {
    test::meet_at_the_peak<Rig>(
        [](Rig& rig, btRigidBody& a, btRigidBody& b, double stiffness, double /*frame*/) {
            auto spring = six<btGeneric6DofSpring2Constraint>(a, b, 0.5, -0.5, true);
            set_spring(*spring, stiffness, 0);
            rig.add(std::move(spring));
        });
}

TEMPLATE_TEST_CASE("A motor of Bullet's that has its speed within a frame pushed no less till then",
                   "[frame]", btGeneric6DofSpring2Constraint, btGeneric6DofConstraint) {
    test::drive_apart<Rig>(
        accuracy, [](Rig& rig, btRigidBody& a, btRigidBody& b, double speed, double force) {
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
        });
}
