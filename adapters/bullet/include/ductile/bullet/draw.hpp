// SPDX-License-Identifier: MIT
//
// How a plastic joint stands, drawn through the user's btIDebugDraw:
//   the axes of frame A and frame B, which differ by what the joint has moved;
//   a ball whose colour is the utilisation: green without load, over yellow, to red where it flows;
//   violet where the solver's answer cannot be relied on; grey where broken;
//   an arc per axis that has turned plastically, by that angle from frame B (whole turns are not
//   told from each other), and a line per axis that was stretched or sheared.
//
// A constraint added by add_to draws itself in world.debugDrawWorld(), in the modes in which Bullet
// asks actions to draw (wireframe, AABB, normals).
#pragma once

#include <LinearMath/btIDebugDraw.h>
#include <LinearMath/btVector3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ductile/bullet/joint_view.hpp"

namespace ductile::bullet {

/// Red, green, blue, in [0, 1].
[[nodiscard]] inline btVector3 colour_of(const JointView& view) noexcept {
    if (view.outcome == Outcome::broken) return {btScalar(0.5), btScalar(0.5), btScalar(0.5)};
    if (view.outcome == Outcome::unreliable) return {btScalar(0.6), 0, 1};
    const auto used = btScalar(std::clamp(view.utilisation, 0.0, 1.0));
    return {std::min(2 * used, btScalar(1)), std::min(2 - 2 * used, btScalar(1)), 0};
}

/// `size`: length of the axes drawn [m]; nothing is drawn where it is not positive.
inline void draw(const JointView& view, btIDebugDraw& drawer, btScalar size) {
    if (!(size > 0)) return;
    const btVector3 colour = colour_of(view);
    const btVector3& centre = view.frame_a.getOrigin();
    drawer.drawTransform(view.frame_b, size);
    if (view.outcome != Outcome::broken) drawer.drawTransform(view.frame_a, size);
    drawer.drawSphere(centre, size / 5, colour);
    for (int i = 0; i < 3; ++i) {
        const btVector3 axis = view.frame_b.getBasis().getColumn(i);
        const auto slid = btScalar(view.plastic_offset[i]);
        if (slid != 0) drawer.drawLine(centre - slid * axis, centre, colour);
        const auto turned =
            btScalar(std::remainder(view.plastic_offset[3 + i], 2 * std::numbers::pi));
        if (turned == 0) continue;
        drawer.drawArc(view.frame_b.getOrigin(), axis,
                       view.frame_b.getBasis().getColumn((i + 1) % 3), size, size,
                       std::min(turned, btScalar(0)), std::max(turned, btScalar(0)), colour, true);
    }
}

} // namespace ductile::bullet
