// SPDX-License-Identifier: MIT
//
// Frames with a tolerance in ODE do in parts what hangs on plastic joints alone: all others go
// through the frame once. Where all stands the frame is looked at once, and nothing is kept.
#include <ode/ode.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "adapters/ode_engine.hpp"
#include "core/member/strips.hpp"
#include "ductile/ode/members.hpp"
#include "ductile/ode/ode.hpp"
#include "support/bit_hash.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;
using Hinge = ode::PlasticHinge<Law>;

constexpr double frame = 1.0 / 60;

/// A floor in a world of frames; contacts are counted by whom they are of.
struct Site {
    test::OdeEngine engine;
    std::optional<ode::World> world;
    std::vector<std::unique_ptr<Hinge>> hinges;
    std::unique_ptr<ode::Member> member;
    std::vector<dBodyID> mine, others;
    int looks = 0;           ///< for contacts
    int looks_at_others = 0; ///< pairs of geoms that ODE's space found near each other
    int worst = 0;           ///< solves of a frame
    double gained = 0;       ///< most that a frame leaves unexplained [J]

    explicit Site(ode::Solver solver = ode::Solver::direct, bool hashed = true,
                  double gravity = 9.81)
        : engine(hashed) {
        dWorldSetGravity(engine.id, 0, dReal(-gravity), 0);
        dCreatePlane(engine.space, 0, 1, 0, 0);
        world.emplace(engine.id,
                      ode::WorldParameters{
                          .solver = solver, .tolerance = 0.01, .rest_damping = 0, .warn = nullptr});
        world->on_contacts({.space = engine.space, .group = engine.contacts}, [this] {
            ++looks;
            dSpaceCollide(engine.space, this, &Site::near);
        });
    }

    dBodyID box(double mass, const Vector3<double>& half, const Vector3<double>& at) {
        const auto side = [&half](int k) { return dReal(2 * half[k]); };
        dMass inertia;
        dMassSetBoxTotal(&inertia, dReal(mass), side(0), side(1), side(2));
        return body(inertia, dCreateBox(engine.space, side(0), side(1), side(2)), at);
    }
    dBodyID ball(double mass, double radius, const Vector3<double>& at,
                 const Vector3<double>& velocity) {
        dMass inertia;
        dMassSetSphereTotal(&inertia, dReal(mass), dReal(radius));
        const dBodyID made = body(inertia, dCreateSphere(engine.space, dReal(radius)), at);
        dBodySetLinearVel(made, dReal(velocity.x()), dReal(velocity.y()), dReal(velocity.z()));
        return made;
    }
    dBodyID body(const dMass& inertia, dGeomID geom, const Vector3<double>& at) {
        const dBodyID made = dBodyCreate(engine.id);
        dBodySetMass(made, &inertia);
        dGeomSetBody(geom, made);
        dBodySetPosition(made, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        world->add(made);
        return made;
    }
    Hinge& hinge(dBodyID a, dBodyID b, const Vector3<double>& anchor, double strength) {
        hinges.push_back(std::make_unique<Hinge>(
            engine.id, a, b, ode::HingeFrame{.anchor = anchor, .axis = {0, 0, 1}},
            Law(Perfect<double>({.strength = strength}))));
        world->add(*hinges.back());
        return *hinges.back();
    }
    /// Five pieces on hinges, 2 m high, and a ball on its way to it where it is `struck`.
    void post(bool struck) {
        for (int i = 0; i < 5; ++i) {
            const dBodyID below = i > 0 ? mine.back() : nullptr;
            mine.push_back(box(12, {0.05, 0.2, 0.05}, {0, 0.25 + 0.4 * i, 0}));
            hinge(mine.back(), below, {0, 0.05 + 0.4 * i, 0}, 4000);
        }
        mine.push_back(ball(100, 0.2, {-0.6, struck ? 1.9 : 50, 0}, {struck ? 5.0 : 0, 0, 0}));
    }
    /// The same as one body until it yields.
    void member_post(bool struck) {
        const Member of = test::heavy_post();
        const dBodyID post = dBodyCreate(engine.id);
        dBodySetKinematic(post);
        dBodySetPosition(post, 0, dReal(0.05), 0);
        dQuaternion up; // its z
        dQFromAxisAndAngle(up, 1, 0, 0, dReal(-std::acos(0)));
        dBodySetQuaternion(post, up);
        for (int k = 1; k < of.segments(); ++k) {
            const double length = of.segment(k).length;
            const dGeomID geom = dCreateBox(engine.space, dReal(0.1), dReal(0.1), dReal(length));
            dGeomSetBody(geom, post);
            dGeomSetOffsetPosition(geom, 0, 0, dReal(of.place(k - 1) + length / 2));
        }
        member = std::make_unique<ode::Member>(post, of, JointFrame<double>{});
        world->add(*member, "post");
        mine.push_back(
            ball(100, 0.1, {0, of.length(), struck ? -0.4 : 50}, {0, 0, struck ? 2.0 : 0}));
        dBodySetGravityMode(mine.back(), 0);
    }
    /// Boxes in stacks of four that slide a little.
    void stacks(int boxes) {
        for (int i = 0; i < boxes; ++i) {
            const int stack = i / 4;
            others.push_back(
                box(100, {0.5, 0.5, 0.5},
                    {4 + 1.5 * (stack % 16), 0.5 + 1.02 * (i % 4), 4 + 1.5 * (stack / 16)}));
            dBodySetLinearVel(others.back(), dReal(0.1 * (i % 3)), 0, 0);
        }
    }
    static void near(void* data, dGeomID a, dGeomID b) {
        Site& site = *static_cast<Site*>(data);
        if (test::OdeEngine::are_joined(a, b)) return;
        for (dGeomID geom : {a, b}) {
            const dBodyID body = dGeomGetBody(geom);
            site.looks_at_others +=
                std::find(site.others.begin(), site.others.end(), body) != site.others.end();
        }
        dSurfaceParameters surface{};
        surface.mode = dContactApprox1;
        surface.mu = dReal(0.5);
        site.engine.touch(a, b, surface, [&site](dJointID joint, const dContact& contact) {
            site.world->add_contact(joint, contact);
        });
    }
    void step() {
        world->step(frame);
        worst = std::max(worst, world->frame().solves());
        gained = std::max(gained, std::abs(world->ledger().unexplained()));
    }
    [[nodiscard]] double work() const {
        double sum = 0;
        for (const auto& each : hinges) sum += each->absorbed_energy();
        return sum;
    }
};

/// Of places and velocities, bit by bit.
[[nodiscard]] std::uint64_t hash_of(const std::vector<dBodyID>& bodies) {
    test::BitHash bits;
    for (const dBodyID body : bodies) {
        bits.eat(dBodyGetPosition(body), 3);
        bits.eat(dBodyGetRotation(body), 12);
        bits.eat(dBodyGetLinearVel(body), 3);
        bits.eat(dBodyGetAngularVel(body), 3);
    }
    return bits.value();
}

} // namespace

