// SPDX-License-Identifier: MIT
//
// Frames with a tolerance in ODE, with contacts of ODE's own shapes.
#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "adapters/crushed_head.hpp"
#include "adapters/ode_engine.hpp"
#include "adapters/soft_head.hpp"
#include "ductile/ode/closing_contacts.hpp"
#include "ductile/ode/ode.hpp"
#include "support/throws.hpp"

namespace {

using namespace ductile;
using ductile::test::crush_of_head;
using ductile::test::message_of;
using ode::Solver;
using ode::World;
using ode::WorldParameters;
using Law = OneAxisJoint<Perfect<double>>;
using Hinge = ode::PlasticHinge<Law>;
using Slider = ode::PlasticSlider<Law>;
using V3 = Vector3<double>;

constexpr double all_frames[] = {1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30};

[[nodiscard]] Law law(double strength) { return Law(Perfect<double>({.strength = strength})); }

/// A world with what a test puts into it.
struct Rig {
    test::OdeEngine engine;
    World world;
    double friction = 0, bounce = -1;
    bool soft = false; ///< contacts have their own ERP and CFM
    double erp = 0.8, cfm = 1e-9;
    std::vector<std::unique_ptr<ode::PlasticConstraint>> joints;

    explicit Rig(const WorldParameters& parameters = {.tolerance = 0.01,
                                                      .rest_damping = 0,
                                                      .warn = {}})
        : world(engine.id, parameters) {
        dRandSetSeed(0);
        dWorldSetCFM(engine.id, 1e-13);
        world.on_contacts({.space = engine.space, .group = engine.contacts},
                          [this] { dSpaceCollide(engine.space, this, &Rig::near); });
    }

    static void near(void* data, dGeomID a, dGeomID b) {
        auto& rig = *static_cast<Rig*>(data);
        if (test::OdeEngine::are_joined(a, b)) return;
        dSurfaceParameters surface{};
        surface.mode = dContactApprox1;
        surface.mu = dReal(rig.friction);
        if (rig.bounce >= 0) {
            surface.mode |= dContactBounce;
            surface.bounce = dReal(rig.bounce);
        }
        if (rig.soft) {
            surface.mode |= dContactSoftERP | dContactSoftCFM;
            surface.soft_erp = dReal(rig.erp);
            surface.soft_cfm = dReal(rig.cfm);
        }
        rig.engine.touch(a, b, surface, [&rig](dJointID joint, const dContact& contact) {
            rig.world.add_contact(joint, contact);
        });
    }

    static void near_in_spaces(void* data, dGeomID a, dGeomID b) {
        if (dGeomIsSpace(a) != 0 || dGeomIsSpace(b) != 0) {
            dSpaceCollide2(a, b, data, &Rig::near_in_spaces);
        } else {
            near(data, a, b);
        }
    }

    dBodyID body(double mass, const V3& inertia, const V3& at, dGeomID shape = nullptr,
                 unsigned long group = 0, unsigned long mask = 0) {
        const dBodyID body = dBodyCreate(engine.id);
        dMass m;
        dMassSetParameters(&m, dReal(mass), 0, 0, 0, dReal(inertia.x()), dReal(inertia.y()),
                           dReal(inertia.z()), 0, 0, 0);
        dBodySetMass(body, &m);
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        if (shape != nullptr) {
            dGeomSetBody(shape, body);
            dGeomSetCategoryBits(shape, group);
            dGeomSetCollideBits(shape, mask);
        }
        world.add(body);
        return body;
    }
    [[nodiscard]] dGeomID box(double x, double y, double z) const { // half
        return dCreateBox(engine.space, dReal(2 * x), dReal(2 * y), dReal(2 * z));
    }
    [[nodiscard]] dGeomID sphere(double radius) const {
        return dCreateSphere(engine.space, dReal(radius));
    }
    Slider& slider(dBodyID a, const V3& axis, double strength) {
        auto made = std::make_unique<Slider>(engine.id, a, nullptr, axis, law(strength));
        Slider& result = *made;
        joints.push_back(std::move(made));
        world.add(result);
        return result;
    }
    Hinge& hinge(dBodyID a, dBodyID b, const V3& anchor, double strength) {
        auto made = std::make_unique<Hinge>(
            engine.id, a, b, ode::HingeFrame{.anchor = anchor, .axis = {0, 0, 1}}, law(strength));
        Hinge& result = *made;
        joints.push_back(std::move(made));
        world.add(result);
        return result;
    }
    void set_gravity(double g) { dWorldSetGravity(engine.id, 0, dReal(-g), 0); }
    /// Frames until `duration` [s] or more is over.
    void run(double duration, double frame) {
        while (world.time() < duration - 1e-9) world.step(frame);
    }
};

[[nodiscard]] WorldParameters with(Solver solver) {
    return {.solver = solver, .tolerance = 0.01, .rest_damping = 0, .warn = {}};
}

} // namespace

TEST_CASE("Frames: a mass dropped on a crushing head, by ODE's own contact", "[frame]") {
    constexpr double mass = 500, head_mass = 50, height = 2, strength = 30e3, g = 9.81;
    const double crush = crush_of_head(mass, head_mass, height, strength, g);
    for (const Solver solver : {Solver::direct, Solver::quick}) {
        for (const double frame : all_frames) {
            CAPTURE(solver, frame);
            Rig rig(with(solver));
            rig.set_gravity(g);
            const dBodyID head =
                rig.body(head_mass, V3(5, 5, 5), {0, 0, 0}, rig.box(0.5, 0.1, 0.5), 1, 2);
            rig.body(mass, V3(50, 50, 50), {0, 0.2 + height, 0}, rig.box(0.4, 0.1, 0.4), 2, 1);
            const Slider& slider = rig.slider(head, {0, 1, 0}, strength);
            rig.run(1.2, frame);
            CHECK(slider.absorbed_energy() == Approx(strength * crush).epsilon(2e-3));
            CHECK(-double(dBodyGetPosition(head)[1]) == Approx(crush).epsilon(5e-3));
            CHECK(rig.world.run().believed());
            CHECK(std::abs(rig.world.ledger().unexplained()) < 1e-6 * strength * crush);
        }
    }
}

