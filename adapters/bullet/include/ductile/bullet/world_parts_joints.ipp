// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: what a part asks of Bullet's own joints. A part of world_parts.ipp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/Vehicle/btRaycastVehicle.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ductile/bullet/constraint_stops.hpp"
#include "ductile/bullet/half_ahead.hpp"

namespace ductile::bullet {

/// While this lives a part has its share of what Bullet bounds by an impulse a tick: motors of
/// hinges, clamps of points, brakes of vehicles.
class WorldParts::Impulses {
  public:
    /// `vehicles`: there may be some.
    Impulses(btDiscreteDynamicsWorld& world, btScalar share, bool vehicles) {
        if (vehicles) take_brakes(world, share);
        for (int i = 0; i < world.getNumConstraints(); ++i) {
            btTypedConstraint& constraint = *world.getConstraint(i);
            if (constraint.getConstraintType() == HINGE_CONSTRAINT_TYPE) {
                auto& hinge = static_cast<btHingeConstraint&>(constraint);
                if (hinge.getEnableAngularMotor()) take(hinge, hinge.getMaxMotorImpulse(), share);
            } else if (constraint.getConstraintType() == POINT2POINT_CONSTRAINT_TYPE) {
                auto& point = static_cast<btPoint2PointConstraint&>(constraint);
                const btScalar clamp = point.m_setting.m_impulseClamp;
                if (clamp > 0) take(point, clamp, share);
            }
        }
    }
    ~Impulses() {
        for (const auto& [wheel, brake] : brakes_) wheel->m_brake = brake;
        for (const auto& [constraint, impulse] : usual_) set(*constraint, impulse);
    }
    Impulses(const Impulses&) = delete;
    Impulses& operator=(const Impulses&) = delete;

  private:
    void take_brakes(btDiscreteDynamicsWorld& world, btScalar share) {
        auto& actions = detail::ActionArray::of(world);
        for (int i = 0; i < actions.size(); ++i) {
            auto* vehicle = dynamic_cast<btRaycastVehicle*>(actions[i]);
            for (int k = 0; vehicle != nullptr && k < vehicle->getNumWheels(); ++k) {
                btWheelInfo& wheel = vehicle->getWheelInfo(k);
                brakes_.emplace_back(&wheel, wheel.m_brake);
                wheel.m_brake *= share;
            }
        }
    }
    void take(btTypedConstraint& constraint, btScalar impulse, btScalar share) {
        usual_.emplace_back(&constraint, impulse);
        set(constraint, impulse * share);
    }
    static void set(btTypedConstraint& constraint, btScalar impulse) {
        if (constraint.getConstraintType() == HINGE_CONSTRAINT_TYPE) {
            static_cast<btHingeConstraint&>(constraint).setMaxMotorImpulse(impulse);
        } else {
            static_cast<btPoint2PointConstraint&>(constraint).m_setting.m_impulseClamp = impulse;
        }
    }

    std::vector<std::pair<btTypedConstraint*, btScalar>> usual_;
    std::vector<std::pair<btWheelInfo*, btScalar>> brakes_;
};

/// Stops of Bullet's own constraints in islands with plastic joints, within `h` [s].
DUCTILE_INLINE void WorldParts::see_stops(double h, ClosingContacts& found) {
    for (btTypedConstraint* constraint : constraints_of(world_, nullptr)) {
        if (!has_part_stops(*constraint)) continue;
        found.strikes = found.strikes || strikes_stop(*constraint, touching_);
        found.time =
            std::min(found.time, time_to_stop(*constraint, std::min(h, found.time), apart_));
    }
}

DUCTILE_INLINE bool WorldParts::has_part_stops(btTypedConstraint& constraint) {
    return as_plastic(constraint) == nullptr &&
           (concerns(constraint.getRigidBodyA()) || concerns(constraint.getRigidBodyB()));
}

DUCTILE_INLINE double WorldParts::closed_early(double h) {
    const double gap = closing_.closed_early(world_, h, apart_);
    if (!(stop_met_ < h)) return gap;
    return gap > 0 ? std::min(gap, stop_met_) : stop_met_;
}

DUCTILE_INLINE void WorldParts::take_stops(PartStops& stops) {
    if (!at_risk_) return;
    for (btTypedConstraint* constraint : constraints_of(world_, nullptr)) {
        if (has_part_stops(*constraint)) stops.take(*constraint);
    }
}

} // namespace ductile::bullet
