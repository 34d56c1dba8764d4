// SPDX-License-Identifier: MIT
//
// The six rows of a link as Bullet's own solvers want them, for a joint in a world that no World
// looks after. A row of compliance C goes to Bullet as
//   C m             where C m <= 1/2: right in sequential impulse, whose error each sweep
//   multiplies
//                   by C m;
//   a given force   otherwise: that of the spring as it is, which a step can resolve that is so
//   short.
// Where that is not right (a chain of stiff rows; btMLCPSolver, which does not read C m) the row
// misses u' + C λ = b, and the joint's certificate says so.
//
// btMLCPSolver also wants bounds that enclose zero: a given force is a row of bounds 0 and f whose
// target velocity is out of reach.
//
// Symbols
//   u'  row velocity after the solve   [m/s | rad/s]
//   λ   impulse of the row             [N s | N m s]
//   C   compliance                     [1/kg | 1/(kg m²)]
//   m   effective mass 1/(J M⁻¹ Jᵀ)    [kg | kg m²]
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "ductile/bullet/convert.hpp"
#include "ductile/joint/any_link.hpp"
#include "ductile/joint/joint_axis.hpp"

namespace ductile::bullet {

/// Jacobian of a moment about `about`, world axes. `at`: where the row's entries begin.
inline void write_moment(btTypedConstraint::btConstraintInfo2& info, int at,
                         const Vector3<double>& about) noexcept {
    for (int i = 0; i < 3; ++i) {
        info.m_J1linearAxis[at + i] = info.m_J2linearAxis[at + i] = 0;
        info.m_J1angularAxis[at + i] = btScalar(about[i]);
        info.m_J2angularAxis[at + i] = btScalar(-about[i]);
    }
}

/// Jacobian of a force along `along` at the joint and a moment about `about`, world axes; `arm_a`,
/// `arm_b`: joint minus centres of mass.
inline void write_jacobian(btTypedConstraint::btConstraintInfo2& info, int at,
                           const Vector3<double>& arm_a, const Vector3<double>& arm_b,
                           const Vector3<double>& along, const Vector3<double>& about) noexcept {
    const Vector3<double> on_a = sum(cross(arm_a, along), about);
    const Vector3<double> on_b = sum(cross(arm_b, along), about);
    for (int i = 0; i < 3; ++i) {
        info.m_J1linearAxis[at + i] = btScalar(along[i]);
        info.m_J1angularAxis[at + i] = btScalar(on_a[i]);
        info.m_J2linearAxis[at + i] = btScalar(-along[i]);
        info.m_J2angularAxis[at + i] = btScalar(-on_b[i]);
    }
}

/// A row that ends with `impulse` [N s | N m s] in any solver.
inline void write_given(btTypedConstraint::btConstraintInfo2& info, int row,
                        double impulse) noexcept {
    constexpr double out_of_reach = 1e6; // [m/s | rad/s]
    const int at = row * info.rowskip;
    info.m_lowerLimit[at] = btScalar(std::min(impulse, 0.0));
    info.m_upperLimit[at] = btScalar(std::max(impulse, 0.0));
    info.m_constraintError[at] = btScalar(std::copysign(out_of_reach, impulse));
    info.cfm[at] = 0;
}

/// Six rows that give `impulse` to A at the point `joint`, and the opposite to B.
inline void write_impulse(btTypedConstraint::btConstraintInfo2& info, const btRigidBody& a,
                          const btRigidBody& b, const Vector3<double>& joint,
                          const JointImpulse<double>& impulse) noexcept {
    const Vector3<double> arm_a = difference(joint, to_core(a.getCenterOfMassPosition()));
    const Vector3<double> arm_b = difference(joint, to_core(b.getCenterOfMassPosition()));
    const Vector3<double> none = Vector3<double>::Zero();
    for (int row = 0; row < 6; ++row) {
        const bool turns = row >= 3;
        Vector3<double> unit = none;
        unit[row % 3] = 1;
        if (turns) {
            write_moment(info, row * info.rowskip, unit);
        } else {
            write_jacobian(info, row * info.rowskip, arm_a, arm_b, unit, none);
        }
        write_given(info, row, (turns ? impulse.angular : impulse.linear)[row % 3]);
    }
}

/// J M⁻¹ Jᵀ of a row alone, as Bullet's solvers see it [1/kg | 1/(kg m²)].
[[nodiscard]] inline double inverse_mass_of(const LinkRow<double>& row, const btRigidBody& a,
                                            const btRigidBody& b,
                                            const Vector3<double>& joint) noexcept {
    double result = 0;
    for (const btRigidBody* body : {&a, &b}) {
        const Vector3<double> arm = difference(joint, to_core(body->getCenterOfMassPosition()));
        const Vector3<double> n = row.turns ? row.direction : cross(arm, row.direction);
        result += dot(n, times(to_core(body->getInvInertiaTensorWorld()), n));
        if (!row.turns) result += double(body->getInvMass());
    }
    return result;
}

/// Impulse of a force over a step, within what Bullet takes for infinite [N s | N m s].
[[nodiscard]] inline btScalar as_impulse(double force, double dt) noexcept {
    return btScalar(std::clamp(force * dt, -double(SIMD_INFINITY), double(SIMD_INFINITY)));
}

/// Bullet's order of rows, by axis: turning ones first, as their combination with the others is the
/// sparsest; those of the joint, `plastic`, last.
[[nodiscard]] inline std::array<std::size_t, 6> rigid_rotations_first(
    std::span<const JointAxis> plastic) {
    std::array<std::size_t, 6> order{};
    std::size_t row = 0;
    for (const bool turning : {true, false}) {
        for (const JointAxis axis : all_joint_axes) {
            const bool is_plastic =
                std::find(plastic.begin(), plastic.end(), axis) != plastic.end();
            if (!is_plastic && turns(axis) == turning) order[row++] = index(axis);
        }
    }
    for (const JointAxis axis : plastic) order[row++] = index(axis);
    return order;
}

/// Bounds, target velocity and compliance of `wanted`, which acts at `joint`, as row `row`. `dt`:
/// for which the force acts [s].
inline void write_limits(btTypedConstraint::btConstraintInfo2& info, int row,
                         const LinkRow<double>& wanted, const btRigidBody& a, const btRigidBody& b,
                         const Vector3<double>& joint, double dt) noexcept {
    constexpr double largest_slack = 0.5; // C m
    const RowLimits<double>& limits = wanted.limits;
    const int at = row * info.rowskip;
    info.m_constraintError[at] = btScalar(limits.bias);
    info.m_lowerLimit[at] = as_impulse(limits.lower, dt);
    info.m_upperLimit[at] = as_impulse(limits.upper, dt);
    info.cfm[at] = 0;
    if (limits.lower == limits.upper) write_given(info, row, limits.lower * dt);
    if (!(limits.compliance > 0)) return;
    const double slack = limits.compliance / inverse_mass_of(wanted, a, b, joint);
    info.cfm[at] = btScalar(slack);
    const double spring = limits.bias / limits.compliance; // λ at u' = 0
    if (slack > largest_slack) {
        write_given(info, row, std::clamp(spring, limits.lower * dt, limits.upper * dt));
    }
}

/// The rows of the link's last `prepare`, that of axis `order[i]` as row i. `dt`: for which the
/// forces act [s].
inline void write_rows(btTypedConstraint::btConstraintInfo2& info, const btRigidBody& a,
                       const btRigidBody& b, const AnyLink<double>& link,
                       const std::array<std::size_t, 6>& order, double dt) noexcept {
    for (int row = 0; row < 6; ++row) {
        const LinkRow<double> wanted = link.row(all_joint_axes[order[std::size_t(row)]]);
        const int at = row * info.rowskip;
        if (wanted.turns) {
            write_moment(info, at, wanted.direction);
        } else {
            write_jacobian(info, at, link.pose().arm_a(), link.pose().arm_b(), wanted.direction,
                           Vector3<double>::Zero());
        }
        write_limits(info, row, wanted, a, b, link.point(), dt);
    }
}

} // namespace ductile::bullet
