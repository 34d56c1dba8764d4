// SPDX-License-Identifier: MIT
//
// Plastic hinges whose islands are solved by several threads: the same bits as with one.
//
// Bullet guarantees that an island is solved by one thread, with a solver of its own, and that
// actions run after all islands. A constraint must then touch nothing but itself and the bodies of
// its island. Debian builds Bullet without BT_THREADSAFE: its world for threads runs, but on one.
// So the islands are also handed to threads here, as Bullet built with BT_THREADSAFE does it.
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Dynamics/btSimulationIslandManagerMt.h>
#include <LinearMath/btThreads.h>
#include <btBulletDynamicsCommon.h>

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/member/strips.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/members.hpp"

using namespace ductile;

namespace {

using Hinge = bullet::PlasticHinge<OneAxisJoint<Perfect<double>, TravelLimit<double>>>;

constexpr std::size_t pairs = 60;

/// Two bodies on a hinge off their centres, of different masses, speeds and strengths: a third of
/// them breaks, a third stops, a third stays rigid.
class Pair {
  public:
    Pair(std::size_t i, btCollisionShape& shape) {
        const auto n = btScalar(i);
        for (int side = 0; side < 2; ++side) {
            btRigidBody::btRigidBodyConstructionInfo info(
                1 + btScalar(0.03) * n + btScalar(side), nullptr, &shape,
                {btScalar(0.1), btScalar(0.3), btScalar(0.4) + btScalar(0.01) * n});
            info.m_startWorldTransform.setOrigin({4 * n, btScalar(2 * side - 1), 0});
            body[side] = std::make_unique<btRigidBody>(info);
            body[side]->setActivationState(DISABLE_DEACTIVATION);
        }
        body[0]->setAngularVelocity({0, 0, 3 + btScalar(0.1) * n});
        btTransform below, above;
        below.setIdentity(), above.setIdentity();
        below.setOrigin({0, 1, 0}), above.setOrigin({0, -1, 0});
        const double strength = i % 3 == 2 ? 1e4 : 2 + 0.05 * double(i);
        hinge = std::make_unique<Hinge>(
            *body[0], *body[1], below, above,
            OneAxisJoint(Perfect<double>({.strength = strength}),
                         TravelLimit<double>({.limit = i % 3 == 0 ? 0.05 : 1e3})));
    }
    std::unique_ptr<btRigidBody> body[2];
    std::unique_ptr<Hinge> hinge;
};

/// A solver by name, of the class that users would take: joints know it.
class PlainSolver {
  public:
    explicit PlainSolver(const std::string& name) {
        if (name == "si") {
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        } else if (name == "front") {
            usual_ = std::make_unique<btSequentialImpulseConstraintSolver>();
            solver_ = std::make_unique<bullet::FrontSolver>(*usual_, false);
        } else {
            throw std::invalid_argument("no solver " + name);
        }
    }
    [[nodiscard]] btConstraintSolver& operator*() { return *solver_; }

  private:
    std::unique_ptr<btConstraintSolver> usual_, solver_;
};

/// A world of separate pairs of any kind of world.
template <class World>
class Scene {
  public:
    template <class... Arguments>
    explicit Scene(bool commit_at_end_of_tick, Arguments&&... arguments)
        : world(&dispatcher_, &broadphase_, std::forward<Arguments>(arguments)..., &configuration_),
          commit_at_end_of_tick_(commit_at_end_of_tick) {
        world.setGravity({0, -1, 0});
        for (std::size_t i = 0; i < pairs; ++i) {
            all.push_back(std::make_unique<Pair>(i, shape_));
            for (auto& body : all.back()->body) world.addRigidBody(body.get(), 0, 0);
            if (commit_at_end_of_tick) {
                all.back()->hinge->add_to(world);
            } else {
                world.addConstraint(all.back()->hinge.get());
            }
        }
    }
    ~Scene() {
        for (auto& pair : all) {
            if (commit_at_end_of_tick_) {
                pair->hinge->remove_from(world);
            } else {
                world.removeConstraint(pair->hinge.get());
            }
            for (auto& body : pair->body) world.removeRigidBody(body.get());
        }
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i)
            world.stepSimulation(btScalar(1) / 240, 0, btScalar(1) / 240);
    }
    /// All that is known of the hinges and bodies.
    std::vector<double> state() {
        std::vector<double> result;
        for (auto& pair : all) {
            Hinge& h = *pair->hinge;
            result.insert(result.end(), {h.rotation(), h.plastic_rotation(), h.absorbed_energy(),
                                         h.moment(), h.residual_max(), double(h.broken())});
            for (const auto& body : pair->body) {
                for (int k = 0; k < 3; ++k) {
                    result.push_back(double(body->getCenterOfMassPosition()[k]));
                    result.push_back(double(body->getLinearVelocity()[k]));
                    result.push_back(double(body->getAngularVelocity()[k]));
                }
            }
        }
        return result;
    }
    [[nodiscard]] std::size_t broken() {
        std::size_t count = 0;
        for (auto& pair : all) count += pair->hinge->broken();
        return count;
    }

