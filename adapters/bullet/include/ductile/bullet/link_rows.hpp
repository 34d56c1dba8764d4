// SPDX-License-Identifier: MIT
//
// The six rows of a link as Bullet's solvers want them. A row of compliance C goes to Bullet as
//   C itself        where a solver of soft_solvers.hpp or soft_mlcp_solver.hpp asks;
//   C m             where another solver asks and C m <= 1/2: right in sequential impulse, whose
//                   error each sweep multiplies by C m;
//   a given force   otherwise: that of the pair as if it were alone (isolated_pair.hpp). Exact
//                   where nothing else acts on the two bodies within the step.
// Where that is not right (a chain of stiff rows; btMLCPSolver, which does not read C m) the row
// misses u' + C λ = b, and the joint's certificate says so. Where no row is soft, the rigid ones
// are combined so that they do not push each other (decoupled_rows.hpp).
//
// btMLCPSolver also wants bounds that enclose zero: for solvers other than our own a given force is
// a row of bounds 0 and f whose target velocity is out of reach.
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
#include "ductile/bullet/kept_mass.hpp"
#include "ductile/joint/any_link.hpp"
#include "ductile/joint/decoupled_rows.hpp"
#include "ductile/joint/isolated_pair.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/joint/row_sweep.hpp"

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

/// Bounds, target velocity and compliance of `wanted`, which acts at `joint`, as row `row`.
/// `exact`: the solver honours C. `force_alone()`: of the pair as if it were alone [N | N m]. `dt`:
/// for which the force acts [s].
template <class ForceAlone>
void write_limits(btTypedConstraint::btConstraintInfo2& info, int row,
                  const LinkRow<double>& wanted, const btRigidBody& a, const btRigidBody& b,
                  const Vector3<double>& joint, bool exact, double dt,
                  const ForceAlone& force_alone) noexcept {
    constexpr double largest_slack = 0.5; // C m
    const RowLimits<double>& limits = wanted.limits;
    const int at = row * info.rowskip;
    info.m_constraintError[at] = btScalar(limits.bias);
    info.m_lowerLimit[at] = as_impulse(limits.lower, dt);
    info.m_upperLimit[at] = as_impulse(limits.upper, dt);
    info.cfm[at] = btScalar(limits.compliance);
    if (exact) return;
    if (limits.lower == limits.upper) write_given(info, row, limits.lower * dt);
    if (!(limits.compliance > 0)) return;
    const double slack = limits.compliance / inverse_mass_of(wanted, a, b, joint);
    info.cfm[at] = btScalar(slack);
    if (slack > largest_slack) write_given(info, row, force_alone() * dt);
}

/// True where no row of the link's last `prepare` is soft or given.
[[nodiscard]] inline bool all_hard(const AnyLink<double>& link) noexcept {
    for (const JointAxis axis : link.axes()) {
        const RowLimits<double>& limits = link.limits()[index(axis)];
        if (limits.compliance > 0 || !(limits.lower < limits.upper)) return false;
    }
    return true;
}

/// Hard rows of the link's last `prepare`, combined as `combined` says; that of axis `order[i]` is
/// row i. `dt`: for which its forces act [s].
inline void write_hard_rows(btTypedConstraint::btConstraintInfo2& info, const AnyLink<double>& link,
                            const std::array<std::size_t, 6>& order,
                            const CombinedRows<double>& combined, double dt) noexcept {
    const LinkPose<double>& pose = link.pose();
    const auto& rows = link.limits();
    const Vector3<double> moving(rows[0].bias, rows[1].bias, rows[2].bias);
    const Vector3<double> turning(rows[3].bias, rows[4].bias, rows[5].bias);
    int at = 0;
    for (const CombinedRow<double>& row : combined) {
        const Vector3<double> about = times(pose.moment_axes(), row.moment);
        double target = dot(row.moment, turning);
        if (is_zero(row.force)) {
            write_moment(info, at, about);
        } else {
            const Vector3<double> along = times(pose.axes(), row.force);
            write_jacobian(info, at, pose.arm_a(), pose.arm_b(), along, about);
            target += dot(row.force, moving);
        }
        info.m_constraintError[at] = btScalar(target);
        info.cfm[at] = 0;
        at += info.rowskip;
    }
    // Bullet leaves a row without bounds
    for (int row = 6 - int(link.axes().size()); row < 6; ++row) {
        const RowLimits<double>& limits = rows[order[std::size_t(row)]];
        info.m_lowerLimit[row * info.rowskip] = as_impulse(limits.lower, dt);
        info.m_upperLimit[row * info.rowskip] = as_impulse(limits.upper, dt);
    }
}