TEST_CASE("Frames: what falls keeps its speed until it touches, and then rests", "[frame]") {
    // falls from a low height, so that in the part that ends there it still gains much of its speed
    constexpr double mass = 500, head_mass = 50, height = 0.05, g = 9.81;
    constexpr double fall = height + ode::closed_depth;
    for (const double frame : all_frames) {
        for (const double strength : {30e3, 300e3}) {
            CAPTURE(frame, strength);
            const double crush = crush_of_head(mass, head_mass, fall, strength, g);
            Rig rig;
            rig.set_gravity(g);
            const dBodyID head =
                rig.body(head_mass, V3(5, 5, 5), {0, 0, 0}, rig.box(0.5, 0.1, 0.5), 1, 2);
            rig.body(mass, V3(50, 50, 50), {0, 0.2 + height, 0}, rig.sphere(0.1), 2, 1);
            const Slider& slider = rig.slider(head, {0, 1, 0}, strength);
            rig.run(0.5, frame);
            CHECK(slider.absorbed_energy() == Approx(strength * crush).epsilon(1e-3));
            CHECK(rig.world.run().believed());
            int solves = 0;
            for (int i = 0; i < 12; ++i) {
                rig.world.step(frame);
                solves += rig.world.frame().solves();
            }
            CHECK(solves <= 24); // at rest: two a frame
        }
    }
}

TEST_CASE("Frames: a mesh that is one face is met as a box is, on ground that is a mesh",
          "[frame]") {
    constexpr double mass = 500, head_mass = 50, height = 1, strength = 30e3, g = 9.81;
    const double crush = crush_of_head(mass, head_mass, height, strength, g);
    constexpr std::array<float, 12> corners{-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1};
    constexpr std::array<dTriIndex, 6> faces{0, 2, 1, 0, 3, 2};
    const dTriMeshDataID data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data, corners.data(), 3 * sizeof(float), 4, faces.data(), 6,
                                3 * sizeof(dTriIndex));
    for (const double frame : all_frames) {
        CAPTURE(frame);
        Rig rig;
        rig.set_gravity(g);
        const auto mesh = [&] {
            return dCreateTriMesh(rig.engine.space, data, nullptr, nullptr, nullptr);
        };
        const dBodyID head = rig.body(head_mass, V3(5, 5, 5), {0, 0, 0}, mesh(), 1, 2);
        dGeomSetPosition(mesh(), 0, dReal(-0.5), 0);
        rig.body(mass, V3(50, 50, 50), {0, 0.1 + height, 0}, rig.sphere(0.1), 2, 1);
        const Slider& slider = rig.slider(head, {0, 1, 0}, strength);
        rig.run(1, frame);
        CHECK(slider.absorbed_energy() == Approx(strength * crush).epsilon(5e-3));
        CHECK(rig.world.run().believed());
        CHECK(rig.world.run().worst_frame < 100);
    }
    dGeomTriMeshDataDestroy(data);
}

TEST_CASE("Frames: geoms in a space of any kind are met alike", "[frame]") {
    constexpr double mass = 500, head_mass = 50, height = 1, strength = 30e3, g = 9.81;
    const double crush = crush_of_head(mass, head_mass, height, strength, g);
    const dVector3 centre{0, 0, 0}, extents{8, 8, 8};
    for (const int kind : {0, 1, 2}) {
        CAPTURE(kind);
        Rig rig;
        rig.set_gravity(g);
        const dSpaceID outer = kind == 0   ? dQuadTreeSpaceCreate(nullptr, centre, extents, 4)
                               : kind == 1 ? dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ)
                                           : dHashSpaceCreate(nullptr);
        const dSpaceID inner =
            kind == 2 ? dQuadTreeSpaceCreate(outer, centre, extents, 4) : nullptr;
        const auto in = [&](dSpaceID space, dGeomID geom) {
            dSpaceRemove(rig.engine.space, geom);
            dSpaceAdd(space, geom);
        };
        const dGeomID plate = rig.box(0.5, 0.1, 0.5), ball = rig.sphere(0.1);
        const dBodyID head = rig.body(head_mass, V3(5, 5, 5), {0, 0, 0}, plate, 1, 2);
        rig.body(mass, V3(50, 50, 50), {0, 0.2 + height, 0}, ball, 2, 1);
        in(outer, ball);
        in(inner != nullptr ? inner : outer, plate);
        rig.world.on_contacts({.space = outer, .group = rig.engine.contacts},
                              [&] { dSpaceCollide(outer, &rig, &Rig::near_in_spaces); });
        const Slider& slider = rig.slider(head, {0, 1, 0}, strength);
        rig.run(1, 1.0 / 60);
        CHECK(slider.absorbed_energy() == Approx(strength * crush).epsilon(5e-3));
        CHECK(rig.world.run().believed());
        const dGeomID stray = dCreateSphere(inner != nullptr ? inner : outer, 1);
        dGeomSetBody(stray, dBodyCreate(rig.engine.id));
        CHECK_THAT(message_of([&] { rig.world.step(0.01); }),
                   Catch::Matchers::Contains("must have been added"));
        dSpaceDestroy(outer);
    }
}

TEST_CASE("Frames: what slides on its face stays on it until it strikes", "[frame]") {
    constexpr double speed = 7.8, g = 9.81, friction = 0.28, height = 0.12, duration = 0.1;
    for (const double frame : all_frames) {
        CAPTURE(frame);
        Rig rig;
        rig.friction = friction;
        rig.set_gravity(g);
        dCreatePlane(rig.engine.space, 0, 1, 0, 0);
        const dBodyID plank =
            rig.body(80, V3(2, 4, 3), {0, height, 0}, rig.box(0.3, height, 0.25), 1, ~0ul);
        dBodySetLinearVel(plank, speed, 0, dReal(-0.2));
        rig.slider(rig.body(1, V3(1, 1, 1), {5, 5, 5}), {0, 1, 0}, 100);
        rig.run(duration, frame);
        CHECK(dBodyGetLinearVel(plank)[0] ==
              Approx(speed - friction * g * rig.world.time()).epsilon(2e-3));
        CHECK(dBodyGetPosition(plank)[1] == Approx(height).margin(2.5e-4));
        CHECK(std::abs(dBodyGetRotation(plank)[4]) < 1e-3); // of its length [rad]
    }
}

