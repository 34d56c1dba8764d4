// SPDX-License-Identifier: MIT
//
// A Bullet world that the tests of members put things into, and the two scenes that most of them
// need.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/bullet_engine.hpp"
#include "adapters/soft_head.hpp"
#include "core/member/strips.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/member_snapshot.hpp"
#include "ductile/bullet/members.hpp"

namespace ductile::test {

constexpr bool rough = sizeof(btScalar) == sizeof(float);
constexpr int most_segments = 20;
inline const btTransform here = btTransform::getIdentity();

/// Outlives its joints and members.
struct Rig : BulletEngine {
    std::vector<std::unique_ptr<btTypedConstraint>> constraints;

    explicit Rig(const btVector3& gravity = {0, 0, 0}) : BulletEngine(gravity) {
        engine.getSolverInfo().m_splitImpulsePenetrationThreshold = 1;
    }
    ~Rig() {
        for (auto& constraint : constraints) engine.removeConstraint(constraint.get());
    }

    btCollisionShape* shape(std::unique_ptr<btCollisionShape> made) {
        shapes.push_back(std::move(made));
        return shapes.back().get();
    }
    /// `group` 0: it meets nothing.
    btRigidBody& body(double mass, const btVector3& inertia, const btVector3& at,
                      btCollisionShape* shape = nullptr, int group = 0, int mask = 0) {
        if (shape == nullptr) shape = this->shape(std::make_unique<btSphereShape>(btScalar(0.01)));
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape, inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        engine.addRigidBody(bodies.back().get(), group, mask);
        bodies.back()->setActivationState(DISABLE_DEACTIVATION);
        bodies.back()->setFriction(0);
        return *bodies.back();
    }
    /// A box along z from the origin on, half a width `half` wide.
    btCollisionShape* post(double half, double length) {
        auto around = std::make_unique<btCompoundShape>();
        around->addChildShape(
            btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(length / 2))),
            shape(std::make_unique<btBoxShape>(
                btVector3(btScalar(half), btScalar(half), btScalar(length / 2)))));
        return shape(std::move(around));
    }
};

constexpr int everything = btBroadphaseProxy::AllFilter, usual = btBroadphaseProxy::DefaultFilter;

/// The same segments, each a body of its own.
struct AlwaysJointed {
    using Hinge = bullet::PlasticHinge<UsualAxisJoint>;

    AlwaysJointed(Rig& rig, bullet::World& world, const Member& member) {
        // hinges turn about z, members bend about x
        const btMatrix3x3 turned(0, 0, 1, 1, 0, 0, 0, 1, 0);
        double place = 0;
        btRigidBody* before = nullptr;
        for (int k = 0; k < member.segments(); ++k) {
            const MemberSegment& segment = member.segment(k);
            if (segment.held) continue;
            const auto half = btScalar(segment.length / 2);
            btRigidBody& body =
                rig.body(segment.mass,
                         {btScalar(segment.inertia[0]), btScalar(segment.inertia[1]),
                          btScalar(segment.inertia[2])},
                         {0, 0, btScalar(place) + half});
            const btTransform start(turned, {0, 0, -half});
            if (k > 0) {
                const bool ground = before == nullptr;
                const auto half_before = btScalar(member.segment(k - 1).length / 2);
                hinges.push_back(std::make_unique<Hinge>(
                    body, ground ? btTypedConstraint::getFixedBody() : *before, start,
                    btTransform(turned, {0, 0, ground ? btScalar(0) : half_before}),
                    member.section(k - 1)));
                world.add(*hinges.back());
            }
            before = &body;
            bodies.push_back(before);
            place += segment.length;
        }
        last = before;
    }
    [[nodiscard]] double absorbed_energy() const {
        double sum = 0;
        for (const auto& hinge : hinges) sum += hinge->absorbed_energy();
        return sum;
    }

    std::vector<std::unique_ptr<Hinge>> hinges;
    std::vector<btRigidBody*> bodies;
    btRigidBody* last = nullptr;
};

using Snapshot = bullet::MemberSnapshot;
/// Across a member, where a segment of it is [m].
inline double across(const bullet::Member& member, int segment) {
    return double(member.pose(segment).getOrigin().y());
}
/// A mass [kg] fixed by a point to the tip of a cantilever such as P13's, always jointed or just in
/// time.
struct Struck {
    Rig rig;
    bullet::World world;
    Member description;
    std::unique_ptr<AlwaysJointed> always;
    std::unique_ptr<bullet::Member> member;
    btRigidBody* mass;

