// SPDX-License-Identifier: MIT
//
// The README's first program in Bullet: a rotor of 2 kg m² and 10 rad/s, a hinge of 64 N m that breaks
// at 1.5 rad; that takes 96 of its 100 J.
#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <ductile/bullet/bullet.hpp>

int main() {
    using namespace ductile;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld engine(&dispatcher, &broadphase, &solver, &configuration);
    btEmptyShape shape;
    btRigidBody rotor(
        btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape, btVector3(2, 2, 2)));
    engine.addRigidBody(&rotor, 0, 0);
    engine.setGravity(btVector3(0, 0, 0));
    rotor.setAngularVelocity(btVector3(0, 0, 10));

    bullet::World stepper(engine);
    bullet::PlasticHinge hinge(rotor, btTransform::getIdentity(),
                               OneAxisJoint(Perfect<double>({.strength = 64}),
                                            TravelLimit<double>({.limit = 1.5})));
    stepper.add(hinge, "hinge");
    for (int i = 0; i < 60 && !hinge.broken(); ++i) stepper.step(1.0 / 60);
    std::printf("took %.1f J over %.2f rad\n", hinge.absorbed_energy(), hinge.plastic_rotation());
}
