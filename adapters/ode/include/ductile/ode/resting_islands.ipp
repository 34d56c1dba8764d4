// SPDX-License-Identifier: MIT
//
// Bodies of resting_islands.hpp.
#pragma once

#include "ductile/ode/island_solver.hpp"
#include "ductile/ode/resting_islands.hpp"

namespace ductile::ode {

DUCTILE_INLINE void RestingIslands::begin(std::span<const dBodyID> bodies) {
    end();
    for (dBodyID body : bodies) {
        const int samples = dBodyGetAutoDisableAverageSamplesCount(body);
        if (dBodyGetAutoDisableFlag(body) == 0 || samples == 0) continue;
        dBodySetAutoDisableAverageSamplesCount(body, 0);
        samples_.emplace_back(body, samples);
    }
}

DUCTILE_INLINE void RestingIslands::end() {
    for (const auto& [body, samples] : std::exchange(samples_, {})) {
        dBodySetAutoDisableAverageSamplesCount(body, unsigned(samples));
    }
}

DUCTILE_INLINE bool RestingIslands::gather(dBodyID first) {
    found_.assign(1, first);
    seen_.enter(first);
    bool may_sleep = true;
    for (std::size_t at = 0; at < found_.size(); ++at) {
        const dBodyID body = found_[at];
        const int count = dBodyGetNumJoints(body);
        const Idle* idle = idle_.find(body);
        may_sleep = may_sleep && count > 0 && idle != nullptr && idle->steps > 0 &&
                    idle->steps >= dBodyGetAutoDisableSteps(body) &&
                    idle->time >= double(dBodyGetAutoDisableTime(body));
        for (int i = 0; i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            if (dJointIsEnabled(joint) == 0) continue;
            if (PlasticConstraint** plastic = plastic_.find(joint)) {
                IslandRows* rows = (*plastic)->island_rows();
                may_sleep = may_sleep && (rows == nullptr || !rows->acts() || rows->rests());
            }
            for (const int side : {0, 1}) {
                const dBodyID other = dJointGetBody(joint, side);
                if (other == nullptr) continue;
                if (!can_move(other)) {
                    may_sleep = may_sleep && dBodyIsEnabled(other) == 0;
                } else if (!seen_.has(other)) {
                    seen_.enter(other);
                    found_.push_back(other);
                }
            }
        }
    }
    return may_sleep;
}

DUCTILE_INLINE bool RestingIslands::look(std::span<const dBodyID> bodies,
                                         std::span<PlasticConstraint* const> joints,
                                         double length) {
    std::swap(before_, idle_);
    idle_.clear();
    for (dBodyID body : bodies) {
        if (!can_move(body) || dBodyIsEnabled(body) == 0 || !detail::is_idle(body)) continue;
        const Idle* known = before_.find(body);
        const Idle last = known != nullptr ? *known : Idle();
        idle_[body] = {last.steps + 1, last.time + length};
    }
    if (idle_.size() == 0) return false;
    plastic_.clear();
    for (PlasticConstraint* joint : joints) plastic_[joint->id()] = joint;
    seen_.clear();
    bool slept = false;
    for (dBodyID body : bodies) {
        if (!can_move(body) || dBodyIsEnabled(body) == 0 || seen_.has(body)) continue;
        if (!gather(body)) continue;
        for (dBodyID asleep : found_) {
            dBodyDisable(asleep);
            dBodySetLinearVel(asleep, 0, 0, 0);
            dBodySetAngularVel(asleep, 0, 0, 0);
            idle_[asleep] = {};
        }
        slept = true;
    }
    return slept;
}

} // namespace ductile::ode
