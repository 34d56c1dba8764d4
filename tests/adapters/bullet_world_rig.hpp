// SPDX-License-Identifier: MIT
//
// A Bullet world below ductile's own World, for the tests of that. Same verbs as
// ode_world_rig.hpp.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cmath>
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
    static constexpr const char* engine = "Bullet";
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
    /// As a user gets it who says nothing: steps are frames, of 1 %.
    explicit WorldRig(Warn warn)
        : dynamics_(&dispatcher_, &broadphase_, &solver_, &configuration_),
          world_(dynamics_, {.warn = std::move(warn)}) {
        dynamics_.setGravity({0, 0, 0});
    }
    ~WorldRig() {
        others_.clear();
        for (auto& hinge : hinges_) world_.remove(*hinge);
        for (auto& joint : sixes_) world_.remove(*joint);
        for (auto& constraint : own_) dynamics_.removeConstraint(constraint.get());
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

    /// That touches others.
    Body box(double mass, const V3& half, const V3& at) {
        return shaped(mass, std::make_unique<btBoxShape>(bullet::to_bullet(half)), at);
    }
    /// The same, without friction.
    Body ball(double mass, double radius, const V3& at) {
        const Body b = shaped(mass, std::make_unique<btSphereShape>(btScalar(radius)), at);
        b->setFriction(0);
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

    /// At once, without a way there.
    static void put(Body b, const V3& at) {
        btTransform pose = b->getWorldTransform();
        pose.setOrigin(bullet::to_bullet(at));
        b->setCenterOfMassTransform(pose);
        b->setInterpolationWorldTransform(pose); // else a prescribed body is driven there
    }

    /// About z; null `b`: the static world.
    Hinge& hinge(Body a, Body b, const V3& anchor, Joint joint, const std::string& name) {
        btTransform frame;
        frame.setIdentity();
        frame.setOrigin(bullet::to_bullet(anchor));
        hinges_.push_back(
            b != nullptr ? std::make_unique<Hinge>(*a, *b, local(a, frame), local(b, frame), joint)
                         : std::make_unique<Hinge>(*a, local(a, frame), joint));
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

    /// About z, any law.
    template <class Any>
    auto& hinge_of(Body a, Body b, const V3& anchor, Any joint) {
        using Constraint = bullet::PlasticHinge<Any>;
        const btTransform frame(btMatrix3x3::getIdentity(), bullet::to_bullet(anchor));
        return own(b != nullptr
                       ? std::make_unique<Constraint>(*a, *b, local(a, frame), local(b, frame),
                                                      std::move(joint))
                       : std::make_unique<Constraint>(*a, local(a, frame), std::move(joint)));
    }
    /// To the static world, along `axis`.
    template <class Any>
    auto& slider(Body a, const V3& axis, Any joint) {
        btTransform frame;
        frame.setIdentity();
        frame.setRotation(shortestArcQuat({0, 0, 1}, bullet::to_bullet(axis)));
        return own(
            std::make_unique<bullet::PlasticSlider<Any>>(*a, local(a, frame), std::move(joint)));
    }
    /// Any joint of six axes, as `six_axes`.
    template <class Any>
    auto& six_of(Body a, Any joint) {
        btTransform frame;
        frame.setIdentity();
        return own(std::make_unique<bullet::PlasticJoint<Any>>(*a, frame, std::move(joint)));
    }
    /// A joint of some axes; null `b`: the static world. `axes`: of the frame, as columns.
    template <class Any, class Axes>
    auto& some_of(Body a, Body b, const V3& at, const Eigen::Matrix3d& columns, Any joint,
                  const Axes& axes) {
        using Constraint = bullet::PlasticJoint<Any>;
        const btTransform frame = bullet::to_bullet(JointFrame<double>{at, columns});
        return own(b != nullptr
                       ? std::make_unique<Constraint>(*a, *b, local(a, frame), local(b, frame),
                                                      std::move(joint), axes)
                       : std::make_unique<Constraint>(*a, local(a, frame), std::move(joint), axes));
    }
    /// The engine's own hinge about z, which takes no moment.
    void pin(Body a, Body b, const V3& anchor) {
        const btTransform frame(btMatrix3x3::getIdentity(), bullet::to_bullet(anchor));
        keep(b != nullptr
                 ? std::make_unique<btHingeConstraint>(*a, *b, local(a, frame), local(b, frame))
                 : std::make_unique<btHingeConstraint>(*a, local(a, frame)));
    }
    /// The same, made plastic.
    auto& motor(Body a, Body b, const V3& anchor, Joint joint) {
        pin(a, b, anchor);
        return own(std::make_unique<bullet::PlasticMotor<Joint>>(
            static_cast<btHingeConstraint&>(*own_.back()), joint));
    }
    /// The engine's own slider: `a` may only move along `axis`.
    void guide(Body a, const V3& axis) {
        btTransform frame = a->getCenterOfMassTransform();
        frame.setRotation(shortestArcQuat({1, 0, 0}, bullet::to_bullet(axis)));
        keep(std::make_unique<btSliderConstraint>(*a, local(a, frame), true));
    }

    void set_gravity(const V3& g) {
        dynamics_.setGravity(bullet::to_bullet(g));
        for (auto& body : bodies_) body->setGravity(bullet::to_bullet(g));
    }
    /// Of all that were made.
    void set_friction(double coefficient) {
        for (auto& body : bodies_) body->setFriction(btScalar(std::sqrt(coefficient)));
    }
    static void apply_force(Body b, const V3& force) {
        b->applyCentralForce(bullet::to_bullet(force));
    }
    /// `arm`: from the centre of mass, at the start.
    void push(Body b, const V3& force, const V3& at) { world().apply_force(*b, force, at); }
    static void apply_force_at(Body b, const V3& force, const V3& arm) {
        b->applyForce(bullet::to_bullet(force),
                      b->getWorldTransform().getBasis() * bullet::to_bullet(arm));
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
    /// Rotation from the start, less than π [rad].
    static V3 turn(Body b) {
        return rotation_vector<double>(bullet::to_core(b->getCenterOfMassTransform().getBasis()));
    }
    static V3 position(Body b) { return bullet::to_core(b->getCenterOfMassPosition()); }

  private:
    Body shaped(double mass, std::unique_ptr<btConvexInternalShape> shape, const V3& at) {
        btVector3 inertia;
        shape->calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape.get(),
                                                      inertia);
        info.m_startWorldTransform.setOrigin(bullet::to_bullet(at));
        shapes_.push_back(std::move(shape));
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        dynamics_.addRigidBody(bodies_.back().get());
        return bodies_.back().get();
    }
    static btTransform local(Body body, const btTransform& frame) {
        return body->getCenterOfMassTransform().inverse() * frame;
    }
    void keep(std::unique_ptr<btTypedConstraint> constraint) {
        own_.push_back(std::move(constraint));
        dynamics_.addConstraint(own_.back().get(), true);
    }
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
    std::vector<std::unique_ptr<btConvexInternalShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> own_;
    bullet::World world_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::vector<std::unique_ptr<Six>> sixes_;
    std::vector<std::unique_ptr<bullet::PlasticConstraint>> others_;
};

} // namespace ductile::test
