// SPDX-License-Identifier: MIT
//
// Plastic joints in the life of a Bullet world: sleep, switches, teleports, bodies that come and
// go, save and restore, serialisation, drawing; ticks that are committed late.
#include <LinearMath/btSerializer.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "adapters/bullet_world.hpp"
#include "ductile/bullet/energy_meter.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

using V3 = Vector3<double>;
using One = OneAxisJoint<Perfect<double>>;
using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr bool single = BulletWorld::single;
constexpr double exact = single ? 2e-4 : 1e-9;
const btTransform here = btTransform::getIdentity();

One one(double strength, double limit = infinity) {
    return One(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}));
}

Six six(const Vector6<double>& capacity) {
    return Six(Ellipsoid<double, 6>({.capacity = capacity}), Perfect<double>({.strength = 1}));
}

Vector6<double> capacities() {
    Vector6<double> c;
    c << 900, 700, 1200, 40, 60, 30;
    return c;
}

/// I = 2 kg m², turning at 10 rad/s: 40 N m stop it after 2.5 rad and 100 J.
btRigidBody& rotor(BulletWorld& world, double spin = 10) {
    btRigidBody& body = world.body(1, 2);
    body.setAngularVelocity({0, 0, btScalar(spin)});
    return body;
}

void close(double value, double expected) {
    CHECK(value == Approx(expected).epsilon(exact).margin(exact));
}

/// Counts what is drawn, and remembers the colour of the ball.
class Drawer final : public btIDebugDraw {
  public:
    void drawLine(const btVector3&, const btVector3&, const btVector3&) override { ++lines; }
    void drawSphere(const btVector3&, btScalar, const btVector3& colour) override { ball = colour; }
    void drawArc(const btVector3&, const btVector3&, const btVector3&, btScalar, btScalar,
                 btScalar from, btScalar to, const btVector3&, bool, btScalar) override {
        ++arcs;
        arc = double(to - from);
    }
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                          const btVector3&) override {}
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    [[nodiscard]] int getDebugMode() const override { return DBG_DrawWireframe; }

    int lines = 0, arcs = 0;
    double arc = 0;
    btVector3 ball{-1, -1, -1};
};

} // namespace

TEST_CASE("ticks committed late are booked as those committed at their end", "[bullet][life]") {
    // the body is damped at the start of a tick, before Bullet opens the joint's
    const double limit = GENERATE(1e9, 1.3);
    const auto run = [limit](bool late) {
        BulletWorld world("world");
        btRigidBody& body = rotor(world);
        body.setDamping(0, btScalar(0.3));
        bullet::PlasticHinge hinge(body, here, one(40, limit));
        if (late) {
            world.world().addConstraint(&hinge);
        } else {
            hinge.add_to(world.world());
        }
        world.step(1e-3, 700);
        const std::vector result{hinge.absorbed_energy(), hinge.plastic_rotation(),
                                 hinge.rotation(), double(body.getAngularVelocity().z()),
                                 hinge.broken() ? 1.0 : 0.0};
        if (late) {
            world.world().removeConstraint(&hinge);
        } else {
            hinge.remove_from(world.world());
        }
        return result;
    };
    const auto late = run(true), prompt = run(false);
    INFO("limit " << limit);
    close(late[0], prompt[0]);
    close(late[1], prompt[1]);
    CHECK(late[2] == Approx(prompt[2]).epsilon(single ? 1e-4 : 1e-9));
    // a break found by the solver gives its energy back a tick, and so a tick's damping, later
    CHECK(late[3] == Approx(prompt[3]).epsilon(1e-3).margin(exact));
    CHECK(late[4] == prompt[4]);
    CHECK(late[4] == (limit < 2 ? 1.0 : 0.0));
}

TEST_CASE("a break found by the solver gives its energy back all the same", "[bullet][life]") {
    // no action and nobody asks: 2 bodies, 6 rad/s relative afterwards, 7.6 and 1.6 rad/s
    const auto solver = GENERATE(from_range(BulletWorld::solvers()));
    const double rate = GENERATE(15.0, 240.0);
    INFO(solver << ", dt = 1/" << rate);
    BulletWorld world(solver);
    btRigidBody& a = rotor(world);
    btRigidBody& b = world.body(1, 3);
    bullet::PlasticHinge hinge(a, b, here, here, one(12, 3.2));
    world.world().addConstraint(&hinge);
    for (int i = 0; i < int(rate); ++i) world.step(1 / rate);
    close(double(a.getAngularVelocity().z()), 7.6);
    close(double(b.getAngularVelocity().z()), 1.6);
    CHECK(hinge.broken());
    close(hinge.absorbed_energy(), 38.4);
    CHECK(!hinge.isEnabled());
    world.world().removeConstraint(&hinge);
}

