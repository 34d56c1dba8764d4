// SPDX-License-Identifier: MIT
//
// A Bullet world below ductile's own World, for the tests of that. Same verbs as
// ode_world_rig.hpp.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ductile/bullet/bullet.hpp"

namespace ductile::test {

namespace engine = ductile::bullet;
using V3 = Vector3<double>;
using Joint = OneAxisJoint<Perfect<double>, TravelLimit<double>>;
using SixAxes = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;

class WorldRig {
  public:
    using Hinge = bullet::PlasticHinge<Joint>;
    using Six = bullet::PlasticJoint<SixAxes>;
    using Body = btRigidBody*;
    static constexpr bool single = sizeof(btScalar) == sizeof(float);

    /// Steps as they are, not frames.
    explicit WorldRig(bool /*iterative*/, Warn warn = nullptr, bool ledger = true)
        : dynamics_(&dispatcher_, &broadphase_, &solver_, &configuration_),
          world_(dynamics_, {.ledger = ledger, .tolerance = 0, .warn = std::move(warn)}) {
        dynamics_.setGravity({0, 0, 0});
    }
    /// Steps are frames.
    WorldRig(bool /*iterative*/, double tolerance, int budget)
        : dynamics_(&dispatcher_, &broadphase_, &solver_, &configuration_),
          world_(dynamics_, {.tolerance = tolerance,
                             .budget = budget,
                             .rest_damping = 0, // what swings here is to go on
                             .warn = nullptr}) {
        dynamics_.setGravity({0, 0, 0});
    }
    ~WorldRig() {
        others_.clear();
        for (auto& hinge : hinges_) world_.remove(*hinge);
        for (auto& joint : sixes_) world_.remove(*joint);
        for (auto& body : bodies_) dynamics_.removeRigidBody(body.get());
    }

    [[nodiscard]] bullet::World& world() { return world_; }
    [[nodiscard]] btDiscreteDynamicsWorld& dynamics() { return dynamics_; }

    Body body(double mass, const V3& inertia, const V3& at) {
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape_,
                                                      bullet::to_bullet(inertia));
        info.m_startWorldTransform.setOrigin(bullet::to_bullet(at));
        Body b = bodies_.emplace_back(std::make_unique<btRigidBody>(info)).get();
        b->setActivationState(DISABLE_DEACTIVATION);
        dynamics_.addRigidBody(b, 0, 0);
        return b;
    }

    /// Its motion is prescribed from now on.
    static void prescribe(Body b) {
        b->setMassProps(0, {0, 0, 0});
        b->updateInertiaTensor(); // Bullet's solvers go on using the one of the world
        b->setCollisionFlags(b->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    /// Turns a prescribed body by `spin` dt about z in the coming step, to `angle` in all.
    static void drive(Body b, double angle, double /*spin*/) {
        b->getWorldTransform().setRotation(btQuaternion(btVector3(0, 0, 1), btScalar(angle)));
    }

    /// About z; null `b`: the static world.
    Hinge& hinge(Body a, Body b, const V3& anchor, Joint joint, const std::string& name) {
        btTransform frame;
        frame.setIdentity();
        frame.setOrigin(bullet::to_bullet(anchor));
        const auto in = [&](Body body) {
            return body->getCenterOfMassTransform().inverse() * frame;
        };
        hinges_.push_back(b != nullptr ? std::make_unique<Hinge>(*a, *b, in(a), in(b), joint)
                                       : std::make_unique<Hinge>(*a, in(a), joint));
        world_.add(*hinges_.back(), name);
        return *hinges_.back();
    }

    /// To the static world, axes along those of the world, z along the member.
    Six& six_axes(Body a, const V3& anchor, SixAxes joint) {
        btTransform frame;
        frame.setIdentity();
        frame.setOrigin(bullet::to_bullet(anchor));
        sixes_.push_back(std::make_unique<Six>(*a, a->getCenterOfMassTransform().inverse() * frame,
                                               std::move(joint)));
        world_.add(*sixes_.back());
        return *sixes_.back();
    }

    /// To the static world, along `axis`.
    auto& slider(Body a, const V3& axis, Joint joint) {
        btTransform frame;
        frame.setIdentity();
        frame.setRotation(shortestArcQuat({0, 0, 1}, bullet::to_bullet(axis)));
        const btTransform in_a = a->getCenterOfMassTransform().inverse() * frame;
        return own(std::make_unique<bullet::PlasticSlider<Joint>>(*a, in_a, std::move(joint)));
    }
    /// Any joint of six axes, as `six_axes`.
    template <class Any>
    auto& six_of(Body a, Any joint) {
        btTransform frame;
        frame.setIdentity();
        return own(std::make_unique<bullet::PlasticJoint<Any>>(*a, frame, std::move(joint)));
    }

    void set_gravity(const V3& g) {
        dynamics_.setGravity(bullet::to_bullet(g));
        for (auto& body : bodies_) body->setGravity(bullet::to_bullet(g));
    }
    static void apply_force(Body b, const V3& force) {
        b->applyCentralForce(bullet::to_bullet(force));
    }
    static void set_velocity(Body b, const V3& v) { b->setLinearVelocity(bullet::to_bullet(v)); }
    static void set_spin(Body b, const V3& w) { b->setAngularVelocity(bullet::to_bullet(w)); }
    /// All that a body and its hinge remember.
    struct Saved {
        btTransform at;
        btVector3 velocity, spin;
        Hinge::State hinge;
        bool operator==(const Saved&) const = default;
    };
    static Saved save(Body b, Hinge& hinge) {
        return {b->getCenterOfMassTransform(), b->getLinearVelocity(), b->getAngularVelocity(),
                hinge.state()};
    }
    static void put_back(Body b, Hinge& hinge, const Saved& saved) {
        b->setCenterOfMassTransform(saved.at);
        b->setLinearVelocity(saved.velocity);
        b->setAngularVelocity(saved.spin);
        hinge.restore(saved.hinge);
    }
    static V3 velocity(Body b) { return bullet::to_core(b->getLinearVelocity()); }
    static V3 spin(Body b) { return bullet::to_core(b->getAngularVelocity()); }
    static V3 position(Body b) { return bullet::to_core(b->getCenterOfMassPosition()); }

  private:
    template <class Constraint>
    Constraint& own(std::unique_ptr<Constraint> constraint) {
        Constraint& result = *constraint;
        others_.push_back(std::move(constraint));
        world_.add(result);
        return result;
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld dynamics_;
    btSphereShape shape_{1};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    bullet::World world_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::vector<std::unique_ptr<Six>> sixes_;
    std::vector<std::unique_ptr<bullet::PlasticConstraint>> others_;
};

} // namespace ductile::test
