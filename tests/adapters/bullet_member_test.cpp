// SPDX-License-Identifier: MIT
//
// Members in Bullet: what they bear, their bodies, what is kept and put back, and what they refuse.
#include "adapters/member_rig.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ductile/material/named.hpp"
#include "ductile/section/rectangle.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;
using bullet::World;
using bullet::WorldParameters;

TEST_CASE("two members that one joint would hold are told what joins members", "[bullet][member]") {
    Rig rig;
    bullet::World world(rig.engine, {.warn = {}});
    const auto one = bar_of(rig, free_bar(), false), other = bar_of(rig, free_bar(), false);
    one->attach(0, [&](btRigidBody& piece, const btTransform& at) {
        return std::make_unique<btPoint2PointConstraint>(piece, *other->pieces().front(),
                                                         at.getOrigin(), btVector3(0, 0, 0));
    });
    world.add(*one);
    CHECK(message_of([&] {
              world.add(*other);
              world.step(1.0 / 60);
          }).find("joined are one StructureInTime") != std::string::npos);
}

TEST_CASE("a scene whose members stay whole is bit for bit the one without the library",
          "[bullet][member]") {
    const auto run = [](bool with_members) {
        Rig rig({0, 0, btScalar(-9.81)});
        rig.body(0, {0, 0, 0}, {0, 0, -1},
                 rig.shape(std::make_unique<btBoxShape>(btVector3(50, 50, 1))), usual, everything);
        std::unique_ptr<World> world;
        if (with_members) {
            world =
                std::make_unique<World>(rig.engine, WorldParameters{.tolerance = 0, .warn = {}});
        }
        std::vector<std::unique_ptr<bullet::Member>> members;
        MemberParameters p;
        p.segments = lumped_segments(2, 24, 8, {1e-3, 1e-3, 2e-3});
        p.sections.assign(7, UsualAxisJoint(Perfect<double>({.strength = 5e4})));
        const Member of(p);
        auto* box =
            rig.shape(std::make_unique<btBoxShape>(btVector3(btScalar(0.2), btScalar(0.2), 1)));
        std::vector<btRigidBody*> posts;
        for (int i = 0; i < 6; ++i) {
            btVector3 inertia;
            box->calculateLocalInertia(24, inertia);
            // the last ones fall on each other
            posts.push_back(&rig.body(
                24, inertia,
                {btScalar(i < 3 ? 2 * i : 6), 0, btScalar(i < 3 ? 1 : 1.02 + 2.1 * (i - 3))}, box,
                usual, everything));
            posts.back()->setFriction(btScalar(0.5));
            posts.back()->setAngularVelocity({btScalar(i < 3 ? 0 : 0.3), 0, 0});
            if (!with_members) continue;
            members.push_back(std::make_unique<bullet::Member>(
                *posts.back(), of, btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -1)),
                bullet::MemberBox{0.2, 0.2}));
            world->add(*members.back());
        }
        std::vector<btTransform> poses;
        for (int step = 0; step < 300; ++step) {
            if (with_members) {
                world->step(1.0 / 60);
            } else {
                rig.engine.stepSimulation(btScalar(1.0 / 60), 0);
            }
            for (const btRigidBody* post : posts) poses.push_back(post->getWorldTransform());
        }
        for (const auto& member : members) CHECK(member->whole());
        return poses;
    };
    const auto without = run(false), with = run(true);
    REQUIRE(with.size() == without.size());
    CHECK(std::equal(with.begin(), with.end(), without.begin(),
                     [](const btTransform& a, const btTransform& b) { return a == b; }));
}