TEST_CASE("a kick between two ticks is not taken for the last tick's answer", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = rotor(world, 0);
    bullet::PlasticHinge hinge(body, here, one(40));
    world.world().addConstraint(&hinge); // committed late
    world.step(1e-3);
    body.setAngularVelocity({0, 0, 10});
    CHECK(hinge.outcome() == Outcome::elastic);
    CHECK(hinge.residual() < 1e-6);
    world.step(1e-3, 600);
    close(hinge.absorbed_energy(), 100);
    world.world().removeConstraint(&hinge);
}

TEST_CASE("a sleeping joint books nothing and wakes as it slept", "[bullet][life]") {
    BulletWorld world("world", {0, -9.81, 0});
    btRigidBody& body = world.body(6, 1);
    body.forceActivationState(ACTIVE_TAG);
    body.setSleepingThresholds(1, 1);
    bullet::PlasticSlider bar(
        body,
        BulletWorld::frame(
            V3::Zero(),
            Eigen::AngleAxis<double>(-std::numbers::pi / 2, V3::UnitX()).toRotationMatrix()),
        one(100));
    bar.add_to(world.world());
    for (int i = 0; i < 400 && body.isActive(); ++i) world.step(1.0 / 60);
    REQUIRE(!body.isActive());
    const auto asleep = bar.state();
    const double force = bar.force();
    CHECK(force == Approx(6 * 9.81).epsilon(1e-4));
    world.step(1.0 / 60, 50);
    CHECK(bar.state() == asleep);
    CHECK(bar.force() == force);
    body.activate(true);
    body.applyCentralImpulse({0, -30, 0}); // 5 m/s against (100 - 58.86)/6 m/s²
    world.step(1.0 / 240, 240);
    CHECK(bar.plastic_elongation() == Approx(12.5 / ((100 - 58.86) / 6)).epsilon(1e-2));
    bar.remove_from(world.world());
}

TEST_CASE("a joint switched off does nothing and switched on again goes on", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = rotor(world);
    bullet::PlasticHinge hinge(body, here, one(40));
    hinge.add_to(world.world());
    world.step(1e-3, 100); // 20 rad/s²: 8 rad/s left
    close(double(body.getAngularVelocity().z()), 8);
    const auto state = hinge.state();
    hinge.setEnabled(false);
    world.step(1e-3, 500);
    close(double(body.getAngularVelocity().z()), 8);
    CHECK(hinge.state() == state);
    hinge.setEnabled(true);
    world.step(1e-3, 600);
    // it turned by 4 rad meanwhile: the drift towards the rest position is a matter of the row, but
    // what it absorbs stays the energy that was there
    CHECK(hinge.outcome() != Outcome::broken);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(1e-2));
    hinge.remove_from(world.world());
}

