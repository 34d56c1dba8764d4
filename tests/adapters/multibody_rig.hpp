// SPDX-License-Identifier: MIT
//
// Worlds with one multibody for the tests of Bullet's reduced coordinates: rotors on a common axis
// and a chain of segments.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ductile/bullet/multibody_energy.hpp"
#include "ductile/bullet/multibody_hinge.hpp"
#include "ductile/bullet/multibody_solver.hpp"

namespace ductile::test {

using Joint = OneAxisJoint<Perfect<double>>;
using Hinge = bullet::MultiBodyPlasticHinge<>;

inline constexpr bool single = sizeof(btScalar) == sizeof(float);

/// "si": iterative; "mlcp": Bullet's direct solver; "soft mlcp": ours.
class MultiBodyRig {
  public:
    MultiBodyRig(const std::string& solver, int links, double base_inertia = 0)
        : body_(links, btScalar(1), btVector3(1, 1, 1) * btScalar(base_inertia), base_inertia == 0,
                false) {
        if (solver == "si") solver_ = std::make_unique<btMultiBodyConstraintSolver>();
        if (solver == "mlcp") {
            solver_ = std::make_unique<btMultiBodyMLCPConstraintSolver>(&dantzig_);
        }
        if (solver == "soft mlcp") {
            solver_ = std::make_unique<bullet::MultiBodyMlcpSolver>(&dantzig_);
        }
        world_ = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher_, &broadphase_,
                                                            solver_.get(), &configuration_);
        world_->setGravity({0, 0, 0});
        bullet::undamp(body_);
    }
    ~MultiBodyRig() {
        for (auto& hinge : hinges_) hinge->remove_from(*world_);
        for (auto& collider : colliders_) world_->removeCollisionObject(collider.get());
        world_->removeMultiBody(&body_);
    }
    MultiBodyRig(const MultiBodyRig&) = delete;
    MultiBodyRig& operator=(const MultiBodyRig&) = delete;

    /// To be called when all links are set up.
    void finish() {
        body_.finalizeMultiDof();
        world_->addMultiBody(&body_);
        for (int i = 0; i < body_.getNumLinks(); ++i) {
            auto& collider =
                colliders_.emplace_back(std::make_unique<btMultiBodyLinkCollider>(&body_, i));
            collider->setCollisionShape(&shape_);
            body_.getLink(i).m_collider = collider.get();
            world_->addCollisionObject(collider.get(), 0, 0);
        }
    }
    Hinge& hinge(int link, Joint joint) {
        hinges_.push_back(std::make_unique<Hinge>(body_, link, std::move(joint)));
        hinges_.back()->add_to(*world_);
        return *hinges_.back();
    }
    [[nodiscard]] Hinge& hinge(int i) { return *hinges_[std::size_t(i)]; }
    void step(double dt) { world_->stepSimulation(btScalar(dt), 0); }

    /// Velocities that an impulse by degree of freedom (base: torque, force) leaves at once.
    void strike(const std::vector<double>& impulse) {
        btAlignedObjectArray<btScalar> scratch, bullet_impulse, change;
        btAlignedObjectArray<btVector3> vectors;
        btAlignedObjectArray<btMatrix3x3> matrices;
        world_->forwardKinematics();
        body_.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scratch, vectors, matrices,
                                                                   false, false, false);
        for (const double entry : impulse) bullet_impulse.push_back(btScalar(entry));
        change.resize(bullet_impulse.size(), 0);
        body_.calcAccelerationDeltasMultiDof(&bullet_impulse[0], &change[0], scratch, vectors);
        body_.applyDeltaVeeMultiDof(&change[0], 1);
    }

    [[nodiscard]] btMultiBody& body() { return body_; }
    [[nodiscard]] btMultiBodyDynamicsWorld& world() { return *world_; }
    [[nodiscard]] double kinetic_energy() const { return bullet::kinetic_energy(body_); }
    /// Sum of what the hinges took [J].
    [[nodiscard]] double taken() const {
        double sum = 0;
        for (const auto& hinge : hinges_) {
            const auto& state = hinge->joint().state();
            sum += state.plastic_work + state.other_work + state.stored + state.lost;
        }
        return sum;
    }
    /// Worst certificate so far [rad/s].
    [[nodiscard]] double residual() const {
        double worst = 0;
        for (const auto& hinge : hinges_) worst = std::max(worst, hinge->residual_max());
        return worst;
    }

  private:
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btDantzigSolver dantzig_;
    std::unique_ptr<btMultiBodyConstraintSolver> solver_;
    std::unique_ptr<btMultiBodyDynamicsWorld> world_;
    btMultiBody body_;
    btSphereShape shape_{btScalar(0.01)};
    std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
};

