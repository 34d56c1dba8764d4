// SPDX-License-Identifier: MIT
//
// Bodies of stepped_world.hpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "ductile/vocabulary/check.hpp"
#include "ductile/world/stepped_world.hpp"
#include "ductile/world/waiting_joints.hpp"

namespace ductile {

DUCTILE_INLINE void SteppedWorld::step(double dt) {
    check::positive("World.step.dt", dt, "s");
    if (stepping_) {
        throw std::logic_error("World.step: must not be called within a step, as by a callback");
    }
    const Stepping guard(stepping_);
    supervisor_.open();
    look_at_structures();
    if (frames_) {
        do_frame(dt, time() + dt);
    } else {
        go(dt, time() + dt);
    }
}
DUCTILE_INLINE const Ledger<double>& SteppedWorld::ledger() const {
    const Ledger<double>* kept = kept_ledger();
    if (kept == nullptr) {
        throw std::logic_error(
            "World.ledger: there is none: not asked for, or not to be had of such a world");
    }
    return *kept;
}
DUCTILE_INLINE void SteppedWorld::start_in_frames(const FrameParameters& parameters) {
    frames_.emplace(parameters);
    supervisor_.set_in_frames();
}
DUCTILE_INLINE void SteppedWorld::part_stands(double h,
                                              const std::function<bool(const void*)>& whom) {
    supervisor_.look(time() + h, whom);
    look_at_structures();
}
DUCTILE_INLINE PartEngine& SteppedWorld::begin_frame(double /*length*/) {
    throw std::logic_error("World.tolerance: must not be asked of this engine");
}
DUCTILE_INLINE void SteppedWorld::joint_stepped() {
    if (!stepping_ && !told_of_engine_.exchange(true)) {
        supervisor_.say(
            "ductile: the engine was stepped beside World::step, which clock, events and "
            "ledger miss; step through World::step alone");
    }
}
DUCTILE_INLINE void SteppedWorld::go(double dt, double end) {
    require_possible(dt);
    do_step(dt);
    supervisor_.look(end);
    look_at_structures();
    (void)tell_of_ledger();
    supervisor_.close();
    tell_of_forgotten();
}
DUCTILE_INLINE void SteppedWorld::do_frame(double length, double end) {
    require_possible(length);
    if (sleep_through(length)) {
        frames_->sleep();
        supervisor_.look(end);
        look_at_structures();
    } else {
        frames_->frame(begin_frame(length), length);
        end_frame();
    }
    frames_->count_unreliable(supervisor_.watch().unreliable());
    supervisor_.set_time(end);
    if (const Ledger<double>* kept = kept_ledger()) {
        frames_->tell_contacts(tell_of_ledger() ? kept->brought_in()
                                                : std::numeric_limits<double>::quiet_NaN());
    }
    supervisor_.close();
    tell_of_forgotten();
}
DUCTILE_INLINE bool SteppedWorld::tell_of_ledger() {
    const Ledger<double>* kept = kept_ledger();
    if (kept == nullptr || std::isfinite(kept->unexplained())) return true;
    if (!std::exchange(told_of_ledger_, true)) {
        std::ostringstream line;
        line << "ductile: the ledger is no number from t = " << time()
             << " s on; look for what moved or pushed a body so";
        supervisor_.say(line.str());
    }
    return false;
}
DUCTILE_INLINE const FrameControl& SteppedWorld::frames() const {
    if (!frames_) throw std::logic_error("World.frame: there is none: no tolerance was given");
    return *frames_;
}
DUCTILE_INLINE void SteppedWorld::tell_of_forgotten() {
    const auto forgotten =
        WaitingJoints::all().take([this](const void* body) { return has_body(body); });
    for (std::size_t i = 0; i < forgotten; ++i) {
        supervisor_.say(
            "ductile: a joint of a body of this world was never added, and does nothing: "
            "World::add it");
    }
}

} // namespace ductile
