// SPDX-License-Identifier: MIT
//
// Plastic motors on joints that a world already has: every kind of ODE's joints with a motor,
// either way of attaching it, one or several plastic axes, and what is the user's stays the user's.
#include "adapters/ode_rig.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double exact = 1e-9;
const V3 none = V3::Zero();

V3 sphere(double i) { return V3::Constant(i); }
Joint joint(double strength, double limit = infinity) {
    return Joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}));
}

/// A joint as a user makes it, and the axis that is to be plastic.
struct Made {
    dJointID id = nullptr;
    ode::MotorAxis axis;
    V3 direction; ///< of the axis, world
};

struct KindOfJoint {
    std::string name;
    bool turns;
    std::function<Made(dWorldID, dBodyID, dBodyID)> make;
};

// three crooked axes at right angles
const V3 e0 = V3(1, 2, 2) / 3, e1 = V3(2, 1, -2) / 3, e2 = e0.cross(e1);

Made hinge(dWorldID world, dBodyID a, dBodyID b) {
    const dJointID id = dJointCreateHinge(world, nullptr);
    dJointAttach(id, a, b);
    dJointSetHingeAnchor(id, 0, 0, 0);
    dJointSetHingeAxis(id, e0.x(), e0.y(), e0.z());
    return {id, ode::hinge_axis(id), e0};
}
Made slider(dWorldID world, dBodyID a, dBodyID b) {
    const dJointID id = dJointCreateSlider(world, nullptr);
    dJointAttach(id, a, b);
    dJointSetSliderAxis(id, e0.x(), e0.y(), e0.z());
    const V3 direction = a != nullptr ? e0 : V3(-e0);
    return {id, ode::slider_axis(id), direction};
}
Made universal(dWorldID world, dBodyID a, dBodyID b, int number) {
    const dJointID id = dJointCreateUniversal(world, nullptr);
    dJointAttach(id, a, b);
    dJointSetUniversalAnchor(id, 0, 0, 0);
    dJointSetUniversalAxis1(id, e0.x(), e0.y(), e0.z());
    dJointSetUniversalAxis2(id, e1.x(), e1.y(), e1.z());
    return {id, ode::universal_axis(id, number), number == 0 ? e0 : e1};
}
Made hinge2(dWorldID world, dBodyID a, dBodyID b, int number, double lean = 0) {
    const dJointID id = dJointCreateHinge2(world, nullptr);
    dJointAttach(id, a, b);
    dJointSetHinge2Anchor(id, 0, 0, 0);
    const V3 wheel = (e1 + lean * e0).normalized();
    const dReal axis1[4] = {e0.x(), e0.y(), e0.z(), 0};
    const dReal axis2[4] = {wheel.x(), wheel.y(), wheel.z(), 0};
    dJointSetHinge2Axes(id, axis1, axis2);
    return {id, ode::hinge2_axis(id, number), number == 0 ? e0 : wheel};
}
Made angular(dWorldID world, dBodyID a, dBodyID b, int number, int relative_to) {
    const dJointID id = dJointCreateAMotor(world, nullptr);
    dJointAttach(id, a, b);
    dJointSetAMotorNumAxes(id, 3);
    const V3 axes[] = {e0, e1, e2};
    for (int i = 0; i < 3; ++i) {
        dJointSetAMotorAxis(id, i, relative_to, axes[i].x(), axes[i].y(), axes[i].z());
    }
    return {id, ode::angular_motor_axis(id, number), axes[number]};
}
Made linear(dWorldID world, dBodyID a, dBodyID b, int number, int relative_to) {
    const dJointID id = dJointCreateLMotor(world, nullptr);
    dJointAttach(id, a, b);
    dJointSetLMotorNumAxes(id, 3);
    const V3 axes[] = {e0, e1, e2};
    for (int i = 0; i < 3; ++i) {
        dJointSetLMotorAxis(id, i, relative_to, axes[i].x(), axes[i].y(), axes[i].z());
    }
    return {id, ode::linear_motor_axis(id, number, relative_to), axes[number]};
}

