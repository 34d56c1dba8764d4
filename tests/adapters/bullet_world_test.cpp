// SPDX-License-Identifier: MIT
//
// What only Bullet's World has: a direct solver for the islands suspect, worlds for threads,
// multibodies, and that joints need none of it.
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Dynamics/btSimulationIslandManagerMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <LinearMath/btThreads.h>

#include <catch2/catch.hpp>

#include <array>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "adapters/bullet_world.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

using Hinge = bullet::PlasticHinge<>;
constexpr bool single = sizeof(btScalar) == sizeof(float);

btTransform at(double x, double y) {
    btTransform frame;
    frame.setIdentity();
    frame.setOrigin({btScalar(x), btScalar(y), 0});
    return frame;
}

OneAxisJoint<Perfect<double>> joint(double strength) {
    return OneAxisJoint(Perfect<double>({.strength = strength}));
}

/// Cantilevers of rods of 0.1 kg and a tip of 1 kg; every second one is a single rod.
template <class Dynamics>
class Beams {
  public:
    static constexpr int count = 6, segments = 5;

    template <class... Arguments>
    explicit Beams(bullet::WorldParameters parameters, Arguments&&... arguments)
        : dynamics(&dispatcher_, &broadphase_, std::forward<Arguments>(arguments)...,
                   &configuration_),
          world(std::make_unique<bullet::World>(dynamics, std::move(parameters))) {
        dynamics.setGravity({0, 0, 0});
        for (int beam = 0; beam < count; ++beam) {
            const int n = beam % 2 == 0 ? segments : 1;
            btRigidBody* before = nullptr;
            for (int i = 0; i < n; ++i) {
                const bool tip = i + 1 == n;
                btRigidBody::btRigidBodyConstructionInfo info(tip ? 1 : btScalar(0.1), nullptr,
                                                              &shape_, {1e-3f, 1e-2f, 1e-2f});
                info.m_startWorldTransform = at(0.2 * i + 0.1, 5 * beam);
                auto& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
                body.setActivationState(DISABLE_DEACTIVATION);
                dynamics.addRigidBody(&body, 0, 0);
                if (tip) body.setLinearVelocity({0, 4, 0});
                hinges.push_back(
                    before != nullptr
                        ? std::make_unique<Hinge>(body, *before, at(-0.1, 0), at(0.1, 0), joint(20))
                        : std::make_unique<Hinge>(body, at(-0.1, 0), joint(20)));
                world->add(*hinges.back(),
                           "beam " + std::to_string(beam) + " hinge " + std::to_string(i));
                before = &body;
            }
        }
    }
    ~Beams() {
        for (auto& hinge : hinges) hinge->remove_from(dynamics);
        for (auto& body : bodies_) dynamics.removeRigidBody(body.get());
    }
    /// Takes the joints away.
    void leave() {
        for (auto& hinge : hinges) world->remove(*hinge);
        hinges.clear();
    }
    [[nodiscard]] std::vector<double> state() {
        std::vector<double> result;
        for (auto& hinge : hinges) {
            result.insert(result.end(), {hinge->rotation(), hinge->absorbed_energy(),
                                         hinge->moment(), hinge->residual_max()});
        }
        return result;
    }

  private:
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSphereShape shape_{1};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;

  public:
    Dynamics dynamics;
    std::unique_ptr<bullet::World> world;
    std::vector<std::unique_ptr<Hinge>> hinges;
};

