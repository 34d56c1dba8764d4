// SPDX-License-Identifier: MIT
//
// What follows from the masses of a link's two bodies and its rest position, worked out once and
// kept for as long as neither changes: what a joint that holds need not work out in every tick.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <array>
#include <cstddef>

#include "ductile/joint/any_link.hpp"
#include "ductile/joint/decoupled_rows.hpp"

namespace ductile::bullet {

/// The link's mass at rest, where it has no other use for M (Link::takes_mass_at_rest).
class MassAtRest {
  public:
    /// Tells the link before it prepares, unless it knows.
    void tell(AnyLink<double>& link, const btRigidBody& body_a, const btRigidBody& body_b);

  private:
    PrincipalMass<double> a_, b_; ///< known to the link
};

/// The rows of a link as they do not push each other (decoupled_rows.hpp): of the link as it is
/// where it flows, else as it is at rest. Both are functions of what a restored joint has as well.
class DecoupledLink {
  public:
    /// `plastic`: how many rows are not rigid.
    DecoupledLink(const std::array<std::size_t, 6>& order, int plastic)
        : rows_(single_rows<double>(order)), rigid_(6 - plastic) {}

    /// Of the link as it was prepared.
    void look(const AnyLink<double>& link, const std::array<std::size_t, 6>& order,
              const btRigidBody& body_a, const btRigidBody& body_b);
    [[nodiscard]] const CombinedRows<double>& rows() const noexcept { return rows_; }

  private:
    CombinedRows<double> rows_;
    PrincipalMass<double> a_, b_;
    unsigned at_ = 0;     ///< LinkPose::rest_changes
    int rigid_;           ///< rows
    bool flowing_ = true; ///< or never worked out
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/kept_mass.ipp"
#endif