TEST_CASE("a body made kinematic drives its joint and takes no harm", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& base = world.body(1, 2);
    btRigidBody& body = world.body(1, 2, {1, 0, 0});
    bullet::PlasticHinge hinge(body, base, BulletWorld::frame({-1, 0, 0}), here, one(40));
    hinge.add_to(world.world());
    world.step(1e-3, 10);
    base.setCollisionFlags(base.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    base.setMassProps(0, {0, 0, 0});
    body.setAngularVelocity({0, 0, 10});
    body.setLinearVelocity({0, 10, 0});
    world.step(2e-4, 10000);
    CHECK(bullet::to_core(base.getCenterOfMassPosition()).norm() < 1e-6);
    // I about the hinge: 2 + 1 × 1² = 3 kg m²
    // less what the pin takes from an arm that turns by a chord a step, first order
    CHECK(hinge.absorbed_energy() == Approx(150).epsilon(1e-3));
    CHECK(double(body.getAngularVelocity().length()) < 1e-3);
    hinge.remove_from(world.world());
}

TEST_CASE("a joint to a base that moves along holds still", "[bullet][life]") {
    const auto solver = GENERATE(from_range(BulletWorld::solvers()));
    const int kind = GENERATE(0, 1, 2, 3, 4);
    const int ticks = GENERATE(1, 4);
    const bool by_motion_state = GENERATE(false, true);
    INFO(solver << ", kind " << kind << ", " << ticks << " ticks");
    BulletWorld world(solver);
    btRigidBody& base = world.body(0, 0.0);
    base.setCollisionFlags(base.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    btDefaultMotionState place;
    if (by_motion_state) base.setMotionState(&place);
    btRigidBody& body = world.body(1, 2);
    // float gives a turning kinematic body another velocity than it has
    const btVector3 velocity(btScalar(0.3), btScalar(-0.2), btScalar(0.5));
    const btVector3 spin(0, 0, btScalar(single ? 0 : 0.5));
    body.setLinearVelocity(velocity);
    body.setAngularVelocity(spin);

    bullet::PlasticHinge hinge(body, base, here, here, one(40));
    bullet::PlasticSlider slider(body, base, here, here, one(40));
    bullet::PlasticJoint joint(body, base, here, here, six(capacities()));
    btHingeConstraint own(body, base, here, here);
    bullet::PlasticMotor motor(own, one(40));
    if (kind == 0) hinge.add_to(world.world());
    if (kind == 1) slider.add_to(world.world());
    if (kind == 2) joint.add_to(world.world());
    if (kind == 3) world.world().addConstraint(&own);
    if (kind == 3) motor.add_to(world.world());
    if (kind == 4 && ticks == 1) world.world().addConstraint(&hinge); // no booking at a tick's end
    const PairQueries* const all[] = {&hinge, &slider, &joint, &motor, &hinge};
    const PairQueries& asked = *all[kind];

    const double dt = 1.0 / 60;
    for (int i = 1; i <= 120; ++i) {
        const btTransform next(btQuaternion(btVector3(0, 0, 1), btScalar(i * dt) * spin.z()),
                               btScalar(i * dt) * velocity);
        if (by_motion_state) {
            place.setWorldTransform(next);
        } else {
            base.setWorldTransform(next);
        }
        world.world().stepSimulation(btScalar(dt), ticks == 1 ? 0 : 2 * ticks,
                                     btScalar(dt / ticks));
    }
    const double still = single ? 2e-4 : 1e-9;
    CHECK(asked.absorbed_energy() < still);
    CHECK(asked.plastic_travel() < still);
    CHECK(std::abs(hinge.rotation()) < still);
    CHECK(std::abs(slider.elongation()) < still);
    CHECK(std::abs(joint.position(JointAxis::shear_x)) < still);
    CHECK(std::abs(motor.rotation()) < still);
    const bool holds = kind != 4 || ticks == 1;
    if (holds)
        CHECK((body.getCenterOfMassPosition() - base.getCenterOfMassPosition()).length() <
              (kind == 3 ? 0.02
               : single  ? 1e-3
                         : 1e-6)); // Bullet's hinge runs ahead
    world.world().removeConstraint(&own);
}

TEST_CASE("a body turned by hand is turned, without work", "[bullet][life]") {
    const double stiffness = GENERATE(as<double>{}, infinity, 2000.0);
    const int kind = GENERATE(0, 1, 2);
    const bool switched_off = GENERATE(false, true);
    INFO("k = " << stiffness << ", kind " << kind << (switched_off ? ", switched off" : ""));
    BulletWorld world;
    btRigidBody& body = world.body(1, 2);
    const One law(Perfect<double>({.strength = 64}), TravelLimit<double>(),
                  {.stiffness = stiffness});
    Vector6<double> each = Vector6<double>::Constant(stiffness);
    bullet::PlasticHinge hinge(body, here, law);
    bullet::PlasticJoint joint(
        body, here,
        Six(Ellipsoid<double, 6>({.capacity = capacities()}), Perfect<double>({.strength = 1}),
            TravelLimit<double>(), {.stiffness = each}));
    btHingeConstraint own(body, {0, 0, 0}, {0, 0, 1});
    bullet::PlasticMotor motor(own, law);
    bullet::PlasticConstraint* const all[] = {&hinge, &joint, &motor};
    bullet::PlasticConstraint& turned = *all[kind];
    if (kind == 2) world.world().addConstraint(&own);
    turned.add_to(world.world());
    body.applyTorque({0, 0, 5});
    world.step(1e-2);
    body.setAngularVelocity({0, 0, 0});
    const double stored = turned.queries().stored_energy();
    const auto set = [&](double angle) {
        body.setWorldTransform(btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(angle))));
    };
    const auto angle = [&] {
        return kind == 0   ? hinge.rotation()
               : kind == 1 ? joint.position(JointAxis::torsion)
                           : motor.rotation();
    };
    const double before = angle();
    if (switched_off) {
        turned.setEnabled(false);
        world.step(1e-2, 3);
    }
    set(before + 0.3);
    turned.setEnabled(true);
    double fastest = 0, held = 0;
    for (int i = 0; i < 200; ++i) {
        world.step(1e-2);
        fastest = std::max(fastest, double(body.getAngularVelocity().length()));
        held = std::max(held, turned.queries().stored_energy());
    }
    CHECK(turned.queries().absorbed_energy() < exact);
    // what the spring held it gives, and no more but what its rule makes of it, k dt²/4m
    constexpr double symplectic = 1 + 2000 * 1e-4 / (4 * 2);
    CHECK(fastest <= symplectic * std::sqrt(2 * stored / 2) + (single ? 1e-4 : 1e-9));
    CHECK(held <= symplectic * stored * (1 + 1e-2) + exact);
    CHECK(angle() == Approx(before + 0.3).margin(stored > 0 ? 0.01 : single ? 1e-5 : 1e-9));
    turned.remove_from(world.world());
    world.world().removeConstraint(&own);
}

