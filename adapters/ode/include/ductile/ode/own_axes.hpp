// SPDX-License-Identifier: MIT
//
// The axes of a joint of ODE's along which its motors, stops and springs act, where it is solved:
// with them what its feedback says is divided into what those did and what its rigid rows did,
// which take nothing as bodies go along. Balls and fixed joints have none; of hinges, sliders,
// universals and hinge-2 they are known; what all others do is taken to be their motors'.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include "ductile/ode/convert.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

struct OwnAxes {
    bool known = true;
    bool powered = false;                           ///< a motor or spring may bring energy in
    Vector3<double> arm_a{0, 0, 0}, arm_b{0, 0, 0}; ///< to the pin [m]
    Vector3<double> slides{0, 0, 0};                ///< unit vector, or none
    /// Turns about these are free; of two any moment in their plane is.
    Vector3<double> turns{0, 0, 0}, turns_too{0, 0, 0};

    /// Of `joint` between these, as they are.
    [[nodiscard]] static DUCTILE_INLINE OwnAxes of(dJointID joint, const AttachedBodies& bodies);
    /// Force and moment on A at the pin, of what the feedback says about A's centre.
    [[nodiscard]] DUCTILE_INLINE Vector3<double> force(const Vector3<double>& of_all) const;
    [[nodiscard]] DUCTILE_INLINE Vector3<double> moment(const Vector3<double>& force,
                                                        const Vector3<double>& torque) const;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/own_axes.ipp"
#endif