TEST_CASE("Frames: a vehicle against a lamp post, by ODE's own contact", "[frame]") {
    // bench/scenes/lamp_post.hpp has the closed form: M θ = E₁ + m_p g (L/2)(1 - cos θ)
    constexpr double vehicle = 1000, speed = 10, bumper = 0.6, post = 60, length = 5;
    constexpr double moment = 25e3, g = 9.81;
    constexpr double inertia = post * length * length / 3;
    constexpr double both = vehicle * bumper * bumper + inertia;
    constexpr double after = vehicle * vehicle * speed * speed * bumper * bumper / (2 * both);
    double angle = after / moment;
    for (int i = 0; i < 100; ++i) {
        angle = (after + post * g * length / 2 * (1 - std::cos(angle))) / moment;
    }
    for (const double frame : all_frames) {
        CAPTURE(frame);
        Rig rig;
        rig.set_gravity(g);
        constexpr double half = 0.01;
        const dBodyID rod = rig.body(post, V3(125, 1, 125), {0, length / 2, 0},
                                     rig.box(half, length / 2, 0.1), 1, 2);
        const dBodyID car = rig.body(vehicle, V3(100, 100, 100), {-0.3 - half - 0.02, bumper, 0},
                                     rig.sphere(0.02), 2, 1);
        dBodySetLinearVel(car, dReal(speed), 0, 0);
        dBodySetGravityMode(car, 0);
        const dJointID guide = dJointCreateSlider(rig.engine.id, nullptr);
        dJointAttach(guide, car, nullptr);
        dJointSetSliderAxis(guide, 1, 0, 0);
        const Hinge& hinge = rig.hinge(rod, nullptr, {0, 0, 0}, moment);
        rig.run(0.6, frame);
        CHECK(hinge.plastic_rotation() == Approx(angle).epsilon(0.01));
        CHECK(hinge.absorbed_energy() == Approx(moment * angle).epsilon(0.01));
        CHECK(rig.world.run().believed());
    }
}

namespace {

/// Plastic work of a post of five hinges that balls of 100 kg strike [J].
double work_of_balls(int balls, double speed, double frame, Solver solver) {
    Rig rig(with(solver));
    std::vector<dBodyID> pieces;
    for (int i = 0; i < 5; ++i) {
        pieces.push_back(rig.body(12, V3(0.482, 0.00964, 0.482), {0, 0.4 * i + 0.2, 0},
                                  rig.box(0.05, 0.2, 0.05), 2, 4));
        rig.hinge(pieces.back(), i == 0 ? nullptr : pieces[std::size_t(i - 1)], {0, 0.4 * i, 0},
                  4000);
    }
    for (int i = 0; i < balls; ++i) {
        const dBodyID ball = rig.body(100, V3(1.6, 1.6, 1.6), {-0.3 - 0.05 * i, 1.95 - 0.9 * i, 0},
                                      rig.sphere(0.2), 4, 2);
        dBodySetLinearVel(ball, dReal(speed), 0, 0);
    }
    const double energy = 50 * speed * speed * balls;
    double most = 0;
    while (rig.world.time() < 0.6 - 1e-9) {
        rig.world.step(frame);
        most = std::max(most, rig.world.ledger().held().kinetic);
    }
    CHECK(most <= energy * (1 + 1e-9));
    CHECK(rig.world.run().believed());
    CHECK(std::abs(rig.world.ledger().unexplained()) < 1e-6 * energy);
    double work = 0;
    for (const auto& joint : rig.joints) work += joint->queries().absorbed_energy();
    return work;
}

} // namespace

TEST_CASE("Frames: balls on a post of five hinges take the same at any frame", "[frame]") {
    // plastic work at frames of 1 ms, within 0.1 % that of Bullet too (bullet_frames_test.cpp) [J]
    struct Case {
        int balls;
        double speed, work, off;
    };
    for (const Case& scene :
         {Case{1, 1, 46.391, 1e-3}, Case{1, 2, 185.42, 1e-3}, Case{1, 5, 1123.5, 1e-3},
          Case{1, 20, 4551.8, 0.02}, Case{2, 1, 87.108, 1e-3}, Case{2, 2, 361.3, 1e-3},
          Case{2, 5, 1965.8, 5e-3}, Case{2, 20, 9913.6, 0.02}}) {
        for (const double frame : all_frames) {
            CAPTURE(scene.balls, scene.speed, frame);
            const double work = work_of_balls(scene.balls, scene.speed, frame, Solver::direct);
            CHECK(work == Approx(scene.work).epsilon(scene.off));
        }
    }
}

TEST_CASE("Frames: motors of ODE's own joints that are plastic stop where they should", "[frame]") {
    // a hinge tells its angle, an angular motor is summed up; the rotor turns by 1.225 rad
    constexpr double inertia = 2, spin = 7, strength = 40, energy = inertia * spin * spin / 2;
    for (const bool measured : {true, false}) {
        for (const double frame : all_frames) {
            CAPTURE(measured, frame);
            Rig rig;
            const dBodyID rotor = rig.body(1, V3(2, 2, 2), {0, 0, 0});
            dBodySetAngularVel(rotor, 0, 0, dReal(spin));
            const dJointID joint = measured ? dJointCreateHinge(rig.engine.id, nullptr)
                                            : dJointCreateAMotor(rig.engine.id, nullptr);
            dJointAttach(joint, rotor, nullptr);
            if (measured) {
                dJointSetHingeAxis(joint, 0, 0, 1);
            } else {
                dJointSetAMotorNumAxes(joint, 1);
                dJointSetAMotorAxis(joint, 0, 0, 0, 0, 1);
            }
            auto made = std::make_unique<ode::PlasticMotor<Law>>(
                measured ? ode::hinge_axis(joint) : ode::angular_motor_axis(joint, 0),
                law(strength));
            const ode::PlasticMotor<Law>& motor = *made;
            rig.world.add(*made);
            rig.joints.push_back(std::move(made));
            rig.run(0.5, frame);
            CHECK(motor.absorbed_energy() == Approx(energy).epsilon(1e-6));
            CHECK(motor.position() == Approx(energy / strength).epsilon(1e-6));
            CHECK(rig.world.run().believed());
            CHECK(rig.world.run().parts <= rig.world.run().frames + 8);
            CHECK(std::abs(rig.world.ledger().unexplained()) < 1e-9 * energy);
        }
    }
}

