// SPDX-License-Identifier: MIT
//
// A scene in Bullet. Contact points are handed over as manifolds; split impulse corrects positions
// apart from velocities at any depth; bodies do not collide otherwise.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
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
        for (const GuideSpec& guide : scene.guides) add_guide(guide);
        for (const JointSpec& joint : scene.joints) add_joint(joint, settings.method);
        for (const ContactSpec& contact : scene.contacts) {
            btRigidBody& a = contact.a == ground ? ground_ : body(contact.a);
            manifolds_.push_back(dispatcher_.getNewManifold(&a, &body(contact.b)));
        }
        made_.resize(manifolds_.size());
        if (settings.leapfrog) {
            keeper_ = std::make_unique<ductile::bullet::World>(
                *world_, ductile::bullet::WorldParameters{
                             .ledger = false, .leapfrog = true, .warn = nullptr});
        }
    }
    ~BulletWorld() {
        keeper_.reset();
        for (btPersistentManifold* manifold : manifolds_) dispatcher_.releaseManifold(manifold);
        holders_.clear();
        for (auto& guide : guides_) world_->removeConstraint(guide.get());
        for (auto& body : bodies_) world_->removeRigidBody(body.get());
    }
    BulletWorld(const BulletWorld&) = delete;
    BulletWorld& operator=(const BulletWorld&) = delete;

    void step(double dt) {
        world_->getSolverInfo().m_erp = btScalar(drift_correction(dt));
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const Vector& force = scene_.bodies[i].force;
            if (!force.isZero()) bodies_[i]->applyCentralForce(ductile::bullet::to_bullet(force));
        }
        for (auto& holder : holders_) holder->before_step(dt);
        collide(dt);
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
    /// True where the contact was made in the last step.
    [[nodiscard]] bool touching(std::size_t contact) const { return made_[contact]; }

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
        front_ = std::make_unique<ductile::bullet::FrontHold>(*world_); // islands of our joints
        world_->setGravity(ductile::bullet::to_bullet(scene_.gravity));
        btContactSolverInfo& info = world_->getSolverInfo();
        if (settings.iterations > 0) info.m_numIterations = settings.iterations;
        info.m_splitImpulse = true;
        info.m_splitImpulsePenetrationThreshold = btScalar(1e30); // at any depth
        info.m_globalCfm = btScalar(scene_.contact_compliance);
        // manifolds made by hand do not merge islands: one island for all
        world_->getSimulationIslandManager()->setSplitIslands(false);
    }

    void add_body(const BodySpec& spec) {
        using ductile::bullet::to_bullet;
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(spec.mass), nullptr, &shape_,
                                                      to_bullet(spec.inertia));
        const Rotation& r = spec.start.rotation;
        btMatrix3x3 basis;
        for (int row = 0; row < 3; ++row) basis[row] = to_bullet(r.row(row).transpose());
        info.m_startWorldTransform = btTransform(basis, to_bullet(spec.start.position));
        btRigidBody& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_->addRigidBody(&body, 0, 0);
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
            // btSliderConstraint's lateral rows are soft and bounce; limits with lower > upper are
            // free
            auto slider = std::make_unique<btGeneric6DofConstraint>(a, b, in_body(a, frame),
                                                                    in_body(b, frame), true);
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

    /// Fills the manifolds with this step's contact points; impulses carry over for warm starting.
    void collide(double dt) {
        int count = 0;
        for (std::size_t i = 0; i < manifolds_.size(); ++i) {
            const ContactSpec& spec = scene_.contacts[i];
            const BodyState a = state(spec.a), b = state(spec.b);
            const double closing = spec.approach ? spec.approach(a, b).closing_speed : 0;
            const charpy::EdgeContact contact =
                spec.touch(a, b, charpy::reach(made_[i], spec.thickness, closing, dt));
            made_[i] = contact.count > 0;
            btPersistentManifold& manifold = *manifolds_[i];
            std::array<btScalar, 2> impulse{};
            for (int k = 0; k < std::min(contact.count, manifold.getNumContacts()); ++k) {
                impulse[std::size_t(k)] = manifold.getContactPoint(k).m_appliedImpulse;
            }
            manifold.clearManifold();
            for (int k = 0; k < contact.count; ++k) {
                add_point(manifold, contact.points[std::size_t(k)], impulse[std::size_t(k)],
                          scene_.contact_compliance > 0 ? 1e-6 * (1 + 0.37 * count++) * dt : 0);
            }
        }
    }
    static void add_point(btPersistentManifold& manifold, const charpy::ContactPoint& point,
                          btScalar impulse, double unlike) {
        using ductile::bullet::to_bullet;
        const btVector3 on_a = to_bullet(point.position);
        const btVector3 on_b = to_bullet(point.position - point.gap * point.normal);
        const auto local = [](const btCollisionObject* body, const btVector3& at) {
            return body->getWorldTransform().invXform(at);
        };
        btManifoldPoint entry(local(manifold.getBody0(), on_a), local(manifold.getBody1(), on_b),
                              to_bullet(point.normal), btScalar(point.gap + unlike));
        entry.m_positionWorldOnA = on_a;
        entry.m_positionWorldOnB = on_b;
        entry.m_appliedImpulse = impulse;
        manifold.addManifoldPoint(entry);
    }

    Scene scene_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    std::unique_ptr<btMLCPSolverInterface> dantzig_;
    std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::unique_ptr<ductile::bullet::FrontHold> front_;
    btSphereShape shape_{1};
    /// What touches the ground: Bullet's fixed body has no shape, and manifolds ask for one.
    btRigidBody ground_{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape_)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> guides_;
    std::vector<std::unique_ptr<Holder>> holders_;
    std::vector<btPersistentManifold*> manifolds_;
    std::vector<bool> made_;
    std::unique_ptr<ductile::bullet::World> keeper_; ///< of a run that leapfrogs
};

} // namespace bench
