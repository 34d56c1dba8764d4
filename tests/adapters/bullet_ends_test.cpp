// SPDX-License-Identifier: MIT
//
// How joints, bodies and worlds of Bullet end: in which order they may, what a break leaves behind,
// and joints that come into a world twice. Worth running under AddressSanitizer.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "adapters/bullet_world.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

using Hinge = bullet::PlasticHinge<>;
constexpr double unlimited = std::numeric_limits<double>::infinity();
const btTransform here = btTransform::getIdentity();

OneAxisJoint<Perfect<double>> joint(double strength, double limit = unlimited) {
    return OneAxisJoint(Perfect<double>({.strength = strength}),
                        TravelLimit<double>({.limit = limit}));
}

/// Two boxes of 1 m, 1.1 m apart, that turn against each other and so break what joins them.
class Halves {
  public:
    explicit Halves(btDiscreteDynamicsWorld& world) : world_(world) {
        for (int i : {0, 1}) {
            btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, &box_, {2, 2, 2});
            info.m_startWorldTransform = BulletWorld::frame({1.1 * i, 0, 0});
            body_[i].emplace(info);
            body_[i]->setActivationState(DISABLE_DEACTIVATION);
            body_[i]->setAngularVelocity({0, 0, btScalar(i == 0 ? 6 : -6)});
            world_.addRigidBody(&*body_[i]);
        }
    }
    ~Halves() {
        for (auto& body : body_) world_.removeRigidBody(&*body);
    }
    Halves(const Halves&) = delete;
    Halves& operator=(const Halves&) = delete;

    btRigidBody& operator[](int i) { return *body_[i]; }
    static btTransform pivot(int i) { return BulletWorld::frame({i == 0 ? 0.55 : -0.55, 0, 0}); }

    /// Throws the first at the second, 3 m away: how fast the second is 2 s later.
    double thrown() {
        for (int i : {0, 1}) {
            body_[i]->setWorldTransform(BulletWorld::frame({3.0 * i, 0, 0}));
            body_[i]->setInterpolationWorldTransform(body_[i]->getWorldTransform());
            body_[i]->setAngularVelocity({0, 0, 0});
            body_[i]->setLinearVelocity({btScalar(i == 0 ? 4 : 0), 0, 0});
        }
        for (int i = 0; i < 480; ++i) world_.stepSimulation(btScalar(1. / 240), 0);
        return double(body_[1]->getLinearVelocity().x());
    }

  private:
    btDiscreteDynamicsWorld& world_;
    btBoxShape box_{{0.5, 0.5, 0.5}};
    std::optional<btRigidBody> body_[2];
};

/// Steps until the hinge breaks.
void break_it(BulletWorld& world, const PairQueries& hinge) {
    for (int i = 0; i < 200 && !hinge.broken(); ++i) world.step(1. / 240);
    REQUIRE(hinge.broken());
}

bool collide(Halves& halves) {
    return halves[0].checkCollideWith(&halves[1]) && halves[1].checkCollideWith(&halves[0]);
}

} // namespace

TEST_CASE("two parts collide again once their joint has broken", "[bullet][ends]") {
    const auto told = GENERATE(as<std::optional<bool>>{}, std::nullopt, false, true); // not to
    const bool by_engine = GENERATE(false, true);
    CAPTURE(told.has_value(), told.value_or(false), by_engine);
    BulletWorld world("si");
    Halves halves(world.world());
    Hinge hinge(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1), joint(64, 0.05));
    by_engine ? world.world().addConstraint(&hinge, told.value_or(false))
              : hinge.add_to(world.world(), told);
    // unasked they do not, but as Bullet's own joints have it by Bullet's own call
    CHECK(collide(halves) == !told.value_or(!by_engine));
    break_it(world, hinge);
    CHECK(collide(halves));
    CHECK(halves.thrown() > 1);
    world.world().removeConstraint(&hinge);
}

TEST_CASE("a World parts what a joint holds, unless that was told otherwise", "[bullet][ends]") {
    const double tolerance = GENERATE(0.0, 0.01);
    const bool kept = GENERATE(false, true), by_engine = GENERATE(false, true);
    CAPTURE(tolerance, kept, by_engine);
    BulletWorld world("si");
    Halves halves(world.world());
    bullet::World keeper(world.world(), {.tolerance = tolerance, .warn = nullptr});
    Hinge hinge(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1), joint(64));
    if (by_engine) world.world().addConstraint(&hinge); // before: the World goes on from there
    if (kept) hinge.add_to(world.world(), false);
    keeper.add(hinge);
    CHECK(collide(halves) == kept);
    keeper.step(1e-3);
    CHECK(collide(halves) == kept);
    keeper.remove(hinge);
    CHECK(collide(halves));
    CHECK(halves[0].getNumConstraintRefs() == 0);
}

