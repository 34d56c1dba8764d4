// SPDX-License-Identifier: MIT
//
// Bodies of meeting_islands.hpp.
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <LinearMath/btAabbUtil2.h>

#include <new>
#include <typeinfo>
#include <utility>

#include "ductile/bullet/meeting_islands.hpp"

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

DUCTILE_INLINE MeetingIslands* MeetingIslands::enter(btDiscreteDynamicsWorld& world) {
    btSimulationIslandManager*& place = detail::IslandsOfWorld::of(world);
    if (typeid(*place) != typeid(btSimulationIslandManager)) return nullptr;
    void* room = btAlignedAlloc(sizeof(MeetingIslands), 16);
    bool& owned = detail::IslandsOfWorld::owned(world);
    auto* islands = new (room) MeetingIslands(*place, std::exchange(owned, true));
    islands->setSplitIslands(place->getSplitIslands());
    place = islands;
    return islands;
}

DUCTILE_INLINE void MeetingIslands::leave(btDiscreteDynamicsWorld& world) {
    usual_->setSplitIslands(getSplitIslands());
    detail::IslandsOfWorld::of(world) = std::exchange(usual_, nullptr);
    detail::IslandsOfWorld::owned(world) = owned_;
    this->~MeetingIslands();
    btAlignedFree(this);
}

DUCTILE_INLINE MeetingIslands::~MeetingIslands() {
    if (usual_ == nullptr || !owned_) return;
    usual_->~btSimulationIslandManager();
    btAlignedFree(usual_);
}

DUCTILE_INLINE void MeetingIslands::updateActivationState(btCollisionWorld* world,
                                                          btDispatcher* dispatcher) {
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

} // namespace ductile::bullet