TEST_CASE("Frames: what is thin and fast does not pass unseen", "[frame]") {
    // a ball of 1 kg at 300 m/s on a plate of 4 mm: it goes 10 m in a frame
    constexpr double strength = 5e3, common = 300 / 3.0;
    for (const double frame : all_frames) {
        CAPTURE(frame);
        Rig rig;
        const dBodyID plate = rig.body(2, V3(1, 1, 1), {0, 0, 0}, rig.box(0.002, 0.5, 0.5), 1, 2);
        const dBodyID ball = rig.body(1, V3(1, 1, 1), {-3, 0, 0}, rig.sphere(0.002), 2, 1);
        dBodySetLinearVel(ball, 300, 0, 0);
        const Slider& slider = rig.slider(plate, {1, 0, 0}, strength);
        rig.run(0.2, frame);
        CHECK(slider.absorbed_energy() == Approx(3 * common * common / 2).epsilon(1e-3));
    }
}

TEST_CASE("Frames: a blow rebounds as the contact says", "[frame]") {
    // u' of a ball of 1 kg that meets 3 kg at 8 m/s with e = 1/2: -1 and 3 m/s
    for (const double frame : all_frames) {
        CAPTURE(frame);
        Rig rig;
        rig.bounce = 0.5;
        const dBodyID block = rig.body(3, V3(1, 1, 1), {0, 0, 0}, rig.box(0.5, 0.5, 0.5), 1, 2);
        const dBodyID ball = rig.body(1, V3(1, 1, 1), {-1, 0, 0}, rig.sphere(0.2), 2, 1);
        dBodySetLinearVel(ball, 8, 0, 0);
        const Slider& slider = rig.slider(block, {1, 0, 0}, 20);
        rig.run(2, frame);
        CHECK(double(dBodyGetLinearVel(ball)[0]) == Approx(-1).epsilon(1e-6));
        CHECK(slider.absorbed_energy() == Approx(3 * 9 / 2.0).epsilon(1e-6));
    }
}

TEST_CASE("Frames: what rebounds is struck anew where another blow sends it back", "[frame]") {
    // 30 us after a ball has left the head again another one strikes that from below: three blows
    constexpr double e = 0.5, g = 10, ball = 1, head = 10, heavy = 10, time = 2.7e-3, later = 3e-5;
    const auto blow = [](double m, double n, double nears) {
        return (1 + e) * m * n / (m + n) * nears;
    };
    constexpr double speed = 5, from_below = 5;
    const double fallen = speed * time + g * time * time / 2, meets = speed + g * time;
    const double first = blow(ball, head, meets);
    const double down = first / head, up = first / ball - meets;
    const double after = blow(heavy, head, from_below + down) / head - down;
    const double last = after - blow(ball, head, after - up) / head;
    for (const double frame : all_frames) {
        CAPTURE(frame);
        Rig rig;
        rig.bounce = e;
        rig.set_gravity(g);
        const dBodyID block = rig.body(head, V3(1, 1, 1), {0, 0, 0}, rig.box(1, 0.5, 1), 1, 2);
        const dBodyID above =
            rig.body(ball, V3(1, 1, 1), {0, 0.6 + fallen, 0}, rig.sphere(0.1), 2, 1);
        const double way = from_below * (time + later) + down * later;
        const dBodyID below =
            rig.body(heavy, V3(1, 1, 1), {0, -0.6 - way, 0}, rig.sphere(0.1), 2, 1);
        for (const dBodyID still : {block, below}) dBodySetGravityMode(still, 0);
        dBodySetLinearVel(above, 0, -speed, 0);
        dBodySetLinearVel(below, 0, from_below, 0);
        const Slider& slider = rig.slider(block, {0, 1, 0}, 500);
        rig.run(0.1, frame);
        CHECK(slider.absorbed_energy() == Approx(head * last * last / 2).epsilon(0.01));
        CHECK(rig.world.run().believed());
    }
}

TEST_CASE("Frames: what is put down a little above a head that hardly bears it falls as far",
          "[frame]") {
    // 0.99 of its strength is weight, so that it gives way by some 80 times the fall
    constexpr double mass = 500, head_mass = 50, g = 9.81, weight = (mass + head_mass) * g;
    constexpr double strength = weight / 0.99;
    for (const double gap : {0.0, 1e-7, 1e-6, 1e-5, 3e-5, 1e-4, 2e-4, 1e-3}) {
        const double crush = crush_of_head(mass, head_mass, gap, strength, g);
        for (const double frame : all_frames) {
            CAPTURE(gap, frame);
            Rig rig;
            rig.set_gravity(g);
            const dBodyID head =
                rig.body(head_mass, V3(5, 5, 5), {0, 0, 0}, rig.box(0.5, 0.1, 0.5), 1, 2);
            rig.body(mass, V3(50, 50, 50), {0, 0.2 + gap, 0}, rig.sphere(0.1), 2, 1);
            const Slider& slider = rig.slider(head, {0, 1, 0}, strength);
            rig.run(1.5, frame);
            // it is closed where it overlaps by 0.1 um, or by a hundredth of its fall
            constexpr double hair = 0.1;
            CHECK(slider.absorbed_energy() == Approx(strength * crush).epsilon(0.015).margin(hair));
            CHECK(rig.world.run().believed());
        }
    }
}

TEST_CASE("Frames: a contact's own ERP and compliance do not throw things about", "[frame]") {
    constexpr double mass = 500, head_mass = 50, height = 1, strength = 30e3, g = 9.81;
    constexpr double fall = height + ode::closed_depth;
    const double crush = crush_of_head(mass, head_mass, fall, strength, g);
    for (const bool guided : {false, true}) { // that island is ODE's
        for (const double frame : all_frames) {
            CAPTURE(guided, frame);
            Rig rig;
            rig.soft = true;
            rig.set_gravity(g);
            const dBodyID head =
                rig.body(head_mass, V3(5, 5, 5), {0, 0, 0}, rig.box(0.5, 0.1, 0.5), 1, 2);
            const dBodyID block =
                rig.body(mass, V3(50, 50, 50), {0, 0.2 + height, 0}, rig.sphere(0.1), 2, 1);
            if (guided) {
                const dJointID guide = dJointCreateSlider(rig.engine.id, nullptr);
                dJointAttach(guide, block, nullptr);
                dJointSetSliderAxis(guide, 0, 1, 0);
            }
            const Slider& slider = rig.slider(head, {0, 1, 0}, strength);
            rig.run(1, frame);
            CHECK(slider.absorbed_energy() == Approx(strength * crush).epsilon(5e-3));
            CHECK(rig.world.run().believed());
        }
    }
}

