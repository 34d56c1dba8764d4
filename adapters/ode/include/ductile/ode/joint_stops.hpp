// SPDX-License-Identifier: MIT
//
// Stops of ODE's own joints: how far from them an axis is, and how fast it comes. Of hinges,
// sliders, universals, pistons and the steering of a hinge-2; those of others are not told.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cstddef>

#include "ductile/ode/convert.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// An axis of a joint that has a stop, as its bodies are.
struct StoppedAxis {
    double least, most; ///< stops; infinite: none [m | rad]
    double at, rate;    ///< [m | rad] [m/s | rad/s]
    double yields;      ///< velocity that a unit impulse along it gives, both bodies free

    /// Distance to the stop that it goes towards, < 0 beyond it [m | rad].
    [[nodiscard]] double gap() const noexcept { return rate > 0 ? most - at : at - least; }
};

/// Axes of one joint.
struct StoppedAxes {
    std::array<StoppedAxis, 2> axes{};
    std::size_t count = 0;

    [[nodiscard]] const StoppedAxis* begin() const noexcept { return axes.data(); }
    [[nodiscard]] const StoppedAxis* end() const noexcept { return axes.data() + count; }
};

[[nodiscard]] DUCTILE_INLINE StoppedAxes stopped_axes(dJointID joint);

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/joint_stops.ipp"
#endif
