// SPDX-License-Identifier: MIT
//
// A scene in Bullet. Contacts are those of the scene alone (charpy/bullet_contacts.hpp); split
// impulse corrects positions apart from velocities at any depth.
//
// With a tolerance the world is a ductile::bullet::World and a step a frame.
#pragma once

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "charpy/bullet_contacts.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/world.hpp"
#include "engines/settings.hpp"
#include "methods/bullet/all.hpp"

namespace bench {

class BulletWorld {
  public:
    static constexpr std::string_view engine = "bullet";
    static constexpr std::string_view precision =
        sizeof(btScalar) == sizeof(double) ? "double" : "float";
    static constexpr int default_iterations = 10; ///< of btContactSolverInfo
    static constexpr std::string_view exact_solver =
        "si"; ///< of our joints, whose islands a front solves
    static constexpr bool has_frames = true;
    static constexpr std::string_view default_solver = "si"; ///< of the engine
    static constexpr std::array<std::string_view, 2> solvers_of_peers{"si", "mlcp"};
    static constexpr std::array<SolverName, 3> solvers{
        {{"mlcp", Iterations::fallback}, {"si", Iterations::solve}, {"nncg", Iterations::solve}}};

    [[nodiscard]] static bool has(std::string_view method) {
        return std::any_of(bullet_methods::all.begin(), bullet_methods::all.end(),
                           [&](const auto& entry) { return entry.first == method; });
    }

    /// @throws std::invalid_argument where the solver or the method is not there.
    BulletWorld(const Scene& scene, const Settings& settings) : scene_(scene) {
        make_world(settings);
        for (const BodySpec& body : scene.bodies) add_body(body);
        world_->addRigidBody(&ground_);
        for (const GuideSpec& guide : scene.guides) add_guide(guide);
        for (const JointSpec& joint : scene.joints) add_joint(joint, settings.method);
        for (const ContactSpec& contact : scene_.contacts) add_contact(contact);
    }
    ~BulletWorld() {
        holders_.clear();
        keeper_.reset();
        for (auto& guide : guides_) world_->removeConstraint(guide.get());
        world_->removeRigidBody(&ground_);
        for (auto& body : bodies_) world_->removeRigidBody(body.get());
    }
    BulletWorld(const BulletWorld&) = delete;
    BulletWorld& operator=(const BulletWorld&) = delete;

    /// With a tolerance a frame.
    void step(double dt) {
        if (!keeper_) world_->getSolverInfo().m_erp = btScalar(drift_correction(dt));
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const Vector& force = scene_.bodies[i].force;
            if (!force.isZero()) bodies_[i]->applyCentralForce(ductile::bullet::to_bullet(force));
        }
        for (auto& holder : holders_) holder->before_step(dt);
        if (keeper_) {
            keeper_->step(dt);
        } else {
            world_->stepSimulation(btScalar(dt), 0);
        }
        for (auto& holder : holders_) holder->after_step(dt);
    }

    [[nodiscard]] BodyState state(int index) const {
        return index == ground ? BodyState{} : state_of(*bodies_[std::size_t(index)]);
    }
    [[nodiscard]] const std::vector<std::unique_ptr<Holder>>& holders() const { return holders_; }
    /// What frames with a tolerance say of themselves; null without one.
    [[nodiscard]] const ductile::RunReport* run() const {
        return keeper_ ? &keeper_->run() : nullptr;
    }

