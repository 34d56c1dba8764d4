// SPDX-License-Identifier: MIT
//
// Springs and motors of Bullet's own beside plastic joints, in frames with a tolerance.
#include <btBulletDynamicsCommon.h>

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/bullet_engine.hpp"
#include "adapters/spring_runs.hpp"
#include "ductile/bullet/bullet.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;
using Slider = bullet::PlasticSlider<Law>;
using Hinge = bullet::PlasticHinge<Law>;

constexpr double accuracy = sizeof(btScalar) == sizeof(float) ? 0.03 : 0.01;

struct Rig : test::BulletEngine {
    std::vector<std::unique_ptr<btTypedConstraint>> own;
    std::unique_ptr<Slider> slider;
    std::unique_ptr<bullet::World> world;
    btRigidBody* loaded = nullptr;
    double force = 0;
    int meets = 0; ///< whom

    explicit Rig(bullet::WorldParameters parameters = {.warn = {}}) : BulletEngine({0, 0, 0}) {
        shapes.push_back(std::make_unique<btSphereShape>(btScalar(0.1)));
        world = std::make_unique<bullet::World>(engine, std::move(parameters));
    }
    virtual ~Rig() {
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
        engine.addRigidBody(&body, meets, meets);
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
    void load(btRigidBody& body, double pull) {
        loaded = &body;
        force = pull;
    }
    virtual void apply_load() const { loaded->applyCentralForce({btScalar(force), 0, 0}); }
    void add(std::unique_ptr<btTypedConstraint> constraint) {
        engine.addConstraint(constraint.get(), true);
        own.push_back(std::move(constraint));
    }
    void run(double duration, double frame) {
        while (world->time() < duration - 1e-9) {
            if (loaded != nullptr) apply_load();
            world->step(frame);
        }
    }
};

/// The same of bodies that turn about z, where all of them are.
struct Rotors : Rig {
    std::unique_ptr<Hinge> hinge;