  private:
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSphereShape shape_{1};

  public:
    World world;
    std::vector<std::unique_ptr<Pair>> all;

  private:
    bool commit_at_end_of_tick_;
};

/// Solves every constraint as an island, by as many threads as there are solvers.
class IslandThreads final : public btDiscreteDynamicsWorld {
  public:
    IslandThreads(btDispatcher* dispatcher, btBroadphaseInterface* broadphase,
                  std::vector<PlainSolver>* solvers, btCollisionConfiguration* configuration)
        : btDiscreteDynamicsWorld(dispatcher, broadphase, &*solvers->front(), configuration),
          solvers_(*solvers) {}

  protected:
    void solveConstraints(btContactSolverInfo& info) override {
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < solvers_.size(); ++t) {
            threads.emplace_back([this, t, &info] { solve_every(solvers_.size(), t, info); });
        }
        for (auto& thread : threads) thread.join();
    }

  private:
    void solve_every(std::size_t stride, std::size_t first, const btContactSolverInfo& info) {
        for (auto i = int(first); i < getNumConstraints(); i += int(stride)) {
            btTypedConstraint* constraint = getConstraint(i);
            btCollisionObject* bodies[] = {&constraint->getRigidBodyA(),
                                           &constraint->getRigidBodyB()};
            (*solvers_[first])
                .solveGroup(bodies, 2, nullptr, 0, &constraint, 1, info, nullptr, nullptr);
        }
    }
    std::vector<PlainSolver>& solvers_;
};

std::vector<PlainSolver> solvers(const std::string& name, std::size_t count) {
    std::vector<PlainSolver> result;
    for (std::size_t i = 0; i < count; ++i) result.emplace_back(name);
    return result;
}

constexpr int steps = 120;

} // namespace

TEST_CASE("islands solved by four threads are those of one thread, bit for bit",
          "[bullet][threads]") {
    const std::string name = GENERATE(as<std::string>(), "si", "front");
    // with the action at the end of the tick, or in the next tick's solve, by the solver's thread
    const bool commit_at_end_of_tick = GENERATE(true, false);
    INFO(name << (commit_at_end_of_tick ? ", committed at the tick's end" : ", committed late"));
    auto one = solvers(name, 1), four = solvers(name, 4);
    Scene<IslandThreads> serial(commit_at_end_of_tick, &one);
    Scene<IslandThreads> parallel(commit_at_end_of_tick, &four);
    serial.run(steps), parallel.run(steps);
    CHECK(serial.state() == parallel.state());
    CHECK(parallel.broken() == pairs / 3);
}

