// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: what a part asks of Bullet's own joints. A part of world_parts.ipp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "ductile/bullet/half_ahead.hpp"

namespace ductile::bullet {

namespace detail {

/// When a hinge turns into its stop if it goes on as it does, within `h`; else infinite [s].
DUCTILE_INLINE double time_to_stop(btHingeConstraint& hinge, btScalar h) {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (!hinge.isEnabled() || !hinge.hasLimit()) return never;
    const btRigidBody &a = hinge.getRigidBodyA(), &b = hinge.getRigidBodyB();
    const btScalar spin = (a.getAngularVelocity() - b.getAngularVelocity()).length();
    constexpr btScalar followed = btScalar(0.1); // [rad]
    if (!(spin > 0)) return never;
    const btScalar time = std::min(h, followed / spin);
    const btScalar now =
        hinge.getHingeAngle(a.getCenterOfMassTransform(), b.getCenterOfMassTransform());
    const btScalar then = hinge.getHingeAngle(moved(a, a.getCenterOfMassTransform(), time),
                                              moved(b, b.getCenterOfMassTransform(), time));
    const auto turns = double(btNormalizeAngle(then - now) / time);
    const btScalar stop = turns > 0 ? hinge.getUpperLimit() : hinge.getLowerLimit();
    const double left = double(stop - now) / turns;
    constexpr double past_it = 1 + 1e-6;
    return left > 0 && left < double(h) ? past_it * left : never;
}

} // namespace detail

/// While this lives a part has its share of what Bullet bounds by an impulse a tick: motors of
/// hinges, clamps of points.
class WorldParts::Impulses {
  public:
    Impulses(btDiscreteDynamicsWorld& world, btScalar share) {
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
        for (const auto& [constraint, impulse] : usual_) set(*constraint, impulse);
    }
    Impulses(const Impulses&) = delete;
    Impulses& operator=(const Impulses&) = delete;

  private:
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
};

/// Of hinges of Bullet's in islands with plastic joints [s].
DUCTILE_INLINE double WorldParts::time_to_stops(double h) {
    double first = std::numeric_limits<double>::infinity();
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        btTypedConstraint& constraint = *world_.getConstraint(i);
        if (constraint.getConstraintType() != HINGE_CONSTRAINT_TYPE) continue;
        auto& hinge = static_cast<btHingeConstraint&>(constraint);
        const double time = detail::time_to_stop(hinge, btScalar(h));
        if (!(time < first)) continue;
        if (concerns(hinge.getRigidBodyA()) || concerns(hinge.getRigidBodyB())) first = time;
    }
    return first;
}

} // namespace ductile::bullet
