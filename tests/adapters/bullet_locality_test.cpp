// SPDX-License-Identifier: MIT
//
// Frames with a tolerance in Bullet do again what is in trouble alone, and save nothing where
// nothing happens.
#include <btBulletDynamicsCommon.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adapters/bullet_engine.hpp"
#include "core/member/strips.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/members.hpp"
#include "ductile/bullet/world_parts.hpp"
#include "support/bit_hash.hpp"

namespace {

using namespace ductile;
using bullet::World;
using bullet::WorldParameters;
using Law = OneAxisJoint<Perfect<double>>;
using Hinge = bullet::PlasticHinge<Law>;

constexpr bool rough = sizeof(btScalar) == sizeof(float);
constexpr double frame = 1.0 / 60;

[[nodiscard]] Law law(double strength) { return Law(Perfect<double>({.strength = strength})); }
[[nodiscard]] btTransform at(const btVector3& origin) {
    btTransform result;
    result.setIdentity();
    result.setOrigin(origin);
    return result;
}

/// A world on a floor.
struct Site : test::BulletEngine {
    std::vector<std::unique_ptr<Hinge>> hinges;
    std::unique_ptr<World> world;

    Site() : BulletEngine({0, btScalar(-9.81), 0}) {
        engine.getSolverInfo().m_splitImpulsePenetrationThreshold = 1;
        body(std::make_unique<btBoxShape>(btVector3(200, 1, 200)), 0, {0, -1, 0});
    }
    ~Site() {
        hinges.clear();
        world.reset();
    }

    void look_after(const WorldParameters& parameters = {
                        .tolerance = 0.01, .rest_damping = 0, .warn = {}}) {
        world = std::make_unique<World>(engine, parameters);
        for (auto& hinge : hinges) world->add(*hinge);
    }
    btRigidBody& body(std::unique_ptr<btCollisionShape> shape, double mass,
                      const btVector3& place) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
        shapes.push_back(std::move(shape));
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shapes.back().get(),
                                                      inertia);
        info.m_startWorldTransform = at(place);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        if (mass > 0) bodies.back()->setActivationState(DISABLE_DEACTIVATION);
        engine.addRigidBody(bodies.back().get());
        return *bodies.back();
    }
    /// Five pieces on hinges, 2 m high.
    std::vector<btRigidBody*> post(const btVector3& foot, double strength = 4000) {
        std::vector<btRigidBody*> pieces;
        for (int i = 0; i < 5; ++i) {
            btRigidBody& piece = body(std::make_unique<btBoxShape>(
                                          btVector3(btScalar(0.05), btScalar(0.2), btScalar(0.05))),
                                      12, foot + btVector3(0, btScalar(0.25 + 0.4 * i), 0));
            const btVector3 low(0, btScalar(-0.2), 0), high(0, btScalar(0.2), 0);
            hinges.push_back(i == 0 ? std::make_unique<Hinge>(piece, at(low), law(strength))
                                    : std::make_unique<Hinge>(piece, *pieces.back(), at(low),
                                                              at(high), law(strength)));
            pieces.push_back(&piece);
        }
        return pieces;
    }
    btRigidBody& ball(const btVector3& place, const btVector3& velocity) {
        btRigidBody& made = body(std::make_unique<btSphereShape>(btScalar(0.2)), 100, place);
        made.setGravity({0, 0, 0});
        made.setLinearVelocity(velocity);
        return made;
    }
    [[nodiscard]] double work() const {
        double sum = 0;
        for (const auto& hinge : hinges) sum += hinge->absorbed_energy();
        return sum;
    }
};

/// A site's frames of one part, each looked at for what may have to be put back.
struct Looked {
    Site& site;
    bullet::FrontHold front{site.engine};
    bullet::EnergyMeter meter{site.engine};
    std::unique_ptr<bullet::Divisibles> members = std::make_unique<bullet::Divisibles>();
    bullet::WorldParts parts{
        site.engine,  front, meter, members, [](const bullet::PlasticConstraint&) { return 0u; },
        [](double) {}};

    explicit Looked(Site& of) : site(of) {
        for (auto& hinge : site.hinges) {
            hinge->add_to(site.engine);
            hinge->set_ahead(true);
        }
    }
    ~Looked() {
        for (auto& hinge : site.hinges) hinge->remove_from(site.engine);
    }
    Looked(const Looked&) = delete;
    Looked& operator=(const Looked&) = delete;

