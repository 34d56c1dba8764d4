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

#include <array>
#include <span>
#include <vector>

#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/frame/part_row.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class PartRisk {
  public:
    /// What the joint at `place` among the world's constraints did in the part just done.
    void note(int place, const PlasticConstraint& joint, std::span<const PartRow> rows);
    /// Of the joint at `place`, before a part.
    /// `length`: of the longest part that may come [s].
    [[nodiscard]] bool is_at_risk(int place, const PlasticConstraint& joint, btScalar length);

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
    [[nodiscard]] Noted& noted(int place);
    /// True where nobody touched the body since the last part, and it turns slowly.
    [[nodiscard]] static bool is_left_alone(const btRigidBody& body, btScalar length,
                                            Burden& burden);

    std::vector<Noted> noted_; ///< by place
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/part_risk.ipp"
#endif
