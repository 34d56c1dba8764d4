// SPDX-License-Identifier: MIT
//
// How joints, bodies and worlds of ODE end: in which order they may, and what a break leaves
// behind. Worth running under AddressSanitizer.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdarg>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ductile/ode/ode.hpp"
#include "support/throws.hpp"

using namespace ductile;

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

OneAxisJoint<Perfect<double>> joint(double strength, double limit = unlimited) {
    return OneAxisJoint(Perfect<double>({.strength = strength}),
                        TravelLimit<double>({.limit = limit}));
}

/// ODE says where a world ends before a joint of a group.
void say_nothing(int, const char*, va_list) {}

struct Engine {
    Engine() {
        dInitODE2(0);
        dSetMessageHandler(say_nothing);
    }
    ~Engine() {
        end();
        dSetMessageHandler(nullptr);
        dCloseODE();
    }
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// I = 2 kg m², spinning about z.
    [[nodiscard]] dBodyID rotor(double spin) const {
        const dBodyID body = dBodyCreate(id);
        dMass m;
        dMassSetParameters(&m, 1, 0, 0, 0, 2, 2, 2, 0, 0, 0);
        dBodySetMass(body, &m);
        dBodySetAngularVel(body, 0, 0, dReal(spin));
        return body;
    }
    void end() {
        if (id != nullptr) dWorldDestroy(id);
        id = nullptr;
    }

    dWorldID id = dWorldCreate();
};

/// A joint about z of each kind between `a` and `b` (null: the static world).
struct Kind {
    const char* name;
    std::unique_ptr<ode::PlasticConstraint> (*make)(dWorldID world, dBodyID a, dBodyID b,
                                                    double limit);
};

const std::vector<Kind> kinds{
    {"hinge",
     [](dWorldID world, dBodyID a, dBodyID b,
        double limit) -> std::unique_ptr<ode::PlasticConstraint> {
         return std::make_unique<ode::PlasticHinge<>>(
             world, a, b, ode::HingeFrame{.axis = {0, 0, 1}}, joint(64, limit));
     }},
    {"six axes",
     [](dWorldID world, dBodyID a, dBodyID b,
        double limit) -> std::unique_ptr<ode::PlasticConstraint> {
         using One = OneAxisJoint<Perfect<double>>;
         return std::make_unique<ode::PlasticJoint<One>>(
             world, a, b, JointFrame<double>{}, joint(64, limit), std::array{JointAxis::torsion});
     }},
    {"motor",
     [](dWorldID world, dBodyID a, dBodyID b,
        double limit) -> std::unique_ptr<ode::PlasticConstraint> {
         const dJointID hinge = dJointCreateHinge(world, nullptr);
         dJointAttach(hinge, a, b);
         dJointSetHingeAxis(hinge, 0, 0, 1);
         return std::make_unique<ode::PlasticMotor<>>(ode::hinge_axis(hinge), joint(64, limit));
     }},
};

} // namespace

TEST_CASE("two parts are no longer connected once their joint has broken", "[ode][ends]") {
    const Kind kind = GENERATE(from_range(kinds));
    const bool to_ground = GENERATE(false, true);
    INFO(kind.name << (to_ground ? " to the ground" : ""));
    Engine engine;
    const dBodyID a = engine.rotor(10), b = to_ground ? nullptr : engine.rotor(-10);
    ode::World world(engine.id, ode::WorldParameters{.warn = nullptr});
    world.add(a);
    if (b != nullptr) world.add(b);
    const auto constraint = kind.make(engine.id, a, b, 0.05);
    world.add(*constraint);
    CHECK(dAreConnectedExcluding(a, b, dJointTypeContact) == 1);
    for (int i = 0; i < 100 && !constraint->queries().broken(); ++i) world.step(1. / 240);
    REQUIRE(constraint->queries().broken());
    CHECK(dAreConnectedExcluding(a, b, dJointTypeContact) == 0);
    for (int i = 0; i < 10; ++i) world.step(1. / 240);
    // 64 N m over 0.05 rad, and the ledger knows of the break
    CHECK(constraint->queries().absorbed_energy() == Approx(3.2));
    const double kinetic = to_ground ? 100 : 200;
    CHECK(world.ledger().held().kinetic == Approx(kinetic - 3.2));
    CHECK(std::abs(world.ledger().unexplained()) < 1e-9 * kinetic);
}

