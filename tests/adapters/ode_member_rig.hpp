// SPDX-License-Identifier: MIT
//
// What the tests of members put into an ODE world, and the scenes that most of them need: those of
// member_rig.hpp.
#pragma once

#include <ode/ode.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ode_engine.hpp"
#include "adapters/soft_head.hpp"
#include "core/member/strips.hpp"
#include "ductile/ode/member_snapshot.hpp"
#include "ductile/ode/members.hpp"
#include "ductile/ode/ode.hpp"

namespace ductile::test::in_ode {

using V3 = Vector3<double>;
constexpr bool rough = false;     ///< in double
constexpr int most_segments = 10; ///< always jointed: with 20 ODE's own LCP fails
inline const JointFrame<double> here{};

/// Outlives its Worlds and members.
struct Rig : OdeEngine {
    dSurfaceParameters surface{}; ///< of contacts

    explicit Rig(const V3& gravity = {0, 0, 0}) {
        dRandSetSeed(0);
        surface.mode = dContactApprox1;
        dWorldSetCFM(id, 1e-13);
        dWorldSetGravity(id, dReal(gravity.x()), dReal(gravity.y()), dReal(gravity.z()));
    }
    /// Of no mass: kinematic.
    dBodyID body(double mass, const V3& inertia, const V3& at) const {
        const dBodyID body = dBodyCreate(id);
        if (mass > 0) {
            dMass m;
            dMassSetParameters(&m, dReal(mass), 0, 0, 0, dReal(inertia.x()), dReal(inertia.y()),
                               dReal(inertia.z()), 0, 0, 0);
            dBodySetMass(body, &m);
        } else {
            dBodySetKinematic(body);
        }
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        return body;
    }
    dGeomID box(dBodyID body, const V3& half, const V3& offset = {0, 0, 0}) const {
        const dGeomID geom =
            dCreateBox(space, dReal(2 * half.x()), dReal(2 * half.y()), dReal(2 * half.z()));
        dGeomSetBody(geom, body);
        dGeomSetOffsetPosition(geom, dReal(offset.x()), dReal(offset.y()), dReal(offset.z()));
        return geom;
    }
    /// A box on each segment of a straight member that starts `start` along z in its body.
    std::vector<dGeomID> boxes(dBodyID body, const Member& of, double half,
                               double start = 0) const {
        std::vector<dGeomID> geoms;
        for (int k = of.clamped() ? 1 : 0; k < of.segments(); ++k) {
            const double length = of.segment(k).length;
            const double middle = start + (k > 0 ? of.place(k - 1) : 0) + length / 2;
            geoms.push_back(box(body, {half, half, length / 2}, {0, 0, middle}));
        }
        return geoms;
    }
    /// A ball joint of the engine's own, where `point` is.
    dJointID pin(dBodyID a, dBodyID b, const V3& point) const {
        const dJointID joint = dJointCreateBall(id, nullptr);
        dJointAttach(joint, a, b);
        dJointSetBallAnchor(joint, dReal(point.x()), dReal(point.y()), dReal(point.z()));
        return joint;
    }
    /// Contacts without friction of all that touches, but of what joints hold together.
    void collide(ode::World& world) {
        world_ = &world;
        dSpaceCollide(space, this, &Rig::near);
    }
    /// The same, by the World.
    void meet(ode::World& world) {
        world.on_contacts({.space = space, .group = contacts}, [this, &world] { collide(world); });
    }

  private:
    static void near(void* data, dGeomID a, dGeomID b) {
        auto& rig = *static_cast<Rig*>(data);
        if (are_joined(a, b)) return;
        rig.touch(a, b, rig.surface, [&rig](dJointID joint, const dContact& contact) {
            rig.world_->add_contact(joint, contact);
        });
    }
    ode::World* world_ = nullptr;
};

inline void set_velocity(dBodyID body, const V3& v) {
    dBodySetLinearVel(body, dReal(v.x()), dReal(v.y()), dReal(v.z()));
}

/// The same segments, each a body of its own.
struct AlwaysJointed {
    using Hinge = ode::PlasticHinge<UsualAxisJoint>;

