// SPDX-License-Identifier: MIT
//
// Bodies of island_solver.hpp: motors of axes that are at one of their two stops. A part of
// island_solver.ipp.
//
// Trap of Bullet 3.24: an axis of a hinge, a slider and a btGeneric6DofConstraint has one row,
// which is its stop's there. A motor that pushes into it pushes no more, so that any load takes the
// axis off it, and one that pushes away has all the force that it takes to be as fast as it is
// meant within the tick. Here it has a row beside that of the stop. btGeneric6DofSpring2Constraint
// has one.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "ductile/bullet/island_solver_held.ipp"
#include "ductile/bullet/stated_rows.hpp"

namespace ductile::bullet {

namespace detail {

/// Of a row, by Bullet's.
[[nodiscard]] DUCTILE_INLINE double limit(btScalar value) noexcept {
    constexpr double unlimited = 1e9;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (double(value) >= unlimited) return infinity;
    if (double(value) <= -unlimited) return -infinity;
    return double(value);
}

/// While this lives such axes have their stops alone.
class StoppedMotors {
  public:
    explicit StoppedMotors(const btContactSolverInfo& info) : info_(info) {}
    ~StoppedMotors() {
        for (btHingeConstraint* hinge : hinges_) hinge->enableMotor(true);
        for (const auto& [slider, moves] : sliders_) set(*slider, moves, true);
    }
    StoppedMotors(const StoppedMotors&) = delete;
    StoppedMotors& operator=(const StoppedMotors&) = delete;

    /// Its rows as if it had no stops go to `rows`, if there is such an axis.
    void take(btTypedConstraint& constraint, std::vector<StatedRow>& rows) {
        if (!constraint.isEnabled()) return;
        axes_.clear();
        btTypedConstraint::btConstraintInfo1 size{};
        switch (constraint.getConstraintType()) {
            case HINGE_CONSTRAINT_TYPE: {
                auto& hinge = static_cast<btHingeConstraint&>(constraint);
                if (!hinge.getEnableAngularMotor()) return;
                hinge.getInfo1(&size);
                if (hinge.getSolveLimit() != 0)
                    add(3, hinge.getLowerLimit(), hinge.getUpperLimit());
                if (!axes_.empty()) hinges_.push_back(&hinge);
                break;
            }
            case SLIDER_CONSTRAINT_TYPE:
                take_slider(static_cast<btSliderConstraint&>(constraint), size);
                break;
            case D6_CONSTRAINT_TYPE:
            case D6_SPRING_CONSTRAINT_TYPE:
                take_six(static_cast<btGeneric6DofConstraint&>(constraint), size);
                break;
            default:
                return;
        }
        if (axes_.empty()) return;
        for (const Axis& axis : axes_) set_limits(constraint, axis.number, 1, -1);
        constraint.getInfo1(&size);
        state_rows(constraint, size.m_numConstraintRows, info_, rows);
        for (const Axis& axis : axes_) set_limits(constraint, axis.number, axis.least, axis.most);
        for (const Axis& axis : axes_) switch_off(constraint, axis.number < 3);
    }

  private:
    struct Axis {
        int number;
        btScalar least, most; ///< the user's, or a part's
    };
    void add(int number, btScalar least, btScalar most) {
        if (least < most) axes_.push_back({number, least, most});
    }
    void take_slider(btSliderConstraint& slider, btTypedConstraint::btConstraintInfo1& size) {
        if (!slider.getPoweredLinMotor() && !slider.getPoweredAngMotor()) return;
        slider.getInfo1(&size);
        if (slider.getPoweredLinMotor() && slider.getSolveLinLimit()) {
            add(0, slider.getLowerLinLimit(), slider.getUpperLinLimit());
        }
        if (slider.getPoweredAngMotor() && slider.getSolveAngLimit()) {
            add(3, slider.getLowerAngLimit(), slider.getUpperAngLimit());
        }
    }
    void take_six(btGeneric6DofConstraint& six, btTypedConstraint::btConstraintInfo1& size) {
        const auto& moves = *six.getTranslationalLimitMotor();
        bool any = false;
        for (int i = 0; i < 3; ++i) {
            any = any || moves.m_enableMotor[i] || six.getRotationalLimitMotor(i)->m_enableMotor;
        }
        if (!any) return;
        six.getInfo1(&size);
        for (int i = 0; i < 3; ++i) {
            const auto& turns = *six.getRotationalLimitMotor(i);
            if (moves.m_enableMotor[i] && moves.m_currentLimit[i] != 0) {
                add(i, moves.m_lowerLimit[i], moves.m_upperLimit[i]);
            }
            if (turns.m_enableMotor && turns.m_currentLimit != 0) {
                add(i + 3, turns.m_loLimit, turns.m_hiLimit);
            }
        }
    }
    /// Bullet does so itself with one of six degrees of freedom.
    void switch_off(btTypedConstraint& constraint, bool moves) {
        if (constraint.getConstraintType() == HINGE_CONSTRAINT_TYPE) {
            hinges_.back()->enableMotor(false);
        } else if (constraint.getConstraintType() == SLIDER_CONSTRAINT_TYPE) {
            sliders_.emplace_back(static_cast<btSliderConstraint*>(&constraint), moves);
            set(*sliders_.back().first, moves, false);
        }
    }
    static void set(btSliderConstraint& slider, bool moves, bool on) {
        moves ? slider.setPoweredLinMotor(on) : slider.setPoweredAngMotor(on);
    }

    const btContactSolverInfo& info_;
    std::vector<Axis> axes_; ///< of one constraint
    std::vector<btHingeConstraint*> hinges_;
    std::vector<std::pair<btSliderConstraint*, bool>> sliders_;
};

} // namespace detail

/// Rows of motors at their stops, beside those of the stops; after all that are read.
DUCTILE_INLINE void IslandSolver::load_motors() {
    motor_rows_.clear();
    std::size_t first = 0, of_this = 0;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        const int count = m_tmpConstraintSizesPool[int(i)].m_numConstraintRows;
        const bool same = count == unstopped_count_[i];
        for (int k = 0; same && k < count; ++k) {
            const StatedRow& motor = unstopped_[of_this + std::size_t(k)];
            const std::size_t place = first + std::size_t(k);
            const solve::IslandRow& stop = island_.rows[first_read_ + place];
            const double impulse = detail::limit(motor.upper);
            const bool pushes = impulse > 0 && !std::isinf(impulse) && motor.lower == -motor.upper;
            if (!pushes || std::isinf(stop.lower) == std::isinf(stop.upper)) continue;
            const btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[int(place)];
            if (!(row.m_jacDiagABInv > 0)) continue;
            solve::IslandRow added = stop;
            added.target = double(motor.error) - began(row) - pushed(row);
            added.compliance = added.impulse = 0;
            added.lower = -impulse;
            added.upper = impulse;
            motor_rows_.emplace_back(place, island_.rows.size());
            island_.rows.push_back(added);
        }
        first += std::size_t(count);
        of_this += std::size_t(unstopped_count_[i]);
    }
}

} // namespace ductile::bullet