TEST_CASE("a bar on two supports carries a load whole that sweeps cannot settle",
          "[bullet][member]") {
    // 100 kg on the middle of 20 kg: ten sweeps leave it a thousandth off. The supports' edges are
    // where segments meet: with a box for each of them those would hold the open bar's halves
    // apart.
    constexpr double frame = 1e-3;
    for (const double share : {0.8, 1.14}) {
        Rig rig({0, 0, btScalar(-9.81)});
        const double bar_mass = 20, load_mass = 100;
        auto* support = rig.shape(
            std::make_unique<btBoxShape>(btVector3(btScalar(0.05), btScalar(0.5), btScalar(0.5))));
        for (const double x : {-0.95, 0.95}) {
            rig.body(0, {0, 0, 0}, {btScalar(x), 0, btScalar(-0.5)}, support, usual, everything);
        }
        const auto box = [&](double mass, const btVector3& half, double z) -> btRigidBody& {
            auto* shape = rig.shape(std::make_unique<btBoxShape>(half));
            btVector3 inertia;
            shape->calculateLocalInertia(btScalar(mass), inertia);
            btRigidBody& body =
                rig.body(mass, inertia, {0, 0, btScalar(z)}, shape, usual, everything);
            return body;
        };
        btRigidBody& bar = box(bar_mass, {1, btScalar(0.05), btScalar(0.05)}, 0.05);
        box(load_mass, {btScalar(0.01), btScalar(0.04), btScalar(0.1)}, 0.2);
        // reactions at the inner edges of the supports
        const double reaction = 9.81 * (load_mass + bar_mass) / 2;
        const double moment = 0.9 * reaction - 9.81 * bar_mass / 2 * 0.5;
        MemberParameters p;
        p.segments = lumped_segments(2, bar_mass, 20, {1e-3, 1e-3, 2e-3});
        p.sections.assign(19, UsualAxisJoint(Perfect<double>({.strength = moment / share})));
        // along x of the bar, bending about its y
        const btTransform start(btMatrix3x3(0, 0, 1, 1, 0, 0, 0, 1, 0), btVector3(-1, 0, 0));
        World world(rig.engine, {.warn = {}});
        bullet::Member member(bar, Member(p), start, {0.05, 0.05});
        world.add(member);
        const auto go = [&](int steps) {
            int open = 0;
            for (int i = 0; i < steps && member.absorbed_energy() < 5; ++i) {
                world.step(frame);
                open += !member.whole();
            }
            return open;
        };
        go(50); // it falls by a hair first, and settles
        const double before = member.absorbed_energy();
        const int open = go(3500);
        CAPTURE(share, open, before);
        if (share < 1) {
            CHECK(before < 0.1);
            CHECK(member.absorbed_energy() == before);
            CHECK(open == 0);
        } else {
            CHECK(member.absorbed_energy() >= 5);
        }
    }
}

TEST_CASE("a strip of steel bears a blow that would yield it were it rigid", "[bullet][member]") {
    const Rectangle<double> section({.width = 0.064, .height = 0.004});
    const Member of = beam(section, Material<double>(s355<double>()),
                           {.length = 1, .segments = 16, .clamped = true});
    for (const double frame : {1.0 / 30, 1.0 / 240, 1.0 / 4000}) {
        BallOnPost slow(of, 1, 2.5, 0.01, 0.01, 0.003);
        slow.go(0.1, frame);
        CHECK(slow.post->absorbed_energy() == 0);
        CHECK(slow.ball->getLinearVelocity().y() < 2); // it did strike
        BallOnPost fast(of, 1, 12, 0.01, 0.01, 0.003);
        fast.go(0.1, frame);
        CHECK(fast.post->absorbed_energy() > 1);
    }
}

TEST_CASE("what acts on a member that is damped and spins is all accounted for",
          "[bullet][member]") {
    // a rotor that tumbles: 10 N m of gyroscopic moment on each of ten discs, which bear 100
    for (const double tolerance : {0.0, 0.01}) {
        for (const double inertia_share : {1.0, 0.8}) { // of the user's body
            Rig rig;
            World world(rig.engine, {.tolerance = tolerance, .warn = {}});
            MemberParameters p;
            p.segments = lumped_segments(2, 20, 10, {0.05, 0.05, 0.1});
            p.sections.assign(9, UsualAxisJoint(Perfect<double>({.strength = 100})));
            const Member of(p);
            const MemberPiece whole = make_piece(of, straight(of), {0, 9});
            const Vector3<double> inertia = scaled(inertia_share, whole.inertia);
            btRigidBody& body = rig.body(
                20, {btScalar(inertia[0]), btScalar(inertia[1]), btScalar(inertia[2])}, {0, 0, 0});
            body.setDamping(btScalar(0.1), btScalar(0.1));
            bullet::Member member(body, of, btTransform(btQuaternion::getIdentity(), {0, 0, -1}));
            world.add(member);
            body.setAngularVelocity({1, 10, 20});
            double left_over = 0;
            for (int i = 0; i < 60; ++i) {
                world.step(1.0 / 60);
                left_over = std::max(left_over, member.left_over());
            }
            CAPTURE(tolerance, inertia_share, left_over);
            CHECK(left_over > 0); // it was looked at
            // of moments of some 0.3 N m s, the round-off of an angular momentum of 70
            CHECK(left_over < (rough ? 1e-3 : 1e-9));
            CHECK(member.absorbed_energy() == 0);
        }
    }
}