    AlwaysJointed(const Rig& rig, ode::World& world, const Member& member) {
        double place = 0;
        dBodyID before = nullptr;
        for (int k = 0; k < member.segments(); ++k) {
            const MemberSegment& segment = member.segment(k);
            if (segment.held) continue;
            const dBodyID body =
                rig.body(segment.mass, segment.inertia, {0, 0, place + segment.length / 2});
            world.add(body);
            bodies.push_back(body);
            if (k > 0) {
                hinges.push_back(std::make_unique<Hinge>(
                    rig.id, body, before,
                    ode::HingeFrame{.anchor = {0, 0, place}, .axis = {1, 0, 0}},
                    member.section(k - 1)));
                world.add(*hinges.back());
            }
            before = body;
            place += segment.length;
        }
    }
    [[nodiscard]] double absorbed_energy() const {
        double sum = 0;
        for (const auto& hinge : hinges) sum += hinge->absorbed_energy();
        return sum;
    }

    std::vector<dBodyID> bodies;
    std::vector<std::unique_ptr<Hinge>> hinges;
};

using Snapshot = ode::MemberSnapshot;
/// Across a member, where a segment of it is [m].
inline double across(const ode::Member& member, int segment) {
    return member.pose(segment).origin[1];
}
/// A mass [kg] fixed by a point to the tip of a cantilever such as P13's, always jointed or just in
/// time.
struct Struck {
    Rig rig;
    ode::World world;
    std::unique_ptr<AlwaysJointed> always;
    std::unique_ptr<ode::Member> member;
    dBodyID mass;
    dJointID pin;

    Struck(const Member& of, bool just_in_time, double tolerance = 0, double kg = 1)
        : world(rig.id, {.tolerance = tolerance, .warn = {}}),
          mass(rig.body(kg, {1, 1, 1}, {0, 0, of.length()})) {
        world.add(mass);
        if (just_in_time) {
            member = std::make_unique<ode::Member>(rig.body(0, {0, 0, 0}, {0, 0, 0}), of, here);
            pin = rig.pin(member->body_of(1), mass, {0, 0, of.length()});
            world.add(*member, "post");
        } else {
            always = std::make_unique<AlwaysJointed>(rig, world, of);
            pin = rig.pin(always->bodies.back(), mass, {0, 0, of.length()});
        }
    }
    void strike(double speed) const { set_velocity(mass, {0, speed, 0}); }
    [[nodiscard]] double absorbed_energy() const {
        return member ? member->absorbed_energy() : always->absorbed_energy();
    }
    [[nodiscard]] double bend(int section) const {
        return member ? member->bend(section) : always->hinges[std::size_t(section)]->rotation();
    }
};

/// That slides along z alone.
inline dBodyID carriage_at(const Rig& rig, ode::World& world, double z) {
    const dBodyID carriage = rig.body(1, {1, 1, 1}, {0, 0, z});
    world.add(carriage);
    const dJointID rail = dJointCreateSlider(rig.id, nullptr);
    dJointAttach(rail, carriage, nullptr);
    dJointSetSliderAxis(rail, 0, 0, 1);
    return carriage;
}

/// A beam that stands clamped, its other end held so that it may slide along alone, or not at all,
/// and a mass [kg] fixed by a point to it at `place` [m].
struct HeldTwice {
    Rig rig;
    std::vector<std::string> said; ///< by the World
    ode::World world;
    std::unique_ptr<AlwaysJointed> always;
    std::unique_ptr<ode::Member> member;
    dBodyID mass;

