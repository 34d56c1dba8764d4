// SPDX-License-Identifier: MIT
//
// Whether the coming part of a frame may have to be put back, told before it, so that a world in
// which nothing happens saves nothing. It may where a plastic joint that is awake
//
//   flowed, moved, or used more than half of its strength in the last part, or took no part in it
//   has a body that somebody gave another velocity, weight or mass since
//   has a body that turns by more than 0.05 rad in the frame, as links ask more of bars that spin
//   is in an island with a constraint that is no plastic joint, which may be a motor
//
// or where forces were applied that are not those of the last frame. Gaps that close, kinematic
// bodies and the user's callbacks and actions are for world_parts.hpp to ask for.
//
// Not told: loads that grow to more than double within one part by anything else. Such a part
// stands, and the frame's report says what it misplaced.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/frame/part_row.hpp"

namespace ductile::bullet {

class PartRisk {
  public:
    /// What the joint at `place` among the world's constraints did in the part just done.
    void note(int place, const PlasticConstraint& joint, std::span<const PartRow> rows) {
        Noted& of = noted(place);
        of.joint = &joint;
        of.calm =
            std::all_of(rows.begin(), rows.end(), [](const PartRow& row) { return row.is_calm(); });
    }
    /// Of the joint at `place`, before a part.
    /// `length`: of the longest part that may come [s].
    [[nodiscard]] bool is_at_risk(int place, const PlasticConstraint& joint, btScalar length) {
        Noted& of = noted(place);
        // Both are asked always: each notes what its body bears.
        const bool alone_a = is_left_alone(joint.getRigidBodyA(), length, of.burdens[0]);
        const bool alone_b = is_left_alone(joint.getRigidBodyB(), length, of.burdens[1]);
        if (!joint.is_awake_member()) return false;
        return of.joint != &joint || !of.calm || !alone_a || !alone_b;
    }

  private:
    /// What a body bears by itself.
    struct Burden {
        btVector3 gravity{0, 0, 0};
        btScalar inverse_mass = 0;
    };
    struct Noted {
        const PlasticConstraint* joint = nullptr;
        bool calm = false;
        std::array<Burden, 2> burdens;
    };
    [[nodiscard]] Noted& noted(int place) {
        if (noted_.size() <= std::size_t(place)) noted_.resize(std::size_t(place) + 1);
        return noted_[std::size_t(place)];
    }
    /// True where nobody touched the body since the last part, and it turns slowly.
    [[nodiscard]] static bool is_left_alone(const btRigidBody& body, btScalar length,
                                            Burden& burden) {
        constexpr btScalar slow = btScalar(0.05); // [rad]
        if (body.isStaticOrKinematicObject()) return true;
        const bool same =
            burden.gravity == body.getGravity() && burden.inverse_mass == body.getInvMass();
        burden = {body.getGravity(), body.getInvMass()};
        // Bullet keeps what a tick left it
        const bool turns = body.getAngularVelocity().length2() * length * length > slow * slow;
        return same && !turns &&
               body.getLinearVelocity() == body.getInterpolationLinearVelocity() &&
               body.getAngularVelocity() == body.getInterpolationAngularVelocity();
    }

    std::vector<Noted> noted_; ///< by place
};

} // namespace ductile::bullet