/// Rotors about one axis, each hinged to the one before, the first to the base.
struct Rotors : MultiBodyRig {
    Rotors(const std::string& solver, const std::vector<double>& inertias,
           const btVector3& axis = {0, 0, 1}, double base_inertia = 0)
        : MultiBodyRig(solver, int(inertias.size()), base_inertia) {
        for (std::size_t i = 0; i < inertias.size(); ++i) {
            body().setupRevolute(int(i), 1, btVector3(1, 1, 1) * btScalar(inertias[i]), int(i) - 1,
                                 btQuaternion::getIdentity(), axis, {0, 0, 0}, {0, 0, 0});
        }
        finish();
    }
};

/// A cantilever along x of equal rigid segments that turn about z.
struct Cantilever : MultiBodyRig {
    struct Parameters {
        int segments = 1;
        double length = 1, mass_per_length = 2, plastic_moment = 100;
        double tip_mass = 0;                                        ///< a point, fixed to the tip
        double stiffness = std::numeric_limits<double>::infinity(); ///< of each hinge [N m/rad]
    };

    Cantilever(const std::string& solver, const Parameters& p)
        : MultiBodyRig(solver, p.segments + (p.tip_mass > 0 ? 1 : 0)),
          segments(p.segments),
          segment(p.length / p.segments) {
        const double mass = p.mass_per_length * segment;
        const auto half = btScalar(segment / 2);
        const auto across = btScalar(mass * segment * segment / 12);
        for (int i = 0; i < segments; ++i) {
            body().setupRevolute(i, btScalar(mass), {across, across, across}, i - 1,
                                 btQuaternion::getIdentity(), {0, 0, 1},
                                 {i == 0 ? btScalar(0) : half, 0, 0}, {half, 0, 0});
        }
        if (p.tip_mass > 0) {
            body().setupFixed(segments, btScalar(p.tip_mass), {0, 0, 0}, segments - 1,
                              btQuaternion::getIdentity(), {half, 0, 0}, {0, 0, 0});
        }
        finish();
        for (int i = 0; i < segments; ++i) {
            hinge(i, Joint(Perfect<double>({.strength = p.plastic_moment}), {},
                           {.stiffness = p.stiffness}));
        }
    }

    using MultiBodyRig::hinge;

    /// An impulse across the tip [N s]; the hinges' moments are finite and do not feel it.
    void strike_tip(double impulse) {
        std::vector<double> moments(std::size_t(6 + segments));
        for (int i = 0; i < segments; ++i) {
            moments[std::size_t(6 + i)] = impulse * segment * (segments - i);
        }
        strike(moments);
    }
    /// Forces across every segment's centre and the tip in the coming tick [N].
    void push(double on_each, double at_tip) {
        for (int i = 0; i < segments; ++i) body().addLinkForce(i, {0, btScalar(on_each), 0});
        body().addLinkForce(segments - 1, {0, btScalar(at_tip), 0});
        body().addLinkTorque(segments - 1, {0, 0, btScalar(at_tip * segment / 2)});
    }

    [[nodiscard]] double tip_deflection() {
        double angle = 0, y = 0;
        for (int i = 0; i < segments; ++i) {
            angle += hinge(i).rotation();
            y += segment * std::sin(angle);
        }
        return y;
    }
    [[nodiscard]] double root_rotation() { return hinge(0).rotation(); }
    [[nodiscard]] double fastest() {
        double most = 0;
        for (int i = 0; i < segments; ++i) {
            most = std::max(most, std::abs(double(body().getJointVel(i))));
        }
        return most;
    }

    int segments;
    double segment; ///< length of one [m]
};

} // namespace ductile::test
