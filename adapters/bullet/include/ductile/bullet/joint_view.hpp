// SPDX-License-Identifier: MIT
//
// How a joint stands: what there is to draw.
#pragma once

#include <LinearMath/btTransform.h>

#include "ductile/vocabulary/row.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile::bullet {

/// After the last tick. Plain value.
struct JointView {
    btTransform frame_a; ///< of the joint in A, world
    btTransform frame_b; ///< of the joint in B, world
    Outcome outcome = Outcome::elastic;
    double utilisation = 0;                                   ///< 0: no load, 1: it flows [-]
    Vector6<double> plastic_offset = Vector6<double>::Zero(); ///< order of JointAxis [m | rad]
};

} // namespace ductile::bullet
