// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: what a part asks of each body by itself. A part of world_parts.ipp.
#pragma once

#include "ductile/joint/gyroscopic.hpp"

namespace ductile::bullet {

namespace detail {

[[nodiscard]] DUCTILE_INLINE double kinetic_energy(const btRigidBody& body) {
    if (!(body.getInvMass() > 0) || body.isStaticOrKinematicObject()) return 0;
    const btVector3 spin = body.getAngularVelocity() * body.getCenterOfMassTransform().getBasis();
    double sum = double(body.getLinearVelocity().length2()) / (2 * double(body.getInvMass()));
    for (int k = 0; k < 3; ++k) {
        const btScalar inverse = body.getInvInertiaDiagLocal()[k];
        if (inverse > 0) sum += double(spin[k] * spin[k]) / (2 * double(inverse));
    }
    return sum;
}

} // namespace detail

/// Members reckon with Bullet's own rule.
DUCTILE_INLINE void WorldParts::keep_spins(double h) {
    if (!members_->empty()) return;
    for (btRigidBody* body : bodies_of(world_, scope())) {
        if (body->isStaticOrKinematicObject() || !body->isActive()) continue;
        Vector3<double> spin = to_core(body->getAngularVelocity());
        if (!turns_far(spin, h)) continue;
        spin = scaled(std::pow(1 - double(body->getAngularDamping()), h), spin);
        const Matrix3<double> about = sandwiched(
            to_core(body->getCenterOfMassTransform().getBasis()), to_core(body->getLocalInertia()));
        if (!wobbles(about, spin)) continue;
        const Vector3<double> rest =
            gyroscopic_rest(gyroscopic_impulse(*body, about, spin, h), about, spin, h);
        if (is_zero(rest)) continue;
        body->applyTorque(unweighted(to_bullet(scaled(1 / h, rest)), body->getAngularFactor()));
        meter_.add_gyroscopic(body, rest);
    }
}

DUCTILE_INLINE double WorldParts::kinetic_energy() const {
    double sum = 0;
    for (const btRigidBody* body : bodies_of(world_, scope())) {
        sum += detail::kinetic_energy(*body);
    }
    return sum;
}

/// Of one plastic joint its bodies' momentum x the last digit of their position / h; what one gives
/// another takes.
DUCTILE_INLINE double WorldParts::rounding(double h) const {
    double sum = 0; // of squares
    for (const btTypedConstraint* joint : constraints_of(world_, scope())) {
        if (joint->getConstraintType() != plastic_constraint_type || !joint->isEnabled()) continue;
        for (const btRigidBody* body : {&joint->getRigidBodyA(), &joint->getRigidBodyB()}) {
            if (!(body->getInvMass() > 0)) continue;
            const double square = double(body->getCenterOfMassPosition().length2());
            const double jump = double(SIMD_EPSILON) * double(SIMD_EPSILON) * square / (h * h);
            sum += 2 * detail::kinetic_energy(*body) / double(body->getInvMass()) * jump;
        }
    }
    return std::sqrt(sum);
}

} // namespace ductile::bullet
