// SPDX-License-Identifier: MIT
//
// Bodies of front_solver.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <utility>

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/face_points.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/lent.hpp"
#include "ductile/frame/part_settings.hpp"

namespace ductile::bullet {

namespace detail {

/// One that is switched off, as a broken one is, leaves its island to the user's solver.
[[nodiscard]] DUCTILE_INLINE bool is_plastic(btTypedConstraint* constraint) {
    return constraint->isEnabled() && as_plastic(*constraint) != nullptr;
}

[[nodiscard]] DUCTILE_INLINE bool is_plastic_or_sprung(btTypedConstraint* constraint) {
    return is_plastic(constraint) || has_springs(*constraint);
}
/// By a joint, or a member that is whole, which may stand still; else it has springs alone.
[[nodiscard]] DUCTILE_INLINE bool has_plastic(const IslandParts& island,
                                              const DirectBodies& direct) {
    const auto touches = [&direct](const btCollisionObject& a, const btCollisionObject& b) {
        return direct.has(a) || direct.has(b);
    };
    const auto any = [](const auto& of, const auto& is) {
        return std::any_of(of.begin(), of.end(), is);
    };
    return any(island.bodies, [&](const btCollisionObject* body) { return direct.has(*body); }) ||
           any(island.manifolds,
               [&](const btPersistentManifold* manifold) {
                   return touches(*manifold->getBody0(), *manifold->getBody1());
               }) ||
           any(island.constraints, [&](btTypedConstraint* constraint) {
               return is_plastic(constraint) ||
                      touches(constraint->getRigidBodyA(), constraint->getRigidBodyB());
           });
}

/// Of Bullet's joints and contacts it has none: it leaves nothing of itself in its solver.
[[nodiscard]] DUCTILE_INLINE bool is_one_joint(const IslandParts& island) {
    return island.manifolds.empty() && island.constraints.size() == 1 &&
           is_plastic(island.constraints.front());
}

/// Bullet's own members are not public.
struct SolverOfWorld : btDiscreteDynamicsWorld {
    static bool& owned(btDiscreteDynamicsWorld& world) {
        return world.*(&SolverOfWorld::m_ownsConstraintSolver);
    }
};

/// What an island had of it while a plastic joint was in it: a solver of one direction leaves it
/// there.
DUCTILE_INLINE void forget_second_direction(btPersistentManifold** manifolds, int count) {
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) {
            manifolds[i]->getContactPoint(k).m_appliedImpulseLateral2 = 0;
        }
    }
}

/// While this lives contacts that touch are closed, and there are no others. These have no impulse
/// then. What rebounded has left, although it overlaps by what its gap was aimed too far: closed,
/// it would not be struck anew where another blow sends it back.
class StruckContacts {
  public:
    StruckContacts(btPersistentManifold** manifolds, int count, double slowest)
        : slowest_(slowest) {
        for (int i = 0; i < count; ++i) {
            Struck& struck = struck_.emplace_back();
            struck.manifold = manifolds[i];
            struck.count = manifolds[i]->getNumContacts();
            for (int k = 0; k < struck.count; ++k) {
                struck.points[std::size_t(k)] = manifolds[i]->getContactPoint(k);
            }
            manifolds[i]->setNumContacts(0);
            for (int k = 0; k < struck.count; ++k) {
                const btManifoldPoint& point = struck.points[std::size_t(k)];
                struck.closes[std::size_t(k)] = touches(point) && !rebounds(*manifolds[i], point);
                if (!struck.closes[std::size_t(k)]) continue;
                const int here = manifolds[i]->addManifoldPoint(point);
                manifolds[i]->getContactPoint(here).setDistance(0);
            }
        }
    }
    ~StruckContacts() {
        for (Struck& struck : struck_) {
            int solved = 0;
            for (int k = 0; k < struck.count; ++k) {
                btManifoldPoint& point = struck.points[std::size_t(k)];
                const btScalar distance = point.getDistance();
                if (struck.closes[std::size_t(k)]) {
                    point = struck.manifold->getContactPoint(solved++);
                    point.setDistance(distance);
                } else {
                    point.m_appliedImpulse = 0;
                    point.m_appliedImpulseLateral1 = point.m_appliedImpulseLateral2 = 0;
                }
            }
            struck.manifold->setNumContacts(0);
            for (int k = 0; k < struck.count; ++k) {
                struck.manifold->addManifoldPoint(struck.points[std::size_t(k)]);
            }
        }
    }
    StruckContacts(const StruckContacts&) = delete;
    StruckContacts& operator=(const StruckContacts&) = delete;

