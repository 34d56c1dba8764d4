// SPDX-License-Identifier: MIT
//
// Bodies of island_solver.hpp: rows of the engine's own that turn within a part. A part of
// island_solver.ipp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpringConstraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "ductile/bullet/island_solver_held.ipp"
#include "ductile/bullet/island_solver_motors.ipp"
#include "ductile/bullet/moving_bodies.hpp"

namespace ductile::bullet {

namespace detail {

/// Of a body that others are solved with at the same time, and that may not be moved here.
[[nodiscard]] DUCTILE_INLINE bool is_led(const btRigidBody& body) noexcept {
    return !moves(&body) &&
           !(body.getLinearVelocity().isZero() && body.getAngularVelocity().isZero());
}

/// While this lives a body is where its velocity takes it in `time` [s].
class BodyAhead {
  public:
    BodyAhead(btRigidBody& body, btScalar time) : body_(body), now_(body.getWorldTransform()) {
        if (moves(&body_)) body_.setWorldTransform(moved(body_, now_, time));
    }
    ~BodyAhead() {
        if (moves(&body_)) body_.setWorldTransform(now_);
    }
    BodyAhead(const BodyAhead&) = delete;
    BodyAhead& operator=(const BodyAhead&) = delete;

  private:
    btRigidBody& body_;
    btTransform now_;
};

/// While this lives rows of hinges' pins go along the axes of the world, not along their arms,
/// which turn: the same three rows, in parts of frames. Those of sliders that go by the frame of B
/// act on the arms that they have: with its offset of frames Bullet takes the way along the axis
/// for the opposite one, and they drive what they should hold.
class PlainFrames {
  public:
    PlainFrames(const std::vector<btTypedConstraint*>& constraints, bool part) {
        for (btTypedConstraint* constraint : constraints) {
            if (part && constraint->getConstraintType() == HINGE_CONSTRAINT_TYPE) {
                take(static_cast<btHingeConstraint&>(*constraint), hinges_);
            } else if (constraint->getConstraintType() == SLIDER_CONSTRAINT_TYPE) {
                auto& slider = static_cast<btSliderConstraint&>(*constraint);
                if (!slider.getUseLinearReferenceFrameA()) take(slider, sliders_);
            }
        }
    }
    ~PlainFrames() {
        for (btHingeConstraint* hinge : hinges_) hinge->setUseFrameOffset(true);
        for (btSliderConstraint* slider : sliders_) slider->setUseFrameOffset(true);
    }
    PlainFrames(const PlainFrames&) = delete;
    PlainFrames& operator=(const PlainFrames&) = delete;

  private:
    template <class Constraint>
    static void take(Constraint& constraint, std::vector<Constraint*>& taken) {
        if (!constraint.getUseFrameOffset()) return;
        taken.push_back(&constraint);
        constraint.setUseFrameOffset(false);
    }

