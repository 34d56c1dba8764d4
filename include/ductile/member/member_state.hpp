// SPDX-License-Identifier: MIT
//
// What a member remembers: of each section whether it is open, how far it is bent and what its
// joint went through. It does not matter to it how often a section was closed in between. And what
// an elastic member would have kept of the blows that yielded it.
#pragma once

#include <vector>

#include "ductile/member/member.hpp"

namespace ductile {

/// Plain value.
struct SectionState {
    bool open = false; ///< a joint between two bodies
    int held = 0;      ///< steps in which it held since it last flowed, while open
    int alarms = 0;    ///< times that it was opened since it last flowed
    double bend = 0;   ///< of the next segment about x, from this one; while closed [rad]
    UsualAxisJoint::State joint{};

    bool operator==(const SectionState&) const = default;
};

/// The work of open sections that an elastic member takes back after a blow, and that vibration
/// ends. Plain value.
struct MemberVibration {
    double share = 0;   ///< of the work that sections do from now on, 1/N² (blow.hpp) [-]
    double ahead = 0;   ///< largest that this may come to [J]
    double counted = 0; ///< work of all sections that was looked at [J]
    double lost = 0;    ///< sum, of all blows [J]

    bool operator==(const MemberVibration&) const = default;
};

/// By section. Plain value: copy, compare, save and restore it.
using MemberState = std::vector<SectionState>;

[[nodiscard]] inline MemberState straight(const Member& member) {
    MemberState state;
    for (int i = 0; i < member.sections(); ++i) {
        state.push_back({.joint = member.section(i).state()});
    }
    return state;
}

/// Segments first ... last, which are one body.
struct MemberRun {
    int first = 0, last = 0;

    [[nodiscard]] bool holds(int segment) const noexcept {
        return first <= segment && segment <= last;
    }
    bool operator==(const MemberRun&) const = default;
};

/// From the start.
[[nodiscard]] inline std::vector<MemberRun> runs(const MemberState& state) {
    std::vector<MemberRun> result{{}};
    for (const SectionState& section : state) {
        const int next = result.back().last + 1;
        if (section.open) {
            result.push_back({next, next});
        } else {
            result.back().last = next;
        }
    }
    return result;
}

} // namespace ductile