TEST_CASE("bodies moved by hand with their joint stay as bent as they were", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& a = world.body(1, 2, {0.5, 0, 0});
    btRigidBody& b = world.body(1, 2, {-0.5, 0, 0});
    a.setAngularVelocity({0, 0, 5});
    a.setLinearVelocity({0, btScalar(2.5), 0});
    bullet::PlasticHinge hinge(a, b, BulletWorld::frame({-0.5, 0, 0}),
                               BulletWorld::frame({0.5, 0, 0}), one(10));
    hinge.add_to(world.world());
    world.step(1e-3, 2000);
    const auto before = hinge.state();
    const double rotation = hinge.rotation();
    const btTransform move(btQuaternion(btVector3(1, 2, 3).normalized(), 2), btVector3(7, -8, 9));
    for (btRigidBody* body : {&a, &b}) {
        body->setWorldTransform(move * body->getWorldTransform());
        body->setLinearVelocity({0, 0, 0});
        body->setAngularVelocity({0, 0, 0});
    }
    world.step(1e-3, 500);
    CHECK(hinge.absorbed_energy() ==
          Approx(before.joint.plastic_work).epsilon(single ? 1e-4 : 1e-9));
    CHECK(hinge.rotation() == Approx(rotation).epsilon(single ? 1e-3 : 1e-6));
    CHECK(hinge.outcome() == Outcome::elastic);
    hinge.remove_from(world.world());
}

TEST_CASE("a joint leaves a world with its body and comes back to it", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = rotor(world);
    bullet::PlasticHinge hinge(body, here, one(40));
    hinge.add_to(world.world());
    world.step(1e-3, 100);
    const auto state = hinge.state();
    hinge.remove_from(world.world());
    world.world().removeRigidBody(&body);
    world.step(1e-3, 100);
    CHECK(hinge.state() == state);
    world.world().addRigidBody(&body, 0, 0);
    hinge.add_to(world.world());
    world.step(1e-3, 600);
    close(hinge.absorbed_energy(), 100);
    close(hinge.plastic_rotation(), 2.5);
    hinge.remove_from(world.world());
}

TEST_CASE("a joint that was taken away is asked nothing, also where its body has ended",
          "[bullet][life]") {
    // an address sanitizer sees a world that still asks
    BulletWorld world;
    bullet::PlasticHinge stays(rotor(world), here, one(40));
    stays.add_to(world.world());
    btEmptyShape nothing;
    auto body = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &nothing, {2, 2, 2}));
    body->setAngularVelocity({0, 0, 10});
    world.world().addRigidBody(body.get(), 0, 0);
    bullet::PlasticHinge goes(*body, here, one(40));
    goes.add_to(world.world());
    world.step(1.0 / 60);
    goes.remove_from(world.world());
    const double absorbed = goes.absorbed_energy();
    close(absorbed, 40 * (10 + 10 - 40.0 / 2 / 60) / 2 / 60);
    world.world().removeRigidBody(body.get());
    body.reset();
    world.step(1.0 / 60, 2);
    CHECK(goes.absorbed_energy() == absorbed);
    stays.remove_from(world.world());
}

