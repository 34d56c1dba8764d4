// SPDX-License-Identifier: MIT
//
// Structures that lie on a floor: where they slide, where they tip, and that stacks stand. Compiled
// for every engine and precision (RIG_HEADER); contacts are the engine's own, solved with the
// joints.
#include RIG_HEADER

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "adapters/frame.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

using Body = StructureRig::Body;
using V3 = Vector3<double>;

constexpr double g = 9.81, dt = 1.0 / 60;
/// The velocity at the end of a step acts for all of it, but not in a frame.
constexpr double late = StructureRig::in_frames ? 0 : dt;

UsualSixAxisJoint strong() {
    return UsualSixAxisJoint(Ellipsoid<double, 6>({.capacity = Vector6<double>::Constant(1e8)}),
                             Perfect<double>({.strength = 1}));
}

/// Gravity on a ground that is tilted by `angle` about y: down the slope is along x.
V3 tilted(double angle) { return V3(g * std::sin(angle), 0, -g * std::cos(angle)); }

/// When all is there.
void settle(StructureRig& rig, double friction) {
    rig.set_friction(friction);
    rig.keep_awake();
}

/// P38's block of 1 x 1 x 2 m and 1000 kg, in two halves that a plastic joint holds.
struct Block {
    Block(const V3& gravity, double friction, const engine::WorldParameters& parameters = {})
        : rig(g, parameters) {
        rig.set_gravity(gravity);
        lower = rig.box(500, V3(0.5, 0.5, 0.5), V3(0, 0, 0.5 - StructureRig::layer));
        upper = rig.box(500, V3(0.5, 0.5, 0.5), V3(0, 0, 1.5 - StructureRig::layer));
        rig.connect(upper, lower, V3(0, 0, 1 - StructureRig::layer), strong());
        settle(rig, friction);
        rig.run(20 * dt, dt);
        from = StructureRig::place(lower);
    }
    /// Pushed at a height above its centre of mass for a second.
    void push(double force, double above) {
        for (int i = 0; i < 60; ++i) {
            const V3 centre = (StructureRig::place(lower) + StructureRig::place(upper)) / 2;
            StructureRig::apply_force(upper, V3(force, 0, 0), centre + V3(0, 0, above));
            rig.step(dt);
        }
    }
    [[nodiscard]] double slid() const { return (StructureRig::place(lower) - from).x(); }
    [[nodiscard]] double leans() const {
        return (StructureRig::place(upper) - StructureRig::place(lower)).x();
    }

    StructureRig rig;
    Body lower = nullptr, upper = nullptr;
    V3 from;
};

/// Of a thing at rest: what round-off and the contacts' compliance let it move.
constexpr double still = StructureRig::single ? 1e-4 : 1e-6;

} // namespace

TEST_CASE("P38 a block slides and tips by the push that it should", "[contacts]") {
    // mu m g = 5886 N; at 1.5 m m g b/(2 x 1.5) = 3270 N
    struct Case {
        double force, above;
        bool slides, tips;
    };
    const Case c =
        GENERATE(Case{0.99 * 5886, -0.5, false, false}, Case{1.01 * 5886, -0.5, true, false},
                 Case{0.99 * 3270, 0.5, false, false}, Case{1.01 * 3270, 0.5, false, true});
    INFO(c.force << " N at " << 1 + c.above << " m");
    Block block(V3(0, 0, -g), 0.6);
    block.push(c.force, c.above);
    CHECK((std::abs(block.leans()) > 1e-3) == c.tips);
    if (!c.tips) {
        const double a = c.force / 1000 - 0.6 * g;
        const double way = c.slides ? a * (1 + late) / 2 : 0;
        CHECK(block.slid() == Approx(way).epsilon(0.01).margin(still));
    }
    CHECK(block.rig.lines().empty());
}

TEST_CASE("P38 a block on a tilted ground tips at 26.5651 degrees and slides at 30.9638",
          "[contacts]") {
    const double tips = std::atan(0.5);
    for (const double angle : {0.99 * tips, 1.01 * tips}) {
        Block block(tilted(angle), 0.6);
        block.push(0, 0);
        CHECK((std::abs(block.leans()) > 1e-3) == (angle > tips));
        if (angle < tips) CHECK(std::abs(block.slid()) < still);
        CHECK(block.rig.lines().empty());
    }
    // lying down it cannot tip
    for (const double factor : {0.99, 1.01, 1.1}) {
        const double angle = std::atan(factor * 0.6);
        StructureRig rig;
        rig.set_gravity(tilted(angle));
        const double z = 0.25 - StructureRig::layer;
        const Body tail = rig.box(500, V3(0.5, 0.5, 0.25), V3(0, 0, z));
        const Body head = rig.box(500, V3(0.5, 0.5, 0.25), V3(1, 0, z));
        rig.connect(head, tail, V3(0.5, 0, z), strong());
        settle(rig, 0.6);
        constexpr int steps = 120;
        for (int i = 0; i < steps; ++i) rig.step(dt);
        constexpr double time = steps * dt;
        const double rate =
            std::max(0.0, g * (std::sin(angle) - 0.6 * std::cos(angle))) * time * (time + late) / 2;
        INFO("slope " << factor << " of the friction angle");
        CHECK(StructureRig::place(tail).x() == Approx(rate).epsilon(0.01).margin(still));
        CHECK(rig.lines().empty());
    }
}

