// SPDX-License-Identifier: MIT
//
// A tick of some islands of a world, the rest of which stays as it is to the last bit: what
// Bullet's own does for all, by public calls for theirs.
//
//   gravity, damping, prediction, bounds, broadphase, the near callback for their pairs, islands
//   and who sleeps or wakes, their solve, their motion, the end of the tick of their joints
//
// The order is Bullet's: pairs by their numbers, bodies and constraints by their places, so that an
// island ticked alone gets the bits that it has in a world of its own.
//
// Who touches a body that is not among them is found and told; the tick has to be put back then.
//
// Not for worlds with callbacks, actions, solvers, dispatchers or island managers of another kind,
// kinematic bodies, or continuous collision: `is_possible`.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <typeinfo>
#include <utility>
#include <vector>

#include "ductile/bullet/local_scope.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/vocabulary/disjoint_sets.hpp"

namespace ductile::bullet {

class LocalTick {
  public:
    /// `usual`: who solves what is no plastic joint's.
    [[nodiscard]] static bool is_possible(btDiscreteDynamicsWorld& world,
                                          const btConstraintSolver& usual) {
        const btDispatcher& dispatcher = *world.getDispatcher();
        const auto& bodies = MovingBodies::of(world);
        for (int i = 0; i < bodies.size(); ++i) {
            if (bodies[i]->isKinematicObject() || bodies[i]->getCcdSquareMotionThreshold() > 0) {
                return false;
            }
        }
        return typeid(world) == typeid(btDiscreteDynamicsWorld) &&
               typeid(dispatcher) == typeid(btCollisionDispatcher) &&
               typeid(usual) == typeid(btSequentialImpulseConstraintSolver) &&
               (world.getSolverInfo().m_solverMode & SOLVER_RANDMIZE_ORDER) == 0 &&
               world.getSimulationIslandManager()->getSplitIslands() &&
               world.getForceUpdateAllAabbs();
    }

    /// `moved`: is called when the bodies were moved, before joints book.
    void go(btDiscreteDynamicsWorld& world, LocalScope& scope, btScalar h,
            const std::function<void()>& moved) {
        for (btRigidBody* body : scope.bodies()) {
            if (body->isActive()) body->applyGravity();
            body->applyDamping(h);
            body->predictIntegratedTransform(h, body->getInterpolationWorldTransform());
        }
        btDispatcherInfo& info = world.getDispatchInfo();
        info.m_timeStep = h;
        info.m_stepCount = 0;
        collide(world, scope);
        find_islands(world, scope);
        solve(world, scope, h);
        btTransform predicted;
        for (btRigidBody* body : scope.bodies()) {
            body->setHitFraction(1);
            if (!body->isActive()) continue;
            body->predictIntegratedTransform(h, predicted);
            body->proceedToTransform(predicted);
        }
        moved();
        finish(scope, h);
    }
    /// Bodies beside those of the scope that the last tick found touching them.
    [[nodiscard]] const std::vector<btRigidBody*>& touched() const noexcept { return touched_; }

    /// Looks for contacts of the scope's bodies where they are.
    void collide(btDiscreteDynamicsWorld& world, LocalScope& scope) {
        for (btRigidBody* body : scope.bodies()) world.updateSingleAabb(body);
        world.computeOverlappingPairs();
        find_pairs(world, scope);
        auto& dispatcher = static_cast<btCollisionDispatcher&>(*world.getDispatcher());
        scope.listed_manifolds().clear();
        touching_.clear();
        touched_.clear();
        for (btBroadphasePair* pair : pairs_) {
            dispatcher.getNearCallback()(*pair, dispatcher, world.getDispatchInfo());
            if (pair->m_algorithm == nullptr) continue;
            found_.resize(0);
            pair->m_algorithm->getAllContactManifolds(found_);
            for (int k = 0; k < found_.size(); ++k) {
                btPersistentManifold* manifold = found_[k];
                scope.listed_manifolds().push_back(manifold);
                const btCollisionObject &a = *manifold->getBody0(), &b = *manifold->getBody1();
                if (manifold->getNumContacts() == 0 || !dispatcher.needsResponse(&a, &b)) continue;
                touching_.push_back(manifold);
                for (const btCollisionObject* object : {&a, &b}) {
                    if (object->isStaticOrKinematicObject() || scope.has(*object)) continue;
                    auto* body = const_cast<btRigidBody*>(btRigidBody::upcast(object));
                    if (body != nullptr) touched_.push_back(body);
                }
            }
        }
        // as a snapshot lists them, which tells several of one pair apart by their order
        std::sort(scope.listed_manifolds().begin(), scope.listed_manifolds().end(),
                  [](const auto* x, const auto* y) { return x->m_index1a < y->m_index1a; });
    }