TEST_CASE("contacts between two parts act once their joint has broken", "[ode][ends]") {
    const Kind kind = GENERATE(from_range(kinds));
    CAPTURE(kind.name);
    const bool motor = std::string(kind.name) == "motor"; // whose hinge is the user's
    Engine engine;
    const dBodyID a = engine.rotor(10), b = engine.rotor(-10), other = engine.rotor(0);
    const dJointGroupID group = dJointGroupCreate(0);
    ode::World world(engine.id, ode::WorldParameters{.warn = nullptr});
    for (dBodyID body : {a, b, other}) world.add(body);
    const auto constraint = kind.make(engine.id, a, b, 0.05);
    const auto to_world = kind.make(engine.id, other, nullptr, unlimited);
    world.add(*constraint);
    world.add(*to_world);
    const auto acts = [&](dBodyID first, dBodyID second, bool between_joined = false) {
        dContact contact{};
        contact.geom.normal[2] = 1; // they do not close
        contact.geom.pos[0] = 1;
        const dJointID joint = dJointCreateContact(engine.id, group, &contact);
        dJointAttach(joint, first, second);
        world.add_contact(joint, contact, between_joined);
        return dJointIsEnabled(joint) != 0;
    };
    CHECK(acts(a, b) == motor);
    CHECK(acts(b, a) == motor);
    CHECK(acts(a, b, true));
    CHECK(acts(a, other));
    CHECK(acts(a, nullptr));
    CHECK(acts(other, nullptr)); // of what holds it to the world nothing is known
    world.step(1e-6);
    dJointGroupEmpty(group);
    for (int i = 0; i < 100 && !constraint->queries().broken(); ++i) world.step(1. / 240);
    REQUIRE(constraint->queries().broken());
    CHECK(acts(a, b));
    world.step(1e-6);
    dJointGroupDestroy(group);
}

TEST_CASE("a joint of six axes that is mended connects its parts again", "[ode][ends]") {
    Engine engine;
    const dBodyID a = engine.rotor(10);
    ode::World world(engine.id);
    ode::PlasticJoint constraint(engine.id, a, nullptr, JointFrame<double>{}, joint(64, 0.05),
                                 {JointAxis::torsion});
    constraint.add_to(world);
    const auto whole = constraint.state();
    for (int i = 0; i < 100 && !constraint.broken(); ++i) world.step(1. / 240);
    REQUIRE(constraint.broken());
    CHECK_FALSE(constraint.detached());
    const dQuaternion start = {1, 0, 0, 0};
    dBodySetQuaternion(a, start);
    dBodySetAngularVel(a, 0, 0, 1);
    constraint.restore(whole);
    CHECK(dAreConnected(a, nullptr) == 1);
    for (int i = 0; i < 100; ++i) world.step(1. / 240);
    CHECK(constraint.absorbed_energy() == Approx(1)); // of 0.5 × 2 × 1²
    CHECK(dBodyGetAngularVel(a)[2] == Approx(0).margin(1e-9));
}

TEST_CASE("ODE's world ends before what is in it", "[ode][ends]") {
    const Kind kind = GENERATE(from_range(kinds));
    const bool broken = GENERATE(false, true), joint_first = GENERATE(false, true);
    INFO(kind.name << (broken ? ", broken" : "") << (joint_first ? ", then the joint" : ""));
    Engine engine;
    const dBodyID a = engine.rotor(10);
    auto world = std::make_unique<ode::World>(engine.id, ode::WorldParameters{.warn = nullptr});
    world->add(a);
    auto constraint = kind.make(engine.id, a, nullptr, broken ? 0.05 : unlimited);
    world->add(*constraint);
    for (int i = 0; i < 10; ++i) world->step(1e-2);
    const double absorbed = constraint->queries().absorbed_energy();
    engine.end();
    CHECK(constraint->queries().absorbed_energy() == absorbed);
    if (joint_first) constraint.reset();
    world.reset();
}