/// Sequential impulse that counts the constraints it is given, and notes in which groups.
class CountingSolver final : public btSequentialImpulseConstraintSolver {
  public:
    using Group = std::array<std::vector<int>, 3>; ///< numbers of bodies, of pairs, of pairs
    btScalar solveGroup(btCollisionObject** bodies, int body_count,
                        btPersistentManifold** manifolds, int manifold_count,
                        btTypedConstraint** constraints, int constraint_count,
                        const btContactSolverInfo& info, btIDebugDraw* drawer,
                        btDispatcher* dispatcher) override {
        solved += constraint_count;
        Group& group = groups.emplace_back();
        for (int i = 0; i < body_count; ++i) group[0].push_back(bodies[i]->getWorldArrayIndex());
        const auto note = [](std::vector<int>& list, const btCollisionObject& a,
                             const btCollisionObject& b) {
            list.insert(list.end(), {a.getWorldArrayIndex(), b.getWorldArrayIndex()});
        };
        for (int i = 0; i < manifold_count; ++i) {
            note(group[1], *manifolds[i]->getBody0(), *manifolds[i]->getBody1());
        }
        for (int i = 0; i < constraint_count; ++i) {
            note(group[2], constraints[i]->getRigidBodyA(), constraints[i]->getRigidBodyB());
        }
        return btSequentialImpulseConstraintSolver::solveGroup(
            bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info,
            drawer, dispatcher);
    }
    int solved = 0;
    std::vector<Group> groups;
};

} // namespace

TEST_CASE("islands without plastic joints are the same beside a World, bit for bit",
          "[bullet][world]") {
    // A heap of loose bodies beside beams that a World looks after, in plain steps: a frame with a
    // tolerance is one of the whole world, whose parts the heap takes too.
    const auto heap = [](bool with_beams) {
        btSequentialImpulseConstraintSolver solver;
        Beams<btDiscreteDynamicsWorld> beams({.tolerance = 0, .warn = nullptr}, &solver);
        if (!with_beams) beams.leave();
        beams.dynamics.setGravity({0, btScalar(-9.81), 0});
        btBoxShape floor_shape({50, 1, 50}), box({btScalar(0.5), btScalar(0.5), btScalar(0.5)});
        btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &floor_shape));
        floor.getWorldTransform().setOrigin({500, -1, 0});
        beams.dynamics.addRigidBody(&floor);
        std::vector<std::unique_ptr<btRigidBody>> boxes;
        std::vector<double> state;
        for (int i = 0; i < 8; ++i) {
            btRigidBody::btRigidBodyConstructionInfo info(
                1, nullptr, &box, btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)));
            info.m_startWorldTransform.setOrigin(
                {btScalar(500 + 0.1 * i), btScalar(0.6 + 1.1 * i), 0});
            boxes.push_back(std::make_unique<btRigidBody>(info));
            beams.dynamics.addRigidBody(boxes.back().get());
        }
        for (int i = 0; i < 200; ++i) beams.world->step(1.0 / 60);
        for (auto& body : boxes) {
            for (int k = 0; k < 3; ++k) {
                state.push_back(double(body->getCenterOfMassPosition()[k]));
                state.push_back(double(body->getAngularVelocity()[k]));
            }
            beams.dynamics.removeRigidBody(body.get());
        }
        beams.dynamics.removeRigidBody(&floor);
        return state;
    };
    CHECK(heap(true) == heap(false));
}

