// SPDX-License-Identifier: MIT
//
// What a world tells of its joints: that one yielded, broke, or cannot be relied on.
#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>

#include "ductile/world/joint_report.hpp"

namespace ductile {

enum class EventKind {
    yielded,    ///< flowed for the first time
    broke,      ///< see JointEvent::fracture
    unreliable, ///< unsolved, makes energy, or turned unseen (Outcome); told once per joint
    coarse,     ///< the step was too long for what it did; told once per joint
    split,      ///< of a member: a section opened (member/README.md)
    fused,      ///< of a member: a section closed again
};

[[nodiscard]] constexpr std::string_view to_string(EventKind kind) noexcept {
    switch (kind) {
        case EventKind::yielded:
            return "yielded";
        case EventKind::broke:
            return "broke";
        case EventKind::unreliable:
            return "unreliable";
        case EventKind::coarse:
            return "coarse";
        case EventKind::split:
            return "split";
        case EventKind::fused:
            return "fused";
    }
    return "unknown";
}

/// Plain value.
template <std::floating_point S>
struct JointEvent {
    EventKind kind = EventKind::yielded;
    std::size_t joint = 0; ///< number that the watch gave it
    std::string name;      ///< of the joint
    double time = 0;       ///< of a break; of all else at the end of the step, or part [s]
    JointReport<S> report;
    int section = -1; ///< of a member, that split or fused; else -1
};

} // namespace ductile
