// SPDX-License-Identifier: MIT
//
// Contacts of bodies with setContactStiffnessAndDamping: springs and dampers
// (frame/soft_contact.hpp), in series and side by side as Bullet takes those of two bodies.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <optional>

#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/frame/soft_contact.hpp"

namespace ductile::bullet {

/// Of a point where the bodies have such a spring and damper, in frames of `frame` [s]; nothing: it
/// is hard.
[[nodiscard]] inline std::optional<SoftContact> soft_contact(
    double stiffness, double damping, const btRigidBody* a, const btRigidBody* b,
    const btVector3& at, const btVector3& normal, double frame) {
    const auto yields = [&](const btRigidBody* body) {
        return detail::moves(body) ? double(body->computeImpulseDenominator(at, normal)) : 0.0;
    };
    const SoftContact soft(stiffness, damping, yields(a), yields(b));
    if (!(stiffness > 0 || damping > 0) || soft.is_hard(frame)) return {};
    return soft;
}

[[nodiscard]] inline bool gives_way(const btManifoldPoint& point) {
    return (point.m_contactPointFlags & BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING) != 0;
}

/// Of a point that Bullet has made.
[[nodiscard]] inline std::optional<SoftContact> soft_contact(const btManifoldPoint& point,
                                                             const btRigidBody* a,
                                                             const btRigidBody* b, double frame) {
    if (!gives_way(point)) return {};
    return soft_contact(double(point.m_combinedContactStiffness1),
                        double(point.m_combinedContactDamping1), a, b, point.getPositionWorldOnB(),
                        point.m_normalWorldOnB, frame);
}

[[nodiscard]] inline bool may_give_way(const btCollisionObject& object) {
    constexpr int gives = btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING;
    return (object.getCollisionFlags() & gives) != 0;
}

/// Of one that it would make.
[[nodiscard]] inline std::optional<SoftContact> soft_contact(const btCollisionObject& a,
                                                             const btCollisionObject& b,
                                                             const btVector3& at,
                                                             const btVector3& normal,
                                                             double frame) {
    if (!may_give_way(a) && !may_give_way(b)) return {};
    const double stiffness =
        1 / (1 / double(a.getContactStiffness()) + 1 / double(b.getContactStiffness()));
    const double damping = double(a.getContactDamping()) + double(b.getContactDamping());
    return soft_contact(stiffness, damping, btRigidBody::upcast(&a), btRigidBody::upcast(&b), at,
                        normal, frame);
}

} // namespace ductile::bullet