TEST_CASE("P38 a block rocks with its period, and landing takes half of its energy", "[contacts]") {
    // alpha: from its diagonal to upright; p^2 = 3 g/(4 R)
    const double alpha = std::atan(0.5), p2 = 0.75 * g / std::hypot(0.5, 1.0);
    struct Case {
        double first, period, next; ///< amplitude [alpha], without loss [s], after landing [rad]
    };
    const Case c = GENERATE(Case{0.2, 1.094443, 0.0430262}, Case{0.5, 2.066521, 0.0956508},
                            Case{0.8, 3.583321, 0.127562});
    CAPTURE(c.first);
    engine::WorldParameters parameters;
    parameters.tolerance = 0.01;
    Block block(V3(0, 0, -g), 2, parameters);
    // from the floor, about its edge
    const double first = c.first * alpha,
                 spin = std::sqrt(2 * p2 * (std::cos(alpha - first) - std::cos(alpha)));
    for (const Body half : {block.lower, block.upper}) {
        const V3 arm = StructureRig::place(half) - V3(0.5, 0, -StructureRig::layer);
        StructureRig::set_velocity(half, V3(0, spin, 0).cross(arm), V3(0, spin, 0));
    }
    double most = 0, landed = 0, least = 0, before = 0;
    for (int i = 1; i * dt < c.period; ++i) {
        block.rig.step(dt);
        const double angle = std::asin(block.leans());
        if (landed == 0 && angle < 0) landed = dt * (i - angle / (angle - before));
        most = std::max(most, angle);
        least = std::min(least, angle);
        before = angle;
    }
    CHECK(most == Approx(first).epsilon(0.01));
    CHECK(landed == Approx(c.period / 2).epsilon(0.01));
    // it lands on a floor that is a layer above its edge
    CHECK(-least == Approx(c.next).epsilon(0.01).margin(2 * StructureRig::layer));
    CHECK(block.rig.lines().empty());
}

TEST_CASE("A moment on what lies on a floor turns it or not, and does not push it", "[contacts]") {
    // Bullet's friction knows nothing of torques: half of a box crept by 76 mm in a second
    for (const double tolerance : {0.0, 0.01}) {
        for (const V3& moment : {V3(0, 1000, 0), V3(-700, 700, 0), V3(0, 0, 1000)}) {
            CAPTURE(tolerance, moment.transpose());
            engine::WorldParameters parameters;
            parameters.tolerance = tolerance;
            StructureRig rig(g, parameters);
            const double z = 0.25 - StructureRig::layer;
            const Body tail = rig.box(500, V3(0.5, 0.5, 0.25), V3(0, 0, z));
            const Body head = rig.box(500, V3(0.5, 0.5, 0.25), V3(1, 0, z));
            rig.connect(head, tail, V3(0.5, 0, z), strong());
            settle(rig, 0.6);
            rig.run(20 * dt, dt);
            const V3 from = StructureRig::place(tail);
            for (int i = 0; i < 60; ++i) {
                const V3 at = StructureRig::place(tail),
                         arm = moment.z() == 0 ? V3(0, 0, 0.2) : V3(0.4, 0, 0);
                // a couple, arm x force = moment/2
                const V3 half = moment.cross(arm) / (2 * arm.squaredNorm());
                StructureRig::apply_force(tail, half, at + arm);
                StructureRig::apply_force(tail, -half, at - arm);
                rig.step(dt);
            }
            CHECK((StructureRig::place(tail) - from).norm() < still);
            CHECK(StructureRig::motion(head).spin.norm() < still);
            CHECK(rig.lines().empty());
        }
    }
}