TEST_CASE("the user's solver is handed the islands that Bullet hands over", "[bullet][world]") {
    // chains of boxes, some of which come to rest on a floor, some on a body that is driven
    const int batch = GENERATE(1, 8, 128);
    const auto run = [batch](bool with_world) {
        BulletWorld rig("si");
        btDiscreteDynamicsWorld& dynamics = rig.world();
        CountingSolver solver;
        btConstraintSolver* usual = dynamics.getConstraintSolver();
        dynamics.setConstraintSolver(&solver);
        dynamics.getSolverInfo().m_minimumSolverBatchSize = batch;
        dynamics.setGravity({0, btScalar(-9.81), 0});
        std::unique_ptr<bullet::World> world;
        if (with_world) {
            world = std::make_unique<bullet::World>(
                dynamics, bullet::WorldParameters{.tolerance = 0, .warn = nullptr});
        }
        btBoxShape shape({btScalar(0.5), btScalar(0.5), btScalar(0.5)}), wide({20, 1, 20});
        std::vector<std::unique_ptr<btRigidBody>> bodies;
        std::vector<std::unique_ptr<btPoint2PointConstraint>> joints;
        const auto add = [&](btCollisionShape& of, double mass, const btVector3& place) {
            btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &of,
                                                          btVector3(1, 1, 1) * btScalar(mass / 6));
            info.m_startWorldTransform.setOrigin(place);
            dynamics.addRigidBody(bodies.emplace_back(std::make_unique<btRigidBody>(info)).get());
            return bodies.back().get();
        };
        add(wide, 0, {0, -1, 0});
        btRigidBody* driven = add(shape, 1, {30, 0, 0});
        driven->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        driven->setActivationState(DISABLE_DEACTIVATION);
        for (int i = 0; i < 9; ++i) {
            btRigidBody* before = nullptr;
            for (int k = 0; k <= i % 4; ++k) {
                const double x = i == 8 ? 30 : 4.0 * (i % 4) + 1.1 * k, z = 6.0 * (i / 4);
                btRigidBody* body = add(
                    shape, 1 + k, {btScalar(x), btScalar(1.2 + 0.3 * i), btScalar(i == 8 ? 0 : z)});
                if (before != nullptr) {
                    joints.push_back(std::make_unique<btPoint2PointConstraint>(
                        *before, *body, btVector3(btScalar(0.55), 0, 0),
                        btVector3(btScalar(-0.55), 0, 0)));
                    dynamics.addConstraint(joints.back().get());
                }
                before = body;
            }
        }
        for (int i = 0; i < 300; ++i) {
            if (with_world) {
                world->step(1.0 / 60);
            } else {
                dynamics.stepSimulation(btScalar(1.0 / 60), 0);
            }
        }
        for (auto& joint : joints) dynamics.removeConstraint(joint.get());
        for (auto& body : bodies) dynamics.removeRigidBody(body.get());
        world.reset();
        dynamics.setConstraintSolver(usual);
        std::erase_if(solver.groups, [](const CountingSolver::Group& group) {
            return group == CountingSolver::Group(); // Bullet flushes an empty one
        });
        return std::pair(solver.groups, solver.solved);
    };
    const auto with = run(true), without = run(false);
    CHECK(with.second > 1000);
    CHECK(with == without);
}

TEST_CASE("islands with a plastic joint never reach the user's solver, which is put back",
          "[bullet][world]") {
    CountingSolver own;
    Beams<btDiscreteDynamicsWorld> beams({.warn = nullptr}, &own);
    CHECK(beams.dynamics.getConstraintSolver() != &own);
    beams.world->step(1e-3);
    CHECK(own.solved == 0);
    beams.world.reset();
    CHECK(beams.dynamics.getConstraintSolver() == &own);
}

TEST_CASE("a World and the solver that Bullet's world made itself end in either order",
          "[bullet][world]") {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    {
        btDiscreteDynamicsWorld owner(&dispatcher, &broadphase, nullptr, &configuration);
        btConstraintSolver* made = owner.getConstraintSolver();
        {
            bullet::World world(owner);
            CHECK(owner.getConstraintSolver() != made);
        }
        CHECK(owner.getConstraintSolver() == made);
    }
    auto owner = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, nullptr,
                                                           &configuration);
    const bullet::World world(*owner);
    owner.reset(); // the sanitizers see what is freed twice or not at all
}

TEST_CASE("a world of multibodies keeps its solver and has no tolerance", "[bullet][world]") {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btMultiBodyConstraintSolver solver;
    btMultiBodyDynamicsWorld reduced(&dispatcher, &broadphase, &solver, &configuration);
    const bullet::World world(reduced);
    CHECK(reduced.getConstraintSolver() == &solver);
    CHECK(message_of([&] { bullet::World(reduced, {.tolerance = 0.01}); }) ==
          "World.tolerance: must not be asked of a world of multibodies or soft bodies");
}