    [[nodiscard]] bool at_risk() {
        parts.begin(frame);
        (void)parts.closing(frame, 1e-9, 1e-9);
        const bool risk = parts.may_be_put_back();
        (void)parts.part(frame);
        parts.end();
        return risk;
    }
};

} // namespace

TEST_CASE("Locality: what stands is not saved, and what somebody does to it is seen", "[frame]") {
    Site site;
    const auto pieces = site.post({0, 0, 0});
    Looked looked(site);
    const auto at_risk = [&looked] { return looked.at_risk(); };
    CHECK(at_risk()); // nothing is known of it
    for (int i = 0; i < 10; ++i) CHECK_FALSE(at_risk());
    pieces[4]->setLinearVelocity({btScalar(1e-6), 0, 0});
    CHECK(at_risk());
    for (int i = 0; i < 3; ++i) (void)at_risk();
    CHECK_FALSE(at_risk());
    pieces[4]->applyCentralForce({1, 0, 0});
    CHECK(at_risk());
    CHECK(at_risk()); // it ended
    CHECK_FALSE(at_risk());
    pieces[4]->setGravity({0, -9, 0});
    CHECK(at_risk());
    CHECK_FALSE(at_risk());
    btRigidBody& ball = site.ball({-1, btScalar(1.9), 0}, {50, 0, 0});
    CHECK(at_risk()); // it would be there within the frame
    site.engine.removeRigidBody(&ball);
    site.bodies.pop_back();
}

TEST_CASE("Locality: a motor beside a plastic joint is a risk, one far away is none", "[frame]") {
    Site site;
    const auto pieces = site.post({0, 0, 0});
    btRigidBody& far = site.body(std::make_unique<btSphereShape>(btScalar(0.1)), 1, {9, 1, 0});
    btHingeConstraint motor(far, btVector3(0, 0, 0), btVector3(0, 0, 1));
    site.engine.addConstraint(&motor);
    Looked looked(site);
    const auto at_risk = [&looked] { return looked.at_risk(); };
    for (int i = 0; i < 3; ++i) (void)at_risk();
    CHECK_FALSE(at_risk());
    btHingeConstraint near(*pieces[4], btVector3(0, btScalar(0.2), 0), btVector3(0, 0, 1));
    site.engine.addConstraint(&near);
    for (int i = 0; i < 3; ++i) CHECK(at_risk());
    site.engine.removeConstraint(&near);
    site.engine.removeConstraint(&motor);
}

TEST_CASE("Locality: what hands and forces do to what stood is as exact as ever", "[frame]") {
    // a rotor that stood ten frames is pushed by hand, then by a moment beyond its strength
    constexpr double inertia = 2, spin = 7, strength = 40;
    Site site;
    btRigidBody& rotor = site.body(std::make_unique<btSphereShape>(btScalar(0.1)), 1, {0, 5, 0});
    rotor.setGravity({0, 0, 0});
    rotor.setMassProps(1, btVector3(inertia, inertia, inertia));
    site.hinges.push_back(std::make_unique<Hinge>(rotor, at({0, 0, 0}), law(strength)));
    site.look_after();
    Hinge& hinge = *site.hinges.back();
    for (int i = 0; i < 10; ++i) site.world->step(frame);
    rotor.setAngularVelocity({0, 0, btScalar(spin)});
    for (int i = 0; i < 40; ++i) site.world->step(frame);
    const double energy = inertia * spin * spin / 2;
    CHECK(hinge.absorbed_energy() == Approx(energy).epsilon(rough ? 1e-4 : 1e-9));
    for (int i = 0; i < 10; ++i) site.world->step(frame);
    // 2 M for a frame, and to rest again: θ = M t²/(2 I) + the same
    rotor.applyTorque({0, 0, btScalar(2 * strength)});
    for (int i = 0; i < 10; ++i) site.world->step(frame);
    const double travel = 2 * strength * frame * frame / (2 * inertia);
    CHECK(hinge.absorbed_energy() ==
          Approx(energy + strength * travel).epsilon(rough ? 1e-4 : 1e-9));
    CHECK(site.world->run().believed());
    CHECK(std::abs(site.world->ledger().unexplained()) < (rough ? 1e-3 : 1e-9) * energy);
}