TEST_CASE("Frames: a contact that gives way is a spring and a damper at any frame", "[frame]") {
    for (const test::SoftHead& scene : test::soft_heads) {
        constexpr double duration = 0.5;
        const double absorbed = scene.absorbed(duration);
        for (const double frame : all_frames) {
            for (const bool of_world : {false, true}) { // whose ERP and CFM they are
                CAPTURE(scene.mass, scene.head, scene.stiffness, scene.damping, frame, of_world);
                Rig rig;
                rig.set_gravity(scene.gravity);
                rig.soft = !of_world;
                rig.erp = scene.erp(frame);
                rig.cfm = scene.cfm(frame);
                if (of_world) {
                    dWorldSetERP(rig.engine.id, dReal(rig.erp));
                    dWorldSetCFM(rig.engine.id, dReal(rig.cfm));
                }
                const dBodyID head = rig.body(scene.head, V3::Constant(scene.head), {0, 0, 0},
                                              rig.box(2, 1, 2), 1, 2);
                const dBodyID mass = rig.body(scene.mass, V3::Constant(scene.mass),
                                              {0, 1.5 + 1e-9, 0}, rig.sphere(0.5), 2, 1);
                dBodySetLinearVel(mass, 0, dReal(-scene.speed), 0);
                const Slider& slider = rig.slider(head, {0, 1, 0}, scene.strength);
                rig.run(duration, frame);
                CHECK(slider.absorbed_energy() == Approx(absorbed).epsilon(0.01));
                CHECK(rig.world.run().believed());
            }
        }
    }
}

TEST_CASE("Frames: a stop of ODE's own joint is met where it is, and throws nothing about",
          "[frame]") {
    constexpr double mass = 2, speed = 3, strength = 20, stop = 0.05;
    constexpr double lost = mass * speed * speed / 4; // as both go on together
    for (const bool slides : {true, false}) {
        for (const double frame : all_frames) {
            CAPTURE(slides, frame);
            Rig rig;
            const dBodyID held = rig.body(mass, V3::Constant(mass), {0, 0, 0});
            const dBodyID thrown = rig.body(mass, V3::Constant(mass), {0, 0, 0});
            const ode::PlasticConstraint* joint = nullptr;
            const dJointID own = slides ? dJointCreateSlider(rig.engine.id, nullptr)
                                        : dJointCreateHinge(rig.engine.id, nullptr);
            dJointAttach(own, thrown, held);
            if (slides) {
                joint = &rig.slider(held, {0, 0, 1}, strength);
                dJointSetSliderAxis(own, 0, 0, 1);
                dJointSetSliderParam(own, dParamLoStop, -stop);
                dJointSetSliderParam(own, dParamHiStop, stop);
                dBodySetLinearVel(thrown, 0, 0, speed);
            } else {
                joint = &rig.hinge(held, nullptr, {0, 0, 0}, strength);
                dJointSetHingeAxis(own, 0, 0, 1);
                dJointSetHingeParam(own, dParamLoStop, -stop);
                dJointSetHingeParam(own, dParamHiStop, stop);
                dBodySetAngularVel(thrown, 0, 0, speed);
            }
            rig.run(0.75, frame);
            CHECK(joint->queries().absorbed_energy() == Approx(lost).epsilon(5e-3));
            CHECK(rig.world.run().believed());
        }
    }
}

TEST_CASE("Frames: a universal's stops are foreseen whichever way it was attached", "[frame]") {
    // a rotor of 3 rad/s is stopped at 0.3 rad; the disc on its plastic hinge goes on, 9 J
    constexpr double inertia = 2, speed = 3, strength = 20, stop = 0.3;
    const bool reversed = GENERATE(false, true), second = GENERATE(false, true);
    for (const double frame : all_frames) {
        CAPTURE(reversed, second, frame);
        Rig rig;
        const dBodyID rotor = rig.body(inertia, V3::Constant(inertia), {0, 0, 0});
        const dBodyID disc = rig.body(inertia, V3::Constant(inertia), {0, 0, 0});
        const dJointID own = dJointCreateUniversal(rig.engine.id, nullptr);
        dJointAttach(own, reversed ? nullptr : rotor, reversed ? rotor : nullptr);
        dJointSetUniversalAnchor(own, 0, 0, 0);
        const V3 across(0.6, 0.8, 0), about(0, 0, 1), axis_1 = second ? across : about,
                                                      axis_2 = second ? about : across;
        dJointSetUniversalAxis1(own, axis_1.x(), axis_1.y(), axis_1.z());
        dJointSetUniversalAxis2(own, axis_2.x(), axis_2.y(), axis_2.z());
        const int group = second != reversed ? dParamGroup : 0;
        dJointSetUniversalParam(own, dParamLoStop + group, -dReal(0.5));
        dJointSetUniversalParam(own, dParamHiStop + group, dReal(stop));
        const Hinge& hinge = rig.hinge(disc, rotor, {0, 0, 0}, strength);
        for (const dBodyID body : {rotor, disc}) dBodySetAngularVel(body, 0, 0, speed);
        rig.run(0.5, frame);
        CHECK(hinge.absorbed_energy() == Approx(inertia * speed * speed / 2).epsilon(1e-3));
        CHECK(rig.world.run().believed());
        CHECK(rig.world.run().worst_frame <= 8); // not found by trial
    }
}

