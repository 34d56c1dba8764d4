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

#include "ductile/bullet/joint_view.hpp"

namespace ductile::bullet {

/// Red, green, blue, in [0, 1].
[[nodiscard]] btVector3 colour_of(const JointView& view) noexcept;

/// `size`: length of the axes drawn [m]; nothing is drawn where it is not positive.
void draw(const JointView& view, btIDebugDraw& drawer, btScalar size);

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/draw.ipp"
#endif