TEST_CASE("a world put back to its start runs the same again, bit for bit", "[bullet][life]") {
    const auto solver = GENERATE(from_range(BulletWorld::solvers()));
    INFO(solver);
    BulletWorld world(solver);
    btRigidBody& body = world.body(2, 0.3, {0, 0, 0.2});
    bullet::PlasticJoint joint(body, BulletWorld::frame({0, 0, -0.2}), six(capacities()));
    joint.add_to(world.world());
    struct Snapshot {
        btTransform at;
        btVector3 velocity, spin;
        bullet::PlasticJoint<Six>::State joint;
    };
    const auto save = [&] {
        return Snapshot{body.getWorldTransform(), body.getLinearVelocity(),
                        body.getAngularVelocity(), joint.state()};
    };
    const auto put_back = [&](const Snapshot& s) {
        body.setCenterOfMassTransform(s.at);
        body.setLinearVelocity(s.velocity);
        body.setAngularVelocity(s.spin);
        joint.restore(s.joint);
    };
    body.setAngularVelocity({20, 15, 5});
    const Snapshot start = save();
    world.step(1e-3, 20);
    const Snapshot middle = save();
    world.step(1e-3, 20);
    const Snapshot end = save();
    CHECK(end.joint.joint.plastic_work > middle.joint.joint.plastic_work);
    for (const Snapshot* from : {&start, &middle}) {
        put_back(*from);
        CHECK(joint.state() == from->joint);
        world.step(1e-3, from == &start ? 40 : 20);
        CHECK(save().joint == end.joint);
        CHECK(body.getAngularVelocity() == end.spin);
        CHECK(body.getWorldTransform() == end.at);
    }
    joint.remove_from(world.world());
}

TEST_CASE("a joint restored from before its break holds again", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = rotor(world);
    bullet::PlasticHinge hinge(body, here, one(40, 1.6));
    hinge.add_to(world.world());
    const auto whole = hinge.state();
    world.step(1e-3, 400);
    REQUIRE(hinge.broken());
    const auto broken = hinge.state();
    CHECK(!hinge.isEnabled());
    body.setCenterOfMassTransform(here);
    body.setAngularVelocity({0, 0, 10});
    hinge.restore(whole);
    CHECK(hinge.isEnabled());
    CHECK(!hinge.broken());
    world.step(1e-3, 400);
    CHECK(hinge.broken());
    close(double(body.getAngularVelocity().z()), 6);
    hinge.restore(whole);
    hinge.restore(broken);
    CHECK(!hinge.isEnabled());
    CHECK(hinge.broken());
    hinge.remove_from(world.world());
}

TEST_CASE("the state of a joint is so many bytes", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = world.body(2, 0.3, {0, 0, 0.2});
    bullet::PlasticJoint joint(body, BulletWorld::frame({0, 0, -0.2}), six(capacities()));
    joint.add_to(world.world());
    body.setAngularVelocity({20, 15, 5});
    world.step(1e-3, 20);
    const auto bytes = to_bytes(joint.state());
    using State = bullet::PlasticJoint<Six>::State;
    CHECK(from_bytes<State>(bytes) == joint.state());
    CHECK(message_of([&] { (void)from_bytes<State>(std::span(bytes).first(bytes.size() - 1)); }) ==
          "state: " + std::to_string(bytes.size() - 1) + " bytes, expected " +
              std::to_string(bytes.size()));
    joint.remove_from(world.world());
}

TEST_CASE("the user's joint feedback stays the user's", "[bullet][life]") {
    const std::string solver = GENERATE("world", "si");
    BulletWorld world(solver, {0, -9.81, 0});
    btRigidBody& body = world.body(2, 0.3);
    const double weight = 2 * 9.81;
    btJointFeedback mine{};
    SECTION("set before: it is read") {
        bullet::PlasticJoint joint(body, here, six(capacities()));
        joint.setJointFeedback(&mine);
        joint.add_to(world.world());
        world.step(1.0 / 60, 5);
        CHECK(joint.getJointFeedback() == &mine);
        CHECK(joint.force(JointAxis::shear_y) == Approx(weight).epsilon(1e-5));
        CHECK(double(mine.m_appliedForceBodyA.y()) == Approx(weight).epsilon(1e-5));
        SECTION("and taken away: the joint knows by itself") {
            joint.setJointFeedback(nullptr);
            world.step(1.0 / 60, 2);
            // where Bullet solves the rows the joint needs feedback of its own
            CHECK((joint.getJointFeedback() != nullptr) == (solver == "si"));
            CHECK(joint.force(JointAxis::shear_y) == Approx(weight).epsilon(1e-5));
        }
        joint.remove_from(world.world());
    }
    SECTION("a hinge needs none") {
        bullet::PlasticHinge hinge(body, here, one(40));
        hinge.add_to(world.world());
        world.step(1.0 / 60, 5);
        CHECK(hinge.getJointFeedback() == nullptr);
        hinge.remove_from(world.world());
    }
}