  private:
    struct Struck {
        btPersistentManifold* manifold = nullptr;
        int count = 0;
        std::array<btManifoldPoint, MANIFOLD_CACHE_SIZE> points;
        std::array<bool, MANIFOLD_CACHE_SIZE> closes{};
    };
    [[nodiscard]] static bool touches(const btManifoldPoint& point) {
        return double(point.getDistance()) < closed_gap;
    }
    [[nodiscard]] bool rebounds(const btPersistentManifold& manifold,
                                const btManifoldPoint& point) const {
        constexpr double hardly_less = 0.99;
        const auto e = double(point.m_combinedRestitution);
        return e > 0 && parting_speed(*manifold.getBody0(), *manifold.getBody1(), point,
                                      point.m_normalWorldOnB) > hardly_less * e * slowest_;
    }

    double slowest_; ///< speed from which contacts rebound [m/s]
    std::vector<Struck> struck_;
};

/// Contacts that are open are twice as far apart, so that half a part closes them, and may overlap
/// then by as much as gaps are aimed beyond their closing.
DUCTILE_INLINE void double_gaps(btPersistentManifold** manifolds, int count, Lent<btScalar>& lent) {
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) {
            btScalar& distance = manifolds[i]->getContactPoint(k).m_distance1;
            if (distance > 0) lent.put(distance, 2 * distance + btScalar(closed_gap));
        }
    }
}

/// Contacts that are open do not rebound: Bullet asks e v - d/h of them before they touch, and no
/// cut of the part ends that. They close in it, and rebound in the blow that follows.
DUCTILE_INLINE void end_rebounds(const std::vector<btPersistentManifold*>& manifolds,
                                 Lent<btScalar>& lent) {
    for (btPersistentManifold* manifold : manifolds) {
        for (int k = 0; k < manifold->getNumContacts(); ++k) {
            btManifoldPoint& point = manifold->getContactPoint(k);
            const bool is_open = double(point.getDistance()) > closed_gap;
            if (is_open && point.m_combinedRestitution > 0) {
                lent.put(point.m_combinedRestitution, 0);
            }
        }
    }
}

/// Contacts of what the joints of `constraints` held until they broke push apart slowly
/// (parted_erp), in a step of `info`.
DUCTILE_INLINE void part_slowly(btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, Lent<btScalar>& lent,
                                Lent<int>& flags) {
    constexpr int own = BT_CONTACT_FLAG_HAS_CONTACT_ERP;
    for (int i = 0; i < constraint_count; ++i) {
        PlasticConstraint* joint = as_plastic(*constraints[i]);
        if (joint == nullptr || joint->isEnabled() || !joint->queries().broken()) continue;
        const btCollisionObject* a = &joint->getRigidBodyA();
        const btCollisionObject* b = &joint->getRigidBodyB();
        for (int k = 0; k < manifold_count; ++k) {
            btPersistentManifold& manifold = *manifolds[k];
            const btCollisionObject *first = manifold.getBody0(), *second = manifold.getBody1();
            if (!(first == a && second == b) && !(first == b && second == a)) continue;
            for (int at = 0; at < manifold.getNumContacts(); ++at) {
                btManifoldPoint& point = manifold.getContactPoint(at);
                const bool has_own = (point.m_contactPointFlags & own) != 0;
                const auto usual = double(has_own ? point.m_contactERP : info.m_erp2);
                lent.put(point.m_contactERP,
                         btScalar(parted_erp(usual, -double(point.getDistance()),
                                             double(info.m_timeStep))));
                flags.put(point.m_contactPointFlags, point.m_contactPointFlags | own);
            }
        }
    }
}

} // namespace detail