TEST_CASE("Locality: others go through a frame once, to the bits that they have alone", "[frame]") {
    for (const bool hashed : {false, true}) {
        CAPTURE(hashed);
        Site struck(ode::Solver::direct, hashed), quiet(ode::Solver::direct, hashed);
        for (Site* site : {&struck, &quiet}) {
            site->stacks(80);
            site->post(site == &struck);
        }
        int differ = 0;
        for (int i = 0; i < 60; ++i) {
            struck.step();
            quiet.step();
            differ += hash_of(struck.others) != hash_of(quiet.others);
        }
        CHECK(differ == 0);
        CHECK(struck.worst > 4);
        CHECK(quiet.worst == 1);
        CHECK(struck.work() > 1000);
        // as often as in a frame of two parts, at most
        CHECK(struck.looks_at_others < 2 * quiet.looks_at_others);
        CHECK(struck.gained < 1e-6);
    }
}

TEST_CASE("Locality: a post among others takes what it takes alone", "[frame]") {
    for (const ode::Solver solver : {ode::Solver::direct, ode::Solver::quick}) {
        CAPTURE(int(solver));
        Site alone(solver), among(solver);
        among.stacks(60);
        for (Site* site : {&alone, &among}) site->post(true);
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
        CHECK(among.world->run().believed() == alone.world->run().believed());
        CHECK(among.world->ledger().booked(Account::plastic) == Approx(alone.work()).epsilon(1e-9));
        CHECK(among.gained < 1e-6);
    }
}

TEST_CASE("Locality: others fall asleep beside what goes on in parts", "[frame]") {
    Site site;
    site.stacks(16);
    for (const dBodyID body : site.others) {
        dBodySetLinearVel(body, 0, 0, 0);
        dBodySetAutoDisableFlag(body, 1);
        dBodySetAutoDisableSteps(body, 10);
        dBodySetAutoDisableTime(body, dReal(0.2));
    }
    // thrown anew in each frame, in which it comes to rest
    const dBodyID rotor = site.box(10, {0.2, 0.2, 0.2}, {-5, 3, 0});
    site.hinge(rotor, nullptr, {-5, 3, 0}, 40);
    int in_parts = 0;
    for (int i = 0; i < 60; ++i) {
        dBodySetAngularVel(rotor, 0, 0, 2);
        site.step();
        in_parts += site.world->frame().solves() > 1;
    }
    CHECK(in_parts == 60);
    for (const dBodyID body : site.others) CHECK(dBodyIsEnabled(body) == 0);
}