    Struck(const Member& of, bool just_in_time, double tolerance = 0, double kg = 1)
        : world(rig.engine, {.tolerance = tolerance, .warn = {}}), description(of) {
        mass = &rig.body(kg, {1, 1, 1}, {0, 0, btScalar(of.length())});
        const btVector3 none(0, 0, 0);
        if (!just_in_time) {
            always = std::make_unique<AlwaysJointed>(rig, world, of);
            const auto half = btScalar(of.segment(of.segments() - 1).length / 2);
            rig.constraints.push_back(std::make_unique<btPoint2PointConstraint>(
                *always->last, *mass, btVector3(0, 0, half), none));
            rig.engine.addConstraint(rig.constraints.back().get());
            return;
        }
        member = std::make_unique<bullet::Member>(rig.body(0, none, none), of, here);
        member->attach(of.length(), [this](btRigidBody& piece, const btTransform& place) {
            return std::make_unique<btPoint2PointConstraint>(piece, *mass, place.getOrigin(),
                                                             btVector3(0, 0, 0));
        });
        world.add(*member, "post");
    }
    void strike(double speed) { mass->setLinearVelocity({0, btScalar(speed), 0}); }
    [[nodiscard]] double absorbed_energy() const {
        return member ? member->absorbed_energy() : always->absorbed_energy();
    }
    [[nodiscard]] double bend(int section) const {
        return member ? member->bend(section) : always->hinges[std::size_t(section)]->rotation();
    }
};

/// Holds a body across where `at` in it is at `z` in the world [m]; it may slide along, turn about
/// x.
inline std::unique_ptr<btTypedConstraint> held_across(btRigidBody& body, const btTransform& at,
                                                      double z, bool slides, bool turns) {
    // the older one of six axes lets go where there is no error
    auto held = std::make_unique<btGeneric6DofSpring2Constraint>(
        btTypedConstraint::getFixedBody(), body,
        btTransform(btQuaternion::getIdentity(), {0, 0, btScalar(z)}), at);
    const btScalar free = slides ? 1 : 0, turn = turns ? 1 : 0;
    held->setLinearLowerLimit({0, 0, free});
    held->setLinearUpperLimit({0, 0, -free});
    held->setAngularLowerLimit({turn, 0, 0});
    held->setAngularUpperLimit({-turn, 0, 0});
    return held;
}
/// The same of a member at `place` along it [m].
inline void hold_across(bullet::Member& member, double place, double z, bool slides, bool turns) {
    member.attach(place, [z, slides, turns](btRigidBody& piece, const btTransform& at) {
        return held_across(piece, at, z, slides, turns);
    });
}

/// A beam that stands clamped, its other end held so that it may slide along alone, or not at all,
/// and a mass [kg] fixed by a point to it at `place` [m].
struct HeldTwice {
    Rig rig;
    std::vector<std::string> said; ///< by the World
    bullet::World world;
    std::unique_ptr<AlwaysJointed> always;
    std::unique_ptr<bullet::Member> member;
    btRigidBody* mass;

    HeldTwice(const Member& of, bool just_in_time, double tolerance, double place,
              bool slides = true, double kg = 100)
        : world(rig.engine, {.tolerance = tolerance,
                             .warn = [this](const std::string& line) { said.push_back(line); }}),
          mass(&rig.body(kg, {10, 10, 10}, {0, 0, btScalar(place)})) {
        const btVector3 none(0, 0, 0);
        const double length = of.length();
        if (!just_in_time) {
            always = std::make_unique<AlwaysJointed>(rig, world, of);
            const auto half = btScalar(of.segment(of.segments() - 1).length / 2);
            const MemberPlace at = of.on_axis("place", place);
            rig.constraints.push_back(held_across(
                *always->last, btTransform(here.getBasis(), {0, 0, half}), length, slides, false));
            rig.constraints.push_back(std::make_unique<btPoint2PointConstraint>(
                *always->bodies[std::size_t(at.segment - 1)], *mass,
                btVector3(0, 0, btScalar(at.in_segment[2])), none));
            for (auto& constraint : rig.constraints) rig.engine.addConstraint(constraint.get());
            return;
        }
        member = std::make_unique<bullet::Member>(rig.body(0, none, none), of, here);
        hold_across(*member, length, length, slides, false);
        member->attach(place, [this](btRigidBody& piece, const btTransform& at) {
            return std::make_unique<btPoint2PointConstraint>(piece, *mass, at.getOrigin(),
                                                             btVector3(0, 0, 0));
        });
        world.add(*member);
    }
    void strike(double speed) { mass->setLinearVelocity({0, btScalar(speed), 0}); }
    void push(double force) { mass->applyCentralForce({0, btScalar(force), 0}); }
    [[nodiscard]] double absorbed_energy() const {
        return member ? member->absorbed_energy() : always->absorbed_energy();
    }
    [[nodiscard]] double bend(int section) const {
        return member ? member->bend(section) : always->hinges[std::size_t(section)]->rotation();
    }
};