TEST_CASE("P38 the frame of P29 on narrow feet slides and tips as one rigid body", "[contacts]") {
    // footings of 0.2 m; with a third of the weights its joints bear what it comes to
    constexpr double share = 0.3, wide = 0.2, of_frame = 41359.8, of_feet = 4 * 260, high = 0.3;
    constexpr double mass = of_frame + of_feet;
    constexpr double centre = (of_frame * (6.741024 + high) + of_feet * high / 2) / mass;
    const double across = std::atan((2.5 + wide / 2) / centre),
                 along = std::atan((3 + wide / 2) / centre);
    FrameSettings settings;
    settings.elastic = false;
    settings.weights = share;
    settings.loose = true;
    settings.footing = wide;
    struct Case {
        double friction, angle;
        V3 down;
        double pull; ///< of what it slides at, on the footings
    };
    const Case c =
        GENERATE_COPY(Case{0.3, std::atan(0.3), V3(0, 1, 0), 0}, Case{0.6, across, V3(0, 1, 0), 0},
                      Case{0.6, along, V3(1, 0, 0), 0}, Case{0.6, 0, V3(1, 0, 0), 1});
    for (const double factor : {0.99, 1.01}) {
        CAPTURE(c.friction, c.angle, c.pull, factor);
        Frame frame(settings);
        settle(frame.rig, c.friction);
        frame.rig.run(0.5, dt);
        const double angle = factor * c.angle;
        frame.rig.set_gravity(share * g *
                              (std::sin(angle) * c.down - std::cos(angle) * V3(0, 0, 1)));
        const auto& plan = frame.structure->plan();
        for (int i = 0; i < 60; ++i) {
            for (std::size_t k = 0; k < plan.bodies.size(); ++k) {
                const auto of_foot = frame.structure->body(k);
                if (c.pull == 0 || StructureRig::place(of_foot).z() > high) continue;
                const double force = factor * c.friction * mass * share * g / 4;
                const V3 at = StructureRig::place(of_foot);
                StructureRig::apply_force(of_foot, force * c.down, V3(at.x(), at.y(), 0));
            }
            frame.rig.step(dt);
        }
        const double way = frame.structure->displacement("beam 20").dot(c.down);
        if (factor < 1) {
            CHECK(std::abs(way) < (StructureRig::single ? 1e-3 : 2e-5));
        } else {
            CHECK(way > 2e-3);
        }
        CHECK(frame.structure->absorbed_energy() == 0);
        CHECK(frame.rig.lines().empty());
    }
}

TEST_CASE("P38 a portal on point feet slides at 10300.5 N at its eave", "[contacts]") {
    // legs of 250, beam of 3000 kg, h = 4, L = 6 m, mu = 0.3; it would tip at 25751 N
    constexpr double slides = 10300.5, h = 4, span = 6;
    for (const double factor : {0.99, 1.01}) {
        StructureRig rig;
        const double up = -StructureRig::layer;
        std::array<Body, 2> leg{};
        for (const int side : {0, 1}) {
            leg[std::size_t(side)] =
                rig.box(250, V3(0.02, 0.02, h / 2), V3(side * span, 0, h / 2 + up));
        }
        // the beam is as wide as it takes to stand across the plane
        const Body beam =
            rig.box(3000, V3(span / 2 - 0.1, 0.02, 0.05), V3(span / 2, 0, h - 0.1 + up));
        std::array<StructureRig::Joint*, 2> knee{};
        for (const int side : {0, 1}) {
            knee[std::size_t(side)] =
                &rig.connect(leg[std::size_t(side)], beam, V3(side * span, 0, h + up), strong());
        }
        settle(rig, 0.3);
        for (int i = 0; i < 60; ++i) {
            StructureRig::apply_force(beam, V3(factor * slides, 0, 0),
                                      StructureRig::place(beam) + V3(-span / 2, 0, 0.1));
            rig.step(dt);
        }
        const double a = (factor - 1) * slides / 3500;
        const double way = factor > 1 ? a * dt * dt * 60 * 61 / 2 : 0;
        CHECK(StructureRig::place(beam).x() - span / 2 ==
              Approx(way).epsilon(0.02).margin(10 * still));
        if (factor > 1) { // knees carry mu N h, N of 10300.5 and 24034.5 N at the feet
            CHECK(std::abs(knee[0]->force(JointAxis::bending_y)) == Approx(12360.6).epsilon(0.03));
            CHECK(std::abs(knee[1]->force(JointAxis::bending_y)) == Approx(28841.4).epsilon(0.03));
        }
        CHECK(rig.lines().empty());
    }
}

TEST_CASE("Ten and thirty boxes stand under a heavy one", "[contacts]") {
    // 1000 kg on boxes of 10 kg; the lowest one is in two halves that a joint holds
    const int boxes = GENERATE(10, 30);
    INFO(boxes << " boxes");
    StructureRig rig;
    const double edge = 0.5, less = StructureRig::layer;
    const Body left =
        rig.box(5, V3(edge / 4, edge / 2, edge / 2), V3(-edge / 4, 0, edge / 2 - less));
    const Body right =
        rig.box(5, V3(edge / 4, edge / 2, edge / 2), V3(edge / 4, 0, edge / 2 - less));
    rig.connect(right, left, V3(0, 0, edge / 2 - less), strong());
    Body top = nullptr;
    for (int i = 1; i < boxes; ++i) {
        top = rig.box(i + 1 == boxes ? 1000 : 10, V3::Constant(edge / 2),
                      V3(0, 0, edge * (i + 0.5) - less * (i + 1)));
    }
    settle(rig, 0.6);
    rig.run(1, dt);
    const V3 from = StructureRig::place(top);
    rig.run(5, dt);
    const V3 way = StructureRig::place(top) - from;
    CHECK(way.cwiseAbs().maxCoeff() < (StructureRig::single ? 2e-2 : 5e-5));
    CHECK(rig.lines().empty());
}

