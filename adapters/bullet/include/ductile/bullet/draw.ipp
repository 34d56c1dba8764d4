// SPDX-License-Identifier: MIT
//
// Bodies of draw.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ductile/bullet/draw.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

DUCTILE_INLINE btVector3 colour_of(const JointView& view) noexcept {
    if (view.outcome == Outcome::broken) return {btScalar(0.5), btScalar(0.5), btScalar(0.5)};
    if (view.outcome == Outcome::unreliable) return {btScalar(0.6), 0, 1};
    const auto used = btScalar(std::clamp(view.utilisation, 0.0, 1.0));
    return {std::min(2 * used, btScalar(1)), std::min(2 - 2 * used, btScalar(1)), 0};
}

DUCTILE_INLINE void draw(const JointView& view, btIDebugDraw& drawer, btScalar size) {
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