/// Along z from the origin on, its box, where it has one, going on by `over` at both ends [m].
inline std::unique_ptr<bullet::Member> bar_of(Rig& rig, const Member& of, bool box,
                                              double over = 0) {
    const MemberPiece whole = make_piece(of, straight(of), {0, of.segments() - 1});
    const auto half = btScalar(of.length() / 2);
    btCollisionShape* shape = box ? rig.shape(std::make_unique<btBoxShape>(
                                        btVector3(0.05f, 0.05f, half + btScalar(over))))
                                  : nullptr;
    btRigidBody& body = rig.body(
        of.mass(),
        {btScalar(whole.inertia[0]), btScalar(whole.inertia[1]), btScalar(whole.inertia[2])},
        {0, 0, half}, shape, box ? usual : 0, box ? everything : 0);
    return std::make_unique<bullet::Member>(
        body, of, btTransform(here.getBasis(), {0, 0, -half}),
        box ? bullet::MemberBox{0.05, 0.05} : bullet::MemberBox{});
}
inline btRigidBody& ball_of(Rig& rig, double mass, const btVector3& at) {
    const auto inertia = btScalar(0.4 * mass * 0.1 * 0.1);
    return rig.body(mass, {inertia, inertia, inertia}, at,
                    rig.shape(std::make_unique<btSphereShape>(btScalar(0.1))), usual, everything);
}

[[nodiscard]] inline Vector3<double> place_of(const btRigidBody* body) {
    return bullet::to_core(body->getCenterOfMassPosition());
}
inline void set_velocity(btRigidBody* body, const Vector3<double>& v) {
    body->setLinearVelocity(bullet::to_bullet(v));
}

/// By the engine's own calls, of which a member that is whole is not told.
inline void push_behind(bullet::Member& member, double force) {
    member.pieces().front()->applyCentralForce({0, btScalar(force), 0});
}
inline void turn(bullet::Member& member, double spin) {
    member.pieces().front()->setAngularVelocity({btScalar(spin), 0, 0});
}
inline void change_mass(bullet::Member& member, double factor) {
    btRigidBody& body = *member.pieces().front();
    body.setMassProps(body.getMass() * btScalar(factor), body.getLocalInertia());
}
inline void apply_force(bullet::Member& member, double force, double place) {
    member.apply_force({0, btScalar(force), 0}, place);
}

struct Scene {
    Rig rig;
    bullet::World world;

    explicit Scene(const btVector3& gravity, double tolerance = 0.01,
                   double rest_damping = ductile::rest_damping<double>)
        : rig(gravity),
          world(rig.engine, {.tolerance = tolerance, .rest_damping = rest_damping, .warn = {}}) {}
    void go(double time, double frame) {
        const int count = int(std::lround(time / frame));
        for (int i = 0; i < count; ++i) world.step(frame);
    }
};

/// Clamped, along z from the origin on; gravity across it, of `g` [m/s²].
struct Cantilever : Scene {
    std::unique_ptr<bullet::Member> member;

    Cantilever(const Member& of, double g, double tolerance = 0.01)
        : Scene({0, btScalar(-g), 0}, tolerance) {
        member = std::make_unique<bullet::Member>(rig.body(0, {0, 0, 0}, {0, 0, 0}), of, here);
        world.add(*member);
    }
};

/// A ball that strikes the end of a clamped post, 0 ... 2 s.
struct BallOnPost : Scene {
    std::unique_ptr<bullet::Member> post;
    btRigidBody* ball;

    BallOnPost(const Member& of, double mass, double speed, double tolerance = 0.01,
               double half = 0.05, double gap = 0.00713)
        : BallOnPost(of, mass, speed, tolerance, half, gap, of.length() - 0.03, false) {}
    /// Its end held, so that it may slide along alone, or not at all; struck at `place` [m].
    BallOnPost(const Member& of, double mass, double speed, double tolerance, double half,
               double gap, double place, bool held_twice)
        : Scene({0, 0, 0}, tolerance, 0) {
        ball = &ball_of(rig, mass, {0, btScalar(-half - 0.1 - gap), btScalar(place)});
        ball->setLinearVelocity({0, btScalar(speed), 0});
        post = std::make_unique<bullet::Member>(
            rig.body(0, {0, 0, 0}, {0, 0, 0}, rig.post(half, of.length()), usual, everything), of,
            here, bullet::MemberBox{half, half});
        if (held_twice) hold_across(*post, of.length(), of.length(), true, false);
        world.add(*post, "post");
    }
};