TEST_CASE("parameters: the error reduction of the rigid rows, and no compliance",
          "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = world.body(1, 2);
    bullet::PlasticHinge hinge(body, here, one(40));
    hinge.add_to(world.world());
    body.setCenterOfMassTransform(BulletWorld::frame({btScalar(0.01), 0, 0}));
    CHECK(hinge.getParam(BT_CONSTRAINT_ERP) < 0); // the world's, 0.2
    world.step(0.01);
    CHECK(double(body.getCenterOfMassPosition().x()) == Approx(0.008).epsilon(1e-4));
    hinge.setParam(BT_CONSTRAINT_STOP_ERP, btScalar(0.5));
    CHECK(hinge.getParam(BT_CONSTRAINT_ERP) == btScalar(0.5));
    world.step(0.01);
    CHECK(double(body.getCenterOfMassPosition().x()) == Approx(0.004).epsilon(1e-4));
    CHECK(message_of([&] { hinge.setParam(BT_CONSTRAINT_ERP, btScalar(1.5)); }) ==
          "JointConstraint.erp = 1.5: must be in [0, 1]");
    CHECK(message_of([&] { hinge.setParam(BT_CONSTRAINT_CFM, btScalar(0.5)); }) ==
          "JointConstraint.cfm = 0.5: must be left alone: compliance follows from the joint's "
          "stiffness");
    hinge.remove_from(world.world());
}

TEST_CASE("a motor that turns faster than Bullet can says so", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = rotor(world);
    body.setAngularVelocity({0, 0, 90});
    btHingeConstraint stock(body, {0, 0, 0}, {0, 0, 1}, true);
    bullet::PlasticMotor motor(stock, one(0.1));
    world.world().addConstraint(&stock);
    motor.add_to(world.world());
    world.step(1.0 / 60);
    CHECK(motor.outcome() == Outcome::unreliable);
    CHECK(motor.report().unseen_turn == Approx(1.5).epsilon(1e-3)); // Bullet: 1.34
    body.setAngularVelocity({0, 0, 40});
    world.step(1.0 / 60);
    CHECK(motor.outcome() == Outcome::yielding);
    CHECK(motor.report().unseen_turn == 0);
    motor.remove_from(world.world());
    world.world().removeConstraint(&stock);
}

TEST_CASE("a motor of a body whose numbers are not finite says so and keeps its state",
          "[bullet][life][not_finite]") {
    const double bad = GENERATE(as<double>{}, std::nan(""), infinity);
    const bool turned = GENERATE(true, false);
    INFO(bad << (turned ? ", at a place" : ", moving"));
    BulletWorld world;
    btRigidBody& body = rotor(world);
    btHingeConstraint stock(body, {0, 0, 0}, {0, 0, 1}, true);
    bullet::PlasticMotor motor(stock, one(40));
    world.world().addConstraint(&stock);
    motor.add_to(world.world());
    world.step(1e-3);
    REQUIRE(motor.outcome() == Outcome::yielding);
    const auto state = motor.joint().state();
    const double rotation = motor.rotation();
    const btTransform at = body.getCenterOfMassTransform();
    const btVector3 velocity = body.getLinearVelocity(), spin = body.getAngularVelocity();
    if (turned) {
        body.setCenterOfMassTransform(
            btTransform(btMatrix3x3(btScalar(bad), 0, 0, 0, btScalar(bad), 0, 0, 0, 1)));
    } else {
        body.setAngularVelocity({0, 0, btScalar(bad)});
    }
    world.step(1e-3);
    CHECK(motor.outcome() == Outcome::unreliable);
    CHECK(motor.residual() == infinity);
    CHECK(motor.joint().state() == state);
    CHECK(motor.rotation() == rotation);
    CHECK(std::isfinite(motor.moment()));
    body.setCenterOfMassTransform(at);
    body.setLinearVelocity(velocity);
    body.setAngularVelocity(spin);
    world.step(1e-3);
    CHECK(motor.outcome() == Outcome::yielding);
    CHECK(motor.absorbed_energy() == Approx(2 * state.plastic_work).epsilon(0.01));
    motor.remove_from(world.world());
    world.world().removeConstraint(&stock);
}