    HeldTwice(const Member& of, bool just_in_time, double tolerance, double place,
              bool slides = true, double kg = 100)
        : world(rig.id, {.tolerance = tolerance,
                         .warn = [this](const std::string& line) { said.push_back(line); }}),
          mass(rig.body(kg, {10, 10, 10}, {0, 0, place})) {
        world.add(mass);
        const dBodyID carriage = carriage_at(rig, world, of.length());
        const dJointID end = dJointCreateFixed(rig.id, nullptr);
        dBodyID last = nullptr, struck = nullptr;
        if (just_in_time) {
            member = std::make_unique<ode::Member>(rig.body(0, {0, 0, 0}, {0, 0, 0}), of, here);
            last = struck = member->body_of(0);
            member->attach(of.length(), end);
        } else {
            always = std::make_unique<AlwaysJointed>(rig, world, of);
            last = always->bodies.back();
            struck = always->bodies[std::size_t(of.segment_at(place) - 1)];
        }
        dJointAttach(end, last, slides ? carriage : nullptr);
        dJointSetFixed(end);
        rig.pin(struck, mass, {0, 0, place});
        if (member) world.add(*member);
    }
    void strike(double speed) const { set_velocity(mass, {0, speed, 0}); }
    void push(double force) const { dBodyAddForce(mass, 0, dReal(force), 0); }
    [[nodiscard]] double absorbed_energy() const {
        return member ? member->absorbed_energy() : always->absorbed_energy();
    }
    [[nodiscard]] double bend(int section) const {
        return member ? member->bend(section) : always->hinges[std::size_t(section)]->rotation();
    }
};

/// Along z from the origin on, its box, where it has one, going on by `over` at both ends [m].
inline std::unique_ptr<ode::Member> bar_of(const Rig& rig, const Member& of, bool box,
                                           double over = 0) {
    const MemberPiece whole = make_piece(of, straight(of), {0, of.segments() - 1});
    const double half = of.length() / 2;
    const dBodyID body = rig.body(of.mass(), whole.inertia, {0, 0, half});
    if (box) rig.box(body, {0.05, 0.05, half + over});
    return std::make_unique<ode::Member>(body, of, JointFrame<double>{.origin = {0, 0, -half}},
                                         box ? ode::MemberBox{0.05, 0.05} : ode::MemberBox{});
}
inline dBodyID ball_of(const Rig& rig, double mass, const V3& at) {
    const double inertia = 0.4 * mass * 0.1 * 0.1;
    const dBodyID ball = rig.body(mass, {inertia, inertia, inertia}, at);
    dGeomSetBody(dCreateSphere(rig.space, dReal(0.1)), ball);
    return ball;
}

[[nodiscard]] inline V3 place_of(dBodyID body) { return ode::to_core(dBodyGetPosition(body)); }

/// By the engine's own calls, of which a member that is whole is not told.
inline void push_behind(ode::Member& member, double force) {
    dBodyAddForce(member.body_of(0), 0, dReal(force), 0);
}
inline void turn(ode::Member& member, double spin) {
    dBodySetAngularVel(member.body_of(0), dReal(spin), 0, 0);
}
inline void change_mass(ode::Member& member, double factor) {
    dMass mass;
    dBodyGetMass(member.body_of(0), &mass);
    dMassAdjust(&mass, dReal(double(mass.mass) * factor));
    dBodySetMass(member.body_of(0), &mass);
}
inline void apply_force(ode::Member& member, double force, double place) {
    member.apply_force({0, force, 0}, place);
}

struct Scene {
    Rig rig;
    ode::World world;

    explicit Scene(const V3& gravity, double tolerance = 0.01,
                   double rest_damping = ductile::rest_damping<double>)
        : rig(gravity),
          world(rig.id, {.tolerance = tolerance, .rest_damping = rest_damping, .warn = {}}) {}
    void go(double time, double frame) {
        const int count = int(std::lround(time / frame));
        for (int i = 0; i < count; ++i) world.step(frame);
    }
};

/// Clamped, along z from the origin on; gravity across it, of `g` [m/s²].
struct Cantilever : Scene {
    std::unique_ptr<ode::Member> member;

    Cantilever(const Member& of, double g, double tolerance = 0.01) : Scene({0, -g, 0}, tolerance) {
        member = std::make_unique<ode::Member>(rig.body(0, {0, 0, 0}, {0, 0, 0}), of, here);
        world.add(*member);
    }
};

/// A ball that strikes the end of a clamped post, 0 ... 2 s.
struct BallOnPost : Scene {
    std::unique_ptr<ode::Member> post;
    dBodyID ball;

    BallOnPost(const Member& of, double mass, double speed, double tolerance = 0.01,
               double half = 0.05, double gap = 0.00713)
        : BallOnPost(of, mass, speed, tolerance, half, gap, of.length() - 0.03, false) {}
    /// Its end held, so that it may slide along alone, or not at all; struck at `place` [m].
    BallOnPost(const Member& of, double mass, double speed, double tolerance, double half,
               double gap, double place, bool held_twice)
        : Scene({0, 0, 0}, tolerance, 0), ball(ball_of(rig, mass, {0, -half - 0.1 - gap, place})) {
        set_velocity(ball, {0, speed, 0});
        world.add(ball);
        const dBodyID body = rig.body(0, {0, 0, 0}, {0, 0, 0});
        rig.boxes(body, of, half);
        post = std::make_unique<ode::Member>(body, of, here);
        if (held_twice) {
            const dJointID end = dJointCreateFixed(rig.id, nullptr);
            dJointAttach(end, body, carriage_at(rig, world, of.length()));
            dJointSetFixed(end);
            post->attach(of.length(), end);
        }
        world.add(*post, "post");
        rig.meet(world);
    }
};

/// Contacts give way, in frames of `frame` [s].
inline void soften(BallOnPost& scene, const SoftHead& as, double frame) {
    dSurfaceParameters& surface = scene.rig.surface;
    surface.mode |= dContactSoftERP | dContactSoftCFM;
    surface.soft_erp = dReal(as.erp(frame));
    surface.soft_cfm = dReal(as.cfm(frame));
}

/// A ball that strikes a bar that nothing holds, a box of 0.1 m across along z from the origin on.
struct BallOnBar : Scene {
    std::unique_ptr<ode::Member> bar;
    dBodyID ball;

