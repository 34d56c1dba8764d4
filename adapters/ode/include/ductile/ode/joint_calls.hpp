// SPDX-License-Identifier: MIT
//
// How ODE is asked for the parameters of a joint of a kind, and told them, and what there is to be
// set of it.
#pragma once

#include <ode/ode.h>

namespace ductile::ode {

struct JointCalls {
    dReal (*get)(dJointID, int) = nullptr; ///< null: ODE has none of it
    void (*set)(dJointID, int, dReal) = nullptr;
    int stops = 0;           ///< axes that may have some
    bool rows = false;       ///< ERP and CFM of all of them
    bool suspension = false; ///< of its first axis
};

[[nodiscard]] inline JointCalls joint_calls(dJointType kind) {
    switch (kind) {
        case dJointTypeBall:
            return {.get = dJointGetBallParam, .set = dJointSetBallParam, .rows = true};
        case dJointTypeFixed:
            return {.get = dJointGetFixedParam, .set = dJointSetFixedParam, .rows = true};
        case dJointTypeDBall:
            return {.get = dJointGetDBallParam, .set = dJointSetDBallParam, .rows = true};
        case dJointTypeDHinge:
            return {.get = dJointGetDHingeParam, .set = dJointSetDHingeParam, .rows = true};
        case dJointTypeTransmission:
            return {
                .get = dJointGetTransmissionParam, .set = dJointSetTransmissionParam, .rows = true};
        case dJointTypeHinge:
            return {.get = dJointGetHingeParam, .set = dJointSetHingeParam, .stops = 1};
        case dJointTypeSlider:
            return {.get = dJointGetSliderParam, .set = dJointSetSliderParam, .stops = 1};
        case dJointTypeUniversal:
            return {.get = dJointGetUniversalParam, .set = dJointSetUniversalParam, .stops = 2};
        case dJointTypeHinge2:
            return {.get = dJointGetHinge2Param,
                    .set = dJointSetHinge2Param,
                    .stops = 1,
                    .suspension = true};
        case dJointTypePR:
            return {.get = dJointGetPRParam, .set = dJointSetPRParam, .stops = 2};
        case dJointTypePU:
            return {.get = dJointGetPUParam, .set = dJointSetPUParam, .stops = 3};
        case dJointTypePiston:
            return {.get = dJointGetPistonParam, .set = dJointSetPistonParam, .stops = 2};
        case dJointTypeAMotor:
            return {.get = dJointGetAMotorParam, .set = dJointSetAMotorParam, .stops = 3};
        case dJointTypeLMotor:
            return {.get = dJointGetLMotorParam, .set = dJointSetLMotorParam, .stops = 3};
        default:
            return {};
    }
}

} // namespace ductile::ode