DUCTILE_INLINE FrontHold::FrontHold(btDiscreteDynamicsWorld& world) : world_(world) {
    if (dynamic_cast<FrontSolver*>(world.getConstraintSolver()) != nullptr) {
        throw std::invalid_argument(
            "World.world: must have no other World, which would solve its joints too: end that one "
            "first");
    }
    bool& owned = detail::SolverOfWorld::owned(world);
    void* room = btAlignedAlloc(sizeof(FrontSolver), 16);
    auto* front = new (room) FrontSolver(*world.getConstraintSolver(), owned, &world);
    front_ = front->self_;
    owned = false; // else the world would end the user's solver where another one comes
    world.setConstraintSolver(front);
    owned = true;
}

DUCTILE_INLINE FrontHold::~FrontHold() {
    const std::shared_ptr<FrontSolver*> self = front_.lock();
    if (self == nullptr || world_.getConstraintSolver() != *self) return;
    FrontSolver* front = *self;
    bool& owned = detail::SolverOfWorld::owned(world_);
    owned = false;
    world_.setConstraintSolver(&front->usual());
    owned = std::exchange(front->owned_, false);
    front->~FrontSolver();
    btAlignedFree(front);
}

DUCTILE_INLINE FrontSolver::~FrontSolver() {
    if (!owned_) return;
    usual_.~btConstraintSolver();
    btAlignedFree(&usual_);
}

DUCTILE_INLINE void FrontSolver::solve_plastic(IslandParts& island, IslandSolver& solver,
                                               const btContactSolverInfo& info,
                                               btIDebugDraw* drawer, btDispatcher* dispatcher) {
    const detail::StruckContacts struck(island.manifolds.data(),
                                        kind_ == TickKind::blow ? int(island.manifolds.size()) : 0,
                                        double(info.m_restitutionVelocityThreshold));
    Lent<btScalar> lent;
    if (kind_ == TickKind::part) detail::end_rebounds(island.manifolds, lent);
    solver.set_held(held_);
    solver.set_ahead(kind_ == TickKind::part, kind_ == TickKind::blow, frame_);
    // else what overlaps deeply is pushed apart without the joints, which that would strain
    btContactSolverInfo with_joints = info;
    const bool by_depth = info.m_splitImpulsePenetrationThreshold < 0;
    if (kind_ == TickKind::part && by_depth) with_joints.m_splitImpulse = 0;
    solver.set_pushes_apart(kind_ == TickKind::step);
    solver.solveGroup(island.bodies.data(), int(island.bodies.size()), island.manifolds.data(),
                      int(island.manifolds.size()), island.constraints.data(),
                      int(island.constraints.size()), with_joints, drawer, dispatcher);
}

/// Of those that the user's solver gets.
DUCTILE_INLINE void FrontSolver::note_springs(btTypedConstraint** constraints, int count,
                                              double h) {
    if (kind_ != TickKind::part) return;
    const std::lock_guard lock(mutex_);
    for (int i = 0; i < count; ++i) softened_.leave(*constraints[i], h);
}

DUCTILE_INLINE btScalar FrontSolver::solve_usual(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer, btDispatcher* dispatcher) {
    const bool one_direction = (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) == 0;
    note_springs(constraints, constraint_count, double(info.m_timeStep));
    if (one_direction) detail::forget_second_direction(manifolds, manifold_count);
    return usual_.solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                             constraint_count, info, drawer, dispatcher);
}

