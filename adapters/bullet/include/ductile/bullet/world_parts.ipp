// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/members.hpp"
#include "ductile/bullet/world_parts.hpp"

namespace ductile::bullet {

namespace detail {

/// A tick as stepSimulation does it, but for kinematic bodies, whose velocities are known, and
/// motion states. Bullet's own is not public.
struct SingleTick : btDiscreteDynamicsWorld {
    static void go(btDiscreteDynamicsWorld& world, btScalar h) {
        world.applyGravity();
        (world.*(&SingleTick::internalSingleStepSimulation))(h);
        world.clearForces();
    }
};

} // namespace detail

/// The solver's settings of a part or a blow while this lives.
class WorldParts::Settings {
  public:
    Settings(btContactSolverInfo& info, btScalar h, bool blow) : info_(info), usual_(info) {
        constexpr btScalar removed_in = btScalar(5e-3), as_in = btScalar(1e-4); // [s]
        const btScalar most = blow ? btScalar(0) : h / removed_in;
        info.m_erp = std::min(info.m_erp, most);
        info.m_erp2 = std::min(info.m_erp2, most);
        if (!blow) return;
        info.m_splitImpulse = 0;
        info.m_globalCfm *= h / as_in; // a compliance is divided by the tick
    }
    ~Settings() {
        info_.m_erp = usual_.m_erp;
        info_.m_erp2 = usual_.m_erp2;
        info_.m_splitImpulse = usual_.m_splitImpulse;
        info_.m_globalCfm = usual_.m_globalCfm;
    }
    Settings(const Settings&) = delete;
    Settings& operator=(const Settings&) = delete;

  private:
    btContactSolverInfo& info_;
    btContactSolverInfo usual_;
};

DUCTILE_INLINE WorldParts::WorldParts(btDiscreteDynamicsWorld& world, FrontHold& front,
                                      EnergyMeter& meter, Members& members, Number number,
                                      Accept accept)
    : world_(world),
      front_(front),
      meter_(meter),
      members_(members),
      number_(std::move(number)),
      accept_(std::move(accept)),
      half_ahead_(world),
      islands_(MeetingIslands::enter(world)),
      closing_(members),
      pairs_were_sorted_(world.getDispatchInfo().m_deterministicOverlappingPairs) {
    world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
}

DUCTILE_INLINE WorldParts::~WorldParts() {
    if (!front_.is_alive()) return;
    half_ahead_.leave();
    if (islands_ != nullptr) islands_->leave(world_);
    world_.getDispatchInfo().m_deterministicOverlappingPairs = pairs_were_sorted_;
}

DUCTILE_INLINE void WorldParts::begin(double length) {
    forces_.hold(world_);
    forces_act_ = true;
    ways_.begin(world_, btScalar(length));
    time_ = 0;
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        PlasticConstraint* plastic = as_plastic(*world_.getConstraint(i));
        if (plastic == nullptr) continue;
        if (!plastic->in_world()) {
            throw std::logic_error(
                "World.step: a plastic joint must be put into a world with a tolerance by "
                "World::add "
                "or its own add_to, as Bullet's addConstraint does not say when a part ends");
        }
        plastic->begin_part();
    }
}

DUCTILE_INLINE void WorldParts::end() { world_.synchronizeMotionStates(); }

DUCTILE_INLINE void WorldParts::save() {
    kept_time_ = time_;
    meter_.keep();
    snapshot_.take(world_, front_.usual());
}

DUCTILE_INLINE void WorldParts::put_back() {
    snapshot_.put_back(world_, front_.usual());
    meter_.put_back();
    world_.clearForces();
    forces_act_ = false;
    time_ = kept_time_;
}

