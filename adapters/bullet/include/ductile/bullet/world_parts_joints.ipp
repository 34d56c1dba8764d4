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

/// While this lives a part has its `share` of what motors of hinges, and clamps of points, may do,
/// which Bullet bounds by an impulse a tick.
class WorldParts::HingeMotors {
  public:
    HingeMotors(btDiscreteDynamicsWorld& world, btScalar share, Lent<btScalar>& lent) {
        for (btTypedConstraint* constraint : constraints_of(world, nullptr)) {
            if (constraint->getConstraintType() == HINGE_CONSTRAINT_TYPE) {
                auto* hinge = static_cast<btHingeConstraint*>(constraint);
                if (!hinge->getEnableAngularMotor()) continue;
                usual_.emplace_back(hinge, hinge->getMaxMotorImpulse());
                hinge->setMaxMotorImpulse(usual_.back().second * share);
            } else if (constraint->getConstraintType() == POINT2POINT_CONSTRAINT_TYPE) {
                auto* point = static_cast<btPoint2PointConstraint*>(constraint);
                btScalar& clamp = point->m_setting.m_impulseClamp;
                if (clamp > 0) lent.put(clamp, clamp * share);
            }
        }
    }
    ~HingeMotors() {
        for (const auto& [hinge, impulse] : usual_) hinge->setMaxMotorImpulse(impulse);
    }
    HingeMotors(const HingeMotors&) = delete;
    HingeMotors& operator=(const HingeMotors&) = delete;

  private:
    std::vector<std::pair<btHingeConstraint*, btScalar>> usual_;
};

/// The same of vehicles.
DUCTILE_INLINE void WorldParts::share_brakes(btScalar share, Lent<btScalar>& lent) {
    auto& actions = detail::ActionArray::of(world_);
    for (int i = 0; i < actions.size(); ++i) {
        auto* vehicle = dynamic_cast<btRaycastVehicle*>(actions[i]);
        for (int k = 0; vehicle != nullptr && k < vehicle->getNumWheels(); ++k) {
            btScalar& brake = vehicle->getWheelInfo(k).m_brake;
            lent.put(brake, brake * share);
        }
    }
}

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