TEST_CASE("pieces behave as the body did, and it comes back bent", "[bullet][member]") {
    BallOnPost scene(heavy_post(), 100, 2);
    btRigidBody& body = *scene.post->pieces().front();
    int mine = 0;
    body.setUserPointer(&mine);
    body.setUserIndex(7);
    body.setFriction(btScalar(0.25));
    bool opened = false;
    for (int i = 0; i < 200; ++i) {
        scene.world.step(1.0 / 240);
        if (scene.post->whole()) continue;
        opened = true;
        CHECK(body.getBroadphaseHandle() == nullptr);
        for (const btRigidBody* piece : scene.post->pieces()) {
            CHECK(piece->getUserPointer() == &mine);
            CHECK(piece->getUserIndex() == 7);
            CHECK(piece->getFriction() == btScalar(0.25));
            CHECK(piece->getBroadphaseHandle()->m_collisionFilterGroup == usual);
            CHECK(bullet::Member::of(piece) == scene.post.get());
        }
    }
    CHECK(opened);
    REQUIRE(scene.post->whole());
    CHECK(scene.post->pieces() == std::vector<btRigidBody*>{&body});
    CHECK(body.getBroadphaseHandle() != nullptr);
    CHECK(body.isStaticObject());
    const auto& shape = dynamic_cast<const btCompoundShape&>(*body.getCollisionShape());
    // a box for each stretch between two bends, where its segments are
    int bends = 0, last = 0;
    for (int i = 1; i < 10; ++i) {
        if (std::abs(scene.post->bend(i)) < 1e-6) continue;
        ++bends;
        last = i;
    }
    REQUIRE(shape.getNumChildShapes() == bends + 1);
    const btTransform end = scene.post->pose(10), after = scene.post->pose(last + 1);
    CHECK(((body.getWorldTransform() * shape.getChildTransform(bends)).getOrigin() -
           (end.getOrigin() + after.getOrigin()) / 2)
              .length() < 1e-5);
    CHECK(end.getOrigin().y() > 0.2);
    CHECK(bullet::Member::of(scene.ball) == nullptr);
}