TEST_CASE("Frames: a spring whose island is ODE's is solved in parts of any length", "[frame]") {
    constexpr double mass = 5, speed = 1, strength = 1e3, stiffness = 1e3;
    Rig rig;
    const dBodyID block = rig.body(mass, V3(1, 1, 1), {0, 0, 0});
    const dJointID guide = dJointCreateSlider(rig.engine.id, nullptr);
    dJointAttach(guide, block, nullptr);
    dJointSetSliderAxis(guide, 0, 1, 0);
    Slider slider(rig.engine.id, block, nullptr, {0, 1, 0},
                  Law(Perfect<double>({.strength = strength}), {}, {.stiffness = stiffness}));
    rig.world.add(slider);
    dBodySetLinearVel(block, 0, dReal(speed), 0);
    rig.run(0.1, 1.0 / 60);
    for (const double h : {1e-5, 1e-6, 1e-7}) {
        CAPTURE(h);
        rig.world.step(h);
        CHECK(rig.world.frame().unreliable == 0);
    }
}

TEST_CASE("Frames: a joint that is taken out of its World acts no more, in ODE's islands too",
          "[frame]") {
    constexpr double strength = 4, frame = 1.0 / 60;
    for (const bool motor : {true, false}) {
        CAPTURE(motor);
        Rig rig;
        const dBodyID rotor = rig.body(1, V3(2, 2, 2), {0, 0, 0});
        const dJointID pin = dJointCreateHinge(rig.engine.id, nullptr);
        dJointAttach(pin, rotor, nullptr);
        dJointSetHingeAxis(pin, 0, 0, 1);
        if (motor) {
            rig.joints.push_back(
                std::make_unique<ode::PlasticMotor<Law>>(ode::hinge_axis(pin), law(strength)));
            rig.world.add(*rig.joints.back());
        } else {
            rig.hinge(rotor, nullptr, {0, 0, 0}, strength);
        }
        dBodySetAngularVel(rotor, 0, 0, 5);
        rig.run(0.1, frame);
        rig.world.remove(*rig.joints.back());
        const dReal spin = dBodyGetAngularVel(rotor)[2];
        rig.run(0.2, frame);
        CHECK(dBodyGetAngularVel(rotor)[2] == Approx(spin).epsilon(1e-6));
    }
}

TEST_CASE("Frames: what contacts bring in is said, what a driven body brings is not", "[frame]") {
    // beside two boxes a disc of 1 kg m² is stopped: 2 J by its hinge of 4 N m
    const bool overlap = GENERATE(true, false), driven = GENERATE(true, false);
    CAPTURE(overlap, driven);
    Rig rig;
    rig.set_gravity(0);
    const dBodyID left = rig.body(1, V3(1, 1, 1), {0, 0, 0}, rig.box(0.5, 0.5, 0.5), 1, 2);
    const dBodyID right =
        rig.body(1, V3(1, 1, 1), {overlap ? 0.8 : 1.01, 0, 0}, rig.box(0.5, 0.5, 0.5), 2, 1);
    if (driven) dBodySetKinematic(left);
    dBodySetLinearVel(left, driven || !overlap ? 1 : 0, 0, 0);
    const dBodyID disc = rig.body(1, V3(1, 1, 1), {0, 5, 0});
    dBodySetAngularVel(disc, 0, 0, 2);
    const Hinge& hinge = rig.hinge(disc, nullptr, {0, 5, 0}, 4);
    rig.run(1, 1.0 / 60);
    CHECK(hinge.absorbed_energy() == Approx(2).epsilon(1e-6));
    CHECK(double(dBodyGetLinearVel(right)[0]) > 0.4); // was pushed
    const RunReport& run = rig.world.run();
    CHECK((run.brought_in > 0.02) == (overlap && !driven));
    CHECK(run.believed() == !(overlap && !driven));
}

TEST_CASE("Frames: what is driven pushes, and its work is none of the contact's", "[frame]") {
    // a ball of 0.1 m at x on the face of a post that is turned by q: y sin q - x cos q = 0.15 m
    constexpr double strength = 500, speed = 2, start = -0.31, height = 0.7, time = 0.4;
    constexpr double x = start + speed * time, away = 0.15;
    const double turn = std::asin(away / std::hypot(x, height)) + std::atan2(x, height);
    for (const double frame : all_frames) {
        CAPTURE(frame);
        Rig rig;
        const dBodyID post =
            rig.body(12, {1, 0.01, 1}, {0, 0.5, 0}, rig.box(0.05, 0.5, 0.05), 1, 2);
        const dBodyID ball = rig.body(1, {1, 1, 1}, {start, height, 0}, rig.sphere(0.1), 2, 1);
        dBodySetKinematic(ball);
        dBodySetLinearVel(ball, dReal(speed), 0, 0);
        const Hinge& hinge = rig.hinge(post, nullptr, {0, 0, 0}, strength);
        rig.run(time, frame);
        CHECK(hinge.absorbed_energy() == Approx(strength * turn).epsilon(0.01));
        CHECK(rig.world.run().believed());
        CHECK(rig.world.run().worst_frame < 60);
    }
}

TEST_CASE("Frames: damping is that of frames, however many parts they have", "[frame]") {
    // ODE takes a share of the velocity in each step; the ball meets nothing, the rotor yields
    const auto left = [](double tolerance) {
        Rig rig({.tolerance = tolerance, .rest_damping = 0, .warn = {}});
        const dBodyID ball = rig.body(1, V3(1, 1, 1), {0, 5, 0});
        dBodySetLinearVel(ball, 1, 0, 0);
        dBodySetLinearDamping(ball, dReal(0.02));
        const dBodyID rotor = rig.body(1, V3(2, 2, 2), {0, 0, 0});
        dBodySetAngularVel(rotor, 0, 0, 7);
        rig.hinge(rotor, nullptr, {0, 0, 0}, 40);
        rig.run(0.5, 1.0 / 60);
        CHECK(double(dBodyGetLinearDamping(ball)) == Approx(0.02));
        return double(dBodyGetLinearVel(ball)[0]);
    };
    CHECK(left(0.01) == Approx(std::pow(0.98, 30)).epsilon(1e-9));
    CHECK(left(1e-5) == Approx(std::pow(0.98, 30)).epsilon(1e-9));
}

