// SPDX-License-Identifier: MIT
//
// Bodies of joint_stops.hpp.
#pragma once

#include <cmath>

#include "ductile/ode/joint_calls.hpp"
#include "ductile/ode/joint_stops.hpp"

namespace ductile::ode {

namespace detail {

/// What ODE tells of one axis.
struct AxisCalls {
    int group; ///< of its parameters
    dReal (*at)(dJointID);
    dReal (*rate)(dJointID);
    void (*axis)(dJointID, dVector3);
    bool turns;
};

[[nodiscard]] DUCTILE_INLINE double yields_along(dJointID joint, const Vector3<double>& axis,
                                                 bool turns) {
    double sum = 0;
    for (const int side : {0, 1}) {
        const dBodyID body = dJointGetBody(joint, side);
        if (body == nullptr || !can_move(body)) continue;
        const BodyState<double> state = body_state(body);
        sum += turns ? dot(axis, times(state.inverse_inertia, axis)) : state.inverse_mass;
    }
    return sum;
}

DUCTILE_INLINE void add_axis(dJointID joint, const AxisCalls& calls, StoppedAxes& axes) {
    const auto parameter = joint_calls(dJointGetType(joint)).get;
    const auto least = double(parameter(joint, dParamLoStop + calls.group));
    const auto most = double(parameter(joint, dParamHiStop + calls.group));
    if (!std::isfinite(least) && !std::isfinite(most)) return;
    axes.axes[axes.count++] = {least, most, double(calls.at(joint)), double(calls.rate(joint)),
                               yields_along(joint, told(joint, calls.axis), calls.turns)};
}

} // namespace detail

DUCTILE_INLINE StoppedAxes stopped_axes(dJointID joint) {
    StoppedAxes axes;
    const auto add = [&](const detail::AxisCalls& calls) { detail::add_axis(joint, calls, axes); };
    switch (dJointGetType(joint)) {
        case dJointTypeHinge:
            add({0, dJointGetHingeAngle, dJointGetHingeAngleRate, dJointGetHingeAxis, true});
            break;
        case dJointTypeSlider:
            add({0, dJointGetSliderPosition, dJointGetSliderPositionRate, dJointGetSliderAxis,
                 false});
            break;
        case dJointTypeUniversal:
            add({0, dJointGetUniversalAngle1, dJointGetUniversalAngle1Rate, dJointGetUniversalAxis1,
                 true});
            add({dParamGroup, dJointGetUniversalAngle2, dJointGetUniversalAngle2Rate,
                 dJointGetUniversalAxis2, true});
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