TEST_CASE("what a member cannot be made of is said, and nothing is changed", "[bullet][member]") {
    Rig rig;
    World world(rig.engine, {.warn = {}});
    const Member clamped = strip(4), free_bar = strip(4, false);
    btRigidBody& still = rig.body(0, {0, 0, 0}, {0, 0, 0});
    btRigidBody& moving = rig.body(2, {1, 1, 1}, {0, 0, 0});
    const btTransform middle(btQuaternion::getIdentity(), {0, 0, btScalar(-0.5)});
    CHECK(message_of([&] { bullet::Member(still, free_bar, middle); }) ==
          "Member.body: must move where the member is not clamped");
    CHECK(message_of([&] { bullet::Member(moving, clamped, here); }) ==
          "Member.body: must be static for a clamped member");
    btRigidBody& light = rig.body(1, {1, 1, 1}, {0, 0, 0});
    CHECK(message_of([&] { bullet::Member(light, free_bar, middle); }) ==
          "Member.body.mass = 1 kg: must be that of the member, 2 kg");
    CHECK(message_of([&] { bullet::Member(moving, free_bar, here); }) ==
          "Member.start_in_body = 0.5 m: must be 0: the member's centre is to be the body's");
    const btTransform scaled(btMatrix3x3(2, 0, 0, 0, 2, 0, 0, 0, 2), middle.getOrigin());
    CHECK(message_of([&] { bullet::Member(moving, free_bar, scaled); }) ==
          "Member.start_in_body.axes: must be three orthonormal columns, right-handed");
    CHECK(message_of([&] {
              bullet::Member(moving, free_bar, middle, {-1, 1});
          }) == "Member.box.half_width = -1 m: must be in (0, 1) m");
    btRigidBody& driven = rig.body(0, {0, 0, 0}, {0, 0, 0});
    driven.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    CHECK(message_of([&] { bullet::Member(driven, clamped, here); }) ==
          "Member.body: must not be kinematic");

    bullet::Member member(moving, free_bar, middle);
    CHECK(message_of([&] { bullet::Member(moving, free_bar, middle); }) ==
          "Member.body: must not be a member already");
    CHECK(message_of([&] { member.attach(1.5, {}); }) ==
          "Member.attach.place = 1.5 m: must be in [0, 1] m");
    CHECK(message_of([&] {
              member.apply_force({1, 0, 0}, -1);
          }) == "Member.apply_force.place = -1 m: must be in [0, 1] m");
    CHECK(message_of([&] {
              member.apply_force({0, NAN, 0}, 0.5);
          }) == "Member.apply_force.force = nan N: must be finite");
    CHECK(message_of([&] {
              member.apply_force({0, btScalar(rough ? 1e30 : 1e160), 0}, 0.5);
          }) == (rough ? "nothing thrown"
                       : "Member.apply_force.force = 1e+160 N: must be at most 1e+100 in size"));
    btPoint2PointConstraint pin(moving, {0, 0, 0});
    rig.engine.addConstraint(&pin);
    CHECK(message_of([&] { world.add(member); }).find("Member::attach") != std::string::npos);
    rig.engine.removeConstraint(&pin);
    rig.engine.removeRigidBody(&moving);
    CHECK(message_of([&] { world.add(member); }).find("addRigidBody it") != std::string::npos);
    rig.engine.addRigidBody(&moving);
    Rig other;
    World of_another(other.engine, {.warn = {}});
    CHECK(message_of([&] { of_another.add(member); }).find("addRigidBody it") != std::string::npos);
    world.add(member);
    CHECK(message_of([&] { world.add(member); }) ==
          "World.add.member: must not be in a world already");
    CHECK_THROWS_WITH(member.attach(0.5, {}),
                      "Member.attach: must be called before the member is in a World");
    world.step(1e-3);
}

TEST_CASE("a member, its world and its body may end in any order", "[bullet][member]") {
    for (const bool world_first : {false, true}) {
        Rig rig;
        auto world = std::make_unique<World>(rig.engine, WorldParameters{.warn = {}});
        btRigidBody& mass = rig.body(1, {1, 1, 1}, {0, 0, 1});
        auto member =
            std::make_unique<bullet::Member>(rig.body(0, {0, 0, 0}, {0, 0, 0}), strip(5), here);
        member->attach(1, [&mass](btRigidBody& piece, const btTransform& place) {
            return std::make_unique<btPoint2PointConstraint>(piece, mass, place.getOrigin(),
                                                             btVector3(0, 0, 0));
        });
        world->add(*member);
        mass.setLinearVelocity({0, 4, 0});
        for (int i = 0; i < 20; ++i) world->step(1e-3);
        CHECK_FALSE(member->whole());
        if (world_first) {
            world.reset();
            CHECK(member->absorbed_energy() > 0);
            CHECK(member->whole()); // bent as it is
            CHECK(member->pose(5).getOrigin().y() > 0);
            World another(rig.engine, {.warn = {}});
            another.add(*member);
            another.step(1e-3);
            member.reset();
        } else {
            member.reset();
            world->step(1e-3);
            world.reset();
        }
        CHECK(rig.engine.getNumConstraints() == 0);
        CHECK(rig.engine.getNumCollisionObjects() == 2);
        rig.engine.stepSimulation(btScalar(1e-3), 0);
    }
}

