// SPDX-License-Identifier: MIT
//
// Bodies of kept_mass.hpp.
#pragma once

#include <LinearMath/btScalar.h>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/kept_mass.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

namespace detail {

/// K of the link at its rest position (set_inverse_mass_at_rest).
DUCTILE_INLINE Matrix6<double> inverse_mass_at_rest(const AnyLink<double>& link,
                                                    const PrincipalMass<double>& a,
                                                    const PrincipalMass<double>& b) noexcept {
    Vector3<double> offset = Vector3<double>::Zero();
    for (const JointAxis axis : link.axes()) {
        if (!turns(axis)) offset[Eigen::Index(index(axis))] = link.plastic_offset(axis);
    }
    return inverse_mass_along_b(link.pose(), link.pose().rest(), offset, a, b);
}

} // namespace detail

DUCTILE_INLINE void MassAtRest::tell(AnyLink<double>& link, const btRigidBody& body_a,
                                     const btRigidBody& body_b) {
    if (!link.takes_mass_at_rest()) return;
    const PrincipalMass<double> a = principal_mass(body_a), b = principal_mass(body_b);
    if (!link.reads_mass() && a_ == a && b_ == b) return;
    a_ = a;
    b_ = b;
    link.set_inverse_mass_at_rest(detail::inverse_mass_at_rest(link, a, b));
}

DUCTILE_INLINE void DecoupledLink::look(const AnyLink<double>& link,
                                        const std::array<std::size_t, 6>& order,
                                        const btRigidBody& body_a, const btRigidBody& body_b) {
    const LinkPose<double>& pose = link.pose();
    const PrincipalMass<double> a = principal_mass(body_a), b = principal_mass(body_b);
    const bool flowing = link.totals().flowing;
    if (!flowing && !flowing_ && at_ == pose.rest_changes() && a_ == a && b_ == b) return;
    flowing_ = flowing;
    at_ = pose.rest_changes();
    a_ = a;
    b_ = b;
    // a solver drops rows with less than its epsilon
    constexpr double least = 4 * double(SIMD_EPSILON);
    const Matrix6<double> k =
        flowing ? inverse_mass_along_b(pose, pose.orientation(), pose.displacement(), a, b)
                : detail::inverse_mass_at_rest(link, a, b);
    rows_ = decoupled_rows(k, order, rigid_, least);
}

} // namespace ductile::bullet