TEST_CASE("Bullet's world for threads is its world for one, bit for bit", "[bullet][threads]") {
    std::unique_ptr<btITaskScheduler> own(
        btCreateDefaultTaskScheduler()); // null: not BT_THREADSAFE
    btSetTaskScheduler(own != nullptr ? own.get() : btGetSequentialTaskScheduler());
    const bool exact = GENERATE(false, true);
    INFO((exact ? "front" : "sequential impulse"));
    std::vector<std::unique_ptr<PlainSolver>> usual;
    std::vector<btConstraintSolver*> pool_of;
    for (int i = 0; i < 4; ++i) { // the pool deletes its solvers
        if (exact) {
            usual.push_back(std::make_unique<PlainSolver>("si"));
            pool_of.push_back(new bullet::FrontSolver(**usual.back(), false));
        } else {
            pool_of.push_back(new btSequentialImpulseConstraintSolver);
        }
    }
    btConstraintSolverPoolMt pool(pool_of.data(), int(pool_of.size()));
    PlainSolver alone(exact ? "front" : "si");
    {
        Scene<btDiscreteDynamicsWorld> serial(true, &*alone);
        Scene<btDiscreteDynamicsWorldMt> parallel(true, &pool, nullptr);
        // islands of their own, not gathered to batches: early exits look at the whole batch
        serial.world.getSolverInfo().m_minimumSolverBatchSize = 1;
        static_cast<btSimulationIslandManagerMt*>(parallel.world.getSimulationIslandManager())
            ->setMinimumSolverBatchSize(1);
        serial.run(steps), parallel.run(steps);
        CHECK(serial.state() == parallel.state());
        CHECK(parallel.broken() == pairs / 3);
    }
    btSetTaskScheduler(nullptr);
}

TEST_CASE("worlds in threads of their own do not know of each other", "[bullet][threads]") {
    const auto state_after = [](std::size_t count) {
        std::vector<PlainSolver> own = solvers("front", count);
        std::vector<std::unique_ptr<Scene<btDiscreteDynamicsWorld>>> scenes;
        for (PlainSolver& solver : own) {
            scenes.push_back(std::make_unique<Scene<btDiscreteDynamicsWorld>>(true, &*solver));
        }
        std::vector<std::thread> threads;
        for (auto& scene : scenes) threads.emplace_back([&scene] { scene->run(steps); });
        for (auto& thread : threads) thread.join();
        for (auto& scene : scenes) CHECK(scene->state() == scenes.front()->state());
        return scenes.front()->state();
    };
    CHECK(state_after(4) == state_after(1));
}

namespace {

using Manager = btSimulationIslandManagerMt;

/// Four threads for the islands, as Bullet hands them out where it was built for threads.
void solve_in_threads(btAlignedObjectArray<Manager::Island*>* islands,
                      const Manager::SolverParams& with) {
    constexpr int count = 4;
    std::vector<std::thread> threads;
    for (int t = 0; t < count; ++t) {
        threads.emplace_back([islands, &with, t] {
            for (int i = t; i < islands->size(); i += count) {
                Manager::solveIsland(with.m_solverPool, *(*islands)[i], with);
            }
        });
    }
    for (auto& thread : threads) thread.join();
}

/// A solver for each island: Bullet's own pool locks nothing where it was not built for threads.
class SolverPerIsland final : public btConstraintSolverPoolMt {
  public:
    SolverPerIsland() : btConstraintSolverPoolMt(1) {}
    btScalar solveGroup(btCollisionObject** bodies, int body_count,
                        btPersistentManifold** manifolds, int manifold_count,
                        btTypedConstraint** constraints, int constraint_count,
                        const btContactSolverInfo& info, btIDebugDraw* drawer,
                        btDispatcher* dispatcher) override {
        btSequentialImpulseConstraintSolver solver;
        return solver.solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                                 constraint_count, info, drawer, dispatcher);
    }
};

