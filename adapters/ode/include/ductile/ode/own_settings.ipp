// SPDX-License-Identifier: MIT
//
// Bodies of own_settings.hpp.
#pragma once

#include <cmath>

#include "ductile/ode/own_settings.hpp"

namespace ductile::ode {

DUCTILE_INLINE OwnSettings::Access OwnSettings::access(dJointID joint) {
    switch (dJointGetType(joint)) {
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

DUCTILE_INLINE void OwnSettings::find(dJointID joint) {
    const Access access = OwnSettings::access(joint);
    const auto add = [&](int erp_name, int cfm_name, bool spring) {
        const Softness usual{double(access.get(joint, erp_name)),
                             double(access.get(joint, cfm_name))};
        own_.push_back({joint, access.set, erp_name, cfm_name, usual, spring});
    };
    if (access.rows) add(dParamERP, dParamCFM, false);
    if (access.suspension) add(dParamSuspensionERP, dParamSuspensionCFM, true);
    for (int axis = 0; axis < access.stops; ++axis) {
        const int group = dParamGroup * axis;
        const bool stops = std::isfinite(access.get(joint, dParamLoStop + group)) ||
                           std::isfinite(access.get(joint, dParamHiStop + group));
        if (stops) add(dParamStopERP + group, dParamStopCFM + group, true);
    }
}

DUCTILE_INLINE void OwnSettings::rule(std::span<const dBodyID> bodies, double h, double frame,
                                      bool blow) {
    own_.clear();
    for (dBodyID body : bodies) {
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            const dBodyID first = dJointGetBody(joint, 0);
            if (first == body || first == nullptr) find(joint);
        }
    }
    for (const Own& own : own_) {
        Softness rule = own.usual;
        if (blow) {
            rule = {0, rule.compliance * blow_compliance(h)};
        } else if (own.spring) {
            rule = part_spring(rule, h, frame);
        } else {
            rule.erp = part_erp(rule.erp, h);
        }
        own.set(own.joint, own.erp_name, dReal(rule.erp));
        own.set(own.joint, own.cfm_name, dReal(rule.compliance));
    }
}

DUCTILE_INLINE void OwnSettings::put_back() {
    for (const Own& own : own_) {
        own.set(own.joint, own.erp_name, dReal(own.usual.erp));
        own.set(own.joint, own.cfm_name, dReal(own.usual.compliance));
    }
    own_.clear();
}

} // namespace ductile::ode