    ~Rotors() override { world->remove(*hinge); }
    btRigidBody& body(double inertia, double /*x*/) {
        btRigidBody& made = Rig::body(1, 0);
        const auto of = btScalar(inertia);
        made.setMassProps(1, {of, of, of});
        made.updateInertiaTensor();
        return made;
    }
    void hold(btRigidBody& body, double strength) {
        hinge = std::make_unique<Hinge>(body, btTransform::getIdentity(),
                                        Law(Perfect<double>({.strength = strength})));
        world->add(*hinge);
    }
    [[nodiscard]] double absorbed() const { return hinge->absorbed_energy(); }
    void apply_load() const override { loaded->applyTorque({0, 0, btScalar(force)}); }
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

namespace {

enum class Kind { six, springs, slider };

/// A motor that drives `b` away from `a`, or towards it where `speed` < 0, and a stop where they
/// are, if there is to be one.
void drive(Kind kind, Rig& rig, btRigidBody& a, btRigidBody& b, double speed, double force,
           bool stops) {
    const auto v = btScalar(speed), most = btScalar(force);
    constexpr btScalar far_off = 10;
    if (kind == Kind::slider) {
        auto slider = std::make_unique<btSliderConstraint>(a, b, at(0.5), at(-0.5), true);
        slider->setLowerLinLimit(stops ? 0 : 1);
        slider->setUpperLinLimit(stops ? far_off : -1);
        slider->setPoweredLinMotor(true);
        slider->setTargetLinMotorVelocity(v);
        slider->setMaxLinMotorForce(most);
        rig.add(std::move(slider));
    } else if (kind == Kind::springs) {
        auto axes = six<btGeneric6DofSpring2Constraint>(a, b, 0.5, -0.5, true);
        if (stops) axes->setLimit(0, 0, far_off);
        axes->enableMotor(0, true);
        axes->setTargetVelocity(0, -v);
        axes->setMaxMotorForce(0, most);
        rig.add(std::move(axes));
    } else {
        auto axes = six<btGeneric6DofConstraint>(a, b, 0.5, -0.5, true);
        if (stops) axes->setLimit(0, 0, far_off);
        auto* motor = axes->getTranslationalLimitMotor();
        motor->m_enableMotor[0] = true;
        motor->m_targetVelocity[0] = -v;
        motor->m_maxMotorForce[0] = most;
        rig.add(std::move(axes));
    }
}
/// The same about z; of a hinge Bullet bounds what it may do in a frame.
void turn(Rotors& rig, btRigidBody& a, btRigidBody& b, double speed, double impulse) {
    auto hinge = std::make_unique<btHingeConstraint>(a, b, at(0), at(0));
    hinge->setLimit(btScalar(-2.5), 0); // of A against B
    hinge->enableAngularMotor(true, btScalar(-speed), btScalar(impulse));
    rig.add(std::move(hinge));
}

} // namespace

TEST_CASE("A motor of Bullet's that has its speed within a frame pushed no less till then",
          "[frame]") {
    const Kind kind = GENERATE(Kind::six, Kind::springs, Kind::slider);
    const bool at_a_stop = GENERATE(false, true); // that it leaves
    CAPTURE(int(kind), at_a_stop);
    test::drive_apart<Rig>(
        accuracy, [=](Rig& rig, btRigidBody& a, btRigidBody& b, double speed, double force,
                      double /*frame*/) { drive(kind, rig, a, b, speed, force, at_a_stop); });
}

TEST_CASE("A hinge motor of Bullet's leaves its stop as if that were not there", "[frame]") {
    test::drive_apart<Rotors>(
        accuracy, [](Rotors& rig, btRigidBody& a, btRigidBody& b, double speed, double moment,
                     double frame) { turn(rig, a, b, speed, moment * frame); });
}

TEST_CASE("A motor of Bullet's that is at its stop goes on to push", "[frame]") {
    const Kind kind = GENERATE(Kind::six, Kind::springs, Kind::slider);
    CAPTURE(int(kind));
    test::press_against_a_stop<Rig>(
        accuracy, [kind](Rig& rig, btRigidBody& a, btRigidBody& b, double speed, double force,
                         double /*frame*/) { drive(kind, rig, a, b, -speed, force, true); });
}

TEST_CASE("A hinge motor of Bullet's that is at its stop goes on to push", "[frame]") {
    test::press_against_a_stop<Rotors>(
        accuracy, [](Rotors& rig, btRigidBody& a, btRigidBody& b, double speed, double moment,
                     double frame) { turn(rig, a, b, -speed, moment * frame); });
}

namespace {

/// A mass that a spring lets go of strikes another one on a plastic slider, in frames of 1/`rate`
/// s.
struct Shot {
    double work = 0;
    std::vector<std::string> said;
    bool believed = false;

    Shot(double rate, bool springs) {
        Rig rig({.springs = springs,
                 .warn = [this](const std::string& line) { said.push_back(line); }});
        rig.meets = 1;
        constexpr double mass = 10, frequency = 40, drawn = 0.1; // ω [rad/s]
        auto &post = rig.body(mass, 0.2 + drawn), &ball = rig.body(mass, 0);
        rig.hold(post, 2000);
        auto spring = six<btGeneric6DofSpring2Constraint>(btTypedConstraint::getFixedBody(), ball,
                                                          0, 0, true);
        spring->setLimit(0, 1, -1);
        set_spring(*spring, mass * frequency * frequency, drawn);
        rig.add(std::move(spring));
        rig.run(0.3, 1 / rate);
        work = rig.absorbed();
        believed = rig.world->run().believed();
    }
};

} // namespace

TEST_CASE(
    "Springs that Bullet softens come to a plastic joint with all of their stiffness where "
    "they are asked for, and are said where they are not",
    "[frame]") {
    const Shot fine(6000, true);
    CHECK(fine.said.empty());
    for (const double rate : {60.0, 30.0}) {
        CAPTURE(rate);
        const Shot asked(rate, true), usual(rate, false);
        CHECK(asked.work == Approx(fine.work).epsilon(0.02));
        CHECK(asked.believed);
        CHECK(asked.said.empty());
        REQUIRE(usual.said.size() == 1); // once
        CHECK(usual.said[0].find("between body 1 and the static world") != std::string::npos);
    }
}
