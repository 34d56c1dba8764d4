// SPDX-License-Identifier: MIT
//
// A structure in Bullet as it comes: sequential impulse, ten iterations; ours with a default World.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/bullet/bullet.hpp"
#include "structures/plan.hpp"

namespace bench::structures {

class Site {
  public:
    static constexpr std::string_view engine = "bullet";
    static constexpr std::string_view precision =
        sizeof(btScalar) == sizeof(double) ? "double" : "float";
    static constexpr double layer = 0;
    static std::vector<std::string> solvers() { return {"si"}; }
    static bool sensible(const std::string&, Method, std::size_t /*joints*/) { return true; }

    Site(const Plan& plan, Method method, const std::string& /*solver*/, bool awake) : plan_(plan) {
        engine_->setGravity(btVector3(0, 0, method == Method::none ? 0 : btScalar(-plan.gravity)));
        if (method == Method::elastic || method == Method::rigid) {
            world_.emplace(*engine_, ductile::bullet::WorldParameters{
                                         .warn = [this](const std::string&) { ++warnings_; }});
        }
        const int still = add({0, V3(50, 50, 1), V3(0, 0, -1), true}, awake);
        bodies_.reserve(plan.parts.size() + 1);
        for (const Part& part : plan.parts) add(part, awake);
        for (const Joint& joint : plan.joints) connect(joint, method, still);
    }
    ~Site() {
        ours_.clear();
        world_.reset();
        engine_.reset();
    }
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    void step(double dt) {
        if (world_) {
            world_->step(dt);
        } else {
            engine_->stepSimulation(btScalar(dt), 0);
        }
    }
    void remove_column() {
        btRigidBody* column = body(plan_.to_remove);
        std::erase_if(ours_, [&](const auto& joint) {
            const bool touches =
                &joint->getRigidBodyA() == column || &joint->getRigidBodyB() == column;
            if (touches) world_->remove(*joint);
            return touches;
        });
        for (const auto& joint : own_) {
            if (&joint->getRigidBodyA() == column || &joint->getRigidBodyB() == column) {
                engine_->removeConstraint(joint.get());
            }
        }
        engine_->removeRigidBody(column);
    }
    [[nodiscard]] double absorbed() const {
        double sum = 0;
        for (const auto& joint : ours_) sum += joint->absorbed_energy();
        return sum;
    }
    [[nodiscard]] V3 position(int part) const {
        return ductile::bullet::to_core(body(part)->getCenterOfMassPosition());
    }
    [[nodiscard]] int warnings() const { return warnings_; }

  private:
    using Ours = ductile::bullet::PlasticJoint<Section>;

    /// The first one is the ground.
    [[nodiscard]] btRigidBody* body(int part) const { return bodies_[std::size_t(part + 1)].get(); }

    int add(const Part& part, bool awake) {
        using ductile::bullet::to_bullet;
        shapes_.push_back(std::make_unique<btBoxShape>(to_bullet(part.half)));
        btVector3 inertia(0, 0, 0);
        if (part.mass > 0) shapes_.back()->calculateLocalInertia(btScalar(part.mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(part.mass), nullptr,
                                                      shapes_.back().get(), inertia);
        info.m_startWorldTransform.setOrigin(to_bullet(part.at));
        btRigidBody& made = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        made.setFriction(part.mass > 0 ? btScalar(friction) : btScalar(1));
        made.setLinearVelocity(to_bullet(part.velocity));
        if (awake) made.setActivationState(DISABLE_DEACTIVATION);
        part.collides ? engine_->addRigidBody(&made) : engine_->addRigidBody(&made, 0, 0);
        return ground;
    }
    void connect(const Joint& joint, Method method, int still) {
        if (method == Method::none) return;
        btRigidBody &a = *body(joint.a), &b = *body(joint.b == ground ? still : joint.b);
        const M3& m = joint.axes;
        const btTransform frame(
            btMatrix3x3(btScalar(m(0, 0)), btScalar(m(0, 1)), btScalar(m(0, 2)), btScalar(m(1, 0)),
                        btScalar(m(1, 1)), btScalar(m(1, 2)), btScalar(m(2, 0)), btScalar(m(2, 1)),
                        btScalar(m(2, 2))),
            ductile::bullet::to_bullet(joint.at));
        const btTransform in_a = a.getCenterOfMassTransform().inverse() * frame;
        const btTransform in_b = b.getCenterOfMassTransform().inverse() * frame;
        if (method == Method::fixed) {
            own_.push_back(std::make_unique<btFixedConstraint>(a, b, in_a, in_b));
            engine_->addConstraint(own_.back().get());
            return;
        }
        ours_.push_back(std::make_unique<Ours>(a, b, in_a, in_b, section(joint.column, method)));
        world_->add(*ours_.back());
    }

    Plan plan_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    std::vector<std::unique_ptr<btBoxShape>> shapes_;
    std::optional<btDiscreteDynamicsWorld> engine_{std::in_place, &dispatcher_, &broadphase_,
                                                   &solver_, &configuration_};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    int warnings_ = 0;
    std::optional<ductile::bullet::World> world_;
    std::vector<std::unique_ptr<btTypedConstraint>> own_;
    std::vector<std::unique_ptr<Ours>> ours_;
};

} // namespace bench::structures