  private:
    void make_world(const Settings& settings) {
        if (settings.solver == "mlcp") {
            dantzig_ = std::make_unique<btDantzigSolver>();
            solver_ = std::make_unique<btMLCPSolver>(dantzig_.get());
        } else if (settings.solver == "si") {
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        } else if (settings.solver == "nncg") {
            solver_ = std::make_unique<btNNCGConstraintSolver>();
        } else {
            throw std::invalid_argument("solver = " + settings.solver +
                                        ": must be mlcp, si or nncg");
        }
        world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_,
                                                           solver_.get(), &configuration_);
        if (settings.in_frames()) {
            keeper_ = std::make_unique<ductile::bullet::World>(
                *world_, ductile::bullet::WorldParameters{
                             .ledger = false, .tolerance = settings.tolerance, .warn = nullptr});
        } else {
            front_ = std::make_unique<ductile::bullet::FrontHold>(*world_); // islands of our joints
        }
        dispatcher_.filter(*broadphase_.getOverlappingPairCache());
        dispatcher_.make_ahead(settings.in_frames());
        dispatcher_.make_unlike(scene_.contact_compliance > 0);
        world_->setGravity(ductile::bullet::to_bullet(scene_.gravity));
        btContactSolverInfo& info = world_->getSolverInfo();
        if (settings.iterations > 0) info.m_numIterations = settings.iterations;
        info.m_splitImpulse = true;
        info.m_splitImpulsePenetrationThreshold = btScalar(1e30); // at any depth
        info.m_globalCfm = btScalar(scene_.contact_compliance);
    }

    void add_body(const BodySpec& spec) {
        using ductile::bullet::to_bullet;
        btCollisionShape& shape =
            *shapes_.emplace_back(std::make_unique<btSphereShape>(btScalar(spec.radius)));
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(spec.mass), nullptr, &shape,
                                                      to_bullet(spec.inertia));
        const Rotation& r = spec.start.rotation;
        btMatrix3x3 basis;
        for (int row = 0; row < 3; ++row) basis[row] = to_bullet(r.row(row).transpose());
        info.m_startWorldTransform = btTransform(basis, to_bullet(spec.start.position));
        btRigidBody& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_->addRigidBody(&body);
        if (spec.weightless) body.setGravity(btVector3(0, 0, 0));
        body.setLinearVelocity(to_bullet(spec.start.velocity));
        body.setAngularVelocity(to_bullet(spec.start.spin));
    }
    [[nodiscard]] btRigidBody& body(int index) {
        return index == ground ? btTypedConstraint::getFixedBody() : *bodies_[std::size_t(index)];
    }
    [[nodiscard]] static btTransform in_body(const btRigidBody& body, const btTransform& frame) {
        return body.getCenterOfMassTransform().inverse() * frame;
    }

    void add_guide(const GuideSpec& guide) {
        const btTransform frame = frame_along(guide.anchor, guide.axis);
        btRigidBody &a = body(guide.body), &b = body(ground);
        std::unique_ptr<btTypedConstraint> constraint;
        if (guide.motion == Motion::turns) {
            constraint = std::make_unique<btHingeConstraint>(a, b, in_body(a, frame),
                                                             in_body(b, frame), true);
        } else {
            // btSliderConstraint's lateral rows are soft and bounce, and btGeneric6DofConstraint
            // does not hold a locked axis whose error is exactly zero; lower > upper is free
            auto slider = std::make_unique<btGeneric6DofSpring2Constraint>(
                a, b, in_body(a, frame), in_body(b, frame));
            for (int axis = 0; axis < 6; ++axis) slider->setLimit(axis, axis == 2 ? 1 : 0, 0);
            constraint = std::move(slider);
        }
        world_->addConstraint(constraint.get(), true);
        guides_.push_back(std::move(constraint));
    }

    void add_joint(const JointSpec& joint, std::string_view method) {
        const btTransform frame = frame_along(joint.anchor, joint.axis);
        btRigidBody &a = body(joint.a), &b = body(joint.b);
        const BulletSite site{*world_,
                              keeper_.get(),
                              a,
                              b,
                              in_body(a, frame),
                              in_body(b, frame),
                              joint,
                              effective_mass(scene_, joint)};
        for (const auto& [name, make] : bullet_methods::all) {
            if (name == method) {
                holders_.push_back(make(site));
                return;
            }
        }
        throw std::invalid_argument("method = " + std::string(method) + ": not there in Bullet");
    }

    void add_contact(const ContactSpec& spec) {
        const btRigidBody& a = spec.a == ground ? ground_ : body(spec.a);
        charpy::BulletContact contact{
            .a = &a, .b = &body(spec.b), .thickness = spec.thickness, .touch = [this, &spec](double margin) {
                return spec.touch(state(spec.a), state(spec.b), margin);
            }};
        if (spec.approach) {
            contact.closing_speed = [this, &spec] {
                return spec.approach(state(spec.a), state(spec.b)).closing_speed;
            };
        }
        dispatcher_.add(std::move(contact));
    }

    Scene scene_;
    btDefaultCollisionConfiguration configuration_;
    charpy::BulletContacts dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    std::unique_ptr<btMLCPSolverInterface> dantzig_;
    std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::unique_ptr<ductile::bullet::FrontHold> front_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_; ///< for the broadphase
    btSphereShape ground_shape_{1};                         ///< all contacts are within it
    /// What touches the ground: Bullet's fixed body is in no world.
    btRigidBody ground_{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ground_shape_)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> guides_;
    std::vector<std::unique_ptr<Holder>> holders_;
    std::unique_ptr<ductile::bullet::World> keeper_; ///< of frames with a tolerance
};

} // namespace bench