TEST_CASE("joints of a world that is gone leave a new one alone", "[ode][ends]") {
    Engine engine;
    const Kind kind = GENERATE(from_range(kinds));
    INFO(kind.name);
    auto old = kind.make(engine.id, engine.rotor(10), nullptr, unlimited);
    engine.end();
    engine.id = dWorldCreate(); // where the old one was, as often as not
    const dBodyID a = engine.rotor(10);
    ode::World world(engine.id);
    auto constraint = kind.make(engine.id, a, nullptr, unlimited);
    world.add(*constraint);
    old.reset();
    for (int i = 0; i < 100; ++i) world.step(1e-2);
    CHECK(constraint->queries().absorbed_energy() == Approx(100));
}

TEST_CASE("a joint that ends leaves every World", "[ode][ends]") {
    const Kind kind = GENERATE(from_range(kinds));
    INFO(kind.name);
    Engine engine;
    const dBodyID a = engine.rotor(10);
    ode::World world(engine.id, ode::WorldParameters{.warn = nullptr});
    ode::World other(engine.id);
    world.add(a);
    {
        const auto constraint = kind.make(engine.id, a, nullptr, unlimited);
        world.add(*constraint);
        other.add(*constraint);
        world.step(1e-2);
    }
    const double spin = double(dBodyGetAngularVel(a)[2]);
    CHECK(spin == Approx(10 - 0.32));
    world.step(1e-2);
    other.step(1e-2);
    if (std::string(kind.name) != "motor") {
        CHECK(double(dBodyGetAngularVel(a)[2]) == spin);
        CHECK(dBodyGetNumJoints(a) == 0);
    }
    CHECK(std::abs(world.ledger().unexplained()) < 1e-9);
}

TEST_CASE("a joint ends in a listener", "[ode][ends]") {
    Engine engine;
    const dBodyID a = engine.rotor(10);
    ode::World world(engine.id, ode::WorldParameters{.warn = nullptr});
    auto constraint = kinds[0].make(engine.id, a, nullptr, 0.05);
    world.add(*constraint);
    world.on_event([&](const JointEvent<double>& event) {
        if (event.kind == EventKind::broke) constraint.reset();
    });
    for (int i = 0; i < 10; ++i) world.step(1e-2);
    CHECK(constraint == nullptr);
}

TEST_CASE("a World ends before its joints, and another steps them", "[ode][ends]") {
    Engine engine;
    const dBodyID a = engine.rotor(10);
    const auto constraint = kinds[0].make(engine.id, a, nullptr, unlimited);
    {
        ode::World first(engine.id);
        first.add(*constraint);
        first.step(1e-2);
    }
    ode::World second(engine.id);
    second.add(*constraint);
    for (int i = 0; i < 100; ++i) second.step(1e-2);
    CHECK(constraint->queries().absorbed_energy() == Approx(100));
}