/// Its contacts give way, in frames of any length.
inline void soften(BallOnPost& scene, const SoftHead& as, double /*frame*/) {
    constexpr double others_damping = 0.1; // as Bullet's bodies come
    scene.ball->setContactStiffnessAndDamping(btScalar(as.stiffness),
                                              btScalar(as.damping - others_damping));
}

/// A ball that strikes a bar that nothing holds, a box of 0.1 m across along z from the origin on.
struct BallOnBar : Scene {
    std::unique_ptr<bullet::Member> bar;
    btRigidBody* ball;

    BallOnBar(const Member& of, double mass, double speed, double place, double over = 0)
        : Scene({0, 0, 0}), bar(bar_of(rig, of, true, over)) {
        ball = &ball_of(rig, mass, {0, btScalar(-0.1571), btScalar(place)});
        ball->setLinearVelocity({0, btScalar(speed), 0});
        world.add(*bar, "bar");
    }
};

/// A bar along z from the origin on, on a point at its start and on one that slides along at its
/// end, and a mass [kg] fixed by a point to its middle; gravity across it. They may sleep.
struct HungOn : Scene {
    std::unique_ptr<bullet::Member> bar;

    HungOn(const Member& of, double mass)
        : Scene({0, btScalar(-9.81), 0}), bar(bar_of(rig, of, false)) {
        const double length = of.length();
        btRigidBody& weight = rig.body(mass, {1, 1, 1}, {0, 0, btScalar(length / 2)});
        for (btRigidBody* each : {bar->pieces().front(), &weight}) {
            each->forceActivationState(ACTIVE_TAG);
        }
        bar->attach(0, [](btRigidBody& piece, const btTransform& at) {
            return std::make_unique<btPoint2PointConstraint>(piece, at.getOrigin());
        });
        hold_across(*bar, length, length, true, true);
        bar->attach(length / 2, [&weight](btRigidBody& piece, const btTransform& at) {
            return std::make_unique<btPoint2PointConstraint>(piece, weight, at.getOrigin(),
                                                             btVector3(0, 0, 0));
        });
        world.add(*bar);
    }
};

/// A ball of 50 kg fixed by a point to the tip of a clamped post that nothing else meets, and one
/// of 100 kg 7 mm before it. `within`: the post has boxes, and they reach into the first one, which
/// is as large as half a metre; the other is far away.
struct BallOnHung : Scene {
    std::unique_ptr<bullet::Member> post;
    btRigidBody *hung, *ball;

    explicit BallOnHung(const Member& of, bool within = false) : Scene({0, 0, 0}, 0.01, 0) {
        const auto tip = btScalar(of.length());
        hung = &ball_of(rig, 50, {0, 0, tip});
        ball = &ball_of(rig, 100, {0, btScalar(within ? -1 : -0.207), tip});
        const btVector3 none(0, 0, 0);
        if (within) {
            post = std::make_unique<bullet::Member>(
                rig.body(0, none, none, rig.post(0.05, of.length()), usual, everything), of, here,
                bullet::MemberBox{0.05, 0.05});
            hung->setCollisionShape(rig.shape(std::make_unique<btSphereShape>(btScalar(0.5))));
        } else {
            post = std::make_unique<bullet::Member>(rig.body(0, none, none), of, here);
        }
        post->attach(of.length(), [this](btRigidBody& piece, const btTransform& at) {
            return std::make_unique<btPoint2PointConstraint>(piece, *hung, at.getOrigin(),
                                                             btVector3(0, 0, 0));
        });
        world.add(*post, "post");
    }
    static void strike(btRigidBody* body, double speed) {
        body->setLinearVelocity({0, btScalar(speed), 0});
    }
    /// The point holds no more, or again.
    void let_go(bool off = true) {
        rig.engine.getConstraint(rig.engine.getNumConstraints() - 1)->setEnabled(!off);
    }
};

/// A bar of one box of 0.1 m across along z from the origin on, laid on two pairs of balls 0.2 m
/// from its ends, and a ball [kg] laid on its middle, all `gap` above what they are laid on.
struct LaidOn : Scene {
    std::unique_ptr<bullet::Member> bar;

    LaidOn(const Member& of, double mass, double gap) : Scene({0, btScalar(-9.81), 0}) {
        auto* small = rig.shape(std::make_unique<btSphereShape>(btScalar(0.05)));
        for (const double z : {0.2, of.length() - 0.2}) {
            for (const double x : {-0.04, 0.04}) {
                rig.body(0, {0, 0, 0}, {btScalar(x), btScalar(-0.1 - gap), btScalar(z)}, small,
                         usual, everything);
            }
        }
        ball_of(rig, mass, {0, btScalar(0.15 + gap), btScalar(of.length() / 2)});
        bar = bar_of(rig, of, true);
        world.add(*bar);
    }
};

} // namespace ductile::test