/// The rows of the link's last `prepare`, not pushing each other as `decoupled` says, for the
/// constraint to solve by itself (null: all are the joint's); that of axis `order[i]` is row i.
/// `dt`: for which they act [s].
inline void add_rows(RowSweep<double>& sweep, const AnyLink<double>& link,
                     const std::array<std::size_t, 6>& order, const DecoupledLink* decoupled,
                     double dt) noexcept {
    const auto dimension = int(link.axes().size());
    const Matrix3<double>& axes = link.pose().axes();
    const Matrix3<double>& moment_axes = link.pose().moment_axes();
    const auto& rows = link.limits();
    const Vector3<double> moving(rows[0].bias, rows[1].bias, rows[2].bias);
    const Vector3<double> turning(rows[3].bias, rows[4].bias, rows[5].bias);
    const Vector3<double> none = Vector3<double>::Zero();
    for (std::size_t i = 0; i < 6; ++i) {
        RowLimits<double> limits = rows[order[i]];
        limits.lower *= dt;
        limits.upper *= dt;
        if (decoupled == nullptr) {
            const int column_of_axis = int(order[i] % 3);
            order[i] < 3 ? sweep.add(column(axes, column_of_axis), none, limits)
                         : sweep.add(none, column(moment_axes, column_of_axis), limits);
        } else {
            const CombinedRow<double>& row = decoupled->rows()[i];
            limits.bias = dot(row.force, moving) + dot(row.moment, turning);
            // Eigen's own products, in packets: six rows a tick
            sweep.add(axes * row.force, moment_axes * row.moment, limits);
        }
    }
    if (dimension > 1) sweep.join_last(dimension);
}
/// Forces along the axes of the link from the impulses of such rows [N | N m].
[[nodiscard]] inline Vector6<double> forces_of_impulses(const std::array<std::size_t, 6>& order,
                                                        const DecoupledLink* decoupled,
                                                        const RowSweep<double>::Impulses& impulses,
                                                        double dt) noexcept {
    Vector6<double> forces = Vector6<double>::Zero();
    for (std::size_t i = 0; i < 6; ++i) {
        const double force = impulses[Eigen::Index(i)] / dt;
        if (decoupled == nullptr) {
            forces[Eigen::Index(order[i])] = force;
        } else {
            const CombinedRow<double>& row = decoupled->rows()[i];
            for (int k = 0; k < 3; ++k) {
                forces[k] += force * row.force[k];
                forces[3 + k] += force * row.moment[k];
            }
        }
    }
    return forces;
}

/// The rows of the link's last `prepare`, that of axis `order[i]` as row i. `exact`: the solver
/// honours C. `dt`: for which the forces act [s].
inline void write_rows(btTypedConstraint::btConstraintInfo2& info, const btRigidBody& a,
                       const btRigidBody& b, const AnyLink<double>& link,
                       const std::array<std::size_t, 6>& order, bool exact, double dt) noexcept {
    const double tick = 1 / double(info.fps);
    Vector6<double> alone = Vector6<double>::Zero();
    bool solved_alone = false;
    const auto force_alone = [&](std::size_t axis) {
        if (!solved_alone) {
            const Matrix6<double> k = link.pose().inverse_mass(body_state(a), body_state(b));
            alone = forces_of_isolated_pair(
                link.limits(), k, link.velocities(free_state(a, tick), free_state(b, tick)), dt);
            solved_alone = true;
        }
        return alone[Eigen::Index(axis)];
    };
    for (int row = 0; row < 6; ++row) {
        const std::size_t axis = order[std::size_t(row)];
        const LinkRow<double> wanted = link.row(all_joint_axes[axis]);
        const int at = row * info.rowskip;
        if (wanted.turns) {
            write_moment(info, at, wanted.direction);
        } else {
            write_jacobian(info, at, link.pose().arm_a(), link.pose().arm_b(), wanted.direction,
                           Vector3<double>::Zero());
        }
        write_limits(info, row, wanted, a, b, link.point(), exact, dt,
                     [&] { return force_alone(axis); });
    }
}

} // namespace ductile::bullet