TEST_CASE("what makes no joint in ODE is refused in words", "[ode][ends]") {
    Engine engine, other;
    const dBodyID a = engine.rotor(0), b = engine.rotor(0), foreign = other.rotor(0);
    dBodySetPosition(b, 1, 0, 0);
    const auto hinge = [&](dBodyID first, dBodyID second, const ode::HingeFrame& frame) {
        return test::message_of(
            [&] { ode::PlasticHinge(engine.id, first, second, frame, joint(64)); });
    };
    CHECK(hinge(a, a, {}) == "PlasticHinge.b: must not be body a itself");
    CHECK(hinge(a, foreign, {}) == "PlasticHinge.b: must be a body of the joint's world");
    CHECK(hinge(a, b, {.axis = {0, 0, 0}}) ==
          "PlasticHinge.frame.axis: must be finite and of a length > 0");
    CHECK(hinge(a, b, {.anchor = {0, std::nan(""), 0}}) ==
          "PlasticHinge.frame.anchor: must be finite [m]");
    CHECK(test::message_of([&] {
              ode::PlasticSlider(engine.id, a, b, Vector3<double>(0, std::nan(""), 1), joint(64));
          }) == "PlasticSlider.axis: must be finite and of a length > 0");
    CHECK(test::message_of([&] {
              ode::PlasticJoint(engine.id, a, b, JointFrame<double>{.origin = {0.5, 0, 0}},
                                JointFrame<double>{.origin = {-0.2, 0, 0}}, joint(64),
                                std::array{JointAxis::torsion});
          }).find("axis shear_x, apart by = -0.3") != std::string::npos);
    CHECK(dBodyGetNumJoints(a) == 0);
    ode::World world(other.id);
    ode::PlasticHinge fine(engine.id, a, b, {.anchor = {0.5, 0, 0}}, joint(64));
    CHECK(test::message_of([&] { world.add(fine); }) ==
          "World.add.joint: must be one between bodies of this world");
}

TEST_CASE("what does not belong to a World of ODE is refused in words", "[ode][ends]") {
    Engine engine, other;
    ode::World world(engine.id);
    const dBodyID a = engine.rotor(10), b = engine.rotor(0), foreign = other.rotor(0);
    CHECK(test::message_of([&] { world.add(foreign); }) ==
          "World.add.body: must be a body of this world");
    const auto motor_of = [](dWorldID id, dBodyID first, dBodyID second) {
        const dJointID hinge = dJointCreateHinge(id, nullptr);
        dJointAttach(hinge, first, second);
        dJointSetHingeAxis(hinge, 0, 0, 1);
        return ode::hinge_axis(hinge);
    };
    ode::PlasticMotor<> far(motor_of(other.id, nullptr, foreign), joint(64));
    const std::string of_others = "World.add.joint: must be one between bodies of this world";
    CHECK(test::message_of([&] { world.add(far); }) == of_others);
    ode::PlasticHinge late(engine.id, b, nullptr, {}, joint(64));
    dBodyDestroy(b);
    CHECK(test::message_of([&] { world.add(late); }) == of_others);

    const ode::MotorAxis axis = motor_of(engine.id, a, nullptr);
    ode::PlasticMotor<> one(axis, joint(64)), again(axis, joint(32));
    world.add(one);
    CHECK(test::message_of([&] { world.add(again); }) ==
          "World.add.joint: must be the only one of that axis of ODE's joint");
    for (int i = 0; i < 600; ++i) world.step(1e-3);
    CHECK(one.absorbed_energy() == Approx(100));
}

TEST_CASE("a world that is not finite is refused before ODE ends the process", "[ode][ends]") {
    constexpr auto nan = dReal(std::numeric_limits<double>::quiet_NaN());
    for (const double tolerance : {0.0, 0.01}) {
        CAPTURE(tolerance);
        Engine engine;
        const dBodyID body = engine.rotor(0);
        ode::World world(engine.id, ode::WorldParameters{.tolerance = tolerance, .warn = nullptr});
        world.add(body);
        ode::PlasticHinge hinge(engine.id, body, nullptr, {.axis = {0, 0, 1}}, joint(64));
        world.add(hinge);
        const auto refused = [&] { return test::message_of([&] { world.step(1e-2); }); };
        dWorldSetGravity(engine.id, 0, nan, 0);
        CHECK(refused() ==
              "World.step: the gravity of the world must be finite, as ODE would end the process");
        dWorldSetGravity(engine.id, 0, 0, 0);
        for (const dReal bad : {nan, dReal(1.5)}) {
            dBodySetLinearDamping(body, bad);
            CHECK(refused().starts_with("World.step: the damping of body 0 = "));
            dBodySetLinearDamping(body, 0);
        }
        dBodySetAngularVel(body, 0, 0, dReal(1e300));
        CHECK(refused().starts_with("World.step: the spin of body 0 must be finite"));
        dBodySetAngularVel(body, 0, 0, 0);
        CHECK(refused() == "nothing thrown");
        CHECK(world.time() == 1e-2);
    }
}

