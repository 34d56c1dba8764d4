// SPDX-License-Identifier: MIT
//
// Includes little, as it is built by every way; bullet_hinge.cpp has all of the adapter.
#include <cstdio>
#include <ductile/bullet/precision_check.hpp>
#include <ductile/law/perfect.hpp>

int main() {
    ductile::bullet::require_matching_precision();
    btRigidBody body(btRigidBody::btRigidBodyConstructionInfo(2, nullptr, nullptr));
    body.setDamping(btScalar(0.5), 0);
    const ductile::Perfect<double> law({.strength = 64});
    std::printf("holds %.1f N m\n", law.value(0) * 2 * double(body.getLinearDamping()));
}
