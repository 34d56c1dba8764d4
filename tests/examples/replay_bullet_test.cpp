// SPDX-License-Identifier: MIT
//
// What a recording says of Bullet's joints: a slider that bears a weight beside its axis has a
// force and a travel, whatever moments its rigid axes bear; a member's joint tells its capacities
// and how much of its life is used; the first curve is of the axis that took most, however rarely
// it is seen, and there is one of a moment too.
#include <btBulletDynamicsCommon.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "ductile/bullet/bullet.hpp"
#include "ductile/material/named.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/section/box.hpp"
#include "joint_facts.hpp"
#include "of_bullet.hpp"
#include "recorder.hpp"

using namespace ductile;

namespace {

/// One body of 10 kg, with gravity along -z from the first sample on.
struct Scene {
    Scene() {
        engine.setGravity({0, 0, 0});
        body.setActivationState(DISABLE_DEACTIVATION);
        engine.addRigidBody(&body);
    }
    ~Scene() { engine.removeRigidBody(&body); }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    template <class Joint>
    replay::Recording hold(Joint& joint, double rate = 60) {
        world.add(joint, "joint");
        replay::Recorder recorder({.name = "held", .about = "", .engine = "bullet", .rate = rate});
        replay::add_body(recorder, body, "body");
        replay::add_joint(recorder, joint, "joint", {}, replay::life_used(joint));
        for (int i = 0; i < 30; ++i) {
            world.step(1.0 / 60);
            recorder.look(world);
            engine.setGravity({0, 0, -9.81});
        }
        world.remove(joint);
        return recorder.finish();
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld engine{&dispatcher, &broadphase, &solver, &configuration};
    btBoxShape shape{{0.1, 0.1, 0.1}};
    btRigidBody body{{10, nullptr, &shape, {0.1, 0.1, 0.1}}};
    bullet::World world{engine};
};

} // namespace

TEST_CASE("replay: a slider of Bullet has a force in N over a travel in m", "[replay]") {
    Scene scene;
    const btTransform beside(btQuaternion::getIdentity(), {5, 0, 0}); // 490 N m of the weight
    bullet::PlasticSlider<UsualAxisJoint> bar(
        scene.body, beside,
        UsualAxisJoint(Perfect<double>({.strength = 1e4}), TravelLimit<double>({.limit = 0.5})));
    const replay::Recording seen = scene.hold(bar);
    const replay::Curve& curve = seen.samples[0].curves.at(0);
    CHECK(curve.axis == "axial");
    CHECK_FALSE(curve.turns);
    CHECK(std::abs(curve.force.back()) == Approx(98.1).epsilon(1e-6));
    CHECK(seen.samples[0].life.back() == 0);
}

TEST_CASE("replay: a member's joint tells its capacities and the life it has used", "[replay]") {
    Scene scene;
    const Box<double> box(
        {.width = 0.01, .height = 0.01, .web_thickness = 0.001, .flange_thickness = 0.001});
    const UsualSixAxisJoint made =
        section_joint(box, Material<double>(s355<double>()),
                      {.length = 0.1, .largest_bending = 2, .largest_twist = 1});
    const auto facts = replay::facts_of(made, {{"section", "box"}});
    REQUIRE(facts.size() == 1 + 6 + 3);
    CHECK(facts[0] == replay::Fact{"section", "box"});
    // 36 mm² × 355 MPa; (10³ - 8³)/4 mm³ × 355 MPa
    CHECK(facts[3] == replay::Fact{"capacity, axial", "12.78 kN"});
    CHECK(facts[4] == replay::Fact{"capacity, bending_x", "43.31 N m"});
    CHECK(facts[5] == replay::Fact{"breaks by it alone at", "2 rad"});
    CHECK(facts[9] == replay::Fact{"breaks by it alone at", "1 rad"});

    // 98.1 N on an arm of 1 m bend it
    const btTransform beside(btQuaternion::getIdentity(), {1, 0, 0});
    bullet::PlasticJoint<UsualSixAxisJoint> foot(scene.body, beside, made);
    const replay::Recording seen = scene.hold(foot);
    const replay::JointSamples& samples = seen.samples[0];
    const auto bent = [&](std::size_t i) { return std::abs(samples.curves.at(0).position[i]); };
    REQUIRE(bent(29) > 0.1);
    for (const std::size_t i : {std::size_t(10), std::size_t(20)}) {
        CHECK(samples.life[i] == Approx(std::min(1.0, bent(i) / 2)).epsilon(0.02));
    }
}

TEST_CASE("replay: the axis shown took most, where it flowed and broke between two samples too",
          "[replay]") {
    Scene scene;
    Vector6<double> capacity;
    capacity << 1e4, 1e4, 50, 1e3, 1e3, 1e3; // half of the weight, along its axis
    const btTransform beside(btQuaternion::getIdentity(), {0.01, 0, 0});
    bullet::PlasticJoint<UsualSixAxisJoint> bar(
        scene.body, beside,
        UsualSixAxisJoint(Ellipsoid<double, 6>({.capacity = capacity}),
                          Perfect<double>({.strength = 50}), TravelLimit<double>({.limit = 0.05})));
    const replay::Recording seen = scene.hold(bar, 4);
    REQUIRE(seen.times.size() == 3);
    REQUIRE((seen.samples[0].state.back() & replay::broken) != 0);
    REQUIRE(seen.samples[0].curves.size() == 2);
    CHECK(seen.samples[0].curves[0].axis == "axial");
    CHECK(seen.samples[0].curves[1].axis == "bending_y"); // of the arm
}