namespace {

/// Of places and velocities, bit by bit.
[[nodiscard]] std::uint64_t hash_of(const std::vector<btRigidBody*>& bodies) {
    test::BitHash bits;
    for (const btRigidBody* body : bodies) {
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < 3; ++j)
                bits.eat(double(body->getWorldTransform().getBasis()[k][j]));
            bits.eat(double(body->getWorldTransform().getOrigin()[k]));
            bits.eat(double(body->getLinearVelocity()[k]));
            bits.eat(double(body->getAngularVelocity()[k]));
        }
    }
    return bits.value();
}

/// A post, a ball, and boxes in stacks of four that slide a little.
struct Scene : Site {
    std::vector<btRigidBody*> others, mine;
    int events = 0, worst = 0;

    Scene(int boxes, bool struck) {
        for (int i = 0; i < boxes; ++i) {
            const int stack = i / 4;
            others.push_back(
                &body(std::make_unique<btBoxShape>(
                          btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))),
                      100,
                      {btScalar(4 + 1.5 * (stack % 16)), btScalar(0.5 + 1.02 * (i % 4)),
                       btScalar(4 + 1.5 * (stack / 16))}));
            others.back()->setLinearVelocity({btScalar(0.1) * btScalar(i % 3), 0, 0});
        }
        mine = post({0, 0, 0});
        // nobody is there where it waits
        mine.push_back(&ball({btScalar(-0.6), btScalar(struck ? 1.9 : 50), 0},
                             {btScalar(struck ? 5 : 0), 0, 0}));
        look_after();
        world->on_event([this](const auto& event) { events += event.kind == EventKind::yielded; });
    }
    void step() {
        world->step(frame);
        worst = std::max(worst, world->frame().solves());
    }
    /// A box of 2 m that stands there for good.
    btRigidBody& foot(const btVector3& place) {
        auto around = std::make_unique<btCompoundShape>();
        shapes.push_back(
            std::make_unique<btBoxShape>(btVector3(btScalar(0.05), btScalar(1), btScalar(0.05))));
        around->addChildShape(at({0, 1, 0}), shapes.back().get());
        return body(std::move(around), 0, place);
    }
    /// It as a clamped member, not in the world yet.
    [[nodiscard]] std::unique_ptr<bullet::Member> member_on(const btVector3& place) {
        const btTransform upright(btQuaternion(btVector3(1, 0, 0), btScalar(-std::acos(-1.0) / 2)));
        return std::make_unique<bullet::Member>(foot(place), test::heavy_post(10, 4000), upright,
                                                MemberBox{0.05, 0.05});
    }
};

} // namespace

TEST_CASE("Locality: others keep their bits while a member is open", "[frame][member]") {
    /// Boxes as in a Scene, and a clamped post that is one body until it is
    /// struck.
    struct WithMember : Scene {
        std::unique_ptr<bullet::Member> member;
        btRigidBody* far;

        WithMember(int boxes, bool struck) : Scene(boxes, false) {
            member = member_on({0, 0, -9});
            far = &ball({0, btScalar(struck ? 1.9 : 60), btScalar(-9.6)},
                        {0, 0, btScalar(struck ? 5 : 0)});
            world->add(*member);
        }
        ~WithMember() { member.reset(); }
    };
    WithMember struck(200, true), quiet(200, false);
    int differ = 0, open = 0;
    for (int i = 0; i < 60; ++i) {
        struck.step();
        quiet.step();
        differ += hash_of(struck.others) != hash_of(quiet.others);
        open += !struck.member->whole();
    }
    CHECK(differ == 0);
    CHECK(open > 3);
    CHECK(struck.worst > 4);
    CHECK(struck.member->absorbed_energy() > 500);
    CHECK(quiet.member->absorbed_energy() == 0);
    CHECK(std::abs(struck.world->ledger().unexplained()) < (rough ? 2 : 1e-6));
}

