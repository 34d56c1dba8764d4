// SPDX-License-Identifier: MIT
//
// Bodies of attachment.hpp.
#pragma once

#include <stdexcept>

#include "ductile/bullet/attachment.hpp"
#include "ductile/bullet/convert.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void Attachment::make(const std::string& field, btDiscreteDynamicsWorld& world,
                                     btRigidBody& on, const btTransform& place) {
    if (constraint != nullptr) return;
    std::unique_ptr<btTypedConstraint> made = maker ? maker(on, place) : nullptr;
    if (made == nullptr) throw std::invalid_argument(field + ".maker: must make a constraint");
    if (&made->getRigidBodyA() != &on && &made->getRigidBodyB() != &on) {
        throw std::invalid_argument(field +
                                    ".maker: must make a constraint of the body that it is given");
    }
    constraint = std::move(made);
    body = &on;
    told = btJointFeedback(); // was of another body
    constraint->setJointFeedback(feedback.get());
    if (off) constraint->setEnabled(false);
    world.addConstraint(constraint.get(), true);
}
DUCTILE_INLINE void Attachment::drop(btDiscreteDynamicsWorld& world) {
    if (constraint == nullptr) return;
    off = !acts();
    world.removeConstraint(constraint.get());
    constraint.reset();
    body = nullptr;
}

DUCTILE_INLINE btRigidBody& Attachment::other() const {
    return is_first() ? constraint->getRigidBodyB() : constraint->getRigidBodyA();
}
DUCTILE_INLINE bool Attachment::is_solved() const {
    const auto moves = [](const btRigidBody& of) {
        return of.isActive() && !of.isStaticOrKinematicObject();
    };
    return acts() && (moves(*body) || moves(other()));
}
DUCTILE_INLINE bool Attachment::switch_on(bool on) const {
    if (!acts() || other().isStaticOrKinematicObject()) return false;
    constraint->setEnabled(on);
    return true;
}
DUCTILE_INLINE void Attachment::see_coming() {
    before = {contact_body(*body), contact_body(other())};
}
DUCTILE_INLINE bool Attachment::see() {
    if (!is_solved()) return false;
    told = *feedback;
    return true;
}
DUCTILE_INLINE const btVector3& Attachment::force() const {
    return is_first() ? told.m_appliedForceBodyA : told.m_appliedForceBodyB;
}
DUCTILE_INLINE const btVector3& Attachment::torque() const {
    return is_first() ? told.m_appliedTorqueBodyA : told.m_appliedTorqueBodyB;
}
DUCTILE_INLINE Wrench Attachment::given() const { return {to_core(force()), to_core(torque())}; }
DUCTILE_INLINE JointSide Attachment::side(bool own, const Vector3<double>& place, double dt) const {
    const btRigidBody& of = own ? *body : other();
    const bool a = own == is_first();
    return {
        .before = before[own ? 0 : 1],
        .after = contact_body(of),
        .arm = to_core(to_bullet(place) - of.getCenterOfMassPosition()),
        .impulse = scaled(dt, to_core(a ? told.m_appliedForceBodyA : told.m_appliedForceBodyB)),
        .moment = scaled(dt, to_core(a ? told.m_appliedTorqueBodyA : told.m_appliedTorqueBodyB))};
}

} // namespace ductile::bullet