std::vector<KindOfJoint> kinds() {
    using std::placeholders::_1, std::placeholders::_2, std::placeholders::_3;
    std::vector<KindOfJoint> result{{"hinge", true, hinge}, {"slider", false, slider}};
    for (int i = 0; i < 2; ++i) {
        const std::string n = std::to_string(i);
        result.push_back({"universal " + n, true, std::bind(universal, _1, _2, _3, i)});
        result.push_back({"hinge-2 " + n, true, std::bind(hinge2, _1, _2, _3, i, 0)});
        result.push_back({"leaning hinge-2 " + n, true, std::bind(hinge2, _1, _2, _3, i, 0.4)});
    }
    for (int i = 0; i < 3; ++i) {
        for (int rel = 0; rel < 3; ++rel) {
            const std::string n = std::to_string(i) + " relative to " + std::to_string(rel);
            result.push_back({"angular " + n, true, std::bind(angular, _1, _2, _3, i, rel)});
            result.push_back({"linear " + n, false, std::bind(linear, _1, _2, _3, i, rel)});
        }
    }
    return result;
}

/// Travel of a row that stops from speed `u` at deceleration `a`, as symplectic Euler moves it.
double discrete_travel(double u, double a, double dt) {
    const double n = std::floor(u / (a * dt) * (1 + 1e-12));
    return dt * (n * u - a * dt * n * (n + 1) / 2);
}

void set_motion(dBodyID body, bool turns, const V3& motion) {
    if (turns) {
        dBodySetAngularVel(body, motion.x(), motion.y(), motion.z());
    } else {
        Rig::set_velocity(body, motion);
    }
}
V3 motion(dBodyID body, bool turns) { return turns ? Rig::spin(body) : Rig::velocity(body); }

const double dt = 1.0 / 240;

} // namespace

TEST_CASE("any axis of any joint stops two bodies with its strength", "[ode][motor]") {
    // 2 and 3 kg or kg m², 10 apart, strength 12: common 4, 60 J, as in P01c
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double way = GENERATE(1.0, -1.0);
    for (const KindOfJoint& kind : kinds()) {
        INFO(solver << ", " << kind.name << ", " << way);
        Rig rig(solver, none);
        auto a = rig.body(kind.turns ? 1 : 2, sphere(kind.turns ? 2 : 1), none, none, none);
        auto b = rig.body(kind.turns ? 1 : 3, sphere(kind.turns ? 3 : 1), none, none, none);
        const Made made = kind.make(rig.world(), a, b);
        set_motion(a, kind.turns, way * 10 * made.direction);
        auto& motor = rig.motor(made.axis, joint(12));
        rig.open_ledger();
        // the way is summed up from the velocities too, so that the sense of the position is known
        double travelled = 0;
        for (int i = 0; i < 260; ++i) {
            rig.step(dt);
            travelled += dt * motor.velocity();
            if (i == 100) CHECK(motor.reaction() == Approx(-way * 12).epsilon(exact));
        }
        CHECK(made.direction.dot(motion(a, kind.turns)) == Approx(way * 4).epsilon(exact));
        CHECK(made.direction.dot(motion(b, kind.turns)) == Approx(way * 4).epsilon(exact));
        CHECK(motor.position() == Approx(way * discrete_travel(10, 10, dt)).epsilon(1e-8));
        CHECK(motor.position() == Approx(travelled).epsilon(1e-8));
        CHECK(motor.absorbed_energy() == Approx(60).epsilon(exact));
        CHECK(motor.plastic_travel() == Approx(5).epsilon(exact));
        CHECK(std::abs(rig.ledger().unexplained()) < exact * 100);
        CHECK(motor.outcome() == Outcome::elastic);
    }
}

