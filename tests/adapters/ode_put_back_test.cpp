// SPDX-License-Identifier: MIT
//
// An ODE world that was put back goes on bit for bit as one that never tried: 30 boxes with
// friction, in one heap for QuickStep and in ten for dWorldStep, whose cost grows with the cube,
// and beside them four pairs of boxes on a plastic hinge that slide, tip over and yield.
#include <ode/ode.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "adapters/ode_engine.hpp"
#include "ductile/ode/island_solver.hpp"
#include "ductile/ode/ode.hpp"
#include "ductile/ode/world_parts.hpp"
#include "support/bit_hash.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>, TravelLimit<double>>;
using Hinge = ode::PlasticHinge<Law>;

constexpr double frame = 1.0 / 60;

struct Options {
    bool quick = false;  ///< QuickStep, and the pile is one heap, not ten of three boxes
    bool hash = true;    ///< the space
    double limit = 1e9;  ///< travel at which hinges break [rad]
    bool sleeps = false; ///< bodies may fall asleep, one island after the other
    bool motors = false; ///< in place of hinges PlasticMotors on ODE's own
};

struct Pile;

/// Something of the world that a trial changes and that has to be put back.
struct Item {
    const char* name;
    /// What it is now, to be written over what was put back.
    std::function<void()> (*left_behind)(Pile&);
};

/// The pile and its parts.
struct Pile {
    Options options;
    test::OdeEngine engine;
    std::vector<dBodyID> bodies;
    std::vector<std::unique_ptr<ode::PlasticConstraint>> owned;
    std::vector<ode::PlasticConstraint*> joints;
    std::vector<ode::NamedContact> contacts;
    std::optional<ode::ContactMaker> maker;
    ode::EnergyMeter meter{engine.id};
    std::unique_ptr<ode::Divisibles> members = std::make_unique<ode::Divisibles>();
    ode::IslandSolver islands;
    ode::WorldParts parts{{.world = engine.id,
                           .bodies = bodies,
                           .joints = joints,
                           .contacts = contacts,
                           .maker = maker,
                           .meter = meter,
                           .members = members,
                           .solve = [this](double dt) { solve(dt); },
                           .step = [this](double dt) { step(dt); },
                           .book = [this](double dt) { book(dt); },
                           .number = [](const ode::PlasticConstraint&) { return 0u; },
                           .accept =
                               [this](double) {
                                   for (auto* joint : joints) joint->stand();
                               }}};
    std::uint64_t seed = 7; ///< ODE has one for all worlds

    explicit Pile(const Options& of) : options(of), engine(of.hash) {
        dWorldSetGravity(engine.id, 0, dReal(-9.81), 0);
        dWorldSetCFM(engine.id, dReal(1e-8));
        dCreatePlane(engine.space, 0, 1, 0, 0);
        for (int i = 0; i < 30; ++i) {
            const int level = options.quick ? i / 3 : i % 3;
            const double x = options.quick ? 1.02 * (i % 3) : -3 * (i / 3);
            add({x + 0.1 * (level % 2), 0.6 + 1.1 * level, 0.05 * (i % 2)});
        }
        for (int i = 0; i < 4; ++i) {
            const double x = 12 + 4 * i;
            add({x, 0.52, 0});
            add({x, 1.62, 0});
            const dBodyID below = bodies[bodies.size() - 2], above = bodies.back();
            join(above, below, {x, 1.07, 0});
            dBodySetLinearVel(below, dReal(1 + i), 0, dReal(0.3));
            dBodySetAngularVel(above, 0, 0, dReal(0.5 * i));
        }
        dBodySetLinearVel(bodies[27], 3, 0, 1);
        add({0, -50, 0}); // all is done in parts beside it, and put back
        dBodySetKinematic(bodies.back());
        maker.emplace(ode::ContactParameters{.space = engine.space, .group = engine.contacts},
                      [this] { dSpaceCollide(engine.space, this, &Pile::near); });
        meter.open();
    }

