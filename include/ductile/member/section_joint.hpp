// SPDX-License-Identifier: MIT
//
// A member's joint from its section, its material and the length of member that it stands for: no
// strength is found by trial.
//
//   section_hinge    bending about one axis                        OneAxisJoint
//   section_joint    all six axes on one ellipsoid                 CoupledJoint
//
// Capacities and stiffnesses are those of joint_capacity. The ellipsoid through the six capacities
// is smooth and holds for bending with torsion; a rectangle under axial force and bending flows
// earlier, at m = 1 - n², where the ellipsoid is up to 2/√3 = 1.155 times too strong. Where that
// matters build the CoupledJoint from the section's own surface (surface/).
//
// Life is counted in plastic rotations, bending by its path about both axes, twist by its own limit;
// in both at once the squares of their shares add up (axis_life.hpp). Stretch and shear use up none.
// The equivalent travel of the joint is D/M_p with the plastic moment about x: bending about x alone it
// is the plastic rotation.
//
// Symbols
//   L    length of member that the joint stands for [m]
//   M_p  plastic moment                             [N m]
//   k    elastic stiffness of the length            [N/m | N m/rad]
#pragma once

#include <concepts>
#include <limits>

#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/material.hpp"
#include "ductile/section/capacity.hpp"
#include "ductile/section/section.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct SectionJointParameters {
    S length = std::numeric_limits<S>::quiet_NaN(); ///< L [m], > 0
    /// Plastic rotation by bending alone at which it breaks [rad], > 0; infinity: never.
    S largest_bending = std::numeric_limits<S>::infinity();
    /// Plastic rotation by twist alone at which it breaks [rad], > 0; infinity: never.
    S largest_twist = std::numeric_limits<S>::infinity();
    /// True: elastic with the stiffness of the length below yield; false: rigid.
    bool elastic = false;
    /// τ of an elastic joint [s], >= 0: a damper of k τ beside each spring. Of shear and axial
    /// force, so that waves along members end that no part of a frame resolves; of bending and
    /// twist less than steel itself loses: a loss factor ω τ of 6e-5 in a structure that swings at
    /// 20 rad/s.
    S wave_damping = S(1e-4), bending_damping = S(3e-6);
    ShearYield shear_yield = ShearYield::von_mises;
};

template <std::floating_point S>
using SectionJoint = CoupledJoint<Ellipsoid<S, 6>, Perfect<S>, TravelLimit<S>>;

/// Rows in the order of JointAxis.
/// @throws std::invalid_argument where a parameter is out of range.
template <FullSection T>
[[nodiscard]] SectionJoint<typename T::Scalar> section_joint(
    const T& section, const Material<typename T::Scalar>& material,
    const SectionJointParameters<typename T::Scalar>& parameters) {
    using S = typename T::Scalar;
    const JointCapacity<S> of = joint_capacity(
        section, material, {.length = parameters.length, .shear_yield = parameters.shear_yield});
    CoupledParameters<S, 6> rows;
    Eigen::Matrix<S, 6, 1> capacity;
    for (int i = 0; i < 6; ++i) {
        capacity[i] = of.capacity[std::size_t(i)];
        rows.section_stiffness[i] = of.stiffness[std::size_t(i)];
        if (parameters.elastic) rows.stiffness[i] = of.stiffness[std::size_t(i)];
    }
    rows.damping_time.template head<3>().setConstant(
        check::non_negative("SectionJoint.wave_damping", parameters.wave_damping, "s"));
    rows.damping_time.template tail<3>().setConstant(
        check::non_negative("SectionJoint.bending_damping", parameters.bending_damping, "s"));
    const S bending = check::positive_or_infinite("SectionJoint.largest_bending",
                                                  parameters.largest_bending, "rad");
    const S twist =
        check::positive_or_infinite("SectionJoint.largest_twist", parameters.largest_twist, "rad");
    rows.largest_travel.template tail<3>() << bending, bending, twist;
    return SectionJoint<S>(Ellipsoid<S, 6>({.capacity = capacity}),
                           Perfect<S>({.strength = plastic_moment(section, material)}),
                           TravelLimit<S>(), rows);
}

/// Bending about `axis` of the section.
/// @throws std::invalid_argument where a parameter is out of range, or there is a limit for twist,
/// which a hinge does not do; one that is rigid below yield needs no length.
template <BiaxialSection T>
[[nodiscard]] OneAxisJoint<Perfect<typename T::Scalar>> section_hinge(
    const T& section, const Material<typename T::Scalar>& material,
    const SectionJointParameters<typename T::Scalar>& parameters = {},
    SectionAxis axis = SectionAxis::x) {
    using S = typename T::Scalar;
    OneAxisParameters<S> row;
    if (parameters.largest_twist != std::numeric_limits<S>::infinity()) {
        check::fail("SectionHinge.largest_twist", parameters.largest_twist, "rad",
                    "infinite: a hinge bends about one axis only");
    }
    if (parameters.elastic) {
        const S length = check::positive("SectionHinge.length", parameters.length, "m");
        row.stiffness = material.youngs_modulus() * section.second_moment(axis) / length;
    }
    return OneAxisJoint(Perfect<S>({.strength = plastic_moment(section, material, axis)}),
                        TravelLimit<S>({.limit = parameters.largest_bending}), row);
}

} // namespace ductile