TEST_CASE("parts collide once the last of their joints has broken", "[bullet][ends]") {
    const bool mended = GENERATE(false, true);
    BulletWorld world("si");
    Halves halves(world.world());
    btPoint2PointConstraint own(halves[0], halves[1], Halves::pivot(0).getOrigin(),
                                Halves::pivot(1).getOrigin());
    world.world().addConstraint(&own, true);
    Hinge weak(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1), joint(32, 0.05));
    Hinge strong(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1), joint(32, 0.5));
    weak.add_to(world.world());
    strong.add_to(world.world());
    const auto whole = weak.state();
    break_it(world, weak);
    REQUIRE_FALSE(strong.broken());
    CHECK_FALSE(collide(halves));
    if (mended) {
        weak.restore(whole);
        strong.remove_from(world.world());
        CHECK_FALSE(collide(halves));
        weak.remove_from(world.world());
    } else {
        break_it(world, strong);
    }
    CHECK_FALSE(collide(halves)); // the user's own joint
    world.world().removeConstraint(&own);
    CHECK(collide(halves));
}

TEST_CASE("contacts of two bodies end where a joint comes between them", "[bullet][ends]") {
    BulletWorld world("si");
    Halves halves(world.world());
    halves[1].setWorldTransform(BulletWorld::frame({0.95, 0, 0})); // 5 cm in the other
    for (int i : {0, 1}) halves[i].setAngularVelocity({0, 0, 0});
    const auto points = [&world] {
        btDispatcher& dispatcher = *world.world().getDispatcher();
        int count = 0;
        for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
            count += dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
        }
        return count;
    };
    world.step(1e-3);
    REQUIRE(points() > 0);
    for (int i : {0, 1}) halves[i].setLinearVelocity({0, 0, 0});
    Hinge hinge(halves[0], halves[1], BulletWorld::frame({0.475, 0, 0}),
                BulletWorld::frame({-0.475, 0, 0}), joint(64), Meeting::as_they_are);
    hinge.add_to(world.world());
    CHECK(points() == 0);
    halves[0].setAngularVelocity({0, 0, 1});
    world.step(1e-3, 100);
    CHECK(points() == 0);
    // once mended as well
    Hinge broken(halves[0], halves[1], BulletWorld::frame({0.475, 0, 0}),
                 BulletWorld::frame({-0.475, 0, 0}), joint(64, 1e-3), Meeting::as_they_are);
    hinge.remove_from(world.world());
    broken.add_to(world.world());
    const auto mended = broken.state();
    halves[0].setAngularVelocity({0, 0, 3});
    break_it(world, broken);
    world.step(1e-3);
    REQUIRE(points() > 0);
    broken.restore(mended);
    CHECK(points() == 0);
}

TEST_CASE("a joint that is broken, or in no world, parts nothing", "[bullet][ends]") {
    BulletWorld world("si");
    Halves halves(world.world());
    Hinge hinge(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1), joint(64, 0.05));
    hinge.add_to(world.world());
    const auto whole = hinge.state();
    break_it(world, hinge);
    const auto broken = hinge.state();
    hinge.remove_from(world.world());
    hinge.restore(whole);
    CHECK(collide(halves));
    hinge.restore(broken);
    hinge.add_to(world.world());
    CHECK(collide(halves));
    hinge.restore(whole);
    CHECK_FALSE(collide(halves));
    hinge.remove_from(world.world());
    CHECK(collide(halves));
}

TEST_CASE("ground keeps no list of the bodies that it holds", "[bullet][ends]") {
    BulletWorld world("si");
    Halves halves(world.world());
    world.world().removeRigidBody(&halves[1]);
    halves[1].setMassProps(0, {0, 0, 0});
    world.world().addRigidBody(&halves[1]);
    const bool first = GENERATE(false, true); // of the two
    const int a = first ? 1 : 0;
    Hinge hinge(halves[a], halves[1 - a], Halves::pivot(a), Halves::pivot(1 - a), joint(64, 0.05));
    Hinge fixed(halves[0], here, joint(64));
    hinge.add_to(world.world());
    fixed.add_to(world.world());
    CHECK(halves[1].getNumConstraintRefs() == 0);
    CHECK(halves[0].getNumConstraintRefs() == 1); // the static world has no shape
    CHECK_FALSE(collide(halves));
    fixed.remove_from(world.world());
    break_it(world, hinge);
    CHECK(collide(halves));
}