TEST_CASE("a joint to the static world works in either order of its bodies", "[ode][motor]") {
    // 2 kg or kg m² at 10, strength 40: 5 s⁻², 100 J
    const bool body_first = GENERATE(true, false);
    for (const KindOfJoint& kind : kinds()) {
        if (kind.name.find("hinge-2") != std::string::npos) continue; // needs two bodies
        if (!body_first && kind.name.find("universal") != std::string::npos) continue; // refused
        INFO(kind.name << (body_first ? ", body first" : ", world first"));
        Rig rig("direct", none);
        auto a = rig.body(2, sphere(2), none, none, none);
        const Made made =
            kind.make(rig.world(), body_first ? a : nullptr, body_first ? nullptr : a);
        set_motion(a, kind.turns, 10 * made.direction);
        auto& motor = rig.motor(made.axis, joint(40));
        rig.open_ledger();
        for (int i = 0; i < 150; ++i) rig.step(dt);
        CHECK(motion(a, kind.turns).norm() == Approx(0).margin(exact));
        CHECK(motor.position() == Approx(discrete_travel(10, 20, dt)).epsilon(1e-8));
        CHECK(motor.absorbed_energy() == Approx(100).epsilon(exact));
        CHECK(std::abs(rig.ledger().unexplained()) < exact * 100);
        // and its spring pulls back the right way
        if (body_first) continue;
        rig.remove(motor);
        auto& spring = rig.motor(made.axis, Joint(Perfect<double>({.strength = 1e4}),
                                                  TravelLimit<double>(), {.stiffness = 800}));
        const double start = spring.position();
        set_motion(a, kind.turns, made.direction);
        double most = 0;
        for (int i = 0; i < 240; ++i) {
            rig.step(dt);
            most = std::max(most, std::abs(spring.position() - start));
        }
        CHECK(most == Approx(1.0 / 20).epsilon(0.01)); // u/ω, sampled
    }
}

TEST_CASE("a linear motor acts midway between the bodies and keeps their angular momentum",
          "[ode][motor]") {
    // equal bodies abreast of the axis: what stops them also turns them, about their common centre
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const int relative_to = GENERATE(0, 1, 2);
    INFO(solver << ", relative to " << relative_to);
    Rig rig(solver, none);
    auto a = rig.body(2, sphere(0.5), {0, 1, 0}, {4, 0, 0}, none);
    auto b = rig.body(2, sphere(0.5), {0, -1, 0}, none, none);
    const dJointID id = dJointCreateLMotor(rig.world(), nullptr);
    dJointAttach(id, a, b);
    dJointSetLMotorNumAxes(id, 1);
    dJointSetLMotorAxis(id, 0, relative_to, 1, 0, 0);
    auto& motor = rig.motor(ode::linear_motor_axis(id, 0, relative_to), joint(10));
    rig.open_ledger();
    const V3 momentum = 2 * (Rig::velocity(a) + Rig::velocity(b));
    const double first =
        4 - 10 * dt * 2 * (0.5 + 1 / 0.5); // u' of the point midway: K = 2 (1/m + r²/I)
    rig.step(dt);
    // seen along the axis as it is after the step, in which the bodies turned a little
    CHECK(motor.velocity() == Approx(first).epsilon(1e-6));
    CHECK(Rig::spin(a).z() == Approx(-10 * dt * 1 / 0.5).epsilon(exact));
    CHECK(motor.reaction() == Approx(-10).epsilon(exact));
    for (int i = 0; i < 100; ++i) rig.step(dt);
    CHECK((2 * (Rig::velocity(a) + Rig::velocity(b)) - momentum).norm() < 1e-11);
    CHECK(std::abs(motor.velocity()) < 0.1); // it holds, but for the turning of its axis
    CHECK(std::abs(rig.ledger().unexplained()) < exact * 16);
}

