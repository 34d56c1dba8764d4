// SPDX-License-Identifier: MIT
//
// A body that members and structures make and end, and how it goes through a step.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <span>
#include <vector>

#include "ductile/member/member_piece.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/divisible.hpp"
#include "ductile/structure/plan_body.hpp"

namespace ductile::ode {

namespace detail {

[[nodiscard]] inline JointFrame<double> frame_of(dBodyID body) {
    return {to_core(dBodyGetPosition(body)), matrix_to_core(dBodyGetRotation(body))};
}
[[nodiscard]] inline BodyMotion motion_of(dBodyID body) {
    return {linear_velocity(body), angular_velocity(body)};
}
[[nodiscard]] inline bool is_solved(dBodyID body) {
    return can_move(body) && dBodyIsEnabled(body) != 0;
}

/// By rows, as ODE stores matrices.
inline void to_ode(const Matrix3<double>& m, dMatrix3 result) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) result[4 * i + j] = dReal(m(i, j));
        result[4 * i + 3] = 0;
    }
}

/// With no force on it.
inline void put(dBodyID body, const JointFrame<double>& pose, const BodyMotion& motion) {
    dMatrix3 turned;
    to_ode(pose.axes, turned);
    const Vector3<double>&at = pose.origin, &v = motion.velocity, &w = motion.spin;
    dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
    dBodySetRotation(body, turned);
    dBodySetLinearVel(body, dReal(v.x()), dReal(v.y()), dReal(v.z()));
    dBodySetAngularVel(body, dReal(w.x()), dReal(w.y()), dReal(w.z()));
    dBodySetForce(body, 0, 0, 0);
    dBodySetTorque(body, 0, 0, 0);
}

/// `inertia`: along the axes of the body [kg m²].
inline void set_mass(dBodyID body, double mass, const Vector3<double>& inertia) {
    dMass all;
    dMassSetParameters(&all, dReal(mass), 0, 0, 0, dReal(inertia[0]), dReal(inertia[1]),
                       dReal(inertia[2]), 0, 0, 0);
    dBodySetMass(body, &all);
}

/// ODE keeps what it has of a geom's place for ever where one with an offset changes its body, 128
/// bytes each time: the offset goes first.
inline void put_on(dGeomID geom, dBodyID body, const JointFrame<double>& in_body) {
    if (dGeomGetBody(geom) != body) {
        if (dGeomGetBody(geom) != nullptr) dGeomClearOffset(geom);
        dGeomSetBody(geom, body);
    }
    const Vector3<double>& at = in_body.origin;
    dGeomSetOffsetPosition(geom, dReal(at.x()), dReal(at.y()), dReal(at.z()));
    dMatrix3 turned;
    to_ode(in_body.axes, turned);
    dGeomSetOffsetRotation(geom, turned);
}

inline void copy_manners(dBodyID from, dBodyID body) {
    dBodySetAutoDisableFlag(body, dBodyGetAutoDisableFlag(from));
    dBodySetAutoDisableLinearThreshold(body, dBodyGetAutoDisableLinearThreshold(from));
    dBodySetAutoDisableAngularThreshold(body, dBodyGetAutoDisableAngularThreshold(from));
    dBodySetAutoDisableSteps(body, dBodyGetAutoDisableSteps(from));
    dBodySetAutoDisableTime(body, dBodyGetAutoDisableTime(from));
    dBodySetAutoDisableAverageSamplesCount(body,
                                           unsigned(dBodyGetAutoDisableAverageSamplesCount(from)));
    dBodySetLinearDamping(body, dBodyGetLinearDamping(from));
    dBodySetLinearDampingThreshold(body, dBodyGetLinearDampingThreshold(from));
    dBodySetAngularDamping(body, dBodyGetAngularDamping(from));
    dBodySetAngularDampingThreshold(body, dBodyGetAngularDampingThreshold(from));
    dBodySetMaxAngularSpeed(body, dBodyGetMaxAngularSpeed(from));
    dBodySetGravityMode(body, dBodyGetGravityMode(from));
    dBodySetGyroscopicMode(body, dBodyGetGyroscopicMode(from));
    dBodySetFiniteRotationMode(body, dBodyGetFiniteRotationMode(from));
    dVector3 axis;
    dBodyGetFiniteRotationAxis(from, axis);
    dBodySetFiniteRotationAxis(body, axis[0], axis[1], axis[2]);
    dBodySetData(body, dBodyGetData(from));
}

/// Of a body of a plan that collides, on none yet; null: of one that does not.
[[nodiscard]] inline dGeomID box_of(const PlanBody& body, dSpaceID space) {
    if (!body.collides || space == nullptr) return nullptr;
    const Vector3<double>& half = body.half_lengths;
    return dCreateBox(space, dReal(2 * half.x()), dReal(2 * half.y()), dReal(2 * half.z()));
}

