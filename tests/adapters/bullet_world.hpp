// SPDX-License-Identifier: MIT
//
// A Bullet world for tests of what only Bullet has: spherical bodies that do not collide, and every
// solver by name.
#pragma once

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/front_solver.hpp"

namespace ductile::test {

class BulletWorld {
  public:
    using V3 = Vector3<double>;
    static constexpr bool single = sizeof(btScalar) == sizeof(float);

    /// Bullet's own two, and its default one behind the front that a World puts there.
    static std::vector<std::string> solvers() { return {"si", "mlcp", "world"}; }

    explicit BulletWorld(const std::string& solver = "world", const V3& gravity = V3::Zero()) {
        if (solver == "si" || solver == "world") {
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        } else if (solver == "mlcp") {
            solver_ = std::make_unique<btMLCPSolver>(&dantzig_);
        } else {
            throw std::invalid_argument("no solver " + solver);
        }
        world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_,
                                                           solver_.get(), &configuration_);
        if (solver == "world") front_ = std::make_unique<bullet::FrontHold>(*world_);
        world_->setGravity(bullet::to_bullet(gravity));
        world_->getSolverInfo().m_numIterations = 50;
    }
    ~BulletWorld() {
        for (int i = world_->getNumConstraints() - 1; i >= 0; --i) {
            world_->removeConstraint(world_->getConstraint(i));
        }
        for (auto& body : bodies_) world_->removeRigidBody(body.get());
    }
    BulletWorld(const BulletWorld&) = delete;
    BulletWorld& operator=(const BulletWorld&) = delete;

    /// `mass` 0: static. Never falls asleep unless told to.
    btRigidBody& body(double mass, const V3& inertia, const btTransform& at) {
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape_,
                                                      bullet::to_bullet(inertia));
        info.m_startWorldTransform = at;
        btRigidBody& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_->addRigidBody(&body, 0, 0);
        return body;
    }
    btRigidBody& body(double mass, double inertia, const V3& at = V3::Zero()) {
        return body(mass, V3::Constant(inertia), frame(at));
    }

    static btTransform frame(const V3& origin,
                             const Matrix3<double>& axes = Matrix3<double>::Identity()) {
        btMatrix3x3 basis;
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                basis[row][column] = btScalar(axes(row, column));
            }
        }
        return btTransform(basis, bullet::to_bullet(origin));
    }

    void step(double dt) { world_->stepSimulation(btScalar(dt), 0); }
    void step(double dt, int times) {
        for (int i = 0; i < times; ++i) step(dt);
    }

    [[nodiscard]] btDiscreteDynamicsWorld& world() { return *world_; }

  private:
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btDantzigSolver dantzig_;
    std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::unique_ptr<bullet::FrontHold> front_;
    btSphereShape shape_{1};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

} // namespace ductile::test
