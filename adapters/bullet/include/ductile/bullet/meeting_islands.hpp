// SPDX-License-Identifier: MIT
//
// Bullet's islands of bodies whose bounds overlap now, by which it puts them to sleep. Its own are
// of pairs that its broadphase has not yet dropped, which depends on what was tried meanwhile.
//
// Not for worlds with an island manager of another kind, as that of threads is: theirs stays.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <LinearMath/btAabbUtil2.h>

#include <new>
#include <typeinfo>
#include <utility>

namespace ductile::bullet {

namespace detail {

/// Bullet's own members are not public.
struct IslandsOfWorld : btDiscreteDynamicsWorld {
    static btSimulationIslandManager*& of(btDiscreteDynamicsWorld& world) {
        return world.*(&IslandsOfWorld::m_islandManager);
    }
    static bool& owned(btDiscreteDynamicsWorld& world) {
        return world.*(&IslandsOfWorld::m_ownsIslandManager);
    }
};

} // namespace detail

class MeetingIslands final : public btSimulationIslandManager {
  public:
    /// Takes the place of the world's manager; the world ends it where nobody did before. Null
    /// where the world's stays.
    [[nodiscard]] static MeetingIslands* enter(btDiscreteDynamicsWorld& world) {
        btSimulationIslandManager*& place = detail::IslandsOfWorld::of(world);
        if (typeid(*place) != typeid(btSimulationIslandManager)) return nullptr;
        void* room = btAlignedAlloc(sizeof(MeetingIslands), 16);
        bool& owned = detail::IslandsOfWorld::owned(world);
        auto* islands = new (room) MeetingIslands(*place, std::exchange(owned, true));
        islands->setSplitIslands(place->getSplitIslands());
        place = islands;
        return islands;
    }
    /// Gives the place back and ends this; the world must be alive.
    void leave(btDiscreteDynamicsWorld& world) {
        usual_->setSplitIslands(getSplitIslands());
        detail::IslandsOfWorld::of(world) = std::exchange(usual_, nullptr);
        detail::IslandsOfWorld::owned(world) = owned_;
        this->~MeetingIslands();
        btAlignedFree(this);
    }

    void updateActivationState(btCollisionWorld* world, btDispatcher* dispatcher) override {
        btSimulationIslandManager::updateActivationState(world, dispatcher); // numbers the bodies
        initUnionFind(getUnionFind().getNumElements());
        btOverlappingPairCache& cache = *world->getPairCache();
        const btBroadphasePair* pairs = cache.getOverlappingPairArrayPtr();
        for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
            const btBroadphaseProxy &a = *pairs[i].m_pProxy0, &b = *pairs[i].m_pProxy1;
            if (!TestAabbAgainstAabb2(a.m_aabbMin, a.m_aabbMax, b.m_aabbMin, b.m_aabbMax)) continue;
            const auto* of_a = static_cast<const btCollisionObject*>(a.m_clientObject);
            const auto* of_b = static_cast<const btCollisionObject*>(b.m_clientObject);
            if (of_a == nullptr || of_b == nullptr) continue;
            if (of_a->mergesSimulationIslands() && of_b->mergesSimulationIslands()) {
                getUnionFind().unite(of_a->getIslandTag(), of_b->getIslandTag());
            }
        }
    }

  private:
    MeetingIslands(btSimulationIslandManager& usual, bool owned) : usual_(&usual), owned_(owned) {}
    ~MeetingIslands() override {
        if (usual_ == nullptr || !owned_) return;
        usual_->~btSimulationIslandManager();
        btAlignedFree(usual_);
    }

    btSimulationIslandManager* usual_; ///< null once it was given back
    bool owned_;
};

} // namespace ductile::bullet
