// SPDX-License-Identifier: MIT
//
// ODE's vectors and bodies in the words of the core. A null dBodyID is the static world.
#pragma once

#include <ode/ode.h>

#include <array>
#include <functional>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile::ode {

[[nodiscard]] inline Vector3<double> to_core(const dReal* v) noexcept {
    return {double(v[0]), double(v[1]), double(v[2])};
}

/// The two directions that ODE takes across a unit vector.
[[nodiscard]] inline std::array<Vector3<double>, 2> plane_across(const Vector3<double>& normal) {
    const dVector3 n{dReal(normal.x()), dReal(normal.y()), dReal(normal.z())};
    dVector3 first, second;
    dPlaneSpace(n, first, second);
    return {to_core(first), to_core(second)};
}

/// What ODE tells of a joint by a call like dJointGetHingeAxis.
[[nodiscard]] inline Vector3<double> told(dJointID joint, void (*what)(dJointID, dVector3)) {
    dVector3 result;
    what(joint, result);
    return to_core(result);
}
/// [m/s²]
[[nodiscard]] inline Vector3<double> gravity_of(dWorldID world) {
    dVector3 result;
    dWorldGetGravity(world, result);
    return to_core(result);
}

/// ODE stores 3×3 matrices by rows of four.
[[nodiscard]] inline Matrix3<double> matrix_to_core(const dReal* m) noexcept {
    Matrix3<double> result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            result(row, column) = double(m[4 * row + column]);
    }
    return result;
}

[[nodiscard]] inline double mass(dBodyID body) noexcept {
    dMass result;
    dBodyGetMass(body, &result);
    return double(result.mass);
}

/// Inertia about the centre of mass, world axes [kg m²].
[[nodiscard]] inline Matrix3<double> inertia(dBodyID body) noexcept {
    dMass m;
    dBodyGetMass(body, &m);
    return sandwiched(matrix_to_core(dBodyGetRotation(body)), matrix_to_core(m.I));
}

[[nodiscard]] inline Vector3<double> linear_velocity(dBodyID body) noexcept {
    return body != nullptr ? to_core(dBodyGetLinearVel(body)) : Vector3<double>(0, 0, 0);
}
[[nodiscard]] inline Vector3<double> angular_velocity(dBodyID body) noexcept {
    return body != nullptr ? to_core(dBodyGetAngularVel(body)) : Vector3<double>(0, 0, 0);
}

/// Of a world point from the centre of mass; zero of the static world, null.
[[nodiscard]] inline Vector3<double> arm_of(dBodyID body, const Vector3<double>& point) noexcept {
    return body != nullptr ? difference(point, to_core(dBodyGetPosition(body)))
                           : Vector3<double>(0, 0, 0);
}
[[nodiscard]] inline Vector3<double> velocity_at(dBodyID body,
                                                 const Vector3<double>& point) noexcept {
    if (body == nullptr) return Vector3<double>(0, 0, 0);
    return sum(linear_velocity(body), cross(angular_velocity(body), arm_of(body, point)));
}

/// Null: the static world.
[[nodiscard]] inline ContactBody contact_body(dBodyID body) noexcept {
    return body == nullptr ? ContactBody{}
                           : ContactBody{linear_velocity(body), angular_velocity(body)};
}

/// The body as a joint at `point` (world) sees it; the static world and kinematic bodies cannot
/// move.
[[nodiscard]] inline BodyAtJoint<double> at_joint(dBodyID body,
                                                  const Vector3<double>& point) noexcept {
    if (body == nullptr || dBodyIsKinematic(body)) return {};
    return {.inverse_mass = 1 / mass(body),
            .inverse_inertia = numeric::inverse(inertia(body)),
            .arm = difference(point, to_core(dBodyGetPosition(body)))};
}

/// The two bodies of a joint in the order in which ODE's rows and feedback know them: a joint made
/// between the static world and a body (null first) is turned round inside ODE.
struct AttachedBodies {
    dBodyID a = nullptr;
    dBodyID b = nullptr;   ///< null: the static world
    bool reversed = false; ///< the user attached the world first

    bool operator==(const AttachedBodies&) const = default;
    /// The same two, whichever is the first.
    [[nodiscard]] bool are_of(const AttachedBodies& other) const noexcept {
        return (a == other.a && b == other.b) || (a == other.b && b == other.a);
    }
    bool operator<(const AttachedBodies& other) const noexcept {
        const std::less<dBodyID> less;
        return a != other.a ? less(a, other.a) : less(b, other.b);
    }
};

[[nodiscard]] inline AttachedBodies attached_bodies(dJointID joint) noexcept {
    const dBodyID first = dJointGetBody(joint, 0);
    const dBodyID second = dJointGetBody(joint, 1);
    if (first == nullptr && second != nullptr) return {second, nullptr, true};
    return {first, second, false};
}

[[nodiscard]] inline bool can_move(dBodyID body) noexcept {
    return body != nullptr && dBodyIsKinematic(body) == 0;
}