TEST_CASE("Locality: who is sent farther than could be foreseen meets the others", "[frame]") {
    // a bar on a weak hinge is hit early in the frame; what lies on its tip flies off and meets a
    // box of others in the same frame
    const auto run = [](int boxes, bool asleep) {
        Site site(ode::Solver::direct, true, 0);
        const dBodyID bar = site.box(10, {0.5, 0.02, 0.05}, {0.5, 5, 0});
        site.hinge(bar, nullptr, {0, 5, 0}, 20);
        const dBodyID pebble = site.ball(0.01, 0.02, {0.98, 5.041, 0}, {0, 0, 0});
        site.ball(2000, 0.1, {0.15, 4.8, 0}, {0, 60, 0});
        const dBodyID target = site.box(20, {1, 1, 1}, {0.98, 9.3, 0});
        site.mine = {bar, pebble, target};
        for (int i = 0; i < boxes; ++i) {
            site.others.push_back(site.box(20, {0.1, 0.1, 0.1}, {6.0 + i, 1, 4}));
        }
        if (asleep) dBodyDisable(target);
        site.step();
        const dReal* velocity = dBodyGetLinearVel(target);
        CHECK(site.gained < 1e-6 * 2000 * 60 * 60);
        CHECK(dBodyGetLinearVel(pebble)[1] < 60); // it came back from it
        return std::pair(double(velocity[1]), site.work());
    };
    for (const bool asleep : {false, true}) {
        CAPTURE(asleep);
        const auto [speed, work] = run(0, asleep); // all is done in parts
        const auto [among, among_work] = run(40, asleep);
        CHECK(speed > 0.05);
        CHECK(among == Approx(speed).epsilon(0.01));
        CHECK(among_work == Approx(work).epsilon(0.01));
    }
}

TEST_CASE("Locality: contacts that the program makes by itself bring others in", "[frame]") {
    // a rotor stops within a frame; by its own rule the program has it push a plate for a while
    const auto run = [](int boxes) {
        Site site(ode::Solver::direct, true, 0);
        const dBodyID rotor = site.box(10, {0.2, 0.2, 0.2}, {-5, 3, 0});
        site.hinge(rotor, nullptr, {-5, 3, 0}, 40);
        const dBodyID first = site.box(10, {0.2, 0.2, 0.2}, {-9, 3, 0});
        site.hinge(first, nullptr, {-9, 3, 0}, 40);
        const dBodyID plate = site.box(1, {0.2, 0.2, 0.2}, {-4.8, 13, 0});
        for (int i = 0; i < boxes; ++i) {
            site.others.push_back(site.box(20, {0.1, 0.1, 0.1}, {6.0 + i, 1, 4}));
        }
        site.world->on_contacts(
            {.space = site.engine.space, .group = site.engine.contacts}, [&site, rotor, plate] {
                dSpaceCollide(site.engine.space, &site, &Site::near);
                const double angle = 2 * double(dBodyGetQuaternion(rotor)[3]);
                if (angle < 0.006 || angle > 0.012) return;
                const dReal* place = dBodyGetPosition(rotor);
                dContact contact{};
                contact.geom.pos[0] = place[0] + dReal(0.2);
                contact.geom.pos[1] = place[1];
                contact.geom.normal[1] = 1; // on the plate
                contact.geom.depth = dReal(1e-4);
                const dJointID joint =
                    dJointCreateContact(site.engine.id, site.engine.contacts, &contact);
                dJointAttach(joint, plate, rotor);
                site.world->add_contact(joint, contact);
            });
        dBodySetAngularVel(rotor, 0, 0, 2);
        dBodySetAngularVel(first, 0, 0, 1); // whose stop ends a part
        for (int i = 0; i < 3; ++i) site.step();
        CHECK(site.gained < 1e-9);
        CHECK(site.worst > 1);
        return std::pair(double(dBodyGetLinearVel(plate)[1]), site.work());
    };
    const auto [speed, work] = run(0);
    const auto [among, among_work] = run(40);
    CHECK(speed > 0.1);
    CHECK(among == speed);
    CHECK(among_work == work);
}

