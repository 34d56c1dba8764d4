// SPDX-License-Identifier: MIT
//
// A field of joints in Bullet, solved by sequential impulse with Bullet's own ten iterations.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <optional>
#include <string_view>
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

    explicit Field(const FieldSettings& settings) : settings_(settings) {
        world_->setGravity(btVector3(0, 0, 0));
        world_->getSimulationIslandManager()->setSplitIslands(settings.split_islands);
        const int bodies = settings.chain ? settings.count + 1 : 2 * settings.count;
        bodies_.reserve(std::size_t(bodies));
        for (int i = 0; i < bodies; ++i) add_body(i);
        if (settings.joint == Joint::plastic_hinge || settings.joint == Joint::plastic_joint) {
            solves_.emplace(*world_, ductile::bullet::WorldParameters{.ledger = false});
        }
        const double before = heap_in_use();
        constraints_.reserve(std::size_t(settings.count));
        for (int i = 0; i < settings.count; ++i) add_joint(i);
        heap_ = heap_in_use() - before;
    }
    /// Joints go before their world, and that before its bodies: Bullet looks for all that is taken
    /// out of it one by one.
    ~Field() {
        constraints_.clear();
        solves_.reset();
        world_.reset();
    }
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;

    void step() { world_->stepSimulation(btScalar(dt), 0); }
    /// Heap that the joints took when they were made and added [bytes].
    [[nodiscard]] double heap() const { return heap_; }

  private:
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
        explicit Ours(btDynamicsWorld& world, Arguments&&... arguments)
            : constraint_(std::forward<Arguments>(arguments)...) {
            constraint_.add_to(world);
        }

      private:
        Constraint constraint_;
    };

    void add_body(int i) {
        btRigidBody::btRigidBodyConstructionInfo info(
            btScalar(body_mass), nullptr, &shape_,
            btVector3(btScalar(body_inertia), btScalar(body_inertia), btScalar(body_inertia)));
        const int side = i % 2 == 0 ? -1 : 1, row = 300; // pairs in a square field
        const int pair = i / 2;
        const btVector3 at =
            settings_.chain ? btVector3(btScalar(2 * half_length * i), 0, 0)
                            : btVector3(btScalar(pair_distance * (pair % row) + side * half_length),
                                        btScalar(pair_distance * (pair / row)), 0);
        info.m_startWorldTransform.setOrigin(at);
        btRigidBody& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_->addRigidBody(&body, 0, 0);
        if (settings_.chain) return;
        body.setAngularVelocity(btVector3(0, 0, btScalar(side * pair_spin)));
        body.setLinearVelocity(btVector3(0, btScalar(pair_spin * half_length), 0));
    }

    void add_joint(int i) {
        const std::size_t first = std::size_t(settings_.chain ? i : 2 * i);
        btRigidBody &a = *bodies_[first], &b = *bodies_[first + 1];
        btTransform in_a, in_b;
        in_a.setIdentity();
        in_b.setIdentity();
        in_a.setOrigin(btVector3(btScalar(half_length), 0, 0));
        in_b.setOrigin(btVector3(btScalar(-half_length), 0, 0));
        const double strength = settings_.strength(i);
        switch (settings_.joint) {
            case Joint::none:
                return;
            case Joint::plastic_hinge:
                constraints_.push_back(std::make_unique<Ours<Hinge>>(
                    *world_, a, b, in_a, in_b,
                    ductile::OneAxisJoint<ductile::Perfect<double>>(
                        ductile::Perfect<double>({.strength = strength}))));
                return;
            case Joint::plastic_joint:
                constraints_.push_back(std::make_unique<Ours<SixAxis>>(
                    *world_, a, b, in_a, in_b,
                    Six(ductile::Ellipsoid<double, 6>(
                            {.capacity = ductile::Vector6<double>::Constant(strength)}),
                        ductile::Perfect<double>({.strength = 1}))));
                return;
            case Joint::hinge_motor: {
                auto hinge = std::make_unique<btHingeConstraint>(a, b, in_a, in_b, true);
                hinge->enableAngularMotor(true, 0, btScalar(strength * dt));
                add(std::move(hinge));
                return;
            }
            case Joint::spring2: {
                auto spring = std::make_unique<btGeneric6DofSpring2Constraint>(a, b, in_a, in_b);
                for (int axis = 0; axis < 6; ++axis) {
                    spring->setLimit(axis, 1, 0);
                    spring->enableSpring(axis, true);
                    spring->setStiffness(axis, 100, false);
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
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    std::optional<btDiscreteDynamicsWorld> world_{std::in_place, &dispatcher_, &broadphase_, &solver_,
                                                  &configuration_};
    std::optional<ductile::bullet::World> solves_; ///< islands of plastic joints
    btSphereShape shape_{btScalar(0.1)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<Held>> constraints_;
    double heap_ = 0;
};

} // namespace bench::cost
