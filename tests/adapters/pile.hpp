// SPDX-License-Identifier: MIT
//
// A pile of 30 boxes with friction, which slides and may fall asleep, and beside it four pairs of
// boxes on a plastic hinge that slide, tip over and yield: what a world that is put back has to get
// right.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "ductile/bullet/plastic_hinge.hpp"
#include "ductile/bullet/world.hpp"
#include "support/bit_hash.hpp"

namespace pile {

using Hinge = ductile::bullet::PlasticHinge<>;

struct Options {
    bool spread = false;   ///< boxes with gaps between them that slide, else a heap
    bool sleeps = true;    ///< bodies may fall asleep
    bool shuffles = false; ///< the solver goes through its rows in a random order
    bool hinges = true;
};

struct Pile {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btBoxShape box{btVector3(0.5, 0.5, 0.5)}, floor{btVector3(50, 1, 50)};
    std::vector<std::unique_ptr<btRigidBody>> bodies;
    std::vector<std::unique_ptr<Hinge>> hinges;

    explicit Pile(const Options& options = {}) {
        world.setGravity(btVector3(0, btScalar(-9.81), 0));
        if (options.shuffles) world.getSolverInfo().m_solverMode |= SOLVER_RANDMIZE_ORDER;
        add(floor, 0, {0, -1, 0});
        for (int i = 0; i < 30; ++i) {
            const btScalar row = btScalar(i / 3), third = btScalar(i % 3);
            if (options.spread) {
                add(box, 100,
                    {btScalar(1.12) * btScalar(i % 6),
                     btScalar(0.55) + btScalar(1.05) * btScalar(i / 12),
                     btScalar(1.15) * btScalar((i / 6) % 2)});
            } else {
                add(box, 100,
                    {btScalar(1.02) * third + btScalar(0.1) * btScalar((i / 3) % 2),
                     btScalar(0.6) + btScalar(1.1) * row, btScalar(0.05) * btScalar(i % 2)});
            }
        }
        for (int i = 0; options.hinges && i < 4; ++i) {
            const btScalar x = btScalar(12 + 4 * i);
            add(box, 100, {x, btScalar(0.52), 0});
            add(box, 100, {x, btScalar(1.62), 0});
            const std::size_t below = bodies.size() - 2;
            hinge(below, below + 1);
            bodies[below]->setLinearVelocity({btScalar(1 + i), 0, btScalar(0.3)});
            bodies[below + 1]->setAngularVelocity({0, 0, btScalar(0.5 * i)});
        }
        for (auto& body : bodies) {
            body->setFriction(btScalar(0.6));
            if (!options.sleeps) body->setActivationState(DISABLE_DEACTIVATION);
        }
        bodies[28]->setLinearVelocity({3, 0, 1});
        for (int i = 1; options.spread && i < 31; ++i) {
            bodies[std::size_t(i)]->setLinearVelocity({btScalar(0.7) * btScalar((i * 7) % 5 - 2), 0,
                                                       btScalar(0.5) * btScalar((i * 3) % 5 - 2)});
        }
    }
    ~Pile() {
        for (auto& hinge : hinges) hinge->remove_from(world);
        for (auto& body : bodies) world.removeRigidBody(body.get());
    }
    Pile(const Pile&) = delete;
    Pile& operator=(const Pile&) = delete;

    /// Of all places and velocities, and the hinges' accounts, bit by bit.
    [[nodiscard]] std::uint64_t hash() const {
        ductile::test::BitHash bits;
        for (const auto& body : bodies) {
            const btTransform& at = body->getWorldTransform();
            for (int k = 0; k < 3; ++k) {
                for (int j = 0; j < 3; ++j) bits.eat(double(at.getBasis()[k][j]));
                bits.eat(double(at.getOrigin()[k]));
                bits.eat(double(body->getLinearVelocity()[k]));
                bits.eat(double(body->getAngularVelocity()[k]));
            }
        }
        for (const auto& hinge : hinges) {
            bits.eat(hinge->absorbed_energy());
            bits.eat(hinge->plastic_offset());
        }
        return bits.value();
    }

  private:
    void add(btCollisionShape& shape, btScalar mass, const btVector3& at) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
        info.m_startWorldTransform.setIdentity();
        info.m_startWorldTransform.setOrigin(at);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        world.addRigidBody(bodies.back().get());
    }
    void hinge(std::size_t below, std::size_t above) {
        btTransform on_top;
        on_top.setIdentity();
        on_top.setOrigin({0, btScalar(0.55), 0});
        const btTransform at = bodies[below]->getCenterOfMassTransform() * on_top;
        hinges.push_back(std::make_unique<Hinge>(
            *bodies[above], *bodies[below],
            bodies[above]->getCenterOfMassTransform().inverse() * at, on_top,
            ductile::OneAxisJoint(ductile::Perfect<double>({.strength = 300}))));
        hinges.back()->add_to(world);
    }
};

} // namespace pile
