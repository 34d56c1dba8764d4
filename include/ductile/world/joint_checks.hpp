// SPDX-License-Identifier: MIT
//
// What an adapter refuses to make a joint of, in any engine. The engine would make something of it,
// and silently: two halves of a pin that are apart are torn together in the first steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <stdexcept>
#include <string>

#include "ductile/joint/any_link.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/number_text.hpp"

namespace ductile {

/// `frame` itself. `field`: what it is called; `round_off`: that of its axes [-].
/// @throws std::invalid_argument where it is not finite, or its axes are not orthonormal and
/// right-handed.
inline const JointFrame<double>& require_frame(const std::string& field,
                                               const JointFrame<double>& frame, double round_off) {
    if (!is_finite(frame.origin)) {
        throw std::invalid_argument(field + ".origin: must be finite [m]");
    }
    check::finite(field + ".origin", norm(frame.origin), "m");
    const Matrix3<double> products = transposed_times(frame.axes, frame.axes);
    bool orthonormal = true;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const double off = products(i, j) - (i == j ? 1 : 0);
            orthonormal = orthonormal && std::abs(off) <= round_off;
        }
    }
    const Vector3<double> third = cross(column(frame.axes, 0), column(frame.axes, 1));
    if (!orthonormal || !(dot(third, column(frame.axes, 2)) > 0)) {
        throw std::invalid_argument(field +
                                    ".axes: must be three orthonormal columns, right-handed");
    }
    return frame;
}

/// A joint's state that somebody gives it, of one axis or more.
/// @throws std::invalid_argument where it is none that a joint can come to.
template <class State>
void require_state(const State& state) {
    check::non_negative("restore.state.plastic_travel", state.plastic_travel, "m or rad");
    check::finite("restore.state.plastic_work", state.plastic_work, "J");
    if constexpr (std::floating_point<decltype(state.plastic_offset)>) {
        check::finite("restore.state.plastic_offset", state.plastic_offset, "m or rad");
    } else {
        for (const double offset : state.plastic_offset) {
            check::finite("restore.state.plastic_offset", offset, "m or rad");
        }
    }
}

/// Whether the rigid axes of the bodies have to meet where these are.
enum class Meeting {
    required,   ///< to within what a sloppy assembly leaves
    as_they_are ///< of a joint that is made anew for what has moved: the rows pull them together
};

/// Of a link where its bodies are now: its rigid axes have to meet, all but what a sloppy assembly
/// leaves: a twentieth of the arms, and 0.1 rad.
/// @throws std::invalid_argument, naming the axis and what it is off by.
inline void require_meeting(const std::string& kind, const AnyLink<double>& link) {
    constexpr double share_of_arms = 0.05, turn = 0.1;
    constexpr double digits = 1e3 * double(std::numeric_limits<float>::epsilon());
    const LinkPose<double>& pose = link.pose();
    const double arms = norm(pose.arm_a()) + norm(pose.arm_b());
    const double move = share_of_arms * arms + digits * std::max(norm(pose.point()), 1.0);
    for (const JointAxis axis : all_joint_axes) {
        const double off = link.position(axis), most = turns(axis) ? turn : move;
        if (link.is_plastic(axis) || std::abs(off) <= most) continue;
        check::fail(kind + ".frames, rigid axis " + std::string(to_string(axis)) + ", apart by",
                    off, turns(axis) ? "rad" : "m",
                    "within " + number_text(most, 3) + " of each other as the bodies are now");
    }
}

} // namespace ductile
