// SPDX-License-Identifier: MIT
//
// A Bullet world that was put back goes on bit for bit as one that never tried.
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "adapters/pile.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/world_parts.hpp"
#include "ductile/bullet/world_snapshot.hpp"

namespace {

using ductile::bullet::Divisibles;
using ductile::bullet::EnergyMeter;
using ductile::bullet::FrontHold;
using ductile::bullet::PlasticConstraint;
using ductile::bullet::WorldParts;
using pile::Options;
using pile::Pile;

constexpr int frames = 400;
constexpr double frame = 1.0 / 60;

/// A pile and its parts.
struct Parted {
    Pile pile;
    FrontHold front{pile.world};
    EnergyMeter meter{pile.world};
    std::unique_ptr<Divisibles> members = std::make_unique<Divisibles>();
    WorldParts parts{
        pile.world,   front, meter, members, [](const PlasticConstraint&) { return 0u; },
        [](double) {}};

    explicit Parted(const Options& options) : pile(options) {
        for (auto& hinge : pile.hinges) hinge->set_ahead(true);
    }
};

/// Something of the world that a trial changes and that has to be put back.
struct Item {
    const char* name;
    /// What it is now, to be written over what was put back.
    std::function<void()> (*left_behind)(Parted&);
};

/// Frames, of 400, in which a world that tried `trial` frames at once first, and was put back, but
/// for what was forgotten, differs from one that did not.
int frames_that_differ(const Options& options, double trial, int parts,
                       const Item* forgotten = nullptr) {
    Parted plain(options), tried(options);
    int differ = 0;
    for (int i = 0; i < frames; ++i) {
        plain.parts.begin(frame);
        tried.parts.begin(frame);
        tried.parts.save();
        (void)tried.parts.part(trial * frame);
        const auto leave = forgotten != nullptr ? forgotten->left_behind(tried) : [] {};
        tried.parts.put_back();
        leave();
        for (int k = 0; k < parts; ++k) {
            (void)plain.parts.part(frame / parts);
            (void)tried.parts.part(frame / parts);
        }
        differ += plain.pile.hash() != tried.pile.hash();
    }
    return differ;
}

/// `get` of each body, which `set` gives back.
template <class Get, class Set>
std::function<void()> of_bodies(Parted& world, Get get, Set set) {
    std::vector<std::function<void()>> all;
    for (const auto& body : world.pile.bodies) {
        if (body->isStaticObject()) continue;
        all.push_back([&of = *body, value = get(*body), set] { set(of, value); });
    }
    return [all] {
        for (const auto& one : all) one();
    };
}

/// Those of world_snapshot.hpp, but for its last one, the seed, and for what Bullet finds anew in
/// each tick: interpolated poses, islands, forces (held_forces.hpp).
const std::vector<Item> items{
    {"pose",
     [](Parted& world) {
         return of_bodies(
             world, [](btRigidBody& body) { return body.getWorldTransform(); },
             [](btRigidBody& body, const btTransform& at) {
                 body.setWorldTransform(at);
                 body.updateInertiaTensor();
             });
     }},
    {"velocity",
     [](Parted& world) {
         return of_bodies(
             world, [](btRigidBody& body) { return body.getLinearVelocity(); },
             [](btRigidBody& body, const btVector3& v) { body.setLinearVelocity(v); });
     }},
    {"spin",
     [](Parted& world) {
         return of_bodies(
             world, [](btRigidBody& body) { return body.getAngularVelocity(); },
             [](btRigidBody& body, const btVector3& w) { body.setAngularVelocity(w); });
     }},
    {"activation",
     [](Parted& world) {
         return of_bodies(
             world, [](btRigidBody& body) { return body.getActivationState(); },
             [](btRigidBody& body, int state) { body.forceActivationState(state); });
     }},
    {"time of rest",
     [](Parted& world) {
         return of_bodies(
             world, [](btRigidBody& body) { return body.getDeactivationTime(); },
             [](btRigidBody& body, btScalar time) { body.setDeactivationTime(time); });
     }},
    {"points of contact",
     [](Parted& world) -> std::function<void()> {
         btDispatcher& dispatcher = world.pile.dispatcher;
         using Of = std::pair<const btCollisionObject*, const btCollisionObject*>;
         std::map<Of, std::vector<btManifoldPoint>> points;
         for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
             const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
             auto& of = points[{manifold.getBody0(), manifold.getBody1()}];
             for (int k = 0; k < manifold.getNumContacts(); ++k) {
                 of.push_back(manifold.getContactPoint(k));
             }
         }
         return [&dispatcher, points] {
             for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
                 btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
                 const auto of = points.find({manifold.getBody0(), manifold.getBody1()});
                 manifold.setNumContacts(0);
                 if (of == points.end()) continue;
                 for (const btManifoldPoint& point : of->second) manifold.addManifoldPoint(point);
             }
         };
     }},
    {"joints",
     [](Parted& world) -> std::function<void()> {
         for (const auto& hinge : world.pile.hinges) hinge->keep_all(); // in place of what was kept
         return [] {};
     }},
};

} // namespace

TEST_CASE("A pile that tried a frame and was put back goes on bit for bit", "[frame]") {
    for (const bool spread : {false, true}) {
        for (const bool sleeps : {false, true}) {
            for (const double trial : {1.0, 4.0, 16.0}) {
                for (const int parts : {1, 3}) {
                    CAPTURE(spread, sleeps, trial, parts);
                    CHECK(frames_that_differ({.spread = spread, .sleeps = sleeps}, trial, parts) ==
                          0);
                }
            }
        }
    }
}

TEST_CASE("A pile whose solver shuffles its rows goes on bit for bit", "[frame]") {
    // a pair of bounds that the trial left overlapping would change what is shuffled
    CHECK(frames_that_differ({.sleeps = false, .shuffles = true, .hinges = false}, 1, 1) == 0);
}

TEST_CASE("A pile of which one thing is not put back goes on otherwise", "[frame]") {
    for (const Item& item : items) {
        CAPTURE(item.name);
        CHECK(frames_that_differ({.sleeps = true}, 4, 1, &item) > 200);
    }
    const Item seed{"seed of the solver", [](Parted& world) -> std::function<void()> {
                        auto& solver = world.pile.solver;
                        return [&solver, now = solver.getRandSeed()] { solver.setRandSeed(now); };
                    }};
    CHECK(frames_that_differ({.sleeps = false, .shuffles = true, .hinges = false}, 1, 1, &seed) >
          200);
}
