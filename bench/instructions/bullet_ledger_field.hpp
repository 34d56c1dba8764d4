// SPDX-License-Identifier: MIT
//
// The field of bullet_field.hpp with hinges that a ductile World looks after and keeps the ledger
// of.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <optional>
#include <vector>

#include "cost/field.hpp"
#include "ductile/bullet/bullet.hpp"

namespace bench::cost {

class LedgerField {
    using Hinge = ductile::bullet::PlasticHinge<>;

  public:
    explicit LedgerField(const FieldSettings& settings) {
        engine_->setGravity(btVector3(0, 0, 0));
        const int bodies = settings.chain ? settings.count + 1 : 2 * settings.count;
        for (int i = 0; i < bodies; ++i) add_body(settings, i);
        for (int i = 0; i < settings.count; ++i) add_hinge(settings, i);
    }
    ~LedgerField() {
        for (const auto& hinge : hinges_) world_->remove(*hinge);
        world_.reset();
        engine_.reset(); // looks for all that is taken out of it one by one
    }
    LedgerField(const LedgerField&) = delete;
    LedgerField& operator=(const LedgerField&) = delete;

    void step() { world_->step(dt); }

  private:
    void add_body(const FieldSettings& settings, int i) {
        const btScalar inertia{body_inertia};
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(body_mass), nullptr, &shape_,
                                                      btVector3(inertia, inertia, inertia));
        const int side = i % 2 == 0 ? -1 : 1, row = 300, pair = i / 2; // pairs in a square field
        const btVector3 at =
            settings.chain ? btVector3(btScalar(2 * half_length * i), 0, 0)
                           : btVector3(btScalar(pair_distance * (pair % row) + side * half_length),
                                       btScalar(pair_distance * (pair / row)), 0);
        info.m_startWorldTransform.setOrigin(at);
        btRigidBody& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        engine_->addRigidBody(&body, 0, 0);
        if (settings.chain) return;
        body.setAngularVelocity(btVector3(0, 0, btScalar(side * pair_spin)));
        body.setLinearVelocity(btVector3(0, btScalar(pair_spin * half_length), 0));
    }

    void add_hinge(const FieldSettings& settings, int i) {
        const std::size_t first = std::size_t(settings.chain ? i : 2 * i);
        btTransform in_a, in_b;
        in_a.setIdentity();
        in_b.setIdentity();
        in_a.setOrigin(btVector3(btScalar(half_length), 0, 0));
        in_b.setOrigin(btVector3(btScalar(-half_length), 0, 0));
        hinges_.push_back(std::make_unique<Hinge>(
            *bodies_[first], *bodies_[first + 1], in_a, in_b,
            ductile::OneAxisJoint<ductile::Perfect<double>>(
                ductile::Perfect<double>({.strength = settings.strength(i)}))));
        world_->add(*hinges_.back());
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    std::optional<btDiscreteDynamicsWorld> engine_{std::in_place, &dispatcher_, &broadphase_,
                                                   &solver_, &configuration_};
    btSphereShape shape_{btScalar(0.1)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::optional<ductile::bullet::World> world_{
        std::in_place, *engine_, ductile::bullet::WorldParameters{.ledger = true, .warn = nullptr}};
    std::vector<std::unique_ptr<Hinge>> hinges_;
};

} // namespace bench::cost
