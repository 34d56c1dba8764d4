// SPDX-License-Identifier: MIT
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <cstdio>
#include <ductile/bullet/bullet.hpp>
#include <ductile/bullet/precision_check.hpp>

int main() {
    ductile::bullet::require_matching_precision();
    btRigidBody body(btRigidBody::btRigidBodyConstructionInfo(2, nullptr, nullptr));
    body.setDamping(btScalar(0.5), 0);
    const ductile::Perfect<double> law({.strength = 64});
    std::printf("holds %.1f N m\n", law.value(0) * 2 * double(body.getLinearDamping()));
}