DUCTILE_INLINE void WorldParts::tick(double h, bool ahead) {
    if (!std::exchange(forces_act_, false)) forces_.apply();
    members_.apply_forces();
    meter_.before_step();
    if (ahead) {
        half_ahead_.move(btScalar(h), ways_, btScalar(time_));
        time_ += h;
        meter_.bodies_ahead();
    }
    members_.before_solve();
    const Settings settings(world_.getSolverInfo(), btScalar(h), !ahead);
    front_.set_kind(ahead ? TickKind::part : TickKind::blow);
    detail::SingleTick::go(world_, btScalar(h));
    front_.set_kind(TickKind::step);
    meter_.after_step(double(btScalar(h)));
}

DUCTILE_INLINE const PartMotion& WorldParts::part(double h) {
    const double rigid = meter_.of_plastic_joints();
    const double contact = meter_.ledger().booked(Account::contact);
    // so short a part closes what is left of a gap: its impulses are a blow's
    const bool instant = h < shortest_part();
    if (instant) members_.begin_blow();
    const auto look = [&] {
        const auto length = double(btScalar(h));
        return instant ? members_.look_blow(length) : members_.look(length);
    };
    for (tick(h, true); look(); tick(h, true)) do_again();
    tell();
    motion_.rigid_work = meter_.of_plastic_joints() - rigid;
    motion_.contact_work = meter_.ledger().booked(Account::contact) - contact;
    motion_.closed = closing_.closed_early(world_, h, apart_);
    return motion_;
}

DUCTILE_INLINE void WorldParts::do_again() {
    put_back();
    const double before = meter_.held().total();
    members_.open_found();
    meter_.bodies_rearranged(before);
    save();
}

DUCTILE_INLINE const PartMotion& WorldParts::blow() {
    constexpr double instant = 1e-9;
    if (!members_.empty()) save();
    members_.begin_blow();
    for (tick(instant, false); members_.look_blow(instant); tick(instant, false)) do_again();
    motion_.closed = 0;
    return tell();
}

DUCTILE_INLINE void WorldParts::accept(double h) {
    if (h > 0) meter_.rings_down(members_.count_vibration());
    accept_(h);
    if (!(h > 0) || members_.empty()) return;
    const double before = meter_.held().total();
    if (members_.close_held()) meter_.bodies_rearranged(before);
}

DUCTILE_INLINE const PartMotion& WorldParts::tell() {
    motion_.rows.clear();
    motion_.plastic_work = members_.closed_work();
    motion_.closed_work = members_.unmissed_work();
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        const PlasticConstraint* plastic = as_plastic(*world_.getConstraint(i));
        if (plastic == nullptr) continue;
        const std::size_t first = motion_.rows.size();
        plastic->list_part_rows(number_(*plastic), motion_.rows);
        int section = 0;
        if (members_.key_of(*plastic, section) != nullptr) {
            for (std::size_t k = first; k < motion_.rows.size(); ++k) {
                motion_.rows[k].section = section + 1;
            }
        }
        motion_.plastic_work += plastic->queries().absorbed_energy();
    }
    return motion_;
}

DUCTILE_INLINE ClosingContacts WorldParts::closing(double h, double touching, double apart) {
    apart_ = apart;
    return closing_.find(world_, h, touching, apart);
}

DUCTILE_INLINE double WorldParts::kinetic_energy() const {
    double sum = 0;
    const auto& objects = world_.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        const btRigidBody* body = btRigidBody::upcast(objects[i]);
        if (body == nullptr || !(body->getInvMass() > 0) || body->isStaticOrKinematicObject()) {
            continue;
        }
        const btVector3 spin =
            body->getAngularVelocity() * body->getCenterOfMassTransform().getBasis();
        sum += double(body->getLinearVelocity().length2()) / (2 * double(body->getInvMass()));
        for (int k = 0; k < 3; ++k) {
            const btScalar inverse = body->getInvInertiaDiagLocal()[k];
            if (inverse > 0) sum += double(spin[k] * spin[k]) / (2 * double(inverse));
        }
    }
    return sum;
}

} // namespace ductile::bullet
