// SPDX-License-Identifier: MIT
//
// What follows from the masses of a link's two bodies and its rest position, worked out once and
// kept for as long as neither changes: what a joint that holds need not work out in every tick.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btScalar.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "ductile/bullet/convert.hpp"
#include "ductile/joint/decoupled_rows.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/joint/link_types.hpp"

namespace ductile::bullet {

/// K of the link at its rest position (set_inverse_mass_at_rest).
template <class Joint>
[[nodiscard]] Matrix6<double> inverse_mass_at_rest(const Link<Joint>& link,
                                                   const PrincipalMass<double>& a,
                                                   const PrincipalMass<double>& b) noexcept {
    Vector3<double> offset = Vector3<double>::Zero();
    for (const JointAxis axis : link.axes()) {
        if (!turns(axis)) offset[Eigen::Index(index(axis))] = link.plastic_offset(axis);
    }
    return inverse_mass_along_b(link.pose(), link.pose().rest(), offset, a, b);
}

/// The link's mass at rest, where it has no other use for M (Link::takes_mass_at_rest).
class MassAtRest {
  public:
    /// Tells the link before it prepares, unless it knows.
    template <class Joint>
    void tell(Link<Joint>& link, const btRigidBody& body_a, const btRigidBody& body_b) {
        if (!link.takes_mass_at_rest()) return;
        const PrincipalMass<double> a = principal_mass(body_a), b = principal_mass(body_b);
        if (!link.reads_mass() && a_ == a && b_ == b) return;
        a_ = a;
        b_ = b;
        link.set_inverse_mass_at_rest(inverse_mass_at_rest(link, a, b));
    }

  private:
    PrincipalMass<double> a_, b_; ///< known to the link
};

/// The rows of a link as they do not push each other (decoupled_rows.hpp): of the link as it is
/// where it flows, else as it is at rest. Both are functions of what a restored joint has as well.
template <class Joint>
class DecoupledLink {
  public:
    static constexpr int rigid = 6 - Link<Joint>::dimension; ///< rows

    explicit DecoupledLink(const std::array<std::size_t, 6>& order)
        : rows_(single_rows<double>(order)) {}

    /// Of the link as it was prepared.
    void look(const Link<Joint>& link, const std::array<std::size_t, 6>& order,
              const btRigidBody& body_a, const btRigidBody& body_b) {
        const LinkPose<double>& pose = link.pose();
        const PrincipalMass<double> a = principal_mass(body_a), b = principal_mass(body_b);
        const bool flowing = link.joint().state().flowing;
        if (!flowing && !flowing_ && at_ == pose.rest_changes() && a_ == a && b_ == b) return;
        flowing_ = flowing;
        at_ = pose.rest_changes();
        a_ = a;
        b_ = b;
        // a solver drops rows with less than its epsilon
        constexpr double least = 4 * double(SIMD_EPSILON);
        const Matrix6<double> k =
            flowing ? inverse_mass_along_b(pose, pose.orientation(), pose.displacement(), a, b)
                    : inverse_mass_at_rest(link, a, b);
        rows_ = decoupled_rows<rigid>(k, order, least);
    }
    [[nodiscard]] const CombinedRows<double>& rows() const noexcept { return rows_; }

  private:
    CombinedRows<double> rows_;
    PrincipalMass<double> a_, b_;
    unsigned at_ = 0;     ///< LinkPose::rest_changes
    bool flowing_ = true; ///< or never worked out
};

/// Six rows of a joint have none to be combined with.
template <class Joint>
    requires(Link<Joint>::dimension == 6)
class DecoupledLink<Joint> {
  public:
    explicit DecoupledLink(const std::array<std::size_t, 6>&) {}
    void look(const Link<Joint>&, const std::array<std::size_t, 6>&, const btRigidBody&,
              const btRigidBody&) {}
};

} // namespace ductile::bullet
