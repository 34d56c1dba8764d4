// SPDX-License-Identifier: MIT
//
// What a joint of ODE's has for itself of ERP and CFM, in place of the world's, and what a part or
// a blow makes of it (frame/part_settings.hpp): its rows, of a ball, fixed, double-ball,
// double-hinge joint or transmission; its stops, where it has some; the suspension of a hinge-2.
// Left as they are, a stop that is overrun within a frame is pushed back in parts of microseconds,
// at any speed.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <cmath>
#include <span>
#include <vector>

#include "ductile/frame/part_settings.hpp"
#include "ductile/ode/joint_calls.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

class OwnSettings {
  public:
    /// Rules the joints of these bodies for a part of `h` [s] in a frame of `frame` [s], or a blow,
    /// but for `ours`, which plastic joints made for themselves.
    void rule(std::span<const dBodyID> bodies, const AddressBook& ours, double h, double frame,
              bool blow) {
        own_.clear();
        for (dBodyID body : bodies) {
            for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
                const dJointID joint = dBodyGetJoint(body, i);
                const dBodyID first = dJointGetBody(joint, 0);
                if ((first == body || first == nullptr) && !ours.has(joint)) find(joint);
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
    /// They are as they were.
    void put_back() {
        for (const Own& own : own_) {
            own.set(own.joint, own.erp_name, dReal(own.usual.erp));
            own.set(own.joint, own.cfm_name, dReal(own.usual.compliance));
        }
        own_.clear();
    }

  private:
    struct Own {
        dJointID joint;
        void (*set)(dJointID, int, dReal);
        int erp_name, cfm_name;
        Softness usual;
        bool spring; ///< a share of what the frame removes, not of each part
    };
    void find(dJointID joint) {
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

    std::vector<Own> own_;
};

} // namespace ductile::ode
