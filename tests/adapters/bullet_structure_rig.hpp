// SPDX-License-Identifier: MIT
//
// A Bullet world with a floor as a user makes one, for structures: Bullet's default solver, ten
// iterations, a default World. Same verbs as ode_structure_rig.hpp.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/bullet_engine.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/structure.hpp"
#include "ductile/bullet/structure_in_time.hpp"
#include "ductile/bullet/structure_snapshot.hpp"
#include "ductile/joint/usual_joints.hpp"

namespace ductile::test {

namespace engine = ductile::bullet;

using Snapshot = bullet::StructureSnapshot;

/// Of the engine's: a ball, a hinge about y, a weld.
enum class OwnJoint { point, hinge, weld };

class StructureRig {
  public:
    using Body = btRigidBody*;
    using Joint = bullet::PlasticJoint<UsualSixAxisJoint>;
    static constexpr bool single = sizeof(btScalar) == sizeof(float);
    static constexpr bool in_frames = true; ///< a default World's steps
    /// How deep into the floor a body is made that is to rest on it [m].
    static constexpr double layer = 0;

    explicit StructureRig(double gravity = 9.81, bullet::WorldParameters parameters = {}) {
        engine_.setGravity(btVector3(0, 0, btScalar(-gravity)));
        parameters.warn = [this](const std::string& line) { lines_.push_back(line); };
        world_ = std::make_unique<bullet::World>(engine_, parameters);
        box(0, {50, 50, 1}, {0, 0, -1})->setFriction(1);
    }
    ~StructureRig() {
        joints_.clear();
        for (const auto& joint : own_joints_) engine_.removeConstraint(joint.get());
        for (const Own& own : own_) engine_.removeRigidBody(own.body.get());
    }
    StructureRig(const StructureRig&) = delete;
    StructureRig& operator=(const StructureRig&) = delete;

    [[nodiscard]] bullet::World& world() { return *world_; }

    /// To end before this does.
    [[nodiscard]] std::unique_ptr<bullet::Structure> build(
        const StructureModel& model, const std::vector<bullet::OwnBody>& own = {}) {
        return std::make_unique<bullet::Structure>(*world_, model, own);
    }
    [[nodiscard]] std::unique_ptr<bullet::StructureInTime> build_in_time(
        const StructureModel& model) {
        return std::make_unique<bullet::StructureInTime>(*world_, model);
    }
    void forget() {} // what was built is gone: the engine knows
    /// That touches others; a mass of zero: static.
    Body box(double mass, const Vector3<double>& half, const Vector3<double>& at) {
        Own& own = own_.emplace_back();
        own.shape = std::make_unique<btBoxShape>(bullet::to_bullet(half));
        btVector3 inertia(0, 0, 0);
        if (mass > 0) own.shape->calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, own.shape.get(),
                                                      inertia);
        info.m_startWorldTransform.setOrigin(bullet::to_bullet(at));
        own.body = std::make_unique<btRigidBody>(info);
        engine_.addRigidBody(own.body.get());
        return own.body.get();
    }
    /// Between boxes, with the axes of the world.
    Joint& connect(Body a, Body b, const Vector3<double>& at, const UsualSixAxisJoint& joint) {
        const btTransform frame(btMatrix3x3::getIdentity(), bullet::to_bullet(at));
        joints_.push_back(
            std::make_unique<Joint>(*a, *b, a->getCenterOfMassTransform().inverse() * frame,
                                    b->getCenterOfMassTransform().inverse() * frame, joint));
        world_->add(*joints_.back());
        return *joints_.back();
    }
    /// A body fixed to a member at `share` of its axis by a joint of the engine's; null: the
    /// ground.
    btTypedConstraint* const* hang(bullet::StructureInTime& frame, const std::string& member,
                                   double share, Body body, OwnJoint kind) {
        auto made = std::make_unique<btTypedConstraint*>(nullptr);
        btTypedConstraint** const now = made.get();
        hung_.push_back(std::move(made));
        const btTransform at(btMatrix3x3::getIdentity(),
                             bullet::to_bullet(frame.place(member, share)));
        const btTransform in_body =
            body == nullptr ? at : body->getCenterOfMassTransform().inverse() * at;
        frame.attach(member, share, [=](btRigidBody& piece, const btTransform& place) {
            auto joint = join(piece, place, body, in_body, kind);
            *now = joint.get();
            return joint;
        });
        return now;
    }
    btTypedConstraint* const* hang(bullet::Structure& frame, const std::string& member,
                                   double share, Body body, OwnJoint kind) {
        const btTransform at(btMatrix3x3::getIdentity(),
                             bullet::to_bullet(frame.place(member, share)));
        btRigidBody& piece = *frame.body(frame.plan().body(member));
        own_joints_.push_back(join(piece, piece.getCenterOfMassTransform().inverse() * at, body,
                                   body->getCenterOfMassTransform().inverse() * at, kind));
        engine_.addConstraint(own_joints_.back().get(), true);
        hung_.push_back(std::make_unique<btTypedConstraint*>(own_joints_.back().get()));
        return hung_.back().get();
    }
    static void let_go(btTypedConstraint* const* joint, bool off = true) {
        (*joint)->setEnabled(!off);
    }
    void set_gravity(const Vector3<double>& g) { engine_.setGravity(bullet::to_bullet(g)); }
    void set_friction(double coefficient) {
        each([&](btRigidBody& body) { body.setFriction(btScalar(coefficient)); });
    }