    BallOnBar(const Member& of, double mass, double speed, double place, double over = 0)
        : Scene({0, 0, 0}),
          bar(bar_of(rig, of, true, over)),
          ball(ball_of(rig, mass, {0, -0.1571, place})) {
        set_velocity(ball, {0, speed, 0});
        world.add(ball);
        world.add(*bar, "bar");
        rig.meet(world);
    }
};

/// A bar along z from the origin on, on a point at its start and on one that slides along at its
/// end, and a mass [kg] fixed by a point to its middle; gravity across it. They may sleep.
struct HungOn : Scene {
    std::unique_ptr<ode::Member> bar;

    HungOn(const Member& of, double mass) : Scene({0, -9.81, 0}) {
        dWorldSetAutoDisableFlag(rig.id, 1);
        bar = bar_of(rig, of, false);
        const double length = of.length(), half = length / 2;
        const dBodyID body = bar->body_of(0), weight = rig.body(mass, {1, 1, 1}, {0, 0, half}),
                      carriage = rig.body(1, {1, 1, 1}, {0, 0, length});
        rig.pin(body, nullptr, {0, 0, 0});
        rig.pin(body, carriage, {0, 0, length});
        rig.pin(body, weight, {0, 0, half});
        const dJointID rail = dJointCreateSlider(rig.id, nullptr);
        dJointAttach(rail, carriage, nullptr);
        dJointSetSliderAxis(rail, 0, 0, 1);
        for (const dBodyID each : {weight, carriage}) world.add(each);
        world.add(*bar);
    }
};

/// A ball of 50 kg fixed by a point to the tip of a clamped post that nothing else meets, and one
/// of 100 kg 7 mm before it. `within`: the post has boxes, and they reach into the first one, which
/// is as large as half a metre; the other is far away.
struct BallOnHung : Scene {
    std::unique_ptr<ode::Member> post;
    dBodyID hung, ball;
    dJointID point;

    explicit BallOnHung(const Member& of, bool within = false)
        : Scene({0, 0, 0}, 0.01, 0),
          hung(ball_of(rig, 50, {0, 0, of.length()})),
          ball(ball_of(rig, 100, {0, within ? -1 : -0.207, of.length()})) {
        const dBodyID body = rig.body(0, {0, 0, 0}, {0, 0, 0});
        if (within) {
            rig.boxes(body, of, 0.05);
            dGeomSetBody(dCreateSphere(rig.space, dReal(0.5)), hung);
        }
        post = std::make_unique<ode::Member>(body, of, here);
        point = rig.pin(body, hung, {0, 0, of.length()});
        for (const dBodyID each : {hung, ball}) world.add(each);
        world.add(*post, "post");
        rig.meet(world);
    }
    static void strike(dBodyID body, double speed) { set_velocity(body, {0, speed, 0}); }
    /// The point holds no more, or again.
    void let_go(bool off = true) const { (off ? dJointDisable : dJointEnable)(point); }
};

/// A bar of one box of 0.1 m across along z from the origin on, laid on two pairs of balls 0.2 m
/// from its ends, and a ball [kg] laid on its middle, all `gap` above what they are laid on.
struct LaidOn : Scene {
    std::unique_ptr<ode::Member> bar;

    LaidOn(const Member& of, double mass, double gap) : Scene({0, -9.81, 0}) {
        for (const double z : {0.2, of.length() - 0.2}) {
            for (const double x : {-0.04, 0.04}) {
                dGeomSetPosition(dCreateSphere(rig.space, dReal(0.05)), dReal(x), dReal(-0.1 - gap),
                                 dReal(z));
            }
        }
        world.add(ball_of(rig, mass, {0, 0.15 + gap, of.length() / 2}));
        bar = bar_of(rig, of, true);
        world.add(*bar);
        rig.meet(world);
    }
};

} // namespace ductile::test::in_ode