TEST_CASE("parts that were told not to collide do not once their joint is mended",
          "[bullet][ends]") {
    BulletWorld world("si");
    Halves halves(world.world());
    Hinge hinge(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1), joint(64, 0.05));
    hinge.add_to(world.world(), true);
    const auto whole = hinge.state();
    break_it(world, hinge);
    const auto broken = hinge.state();
    hinge.restore(whole);
    for (int i : {0, 1}) CHECK_FALSE(halves[i].checkCollideWith(&halves[1 - i]));
    hinge.restore(broken);
    CHECK(collide(halves));
    hinge.remove_from(world.world());
    CHECK(halves[0].getNumConstraintRefs() == 0);
}

TEST_CASE("a hinge of Bullet's own that a motor rules parts its bodies as it did",
          "[bullet][ends]") {
    const bool parted = GENERATE(false, true), asked = GENERATE(false, true);
    BulletWorld world("si");
    Halves halves(world.world());
    btHingeConstraint own(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1));
    world.world().addConstraint(&own, parted);
    {
        bullet::PlasticMotor motor(own, joint(64));
        asked ? motor.add_to(world.world(), true) : motor.add_to(world.world());
        CHECK(collide(halves) == (!parted && !asked));
    }
    CHECK(collide(halves) == !parted);
    world.world().removeConstraint(&own);
}

TEST_CASE("a hinge of Bullet's own that a motor breaks lets its parts collide", "[bullet][ends]") {
    const auto at_break = GENERATE(bullet::AtBreak::disable_joint, bullet::AtBreak::release_axis);
    BulletWorld world("si");
    Halves halves(world.world());
    btHingeConstraint own(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1));
    world.world().addConstraint(&own, true);
    {
        bullet::PlasticMotor motor(own, joint(64, 0.05), at_break);
        motor.add_to(world.world());
        break_it(world, motor);
        CHECK(collide(halves) == (at_break == bullet::AtBreak::disable_joint));
    }
    world.world().removeConstraint(&own);
    CHECK(collide(halves));
}

TEST_CASE("a joint that ends leaves Bullet's world and every World", "[bullet][ends]") {
    const bool looked_after = GENERATE(false, true);
    const double tolerance = GENERATE(0.0, 0.01);
    const bool parted = GENERATE(false, true);
    BulletWorld world("si");
    Halves halves(world.world());
    bullet::World keeper(world.world(), {.tolerance = tolerance, .warn = nullptr});
    {
        Hinge hinge(halves[0], halves[1], Halves::pivot(0), Halves::pivot(1), joint(64));
        hinge.add_to(world.world(), parted);
        if (looked_after) keeper.add(hinge);
        keeper.step(1e-3);
    }
    CHECK(world.world().getNumConstraints() == 0);
    CHECK(collide(halves));
    CHECK(halves[0].getNumConstraintRefs() == 0);
    keeper.step(1e-3);
    keeper.step(2e-3);
    CHECK(keeper.worst().residual == 0);
}

TEST_CASE("a joint that Bullet's own call took out ends well", "[bullet][ends]") {
    BulletWorld world("si");
    btRigidBody& body = world.body(1, 2);
    {
        Hinge hinge(body, here, joint(64));
        hinge.add_to(world.world());
        world.step(1e-3);
        world.world().removeConstraint(&hinge);
        world.step(1e-3);
    }
    world.step(1e-3);
    CHECK(world.world().getNumConstraints() == 0);
}

TEST_CASE("a joint that Bullet's own call took out may be added again", "[bullet][ends]") {
    BulletWorld world("si");
    btRigidBody& body = world.body(1, 2);
    body.setAngularVelocity({0, 0, 10});
    Hinge hinge(body, here, joint(64));
    hinge.add_to(world.world());
    world.world().removeConstraint(&hinge);
    world.step(1e-3);
    CHECK(hinge.absorbed_energy() == 0);
    hinge.add_to(world.world());
    world.step(1e-3, 400);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(1e-4));
}

TEST_CASE("bodies and joints end in any order once the bodies have left the world",
          "[bullet][ends]") {
    BulletWorld world("si");
    alignas(Halves) std::byte storage[sizeof(Halves)];
    auto* halves = new (storage) Halves(world.world());
    const bool parted = GENERATE(false, true);
    auto hinge = std::make_unique<Hinge>((*halves)[0], (*halves)[1], Halves::pivot(0),
                                         Halves::pivot(1), joint(64));
    hinge->add_to(world.world(), parted);
    world.step(1e-3);
    halves->~Halves();
    std::memset(storage, 0x7F, sizeof storage); // whoever reads it falls
    hinge.reset();
    CHECK(world.world().getNumConstraints() == 0);
    world.step(1e-3);
}

