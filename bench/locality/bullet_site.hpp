// SPDX-License-Identifier: MIT
//
// Posts of plastic hinges, or that are members, boxes and a ball on a floor in Bullet, looked after
// by a ductile World.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "cpu_time.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/members.hpp"

namespace bench::locality {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;

inline constexpr double frame = 1.0 / 60;

using Hinge = bullet::PlasticHinge<Law>;

class Site {
  public:
    Site(double tolerance, bool ledger) {
        engine_.setGravity(btVector3(0, btScalar(-9.81), 0));
        world_ = std::make_unique<bullet::World>(
            engine_, bullet::WorldParameters{
                         .ledger = ledger, .tolerance = tolerance, .rest_damping = 0, .warn = {}});
        add(floor_, 0, {0, -1, 0});
    }
    ~Site() {
        member_.reset();
        hinges_.clear();
        world_.reset();
        for (auto& body : bodies_) engine_.removeRigidBody(body.get());
    }
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    /// Of pieces of 0.4 m, at x, z.
    void post(double x, double z, int joints) {
        const btVector3 foot(btScalar(x), 0, btScalar(z));
        btRigidBody* below = nullptr;
        const btVector3 half(0, btScalar(0.2), 0);
        for (int i = 0; i < joints; ++i) {
            btRigidBody& piece = add(piece_, 12, foot + btVector3(0, btScalar(0.25 + 0.4 * i), 0));
            piece.setActivationState(DISABLE_DEACTIVATION);
            const Law law(Perfect<double>({.strength = 4000}));
            hinges_.push_back(below != nullptr
                                  ? std::make_unique<Hinge>(piece, *below, at(-half), at(half), law)
                                  : std::make_unique<Hinge>(piece, at(-half), law));
            world_->add(*hinges_.back());
            below = &piece;
        }
    }
    /// One that is clamped at the origin, of 16 segments, and one body until it is struck.
    void member() {
        MemberParameters p;
        p.segments = lumped_segments(2, 60, 16, {1e-3, 1e-3, 2e-3});
        p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
        p.sections.assign(16, UsualAxisJoint(Perfect<double>({.strength = 4000})));
        around_.addChildShape(at({0, 1, 0}), &whole_);
        btTransform upright = at({0, 0, 0}); // it bends in the plane of the blow
        upright.setBasis({0, 1, 0, 0, 0, 1, 1, 0, 0});
        member_ = std::make_unique<bullet::Member>(add(around_, 0, {0, 0, 0}), Member(p), upright,
                                                   MemberBox{0.05, 0.05});
        world_->add(*member_);
    }
    /// Two boxes of 1 m on the floor, one on the other, with a hinge between.
    void pair(double x, double z, bool awake) {
        btRigidBody& lower = add(box_, 100, {btScalar(x), btScalar(0.5), btScalar(z)});
        btRigidBody& upper = add(box_, 100, {btScalar(x), btScalar(1.5), btScalar(z)});
        for (btRigidBody* box : {&lower, &upper}) {
            if (awake) box->setActivationState(DISABLE_DEACTIVATION);
        }
        const btVector3 half(0, btScalar(0.5), 0);
        hinges_.push_back(std::make_unique<Hinge>(upper, lower, at(-half), at(half),
                                                  Law(Perfect<double>({.strength = 4000}))));
        world_->add(*hinges_.back());
    }
    /// In rows of 32, beside the post.
    void boxes(int count, bool awake) {
        for (int i = 0; i < count; ++i) {
            btRigidBody& made =
                add(box_, 100,
                    {btScalar(4 + 1.5 * (i % 32)), btScalar(0.5), btScalar(4 + 1.5 * (i / 32))});
            if (awake) made.setActivationState(DISABLE_DEACTIVATION);
        }
    }
    void strike() {
        btRigidBody& ball = add(ball_, 100, {btScalar(-0.3), btScalar(1.9), 0});
        ball.setGravity({0, 0, 0});
        ball.setActivationState(DISABLE_DEACTIVATION);
        ball.setLinearVelocity({5, 0, 0});
    }
    /// [s]
    double timed_step() {
        const double start = bench::cpu_now();
        world_->step(frame);
        return bench::cpu_now() - start;
    }
    [[nodiscard]] const bullet::World& world() const { return *world_; }

  private:
    static btTransform at(const btVector3& origin) {
        btTransform result;
        result.setIdentity();
        result.setOrigin(origin);
        return result;
    }
    btRigidBody& add(btCollisionShape& shape, double mass, const btVector3& place) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape, inertia);
        info.m_startWorldTransform = at(place);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        engine_.addRigidBody(bodies_.back().get());
        return *bodies_.back();
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld engine_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    btBoxShape floor_{btVector3(500, 1, 500)},
        piece_{btVector3(btScalar(0.05), btScalar(0.2), btScalar(0.05))},
        box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btBoxShape whole_{btVector3(btScalar(0.05), 1, btScalar(0.05))};
    btCompoundShape around_;
    btSphereShape ball_{btScalar(0.2)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::unique_ptr<bullet::World> world_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::unique_ptr<bullet::Member> member_;
};

} // namespace bench::locality
