// SPDX-License-Identifier: MIT
//
// Bodies of frame_report.hpp.
#pragma once

#include <algorithm>

#include "ductile/frame/frame_report.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

DUCTILE_INLINE void add_unresolved(std::vector<UnresolvedJoint>& joints, std::size_t joint,
                                   const Unresolved& left) {
    const auto before = [](const UnresolvedJoint& entry, std::size_t number) {
        return entry.joint < number;
    };
    auto at = std::lower_bound(joints.begin(), joints.end(), joint, before);
    if (at == joints.end() || at->joint != joint) at = joints.insert(at, {joint, {}});
    at->left += left;
}

DUCTILE_INLINE void RunReport::add(const FrameReport& frame, double work) {
    ++frames;
    parts += std::size_t(frame.parts);
    rejected += std::size_t(frame.rejected);
    blows += std::size_t(frame.blows);
    jumps += std::size_t(frame.jumps);
    worst_frame = std::max(worst_frame, frame.solves());
    error += frame.error;
    plastic_work = work;
    left += frame.left;
    for (const UnresolvedJoint& entry : frame.joints) {
        add_unresolved(joints, entry.joint, entry.left);
    }
}

} // namespace ductile
