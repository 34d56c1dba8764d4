// SPDX-License-Identifier: MIT
//
// Struck beams and posts in a default World, by balls that fly at them: the engine's own contacts,
// which begin anywhere in a frame. P13, P34, P39 and P40, whose tables are of masses that stick:
// these contacts push until all is at rest, or as long as the answer is asked for. Compiled for
// every engine and precision (RIG_HEADER).
#include RIG_HEADER

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "reference/problems/impact.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

using Body = WorldRig::Body;
constexpr bool single = WorldRig::single;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double frames[] = {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000};
constexpr double radius = 0.02, half = 0.001; ///< of balls, and of what they strike [m]
/// Rotations are to be small: speeds times this, rotations and energies times its square.
constexpr double slow = 0.25;

[[nodiscard]] Joint law(double strength, double stiffness = infinity) {
    return Joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = infinity}),
                 {.stiffness = stiffness});
}

/// Rods on hinges and what flies at them.
struct Scene {
    WorldRig rig{Warn([](const std::string&) {})};
    std::vector<WorldRig::Hinge*> hinges;

    Body rod(double mass, double length, const V3& at) {
        return rig.body(mass, V3::Constant(mass * length * length / 12), at);
    }
    void hinge(Body a, Body b, const V3& at, const Joint& of) {
        hinges.push_back(&rig.hinge(a, b, at, of, "hinge " + std::to_string(hinges.size())));
    }
    Body ball(double mass, double size, const V3& at, const V3& velocity) {
        const Body made = rig.ball(mass, size, at);
        WorldRig::set_velocity(made, velocity);
        return made;
    }
    /// The last frame ends with the scene.
    void run(double time, double frame) {
        while (rig.world().time() < time - 1e-9) {
            rig.world().step(std::min(frame, time - rig.world().time()));
        }
    }
    [[nodiscard]] double absorbed() const {
        double sum = 0;
        for (const auto* each : hinges) sum += each->absorbed_energy();
        return sum;
    }
};

} // namespace

TEST_CASE("P13 a ball that strikes a cantilever's tip gives it what a mass that sticks does",
          "[frame][contacts]") {
    constexpr double gap = 0.0123, edge = 0.0005; // on the rod's face, a little before its end
    for (const reference::ParkesCase& c : reference::parkes_cases) {
        const reference::Parkes& of = c.parameters;
        for (const std::size_t row : {0u, 1u, 4u}) {
            const reference::ParkesAnswer& exact = c.answers[row];
            for (const double frame : frames) {
                CAPTURE(c.name, exact.segments, frame);
                Scene scene;
                const int n = exact.segments;
                const double l = of.length / n, mass = of.mass_per_length * l;
                std::vector<Body> rods;
                for (int i = 0; i < n; ++i) {
                    const V3 at((i + 0.5) * l, 0, 0);
                    rods.push_back(i + 1 < n ? scene.rod(mass, l, at)
                                             : scene.rig.box(mass, V3(l / 2, half, 0.02), at));
                    scene.hinge(rods.back(), i == 0 ? nullptr : rods[std::size_t(i - 1)],
                                V3(i * l, 0, 0), law(of.plastic_moment));
                }
                const double speed = slow * of.speed;
                scene.ball(of.tip_mass, radius, V3(of.length - edge, -half - radius - gap, 0),
                           V3(0, speed, 0));
                scene.run(gap / speed + 2 * slow * exact.stop + 0.05, frame);
                double tip = 0;
                for (const Body each : rods) tip += l * std::sin(WorldRig::turn(each).z());
                constexpr double square = slow * slow;
                CHECK(scene.absorbed() ==
                      Approx(square * exact.struck_energy).epsilon(single ? 0.01 : 0.005));
                CHECK(tip == Approx(square * exact.tip).epsilon(0.01));
                CHECK(WorldRig::turn(rods[0]).z() == Approx(square * exact.root).epsilon(0.01));
                CHECK(scene.rig.world().run().believed());
            }
        }
    }
}

TEST_CASE("P34 a car that strikes a lamp-post gives each of its rods what it should",
          "[frame][contacts]") {
    // the car slides along x; work until it has gone 0.25 m and, but for one rod, 0.5 m
    constexpr double length = 8, density = 12.0576, moment = 19641.44, bumper = 0.5, mass = 1200,
                     start = 13.888889, gap = 0.0123, size = 0.002; // a sharp edge
    if (single) return; // an edge of 2 mm is struck anew by the digits of its place
    struct Case {
        int rods;
        double time, speed, work, foot;
    };
    for (const Case& c :
         {Case{1, 0.164358, 1.3182, 9106.8, 9106.8}, Case{2, 0.060217, 3.2008, 28429, 9106.9},
          Case{2, 0.156454, 2.4435, 37569, 15482}, Case{4, 0.025377, 8.8479, 29686, 9108.2},
          Case{4, 0.054672, 8.3681, 44660, 15427}, Case{8, 0.042704, 10.772, 38753, 15426}}) {
        for (const double frame : frames) {
            CAPTURE(c.rods, c.time, frame);
            Scene scene;
            const double l = length / c.rods;
            Body last = nullptr;
            for (int i = 0; i < c.rods; ++i) {
                const V3 at(0, (i + 0.5) * l, 0);
                const bool struck = i * l < bumper && bumper <= (i + 1) * l;
                const Body rod = struck ? scene.rig.box(density * l, V3(half, l / 2, 0.05), at)
                                        : scene.rod(density * l, l, at);
                scene.hinge(rod, last, V3(0, i * l, 0), law(moment));
                last = rod;
            }
            const Body car = scene.rig.ball(mass, size, V3(-half - size - gap, bumper, 0));
            scene.rig.guide(car, V3(1, 0, 0));
            WorldRig::set_velocity(car, V3(start, 0, 0));
            scene.run(gap / start + c.time, frame);
            CHECK(WorldRig::velocity(car).x() == Approx(c.speed).epsilon(0.01));
            CHECK(scene.absorbed() == Approx(c.work).epsilon(0.01));
            CHECK(scene.hinges[0]->absorbed_energy() == Approx(c.foot).epsilon(0.01));
            CHECK(scene.rig.world().run().believed());
        }
    }
}