TEST_CASE("Bullet serialises a world with plastic joints", "[bullet][life]") {
    BulletWorld world;
    btRigidBody& body = rotor(world);
    btHingeConstraint stock(body, {0, 0, 0}, {0, 0, 1}, true);
    bullet::PlasticHinge hinge(body, here, one(40));
    bullet::PlasticJoint joint(body, here, six(capacities()));
    bullet::PlasticMotor motor(stock, one(40));
    world.world().addConstraint(&stock);
    hinge.add_to(world.world());
    joint.add_to(world.world());
    motor.add_to(world.world());
    world.step(1e-3);
    btDefaultSerializer serializer;
    world.world().serialize(&serializer);
    // the file: a header of 12 bytes, then chunks of code, length, old pointer and two numbers
    const unsigned char* file = serializer.getBufferPointer();
    const int size = serializer.getCurrentBufferSize();
    int constraints = 0;
    for (int at = 12; at + int(sizeof(btChunk)) <= size;) {
        btChunk chunk;
        std::memcpy(&chunk, file + at, sizeof(btChunk));
        if (chunk.m_chunkCode == BT_CONSTRAINT_CODE) ++constraints;
        at += int(sizeof(btChunk)) + chunk.m_length;
    }
    CHECK(constraints == 4);
    motor.remove_from(world.world());
    joint.remove_from(world.world());
    hinge.remove_from(world.world());
    world.world().removeConstraint(&stock);
}

TEST_CASE("a joint draws its utilisation, its flow and its break", "[bullet][life]") {
    BulletWorld world;
    Drawer drawer;
    world.world().setDebugDrawer(&drawer);
    btRigidBody& body = rotor(world, 0);
    bullet::PlasticHinge hinge(body, here, one(40, 1.6));
    hinge.add_to(world.world());
    world.step(1e-3);
    world.world().debugDrawWorld();
    CHECK(drawer.ball == btVector3(0, 1, 0));
    CHECK(drawer.arcs == 0);
    body.applyTorque({0, 0, 20});
    world.step(1e-3);
    world.world().debugDrawWorld();
    CHECK((drawer.ball - btVector3(1, 1, 0)).length() < 1e-4); // half used
    body.setAngularVelocity({0, 0, 10});
    world.step(1e-3, 100);
    world.world().debugDrawWorld();
    CHECK((drawer.ball - btVector3(1, 0, 0)).length() < 1e-4);
    CHECK(drawer.arcs == 1);
    CHECK(drawer.arc == Approx(hinge.plastic_offset()).epsilon(1e-5));
    world.step(1e-3, 200);
    REQUIRE(hinge.broken());
    world.world().debugDrawWorld();
    CHECK((drawer.ball - btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))).length() < 1e-6);
    world.world().setDebugDrawer(nullptr);
    hinge.remove_from(world.world());
}

// ---- the motor of a hinge that is already there

TEST_CASE("an existing hinge's motor stops a rotor as a plastic hinge does", "[bullet][motor]") {
    const auto solver = GENERATE(from_range(BulletWorld::solvers()));
    const bool reference_a = GENERATE(false, true);
    const double spin = GENERATE(10.0, -30.0);
    const double rate = GENERATE(60.0, 1000.0);
    INFO(solver << (reference_a ? ", frame A" : ", frame B") << ", spin " << spin << ", 1/"
                << rate);
    BulletWorld world(solver);
    btRigidBody& body = rotor(world, spin);
    btRigidBody& base = world.body(0, 0);
    btHingeConstraint stock(body, base, here, here, reference_a);
    stock.enableAngularMotor(false, btScalar(1.5), btScalar(0.25));
    world.world().addConstraint(&stock);
    {
        bullet::PlasticMotor motor(stock, one(40));
        motor.add_to(world.world());
        bullet::EnergyMeter meter(world.world());
        for (int i = 0; i < int(2 * rate); ++i) {
            meter.before_step();
            world.step(1 / rate);
            meter.after_step(1 / rate);
        }
        close(motor.absorbed_energy(), spin * spin);
        close(motor.plastic_rotation(), spin * spin / 40);
        const double a = 20 / rate, n = std::floor(std::abs(spin) / a * (1 + 1e-12));
        const double travel = (n * std::abs(spin) - a * n * (n + 1) / 2) / rate;
        CHECK(motor.rotation() ==
              Approx(std::copysign(travel, spin)).epsilon(single ? 1e-3 : 1e-9));
        CHECK(std::abs(double(body.getAngularVelocity().z())) < (single ? 1e-4 : 1e-9));
        CHECK(motor.outcome() == Outcome::elastic);
        CHECK(meter.ledger().booked(Account::plastic) == Approx(spin * spin).epsilon(exact));
        CHECK(std::abs(meter.ledger().unexplained()) < exact * spin * spin);
        motor.remove_from(world.world());
    }
    CHECK(!stock.getEnableAngularMotor()); // as the user had it
    CHECK(stock.getMotorTargetVelocity() == btScalar(1.5));
    CHECK(stock.getMaxMotorImpulse() == btScalar(0.25));
    world.world().removeConstraint(&stock);
}

