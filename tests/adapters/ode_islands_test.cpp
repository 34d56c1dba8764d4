// SPDX-License-Identifier: MIT
//
// Islands that the World of an ODE world solves before ODE's step: the contacts in them against
// ODE's own, what is left to ODE, sleep.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ode_structure_rig.hpp"

#include "adapters/frame.hpp"
#include "ductile/surface/ellipsoid.hpp"

namespace {

using ductile::CoupledJoint;
using ductile::Ellipsoid;
using ductile::Perfect;
using ductile::Vector3;
using ductile::Vector6;
using ductile::test::Frame;
using ductile::test::FrameSettings;
namespace ode = ductile::ode;
using V3 = Vector3<double>;
using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;

constexpr double dt = 1.0 / 60;

/// Two bodies one over the other, jointed; the lower one touches a floor in one point.
struct Slider {
    enum class Floor { world, world_first, body };

    Slider(const dContact& contact, Floor on, bool name) : how(contact), named(name), floor(on) {
        dWorldSetGravity(id, 0, 0, -10);
        dWorldSetCFM(id, 1e-9);
        lower = body(2, V3(0, 0, 0.1));
        upper = body(3, V3(0, 0, 0.3));
        ground = body(1e4, V3(0, 0, -1));
        if (floor == Floor::body) {
            dBodySetGravityMode(ground, 0);
        } else {
            world->remove(ground);
            dBodyDestroy(ground);
            ground = nullptr;
        }
        const Six joint(Ellipsoid<double, 6>({.capacity = Vector6<double>::Constant(1e6)}),
                        Perfect<double>({.strength = 1}));
        root = std::make_unique<ode::PlasticJoint<Six>>(
            id, upper, lower, ode::PlasticJoint<Six>::Frame{.origin = {0, 0, 0.2}}, joint);
        world->add(*root);
    }
    ~Slider() {
        root.reset();
        world.reset();
        dJointGroupDestroy(contacts);
        dWorldDestroy(id);
        dCloseODE();
    }
    Slider(const Slider&) = delete;
    Slider& operator=(const Slider&) = delete;

    dBodyID body(double mass, const V3& at) {
        dBodyID made = dBodyCreate(id);
        dMass inertia;
        // slow to tip: ODE has friction of the normal force that there would be without it
        dMassSetBoxTotal(&inertia, mass, 10, 10, 10);
        dBodySetMass(made, &inertia);
        dBodySetPosition(made, at.x(), at.y(), at.z());
        dBodySetFiniteRotationMode(made, 1);
        world->add(made);
        return made;
    }
    void step() {
        const V3 at = ode::to_core(dBodyGetPosition(lower));
        const double top = ground != nullptr ? dBodyGetPosition(ground)[2] + 1 : 0;
        const double depth = top + 0.1 - at.z();
        feedback = {};
        if (depth >= 0) {
            dContact contact = how;
            contact.geom.depth = depth;
            const bool first = floor != Floor::world_first;
            for (int i = 0; i < 3; ++i) {
                contact.geom.pos[i] = i < 2 ? at[i] : top;
                contact.geom.normal[i] = i < 2 ? 0 : first ? 1 : -1;
            }
            const dJointID joint = dJointCreateContact(id, contacts, &contact);
            dJointAttach(joint, first ? lower : nullptr, first ? ground : lower);
            dJointSetFeedback(joint, &feedback);
            if (named) world->add_contact(joint, contact);
        }
        world->step(dt);
        for (int i = 0; i < dBodyGetNumJoints(lower); ++i) {
            all_enabled = all_enabled && dJointIsEnabled(dBodyGetJoint(lower, i)) != 0;
        }
        dJointGroupEmpty(contacts);
    }