/// Eight posts that balls strike, or not, the last two tied together, and piles of boxes that touch
/// none of them.
template <class Engine>
class Posts {
  public:
    template <class... Arguments>
    Posts(bool struck, double tolerance, Arguments&&... arguments)
        : engine(&dispatcher_, &broadphase_, std::forward<Arguments>(arguments)...,
                 &configuration_),
          world_(engine, {.tolerance = tolerance, .warn = {}}) {
        engine.setGravity({0, 0, btScalar(-9.81)});
        engine.getDispatchInfo().m_deterministicOverlappingPairs = true;
        engine.getSolverInfo().m_minimumSolverBatchSize = 1;
        post_.addChildShape(btTransform(btQuaternion::getIdentity(), {0, 0, 1}), &half_post_);
        for (int i = 0; i < 8; ++i) {
            const btVector3 at(btScalar(5 * i), 0, 0);
            members.push_back(std::make_unique<bullet::Member>(
                add(0, post_, at), test::heavy_post(), btTransform::getIdentity(),
                bullet::MemberBox{0.05, 0.05}));
            btRigidBody& ball = add(100, ball_, at + btVector3(0, btScalar(-0.16), btScalar(1.9)));
            if (struck) ball.setLinearVelocity({0, btScalar(1 + 0.3 * i), 0});
        }
        btRigidBody& between = add(20, ball_, {btScalar(32.5), 0, 2});
        for (bullet::Member* member : {members[6].get(), members[7].get()}) {
            const auto x = btScalar(member == members[6].get() ? -2.5 : 2.5);
            member->attach(2, [&between, x](btRigidBody& piece, const btTransform& at) {
                return std::make_unique<btPoint2PointConstraint>(piece, between, at.getOrigin(),
                                                                 btVector3(x, 0, 0));
            });
        }
        for (auto& member : members) world_.add(*member);
        (void)add(0, ground_, {0, 20, -1});
        for (int i = 0; i < 60; ++i) {
            const auto x = btScalar(i);
            others_.push_back(&add(1 + x, box_, {x, 20, btScalar(0.26)}));
            others_.push_back(&add(1, box_, {x + btScalar(0.1), 20, btScalar(0.8)}));
        }
    }
    ~Posts() {
        members.clear();
        for (auto& body : bodies_) engine.removeRigidBody(body.get());
    }
    Posts(const Posts&) = delete;
    Posts& operator=(const Posts&) = delete;

    void run() {
        for (int i = 0; i < 60; ++i) {
            world_.step(1.0 / 120);
            for (const auto& member : members) {
                seen.push_back(btScalar(member->absorbed_energy()));
                opened = opened || !member->whole();
                for (int k = 0; k <= 10; ++k) see(member->pose(k).getOrigin(), seen);
            }
            for (const btRigidBody* body : others_) {
                see(body->getCenterOfMassPosition(), seen_of_others);
                see(body->getAngularVelocity(), seen_of_others);
            }
        }
    }

  private:
    btRigidBody& add(btScalar mass, btCollisionShape& shape, const btVector3& at) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        engine.addRigidBody(bodies_.back().get());
        return *bodies_.back();
    }
    static void see(const btVector3& v, std::vector<btScalar>& to) {
        to.insert(to.end(), {v.x(), v.y(), v.z()});
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btCompoundShape post_;
    btBoxShape half_post_{{btScalar(0.05), btScalar(0.05), 1}},
        box_{{btScalar(0.25), btScalar(0.25), btScalar(0.25)}}, ground_{{100, 5, 1}};
    btSphereShape ball_{btScalar(0.1)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<btRigidBody*> others_;

  public:
    Engine engine;

  private:
    bullet::World world_;

  public:
    std::vector<std::unique_ptr<bullet::Member>> members;
    std::vector<btScalar> seen, seen_of_others; ///< in every frame
    bool opened = false;
};

} // namespace

TEST_CASE("members that open in islands solved by four threads are those of one, bit for bit",
          "[bullet][threads][member]") {
    const double tolerance = GENERATE(0.0, 0.01);
    CAPTURE(tolerance);
    const auto run = [tolerance](Manager::IslandDispatchFunc dispatch, bool struck) {
        SolverPerIsland solver;
        Posts<btDiscreteDynamicsWorldMt> scene(struck, tolerance, &solver, nullptr);
        auto& manager = static_cast<Manager&>(*scene.engine.getSimulationIslandManager());
        manager.setMinimumSolverBatchSize(1);
        manager.setIslandDispatchFunction(dispatch);
        scene.run();
        CHECK(scene.opened == struck);
        return std::pair{scene.seen, scene.seen_of_others};
    };
    const auto serial = run(Manager::serialIslandDispatch, true),
               parallel = run(solve_in_threads, true);
    CHECK((parallel.first == serial.first));
    CHECK((parallel.second == serial.second));
    if (tolerance > 0) return; // parts are of all bodies, where there are members
    CHECK((parallel.second == run(solve_in_threads, false).second));
    // in parts it has the contacts of an island in another order
    btSequentialImpulseConstraintSolver alone;
    Posts<btDiscreteDynamicsWorld> usual(true, tolerance, &alone);
    usual.run();
    CHECK((parallel.first == usual.seen));
}
