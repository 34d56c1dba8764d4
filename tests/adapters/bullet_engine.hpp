// SPDX-License-Identifier: MIT
//
// Bullet's default world with its default solver and what a test puts into it.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

namespace ductile::test {

/// It outlives the joints, members and World of the rig that derives from it.
struct BulletEngine {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld engine{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;

    explicit BulletEngine(const btVector3& gravity) { engine.setGravity(gravity); }
    ~BulletEngine() {
        for (auto& body : bodies) engine.removeRigidBody(body.get());
    }
    BulletEngine(const BulletEngine&) = delete;
    BulletEngine& operator=(const BulletEngine&) = delete;
};

/// A body that no member or structure made, as it was.
struct KeptBody {
    btRigidBody* body;
    btTransform pose;
    btVector3 velocity, spin;

    explicit KeptBody(btRigidBody* of)
        : body(of),
          pose(of->getCenterOfMassTransform()),
          velocity(of->getLinearVelocity()),
          spin(of->getAngularVelocity()) {}
    void put_back() const {
        body->setCenterOfMassTransform(pose);
        body->setInterpolationWorldTransform(pose);
        body->setLinearVelocity(velocity);
        body->setAngularVelocity(spin);
        body->setInterpolationLinearVelocity(velocity);
        body->setInterpolationAngularVelocity(spin);
    }
};

} // namespace ductile::test
