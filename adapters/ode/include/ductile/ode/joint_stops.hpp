// SPDX-License-Identifier: MIT
//
// Stops of ODE's own joints: how far from them an axis is, and how fast it comes. Of hinges,
// sliders, universals, pistons and the steering of a hinge-2; those of others are not told. Two
// stops at one place are none: they hold the axis, as a spring where they are soft
// (own_settings.hpp).
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/joint_calls.hpp"

namespace ductile::ode {

/// An axis of a joint that may have stops, as its bodies are.
struct StoppedAxis {
    int group;          ///< of its parameters
    double least, most; ///< stops; infinite: none [m | rad]
    double at, rate;    ///< as its stops count [m | rad] [m/s | rad/s]
    double yields;      ///< velocity that a unit impulse along it gives, both bodies free

    [[nodiscard]] bool stops() const noexcept {
        return (std::isfinite(least) || std::isfinite(most)) && least < most;
    }
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

namespace detail {

/// What ODE tells of one axis.
struct AxisCalls {
    int group; ///< of its parameters
    dReal (*at)(dJointID);
    dReal (*rate)(dJointID);
    void (*axis)(dJointID, dVector3);
    bool turns;
    double way = 1, rate_way = 1; ///< -1: its stops count the other way round
};

[[nodiscard]] inline double yields_along(dJointID joint, const Vector3<double>& axis, bool turns) {
    double sum = 0;
    for (const int side : {0, 1}) {
        const dBodyID body = dJointGetBody(joint, side);
        if (body == nullptr || !can_move(body)) continue;
        const BodyState<double> state = body_state(body);
        sum += turns ? dot(axis, times(state.inverse_inertia, axis)) : state.inverse_mass;
    }
    return sum;
}

inline void add_axis(dJointID joint, const AxisCalls& calls, StoppedAxes& axes) {
    const dJointType type = dJointGetType(joint);
    const auto parameter = joint_calls(type).get;
    axes.axes[axes.count++] = {calls.group,
                               double(parameter(joint, dParamLoStop + calls.group)),
                               double(parameter(joint, dParamHiStop + calls.group)),
                               calls.way * double(calls.at(joint)),
                               calls.rate_way * double(calls.rate(joint)),
                               yields_along(joint, told(joint, calls.axis), calls.turns)};
}

} // namespace detail

[[nodiscard]] inline StoppedAxes stopped_axes(dJointID joint) {
    StoppedAxes axes;
    const auto add = [&](const detail::AxisCalls& calls) { detail::add_axis(joint, calls, axes); };
    // attached as (null, body): of a hinge ODE tells the angle the other way round, of a universal
    // the axes, and the second's angle but not its rate
    const bool reversed = attached_bodies(joint).reversed;
    const int first = reversed ? dParamGroup : 0, second = dParamGroup - first;
    const double way = reversed ? -1 : 1;
    switch (dJointGetType(joint)) {
        case dJointTypeHinge:
            add({0, dJointGetHingeAngle, dJointGetHingeAngleRate, dJointGetHingeAxis, true, way,
                 way});
            break;
        case dJointTypeSlider:
            add({0, dJointGetSliderPosition, dJointGetSliderPositionRate, dJointGetSliderAxis,
                 false});
            break;
        case dJointTypeUniversal:
            add({first, dJointGetUniversalAngle1, dJointGetUniversalAngle1Rate,
                 dJointGetUniversalAxis1, true});
            add({second, dJointGetUniversalAngle2, dJointGetUniversalAngle2Rate,
                 dJointGetUniversalAxis2, true, way});
            break;
        case dJointTypeHinge2:
            add({0, dJointGetHinge2Angle1, dJointGetHinge2Angle1Rate, dJointGetHinge2Axis1, true});
            break;
        case dJointTypePiston:
            add({0, dJointGetPistonPosition, dJointGetPistonPositionRate, dJointGetPistonAxis,
                 false});
            add({dParamGroup, dJointGetPistonAngle, dJointGetPistonAngleRate, dJointGetPistonAxis,
                 true});
            break;
        default:
            break;
    }
    return axes;
}

} // namespace ductile::ode