    void add(const Vector3<double>& at) {
        const dBodyID body = dBodyCreate(engine.id);
        dMass mass;
        dMassSetBoxTotal(&mass, 100, 1, 1, 1);
        dBodySetMass(body, &mass);
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dGeomSetBody(dCreateBox(engine.space, 1, 1, 1), body);
        if (options.sleeps) {
            dBodySetAutoDisableFlag(body, 1);
            dBodySetAutoDisableTime(body, 0);
            dBodySetAutoDisableSteps(body, 2);
            dBodySetAutoDisableLinearThreshold(body, dReal(0.3));
            dBodySetAutoDisableAngularThreshold(body, dReal(0.3));
        }
        bodies.push_back(body);
        meter.add(body);
    }
    void join(dBodyID above, dBodyID below, const Vector3<double>& at) {
        const Law law(Perfect<double>({.strength = 300}),
                      TravelLimit<double>({.limit = options.limit}));
        if (options.motors) {
            const dJointID hinge = dJointCreateHinge(engine.id, nullptr);
            dJointAttach(hinge, above, below);
            dJointSetHingeAnchor(hinge, dReal(at.x()), dReal(at.y()), dReal(at.z()));
            dJointSetHingeAxis(hinge, 0, 0, 1);
            owned.push_back(std::make_unique<ode::PlasticMotor<Law>>(ode::hinge_axis(hinge), law));
        } else {
            owned.push_back(std::make_unique<Hinge>(
                engine.id, above, below, ode::HingeFrame{.anchor = at, .axis = {0, 0, 1}}, law));
        }
        joints.push_back(owned.back().get());
        joints.back()->set_ahead(true);
        islands.add(*joints.back());
        meter.add(*joints.back());
    }
    static void near(void* data, dGeomID a, dGeomID b) {
        auto& pile = *static_cast<Pile*>(data);
        if (test::OdeEngine::are_joined(a, b)) return;
        dSurfaceParameters surface{};
        surface.mode = dContactApprox1;
        surface.mu = dReal(0.6);
        pile.engine.touch(a, b, surface, [&pile](dJointID joint, const dContact& contact) {
            pile.contacts.push_back({joint, contact});
        });
    }
    void solve(double dt) {
        for (auto* joint : joints) joint->prepare(dt);
        islands.before_step(contacts, dt, false);
        step(dt);
        islands.after_step();
    }
    void step(double dt) const {
        options.quick ? dWorldQuickStep(engine.id, dReal(dt)) : dWorldStep(engine.id, dReal(dt));
    }
    void book(double dt) {
        for (auto* joint : joints) joint->commit(dt);
        for (auto* joint : joints) joint->finish();
    }
    /// A frame in `pieces` parts, after one of `trial` frames that is put back, but for what is
    /// forgotten; 0: none.
    void go(double trial, int pieces, const Item* forgotten = nullptr) {
        dRandSetSeed(static_cast<unsigned long>(seed));
        parts.begin(frame);
        if (trial > 0) {
            parts.save();
            (void)parts.closing(trial * frame, 1, 1);
            (void)parts.part(trial * frame);
            const auto leave = forgotten != nullptr ? forgotten->left_behind(*this) : [] {};
            parts.put_back();
            leave();
        }
        for (int i = 0; i < pieces; ++i) {
            parts.save();
            (void)parts.part(frame / pieces);
            parts.accept(frame / pieces);
        }
        parts.end();
        seed = dRandGetSeed();
    }

    /// Of all places and velocities, and the joints' accounts, bit by bit.
    [[nodiscard]] std::uint64_t hash() const {
        test::BitHash bits;
        for (const dBodyID body : bodies) {
            bits.eat(dBodyGetPosition(body), 3);
            bits.eat(dBodyGetQuaternion(body), 4);
            bits.eat(dBodyGetRotation(body), 12);
            bits.eat(dBodyGetLinearVel(body), 3);
            bits.eat(dBodyGetAngularVel(body), 3);
        }
        for (const auto* joint : joints) {
            const double absorbed = joint->queries().absorbed_energy();
            bits.eat(&absorbed, 1);
        }
        const HeldEnergy<double> held = meter.ledger().held();
        const double books[] = {held.kinetic, held.potential, meter.ledger().unexplained(),
                                meter.ledger().booked(Account::friction)};
        bits.eat(books, 4);
        return bits.value();
    }
    [[nodiscard]] double absorbed() const {
        double sum = 0;
        for (const auto* joint : joints) sum += joint->queries().absorbed_energy();
        return sum;
    }
};