    std::vector<btHingeConstraint*> hinges_;
    std::vector<btSliderConstraint*> sliders_;
};

[[nodiscard]] DUCTILE_INLINE Vector6<double> twist(const btVector3& linear,
                                                   const btVector3& angular) {
    return twist_of(to_core(linear), to_core(angular));
}
[[nodiscard]] DUCTILE_INLINE Vector6<double> on_a(const btSolverConstraint& row) {
    return twist(row.m_contactNormal1, row.m_relpos1CrossNormal);
}
[[nodiscard]] DUCTILE_INLINE Vector6<double> on_b(const btSolverConstraint& row) {
    return twist(row.m_contactNormal2, row.m_relpos2CrossNormal);
}

/// In the order of its rows, as it last looked at its bodies. One with Bullet's damping is no
/// spring and damper: that bounds its speed, by what a tick's length says.
DUCTILE_INLINE void list_springs(btGeneric6DofSpringConstraint& constraint,
                                 std::vector<OwnSpring>& springs) {
    int row = 0;
    const int first = constraint.getUseFrameOffset() ? 3 : 0; // turns come first
    for (int k = 0; k < 6; ++k) {
        const int i = (first + k) % 6;
        const bool moves = i < 3;
        const auto& axes = *constraint.getTranslationalLimitMotor();
        const auto& turn = *constraint.getRotationalLimitMotor(i % 3);
        if (!(moves ? axes.needApplyForce(i) : turn.needApplyTorques())) continue;
        const bool stopped = (moves ? axes.m_currentLimit[i] : turn.m_currentLimit) != 0;
        if (constraint.isSpringEnabled(i) && !stopped && constraint.getDamping(i) == 1) {
            const btScalar at = moves ? constraint.getRelativePivotPosition(i)
                                      : constraint.getAngle(i - 3),
                           strain = at - constraint.getEquilibriumPoint(i);
            springs.push_back(
                {row, double(constraint.getStiffness(i)), 0, double(moves ? -strain : strain)});
        }
        ++row;
    }
}
DUCTILE_INLINE void list_springs(btGeneric6DofSpring2Constraint& constraint,
                                 std::vector<OwnSpring>& springs) {
    int row = 0;
    const auto add = [&](int limit, bool motor, bool spring, const OwnSpring& law) {
        constexpr int both_stops = 4;
        row += (limit == both_stops ? 2 : limit != 0 ? 1 : 0) + (motor ? 1 : 0);
        if (!spring) return;
        springs.push_back(law);
        springs.back().row = row++;
    };
    constexpr int orders[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const int i : orders[constraint.getRotationOrder()]) {
        const btRotationalLimitMotor2& axis = *constraint.getRotationalLimitMotor(i);
        add(axis.m_currentLimit, axis.m_enableMotor, axis.m_enableSpring,
            {0, double(axis.m_springStiffness), double(axis.m_springDamping),
             double(axis.m_currentPosition - axis.m_equilibriumPoint)});
    }
    const btTranslationalLimitMotor2& axes = *constraint.getTranslationalLimitMotor();
    for (int i = 0; i < 3; ++i) {
        add(axes.m_currentLimit[i], axes.m_enableMotor[i], axes.m_enableSpring[i],
            {0, double(axes.m_springStiffness[i]), double(axes.m_springDamping[i]),
             double(axes.m_equilibriumPoint[i] - axes.m_currentLinearDiff[i])});
    }
}

} // namespace detail

/// The others' rows as the part will end.
DUCTILE_INLINE void IslandSolver::look_ahead(const btContactSolverInfo& info) {
    at_end_.clear();
    count_at_end_.clear();
    if (!ahead_) return;
    for (btTypedConstraint* constraint : others_) {
        btTypedConstraint::btConstraintInfo1 size{};
        const btScalar half = info.m_timeStep / 2;
        btRigidBody &of_a = constraint->getRigidBodyA(), &of_b = constraint->getRigidBodyB();
        const detail::BodyAhead a(of_a, half), b(of_b, half);
        detail::HeldAxes held;
        held.take(*constraint);
        const bool led = detail::is_led(of_a) || detail::is_led(of_b);
        if (constraint->isEnabled() && !led) constraint->getInfo1(&size);
        count_at_end_.push_back(size.m_numConstraintRows);
        state_rows(*constraint, size.m_numConstraintRows, info, at_end_);
    }
}

/// Of a body of this solve, as the part began.
DUCTILE_INLINE Vector6<double> IslandSolver::began(int body) const {
    const btSolverBody& moved = m_tmpSolverBodyPool[body];
    return detail::twist(moved.m_linearVelocity, moved.m_angularVelocity);
}
/// The same, by outside forces in all of it.
DUCTILE_INLINE Vector6<double> IslandSolver::pushed(int body) const {
    const btSolverBody& moved = m_tmpSolverBodyPool[body];
    return detail::twist(moved.m_externalForceImpulse, moved.m_externalTorqueImpulse);
}

/// The same along a row.
DUCTILE_INLINE double IslandSolver::began(const btSolverConstraint& row) const {
    return detail::on_a(row).dot(began(row.m_solverBodyIdA)) +
           detail::on_b(row).dot(began(row.m_solverBodyIdB));
}
DUCTILE_INLINE double IslandSolver::pushed(const btSolverConstraint& row) const {
    return detail::on_a(row).dot(pushed(row.m_solverBodyIdA)) +
           detail::on_b(row).dot(pushed(row.m_solverBodyIdB));
}

/// Springs have the mean of their forces over the part, whatever they are limited to.
DUCTILE_INLINE void IslandSolver::load_springs() {
    spring_rows_.clear();
    const bool blow = 2 * half_ <= blow_length; // in which they give nothing
    if (!ahead_ && !blow) return;
    std::size_t first = 0;
    for (std::size_t i = 0; i < others_.size(); ++i) {
        const std::size_t of_this = first;
        const int count = m_tmpConstraintSizesPool[int(i)].m_numConstraintRows;
        first += std::size_t(count);
        const btTypedConstraintType type = others_[i]->getConstraintType();
        springs_.clear();
        if (count == 0) continue;
        if (type == D6_SPRING_2_CONSTRAINT_TYPE) {
            detail::list_springs(static_cast<btGeneric6DofSpring2Constraint&>(*others_[i]),
                                 springs_);
        } else if (type == D6_SPRING_CONSTRAINT_TYPE) {
            detail::list_springs(static_cast<btGeneric6DofSpringConstraint&>(*others_[i]),
                                 springs_);
        }
        for (const auto& [place, stiffness, damping, strain] : springs_) {
            const btSolverConstraint& row =
                m_tmpSolverNonContactConstraintPool[int(of_this) + place];
            if (!(row.m_jacDiagABInv > 0) || !(stiffness > 0 || damping > 0)) continue;
            const double comes = began(row), push = pushed(row);
            const LawRow law =
                law_row(stiffness, damping, double(row.m_jacDiagABInv), strain, comes, 2 * half_);
            solve::IslandRow& held = island_.rows[first_read_ + of_this + std::size_t(place)];
            if (blow) {
                held.target = held.lower = held.upper = 0;
                continue;
            }
            held.target = law.target - comes - push;
            held.compliance = law.compliance;
            held.lower = -std::numeric_limits<double>::infinity();
            held.upper = std::numeric_limits<double>::infinity();
            spring_rows_.push_back({first_read_ + of_this + std::size_t(place), stiffness,
                                    double(row.m_jacDiagABInv), comes, law});
        }
    }
}

DUCTILE_INLINE void IslandSolver::read_own() {
    if (!ahead_) return;
    const double h = 2 * half_;
    for (const detail::SpringRow& spring : spring_rows_) {
        const double impulse = island_.rows[spring.row].impulse;
        const double end = spring.law.target - spring.law.compliance * impulse;
        own_.add_spring(spring.stiffness, spring.mass, impulse / h, spring.start, end, h);
    }
    for (const detail::SoftRow& soft : soft_rows_) {
        const solve::IslandRow& row = island_.rows[soft.row];
        const double end = row.target - row.compliance * row.impulse + soft.added;
        soft.law.tell(own_, row.impulse / h, soft.start, end, h);
    }
    const auto tell = [&](int place, const solve::IslandRow& motor) {
        const double strength = motor.upper / h;
        if (std::isinf(strength) || !(strength > 0) || motor.lower != -motor.upper) return;
        const btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[place];
        own_.add_motor(strength, double(row.m_jacDiagABInv), motor.impulse / h,
                       motor.target + pushed(row), h);
    };
    for (int i = 0; i < m_tmpSolverNonContactConstraintPool.size(); ++i) {
        tell(i, island_.rows[first_read_ + std::size_t(i)]);
    }
    for (const auto& [place, row] : motor_rows_) tell(int(place), island_.rows[row]);
}

/// Has those of them that hold both ways be right at the end of the part.
DUCTILE_INLINE void IslandSolver::turn_rows() {
    std::size_t then = 0, now = 0;
    for (std::size_t i = 0; i < count_at_end_.size(); ++i) {
        const int count = m_tmpConstraintSizesPool[int(i)].m_numConstraintRows;
        const bool same = count == count_at_end_[i]; // else a stop began or ended, or it is led
        for (int k = 0; same && k < count; ++k) {
            const StatedRow& end = at_end_[then + std::size_t(k)];
            const btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[int(now) + k];
            solve::IslandRow& turned = island_.rows[first_read_ + now + std::size_t(k)];
            if (!std::isinf(turned.lower) || !std::isinf(turned.upper)) continue;
            const int a = row.m_solverBodyIdA, b = row.m_solverBodyIdB;
            const double comes = began(row), push = pushed(row);
            const double leaves = detail::twist(end.move_a, end.turn_a).dot(began(a)) +
                                  detail::twist(end.move_b, end.turn_b).dot(began(b));
            const double asked = turned.target + comes + push; // in the middle
            turned.target = (4 * asked - double(end.error)) / 3 - push - leaves;
        }
        then += std::size_t(count_at_end_[i]);
        now += std::size_t(count);
    }
}

} // namespace ductile::bullet