TEST_CASE("a World over Bullet's world for threads does what it does over that for one",
          "[bullet][world][threads]") {
    std::unique_ptr<btITaskScheduler> own(
        btCreateDefaultTaskScheduler()); // null: not BT_THREADSAFE
    btSetTaskScheduler(own != nullptr ? own.get() : btGetSequentialTaskScheduler());
    const auto run_threads = [] {
        std::vector<btConstraintSolver*> pool_of; // the pool deletes its solvers
        for (int i = 0; i < 4; ++i) pool_of.push_back(new btSequentialImpulseConstraintSolver);
        btConstraintSolverPoolMt pool(pool_of.data(), int(pool_of.size()));
        Beams<btDiscreteDynamicsWorldMt> beams(bullet::WorldParameters{.warn = nullptr}, &pool,
                                               nullptr);
        static_cast<btSimulationIslandManagerMt*>(beams.dynamics.getSimulationIslandManager())
            ->setMinimumSolverBatchSize(1);
        for (int i = 0; i < 200; ++i) beams.world->step(1e-3);
        CHECK(beams.dynamics.getConstraintSolver() != &pool);
        beams.world.reset();
        CHECK(beams.dynamics.getConstraintSolver() == &pool);
        return beams.state();
    };
    const std::vector<double> parallel = run_threads();
    CHECK(parallel == run_threads());
    btSequentialImpulseConstraintSolver alone;
    Beams<btDiscreteDynamicsWorld> serial(bullet::WorldParameters{.warn = nullptr}, &alone);
    serial.dynamics.getSolverInfo().m_minimumSolverBatchSize = 1;
    for (int i = 0; i < 200; ++i) serial.world->step(1e-3);
    // the two hand an island's constraints over in different orders: round-off
    CHECK(parallel[0] == Approx(serial.state()[0]).epsilon(single ? 1e-4 : 1e-9));
    btSetTaskScheduler(nullptr);
}

TEST_CASE("one front serves several threads at once", "[bullet][world][threads]") {
    // as Bullet built with BT_THREADSAFE does it: islands by threads
    btSequentialImpulseConstraintSolver usual;
    bullet::FrontSolver front(usual, false);
    std::array<std::unique_ptr<BulletWorld>, 4> worlds;
    std::vector<std::unique_ptr<Hinge>> hinges;
    for (auto& world : worlds) {
        world = std::make_unique<BulletWorld>("si");
        btRigidBody& body = world->body(1, 2);
        body.setAngularVelocity({0, 0, 10});
        hinges.push_back(std::make_unique<Hinge>(body, at(0, 0), joint(64)));
        hinges.back()->add_to(world->world());
        world->world().setConstraintSolver(&front);
    }
    std::vector<std::thread> threads;
    for (auto& world : worlds) threads.emplace_back([&world] { world->step(1e-3, 300); });
    for (auto& thread : threads) thread.join();
    for (auto& hinge : hinges) {
        CHECK(hinge->absorbed_energy() == hinges[0]->absorbed_energy());
        CHECK(hinge->absorbed_energy() == Approx(99.84).epsilon(single ? 1e-4 : 1e-9));
    }
    for (std::size_t i = 0; i < worlds.size(); ++i) hinges[i]->remove_from(worlds[i]->world());
}

TEST_CASE("feedback that the ledger lent is taken back from a joint that leaves",
          "[bullet][world]") {
    BulletWorld rig("si");
    btRigidBody& body = rig.body(1, 2);
    Hinge hinge(body, at(0, 0), joint(64));
    {
        bullet::World world(rig.world());
        world.add(hinge);
        world.step(1e-3);
        CHECK(hinge.getJointFeedback() != nullptr);
        world.remove(hinge);
    }
    CHECK(hinge.getJointFeedback() == nullptr);
    CHECK_FALSE(hinge.in_world());
}