/// Frames, of 400, in which a world that tried first differs from one that did not.
int frames_that_differ(const Options& options, double trial, int pieces,
                       const Item* forgotten = nullptr) {
    Pile plain(options), tried(options);
    int differ = 0;
    for (int i = 0; i < 400; ++i) {
        plain.go(0, pieces);
        tried.go(trial, pieces, forgotten);
        differ += plain.hash() != tried.hash();
        if (forgotten != nullptr && differ > 0) return differ; // what overlaps would fly away
    }
    CHECK(plain.absorbed() > 100); // the hinges yield
    return differ;
}

/// `count` numbers of each body, where ODE has them.
std::function<void()> of_bodies(Pile& pile, const dReal* (*where)(dBodyID), int count) {
    std::vector<std::pair<dReal*, std::vector<dReal>>> all;
    for (const dBodyID body : pile.bodies) {
        auto* at = const_cast<dReal*>(where(body));
        all.emplace_back(at, std::vector<dReal>(at, at + count));
    }
    return [all] {
        for (const auto& [at, values] : all) std::copy(values.begin(), values.end(), at);
    };
}

/// The list of world_snapshot.hpp, but for its last one, the seed.
const std::vector<Item> items{
    {"place", [](Pile& pile) { return of_bodies(pile, dBodyGetPosition, 3); }},
    {"quaternion", [](Pile& pile) { return of_bodies(pile, dBodyGetQuaternion, 4); }},
    {"matrix", [](Pile& pile) { return of_bodies(pile, dBodyGetRotation, 12); }},
    {"velocity", [](Pile& pile) { return of_bodies(pile, dBodyGetLinearVel, 3); }},
    {"spin", [](Pile& pile) { return of_bodies(pile, dBodyGetAngularVel, 3); }},
    {"joints",
     [](Pile& pile) -> std::function<void()> {
         for (auto* joint : pile.joints) joint->keep_all(); // in place of what was kept
         return [] {};
     }},
    {"whether it is awake",
     [](Pile& pile) -> std::function<void()> {
         std::vector<std::pair<dBodyID, bool>> all;
         for (const dBodyID body : pile.bodies) all.emplace_back(body, dBodyIsEnabled(body) != 0);
         return [all] {
             for (const auto& [body, awake] : all) (awake ? dBodyEnable : dBodyDisable)(body);
         };
     }},
};

} // namespace

TEST_CASE("A pile that tried a frame and was put back goes on bit for bit", "[frame]") {
    for (const bool quick : {false, true}) {
        for (const bool hash : {false, true}) {
            for (const double trial : {1.0, 4.0}) {
                for (const int pieces : {1, 3}) {
                    CAPTURE(quick, hash, trial, pieces);
                    CHECK(frames_that_differ({.quick = quick, .hash = hash}, trial, pieces) == 0);
                }
            }
        }
    }
}

TEST_CASE("A pile that broke a hinge in a trial has it again, bit for bit", "[frame]") {
    for (const bool motors : {false, true}) {
        CAPTURE(motors);
        CHECK(frames_that_differ({.quick = true, .limit = 0.2, .motors = motors}, 16, 2) == 0);
    }
}

TEST_CASE("A pile that falls asleep and is woken goes on bit for bit", "[frame]") {
    CHECK(frames_that_differ({.sleeps = true}, 16, 1) == 0);
    CHECK(frames_that_differ({.quick = true, .sleeps = true}, 4, 1) == 0);
    CHECK(frames_that_differ({.quick = true, .hash = false, .sleeps = true}, 16, 2) == 0);
}

TEST_CASE("A pile with motors that are plastic goes on bit for bit", "[frame]") {
    CHECK(frames_that_differ({.motors = true}, 1, 2) == 0);
    CHECK(frames_that_differ({.quick = true, .motors = true}, 4, 1) == 0);
}

TEST_CASE("A pile of which one thing is not put back goes on otherwise", "[frame]") {
    for (const Item& item : items) {
        CAPTURE(item.name);
        CHECK(frames_that_differ({.sleeps = true}, 4, 1, &item) > 0);
    }
    const Item seed{"seed of the solver", [](Pile&) -> std::function<void()> {
                        return [now = dRandGetSeed()] { dRandSetSeed(now); };
                    }};
    CHECK(frames_that_differ({.quick = true}, 4, 1, &seed) > 0);
}