TEST_CASE("a bent member that is given its straight state has its own body again",
          "[bullet][member]") {
    BallOnPost scene(heavy_post(), 100, 2);
    btRigidBody& body = *scene.post->pieces().front();
    const btCollisionShape* own = body.getCollisionShape();
    const bullet::MemberSnapshot straight_one(*scene.post);
    scene.go(1, 1.0 / 240);
    REQUIRE(scene.post->whole());
    CHECK(body.getCollisionShape() != own);
    const bullet::MemberSnapshot bent(*scene.post);
    const btVector3 end = scene.post->pose(10).getOrigin();
    straight_one.put_back(*scene.post);
    CHECK(body.getCollisionShape() == own);
    CHECK(scene.post->absorbed_energy() == 0);
    CHECK(scene.post->pose(10).getOrigin().y() == 0);
    bent.put_back(*scene.post);
    CHECK((scene.post->pose(10).getOrigin() - end).length() < 1e-6);
    CHECK(scene.post->absorbed_energy() > 10);
}

TEST_CASE("what is done to a member in a world that it cannot bear is said, and nothing is lost",
          "[bullet][member]") {
    Struck scene(strip(5), true);
    btRigidBody& body = *scene.member->pieces().front();
    Struck other(strip(4), true);
    const bullet::MemberSnapshot of_other(*other.member);
    CHECK(message_of([&] { of_other.put_back(*scene.member); }) ==
          "MemberSnapshot.member.sections = 5: must be 4, as of the member that was saved");
    // a constraint that came after the member: its body must not leave the world with it
    btPoint2PointConstraint pin(body, {0, 0, 0});
    scene.rig.engine.addConstraint(&pin);
    scene.strike(4);
    std::string said;
    for (int i = 0; i < 20 && said.empty(); ++i) {
        said = message_of([&] { scene.world.step(1e-3); });
    }
    CHECK(said.find("Member::attach") != std::string::npos);
    CHECK(scene.member->whole());
    CHECK(body.getBroadphaseHandle() != nullptr);
    scene.rig.engine.removeConstraint(&pin);
    for (int i = 0; i < 100; ++i) scene.world.step(1e-3);
    CHECK(scene.member->absorbed_energy() > 5);
    // a body that was taken out of the world
    CHECK(scene.member->whole());
    scene.rig.engine.removeRigidBody(&body);
    CHECK_THROWS_WITH(scene.world.step(1e-3), "Member.body: must be in the world: addRigidBody it");
    scene.rig.engine.addRigidBody(&body);
    scene.world.step(1e-3);
}

TEST_CASE("what is thrown and hangs on two elastic posts is borne by both", "[bullet][member]") {
    // 100 J, 50 for each: what either bears is M_p² l/(6 EI) = 70 J; of a body of no more mass than
    // they have their waves may let some of that flow
    MemberParameters p;
    p.segments = lumped_segments(2, 24, 10, {1e-5, 1e-5, 2e-5});
    p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.sections.assign(10, UsualAxisJoint(Perfect<double>({.strength = 500})));
    p.bending_stiffness = 500.0 * 500 * 2 / (6 * 70);
    const Member of(p);
    for (const auto& [frame, mass] : {std::pair{1.0 / 30, 1000.0}, std::pair{1.0 / 60, 1000.0},
                                      std::pair{1.0 / 240, 1000.0}, std::pair{1.0 / 60, 50.0}}) {
        Scene scene({0, 0, 0}, 0.01, 0);
        btRigidBody& body = scene.rig.body(mass, {0.5f, 0.5f, 0.5f}, {0, 0, 2});
        std::vector<std::unique_ptr<bullet::Member>> posts;
        for (const btScalar x : {btScalar(-0.5), btScalar(0.5)}) {
            const btVector3 none(0, 0, 0);
            posts.push_back(
                std::make_unique<bullet::Member>(scene.rig.body(0, none, {x, 0, 0}), of, here));
            posts.back()->attach(2, [&body, x](btRigidBody& piece, const btTransform& at) {
                return std::make_unique<btPoint2PointConstraint>(piece, body, at.getOrigin(),
                                                                 btVector3(x, 0, 0));
            });
            scene.world.add(*posts.back());
        }
        body.setLinearVelocity({0, btScalar(std::sqrt(200 / mass)), 0});
        scene.go(0.2, frame);
        CAPTURE(frame, mass);
        for (const auto& post : posts) CHECK(post->absorbed_energy() == 0);
        CHECK(scene.world.run().believed() == (mass > 100));
    }
}
