// SPDX-License-Identifier: MIT
//
// A small Bullet world for the contract suite. Same verbs as ode_rig.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "ductile/bullet/bullet.hpp"

namespace ductile::test {

using V3 = Vector3<double>;
using Joint = OneAxisJoint<Perfect<double>>;

class Rig {
  public:
    using Hinge = bullet::PlasticHinge<>;
    using Slider = bullet::PlasticSlider<>;
    using HardeningHinge = bullet::PlasticHinge<OneAxisJoint<Linear<double>>>;
    using Body = btRigidBody*;
    static constexpr bool single = sizeof(btScalar) == sizeof(float);

    /// Solvers to run every test with.
    static std::vector<std::string> solvers() { return {"si", "mlcp"}; }

    Rig(const std::string& solver, const V3& gravity) {
        if (solver == "mlcp") {
            dantzig_ = std::make_unique<btDantzigSolver>();
            solver_ = std::make_unique<btMLCPSolver>(dantzig_.get());
        } else {
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        }
        world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(),
                                                           &configuration_);
        world_->setGravity(bullet::to_bullet(gravity));
        world_->getSolverInfo().m_splitImpulsePenetrationThreshold = btScalar(1e30);
        world_->getSimulationIslandManager()->setSplitIslands(false); // the contact is made by hand
        meter_ = std::make_unique<bullet::EnergyMeter>(*world_);
    }
    ~Rig() {
        meter_.reset();
        for (auto& hinge : hinges_) hinge->remove_from(*world_);
        for (auto& slider : sliders_) slider->remove_from(*world_);
        if (hardening_) hardening_->remove_from(*world_);
        if (contact_ != nullptr) dispatcher_.releaseManifold(contact_);
        for (auto& body : bodies_) world_->removeRigidBody(body.get());
    }

    Body body(double mass, const V3& inertia, const V3& at, const V3& velocity, const V3& spin) {
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape_,
                                                      bullet::to_bullet(inertia));
        info.m_startWorldTransform.setOrigin(bullet::to_bullet(at));
        Body b = bodies_.emplace_back(std::make_unique<btRigidBody>(info)).get();
        b->setActivationState(DISABLE_DEACTIVATION);
        world_->addRigidBody(b, 0, 0);
        b->setLinearVelocity(bullet::to_bullet(velocity));
        b->setAngularVelocity(bullet::to_bullet(spin));
        return b;
    }

    /// Null `b`: the static world.
    Hinge& hinge(Body a, Body b, const V3& anchor, const V3& axis, Joint joint) {
        const btTransform frame = frame_along(anchor, axis);
        hinges_.push_back(b != nullptr ? std::make_unique<Hinge>(*a, *b, local(*a, frame),
                                                                 local(*b, frame), joint)
                                       : std::make_unique<Hinge>(*a, local(*a, frame), joint));
        hinges_.back()->add_to(*world_);
        return *hinges_.back();
    }
    /// To the static world, R = strength + hardening p.
    auto& hardening_hinge(Body a, const V3& anchor, const V3& axis, double strength,
                          double hardening) {
        const btTransform frame = frame_along(anchor, axis);
        hardening_ = std::make_unique<HardeningHinge>(
            *a, local(*a, frame),
            OneAxisJoint(Linear<double>({.strength = strength, .hardening = hardening})));
        hardening_->add_to(*world_);
        return *hardening_;
    }
    Slider& slider(Body a, Body b, const V3& axis, Joint joint) {
        const btTransform frame = frame_along(bullet::to_core(a->getCenterOfMassPosition()), axis);
        sliders_.push_back(b != nullptr ? std::make_unique<Slider>(*a, *b, local(*a, frame),
                                                                   local(*b, frame), joint)
                                        : std::make_unique<Slider>(*a, local(*a, frame), joint));
        sliders_.back()->add_to(*world_);
        return *sliders_.back();
    }

    /// One inelastic contact between two bodies above each other, that touch where their centres are
    /// `distance` apart along y.
    void stack(Body lower, Body upper, double distance) {
        contact_ = dispatcher_.getNewManifold(upper, lower);
        contact_distance_ = distance;
    }

    void step(double dt) {
        if (contact_ != nullptr) touch();
        meter_->before_step();
        world_->stepSimulation(btScalar(dt), 0);
        meter_->after_step(dt);
    }

    static void apply_force(Body b, const V3& force) {
        b->applyCentralForce(bullet::to_bullet(force));
    }
    static V3 position(Body b) { return bullet::to_core(b->getCenterOfMassPosition()); }
    static V3 velocity(Body b) { return bullet::to_core(b->getLinearVelocity()); }
    static V3 spin(Body b) { return bullet::to_core(b->getAngularVelocity()); }
    static void set_velocity(Body b, const V3& v) { b->setLinearVelocity(bullet::to_bullet(v)); }
    [[nodiscard]] const Ledger<double>& ledger() const { return meter_->ledger(); }
    void open_ledger() { meter_->open(); }

  private:
    static btTransform frame_along(const V3& origin, const V3& axis) {
        const btVector3 z = bullet::to_bullet(axis.normalized());
        btVector3 x, y;
        btPlaneSpace1(z, x, y);
        const btMatrix3x3 basis(x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z());
        return btTransform(basis, bullet::to_bullet(origin));
    }
    static btTransform local(const btRigidBody& body, const btTransform& frame) {
        return body.getCenterOfMassTransform().inverse() * frame;
    }

    void touch() {
        const auto* upper = static_cast<const btRigidBody*>(contact_->getBody0());
        const auto* lower = static_cast<const btRigidBody*>(contact_->getBody1());
        const btVector3 top = upper->getCenterOfMassPosition(), base = lower->getCenterOfMassPosition();
        const btScalar gap = top.y() - base.y() - btScalar(contact_distance_);
        contact_->clearManifold();
        if (gap > btScalar(0.5)) return;
        const btVector3 on_lower = base + btVector3(0, btScalar(contact_distance_ / 2), 0);
        const btVector3 on_upper = on_lower + btVector3(0, gap, 0);
        btManifoldPoint point(upper->getCenterOfMassTransform().invXform(on_upper),
                              lower->getCenterOfMassTransform().invXform(on_lower), {0, 1, 0}, gap);
        point.m_positionWorldOnA = on_upper;
        point.m_positionWorldOnB = on_lower;
        contact_->addManifoldPoint(point);
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    std::unique_ptr<btMLCPSolverInterface> dantzig_;
    std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    btSphereShape shape_{1};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::vector<std::unique_ptr<Slider>> sliders_;
    std::unique_ptr<HardeningHinge> hardening_;
    std::unique_ptr<bullet::EnergyMeter> meter_;
    btPersistentManifold* contact_ = nullptr;
    double contact_distance_ = 0;
};

} // namespace ductile::test
