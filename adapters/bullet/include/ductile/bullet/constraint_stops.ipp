// SPDX-License-Identifier: MIT
//
// Bodies of constraint_stops.hpp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btGeneric6DofConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>

#include <algorithm>
#include <limits>

#include "ductile/bullet/constraint_stops.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/stated_rows.hpp"
#include "ductile/frame/part_settings.hpp"

namespace ductile::bullet {

namespace detail {

/// Of one with six degrees of freedom, of either kind.
template <class SixAxes>
void add_six(SixAxes& constraint, const btTransform& a, const btTransform& b, StoppedAxes& axes) {
    const auto* moves = constraint.getTranslationalLimitMotor();
    bool any = false;
    for (int i = 0; i < 3; ++i) {
        const auto* turns = constraint.getRotationalLimitMotor(i);
        any = any || moves->m_lowerLimit[i] < moves->m_upperLimit[i] ||
              turns->m_loLimit < turns->m_hiLimit;
    }
    if (!any) return;
    constraint.calculateTransforms(a, b);
    for (int i = 0; i < 3; ++i) {
        axes.add({i, moves->m_lowerLimit[i], moves->m_upperLimit[i],
                  constraint.getRelativePivotPosition(i)});
        const auto* turns = constraint.getRotationalLimitMotor(i);
        const btScalar least = turns->m_loLimit, most = turns->m_hiLimit;
        axes.add({i + 3, least, most, btAdjustAngleToLimits(constraint.getAngle(i), least, most)});
    }
}

DUCTILE_INLINE void add_slider(btSliderConstraint& slider, const btTransform& a,
                               const btTransform& b, StoppedAxes& axes) {
    const bool stopped = slider.getLowerLinLimit() < slider.getUpperLinLimit() ||
                         slider.getLowerAngLimit() < slider.getUpperAngLimit();
    if (!stopped) return;
    slider.calculateTransforms(a, b);
    slider.testAngLimits();
    slider.testLinLimits();
    axes.add({0, slider.getLowerLinLimit(), slider.getUpperLinLimit(), slider.getLinearPos()});
    axes.add({3, slider.getLowerAngLimit(), slider.getUpperAngLimit(), slider.getAngularPos()});
}

/// Of its twist, and of its swing where both spans bound that; as far as it goes either way.
DUCTILE_INLINE void add_cone(btConeTwistConstraint& cone, const btTransform& a,
                             const btTransform& b, StoppedAxes& axes) {
    if (cone.isMotorEnabled()) return;
    const btQuaternion turned =
        (b * cone.getBFrame()).getRotation().inverse() * (a * cone.getAFrame()).getRotation();
    const btVector3 x(1, 0, 0), leans = quatRotate(turned, x).normalized();
    const btQuaternion twist = shortestArcQuat(x, leans).inverse() * turned;
    const btScalar softness = cone.getLimitSoftness(), none = -SIMD_2_PI;
    const btScalar twisted = btVector3(twist.x(), twist.y(), twist.z()).length();
    const btScalar span = cone.getTwistSpan() * softness;
    if (span > 0 && span < SIMD_PI) {
        axes.add({3, none, span, 2 * btAtan2(twisted, std::abs(twist.w()))});
    }
    const btScalar side = std::hypot(leans.y(), leans.z());
    const btScalar span_1 = cone.getSwingSpan1(), span_2 = cone.getSwingSpan2();
    const btScalar narrow = std::min(span_1, span_2);
    if (!(narrow >= cone.getFixThresh()) || !(narrow < SIMD_PI)) return;
    const btScalar limit =
        side > 0 ? side / std::hypot(leans.z() / span_2, leans.y() / span_1) : narrow;
    axes.add({4, none, limit * softness, btAtan2(side, leans.x())});
}

} // namespace detail

DUCTILE_INLINE StoppedAxes stopped_axes(btTypedConstraint& constraint, const btTransform& a,
                                        const btTransform& b) {
    StoppedAxes axes;
    switch (constraint.getConstraintType()) {
        case HINGE_CONSTRAINT_TYPE: {
            auto& hinge = static_cast<btHingeConstraint&>(constraint);
            if (!hinge.hasLimit()) break;
            const btScalar least = hinge.getLowerLimit(), most = hinge.getUpperLimit();
            axes.add(
                {3, least, most, btAdjustAngleToLimits(hinge.getHingeAngle(a, b), least, most)});
            break;
        }
        case SLIDER_CONSTRAINT_TYPE:
            detail::add_slider(static_cast<btSliderConstraint&>(constraint), a, b, axes);
            break;
        case D6_CONSTRAINT_TYPE:
        case D6_SPRING_CONSTRAINT_TYPE:
            detail::add_six(static_cast<btGeneric6DofConstraint&>(constraint), a, b, axes);
            break;
        case CONETWIST_CONSTRAINT_TYPE:
            detail::add_cone(static_cast<btConeTwistConstraint&>(constraint), a, b, axes);
            break;
        case D6_SPRING_2_CONSTRAINT_TYPE:
            detail::add_six(static_cast<btGeneric6DofSpring2Constraint&>(constraint), a, b, axes);
            break;
        default:
            break;
    }
    return axes;
}
DUCTILE_INLINE StoppedAxes stopped_axes(btTypedConstraint& constraint) {
    return stopped_axes(constraint, constraint.getRigidBodyA().getCenterOfMassTransform(),
                        constraint.getRigidBodyB().getCenterOfMassTransform());
}

namespace detail {

/// At its stop, or beyond it [m | rad].
inline constexpr double at_stop = sizeof(btScalar) == sizeof(float) ? 1e-5 : 1e-7;

DUCTILE_INLINE void set_limits(btTypedConstraint& constraint, int number, btScalar least,
                               btScalar most) {
    const auto set_six = [&](auto& six) {
        if (number < 3) {
            six.getTranslationalLimitMotor()->m_lowerLimit[number] = least;
            six.getTranslationalLimitMotor()->m_upperLimit[number] = most;
        } else {
            six.getRotationalLimitMotor(number - 3)->m_loLimit = least;
            six.getRotationalLimitMotor(number - 3)->m_hiLimit = most;
        }
    };
    switch (constraint.getConstraintType()) {
        case HINGE_CONSTRAINT_TYPE: {
            auto& hinge = static_cast<btHingeConstraint&>(constraint);
            hinge.setLimit(least, most, hinge.getLimitSoftness(), hinge.getLimitBiasFactor(),
                           hinge.getLimitRelaxationFactor());
            break;
        }
        case SLIDER_CONSTRAINT_TYPE: {
            auto& slider = static_cast<btSliderConstraint&>(constraint);
            if (number < 3) {
                slider.setLowerLinLimit(least);
                slider.setUpperLinLimit(most);
            } else {
                slider.setLowerAngLimit(least);
                slider.setUpperAngLimit(most);
            }
            break;
        }
        case D6_SPRING_2_CONSTRAINT_TYPE:
            set_six(static_cast<btGeneric6DofSpring2Constraint&>(constraint));
            break;
        default:
            set_six(static_cast<btGeneric6DofConstraint&>(constraint));
    }
}

/// Of what bounds `axis`, which is there now; `most` < 0: nothing does.
DUCTILE_INLINE void set_span(btConeTwistConstraint& cone, const StoppedAxis& axis, btScalar most) {
    constexpr btScalar unlimited = btScalar(1e9);
    if (axis.number == 3) {
        cone.setLimit(3, most < 0 ? unlimited : most / cone.getLimitSoftness());
    } else {
        const btScalar span_1 = cone.getSwingSpan1() * most / axis.most,
                       span_2 = cone.getSwingSpan2() * most / axis.most;
        cone.setLimit(5, most < 0 ? unlimited : span_1);
        cone.setLimit(4, most < 0 ? unlimited : span_2);
    }
}

/// Whether both bodies would lose more than `energy` [J] at a stop that `axis` comes to with
/// `speed` [m/s | rad/s]; about which of their axes they turn is not asked.
[[nodiscard]] DUCTILE_INLINE bool comes_with(const btTypedConstraint& constraint,
                                             const StoppedAxis& axis, double speed, double energy) {
    double yields = 0;
    for (const btRigidBody* body : {&constraint.getRigidBodyA(), &constraint.getRigidBodyB()}) {
        const btVector3& turns = body->getInvInertiaDiagLocal();
        yields +=
            double(axis.moves() ? body->getInvMass() : std::min({turns.x(), turns.y(), turns.z()}));
    }
    return speed * speed > 2 * yields * energy;
}

} // namespace detail

DUCTILE_INLINE double time_to_stop(btTypedConstraint& constraint, double h, double energy) {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (!constraint.isEnabled()) return never;
    const btRigidBody &a = constraint.getRigidBodyA(), &b = constraint.getRigidBodyB();
    const btTransform &of_a = a.getCenterOfMassTransform(), &of_b = b.getCenterOfMassTransform();
    const auto then = [&](double time) {
        return stopped_axes(constraint, detail::moved(a, of_a, btScalar(time)),
                            detail::moved(b, of_b, btScalar(time)));
    };
    const StoppedAxes begin = stopped_axes(constraint);
    if (begin.count == 0) return never;
    constexpr double followed = 0.1; // [rad]
    constexpr int most_steps = 32, refined = 3;
    const double spin =
        std::max(double(a.getAngularVelocity().length()), double(b.getAngularVelocity().length()));
    const double step = std::max(spin * h > followed ? followed / spin : h, h / most_steps);
    double first = never;
    StoppedAxes now = begin;
    for (double time = 0; time < h && !(first < never);) {
        const double next = std::min(time + step, h);
        const StoppedAxes ahead = then(next);
        for (std::size_t i = 0; i < 2 * now.count; ++i) {
            const bool upper = i % 2 == 1;
            const StoppedAxis& axis = now.axes[i / 2];
            double from = time, left = axis.gap(upper), to = next,
                   beyond = ahead.axes[i / 2].gap(upper);
            const bool was_open = begin.axes[i / 2].gap(upper) > detail::at_stop;
            if (!was_open || !(left > 0 && beyond < 0)) continue;
            if (!detail::comes_with(constraint, axis, (left - beyond) / (to - from), energy)) {
                continue;
            }
            double at = from + left / (left - beyond) * (to - from);
            for (int k = 0; k < refined; ++k) {
                const double rest = then(at).axes[i / 2].gap(upper);
                (rest > 0 ? from : to) = at;
                (rest > 0 ? left : beyond) = rest;
                at = from + left / (left - beyond) * (to - from);
            }
            first = std::min(first, at);
        }
        time = next;
        now = ahead;
    }
    (void)stopped_axes(constraint); // what it calculated is of now again
    constexpr double past_it = 1 + 1e-6;
    return past_it * first < h ? past_it * first : never;
}

namespace detail {

/// Whether a blow by its stops would take more than `energy` [J]. Bullet stops a cone about axes
/// that do not turn with what they bound: at both stops at once these go on, however often they are
/// struck.
DUCTILE_INLINE bool strikes_by_rows(btConeTwistConstraint& cone, double energy) {
    PartStops stops;
    stops.take(cone);
    stops.set(blow_length, blow_length, 0);
    btTypedConstraint::btConstraintInfo1 size{};
    cone.getInfo1(&size);
    std::vector<StatedRow> rows;
    state_rows(cone, size.m_numConstraintRows, btContactSolverInfo(), rows);
    const btRigidBody &a = cone.getRigidBodyA(), &b = cone.getRigidBodyB();
    bool strikes = false;
    for (const StatedRow& row : rows) {
        const bool up = row.lower == 0, down = row.upper == 0;
        if (up == down) continue;
        const btScalar opens =
            row.turn_a.dot(a.getAngularVelocity()) + row.turn_b.dot(b.getAngularVelocity());
        const double closes = double((up ? -opens : opens) / row.turn_a.length());
        strikes = strikes || (closes > 0 && comes_with(cone, {3, 0, 0, 0}, closes, energy));
    }
    return strikes;
}

} // namespace detail

DUCTILE_INLINE bool strikes_stop(btTypedConstraint& constraint, double energy) {
    if (!constraint.isEnabled()) return false;
    const btRigidBody &a = constraint.getRigidBodyA(), &b = constraint.getRigidBodyB();
    const btTransform &of_a = a.getCenterOfMassTransform(), &of_b = b.getCenterOfMassTransform();
    const StoppedAxes now = stopped_axes(constraint);
    bool any = false;
    for (const StoppedAxis& axis : now) {
        any = any || axis.gap(false) <= detail::at_stop || axis.gap(true) <= detail::at_stop;
    }
    const btScalar speed = (a.getLinearVelocity() - b.getLinearVelocity()).length() +
                           a.getAngularVelocity().length() + b.getAngularVelocity().length();
    if (!any || !(speed > 0)) return false;
    const btScalar little = std::min(btScalar(1e-3) / speed, btScalar(1e-3)); // [s]
    const StoppedAxes then =
        stopped_axes(constraint, detail::moved(a, of_a, little), detail::moved(b, of_b, little));
    (void)stopped_axes(constraint);
    for (std::size_t i = 0; i < 2 * now.count; ++i) {
        const bool upper = i % 2 == 1;
        const StoppedAxis& axis = now.axes[i / 2];
        const double closes = (axis.gap(upper) - then.axes[i / 2].gap(upper)) / double(little);
        if (axis.gap(upper) <= detail::at_stop && closes > 0 &&
            detail::comes_with(constraint, axis, closes, energy)) {
            return constraint.getConstraintType() != CONETWIST_CONSTRAINT_TYPE ||
                   detail::strikes_by_rows(static_cast<btConeTwistConstraint&>(constraint), energy);
        }
    }
    return false;
}

DUCTILE_INLINE PartStops::~PartStops() { put_back(); }

DUCTILE_INLINE void PartStops::put_back() {
    for (const auto& [constraint, number, least, most] : limits_) {
        detail::set_limits(*constraint, number, least, most);
    }
    limits_.clear();
    for (const auto& [cone, span_1, span_2, twist, bias] : cones_) {
        cone->setLimit(span_1, span_2, twist, cone->getLimitSoftness(), bias,
                       cone->getRelaxationFactor());
    }
    cones_.clear();
    lent_.put_back();
}

DUCTILE_INLINE double PartStops::met(double h, double energy) const {
    double first = std::numeric_limits<double>::infinity();
    for (const auto& [constraint, began] : began_) {
        const StoppedAxes axes = stopped_axes(*constraint);
        for (std::size_t i = 0; i < 2 * axes.count; ++i) {
            const bool upper = i % 2 == 1;
            const double left = began.axes[i / 2].gap(upper), beyond = axes.axes[i / 2].gap(upper);
            if (!(left > detail::at_stop && beyond < 0)) continue;
            const double speed = (left - beyond) / h;
            if (!detail::comes_with(*constraint, axes.axes[i / 2], speed, energy)) continue;
            first = std::min(first, left / (left - beyond) * h);
        }
    }
    return first;
}

DUCTILE_INLINE void PartStops::take(btTypedConstraint& constraint) {
    if (!constraint.isEnabled()) return;
    if (constraint.getConstraintType() == CONETWIST_CONSTRAINT_TYPE) {
        auto& cone = static_cast<btConeTwistConstraint&>(constraint);
        cones_.push_back({&cone, cone.getSwingSpan1(), cone.getSwingSpan2(), cone.getTwistSpan(),
                          cone.getBiasFactor()});
    }
    const StoppedAxes axes = stopped_axes(constraint);
    if (axes.count > 0) began_.push_back({&constraint, axes});
}

DUCTILE_INLINE void PartStops::set(double h, double frame, double erp) {
    // of what a part without budget went beyond it, as of bodies that overlap
    slowly_ = erp > 0 ? btScalar(overlap_erp(erp, h, frame) / part_erp(erp, h)) : btScalar(1);
    for (const auto& [constraint, began] : began_) {
        const StoppedAxes now = stopped_axes(*constraint);
        for (std::size_t i = 0; i < now.count; ++i) hold(*constraint, began.axes[i], now.axes[i]);
        const btTypedConstraintType type = constraint->getConstraintType();
        if (type == D6_SPRING_2_CONSTRAINT_TYPE) {
            soften_all(static_cast<btGeneric6DofSpring2Constraint&>(*constraint), h, frame);
        } else if (type == D6_CONSTRAINT_TYPE || type == D6_SPRING_CONSTRAINT_TYPE) {
            soften_all(static_cast<btGeneric6DofConstraint&>(*constraint), h, frame);
        }
    }
    for (const auto& [cone, span_1, span_2, twist, bias] : cones_) {
        cone->setLimit(cone->getSwingSpan1(), cone->getSwingSpan2(), cone->getTwistSpan(),
                       cone->getLimitSoftness(), btScalar(part_erp(double(bias), h)),
                       cone->getRelaxationFactor());
    }
}

/// Beyond its stop as it began to be, if it was at one; else it has none.
DUCTILE_INLINE void PartStops::hold(btTypedConstraint& constraint, const StoppedAxis& began,
                                    const StoppedAxis& now) {
    const bool at_least = began.gap(false) <= detail::at_stop,
               at_most = began.gap(true) <= detail::at_stop;
    const bool open = !at_least && !at_most;
    const bool cone = constraint.getConstraintType() == CONETWIST_CONSTRAINT_TYPE;
    // but more than Bullet rounds: of a cone's angle 1 µrad in single precision
    const auto nothing = btScalar((cone ? 0.3 : 0.01) * detail::at_stop);
    const btScalar far_off = now.moves() ? btScalar(1e6) : btScalar(3);
    const auto beyond = [&](bool upper) {
        return std::max(nothing, slowly_ * btScalar(-began.gap(upper)));
    };
    const btScalar least = open ? btScalar(1) : now.at + (at_least ? beyond(false) : -far_off),
                   most = open ? btScalar(-1) : now.at - (at_most ? beyond(true) : -far_off);
    if (cone) {
        detail::set_span(static_cast<btConeTwistConstraint&>(constraint), now, most);
    } else {
        limits_.push_back({&constraint, now.number, now.least, now.most});
        detail::set_limits(constraint, now.number, least, most);
    }
}

/// Bullet sets those that the user did not.
template <class SixAxes>
void PartStops::soften_all(SixAxes& constraint, double h, double frame) {
    const auto soften = [&](btScalar& erp, btScalar& cfm) {
        const Softness spring = part_spring({double(erp), double(cfm)}, h, frame);
        lent_.put(erp, btScalar(spring.erp));
        lent_.put(cfm, btScalar(spring.compliance));
    };
    auto* moves = constraint.getTranslationalLimitMotor();
    for (int i = 0; i < 3; ++i) {
        auto* turns = constraint.getRotationalLimitMotor(i);
        soften(moves->m_stopERP[i], moves->m_stopCFM[i]);
        soften(turns->m_stopERP, turns->m_stopCFM);
    }
}

} // namespace ductile::bullet
