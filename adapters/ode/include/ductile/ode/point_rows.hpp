// SPDX-License-Identifier: MIT
//
// Bounded force rows between two bodies that act at a given point, for one step. ODE has no joint
// for that: its linear motor acts midway between the centres of mass. But the two friction rows of
// a contact joint act at the contact's point, with a bound, a target velocity and a CFM each, so
// contact joints are made for the step and taken away after it.
//
// The contact's normal row, which presses only one way, is kept out by a target velocity far below
// any motion: its force is zero, and no tie can make ODE's direct solver take it up.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cstddef>

#include "ductile/joint/pair.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/symmetric_row.hpp"

namespace ductile::ode {

/// A row along a direction; its centre is not applied here.
struct PointRow {
    Vector3<double> direction{0, 0, 0}; ///< world, unit
    SymmetricRow row;
};

class PointRows {
  public:
    explicit PointRows(dWorldID world) : world_(world), group_(dJointGroupCreate(0)) {}
    ~PointRows() { dJointGroupDestroy(group_); }
    PointRows(const PointRows&) = delete;
    PointRows& operator=(const PointRows&) = delete;

    /// Makes the rows on `a`, opposite on `b` (null: the static world), for the coming step.
    /// Directions at right angles to each other; rows without strength are left out.
    void make(dBodyID a, dBodyID b, const Vector3<double>& point,
              const std::array<PointRow, 3>& rows) {
        std::array<const PointRow*, 3> acting{};
        std::size_t count = 0;
        for (const PointRow& row : rows) {
            if (row.row.strength > 0) acting[count++] = &row;
        }
        for (std::size_t i = 0; i < count; i += 2) {
            const PointRow* second = i + 1 < count ? acting[i + 1] : nullptr;
            attach(a, b, contact(point, *acting[i], second), feedback_[i / 2]);
        }
    }

    /// What the rows did in the step, about the centres of mass; takes them away.
    [[nodiscard]] OutsideForce collect() {
        OutsideForce result;
        for (const dJointFeedback& f : feedback_) {
            result.force += to_core(f.f1);
            result.torque_a += to_core(f.t1);
            result.torque_b += to_core(f.t2);
        }
        clear();
        return result;
    }
    /// Takes the rows away.
    void clear() {
        dJointGroupEmpty(group_);
        feedback_ = {};
    }

  private:
    static constexpr double never = -1e15; ///< [m/s]

    static dContact contact(const Vector3<double>& point, const PointRow& first,
                            const PointRow* second) {
        // ODE's second friction direction is normal × first
        const Vector3<double> other =
            second != nullptr ? second->direction : first.direction.unitOrthogonal();
        const Vector3<double> normal = first.direction.cross(other);
        dContact result{};
        result.surface.mode = dContactAxisDep | dContactFDir1 | dContactMotionN | dContactMotion1 |
                              dContactMotion2 | dContactSlip1 | dContactSlip2;
        for (int i = 0; i < 3; ++i) {
            result.geom.pos[i] = dReal(point[i]);
            result.geom.normal[i] = dReal(normal[i]);
            result.fdir1[i] = dReal(first.direction[i]);
        }
        result.surface.motionN = dReal(never);
        result.surface.mu = dReal(first.row.strength);
        result.surface.motion1 = dReal(first.row.velocity);
        result.surface.slip1 = dReal(first.row.cfm);
        if (second == nullptr) return result;
        result.surface.mu2 = dReal(second->row.strength);
        result.surface.motion2 = dReal(second->row.velocity);
        result.surface.slip2 = dReal(second->row.cfm);
        return result;
    }

    void attach(dBodyID a, dBodyID b, const dContact& contact, dJointFeedback& feedback) {
        const dJointID joint = dJointCreateContact(world_, group_, &contact);
        dJointAttach(joint, a, b);
        dJointSetFeedback(joint, &feedback);
    }

    dWorldID world_;
    dJointGroupID group_;
    std::array<dJointFeedback, 2> feedback_{};
};

} // namespace ductile::ode