TEST_CASE("a motor says by how much its pin was left unsolved", "[ode][motor]") {
    Rig rig("quick", {3, -9.81, 5});
    const V3 at(0.7, 0.2, -0.4);
    auto body = rig.body(2, sphere(0.5), at, none, 3 * e1);
    rig.leave_to_ode(body);
    auto& motor = rig.motor(hinge(rig.world(), body, nullptr).axis, joint(12));
    dWorldSetQuickStepNumIterations(rig.world(), 1);
    rig.step(dt);
    // the point of the body that is held, where it was when the step was solved
    const V3 off = Rig::velocity(body) + Rig::spin(body).cross(-at);
    REQUIRE(off.norm() > 1e-3);
    CHECK(motor.rigid_residual() == Approx(off.cwiseAbs().maxCoeff()).epsilon(1e-3));
}

TEST_CASE("both axes of a universal flow at once, each with its own strength", "[ode][motor]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const bool wheel = GENERATE(false, true);
    INFO(solver << (wheel ? ", hinge-2" : ", universal"));
    Rig rig(solver, none);
    auto a = rig.body(1, sphere(2), none, none, 5 * e0 + 4 * e1);
    auto b = rig.body(1, sphere(3), none, none, none);
    const Made made = wheel ? hinge2(rig.world(), a, b, 0) : universal(rig.world(), a, b, 0);
    auto& first = rig.motor(made.axis, joint(12));
    auto& second =
        rig.motor(wheel ? ode::hinge2_axis(made.id, 1) : ode::universal_axis(made.id, 1), joint(7));
    rig.open_ledger();
    for (int i = 0; i < 20; ++i) {
        rig.step(dt);
        CHECK(first.reaction() == Approx(-12).epsilon(1e-8));
        CHECK(second.reaction() == Approx(-7).epsilon(1e-8));
        CHECK(first.rigid_residual() < (solver == "quick" ? 1e-2 : 1e-9));
    }
    for (int i = 0; i < 400; ++i) rig.step(dt);
    const double relative = (Rig::spin(a) - Rig::spin(b)).norm();
    CHECK(relative < (solver == "quick" ? 1e-3 : 1e-6));
    CHECK(first.absorbed_energy() > 5);
    CHECK(second.absorbed_energy() > 3);
    CHECK(std::abs(rig.ledger().unexplained()) < exact * 41);
    // the joint's own angles say the same
    const double angle1 =
        wheel ? dJointGetHinge2Angle1(made.id) : dJointGetUniversalAngle1(made.id);
    const double angle2 =
        wheel ? -dJointGetHinge2Angle2(made.id) : dJointGetUniversalAngle2(made.id);
    CHECK(std::remainder(first.position() - angle1, 2 * std::numbers::pi) ==
          Approx(0).margin(1e-9));
    CHECK(std::remainder(second.position() - angle2, 2 * std::numbers::pi) ==
          Approx(0).margin(1e-9));
}

TEST_CASE("a ball with an angular motor bends about three axes", "[ode][motor]") {
    // a bar on a ball; its elastic motor knows the pin: I = 0.5 + 3·4 = 12.5 about e1 and e2, 0.5
    // about e0
    Rig rig("direct", none);
    auto bar = rig.body(3, sphere(0.5), 2 * e0, 0.1 * e1.cross(2 * e0), 0.1 * e1);
    const dJointID ball = dJointCreateBall(rig.world(), nullptr);
    dJointAttach(ball, bar, nullptr);
    dJointSetBallAnchor(ball, 0, 0, 0);
    const Made made = angular(rig.world(), bar, nullptr, 0, 1);
    std::vector<ode::PlasticMotor<>*> motors;
    for (int i = 0; i < 3; ++i) {
        motors.push_back(&rig.motor(
            ode::angular_motor_axis(made.id, i),
            Joint(Perfect<double>({.strength = 1e4}), TravelLimit<double>(), {.stiffness = 5000})));
    }
    rig.open_ledger();
    double most = 0;
    for (int i = 0; i < 600; ++i) {
        rig.step(1.0 / 60); // resolved with the mass about the pin, not with that about the centre
        if (i > 300) most = std::max(most, std::abs(motors[1]->position()));
    }
    CHECK(most == Approx(0.005).margin(0.005 * std::pow(20.0 / 60, 2) / 4));
    CHECK(std::abs(rig.ledger().unexplained()) < exact);
}