TEST_CASE("an existing hinge breaks with the right residual speed at every step",
          "[bullet][motor]") {
    const auto solver = GENERATE(from_range(BulletWorld::solvers()));
    const double rate = GENERATE(15.0, 60.0, 1000.0);
    const auto at_break = GENERATE(bullet::AtBreak::disable_joint, bullet::AtBreak::release_axis);
    INFO(solver << ", 1/" << rate);
    BulletWorld world(solver);
    btRigidBody& body = rotor(world);
    btHingeConstraint stock(body, {0, 0, 0}, {0, 0, 1}, true);
    world.world().addConstraint(&stock);
    bullet::PlasticMotor motor(stock, one(40, 1.6), at_break);
    motor.add_to(world.world());
    // the step may change from tick to tick
    for (int i = 0; i < int(rate); ++i) world.step((i % 2 == 0 ? 1.0 : 0.6) / rate);
    CHECK(motor.broken());
    close(double(body.getAngularVelocity().z()), 6);
    close(motor.absorbed_energy(), 64);
    CHECK(stock.isEnabled() == (at_break == bullet::AtBreak::release_axis));
    CHECK(!(stock.isEnabled() && stock.getEnableAngularMotor()));
    motor.remove_from(world.world());
    world.world().removeConstraint(&stock);
}

TEST_CASE("an existing hinge may be elastic below yield, as a plastic hinge is",
          "[bullet][motor]") {
    const std::string solver = "world";
    const double rate = GENERATE(60.0, 1000.0); // the longer step does not resolve the spring
    const double spin = GENERATE(0.1, 9.7);     // swings; yields
    INFO(solver << ", 1/" << rate << ", spin " << spin);
    const One elastic(Perfect<double>({.strength = 40}), TravelLimit<double>(), {.stiffness = 2e4});
    BulletWorld world(solver), other(solver);
    btRigidBody &body = rotor(world, spin), &twin = rotor(other, spin);
    btHingeConstraint stock(body, {0, 0, 0}, {0, 0, 1}, true);
    world.world().addConstraint(&stock);
    bullet::PlasticMotor motor(stock, elastic);
    motor.add_to(world.world());
    bullet::PlasticHinge hinge(twin, here, elastic);
    hinge.add_to(other.world());
    double most = 0;
    for (int i = 0; i < int(rate); ++i) {
        world.step(1 / rate);
        other.step(1 / rate);
        most = std::max(most, motor.stored_energy());
        REQUIRE(motor.outcome() != Outcome::unreliable);
        REQUIRE(motor.rotation() == Approx(hinge.rotation()).margin(single ? 1e-5 : 1e-12));
        REQUIRE(motor.moment() == Approx(hinge.moment()).margin(single ? 0.05 : 1e-8));
    }
    CHECK(most > 1e-3);
    CHECK(motor.absorbed_energy() == Approx(hinge.absorbed_energy()).epsilon(exact));
    CHECK((motor.absorbed_energy() > 0) == (spin > 1));
    hinge.remove_from(other.world());
    motor.remove_from(world.world());
    world.world().removeConstraint(&stock);
}

TEST_CASE("the limits of an existing hinge hold beside what it absorbs", "[bullet][motor]") {
    const auto solver = GENERATE(from_range(BulletWorld::solvers()));
    INFO(solver);
    constexpr double limit = 0.5;
    BulletWorld world(solver);
    btRigidBody& body = rotor(world);
    btRigidBody& base = world.body(0, 0);
    btHingeConstraint stock(body, base, here, here);
    stock.setLimit(btScalar(-limit), btScalar(limit), btScalar(1), btScalar(0), btScalar(0));
    world.world().addConstraint(&stock);
    bullet::PlasticMotor motor(stock, one(40));
    motor.add_to(world.world());
    world.step(1e-3, 500);
    CHECK(std::abs(motor.rotation()) == Approx(limit).margin(0.011)); // a step at 10 rad/s
    CHECK(std::abs(double(body.getAngularVelocity().z())) < 1e-4);
    close(motor.absorbed_energy(), 40 * motor.plastic_rotation());
    CHECK(motor.plastic_rotation() == Approx(limit).margin(0.011));
    motor.remove_from(world.world());
    world.world().removeConstraint(&stock);
}