TEST_CASE("a motor taken over and a sleeping joint are told of too", "[bullet][world]") {
    BulletWorld rig("si");
    btRigidBody& body = rig.body(1, 2);
    btHingeConstraint own(body, {0, 0, 0}, {0, 0, 1});
    rig.world().addConstraint(&own);
    bullet::PlasticMotor motor(own, joint(64));
    bullet::World world(rig.world());
    world.add(motor, "elbow");
    body.setAngularVelocity({0, 0, 10});
    world.step(1e-3);
    REQUIRE(world.events().size() == 1);
    CHECK(world.events()[0].name == "elbow");
    CHECK(world.events()[0].kind == EventKind::yielded);
    CHECK(world.events()[0].report.outcome == Outcome::yielding);
    body.forceActivationState(ISLAND_SLEEPING);
    CHECK(motor.report().outcome == Outcome::elastic);
    CHECK_FALSE(motor.report().first_yield);
    world.remove(motor);
    rig.world().removeConstraint(&own);
}

TEST_CASE("a body that cannot turn leaves the ledger a number", "[bullet][world]") {
    const double tolerance = GENERATE(0.0, 0.01);
    const bool partly = GENERATE(false, true); // about one axis alone it can
    BulletWorld rig("si");
    std::vector<std::string> said;
    bullet::World world(rig.world(), {.tolerance = tolerance, .warn = [&](const std::string& line) {
                                          said.push_back(line);
                                      }});
    btRigidBody& body = rig.body(2, 1);
    body.setMassProps(2, {0, 0, btScalar(partly ? 1 : 0)});
    body.updateInertiaTensor();
    body.setLinearVelocity({3, 0, 0});
    body.setAngularVelocity({0, 0, btScalar(partly ? 2 : 0)});
    for (int i = 0; i < 10; ++i) world.step(1.0 / 60);
    CHECK(std::isfinite(world.ledger().unexplained()));
    CHECK(world.ledger().held().kinetic == Approx(partly ? 11 : 9));
    CHECK(std::abs(world.ledger().unexplained()) < (single ? 1e-5 : 1e-12) * 10);
    CHECK(said.empty());
}

TEST_CASE("the joint of a multibody is told of, and refused where the world has none",
          "[bullet][world]") {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btMultiBodyConstraintSolver solver;
    btMultiBodyDynamicsWorld dynamics(&dispatcher, &broadphase, &solver, &configuration);
    dynamics.setGravity({0, 0, 0});
    btMultiBody body(1, 0, {1, 1, 1}, true, false);
    body.setupRevolute(0, 1, {2, 2, 2}, -1, btQuaternion::getIdentity(), {0, 0, 1}, {0, 0, 0},
                       {0, 0, 0}, true);
    body.finalizeMultiDof();
    bullet::undamp(body);
    btSphereShape shape(1);
    btMultiBodyLinkCollider collider(&body, 0);
    collider.setCollisionShape(&shape);
    body.getLink(0).m_collider = &collider;
    dynamics.addCollisionObject(&collider, 0, 0);
    dynamics.addMultiBody(&body);
    bullet::MultiBodyPlasticHinge<OneAxisJoint<Perfect<double>, TravelLimit<double>>> hinge(
        body, 0,
        OneAxisJoint(Perfect<double>({.strength = 64}), TravelLimit<double>({.limit = 1.5})));
    btMultiBody& moving = body;
    moving.setJointVel(0, 10);
    std::vector<std::string> told;
    {
        bullet::World world(dynamics);
        world.on_event([&told](const JointEvent<double>& event) {
            told.push_back(event.name + " " + std::string(to_string(event.kind)));
        });
        world.add(hinge, "knee");
        for (int i = 0; i < 30; ++i) world.step(1e-2);
        CHECK_THROWS_AS(world.ledger(), std::logic_error); // whatever it would leave out
        world.remove(hinge);
    }
    CHECK(told == std::vector<std::string>{"knee yielded", "knee broke"});
    CHECK(hinge.absorbed_energy() == Approx(96).epsilon(single ? 1e-3 : 1e-6));
    BulletWorld rig("si");
    bullet::World plain(rig.world());
    CHECK(message_of([&] { plain.add(hinge); }) ==
          "World.world: must be a btMultiBodyDynamicsWorld for the joint of a multibody");
    dynamics.removeMultiBody(&body);
    dynamics.removeCollisionObject(&collider);
}