TEST_CASE("a motor that breaks lets go of its joint, or of its axis only", "[ode][motor]") {
    // P02a
    const double rate = GENERATE(15.0, 60.0, 240.0);
    for (const auto at_break : {ode::AtBreak::disable_joint, ode::AtBreak::release_axis}) {
        for (const KindOfJoint& kind : kinds()) {
            if (kind.name.find("hinge-2") != std::string::npos) continue;
            INFO(kind.name << ", dt = 1/" << rate);
            Rig rig("direct", none);
            auto a = rig.body(2, sphere(2), none, none, none);
            const Made made = kind.make(rig.world(), a, nullptr);
            set_motion(a, kind.turns, 10 * made.direction);
            auto& motor = rig.motor(made.axis, joint(40, 1.6), at_break);
            rig.open_ledger();
            for (int i = 0; i < 2000 && !motor.broken(); ++i) rig.step(1 / rate);
            REQUIRE(motor.broken());
            CHECK(made.direction.dot(motion(a, kind.turns)) == Approx(6).epsilon(exact));
            CHECK(motor.absorbed_energy() == Approx(64).epsilon(exact));
            CHECK(std::abs(rig.ledger().unexplained()) < exact * 100);
            CHECK((dJointIsEnabled(made.id) != 0) == (at_break == ode::AtBreak::release_axis));
            rig.step(1 / rate);
            CHECK(made.direction.dot(motion(a, kind.turns)) == Approx(6).epsilon(exact));
            CHECK(motor.reaction() == 0);
            // somebody switches the joint on again: broken is broken
            dJointEnable(made.id);
            made.axis.set(dParamFMax, 1e3);
            rig.step(1 / rate);
            CHECK(made.direction.dot(motion(a, kind.turns)) == Approx(6).epsilon(exact));
        }
    }
}

TEST_CASE("a break beside the centres of mass keeps the ledger closed for every kind",
          "[ode][motor]") {
    for (const KindOfJoint& kind : kinds()) {
        INFO(kind.name);
        Rig rig("direct", none);
        auto a = rig.body(1, {0.1, 0.4, 0.3}, {-1, 0.2, 0}, {0, -2, 1}, {0.3, 0.2, 1});
        auto b = rig.body(2, {0.2, 0.6, 0.5}, {1, 0, -0.3}, {0, -2, 0}, {0, 0.1, -1});
        const Made made = kind.make(rig.world(), a, b);
        auto& motor = rig.motor(made.axis, joint(0.02, 0.01));
        rig.open_ledger();
        const double input = rig.ledger().held().kinetic;
        const V3 momentum = Rig::velocity(a) + 2 * Rig::velocity(b);
        for (int i = 0; i < 500 && !motor.broken(); ++i) rig.step(dt);
        REQUIRE(motor.broken());
        CHECK(motor.absorbed_energy() == Approx(0.02 * 0.01).epsilon(exact));
        CHECK(std::abs(rig.ledger().unexplained()) < exact * input);
        CHECK((Rig::velocity(a) + 2 * Rig::velocity(b) - momentum).norm() < 1e-10);
    }
}