    void step(double dt) {
        world_->step(dt);
        events_ += world_->events().size();
    }
    void run(double time, double dt) {
        for (int i = 0, n = int(time / dt + 0.5); i < n; ++i) step(dt);
    }
    /// By forces in proportion to mass and velocity [1/s].
    void damp(double rate) {
        const auto share = btScalar(1 - std::exp(-rate)); // that Bullet takes in a second
        each([&](btRigidBody& body) { body.setDamping(share, share); });
    }
    void keep_awake() {
        each([](btRigidBody& body) { body.setActivationState(DISABLE_DEACTIVATION); });
    }
    void let_sleep() {
        each([](btRigidBody& body) {
            if (body.getActivationState() != DISABLE_DEACTIVATION) return;
            body.forceActivationState(ACTIVE_TAG);
        });
    }
    [[nodiscard]] bool asleep() {
        bool all = true;
        each([&](btRigidBody& body) { all = all && !body.isActive(); });
        return all;
    }
    [[nodiscard]] double speed() {
        double most = 0;
        each([&](btRigidBody& body) {
            most = std::max(most, double(body.getLinearVelocity().length()));
        });
        return most;
    }
    [[nodiscard]] static double mass(Body body) { return double(body->getMass()); }
    [[nodiscard]] static Vector3<double> place(Body body) {
        return bullet::to_core(body->getCenterOfMassPosition());
    }
    [[nodiscard]] static bool moves(Body body) { return !body->isStaticOrKinematicObject(); }
    [[nodiscard]] static bool asleep(Body body) { return !body->isActive(); }
    [[nodiscard]] static BodyMotion motion(Body body) {
        return {bullet::to_core(body->getLinearVelocity()),
                bullet::to_core(body->getAngularVelocity())};
    }
    [[nodiscard]] static Matrix3<double> inertia(Body body) {
        return bullet::to_core(body->getInvInertiaTensorWorld().inverse());
    }
    static void set_mass(Body body, double mass) {
        body->setMassProps(btScalar(mass), body->getLocalInertia());
    }
    static void apply_force(Body body, const Vector3<double>& force, const Vector3<double>& at) {
        body->applyForce(bullet::to_bullet(force), bullet::to_bullet(at - place(body)));
    }
    static void set_velocity(Body body, const Vector3<double>& velocity,
                             const Vector3<double>& spin = {0, 0, 0}) {
        body->setLinearVelocity(bullet::to_bullet(velocity));
        body->setAngularVelocity(bullet::to_bullet(spin));
    }

    [[nodiscard]] std::size_t events() const { return events_; }
    /// Warnings.
    [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

  private:
    struct Own {
        std::unique_ptr<btBoxShape> shape;
        std::unique_ptr<btRigidBody> body;
    };
    [[nodiscard]] static std::unique_ptr<btTypedConstraint> join(btRigidBody& a,
                                                                 const btTransform& in_a, Body b,
                                                                 const btTransform& in_b,
                                                                 OwnJoint kind) {
        btRigidBody& other = b == nullptr ? btTypedConstraint::getFixedBody() : *b;
        if (kind == OwnJoint::point) {
            return std::make_unique<btPoint2PointConstraint>(a, other, in_a.getOrigin(),
                                                             in_b.getOrigin());
        }
        if (kind == OwnJoint::weld) {
            return std::make_unique<btFixedConstraint>(a, other, in_a, in_b);
        }
        // Bullet's turns about z
        const btTransform y(btQuaternion(btVector3(1, 0, 0), -SIMD_HALF_PI));
        return std::make_unique<btHingeConstraint>(a, other, in_a * y, in_b * y);
    }
    /// All that move.
    template <class Visit>
    void each(const Visit& visit) {
        for (int i = 0; i < engine_.getNumCollisionObjects(); ++i) {
            btRigidBody* body = btRigidBody::upcast(engine_.getCollisionObjectArray()[i]);
            if (!body->isStaticOrKinematicObject()) visit(*body);
        }
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld engine_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<Own> own_;
    std::vector<std::string> lines_;
    std::unique_ptr<bullet::World> world_;
    std::vector<std::unique_ptr<Joint>> joints_;
    std::vector<std::unique_ptr<btTypedConstraint>> own_joints_;
    std::vector<std::unique_ptr<btTypedConstraint*>> hung_; ///< as they are now
    std::size_t events_ = 0;
};

} // namespace ductile::test