  private:
    /// In the order in which Bullet goes through pairs that it sorts.
    void find_pairs(btDiscreteDynamicsWorld& world, const LocalScope& scope) {
        proxies_.clear();
        for (const btRigidBody* body : scope.bodies()) {
            proxies_.push_back(body->getBroadphaseProxy());
        }
        std::sort(proxies_.begin(), proxies_.end());
        pairs_.clear();
        btOverlappingPairCache& cache = *world.getPairCache();
        btBroadphasePair* all = cache.getOverlappingPairArrayPtr();
        const int count = cache.getNumOverlappingPairs();
        const auto is_ours = [this](const btBroadphaseProxy* proxy) {
            constexpr std::size_t few = 16;
            if (proxies_.size() > few) {
                return std::binary_search(proxies_.begin(), proxies_.end(), proxy);
            }
            return std::find(proxies_.begin(), proxies_.end(), proxy) != proxies_.end();
        };
        for (int i = 0; i < count; ++i) {
            if (is_ours(all[i].m_pProxy0) || is_ours(all[i].m_pProxy1)) pairs_.push_back(&all[i]);
        }
        std::sort(pairs_.begin(), pairs_.end(),
                  [](const btBroadphasePair* x, const btBroadphasePair* y) {
                      const auto numbers = [](const btBroadphasePair& pair) {
                          return std::pair(pair.m_pProxy0->m_uniqueId, pair.m_pProxy1->m_uniqueId);
                      };
                      return numbers(*x) > numbers(*y);
                  });
    }
    /// As Bullet's island manager and meeting_islands.hpp do it.
    void find_islands(btDiscreteDynamicsWorld& world, LocalScope& scope) {
        const auto bodies = scope.bodies();
        islands_.reset(bodies.size());
        const auto merge = [&](const btCollisionObject& a, const btCollisionObject& b) {
            if (scope.has(a) && scope.has(b)) {
                islands_.unite(scope.number(a), scope.number(b));
            }
        };
        for (const btBroadphasePair* pair : pairs_) {
            const btBroadphaseProxy &a = *pair->m_pProxy0, &b = *pair->m_pProxy1;
            if (!TestAabbAgainstAabb2(a.m_aabbMin, a.m_aabbMax, b.m_aabbMin, b.m_aabbMax)) continue;
            const auto &of_a = *static_cast<const btCollisionObject*>(a.m_clientObject),
                       &of_b = *static_cast<const btCollisionObject*>(b.m_clientObject);
            if (of_a.mergesSimulationIslands() && of_b.mergesSimulationIslands()) merge(of_a, of_b);
        }
        for (const btTypedConstraint* constraint : scope.constraints()) {
            if (constraint->isEnabled()) {
                merge(constraint->getRigidBodyA(), constraint->getRigidBodyB());
            }
        }
        awake_.assign(bodies.size(), 0);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const int state = bodies[i]->getActivationState();
            if (state == ACTIVE_TAG || state == DISABLE_DEACTIVATION) {
                awake_[std::size_t(islands_.root(int(i)))] = 1;
            }
        }
        const int beyond = world.getNumCollisionObjects(); // Bullet's own numbers are below
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            btRigidBody& body = *bodies[i];
            const int of = islands_.root(int(i));
            body.setIslandTag(beyond + bodies[std::size_t(of)]->getWorldArrayIndex());
            body.setCompanionId(-1);
            if (awake_[std::size_t(of)] == 0) {
                body.setActivationState(ISLAND_SLEEPING);
            } else if (body.getActivationState() == ISLAND_SLEEPING) {
                body.setActivationState(WANTS_DEACTIVATION);
                body.setDeactivationTime(0);
            }
        }
    }
    void solve(btDiscreteDynamicsWorld& world, const LocalScope& scope, btScalar h) {
        const auto acts = [&scope](const btCollisionObject& object) {
            return scope.has(object) && object.isActive();
        };
        solved_bodies_.clear();
        solved_manifolds_.clear();
        solved_constraints_.clear();
        for (btRigidBody* body : scope.bodies()) {
            if (body->isActive()) solved_bodies_.push_back(body);
        }
        for (btPersistentManifold* manifold : touching_) {
            const btCollisionObject &a = *manifold->getBody0(), &b = *manifold->getBody1();
            const auto is_elsewhere = [&scope](const btCollisionObject& object) {
                return !object.isStaticOrKinematicObject() && !scope.has(object);
            };
            if (is_elsewhere(a) || is_elsewhere(b) || !(acts(a) || acts(b))) continue;
            solved_manifolds_.push_back(manifold);
        }
        for (btTypedConstraint* constraint : scope.constraints()) {
            if (acts(constraint->getRigidBodyA()) || acts(constraint->getRigidBodyB())) {
                solved_constraints_.push_back(constraint);
            }
        }
        btContactSolverInfo& info = world.getSolverInfo();
        info.m_timeStep = h;
        if (solved_bodies_.empty()) return;
        btConstraintSolver& solver = *world.getConstraintSolver();
        solver.prepareSolve(int(solved_bodies_.size()), int(solved_manifolds_.size()));
        solver.solveGroup(solved_bodies_.data(), int(solved_bodies_.size()),
                          solved_manifolds_.data(), int(solved_manifolds_.size()),
                          solved_constraints_.data(), int(solved_constraints_.size()), info,
                          world.getDebugDrawer(), world.getDispatcher());
        // not allSolved, by which a front forgets islands that were not solved (front_solver.hpp)
    }
    void finish(LocalScope& scope, btScalar h) {
        joints_.clear();
        for (const LocalScope::Joint& entry : scope.joints()) joints_.push_back(entry.joint);
        TickMember::end_tick_of(joints_);
        for (btRigidBody* body : scope.bodies()) {
            body->updateDeactivation(h);
            if (body->wantsSleeping()) {
                if (body->getActivationState() == ACTIVE_TAG) {
                    body->setActivationState(WANTS_DEACTIVATION);
                }
                if (body->getActivationState() == ISLAND_SLEEPING) {
                    body->setAngularVelocity(btVector3(0, 0, 0));
                    body->setLinearVelocity(btVector3(0, 0, 0));
                }
            } else if (body->getActivationState() != DISABLE_DEACTIVATION) {
                body->setActivationState(ACTIVE_TAG);
            }
            body->clearForces();
        }
    }

    std::vector<const btBroadphaseProxy*> proxies_; ///< of the bodies, sorted
    std::vector<btBroadphasePair*> pairs_;
    std::vector<btPersistentManifold*> touching_;
    std::vector<btRigidBody*> touched_;
    DisjointSets islands_;    ///< of bodies of the scope
    std::vector<char> awake_; ///< by root
    btManifoldArray found_;
    std::vector<btCollisionObject*> solved_bodies_;
    std::vector<btPersistentManifold*> solved_manifolds_;
    std::vector<btTypedConstraint*> solved_constraints_;
    std::vector<TickMember*> joints_;
};

} // namespace ductile::bullet