TEST_CASE("a World ends before its joints, and they go on", "[bullet][ends]") {
    BulletWorld world("si");
    btRigidBody& body = world.body(1, 2);
    body.setAngularVelocity({0, 0, 10});
    Hinge hinge(body, here, joint(64));
    {
        bullet::World keeper(world.world(), {.tolerance = 0.01, .warn = nullptr});
        keeper.add(hinge);
        keeper.step(1e-3);
    }
    world.step(1e-3, 400);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(1e-3));
}

TEST_CASE("Bullet's world ends before a World that has no joint left", "[bullet][ends]") {
    auto world = std::make_unique<BulletWorld>("si");
    btRigidBody& body = world->body(1, 2);
    bullet::World keeper(world->world(), {.tolerance = 0.01, .warn = nullptr});
    {
        Hinge hinge(body, here, joint(64));
        keeper.add(hinge);
        keeper.step(1e-3);
    }
    keeper.step(1e-3);
    world.reset();
    CHECK(keeper.time() == Approx(2e-3));
}

TEST_CASE("a joint comes into a world once", "[bullet][ends]") {
    BulletWorld world("si"), other("si");
    btRigidBody& body = world.body(1, 2);
    body.setAngularVelocity({0, 0, 10});
    Hinge hinge(body, here, joint(64));
    SECTION("added twice, or to two worlds") {
        const char* refused =
            "PlasticConstraint.add_to.world: must not be given while the constraint is in a world: "
            "remove_from that one first";
        hinge.add_to(world.world());
        CHECK(message_of([&] { hinge.add_to(world.world()); }) == refused);
        CHECK(message_of([&] { hinge.add_to(other.world()); }) == refused);
    }
    SECTION("added by Bullet's own call and then by ours") {
        world.world().addConstraint(&hinge);
        hinge.add_to(world.world());
    }
    SECTION("added by Bullet's own call and then to a World") {
        world.world().addConstraint(&hinge);
        bullet::World keeper(world.world());
        keeper.add(hinge);
    }
    CHECK(world.world().getNumConstraints() == 1);
    CHECK(other.world().getNumConstraints() == 0);
    world.step(1e-3, 400);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(1e-4));
    hinge.remove_from(world.world());
    CHECK(world.world().getNumConstraints() == 0);
}

TEST_CASE("what makes no joint is refused in words", "[bullet][ends]") {
    BulletWorld world("si");
    btRigidBody &a = world.body(1, 2), &b = world.body(1, 2, {1, 0, 0});
    btRigidBody &wall = world.body(0, 0.0), &floor = world.body(0, 0.0, {1, 0, 0});
    const auto at = [](double x) { return BulletWorld::frame({x, 0, 0}); };
    const auto refused = [&](btRigidBody& first, btRigidBody& second, const btTransform& in_first,
                             const btTransform& in_second) {
        return message_of([&] { Hinge(first, second, in_first, in_second, joint(64)); });
    };
    // a quarter of a metre between the halves of the pin, of arms of three quarters
    CHECK(refused(a, b, at(0.5), at(-0.25)).find("axis shear_x, apart by = -0.25") !=
          std::string::npos);
    btTransform across = at(-0.5);
    across.setRotation(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI));
    CHECK(refused(a, b, at(0.5), across).find("axis bending_y, apart by = -1.57") !=
          std::string::npos);
    CHECK(refused(a, b, at(std::nan("")), at(-0.5)) ==
          "JointConstraint.frame_in_a.origin: must be finite [m]");
    CHECK(refused(a, b, at(1e160), at(-0.5)).find("JointConstraint.frame_in_a.origin") == 0);
    const btTransform flat(btMatrix3x3(1, 0, 0, 1, 0, 0, 0, 0, 1), {-0.5, 0, 0});
    CHECK(refused(a, b, at(0.5), flat) ==
          "JointConstraint.frame_in_b.axes: must be three orthonormal columns, right-handed");
    CHECK(refused(a, a, at(0.5), at(0.5)) == "PlasticConstraint.b: must not be body a itself");
    CHECK(refused(wall, floor, at(0.5), at(-0.5)) ==
          "PlasticConstraint.a, b: must not both be static, as no joint acts between such bodies");
    // 2 cm and 3 degrees are pulled together
    btTransform sloppy = at(-0.48);
    sloppy.setRotation(btQuaternion(btVector3(0, 1, 0), btScalar(0.05)));
    CHECK(refused(a, b, at(0.5), sloppy) == "nothing thrown");
}