TEST_CASE("a body that is not finite is refused before ODE ends the process", "[ode][ends]") {
    const double tolerance = GENERATE(0.0, 0.01);
    const double bad = GENERATE(std::nan(""), std::numeric_limits<double>::infinity());
    const bool held = GENERATE(false, true);
    CAPTURE(tolerance, bad, held);
    Engine engine;
    const dBodyID a = engine.rotor(10), b = engine.rotor(0);
    ode::World world(engine.id, ode::WorldParameters{.tolerance = tolerance, .warn = nullptr});
    world.add(b);
    world.add(a);
    ode::PlasticHinge hinge(engine.id, a, nullptr, {.axis = {0, 0, 1}}, joint(64));
    world.add(hinge, "hinge");
    world.step(1e-3);
    const dBodyID body = held ? a : b;
    const std::string owner = held ? "body 1" : "body 0";
    const double energy = world.ledger().held().total(), taken = hinge.absorbed_energy();
    const auto refused = [&](const char* what) {
        CHECK(test::message_of([&] { world.step(1e-3); }) ==
              "World.step: the " + std::string(what) + " of " + owner +
                  " must be finite, as ODE would end the process");
        CHECK(world.time() == 1e-3);
    };
    dBodySetLinearVel(body, 0, dReal(bad), 0);
    refused("velocity");
    dBodySetLinearVel(body, 0, 0, 0);
    dBodyAddForce(body, dReal(bad), 0, 0);
    refused("force");
    dBodySetForce(body, 0, 0, 0);
    dBodyAddTorque(body, dReal(bad), 0, 0);
    refused("torque");
    dBodySetTorque(body, 0, 0, 0);
    const dReal spin = dBodyGetAngularVel(body)[2];
    dBodySetAngularVel(body, 0, 0, dReal(bad));
    refused("spin");
    dBodySetAngularVel(body, 0, 0, spin);
    dBodySetPosition(body, dReal(bad), 0, 0);
    refused("position");
    dBodySetPosition(body, 0, 0, 0);
    CHECK(hinge.absorbed_energy() == taken);
    CHECK(world.ledger().held().total() == energy);
    for (int i = 0; i < 400; ++i) world.step(1e-3);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(tolerance > 0 ? 1e-3 : 1e-2));
    CHECK(std::abs(world.ledger().unexplained()) < 1e-9);
}

TEST_CASE("a World of ODE refuses a body that is not finite and that a joint alone tells",
          "[ode][ends]") {
    Engine engine;
    const dBodyID a = engine.rotor(10);
    ode::World world(engine.id);
    ode::PlasticHinge hinge(engine.id, a, nullptr, {.axis = {0, 0, 1}}, joint(64));
    world.add(hinge, "gate");
    dBodySetLinearVel(a, 0, dReal(std::nan("")), 0);
    CHECK(test::message_of([&] { world.step(1e-3); }) ==
          "World.step: the velocity of a body of \"gate\" must be finite, as ODE would end the "
          "process");
}

TEST_CASE("a World of ODE says once of a joint that nobody added", "[ode][ends]") {
    Engine engine;
    const dBodyID a = engine.rotor(0);
    ode::PlasticHinge forgotten(engine.id, a, nullptr, {}, joint(64)),
        added(engine.id, a, nullptr, {}, joint(64));
    std::vector<std::string> said;
    ode::World world(engine.id, ode::WorldParameters{.warn = [&](const std::string& line) {
                         said.push_back(line);
                     }});
    world.add(added);
    for (int i = 0; i < 3; ++i) world.step(1e-3);
    REQUIRE(said.size() == 1);
    CHECK(said[0].find("never added") != std::string::npos);
}
