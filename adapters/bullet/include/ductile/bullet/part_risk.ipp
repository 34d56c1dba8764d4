// SPDX-License-Identifier: MIT
//
// Bodies of part_risk.hpp.
#pragma once

#include <algorithm>
#include <cstddef>

#include "ductile/bullet/part_risk.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void PartRisk::note(int place, const PlasticConstraint& joint,
                                   std::span<const PartRow> rows) {
    constexpr double near = 0.5; // of the strength
    Noted& of = noted(place);
    of.joint = &joint;
    of.calm = std::all_of(rows.begin(), rows.end(), [](const PartRow& row) {
        return row.strength > 0 && row.share <= near && !row.moves();
    });
}

DUCTILE_INLINE bool PartRisk::is_at_risk(int place, const PlasticConstraint& joint,
                                         btScalar length) {
    Noted& of = noted(place);
    // Both are asked always: each notes what its body bears.
    const bool alone_a = is_left_alone(joint.getRigidBodyA(), length, of.burdens[0]);
    const bool alone_b = is_left_alone(joint.getRigidBodyB(), length, of.burdens[1]);
    if (!joint.is_awake_member()) return false;
    return of.joint != &joint || !of.calm || !alone_a || !alone_b;
}

DUCTILE_INLINE auto PartRisk::noted(int place) -> Noted& {
    if (noted_.size() <= std::size_t(place)) noted_.resize(std::size_t(place) + 1);
    return noted_[std::size_t(place)];
}

DUCTILE_INLINE bool PartRisk::is_left_alone(const btRigidBody& body, btScalar length,
                                            Burden& burden) {
    constexpr btScalar slow = btScalar(0.05); // [rad]
    if (body.isStaticOrKinematicObject()) return true;
    const bool same =
        burden.gravity == body.getGravity() && burden.inverse_mass == body.getInvMass();
    burden = {body.getGravity(), body.getInvMass()};
    // Bullet keeps what a tick left it
    const bool turns = body.getAngularVelocity().length2() * length * length > slow * slow;
    return same && !turns && body.getLinearVelocity() == body.getInterpolationLinearVelocity() &&
           body.getAngularVelocity() == body.getInterpolationAngularVelocity();
}

} // namespace ductile::bullet