TEST_CASE("a state that no joint comes to is not restored", "[bullet][ends]") {
    BulletWorld world("si");
    Halves halves(world.world());
    const btTransform in_a = Halves::pivot(0), in_b = Halves::pivot(1);
    const double bad = GENERATE(std::nan(""), HUGE_VAL, 1e300);
    const auto refused = [&](const std::string& field, const auto& restore) {
        CHECK(message_of(restore).find("restore." + field + " = ") == 0);
    };
    SECTION("of one axis of Bullet's own") {
        btHingeConstraint own(halves[0], halves[1], in_a, in_b);
        bullet::PlasticMotor motor(own, joint(64));
        const auto whole = motor.joint().state();
        refused("position", [&] { motor.restore(whole, bad); });
        auto spoiled = whole;
        spoiled.plastic_offset = bad;
        refused("state.plastic_offset", [&] { motor.restore(spoiled, 0); });
        CHECK(motor.joint().state() == whole);
        CHECK(motor.position() == 0);
    }
    SECTION("of six rows") {
        Hinge hinge(halves[0], halves[1], in_a, in_b, joint(64));
        const auto whole = hinge.state();
        auto spoiled = whole;
        spoiled.joint.plastic_travel = bad;
        refused("state.plastic_travel", [&] { hinge.restore(spoiled); });
        CHECK(hinge.state() == whole);
    }
}

TEST_CASE("a body that is in no world is missed at the first step", "[bullet][ends]") {
    BulletWorld world("si");
    btRigidBody& body = world.body(1, 2);
    Hinge hinge(body, here, joint(64));
    world.world().removeRigidBody(&body);
    const std::string missed =
        "PlasticConstraint.a: is in no world: addRigidBody it before the first step, or remove "
        "the joint before the body";
    hinge.add_to(world.world()); // which of the two comes first does not matter
    {
        bullet::World keeper(world.world());
        keeper.add(hinge);
        CHECK_THROWS_WITH(keeper.step(1e-3), missed);
        CHECK(keeper.time() == 0);
    }
    world.world().addRigidBody(&body, 0, 0);
    world.step(1e-3);
}

TEST_CASE("a World says once where its engine is stepped beside it", "[bullet][ends]") {
    BulletWorld world("si");
    btRigidBody& body = world.body(1, 2);
    Hinge hinge(body, here, joint(64));
    std::vector<std::string> said;
    bullet::World keeper(world.world(),
                         {.warn = [&](const std::string& line) { said.push_back(line); }});
    keeper.add(hinge);
    keeper.step(1e-3);
    CHECK(said.empty());
    world.step(1e-3, 3);
    REQUIRE(said.size() == 1);
    CHECK(said[0].find("stepped beside World::step") != std::string::npos);
}

TEST_CASE("a World says once of a joint that nobody added", "[bullet][ends]") {
    BulletWorld world("si"), other("si");
    btRigidBody &body = world.body(1, 2), &elsewhere = other.body(1, 2);
    Hinge forgotten(body, here, joint(64)), added(body, here, joint(64)),
        by_engine(body, here, joint(64)), not_mine(elsewhere, here, joint(64));
    world.world().addConstraint(&by_engine);
    {
        bullet::World keeper(world.world());
        CHECK_THROWS_WITH(keeper.step(1e-3), Catch::Contains("its own add_to"));
        CHECK(keeper.time() == 0);
    }
    std::vector<std::string> said;
    bullet::World keeper(world.world(), {.tolerance = 0, .warn = [&](const std::string& line) {
                                             said.push_back(line);
                                         }});
    keeper.add(added);
    for (int i = 0; i < 3; ++i) keeper.step(1e-3);
    REQUIRE(said.size() == 1);
    CHECK(said[0].find("never added") != std::string::npos);
    world.world().removeConstraint(&by_engine);
}

TEST_CASE("a second World over one Bullet world is refused until the first has ended",
          "[bullet][ends]") {
    BulletWorld world("si");
    btConstraintSolver* const usual = world.world().getConstraintSolver();
    {
        const bullet::World first(world.world(), {.warn = nullptr});
        const btConstraintSolver* const front = world.world().getConstraintSolver();
        CHECK(message_of([&] { bullet::World(world.world(), {.warn = nullptr}); }) ==
              "World.world: must have no other World, which would solve its joints too: end that "
              "one first");
        CHECK(world.world().getConstraintSolver() == front);
    }
    CHECK(world.world().getConstraintSolver() == usual);
    const bullet::World again(world.world(), {.warn = nullptr});
}