TEST_CASE("what is the user's stays the user's", "[ode][motor]") {
    Rig rig("direct", none);
    auto a = rig.body(1, sphere(2), none, none, none);
    const Made made = hinge(rig.world(), a, nullptr);
    dJointSetHingeParam(made.id, dParamVel, 3);
    dJointSetHingeParam(made.id, dParamFMax, 5);
    dJointSetHingeParam(made.id, dParamCFM, 0.25);
    dJointFeedback mine{};

    SECTION("the motor is put back as it was") {
        auto& motor = rig.motor(made.axis, joint(40));
        rig.step(dt);
        CHECK(dJointGetHingeParam(made.id, dParamFMax) == 40);
        rig.remove(motor);
        CHECK(dJointGetHingeParam(made.id, dParamVel) == 3);
        CHECK(dJointGetHingeParam(made.id, dParamFMax) == 5);
        CHECK(dJointGetHingeParam(made.id, dParamCFM) == 0.25);
        CHECK(dJointGetFeedback(made.id) == nullptr);
        rig.step(dt);
    }
    SECTION("a feedback set before is read and kept") {
        dJointSetFeedback(made.id, &mine);
        auto& motor = rig.motor(made.axis, joint(40));
        dBodyAddTorque(a, 10 * e0.x(), 10 * e0.y(), 10 * e0.z());
        rig.step(dt);
        CHECK(dJointGetFeedback(made.id) == &mine);
        CHECK(ode::to_core(mine.t1).dot(e0) == Approx(-10));
        CHECK(motor.reaction() == Approx(-10));
        rig.remove(motor);
        CHECK(dJointGetFeedback(made.id) == &mine);
    }
    SECTION("a feedback set later takes the place of ours") {
        auto& motor = rig.motor(made.axis, joint(40));
        ode::World stepper(rig.world()); // without the rig's energy account, which lends its own
        motor.add_to(stepper);
        stepper.step(dt);
        CHECK(dJointGetFeedback(made.id) != nullptr);
        dJointSetFeedback(made.id, &mine);
        dBodyAddTorque(a, 10 * e0.x(), 10 * e0.y(), 10 * e0.z());
        stepper.step(dt);
        CHECK(motor.reaction() == Approx(-10));
        CHECK(ode::to_core(mine.t1).dot(e0) == Approx(-10));
        rig.remove(motor);
        CHECK(dJointGetFeedback(made.id) == &mine);
    }
    SECTION("one taken away is set again, and ours goes with us") {
        auto& motor = rig.motor(made.axis, joint(40));
        ode::World stepper(rig.world());
        motor.add_to(stepper);
        stepper.step(dt);
        dJointSetFeedback(made.id, nullptr);
        dBodyAddTorque(a, 10 * e0.x(), 10 * e0.y(), 10 * e0.z());
        stepper.step(dt);
        CHECK(motor.reaction() == Approx(-10));
        rig.remove(motor);
        CHECK(dJointGetFeedback(made.id) == nullptr);
    }
}

