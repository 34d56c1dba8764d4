// SPDX-License-Identifier: MIT
//
// A small Bullet world for the contract suite. Same verbs as ode_rig.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adapters/capability.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/energy_meter.hpp"
#include "ductile/bullet/front_solver.hpp"

namespace ductile::test {

using V3 = Vector3<double>;
using Joint = OneAxisJoint<Perfect<double>>;

class Rig {
  public:
    using Hinge = bullet::PlasticHinge<>;
    using Slider = bullet::PlasticSlider<>;
    using HardeningHinge = bullet::PlasticHinge<OneAxisJoint<Linear<double>>>;
    using Body = btRigidBody*;
    static constexpr const char* engine = "Bullet";
    static constexpr bool meets_surfaces = true; ///< in the solve, not by bounds
    static constexpr bool single = sizeof(btScalar) == sizeof(float);

    /// Upper bound of what rows of a softened world give per force [m/s/N].
    static constexpr double softness = single ? 1e-9 : 1e-13;

    /// Bullet's default solver behind the front of a World, and an independent direct one with
    /// plain rows, which knows no compliance.
    static std::vector<std::string> solvers() { return {"world", "mlcp-dantzig"}; }

    [[nodiscard]] static bool can(const std::string& solver, Capability capability) {
        switch (capability) {
            case Capability::coupled:
                return true;
            case Capability::chains:
                return solver == "world" || !single;
            case Capability::any_rows:
                return solver == "world";
        }
        return false;
    }

    Rig(const std::string& solver, const V3& gravity) {
        if (solver == "world") {
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        } else if (solver == "mlcp-dantzig") {
            solver_ = std::make_unique<btMLCPSolver>(&dantzig_);
        } else {
            throw std::invalid_argument("Rig: no solver " + solver);
        }
        world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_,
                                                           solver_.get(), &configuration_);
        if (solver == "world") front_ = std::make_unique<bullet::FrontHold>(*world_);
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
        for (auto& other : others_) other.remove(*world_, *other.constraint);
        for (auto& constraint : own_) world_->removeConstraint(constraint.get());
        if (contact_ != nullptr) dispatcher_.releaseManifold(contact_);
        for (auto& body : bodies_) world_->removeRigidBody(body.get());
    }

    /// Rows that depend on each other made regular; the front does so itself.
    void soften() { world_->getSolverInfo().m_globalCfm = btScalar(softness); }

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

    /// The engine's own hinge, free about `axis`; null `b`: the static world.
    void pin(Body a, Body b, const V3& anchor, const V3& axis) {
        const btTransform frame = frame_along(anchor, axis);
        if (b != nullptr) {
            own_.push_back(
                std::make_unique<btHingeConstraint>(*a, *b, local(*a, frame), local(*b, frame)));
        } else {
            own_.push_back(std::make_unique<btHingeConstraint>(*a, local(*a, frame)));
        }
        world_->addConstraint(own_.back().get(), true);
    }
    /// The engine's own slider: `a` may only move along `axis`.
    void guide(Body a, const V3& axis) {
        const V3 at = bullet::to_core(a->getCenterOfMassPosition());
        own_.push_back(
            std::make_unique<btSliderConstraint>(*a, local(*a, frame_with_x(at, axis)), true));
        world_->addConstraint(own_.back().get(), true);
    }

    /// Hinge and slider with any law.
    template <class Law>
    auto& hinge_of(Body a, Body b, const V3& anchor, const V3& axis, OneAxisJoint<Law> law) {
        using Constraint = bullet::PlasticHinge<OneAxisJoint<Law>>;
        return own<Constraint>(a, b, frame_along(anchor, axis), std::move(law));
    }
    template <class Law>
    auto& slider_of(Body a, Body b, const V3& axis, OneAxisJoint<Law> law) {
        using Constraint = bullet::PlasticSlider<OneAxisJoint<Law>>;
        return own<Constraint>(a, b, frame_along(position(a), axis), std::move(law));
    }
    /// A joint of six axes, its frame given in the world; null `b`: the static world. `axes`: the
    /// plastic ones, where they are not all.
    template <class Law, class... Axes>
    auto& six_axis(Body a, Body b, const JointFrame<double>& frame, Law joint,
                   const Axes&... axes) {
        return own<bullet::PlasticJoint<Law>>(a, b, to_bullet(frame), std::move(joint), axes...);
    }
    /// Of an iterative solver.
    void set_iterations(int count) { world_->getSolverInfo().m_numIterations = count; }