DUCTILE_INLINE btScalar FrontSolver::solveGroup(btCollisionObject** bodies, int body_count,
                                                btPersistentManifold** manifolds,
                                                int manifold_count, btTypedConstraint** constraints,
                                                int constraint_count,
                                                const btContactSolverInfo& info,
                                                btIDebugDraw* drawer, btDispatcher* dispatcher) {
    // Bullet flushes an empty group after an island above its batch size
    if (handed_over_ || (body_count == 0 && manifold_count == 0 && constraint_count == 0)) return 0;
    Lent<btScalar> lent;
    Lent<int> flags;
    const auto rule_contacts = [&] {
        if (kind_ == TickKind::part) detail::double_gaps(manifolds, manifold_count, lent);
        detail::part_slowly(manifolds, manifold_count, constraints, constraint_count, info, lent,
                            flags);
    };
    static const DirectBodies none;
    const DirectBodies& direct = direct_ != nullptr ? *direct_ : none;
    const auto is_chosen = springs_ ? detail::is_plastic_or_sprung : detail::is_plastic;
    if (std::none_of(constraints, constraints + constraint_count, is_chosen) && !direct.any) {
        rule_contacts();
        return solve_usual(bodies, body_count, manifolds, manifold_count, constraints,
                           constraint_count, info, drawer, dispatcher);
    }
    std::unique_ptr<Room> room = borrow();
    room->islands.find(bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
                       is_chosen, direct);
    for (IslandParts& island : room->islands.chosen()) {
        if (kind_ == TickKind::step) break;
        for (btPersistentManifold* manifold : island.manifolds) see_corners(*manifold);
    }
    rule_contacts();
    for (IslandParts& island : room->islands.chosen()) {
        if (detail::is_one_joint(island)) {
            solve_plastic(island, room->alone, info, drawer, dispatcher);
            continue;
        }
        const std::shared_ptr<Kept> kept = solver_of(island);
        solve_plastic(island, kept->solver, info, drawer, dispatcher);
        if (springs_ && !detail::has_plastic(island, direct)) continue;
        const std::lock_guard lock(mutex_);
        own_.join(kept->solver.own());
        for (btTypedConstraint* constraint : island.constraints) softened_.meet(*constraint);
    }
    IslandParts& others = room->islands.others();
    btScalar residual = 0;
    if (!others.bodies.empty() || !others.constraints.empty()) {
        residual =
            solve_usual(others.bodies.data(), int(others.bodies.size()), others.manifolds.data(),
                        int(others.manifolds.size()), others.constraints.data(),
                        int(others.constraints.size()), info, drawer, dispatcher);
    }
    give_back(std::move(room));
    return residual;
}

DUCTILE_INLINE void FrontSolver::prepareSolve(int bodies, int manifolds) {
    usual_.prepareSolve(bodies, manifolds);
    handed_over_ = batches_ && batches_->hand_over(*this);
}

DUCTILE_INLINE void FrontSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) {
    if (std::exchange(handed_over_, false)) batches_->end();
    usual_.allSolved(info, drawer);
    const std::lock_guard lock(mutex_); // one front may serve several worlds
    std::erase_if(kept_, [](auto& entry) { return !std::exchange(entry.second->used, false); });
}

DUCTILE_INLINE void FrontSolver::reset() {
    usual_.reset();
    kept_.clear();
}

DUCTILE_INLINE auto FrontSolver::borrow() -> std::unique_ptr<Room> {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<Room>();
    std::unique_ptr<Room> room = std::move(idle_.back());
    idle_.pop_back();
    return room;
}
DUCTILE_INLINE void FrontSolver::give_back(std::unique_ptr<Room> room) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(room));
}

DUCTILE_INLINE auto FrontSolver::solver_of(const IslandParts& island) -> std::shared_ptr<Kept> {
    const auto first =
        std::find_if(island.constraints.begin(), island.constraints.end(), detail::is_plastic);
    const void* key = first != island.constraints.end()
                          ? static_cast<const void*>(*first)
                          : static_cast<const void*>(island.bodies.front());
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Kept>& kept = kept_[key];
    if (kept == nullptr) kept = std::make_shared<Kept>();
    kept->used = true;
    return kept;
}

} // namespace ductile::bullet