TEST_CASE("Locality: what a member meets within the frame comes along", "[frame][member]") {
    // a bar that a ball sends into a box that stands a metre behind it
    for (const double step : {1.0 / 30, 1.0 / 240}) {
        std::vector<double> ends;
        for (const int boxes : {0, 200}) {
            Scene scene(boxes, false);
            const Member of = test::free_bar();
            const MemberPiece whole = make_piece(of, straight(of), {0, of.segments() - 1});
            btRigidBody& bar = scene.body(
                std::make_unique<btBoxShape>(btVector3(btScalar(0.05), btScalar(0.05), 1)),
                of.mass(), {0, btScalar(20), -9});
            bar.setMassProps(btScalar(of.mass()), bullet::to_bullet(whole.inertia));
            bar.setGravity({0, 0, 0});
            bullet::Member member(bar, of, at({0, 0, -1}), MemberBox{0.05, 0.05});
            scene.world->add(member);
            btRigidBody& ball = scene.ball({0, btScalar(19.6), -9}, {0, 8, 0});
            btRigidBody& wall = scene.ball({0, btScalar(20.35), btScalar(-8.1)}, {0, 0, 0});
            for (btRigidBody* each : {&bar, &ball, &wall}) each->setFriction(0);
            for (int i = 0; i < int(0.25 / step); ++i) scene.world->step(step);
            CHECK(wall.getLinearVelocity().y() > btScalar(0.3));
            ends.push_back(member.absorbed_energy());
        }
        CAPTURE(step, ends[0], ends[1]);
        CHECK(ends[0] > 10);
        CHECK(ends[1] == Approx(ends[0]).epsilon(0.01));
    }
}

TEST_CASE("Locality: a second post that is struck within the frame takes what it takes alone",
          "[frame][member]") {
    // 400 kg go from one post to the next in a part of a frame
    const auto absorbed = [](int boxes, int standing) {
        Scene scene(boxes, false);
        std::vector<std::unique_ptr<bullet::Member>> posts;
        for (const double z : {-9.0, -8.8}) {
            posts.push_back(scene.member_on({0, 0, btScalar(z)}));
            scene.world->add(*posts.back());
        }
        for (int i = 0; i < standing; ++i) scene.foot({btScalar(100 + i), 0, 0});
        btRigidBody& ball = scene.ball({0, btScalar(1.9), btScalar(-9.6)}, {0, 0, 15});
        ball.setMassProps(400, ball.getLocalInertia());
        for (int i = 0; i < 3; ++i) scene.world->step(1.0 / 30);
        std::vector<double> result;
        for (const auto& post : posts) result.push_back(post->absorbed_energy());
        return result;
    };
    const std::vector<double> alone = absorbed(0, 0);
    CHECK(alone[0] > 100);
    CHECK(alone[1] > 100);
    for (const auto& among : {absorbed(200, 0), absorbed(0, 200)}) {
        CHECK(among[0] == Approx(alone[0]).epsilon(rough ? 0.02 : 1e-6));
        CHECK(among[1] == Approx(alone[1]).epsilon(rough ? 0.02 : 1e-6));
    }
}

TEST_CASE("Locality: a listener may take a body out while others stand aside", "[frame][member]") {
    for (const bool few : {false, true}) { // some of many that move; all that moves of what stands
        Scene scene(few ? 0 : 200, false);
        for (int i = 0; few && i < 200; ++i) {
            scene.body(std::make_unique<btBoxShape>(btVector3(1, 1, 1)), 0,
                       {btScalar(100 + 3 * i), 1, 0});
        }
        const std::unique_ptr<bullet::Member> made = scene.member_on({0, 0, -9});
        bullet::Member& post = *made;
        scene.world->add(post);
        btRigidBody& ball = scene.ball({0, btScalar(1.9), btScalar(-9.6)}, {0, 0, 5});
        scene.world->on_event([&](const auto& event) {
            if (event.kind == EventKind::split && ball.isInWorld()) {
                scene.engine.removeRigidBody(&ball);
            }
        });
        for (int i = 0; i < 30; ++i) scene.world->step(frame);
        CHECK_FALSE(ball.isInWorld());
        CHECK(post.whole());
        CHECK(post.absorbed_energy() > 1);
        CHECK(scene.world->time() == Approx(30 * frame));
    }
}

