// SPDX-License-Identifier: MIT
//
// Where a method puts a joint into a Bullet world.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>

#include "ductile/bullet/bullet.hpp"
#include "scenes/scene.hpp"

namespace bench {

[[nodiscard]] inline BodyState state_of(const btRigidBody& body) {
    using ductile::bullet::to_core;
    return {to_core(body.getCenterOfMassPosition()),
            to_core(body.getCenterOfMassTransform().getBasis()), to_core(body.getLinearVelocity()),
            to_core(body.getAngularVelocity())};
}

/// Frames have their z along the joint's axis, in the bodies' centre-of-mass frames.
struct BulletSite {
    btDiscreteDynamicsWorld& world;
    ductile::bullet::World* keeper; ///< of frames with a tolerance; null without one
    btRigidBody& a;
    btRigidBody& b; ///< for the ground Bullet's fixed body
    btTransform in_a, in_b;
    JointSpec joint;
    double effective_mass; ///< of the joint's row, bodies free [kg m² | kg]

    [[nodiscard]] bool turns() const { return joint.motion == Motion::turns; }
    /// Stiffness of a spring for this joint: its own, or, as in the seed, the strength per unit of
    /// travel.
    [[nodiscard]] double spring_stiffness() const {
        return std::isfinite(joint.stiffness) ? joint.stiffness : joint.strength;
    }
};

/// A transform at `origin` with z along `axis`.
[[nodiscard]] inline btTransform frame_along(const Vector& origin, const Vector& axis) {
    const btVector3 z = ductile::bullet::to_bullet(axis);
    btVector3 x, y;
    btPlaneSpace1(z, x, y);
    const btMatrix3x3 basis(x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z());
    return btTransform(basis, ductile::bullet::to_bullet(origin));
}

/// Bullet's slider moves along the x of its frames: the same frame with x where z was.
[[nodiscard]] inline btTransform slider_frame(const btTransform& along_z) {
    return along_z * btTransform(btMatrix3x3(0, 1, 0, 0, 0, 1, 1, 0, 0));
}

/// Bullet's slider, held but for its axis.
[[nodiscard]] inline std::unique_ptr<btSliderConstraint> free_slider(btRigidBody& a, btRigidBody& b,
                                                                     const btTransform& in_a,
                                                                     const btTransform& in_b) {
    auto slider =
        std::make_unique<btSliderConstraint>(a, b, slider_frame(in_a), slider_frame(in_b), false);
    slider->setLowerLinLimit(1); // lower > upper: free
    slider->setUpperLinLimit(-1);
    slider->setLowerAngLimit(0);
    slider->setUpperAngLimit(0);
    return slider;
}

} // namespace bench
