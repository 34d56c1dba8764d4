// SPDX-License-Identifier: MIT
//
// Bodies of island_solver.hpp: axes of Bullet's constraints whose two limits are one. A part of
// island_solver.ipp.
//
// Trap of Bullet 3.24: a hinge, a slider and a btGeneric6DofConstraint, universal ones too, have no
// row for such an axis while it is exactly there, as where its bodies were put, and as where they
// rest: what hangs on it falls for a tick, and is caught. btGeneric6DofSpring2Constraint and
// btFixedConstraint have one.
#pragma once

#include <BulletDynamics/ConstraintSolver/btGeneric6DofConstraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ductile/bullet/constraint_stops.hpp"
#ifdef DUCTILE_COMPILED
#include "ductile/bullet/constraint_stops.ipp"
#endif

namespace ductile::bullet::detail {

/// While this lives such axes of constraints, their bodies being where they are, have their limits
/// a last digit off, and so a row.
class HeldAxes {
  public:
    HeldAxes() = default;
    ~HeldAxes() {
        for (const auto& [constraint, number, limit] : limits_) {
            set_limits(*constraint, number, limit, limit);
        }
    }
    HeldAxes(const HeldAxes&) = delete;
    HeldAxes& operator=(const HeldAxes&) = delete;

    void take(btTypedConstraint& constraint) {
        if (!constraint.isEnabled()) return;
        switch (constraint.getConstraintType()) {
            case HINGE_CONSTRAINT_TYPE: {
                auto& hinge = static_cast<btHingeConstraint&>(constraint);
                take(hinge, 3, hinge.getLowerLimit(), hinge.getUpperLimit(),
                     [&] { return hinge.getHingeAngle(); });
                break;
            }
            case SLIDER_CONSTRAINT_TYPE:
                take_slider(static_cast<btSliderConstraint&>(constraint));
                break;
            case D6_CONSTRAINT_TYPE:
            case D6_SPRING_CONSTRAINT_TYPE:
                take_six(static_cast<btGeneric6DofConstraint&>(constraint));
                break;
            default:
                break;
        }
    }

  private:
    struct Limit {
        btTypedConstraint* constraint;
        int number;
        btScalar both; ///< the user's
    };
    template <class At>
    void take(btTypedConstraint& constraint, int number, btScalar least, btScalar most,
              const At& at) {
        if (least != most || at() != most) return;
        limits_.push_back({&constraint, number, most});
        constexpr btScalar smallest = std::numeric_limits<btScalar>::min();
        const btScalar off = most + std::max(SIMD_EPSILON * std::abs(most), smallest);
        set_limits(constraint, number, off, off);
    }
    void take_slider(btSliderConstraint& slider) {
        const bool held = slider.getLowerLinLimit() == slider.getUpperLinLimit() ||
                          slider.getLowerAngLimit() == slider.getUpperAngLimit();
        if (!held) return;
        slider.calculateTransforms(slider.getRigidBodyA().getCenterOfMassTransform(),
                                   slider.getRigidBodyB().getCenterOfMassTransform());
        slider.testAngLimits();
        slider.testLinLimits();
        take(slider, 0, slider.getLowerLinLimit(), slider.getUpperLinLimit(),
             [&] { return slider.getLinearPos(); });
        take(slider, 3, slider.getLowerAngLimit(), slider.getUpperAngLimit(),
             [&] { return slider.getAngularPos(); });
    }
    void take_six(btGeneric6DofConstraint& six) {
        six.calculateTransforms();
        for (int i = 0; i < 3; ++i) {
            const auto& moves = *six.getTranslationalLimitMotor();
            const auto& turns = *six.getRotationalLimitMotor(i);
            take(six, i, moves.m_lowerLimit[i], moves.m_upperLimit[i],
                 [&] { return six.getRelativePivotPosition(i); });
            take(six, i + 3, turns.m_loLimit, turns.m_hiLimit, [&] { return six.getAngle(i); });
        }
    }

    std::vector<Limit> limits_;
};

} // namespace ductile::bullet::detail