TEST_CASE("Locality: contacts of a world that stands are made once a frame", "[frame]") {
    Site site;
    for (int i = 0; i < 6; ++i) {
        const dBodyID lower = site.box(50, {0.5, 0.5, 0.5}, {2.0 * i, 0.5, 0});
        const dBodyID upper = site.box(50, {0.5, 0.5, 0.5}, {2.0 * i, 1.5, 0});
        site.hinge(upper, lower, {2.0 * i, 1, 0}, 100);
    }
    for (int i = 0; i < 30; ++i) site.step();
    const int before = site.looks;
    for (int i = 0; i < 10; ++i) site.step();
    CHECK(site.looks - before == 10);
    CHECK(site.work() == 0);
    // what comes flying is seen before it is there
    site.ball(40, 0.2, {-1.2, 1.5, 0}, {5, 0, 0});
    for (int i = 0; i < 20; ++i) site.step();
    CHECK(site.work() > 1);
    CHECK(site.world->run().blows > 0);
}

TEST_CASE("Locality: a world that sleeps solves nothing until something is awake", "[frame]") {
    enum Deed { nothing, throws, pushes, wakes_as_contacts_are_made, brings, lifts };
    // work, what hands brought in, and solves of ten frames asleep
    const auto run = [](Deed deed, bool beside_one_awake) {
        Site site;
        const dBodyID lower = site.box(50, {0.5, 0.5, 0.5}, {0, 0.5, 0});
        const dBodyID upper = site.box(50, {0.5, 0.5, 0.5}, {0, 1.5, 0});
        site.hinge(upper, lower, {0, 1, 0}, 100);
        for (const dBodyID body : {lower, upper}) dBodySetAutoDisableFlag(body, 1);
        if (beside_one_awake) dBodySetGravityMode(site.ball(1, 0.1, {50, 50, 0}, {0, 0, 0}), 0);
        for (int i = 0; i < 40; ++i) site.step();
        REQUIRE(dBodyIsEnabled(upper) == 0);
        const std::size_t before = site.world->run().parts;
        const int looks = site.looks;
        for (int i = 0; i < 10; ++i) site.step();
        const std::size_t solves = site.world->run().parts - before;
        CHECK(site.looks == looks + 10);
        switch (deed) {
            case throws:
                dBodyEnable(upper);
                dBodySetAngularVel(upper, 0, 0, -3);
                dBodySetLinearVel(upper, dReal(1.5), 0, 0);
                break;
            case pushes:
                for (int i = 0; i < 6; ++i) {
                    site.world->apply_force(upper, {400, 0, 0}, {0, 2, 0});
                    site.step();
                }
                break;
            case wakes_as_contacts_are_made:
                site.world->on_contacts({.space = site.engine.space, .group = site.engine.contacts},
                                        [&site, upper, done = false]() mutable {
                                            if (!std::exchange(done, true)) dBodyEnable(upper);
                                            dSpaceCollide(site.engine.space, &site, &Site::near);
                                        });
                break;
            case brings:
                site.ball(40, 0.2, {-1.2, 1.9, 0}, {5, 0, 0});
                break;
            case lifts:
                dBodySetPosition(lower, 0, 1, 0);
                break;
            case nothing:
                break;
        }
        const std::size_t until_then = site.world->run().parts;
        for (int i = 0; i < 20; ++i) site.step();
        const bool awake = deed != nothing && deed != lifts;
        CHECK((awake || beside_one_awake) == (site.world->run().parts > until_then));
        CHECK(site.gained < 1e-6);
        CHECK(site.world->run().believed());
        return std::tuple(site.work(), site.world->ledger().supplied(), solves);
    };
    for (const Deed deed : {nothing, throws, pushes, wakes_as_contacts_are_made, brings, lifts}) {
        CAPTURE(int(deed));
        const auto [work, supplied, solves] = run(deed, false);
        const auto [beside, brought, solved] = run(deed, true);
        CHECK(solves == 0);
        CHECK(solved == 10);
        CHECK((work > 1) == (deed == throws || deed == pushes || deed == brings));
        CHECK(work == Approx(beside).epsilon(1e-9));
        CHECK(supplied == Approx(brought).epsilon(1e-9));
    }
}

