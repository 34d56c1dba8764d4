// SPDX-License-Identifier: MIT
//
// Bodies of supervisor.hpp.
#pragma once

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "ductile/world/supervisor.hpp"

namespace ductile {

DUCTILE_INLINE void warn_on_stderr(const std::string& line) {
    std::fprintf(stderr, "%s\n", line.c_str());
}

DUCTILE_INLINE Supervisor::Supervisor(Warn warn) : warn_(std::move(warn)) {
    watch_.on_event([this](const Event& event) {
        if (event.kind == EventKind::unreliable) unreliable_.add(event);
        if (event.kind == EventKind::coarse) coarse_.add(event);
        if (listener_) listener_(event);
    });
}
DUCTILE_INLINE void Supervisor::set_idle(const void* joint, bool idle) {
    const auto found = find(joint);
    if (found == joints_.end()) return;
    idle_ += int(idle) - int(std::exchange(found->idle, idle));
}
DUCTILE_INLINE std::size_t Supervisor::add(const void* joint, std::string name, Ask ask) {
    if (find(joint) != joints_.end()) {
        throw std::invalid_argument("World.add.joint: must not be in the world already");
    }
    if (name.empty()) name = "joint " + std::to_string(added_);
    const std::size_t number = watch_.add(std::move(name), ask().fracture.has_value());
    joints_.push_back({joint, number, std::move(ask)});
    return added_ = number + 1, number;
}
DUCTILE_INLINE void Supervisor::remove(const void* joint) {
    const auto found = find(joint);
    if (found == joints_.end()) return;
    set_idle(joint, false);
    found->joint = nullptr;
    removed_ = true;
    if (!looking_) forget_removed();
}
DUCTILE_INLINE std::size_t Supervisor::number(const void* joint) const {
    const std::size_t at = place(joint);
    return at < joints_.size() ? joints_[at].number : Watch<double>::nobody;
}
DUCTILE_INLINE bool Supervisor::knows(const void* joint) const {
    return place(joint) < joints_.size();
}
DUCTILE_INLINE void Supervisor::look(double time, const std::function<bool(const void*)>& whom) {
    time_ = time;
    watch_.go_on(time);
    if (std::size_t(idle_) == joints_.size()) return; // nothing to ask for
    const Looking guard(looking_);
    const std::size_t here = joints_.size(); // a listener may add more
    for (std::size_t i = 0; i < here; ++i) {
        if (joints_[i].joint == nullptr || joints_[i].idle) continue;
        if (whom && !whom(joints_[i].joint)) continue;
        const Report report = joints_[i].ask();
        watch_.see(joints_[i].number, report);
    }
}
DUCTILE_INLINE void Supervisor::tell_section(const void* member, EventKind kind, int section) {
    const auto found = find(member);
    if (found == joints_.end()) return;
    watch_.tell_section(found->number, kind, section, found->ask());
}
DUCTILE_INLINE void Supervisor::close() {
    forget_removed();
    for (JointWarning* warning : {&unreliable_, &coarse_}) {
        if (warning->due() && warn_) warn_(warning->line(in_frames_));
    }
}
DUCTILE_INLINE void Supervisor::forget_removed() noexcept {
    if (!std::exchange(removed_, false)) return;
    std::erase_if(joints_, [](const Entry& entry) { return entry.joint == nullptr; });
}
DUCTILE_INLINE std::vector<Supervisor::Entry>::iterator Supervisor::find(const void* joint) {
    return joints_.begin() + std::ptrdiff_t(place(joint));
}
DUCTILE_INLINE std::size_t Supervisor::place(const void* joint) const {
    const std::size_t count = joints_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = (next_ + i) % count;
        if (joints_[at].joint != joint) continue;
        next_ = at;
        return at;
    }
    return count;
}

} // namespace ductile