TEST_CASE("an axis that cannot be plastic is refused by name", "[ode][motor]") {
    Rig rig("direct", none);
    auto a = rig.body(1, sphere(2), none, none, none);
    const auto refused = [](const std::string& word, const auto& make) {
        try {
            make();
        } catch (const std::invalid_argument& error) {
            INFO(error.what());
            CHECK(std::string(error.what()).find(word) != std::string::npos);
            return;
        }
        FAIL("nothing was thrown: " << word);
    };
    const Made made = hinge(rig.world(), a, nullptr);
    const dJointID angular_id = angular(rig.world(), a, nullptr, 0, 0).id;
    refused("joint = null", [] { (void)ode::hinge_axis(nullptr); });
    refused("joint = null", [] { (void)ode::angular_motor_axis(nullptr, 0); });
    refused("must be ODE's slider", [&] { (void)ode::slider_axis(made.id); });
    refused("must be ODE's angular motor", [&] { (void)ode::angular_motor_axis(made.id, 0); });
    refused("must be ODE's linear motor", [&] { (void)ode::linear_motor_axis(made.id, 0, 0); });
    refused("number = 3", [&] { (void)ode::angular_motor_axis(angular_id, 3); });
    refused("number = -1", [&] { (void)ode::angular_motor_axis(angular_id, -1); });
    refused("attached to a body",
            [&] { (void)ode::hinge_axis(dJointCreateHinge(rig.world(), nullptr)); });
    refused("not as (null, body)", [&] { (void)universal(rig.world(), nullptr, a, 0); });
    refused("relative_to = 3",
            [&] { (void)ode::linear_motor_axis(linear(rig.world(), a, nullptr, 0, 0).id, 0, 3); });
    refused("user mode", [&] {
        const dJointID euler = dJointCreateAMotor(rig.world(), nullptr);
        dJointAttach(euler, a, nullptr);
        refused("independent", [&] {
            dJointSetAMotorNumAxes(euler, 3);
            for (int i = 0; i < 3; ++i) dJointSetAMotorAxis(euler, i, 0, 0, 0, 1);
            (void)ode::angular_motor_axis(euler, 0);
        });
        dJointSetAMotorMode(euler, dAMotorEuler);
        struct End {
            dJointID id;
            ~End() { dJointDestroy(id); } // its axes are none
        } end{euler};
        (void)ode::angular_motor_axis(euler, 0);
    });
    SECTION("what no joint comes to") {
        auto& motor = rig.motor(made.axis, joint(40));
        const auto state = motor.joint().state();
        refused("restore.position = nan", [&] { motor.restore(state, std::nan("")); });
        CHECK(motor.position() == 0);
    }
    SECTION("a stop set before") {
        dJointSetHingeParam(made.id, dParamHiStop, 0.5);
        refused("dParamHiStop", [&] { rig.motor(made.axis, joint(40)); });
    }
    SECTION("a stop set later: the world is left as it was") {
        auto& motor = rig.motor(made.axis, joint(40));
        dBodySetAngularVel(a, e0.x(), e0.y(), e0.z());
        dJointSetHingeParam(made.id, dParamLoStop, -0.5);
        CHECK_THROWS_AS(rig.step(dt), std::logic_error);
        CHECK(motor.position() == 0);
        CHECK(Rig::spin(a).dot(e0) == Approx(1));
        dJointSetHingeParam(made.id, dParamLoStop, -dInfinity);
        rig.step(dt);
        CHECK(motor.position() > 0);
    }
}

TEST_CASE("bodies whose numbers are not finite are refused, and joints keep their states",
          "[ode][motor][not_finite]") {
    // ODE would end the process
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double bad = GENERATE(as<double>{}, std::nan(""), infinity);
    const bool six_axes = GENERATE(true, false);
    INFO(solver << ", " << bad << (six_axes ? ", six axes" : ", motor"));
    const auto run = [&](bool spoil) {
        Rig rig(solver, none);
        auto a = rig.body(2, sphere(0.5), none, V3(4 * e0), none);
        const auto steps = [&](auto& constraint) {
            rig.step(dt);
            REQUIRE(constraint.outcome() == Outcome::yielding);
            const auto state = constraint.joint().state();
            const auto motion = Rig::motion(a);
            if (spoil) {
                Rig::set_velocity(a, {0, bad, 0});
                CHECK_THROWS_AS(rig.step(dt), std::invalid_argument);
                CHECK(constraint.joint().state() == state);
                if constexpr (requires { constraint.position(); }) {
                    CHECK(std::isfinite(constraint.position()));
                    CHECK(std::isfinite(constraint.reaction()));
                }
                rig.put_back(a, motion);
            }
            for (int i = 0; i < 5; ++i) rig.step(dt);
            return constraint.plastic_travel();
        };
        if (six_axes) {
            using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
            const auto capacity = Vector6<double>::Constant(10);
            return steps(rig.six_axis(a, nullptr, JointFrame<double>{},
                                      Six(Ellipsoid<double, 6>({.capacity = capacity}),
                                          Perfect<double>({.strength = 10}))));
        }
        return steps(rig.motor(linear(rig.world(), a, nullptr, 0, 0).axis, joint(10)));
    };
    CHECK(run(true) == Approx(run(false)).epsilon(exact));
}