TEST_CASE("Locality: what hands do to a world that stands is resolved", "[frame]") {
    // bars that hang on by one end bear themselves; then something comes to them within one frame
    enum Deed { nothing, force, gravity, mass, other_joint };
    for (const Deed deed : {nothing, force, gravity, mass, other_joint}) {
        CAPTURE(int(deed));
        Site site;
        const dBodyID bar = site.box(10, {0.5, 0.05, 0.05}, {0.5, 5, 0});
        const Hinge& hinge = site.hinge(bar, nullptr, {0, 5, 0}, 150);
        const dBodyID other = site.box(10, {0.1, 0.1, 0.1}, {0.5, 5.5, 0});
        dBodySetGravityMode(other, 0);
        for (int i = 0; i < 10; ++i) site.step();
        CHECK(site.worst == 1);
        switch (deed) {
            case force:
                dBodyAddForce(bar, 0, -600, 0);
                break;
            case gravity:
                dWorldSetGravity(site.engine.id, 0, -60, 0);
                break;
            case mass: {
                dMass heavier;
                dMassSetBoxTotal(&heavier, 100, 1, dReal(0.1), dReal(0.1));
                dBodySetMass(bar, &heavier);
                break;
            }
            case other_joint: {
                const dJointID motor = dJointCreateSlider(site.engine.id, nullptr);
                dJointAttach(motor, other, bar);
                dJointSetSliderAxis(motor, 0, 1, 0);
                dJointSetSliderParam(motor, dParamVel, 5);
                dJointSetSliderParam(motor, dParamFMax, 600);
                break;
            }
            case nothing:
                break;
        }
        site.step();
        CHECK((site.worst > 1) == (deed != nothing));
        CHECK((hinge.absorbed_energy() > 0) == (deed != nothing));
    }
}

TEST_CASE("Locality: others go through a frame once while a member is open", "[frame]") {
    Site struck, quiet, alone;
    for (Site* site : {&struck, &quiet}) site->stacks(80);
    for (Site* site : {&struck, &quiet, &alone}) site->member_post(site != &quiet);
    int differ = 0, mine_differ = 0, split = 0;
    for (int i = 0; i < 60; ++i) {
        for (Site* site : {&struck, &quiet, &alone}) {
            site->step();
            split += int(site->world->events().size());
        }
        differ += hash_of(struck.others) != hash_of(quiet.others);
        mine_differ += hash_of(struck.mine) != hash_of(alone.mine);
    }
    CHECK(split > 0);
    CHECK(struck.worst > 4);
    CHECK(struck.member->absorbed_energy() > 10);
    CHECK(struck.member->absorbed_energy() == alone.member->absorbed_energy());
    CHECK(differ == 0);
    CHECK(mine_differ == 0);
    CHECK(struck.looks_at_others < 2 * quiet.looks_at_others);
    for (const Site* site : {&struck, &quiet, &alone}) CHECK(site->gained < 1e-6);
}

TEST_CASE("Locality: a body that is touched may end before it comes in", "[frame]") {
    // the program's own contact is there at the end of the first part, in which a hinge yields: who
    // hears of that takes the plate away
    Site site(ode::Solver::direct, true, 0);
    const dBodyID rotor = site.box(10, {0.2, 0.2, 0.2}, {-5, 3, 0});
    site.hinge(rotor, nullptr, {-5, 3, 0}, 40);
    dBodyID plate = site.box(1, {0.2, 0.2, 0.2}, {-4.8, 13, 0});
    for (int i = 0; i < 40; ++i) {
        site.others.push_back(site.box(20, {0.1, 0.1, 0.1}, {6.0 + i, 1, 4}));
    }
    bool touched = false;
    site.world->on_contacts({.space = site.engine.space, .group = site.engine.contacts}, [&] {
        dSpaceCollide(site.engine.space, &site, &Site::near);
        const double angle = 2 * double(dBodyGetQuaternion(rotor)[3]);
        touched = plate != nullptr && angle > 2.2e-5 && angle < 0.012;
        if (!touched) return;
        dContact contact{};
        contact.geom.normal[1] = 1;
        contact.geom.depth = dReal(1e-4);
        const dJointID joint = dJointCreateContact(site.engine.id, site.engine.contacts, &contact);
        dJointAttach(joint, plate, rotor);
        site.world->add_contact(joint, contact);
    });
    bool ended = false;
    site.world->on_event([&](const auto&) {
        if (!touched || ended) return;
        ended = true;
        site.world->remove(plate);
        dGeomDestroy(dBodyGetFirstGeom(plate));
        dBodyDestroy(std::exchange(plate, nullptr));
    });
    dBodySetAngularVel(rotor, 0, 0, 2);
    for (int i = 0; i < 3; ++i) site.step();
    CHECK(ended);
    CHECK(site.worst > 1);
    CHECK(site.work() == Approx(10 * 0.32 / 12 * 4 / 2).epsilon(1e-3)); // I ω²/2
}
