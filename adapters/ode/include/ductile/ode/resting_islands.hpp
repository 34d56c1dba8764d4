// SPDX-License-Identifier: MIT
//
// Who falls asleep in a World with a tolerance, told once a frame by the bodies' own thresholds,
// steps and times (dBodySetAutoDisable...; a frame is a step, of the last velocity: no average over
// samples). ODE's own counters would count the parts of a frame, also those that are put back, and
// can be neither read nor written.
//
// An island falls asleep as a whole: what hangs together by joints and contacts, once all its
// bodies are idle and its plastic joints rest. One that hangs on a kinematic body that is enabled
// stays awake, as ODE would wake it, and so does a body without any joint.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

class RestingIslands {
  public:
    /// Keeps ODE from counting until `end`.
    void begin(std::span<const dBodyID> bodies) {
        end();
        for (dBodyID body : bodies) {
            const int samples = dBodyGetAutoDisableAverageSamplesCount(body);
            if (dBodyGetAutoDisableFlag(body) == 0 || samples == 0) continue;
            dBodySetAutoDisableAverageSamplesCount(body, 0);
            samples_.emplace_back(body, samples);
        }
    }
    void end() {
        for (const auto& [body, samples] : std::exchange(samples_, {})) {
            dBodySetAutoDisableAverageSamplesCount(body, unsigned(samples));
        }
    }
    /// To be called before a body is destroyed.
    void forget(dBodyID body) {
        std::erase_if(samples_, [body](const auto& entry) { return entry.first == body; });
        if (Idle* idle = idle_.find(body)) *idle = {};
    }
    /// A frame of `length` [s] is over, its contacts are there. True where a body fell asleep;
    /// `about_to()` is called before the first one does.
    template <class Before>
    bool look(std::span<const dBodyID> bodies, std::span<PlasticConstraint* const> joints,
              double length, const Before& about_to) {
        std::swap(before_, idle_);
        idle_.clear();
        for (dBodyID body : bodies) {
            if (!can_move(body) || dBodyIsEnabled(body) == 0 || !is_idle(body)) continue;
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
            if (!std::exchange(slept, true)) about_to();
            for (dBodyID asleep : found_) {
                dBodyDisable(asleep);
                dBodySetLinearVel(asleep, 0, 0, 0);
                dBodySetAngularVel(asleep, 0, 0, 0);
                idle_[asleep] = {};
            }
        }
        return slept;
    }

  private:
    struct Idle {
        int steps = 0;   ///< 0: it is not
        double time = 0; ///< [s]
    };
    /// All that hangs together with a body, into found_; false where it is to stay awake.
    [[nodiscard]] bool gather(dBodyID first) {
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

    std::vector<std::pair<dBodyID, int>> samples_; ///< of those that ODE would count
    AddressMap<Idle> idle_, before_;               ///< by body; before this frame
    AddressMap<PlasticConstraint*> plastic_;       ///< by joint
    AddressBook seen_;                             ///< bodies
    std::vector<dBodyID> found_;
};

} // namespace ductile::ode