    int library = dInitODE2(0);
    dWorldID id = dWorldCreate();
    dJointGroupID contacts = dJointGroupCreate(0);
    std::unique_ptr<ode::World> world = std::make_unique<ode::World>(id, ode::WorldParameters{});
    dBodyID lower = nullptr, upper = nullptr, ground = nullptr;
    std::unique_ptr<ode::PlasticJoint<Six>> root;
    dContact how;
    bool named;
    Floor floor;
    dJointFeedback feedback{};
    bool all_enabled = true; ///< joints, after every step
};

/// A kilogramme on a ball joint of ODE's under beam 20; by a motor without a row beside it the
/// island is `left_to_ode`.
void hang_a_lamp(Frame& frame, bool left_to_ode) {
    const V3 below = frame.structure->place("beam 20") - V3(0, 0, 1);
    dBodyID lamp = frame.rig.box(1, {0.1, 0.1, 0.1}, below);
    const dJointID ball = dJointCreateBall(frame.rig.id(), nullptr);
    dJointAttach(ball, lamp, frame.structure->body("beam 20"));
    dJointSetBallAnchor(ball, below.x(), below.y(), below.z() + 1);
    if (left_to_ode) {
        dJointAttach(dJointCreateLMotor(frame.rig.id(), nullptr), lamp,
                     frame.structure->body("beam 20"));
    }
}

bool awake(Frame& frame) {
    bool all = true;
    frame.rig.each([&](dBodyID body) { all = all && dBodyIsEnabled(body) != 0; });
    return all;
}

double difference_of(const dReal* a, const dReal* b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

} // namespace

TEST_CASE("A contact that is named acts as ODE's own", "[ode][islands]") {
    dContact how{};
    how.surface.mode = dContactApprox1;
    how.surface.mu = 0.3;
    V3 velocity(1, 0, 0);
    SECTION("friction in proportion") {}
    SECTION("no friction") { how.surface.mu = 0; }
    SECTION("friction without bound") {
        how.surface.mu = dInfinity;
        velocity = V3(0.3, 0.2, 0);
    }
    SECTION("friction as a force") {
        how.surface.mode = 0;
        how.surface.mu = 4;
        velocity = V3(1, 0.5, 0);
    }
    SECTION("another coefficient across a given direction") {
        how.surface.mode |= dContactFDir1 | dContactMu2;
        how.surface.mu = 0.9;
        how.surface.mu2 = 0.2;
        how.fdir1[1] = 1;
    }
    SECTION("bounce") {
        how.surface.mode |= dContactBounce;
        how.surface.bounce = 0.5;
        how.surface.bounce_vel = 0.1;
        velocity = V3(0.2, 0, -3);
    }
    SECTION("soft") {
        how.surface.mode |= dContactSoftERP | dContactSoftCFM;
        how.surface.soft_erp = 0.4;
        how.surface.soft_cfm = 1e-3;
    }
    SECTION("conveyor") {
        how.surface.mode |= dContactFDir1 | dContactMotion1;
        how.surface.motion1 = -2;
        how.fdir1[0] = 1;
    }
    SECTION("slip") {
        how.surface.mode |= dContactFDir1 | dContactSlip1 | dContactSlip2;
        how.surface.mu = 10;
        how.surface.slip1 = how.surface.slip2 = 0.02;
        how.fdir1[0] = 1;
    }
    using Floor = Slider::Floor;
    for (const Floor floor : {Floor::world, Floor::world_first, Floor::body}) {
        Slider ours(how, floor, true), odes(how, floor, false);
        for (Slider* slider : {&ours, &odes}) {
            for (dBodyID body : {slider->lower, slider->upper}) {
                dBodySetLinearVel(body, velocity.x(), velocity.y(), velocity.z());
            }
        }
        for (int i = 0; i < 40; ++i) {
            ours.step();
            odes.step();
            INFO("floor " << int(floor) << ", step " << i);
            REQUIRE(difference_of(ours.feedback.f1, odes.feedback.f1) < 0.02); // of 50 N
            REQUIRE(difference_of(ours.feedback.t1, odes.feedback.t1) < 0.02);
            REQUIRE(difference_of(ours.feedback.f2, odes.feedback.f2) < 0.02);
            REQUIRE(difference_of(dBodyGetLinearVel(ours.upper), dBodyGetLinearVel(odes.upper)) <
                    1e-4);
            REQUIRE(difference_of(dBodyGetAngularVel(ours.upper), dBodyGetAngularVel(odes.upper)) <
                    1e-4);
        }
        CHECK(difference_of(dBodyGetPosition(ours.lower), dBodyGetPosition(odes.lower)) < 1e-5);
        CHECK(std::abs(ours.world->ledger().unexplained()) < 1e-9);
        CHECK(ours.all_enabled);
    }
}

TEST_CASE("Friction in an island is a cone, whichever way it slides", "[ode][islands]") {
    dContact how{};
    how.surface.mode = dContactApprox1;
    how.surface.mu = 0.3;
    for (const double angle : {0.0, 0.4, 0.8, 2.0}) {
        Slider slider(how, Slider::Floor::world, true);
        for (dBodyID body : {slider.lower, slider.upper}) {
            dBodySetLinearVel(body, 2 * std::cos(angle), 2 * std::sin(angle), 0);
        }
        slider.step();
        const dReal* force = slider.feedback.f1;
        CHECK(std::hypot(force[0], force[1]) == Approx(0.3 * force[2]).epsilon(1e-6));
        CHECK(std::atan2(-force[1], -force[0]) == Approx(angle).margin(0.05));
    }
}

TEST_CASE("A pair that tumbles is solved to round-off", "[ode][islands]") {
    Slider slider({}, Slider::Floor::world, false);
    dWorldSetGravity(slider.id, 0, 0, 0);
    for (dBodyID body : {slider.lower, slider.upper}) {
        dMass uneven;
        dMassSetBoxTotal(&uneven, 2, 0.1, 0.4, 1);
        dBodySetMass(body, &uneven);
        dBodySetAngularVel(body, 3, 5, 2);
        dBodySetPosition(body, 0, 0, dBodyGetPosition(body)[2] + 5);
        dBodyAddTorque(body, 2, 0, 1);
    }
    dBodySetLinearVel(slider.upper, 1, -0.6, 0); // as one
    dBodyAddForce(slider.upper, 5, 4, 0);
    for (int i = 0; i < 20; ++i) {
        slider.step();
        REQUIRE(slider.root->residual() < 1e-9);
    }
}

TEST_CASE("A frame with a joint of ODE's own stands, known or left to ODE", "[ode][islands]") {
    FrameSettings settings;
    settings.elastic = false;
    const bool left_to_ode = GENERATE(false, true);
    if (!left_to_ode) settings.world.solver = ode::Solver::quick; // which would fail it
    Frame frame(settings);
    hang_a_lamp(frame, left_to_ode);
    frame.rig.run(0.5, dt);
    frame.structure->remove("column 00");
    frame.rig.run(2, dt);
    CHECK(frame.structure->absorbed_energy() == 0);
    for (const auto& l : frame.rig.lines()) WARN(l);
    CHECK(frame.rig.lines().empty());
    CHECK(frame.structure->utilisation() == Approx(0.505759).epsilon(0.005));
    CHECK(frame.sway() < 1e-6);
}

TEST_CASE("Where all is known a frame stands under QuickStep, with the same bits",
          "[ode][islands]") {
    FrameSettings settings;
    settings.crates = 1;
    Frame direct(settings);
    settings.world.solver = ode::Solver::quick;
    Frame quick(settings);
    for (Frame* frame : {&direct, &quick}) frame->rig.run(2, dt);
    CHECK(quick.structure->absorbed_energy() == 0);
    CHECK(quick.rig.lines().empty());
    CHECK(quick.structure->utilisation() == direct.structure->utilisation());
    CHECK(quick.structure->sag("beam 20") == direct.structure->sag("beam 20"));
}

TEST_CASE("An island falls asleep as a whole, and nothing is lost on the way", "[ode][islands]") {
    FrameSettings settings;
    SECTION("swinging") {}
    SECTION("with what lies on it") {
        settings.elastic = false;
        settings.crates = 1;
    }
    Frame frame(settings);
    frame.rig.damp(0.5);
    frame.rig.let_sleep();
    frame.rig.run(2, dt); // springs have to be still for a second
    REQUIRE(frame.rig.asleep());
    frame.structure->remove("column 00");
    int steps = 0;
    while (!frame.rig.asleep() && ++steps < 3000) {
        frame.rig.step(dt);
        REQUIRE((frame.rig.asleep() || awake(frame)));
    }
    CHECK(frame.rig.asleep());
    CHECK(steps > (settings.elastic ? 60 : 5));
    CHECK(frame.rig.lines().empty());
    CHECK(std::abs(frame.rig.world().ledger().unexplained()) < 1e-6);
    dBodyEnable(frame.structure->body("beam 23"));
    frame.rig.step(dt);
    CHECK(awake(frame));
    frame.rig.keep_awake();
    dBodyDisable(frame.structure->body("beam 23"));
    frame.rig.step(dt);
    CHECK(awake(frame));
    CHECK(frame.rig.lines().empty());
}

TEST_CASE("The frame without a column swings until it rests, then sleeps", "[ode][islands]") {
    Frame frame(FrameSettings{});
    frame.rig.run(1, dt);
    frame.rig.let_sleep();
    frame.structure->remove("column 00");
    double slept = 0;
    for (; !frame.rig.asleep() && slept < 15; slept += 0.25) frame.rig.run(0.25, dt);
    CHECK(slept > 1.5);
    CHECK(slept < 15);
    CHECK(frame.structure->absorbed_energy() == 0);
    CHECK(frame.structure->utilisation() == Approx(0.508898).epsilon(0.005));
    CHECK(frame.rig.lines().empty());
}

TEST_CASE("QuickStep fails the frame where it is left to it, and says so", "[ode][islands]") {
    FrameSettings settings;
    settings.world.solver = ode::Solver::quick;
    Frame frame(settings);
    hang_a_lamp(frame, true);
    frame.rig.run(1, dt);
    const auto& lines = frame.rig.lines();
    REQUIRE_FALSE(lines.empty());
    CHECK(lines[0].find("was left unsolved") != std::string::npos);
    CHECK(lines[0].find(", and 3") != std::string::npos); // others, of 36
    CHECK(lines.size() <= 4);
}

TEST_CASE("Figures of the frame, for adapters/ode/README.md", "[.][figures]") {
    std::printf(
        "| island | elastic: ms, J, utilisation, unreliable or coarse | rigid |\n|---|---|---|\n");
    enum class Lamp { none, known, left_to_ode };
    const auto row = [](const char* name, ode::Solver solver, Lamp lamp, bool removed) {
        std::printf("| %s%s |", name, removed ? ", column removed" : "");
        for (const bool elastic : {true, false}) {
            FrameSettings settings;
            settings.elastic = elastic;
            settings.world.solver = solver;
            Frame frame(settings);
            if (lamp != Lamp::none) hang_a_lamp(frame, lamp == Lamp::left_to_ode);
            frame.rig.damp(2);
            if (removed) {
                frame.rig.run(0.5, dt);
                frame.structure->remove("column 00");
            }
            std::vector<double> milliseconds;
            for (int i = 0; i < 600; ++i) {
                const auto start = std::chrono::steady_clock::now();
                frame.rig.step(dt);
                const std::chrono::duration<double, std::milli> took =
                    std::chrono::steady_clock::now() - start;
                milliseconds.push_back(took.count());
            }
            std::nth_element(milliseconds.begin(), milliseconds.begin() + 300, milliseconds.end());
            std::printf(" %.2f, %.3g, %.4f, %zu |", milliseconds[300],
                        frame.structure->absorbed_energy(), frame.structure->utilisation(),
                        frame.rig.lines().size());
        }
        std::printf("\n");
    };
    for (const bool removed : {false, true}) {
        for (const bool quick : {false, true}) {
            const auto solver = quick ? ode::Solver::quick : ode::Solver::direct;
            const auto name = [quick](const char* of) {
                return of + std::string(quick ? ", QuickStep" : "");
            };
            row(name("plastic joints").c_str(), solver, Lamp::none, removed);
            row(name("with a ball of ODE's").c_str(), solver, Lamp::known, removed);
            row(name("left to ODE").c_str(), solver, Lamp::left_to_ode, removed);
        }
    }
}

TEST_CASE("a weak row beside a blow's forces is read for what it bore", "[islands]") {
    // read back from forces of 1e16 N on the bodies it was round-off, and its flow unsolved
    constexpr double strength = 1e-6, speed = 10, mass = 1e6, half = 1, blow = 1e-9;
    dInitODE();
    const dWorldID engine = dWorldCreate();
    const dBodyID rod = dBodyCreate(engine);
    dMass inertia;
    dMassSetBoxTotal(&inertia, mass, 0.2, 0.2, 2 * half);
    dBodySetMass(rod, &inertia);
    dBodySetPosition(rod, 0.3, 0.4, half);
    dBodySetLinearVel(rod, speed, speed, speed);
    {
        ode::World world(engine, ode::WorldParameters{.warn = {}});
        using Law = ductile::OneAxisJoint<Perfect<double>>;
        ode::PlasticHinge<Law> hinge(engine, rod, nullptr, {.axis = {0.6, 0.8, 0}},
                                     Law(Perfect<double>({.strength = strength})));
        world.add(rod);
        world.add(hinge);
        world.step(blow);
        CHECK(std::abs(dBodyGetAngularVel(rod)[0]) > 0.05 * speed);
        CHECK(std::abs(hinge.moment()) == Approx(strength).epsilon(1e-9));
        CHECK(hinge.outcome() != ductile::Outcome::unreliable);
    }
    dWorldDestroy(engine);
    dCloseODE();
}