    /// One inelastic contact between two bodies above each other, that touch where their centres
    /// are `distance` apart along y.
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
    static void apply_force(Body b, const V3& force, const V3& at) {
        b->applyForce(bullet::to_bullet(force), bullet::to_bullet(at - position(b)));
    }
    static void apply_torque(Body b, const V3& torque) {
        b->applyTorque(bullet::to_bullet(torque));
    }
    static V3 position(Body b) { return bullet::to_core(b->getCenterOfMassPosition()); }
    static V3 velocity(Body b) { return bullet::to_core(b->getLinearVelocity()); }
    static V3 spin(Body b) { return bullet::to_core(b->getAngularVelocity()); }
    /// Rotation from the start, less than π [rad].
    static V3 turn(Body b) {
        return rotation_vector<double>(bullet::to_core(b->getCenterOfMassTransform().getBasis()));
    }
    static void set_spin(Body b, const V3& w) { b->setAngularVelocity(bullet::to_bullet(w)); }
    static void set_velocity(Body b, const V3& v) { b->setLinearVelocity(bullet::to_bullet(v)); }
    [[nodiscard]] const Ledger<double>& ledger() const { return meter_->ledger(); }
    void open_ledger() { meter_->open(); }

    /// Where a body is and how it moves, to the bit.
    struct Motion {
        btTransform at;
        btVector3 velocity, spin;
        bool operator==(const Motion& other) const {
            return at == other.at && velocity == other.velocity && spin == other.spin;
        }
    };
    static Motion motion(Body b) {
        return {b->getCenterOfMassTransform(), b->getLinearVelocity(), b->getAngularVelocity()};
    }
    void put_back(Body b, const Motion& motion) const {
        b->setCenterOfMassTransform(motion.at);
        b->setLinearVelocity(motion.velocity);
        b->setAngularVelocity(motion.spin);
    }
    /// What a joint remembers.
    template <class Constraint>
    static auto memory(Constraint& joint) {
        return joint.state();
    }
    template <class Constraint>
    static void put_back(Constraint& joint, const typename Constraint::State& state) {
        joint.restore(state);
    }

  private:
    /// A constraint of any kind and how to take it out of the world again.
    struct Other {
        std::unique_ptr<bullet::PlasticConstraint> constraint;
        void (*remove)(btDynamicsWorld&, bullet::PlasticConstraint&);
    };
    template <class Constraint, class Law, class... Axes>
    Constraint& own(Body a, Body b, const btTransform& frame, Law law, const Axes&... axes) {
        auto constraint =
            b != nullptr
                ? std::make_unique<Constraint>(*a, *b, local(*a, frame), local(*b, frame),
                                               std::move(law), axes...)
                : std::make_unique<Constraint>(*a, local(*a, frame), std::move(law), axes...);
        Constraint& result = *constraint;
        result.add_to(*world_);
        others_.push_back({std::move(constraint), [](btDynamicsWorld& world, auto& made) {
                               static_cast<Constraint&>(made).remove_from(world);
                           }});
        return result;
    }
    static btTransform to_bullet(const JointFrame<double>& frame) {
        const Matrix3<double>& m = frame.axes;
        return btTransform(btMatrix3x3(btScalar(m(0, 0)), btScalar(m(0, 1)), btScalar(m(0, 2)),
                                       btScalar(m(1, 0)), btScalar(m(1, 1)), btScalar(m(1, 2)),
                                       btScalar(m(2, 0)), btScalar(m(2, 1)), btScalar(m(2, 2))),
                           bullet::to_bullet(frame.origin));
    }

    static btTransform frame_along(const V3& origin, const V3& axis) {
        const btVector3 z = bullet::to_bullet(axis.normalized());
        btVector3 x, y;
        btPlaneSpace1(z, x, y);
        const btMatrix3x3 basis(x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z());
        return btTransform(basis, bullet::to_bullet(origin));
    }
    static btTransform frame_with_x(const V3& origin, const V3& axis) {
        const btMatrix3x3 z_along = frame_along(origin, axis).getBasis();
        const btVector3 x = z_along.getColumn(2), y = z_along.getColumn(0),
                        z = z_along.getColumn(1);
        return btTransform(
            btMatrix3x3(x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z()),
            bullet::to_bullet(origin));
    }
    static btTransform local(const btRigidBody& body, const btTransform& frame) {
        return body.getCenterOfMassTransform().inverse() * frame;
    }

    void touch() {
        const auto* upper = static_cast<const btRigidBody*>(contact_->getBody0());
        const auto* lower = static_cast<const btRigidBody*>(contact_->getBody1());
        const btVector3 top = upper->getCenterOfMassPosition(),
                        base = lower->getCenterOfMassPosition();
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
    btDantzigSolver dantzig_;
    std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::unique_ptr<bullet::FrontHold> front_;
    btSphereShape shape_{1};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::vector<std::unique_ptr<Slider>> sliders_;
    std::unique_ptr<HardeningHinge> hardening_;
    std::vector<Other> others_;
    std::vector<std::unique_ptr<btTypedConstraint>> own_;
    std::unique_ptr<bullet::EnergyMeter> meter_;
    btPersistentManifold* contact_ = nullptr;
    double contact_distance_ = 0;
};

} // namespace ductile::test