/// Before ODE damped it, after its solve.
[[nodiscard]] inline Vector3<double> undamped(const Vector3<double>& velocity, double share,
                                              double threshold) {
    const Vector3<double> before = scaled(1 / (1 - share), velocity);
    return share > 0 && share < 1 && norm(before) > threshold ? before : velocity;
}

} // namespace detail

[[nodiscard]] inline Wrench wrench_of(const dJointFeedback& feedback, bool of_a) {
    return of_a ? Wrench{to_core(feedback.f1), to_core(feedback.t1)}
                : Wrench{to_core(feedback.f2), to_core(feedback.t2)};
}
/// What the rows of a plastic joint gave, its angular motor and the rest.
[[nodiscard]] inline Wrench wrench_of(const PlasticConstraint& joint, bool of_a) {
    const OutsideForce& outside = joint.outside_force();
    Wrench wrench = wrench_of(*dJointGetFeedback(joint.id()), of_a);
    wrench.force = sum(wrench.force, scaled(of_a ? 1 : -1, outside.force));
    wrench.torque = sum(wrench.torque, of_a ? outside.torque_a : outside.torque_b);
    return wrench;
}

/// A body through a step.
struct PieceCourse {
    JointFrame<double> pose;  ///< where the step solves it
    BodyMotion motion, after; ///< before the solve, and after it, before ODE damps it
    bool solved = false;

    explicit PieceCourse(dBodyID body)
        : pose(detail::frame_of(body)), solved(detail::is_solved(body)) {
        if (solved) motion = detail::motion_of(body);
    }
    void see(dBodyID body) {
        solved = detail::is_solved(body);
        after = {detail::undamped(linear_velocity(body), double(dBodyGetLinearDamping(body)),
                                  double(dBodyGetLinearDampingThreshold(body))),
                 detail::undamped(angular_velocity(body), double(dBodyGetAngularDamping(body)),
                                  double(dBodyGetAngularDampingThreshold(body)))};
    }
    /// What the step changed of it, what gravity gave it left out; `inertia`: of its rows in
    /// internal_forces.hpp, world axes [kg m²]. The body's own may be the user's, and ODE's
    /// gyroscopic moment is an implicit one. `turned`: time in which it turned [s].
    [[nodiscard]] BodyMotion change(dBodyID body, const Vector3<double>& fallen,
                                    const Matrix3<double>& inertia,
                                    const Matrix3<double>& inverse_inertia, double dt,
                                    double& turned) const {
        BodyMotion result;
        result.velocity = difference(after.velocity, motion.velocity);
        if (dBodyGetGravityMode(body) != 0) result.velocity = difference(result.velocity, fallen);
        dMass mass;
        dBodyGetMass(body, &mass);
        const Matrix3<double> own = sandwiched(pose.axes, matrix_to_core(mass.I));
        Vector3<double> about = times(own, difference(after.spin, motion.spin));
        turned = 0;
        if (dBodyGetGyroscopicMode(body) != 0) {
            turned = dt;
            const Vector3<double> momentum = times(inertia, motion.spin);
            about = difference(about, sum(gyroscopic_impulse(body, own, motion.spin, dt),
                                          scaled(dt, cross(motion.spin, momentum))));
        }
        result.spin = times(inverse_inertia, about);
        return result;
    }
};

/// What bodies that sleep press on what does not move: as when they were last solved.
class PressedTouches {
  public:
    struct Pressed {
        dBodyID body, on;      ///< which sleeps; which it presses
        Vector3<double> point; ///< [m]
        Vector3<double> force; ///< [N]
    };

    /// After each step, with all contacts of what does not move.
    void see(std::span<const Touch> touches) {
        std::erase_if(pressed_, [&](const Pressed& was) {
            const auto touch = std::find_if(touches.begin(), touches.end(), [&](const Touch& each) {
                return other_of(each) == was.body;
            });
            return touch == touches.end() || detail::is_solved(was.body);
        });
        asleep_ = pressed_;
        for (const Touch& touch : touches) {
            if (!detail::is_solved(other_of(touch))) continue;
            pressed_.push_back({other_of(touch), touch.of_a ? touch.bodies.a : touch.bodies.b,
                                touch.point, wrench_of(*touch.feedback, touch.of_a).force});
        }
    }
    /// All press this body, which is now what they pressed.
    void go_to(dBodyID on) noexcept {
        for (auto* all : {&pressed_, &asleep_}) {
            for (Pressed& pressed : *all) pressed.on = on;
        }
    }
    void forget() {
        pressed_.clear();
        asleep_.clear();
    }
    [[nodiscard]] std::span<const Pressed> asleep() const noexcept { return asleep_; }

  private:
    [[nodiscard]] static dBodyID other_of(const Touch& touch) {
        return touch.of_a ? touch.bodies.b : touch.bodies.a;
    }

    std::vector<Pressed> pressed_, asleep_; ///< when it was last solved; of these, what sleeps
};

} // namespace ductile::ode
