// SPDX-License-Identifier: MIT
//
// Bodies of own_settings.hpp.
#pragma once

#include <cmath>

#include "ductile/ode/joint_calls.hpp"
#include "ductile/ode/own_settings.hpp"

namespace ductile::ode {

DUCTILE_INLINE void OwnSettings::find(dJointID joint) {
    const JointCalls calls = joint_calls(dJointGetType(joint));
    const auto add = [&](int erp_name, int cfm_name, bool spring) {
        const Softness usual{double(calls.get(joint, erp_name)),
                             double(calls.get(joint, cfm_name))};
        own_.push_back({joint, calls.set, erp_name, cfm_name, usual, spring});
    };
    if (calls.rows) add(dParamERP, dParamCFM, false);
    if (calls.suspension) add(dParamSuspensionERP, dParamSuspensionCFM, true);
    for (int axis = 0; axis < calls.stops; ++axis) {
        const int group = dParamGroup * axis;
        const bool stops = std::isfinite(calls.get(joint, dParamLoStop + group)) ||
                           std::isfinite(calls.get(joint, dParamHiStop + group));
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