TEST_CASE("Frames: islands fall asleep as a whole, and what strikes wakes them", "[frame]") {
    Rig rig;
    rig.set_gravity(9.81);
    rig.friction = 0.5;
    dWorldSetCFM(rig.engine.id, dReal(1e-10));
    const dGeomID floor = dCreatePlane(rig.engine.space, 0, 1, 0, 0);
    dGeomSetCategoryBits(floor, 1);
    dGeomSetCollideBits(floor, 6);
    const dBodyID post = rig.body(50, V3(2, 2, 2), {0, 0.5, 0}, rig.box(0.05, 0.45, 0.05), 2, 4);
    const Hinge& hinge = rig.hinge(post, nullptr, {0, 0.05, 0}, 4000);
    const dBodyID lower = rig.body(10, V3(1, 1, 1), {3, 0.5, 0}, rig.box(0.5, 0.5, 0.5), 4, 7);
    const dBodyID upper = rig.body(10, V3(1, 1, 1), {3, 1.5, 0}, rig.box(0.5, 0.5, 0.5), 4, 7);
    for (const dBodyID body : {post, lower, upper}) {
        dBodySetAutoDisableFlag(body, 1);
        dBodySetAutoDisableTime(body, dReal(0.2));
    }
    const auto asleep = [](dBodyID body) { return dBodyIsEnabled(body) == 0; };
    rig.run(3, 1.0 / 60);
    CHECK(asleep(post));
    CHECK(asleep(lower));
    CHECK(asleep(upper));
    CHECK(dBodyGetAutoDisableAverageSamplesCount(post) == 1); // as the user has it
    const double asleep_energy = rig.world.ledger().booked(Account::sleep);
    CHECK(asleep_energy >= 0);
    CHECK(std::abs(rig.world.ledger().unexplained()) < 1e-6);
    const dBodyID ball = rig.body(20, V3(1, 1, 1), {-1, 0.8, 0}, rig.sphere(0.2), 4, 2);
    dBodySetGravityMode(ball, 0);
    dBodySetLinearVel(ball, 6, 0, 0);
    rig.run(3.5, 1.0 / 60);
    CHECK(hinge.absorbed_energy() > 10);
    CHECK(asleep(lower)); // no business of theirs
}

TEST_CASE("Frames: halves that overlap as their joint breaks are not pushed apart", "[frame]") {
    for (const double frame : all_frames) {
        Rig rig;
        const auto half = [&rig](double mass, double x) {
            return rig.body(mass, mass * V3(0.03, 0.1, 0.1), {x, 0, 0}, rig.box(0.5, 0.2, 0.2), 1,
                            1);
        };
        const dBodyID post = half(20000, -0.5), arm = half(500, 0.5);
        Hinge hinge(rig.engine.id, post, arm,
                    ode::HingeFrame{.anchor = {0, 0, 0}, .axis = {0, 0, 1}},
                    Law(Perfect<double>({.strength = 12e3}), TravelLimit<double>({.limit = 0.5})));
        rig.world.add(hinge);
        dBodySetLinearVel(arm, 0, 5, 0);
        dBodySetAngularVel(arm, 0, 0, 10);
        rig.run(0.4, frame);
        REQUIRE(hinge.broken());
        CHECK(rig.world.run().brought_in < 1e-3 * hinge.absorbed_energy());
        CHECK(rig.world.run().believed());
    }
}

TEST_CASE("Frames: what leaves at once wakes what it lay on", "[frame]") {
    for (const double frame : all_frames) {
        Rig rig;
        rig.set_gravity(9.81);
        const dBodyID head = rig.body(50, V3(2, 2, 2), {0, 0, 0}, rig.box(0.5, 0.1, 0.5), 1, 2);
        rig.slider(head, V3(0, 1, 0), 5000);
        const dBodyID load = rig.body(20, V3(1, 1, 1), {0, 0.35, 0}, rig.box(0.25, 0.25, 0.25), 2);
        for (const dBodyID body : {head, load}) dBodySetAutoDisableFlag(body, 1);
        rig.run(2, frame);
        REQUIRE(dBodyIsEnabled(head) == 0);
        REQUIRE(dBodyIsEnabled(load) == 0);
        dBodyEnable(load);
        dBodySetLinearVel(load, 0, 20, 0);
        rig.world.step(frame);
        CHECK(dBodyIsEnabled(head) == 1); // as in a step of ODE's
    }
}

TEST_CASE("Frames: what ODE does not tell is asked for by name", "[frame]") {
    using Catch::Matchers::Contains;
    const auto contact_of = [](Rig& rig, dBodyID body, bool named) {
        dContact contact{};
        contact.geom.normal[1] = 1;
        const dJointID joint = dJointCreateContact(rig.engine.id, rig.engine.contacts, &contact);
        dJointAttach(joint, body, nullptr);
        if (named) rig.world.add_contact(joint, contact);
    };
    {
        Rig rig;
        const dBodyID body = rig.body(1, V3(1, 1, 1), {0, 0, 0});
        CHECK_THROWS_WITH(contact_of(rig, body, true), Contains("World.add_contact"));
        CHECK_THROWS_WITH(rig.world.step(0.01), Contains("contacts before the step"));
    }
    {
        Rig rig; // whose callback does not name them
        const dBodyID body = rig.body(1, V3(1, 1, 1), {0, 0, 0});
        dBodySetLinearVel(body, 0, 1, 0);
        rig.slider(body, {0, 1, 0}, 1);
        rig.world.on_contacts({.group = rig.engine.contacts},
                              [&] { contact_of(rig, body, false); });
        CHECK_THROWS_WITH(rig.world.step(0.01), Contains("was not named"));
        CHECK(dBodyGetPosition(body)[1] == 0); // as it was
    }
    {
        Rig rig;
        const dBodyID body = rig.body(1, V3(1, 1, 1), {0, 0, 0});
        const dBodyID unknown = dBodyCreate(rig.engine.id);
        const dJointID ball = dJointCreateBall(rig.engine.id, nullptr);
        dJointAttach(ball, body, unknown);
        CHECK_THAT(message_of([&] { rig.world.step(0.01); }), Contains("must have been added"));
        rig.world.add(unknown);
        CHECK_NOTHROW(rig.world.step(0.01));
        const dBodyID with_geom = dBodyCreate(rig.engine.id);
        dGeomSetBody(rig.sphere(0.1), with_geom);
        CHECK_THAT(message_of([&] { rig.world.step(0.01); }), Contains("must have been added"));
    }
    Rig rig;
    CHECK_THAT(message_of([&] { rig.world.on_contacts({}, [] {}); }), Contains("group = null"));
    CHECK_THAT(message_of([&] { rig.world.on_contacts({.group = rig.engine.contacts}, {}); }),
               Contains("on_contacts.make"));
}