TEST_CASE("Locality: a frame that throws leaves all at one time", "[frame][member]") {
    // a listener's word as a section splits, or who makes what hangs on the member then
    for (const bool by_maker : {false, true}) {
        CAPTURE(by_maker);
        Scene scene(200, false);
        const std::unique_ptr<bullet::Member> made = scene.member_on({0, 0, -9});
        bullet::Member& post = *made;
        bool armed = true;
        btRigidBody& lamp = scene.ball({0, btScalar(2.3), btScalar(-9)}, {0, 0, 0});
        post.attach(2, [&](btRigidBody& piece, const btTransform& place) {
            if (by_maker && armed && post.open_sections() > 0) {
                armed = false;
                throw std::runtime_error("of the maker");
            }
            return std::make_unique<btPoint2PointConstraint>(piece, lamp, place.getOrigin(),
                                                             btVector3(0, btScalar(-0.3), 0));
        });
        scene.world->add(post);
        scene.world->on_event([&](const auto& event) {
            if (by_maker || event.kind != EventKind::split || !std::exchange(armed, false)) return;
            throw std::runtime_error("of the listener");
        });
        scene.ball({0, btScalar(1.2), btScalar(-9.6)}, {0, 0, 5});
        btRigidBody& far = scene.ball({0, 40, 0}, {3, 0, 0});
        int frames = 0;
        std::string word;
        double way = 0;
        for (; frames < 20 && word.empty(); ++frames) {
            const double from = double(far.getCenterOfMassPosition().x());
            try {
                scene.world->step(frame);
            } catch (const std::runtime_error& error) {
                word = error.what();
            }
            way = double(far.getCenterOfMassPosition().x()) - from;
        }
        CHECK(word == (by_maker ? "of the maker" : "of the listener"));
        // until the ball touches the post: 0.35 m
        const double within = 0.35 / 5 - frame * (frames - 1);
        CHECK(within > 0.1 * frame);
        CHECK(within < 0.9 * frame);
        CHECK(way == Approx(3 * within).epsilon(1e-3));
        for (int i = 0; i < 30; ++i) scene.world->step(frame);
        CHECK(post.absorbed_energy() > 500);
        CHECK(std::abs(scene.world->ledger().unexplained()) < (rough ? 2 : 1e-6));
    }
}

TEST_CASE("Locality: others keep their bits while one island is done in parts", "[frame]") {
    Scene struck(200, true), quiet(200, false);
    int differ = 0;
    for (int i = 0; i < 60; ++i) {
        struck.step();
        quiet.step();
        differ += hash_of(struck.others) != hash_of(quiet.others);
    }
    CHECK(differ == 0);
    CHECK(struck.worst > 4);
    CHECK(quiet.worst == 1);
    CHECK(std::abs(struck.world->ledger().unexplained()) < (rough ? 2 : 1e-6));
}

TEST_CASE("Locality: a post among a thousand boxes takes what it takes alone", "[frame]") {
    Scene alone(0, true), among(1000, true);
    int differ = 0;
    for (int i = 0; i < 60; ++i) {
        alone.step();
        among.step();
        differ += hash_of(alone.mine) != hash_of(among.mine);
    }
    CHECK(alone.work() > 1000);
    CHECK(among.work() == alone.work());
    CHECK(differ == 0);
    CHECK(among.world->run().parts == alone.world->run().parts);
    CHECK(among.world->run().left.energy == alone.world->run().left.energy);
    if (!rough) CHECK(among.world->run().believed());
    CHECK(among.events == alone.events); // once each, however often a part was done
    CHECK(among.world->ledger().booked(Account::plastic) ==
          Approx(alone.work()).epsilon(rough ? 1e-5 : 1e-9));
    CHECK(std::abs(among.world->ledger().unexplained()) < (rough ? 20 : 1e-6));
}

namespace {

/// With one of these all is done again.
struct Nothing final : btActionInterface {
    void updateAction(btCollisionWorld*, btScalar) override {}
    void debugDraw(btIDebugDraw*) override {}
};

/// A bar that turns about z on a weak hinge and meets a box late in a frame, among others.
struct MeetingSites : Site {
    Nothing nothing;
    btRigidBody* beside = nullptr;
    std::vector<btRigidBody*> others;
    int events = 0;

