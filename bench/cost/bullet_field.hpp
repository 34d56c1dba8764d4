// SPDX-License-Identifier: MIT
//
// A field of joints in Bullet, solved by sequential impulse with Bullet's own ten iterations.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "cost/field.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/plastic_joint.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/surface/ellipsoid.hpp"

namespace bench::cost {

class Field {
    using Hinge = ductile::bullet::PlasticHinge<>;
    using Six = ductile::CoupledJoint<ductile::Ellipsoid<double, 6>, ductile::Perfect<double>>;
    using SixAxis = ductile::bullet::PlasticJoint<Six>;

  public:
    static constexpr std::string_view engine = "bullet";
    static constexpr std::string_view precision =
        sizeof(btScalar) == sizeof(double) ? "double" : "float";
    static constexpr bool splits_by_choice = true;

    [[nodiscard]] static std::string_view solver(const FieldSettings&) { return "si"; }
    [[nodiscard]] static std::size_t size_of(Joint joint) {
        switch (joint) {
            case Joint::none:
                return 0;
            case Joint::plastic_hinge:
                return sizeof(Hinge);
            case Joint::plastic_joint:
                return sizeof(SixAxis);
            case Joint::hinge_motor:
                return sizeof(btHingeConstraint);
            case Joint::spring2:
                return sizeof(btGeneric6DofSpring2Constraint);
            case Joint::fixed:
                return sizeof(btFixedConstraint);
        }
        return 0;
    }
    [[nodiscard]] static bool has(Joint joint) {
        return joint == Joint::none || size_of(joint) > 0;
    }
    [[nodiscard]] static bool has(SetUp) { return true; }

    explicit Field(const FieldSettings& settings) : Field(settings, plan_of(settings)) {}
    /// Joints go before their world, and that before its bodies: Bullet looks for all that is taken
    /// out of it one by one.
    ~Field() {
        constraints_.clear();
        keeper_.reset();
        world_.reset();
    }
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;

    void step() {
        for (const auto& [body, force] : pushed_) body->applyCentralForce(force);
        if (settings_.ledger) {
            keeper_->step(dt_);
        } else {
            world_->stepSimulation(btScalar(dt_), 0);
        }
    }
    /// Heap that the joints took when they were made and added [bytes].
    [[nodiscard]] double heap() const { return heap_; }

  private:
    Field(const FieldSettings& settings, const Plan& plan) : settings_(settings), dt_(plan.dt) {
        world_->setGravity(ductile::bullet::to_bullet(plan.gravity));
        world_->getSimulationIslandManager()->setSplitIslands(settings.split_islands);
        bodies_.reserve(plan.bodies.size() + 1);
        for (const Body& body : plan.bodies) {
            add(body, plan.floor ? static_cast<btCollisionShape&>(cube_) : ball_, plan.floor);
        }
        if (plan.floor) add({.at = {0, 0, -1}, .mass = 0, .inertia = V3::Zero()}, floor_, true);
        if (settings.joint == Joint::plastic_hinge || settings.joint == Joint::plastic_joint) {
            keeper_.emplace(*world_, ductile::bullet::WorldParameters{.ledger = settings.ledger,
                                                                      .warn = nullptr});
        }
        const double before = heap_in_use();
        constraints_.reserve(plan.links.size());
        for (const Link& link : plan.links) connect(link, plan);
        heap_ = heap_in_use() - before;
    }

    /// A constraint that stays in the world until that is gone.
    class Held {
      public:
        virtual ~Held() = default;
    };
    template <class Constraint>
    class Engines final : public Held {
      public:
        Engines(btDynamicsWorld& world, std::unique_ptr<Constraint> constraint)
            : constraint_(std::move(constraint)) {
            world.addConstraint(constraint_.get(), true);
        }

      private:
        std::unique_ptr<Constraint> constraint_;
    };
    template <class Constraint>
    class Ours final : public Held {
      public:
        template <class... Arguments>
        explicit Ours(Field& field, Arguments&&... arguments)
            : constraint_(std::forward<Arguments>(arguments)...) {
            if (field.settings_.ledger) {
                field.keeper_->add(constraint_);
            } else {
                constraint_.add_to(*field.world_);
            }
        }