TEST_CASE("Frames: what makes no contact is refused by the step, whose callback ends", "[frame]") {
    using Catch::Matchers::Contains;
    constexpr auto nan = dReal(std::numeric_limits<double>::quiet_NaN());
    constexpr auto infinity = dReal(std::numeric_limits<double>::infinity());
    struct Wrong {
        const char* said;
        int mode;
        void (*make)(dContact&);
    };
    const Wrong wrongs[] = {
        {"geom.normal", 0, [](dContact& contact) { contact.geom.normal[1] = nan; }},
        {"geom.normal", 0, [](dContact& contact) { contact.geom.normal[1] = 0; }},
        {"geom.pos", 0, [](dContact& contact) { contact.geom.pos[2] = infinity; }},
        {"geom.depth = nan", 0, [](dContact& contact) { contact.geom.depth = nan; }},
        {"fdir1", dContactFDir1, [](dContact& contact) { contact.fdir1[0] = nan; }},
        {"surface.mu = nan", 0, [](dContact& contact) { contact.surface.mu = nan; }},
        {"surface.bounce", dContactBounce, [](dContact& contact) { contact.surface.bounce = nan; }},
        {"surface.soft_cfm = inf", dContactSoftCFM,
         [](dContact& contact) { contact.surface.soft_cfm = infinity; }},
        {"surface.motion1", dContactMotion1,
         [](dContact& contact) { contact.surface.motion1 = nan; }},
        {"surface.slip2", dContactSlip2, [](dContact& contact) { contact.surface.slip2 = nan; }},
    };
    for (const double tolerance : {0.0, 0.01}) {
        for (const Wrong& wrong : wrongs) {
            CAPTURE(tolerance, wrong.said);
            Rig rig({.tolerance = tolerance, .rest_damping = 0, .warn = {}});
            const dBodyID body = rig.body(1, V3(1, 1, 1), {0, 0.09, 0}, rig.sphere(0.1), 1, 1);
            rig.slider(body, {0, 1, 0}, 1);
            const dGeomID floor = dCreatePlane(rig.engine.space, 0, 1, 0, 0);
            struct Scene {
                Rig& rig;
                const Wrong& wrong;
                bool right = false;
            } scene{rig, wrong};
            rig.world.on_contacts(
                {.space = rig.engine.space, .group = rig.engine.contacts}, [&rig, &scene] {
                    dSpaceCollide(rig.engine.space, &scene, [](void* data, dGeomID a, dGeomID b) {
                        const auto& [of, what, right] = *static_cast<Scene*>(data);
                        dContact contact{};
                        if (dCollide(a, b, 1, &contact.geom, int(sizeof(dContact))) == 0) return;
                        contact.surface.mode = what.mode;
                        if (!right) what.make(contact);
                        const dJointID joint =
                            dJointCreateContact(of.engine.id, of.engine.contacts, &contact);
                        dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
                        of.world.add_contact(joint, contact);
                    });
                });
            CHECK_THAT(message_of([&] { rig.world.step(0.01); }),
                       Contains(std::string("World.add_contact.") + wrong.said));
            CHECK(rig.world.time() == 0);
            CHECK(dBodyGetPosition(body)[1] == dReal(0.09));
            dGeomDestroy(floor); // no space is locked
            scene.right = true;
            CHECK_NOTHROW(rig.world.step(0.01));
        }
    }
}

TEST_CASE("Frames: contacts that cannot be put back, or made, are refused", "[frame]") {
    using Catch::Matchers::Contains;
    Rig rig;
    const dBodyID body = rig.body(1, V3(1, 1, 1), {0, 0.1, 0}, rig.sphere(0.1), 1, 1);
    rig.slider(body, {0, 1, 0}, 1);
    const dBodyID unknown = dBodyCreate(rig.engine.id);
    bool meets = true;
    rig.world.on_contacts({.group = rig.engine.contacts}, [&] {
        dContact contact{};
        contact.geom.normal[1] = 1;
        const dJointID joint = dJointCreateContact(rig.engine.id, rig.engine.contacts, &contact);
        dJointAttach(joint, body, meets ? unknown : nullptr);
        rig.world.add_contact(joint, contact);
    });
    CHECK_THAT(message_of([&] { rig.world.step(0.01); }), Contains("must have been added"));
    meets = false;
    CHECK_NOTHROW(rig.world.step(0.01));
    dBodySetPosition(body, 0, dReal(1e9), 0);
    CHECK_THAT(message_of([&] { rig.world.step(0.01); }), Contains("must be <= 1e8"));
    dBodySetPosition(body, 0, dReal(0.1), 0);
    rig.world.on_contacts({.group = rig.engine.contacts}, [&] {
        const dJointID ball = dJointCreateBall(rig.engine.id, rig.engine.contacts);
        rig.world.add_contact(ball, {});
    });
    CHECK_THAT(message_of([&] { rig.world.step(0.01); }), Contains("must be a contact joint"));
    rig.world.on_contacts({.group = rig.engine.contacts}, [&] { rig.world.step(0.01); });
    CHECK_THROWS_WITH(rig.world.step(0.01), Contains("within a step"));
    rig.world.on_contacts({.group = rig.engine.contacts},
                          [&] { rig.world.on_contacts({.group = rig.engine.contacts}, [] {}); });
    CHECK_THROWS_WITH(rig.world.step(0.01), Contains("while contacts are made"));
}

TEST_CASE("Frames: figures of balls on a post", "[.][figures]") {
    for (const Solver solver : {Solver::direct, Solver::quick}) {
        for (const int balls : {1, 2}) {
            for (const double speed : {1.0, 2.0, 5.0, 10.0, 20.0}) {
                std::printf("%s, %d at %g m/s:", solver == Solver::direct ? "direct" : "quick",
                            balls, speed);
                for (const double frame :
                     {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480, 1e-3}) {
                    std::printf(" %.6g", work_of_balls(balls, speed, frame, solver));
                    std::fflush(stdout);
                }
                std::printf("\n");
            }
        }
    }
}