    /// `speed`: of the box, against the bar [m/s].
    MeetingSites(bool local, bool asleep, double speed) {
        engine.setGravity({0, 0, 0});
        if (!local) engine.addAction(&nothing);
        const auto block = [this](const btVector3& place) {
            others.push_back(&body(std::make_unique<btBoxShape>(
                                       btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))),
                                   20, place));
            return others.back();
        };
        btRigidBody& bar = body(
            std::make_unique<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.02), btScalar(0.05))),
            10, {btScalar(0.5), 5, 0});
        hinges.push_back(std::make_unique<Hinge>(bar, at({btScalar(-0.5), 0, 0}), law(20)));
        beside = block({btScalar(0.9), btScalar(5.25), 0});
        for (int i = 0; i < 60; ++i) {
            block({btScalar(6 + 2 * (i % 8)), 1, btScalar(4 + 2 * (i / 8))});
        }
        look_after();
        world->on_event([this](const auto& event) { events += event.kind == EventKind::yielded; });
        for (int i = 0; i < 3; ++i) world->step(frame);
        if (asleep) {
            for (btRigidBody* body : others) body->forceActivationState(ISLAND_SLEEPING);
        }
        beside->setLinearVelocity({0, btScalar(-speed), 0});
        bar.setAngularVelocity({0, 0, 10}); // its tip is there after 0.014 s
        bar.setLinearVelocity({0, 5, 0});
        for (int i = 0; i < 10; ++i) world->step(frame);
    }
    ~MeetingSites() { engine.removeAction(&nothing); }
};

} // namespace

TEST_CASE("Locality: islands that meet are one from then on", "[frame]") {
    for (const double speed : {-1.0, 0.0, 2.0}) {
        for (const bool asleep : {false, true}) {
            if (asleep && speed != 0) continue;
            CAPTURE(speed, asleep);
            const MeetingSites local(true, asleep, speed), all(false, asleep, speed);
            CHECK(all.work() > 4);
            CHECK(local.work() == Approx(all.work()).epsilon(rough ? 1e-2 : 1e-3));
            CHECK(double(all.beside->getLinearVelocity().y()) + speed > 1);
            CHECK(double(local.beside->getLinearVelocity().y()) ==
                  Approx(double(all.beside->getLinearVelocity().y())).epsilon(rough ? 1e-2 : 1e-3));
            CHECK(local.events == 1);
            CHECK(local.world->run().believed() == all.world->run().believed());
            CHECK(std::abs(local.world->ledger().unexplained()) < (rough ? 1e-2 : 1e-9));
            for (std::size_t i = 1; i < local.others.size(); ++i) {
                CHECK(local.others[i]->isActive() != asleep);
            }
        }
    }
}

TEST_CASE("Locality: an island that is met within a frame, unforeseen, comes along", "[frame]") {
    // a ball comes to a bar early in a frame and turns it, before its end, into a block that sleeps
    // higher up
    struct Struck : Site {
        Nothing nothing;
        btRigidBody* block = nullptr;
        std::vector<btRigidBody*> far;
        explicit Struck(bool local) {
            engine.setGravity({0, 0, 0});
            if (!local) engine.addAction(&nothing);
            const auto add = [this](const btVector3& place) {
                const btVector3 half(btScalar(0.1), btScalar(0.1), btScalar(0.1));
                return &body(std::make_unique<btBoxShape>(half), 20, place);
            };
            btRigidBody& bar =
                body(std::make_unique<btBoxShape>(btVector3(btScalar(0.05), 1, btScalar(0.05))), 24,
                     {0, 3, 0});
            hinges.push_back(std::make_unique<Hinge>(bar, at({0, -1, 0}), law(4000)));
            block = add({btScalar(0.25), btScalar(3.85), 0});
            for (int i = 0; i < 60; ++i) {
                far.push_back(add({btScalar(6 + 2 * (i % 8)), 1, btScalar(4 + 2 * (i / 8))}));
            }
            look_after();
            block->forceActivationState(ISLAND_SLEEPING);
            for (btRigidBody* body : far) body->forceActivationState(ISLAND_SLEEPING);
            for (int i = 0; i < 3; ++i) world->step(frame);
            ball({btScalar(-0.28), btScalar(3.2), 0}, {20, 0, 0});
            world->step(frame);
        }
        ~Struck() { engine.removeAction(&nothing); }
    };
    const Struck local(true), all(false);
    CHECK(all.work() > 1);
    CHECK(double(all.block->getLinearVelocity().x()) > 1);
    CHECK(double(local.block->getLinearVelocity().x()) ==
          Approx(double(all.block->getLinearVelocity().x())).epsilon(0.01));
    CHECK(local.work() == Approx(all.work()).epsilon(0.01));
    for (const btRigidBody* body : local.far) CHECK_FALSE(body->isActive());
    CHECK(std::abs(all.world->ledger().unexplained()) < (rough ? 5 : 1e-6));
    CHECK(std::abs(local.world->ledger().unexplained()) < (rough ? 5 : 1e-6));
}