      private:
        Constraint constraint_;
    };

    void add(const Body& body, btCollisionShape& shape, bool collides) {
        using ductile::bullet::to_bullet;
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(body.mass), nullptr, &shape,
                                                      to_bullet(body.inertia));
        info.m_startWorldTransform.setOrigin(to_bullet(body.at));
        btRigidBody& made = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        made.setActivationState(DISABLE_DEACTIVATION);
        made.setFriction(btScalar(floor_friction));
        if (collides) {
            world_->addRigidBody(&made);
        } else {
            world_->addRigidBody(&made, 0, 0);
        }
        made.setAngularVelocity(to_bullet(body.spin));
        made.setLinearVelocity(to_bullet(body.velocity));
        if (!body.push.isZero()) pushed_.emplace_back(&made, to_bullet(body.push));
    }

    [[nodiscard]] btRigidBody& body(int i) const {
        return i == ground ? btTypedConstraint::getFixedBody() : *bodies_[std::size_t(i)];
    }
    void connect(const Link& link, const Plan& plan) {
        btRigidBody &a = body(link.a), &b = body(link.b);
        const auto frame_in = [&link](const btRigidBody& of) {
            btTransform frame = btTransform::getIdentity();
            frame.setOrigin(ductile::bullet::to_bullet(link.at) - of.getCenterOfMassPosition());
            return frame;
        };
        const btTransform in_a = frame_in(a), in_b = frame_in(b);
        const double strength = link.strength;
        switch (settings_.joint) {
            case Joint::none:
                return;
            case Joint::plastic_hinge:
                constraints_.push_back(std::make_unique<Ours<Hinge>>(
                    *this, a, b, in_a, in_b,
                    ductile::OneAxisJoint<ductile::Perfect<double>>(
                        ductile::Perfect<double>({.strength = strength}))));
                return;
            case Joint::plastic_joint:
                constraints_.push_back(std::make_unique<Ours<SixAxis>>(
                    *this, a, b, in_a, in_b,
                    Six(ductile::Ellipsoid<double, 6>(
                            {.capacity = ductile::Vector6<double>::Constant(strength)}),
                        ductile::Perfect<double>({.strength = 1}))));
                return;
            case Joint::hinge_motor: {
                auto hinge = std::make_unique<btHingeConstraint>(a, b, in_a, in_b, true);
                hinge->enableAngularMotor(true, 0, btScalar(strength * dt_));
                add(std::move(hinge));
                return;
            }
            case Joint::spring2: {
                auto spring = std::make_unique<btGeneric6DofSpring2Constraint>(a, b, in_a, in_b);
                for (int axis = 0; axis < 6; ++axis) {
                    spring->setLimit(axis, 1, 0);
                    spring->enableSpring(axis, true);
                    spring->setStiffness(axis, btScalar(plan.stiffness), false);
                    spring->setDamping(axis, 0, false);
                }
                spring->setEquilibriumPoint();
                add(std::move(spring));
                return;
            }
            case Joint::fixed:
                add(std::make_unique<btFixedConstraint>(a, b, in_a, in_b));
                return;
        }
    }
    template <class Constraint>
    void add(std::unique_ptr<Constraint> constraint) {
        constraints_.push_back(
            std::make_unique<Engines<Constraint>>(*world_, std::move(constraint)));
    }

    FieldSettings settings_;
    double dt_; ///< [s]
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    std::optional<btDiscreteDynamicsWorld> world_{std::in_place, &dispatcher_, &broadphase_,
                                                  &solver_, &configuration_};
    std::optional<ductile::bullet::World> keeper_; ///< of islands of plastic joints
    btSphereShape ball_{btScalar(0.1)};
    btBoxShape cube_{
        btVector3(btScalar(half_length), btScalar(half_length), btScalar(half_length))};
    btBoxShape floor_{btVector3(1000, 1000, 1)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::pair<btRigidBody*, btVector3>> pushed_; ///< and their forces [N]
    std::vector<std::unique_ptr<Held>> constraints_;
    double heap_ = 0;
};

} // namespace bench::cost
