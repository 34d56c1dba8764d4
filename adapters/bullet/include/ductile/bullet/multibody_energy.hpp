// SPDX-License-Identifier: MIT
//
// Kinetic energy of a btMultiBody, which Bullet 3.24 does not offer. A joint's work is booked by
// the core as impulse × (u + u')/2, which is exactly the change of kinetic energy at the place
// where the tick began; that the mass matrix changes as the links move is left over, first order in
// the step, and nothing for links that turn about a common axis.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <cstddef>
#include <vector>

#include <LinearMath/btVector3.h>

namespace ductile::bullet {

/// Of the base, unless it is fixed, and of all links [J].
[[nodiscard]] inline double kinetic_energy(const btMultiBody& body) {
    const auto links = std::size_t(body.getNumLinks());
    std::vector<btVector3> spin(links + 1), velocity(links + 1); // in each link's own axes
    body.compTreeLinkVelocities(spin.data(), velocity.data());
    const auto energy = [&](std::size_t i, btScalar mass, const btVector3& inertia) {
        const btVector3 v = velocity[i], w = spin[i];
        double twice = 0;
        for (int k = 0; k < 3; ++k) {
            twice += double(mass) * double(v[k]) * double(v[k]);
            twice += double(inertia[k]) * double(w[k]) * double(w[k]);
        }
        return twice / 2;
    };
    double sum = body.hasFixedBase() ? 0 : energy(0, body.getBaseMass(), body.getBaseInertia());
    for (std::size_t i = 0; i < links; ++i) {
        sum += energy(i + 1, body.getLinkMass(int(i)), body.getLinkInertia(int(i)));
    }
    return sum;
}

} // namespace ductile::bullet