/// So slow that ODE would put it to sleep.
[[nodiscard]] inline bool is_idle(dBodyID body) {
    return dBodyGetAutoDisableFlag(body) != 0 &&
           dBodyGetAutoDisableAverageSamplesCount(body) != 0 &&
           norm(linear_velocity(body)) <= double(dBodyGetAutoDisableLinearThreshold(body)) &&
           norm(angular_velocity(body)) <= double(dBodyGetAutoDisableAngularThreshold(body));
}

/// Both its bodies: ODE wakes what is attached to what is awake, but not for longer than a step.
inline void wake(dJointID joint) noexcept {
    const AttachedBodies bodies = attached_bodies(joint);
    for (dBodyID body : {bodies.a, bodies.b}) {
        if (can_move(body)) dBodyEnable(body);
    }
}

/// Place and velocities of a body as a link sees it, without its mass; null: the static world.
[[nodiscard]] inline BodyState<double> body_motion(dBodyID body) noexcept {
    if (body == nullptr) return {};
    return {.position = to_core(dBodyGetPosition(body)),
            .orientation = matrix_to_core(dBodyGetRotation(body)),
            .velocity = linear_velocity(body),
            .spin = angular_velocity(body)};
}

/// A body that can move, with its mass; `own`: its inertia, in its axes.
inline void add_mass(BodyState<double>& body, const dMass& m, const Matrix3<double>& own) noexcept {
    body.inverse_mass = 1 / double(m.mass);
    body.inverse_inertia = sandwiched(body.orientation, numeric::inverse(own));
}

/// The body as a link sees it. A kinematic body moves but cannot be moved.
[[nodiscard]] inline BodyState<double> body_state(dBodyID body) noexcept {
    BodyState<double> result = body_motion(body);
    if (!can_move(body)) return result;
    dMass m;
    dBodyGetMass(body, &m);
    add_mass(result, m, matrix_to_core(m.I));
    return result;
}

/// What ODE's gyroscopic torque changes of the angular momentum in a step, by its implicit rule
/// (Lacoursière 2006): (I (I - dt [L]ₓ)⁻¹ - 1) L with L = I ω.
[[nodiscard]] inline Vector3<double> gyroscopic_impulse(dBodyID body,
                                                        const Matrix3<double>& inertia,
                                                        const Vector3<double>& spin,
                                                        double dt) noexcept {
    if (dBodyGetGyroscopicMode(body) == 0) return Vector3<double>::Zero();
    const Vector3<double> momentum = times(inertia, spin);
    const Matrix3<double> tilde = difference(inertia, scaled(dt, skew(momentum)));
    return difference(times(inertia, numeric::Lu<double, 3>(tilde).solve(momentum)), momentum);
}

/// A body that can move, with the velocities that ODE's step of `dt` [s] gives it where no row
/// acts.
[[nodiscard]] inline BodyState<double> free_state(dBodyID body, double dt) noexcept {
    BodyState<double> result = body_motion(body);
    dMass m;
    dBodyGetMass(body, &m);
    const Matrix3<double> own = matrix_to_core(m.I);
    add_mass(result, m, own);
    Vector3<double> acceleration = scaled(result.inverse_mass, to_core(dBodyGetForce(body)));
    if (dBodyGetGravityMode(body) != 0) {
        acceleration = sum(acceleration, gravity_of(dBodyGetWorld(body)));
    }
    const Vector3<double> turn =
        sum(scaled(dt, to_core(dBodyGetTorque(body))),
            gyroscopic_impulse(body, sandwiched(result.orientation, own), result.spin, dt));
    result.velocity = sum(result.velocity, scaled(dt, acceleration));
    result.spin = sum(result.spin, times(result.inverse_inertia, turn));
    return result;
}

/// For the coming step; the torque about the centre of mass, world axes.
inline void add_force(dBodyID body, const Vector3<double>& force, const Vector3<double>& torque) {
    dBodyAddForce(body, dReal(force.x()), dReal(force.y()), dReal(force.z()));
    dBodyAddTorque(body, dReal(torque.x()), dReal(torque.y()), dReal(torque.z()));
}

/// The same of what a joint does to its bodies, which its feedback says.
inline void push(dJointID joint, const Vector3<double>& force, const Vector3<double>& torque_a,
                 const Vector3<double>& torque_b) {
    const AttachedBodies bodies = attached_bodies(joint);
    add_force(bodies.a, force, torque_a);
    if (bodies.b != nullptr) add_force(bodies.b, scaled(-1, force), torque_b);
    dJointFeedback* feedback = dJointGetFeedback(joint);
    if (feedback == nullptr) return;
    for (int i = 0; i < 3; ++i) {
        feedback->f1[i] = dReal(force[i]);
        feedback->t1[i] = dReal(torque_a[i]);
        feedback->f2[i] = dReal(bodies.b != nullptr ? -force[i] : 0);
        feedback->t2[i] = dReal(bodies.b != nullptr ? torque_b[i] : 0);
    }
}

inline void apply(dBodyID body, const VelocityChange<double>& change) noexcept {
    const Vector3<double> v = sum(linear_velocity(body), change.linear);
    const Vector3<double> w = sum(angular_velocity(body), change.angular);
    dBodySetLinearVel(body, dReal(v.x()), dReal(v.y()), dReal(v.z()));
    dBodySetAngularVel(body, dReal(w.x()), dReal(w.y()), dReal(w.z()));
}

} // namespace ductile::ode