TEST_CASE("P39 a ball yields an elastic post from the speed that it should", "[frame][contacts]") {
    constexpr double length = 2, bending = 496312.32, moment = 19641.44, density = 12.0576,
                     arm = length - 0.005, gap = 0.0123;
    constexpr double stiffness = 2 * bending / length,
                     inertia = density * length * length * length / 3;
    struct Case {
        double mass, threshold;
    };
    for (const Case& c : {Case{24.1152, 6.5557}, Case{100, 2.8979}, Case{2000, 0.62467}}) {
        for (const double factor : {0.99, 1.01, 1.2}) {
            for (const double frame : frames) {
                CAPTURE(c.mass, factor, frame);
                Scene scene;
                const Body post = scene.rig.box(density * length, V3(length / 2, half, 0.02),
                                                V3(length / 2, 0, 0));
                scene.hinge(post, nullptr, V3::Zero(), law(moment, stiffness));
                const double speed = factor * c.threshold;
                scene.ball(c.mass, radius, V3(arm, -half - radius - gap, 0), V3(0, speed, 0));
                const double both = c.mass * arm * arm + inertia;
                // past the top of its swing, and then never again
                scene.run(gap / speed + 0.7 * M_PI * std::sqrt(both / stiffness), frame);
                const double blow = std::pow(c.mass * speed * arm, 2) / (2 * both);
                const double held = moment * moment / (2 * stiffness);
                if (factor < 1) {
                    CHECK(scene.absorbed() == 0);
                } else {
                    // nothing keeps the ball from going a little along the post, with 0.1 %
                    CHECK(scene.absorbed() == Approx(blow - held).margin(0.0015 * blow));
                }
                CHECK(scene.rig.world().run().believed());
            }
        }
    }
}

TEST_CASE("P40 a ball that strikes a free beam's centre gives it what a mass that sticks does",
          "[frame][contacts]") {
    constexpr double gap = 0.0123;
    struct Case {
        int rods; ///< a half
        double mass, speed, work, angle, common;
    };
    for (const Case& c : {Case{1, 4, 4, 9.6, 0.048, 2}, Case{2, 4, 4, 12, 0.0511111111, 2},
                          Case{5, 4, 4, 14.2533299, 0.0566382875, 2},
                          Case{1, 0.8, 10, 11.1111111, 0.0555555556, 5. / 3},
                          Case{2, 0.8, 10, 16.6666667, 0.0637254902, 5. / 3},
                          Case{5, 0.8, 10, 24.3729904, 0.0822217336, 5. / 3}}) {
        for (const double frame : frames) {
            CAPTURE(c.rods, c.mass, frame);
            Scene scene;
            // a fiftieth of the mass is there before, and moves no faster with the rest than all
            const double there = 0.02 * c.mass, l = 1.0 / c.rods;
            const Body node = scene.rig.box(there, V3(0.005, 0.005, 0.05), V3::Zero());
            std::vector<Body> inner;
            for (const int side : {-1, 1}) {
                Body last = node;
                for (int i = 0; i < c.rods; ++i) {
                    const Body rod = scene.rod(2 * l, l, V3(side * (i + 0.5) * l, 0, 0));
                    scene.hinge(rod, last, V3(side * i * l, 0, 0), law(100));
                    if (i == 0) inner.push_back(rod);
                    last = rod;
                }
            }
            const double speed = slow * c.speed * c.mass / (c.mass - there);
            const Body ball = scene.ball(c.mass - there, radius, V3(0, -0.005 - radius - gap, 0),
                                         V3(0, speed, 0));
            scene.run(gap / speed + 0.06, frame);
            constexpr double square = slow * slow;
            CHECK(scene.absorbed() == Approx(square * c.work).epsilon(single ? 0.01 : 0.005));
            for (const Body rod : inner) {
                CHECK(std::abs(WorldRig::turn(rod).z()) == Approx(square * c.angle).epsilon(0.01));
            }
            CHECK(WorldRig::velocity(ball).y() == Approx(slow * c.common).epsilon(0.005));
            CHECK(scene.rig.world().run().believed());
        }
    }
}