TEST_CASE("A box that lands as good as flush strikes with its whole face", "[contacts]") {
    // 1 t at 5 m/s on a cantilever of 400 kg. Which corner is first is the last digit's say, and
    // struck one by one they absorbed 9.85 to 10.13 kJ.
    Vector6<double> capacity = Vector6<double>::Constant(1e6);
    capacity[std::size_t(JointAxis::bending_y)] = 5e4;
    capacity[std::size_t(JointAxis::bending_x)] = capacity[std::size_t(JointAxis::torsion)] = 2e4;
    const auto work = [&](const V3& tilt, double frame) {
        engine::WorldParameters parameters;
        parameters.tolerance = 0.01;
        StructureRig rig(0, parameters);
        const Body wall = rig.box(1e9, V3(0.1, 0.5, 0.5), V3(-0.1, 0, 2));
        const Body beam = rig.box(400, V3(2, 0.1, 0.1), V3(2, 0, 2));
        const auto& joint =
            rig.connect(beam, wall, V3(0, 0, 2),
                        UsualSixAxisJoint(Ellipsoid<double, 6>({.capacity = capacity}),
                                          Perfect<double>({.strength = 1})));
        const Body box = rig.box(1000, V3(0.2, 0.2, 0.2), V3(3, 0, 2.4));
        StructureRig::set_velocity(box, V3(0, 0, -5), tilt / 0.02); // 0.1 m above the beam
        rig.run(0.4, frame);
        CHECK(rig.world().run().believed());
        return joint.absorbed_energy();
    };
    // the digits of a float's places are as large as what the tilt lifts
    constexpr double alike = StructureRig::single ? 0.01 : 0.004;
    const double flush = work(V3::Zero(), dt);
    for (const V3& tilt : {V3(1e-6, 1e-6, 0), V3(-1e-6, 0, 0), V3(2e-5, -2e-5, 0)}) {
        for (const double frame : {dt, dt / 4}) {
            CAPTURE(tilt.transpose(), frame);
            CHECK(work(tilt, frame) == Approx(flush).epsilon(alike));
        }
    }
}

TEST_CASE(
    "A wall of bricks on plastic joints that is struck is solved, and takes the same in any frame",
    "[contacts]") {
    if (!StructureRig::in_frames) return;
    constexpr int wide = 6, high = 4;
    constexpr double length = 0.4, height = 0.2, joint = 0.01; // [m]
    const auto absorbed = [](double frame) {
        StructureRig rig;
        const UsualSixAxisJoint mortar( // [N, N m], 60 J
            Ellipsoid<double, 6>(
                {.capacity = (Vector6<double>() << 3e3, 3e3, 3e3, 120, 120, 120).finished()}),
            Perfect<double>({.strength = 1}), TravelLimit<double>({.limit = 60}));
        const V3 half(0.5 * (length - joint), 0.1, 0.5 * (height - joint));
        std::array<std::array<Body, wide>, high> bricks{};
        std::vector<StructureRig::Joint*> joints;
        for (std::size_t k = 0; k < high; ++k) {
            for (std::size_t i = 0; i < wide; ++i) {
                const V3 at(length * double(i), 0, half.z() + height * double(k));
                bricks[k][i] = rig.box(30, half, at);
                if (i > 0) {
                    joints.push_back(&rig.connect(bricks[k][i], bricks[k][i - 1],
                                                  at - V3(length / 2, 0, 0), mortar));
                }
                if (k > 0) {
                    joints.push_back(&rig.connect(bricks[k][i], bricks[k - 1][i],
                                                  at - V3(0, 0, height / 2), mortar));
                }
            }
        }
        const Body striker = rig.box(50, V3(0.15, 0.15, 0.15), V3(1.05, -0.6, 0.5));
        settle(rig, 0.6);
        StructureRig::set_velocity(striker, V3(0, 5, 0));
        rig.run(0.5, frame);
        CHECK(rig.lines() == std::vector<std::string>());
        double sum = 0;
        for (const StructureRig::Joint* each : joints) sum += each->absorbed_energy();
        return sum;
    };
    const double coarse = absorbed(1.0 / 60), fine = absorbed(1.0 / 240);
    CAPTURE(coarse, fine);
    CHECK(coarse > 140);
    CHECK(coarse == Approx(fine).epsilon(0.03));
}
