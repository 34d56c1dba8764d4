// SPDX-License-Identifier: MIT
//
// P08 through a joint: four parallel elements as the law of a OneAxisJoint of their stiffness,
// driven along the path of the table and swinging freely.
//
// Source: Masing (1926); Iwan (1966), doi:10.1115/1.3625199.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/iwan.hpp"
#include "reference/expect.hpp"
#include "reference/problems/oscillator.hpp"
#include "reference/world.hpp"

using namespace ductile;
using namespace ductile::reference;

namespace {

constexpr std::array<IwanElement<double>, 4> elements{
    {{4000, 4}, {3000, 6}, {2000, 8}, {1000, 10}}};
using Law = Iwan<double, 4>;

/// A shaft that is driven, with the joint against the ground.
struct Driven {
    explicit Driven(bool mass_known = true)
        : joint(Law(elements), TravelLimit<double>(), {.stiffness = Law(elements).stiffness()}) {
        if (!mass_known) world.withhold_mass();
        const int shaft = world.add_degree(1);
        row = world.add_row({{shaft}}, joint);
        motor = world.add_rigid_row({{shaft}});
    }
    Driven(const Driven&) = delete;
    Driven& operator=(const Driven&) = delete;

    void move(double to, int steps) {
        world.drive(motor, (to - at) / (steps * dt));
        for (int i = 0; i < steps; ++i) world.step(dt);
        at = to;
    }
    /// Force that holds it where it is.
    double force() {
        world.drive(motor, 0);
        world.step(dt);
        return -world.reaction(row).force;
    }

    static constexpr double dt = 1e-3;
    World<double> world;
    OneAxisJoint<Law> joint;
    std::size_t row = 0, motor = 0;
    double at = 0;
};

/// Energy under the backbone up to u [J].
double area(double u) {
    double sum = 0;
    for (const auto& [k, f] : elements) {
        sum += u * k < f ? k * u * u / 2 : f * u - f * f / (2 * k);
    }
    return sum;
}

} // namespace

TEST_CASE("P08 a driven joint of parallel elements follows backbone and memory at any step",
          "[reference][P08]") {
    for (const int steps : {1, 3, 100}) {
        INFO(steps << " steps a leg");
        Driven backbone;
        for (const auto& [u, force] :
             {std::pair{0.001, 10.0}, {0.002, 16.0}, {0.004, 22.0}, {0.010, 28.0}}) {
            backbone.move(u, steps);
            CHECK(backbone.force() == Approx(force).epsilon(1e-9));
        }
        Driven path;
        for (const auto& [u, force] : {std::pair{0.008, 26.0},
                                       {-0.004, -22.0},
                                       {0.006, 24.0},
                                       {0.008, 26.0},
                                       {0.012, 28.0},
                                       {0.0, -20.0},
                                       {-0.012, -28.0}}) {
            path.move(u, steps);
            CHECK(path.force() == Approx(force).epsilon(1e-9));
        }
    }
}

TEST_CASE("P08 a driven joint of parallel elements loses the area of its loops",
          "[reference][P08]") {
    for (const auto& [amplitude, loop] :
         {std::pair{0.003, 0.056}, {0.008, 0.384}, {0.012, 0.752}}) {
        Driven path;
        path.move(amplitude, 7);
        for (int turn = 0; turn < 3; ++turn) {
            const double work = path.joint.state().plastic_work;
            const double stored = path.joint.state().stored;
            path.move(-amplitude, 10);
            path.move(amplitude, 10);
            INFO("u_a = " << amplitude);
            CHECK(path.joint.state().plastic_work - work == Approx(loop).epsilon(1e-9));
            CHECK(path.joint.state().stored == Approx(stored).epsilon(1e-9));
        }
    }
}

TEST_CASE("P08 a mass on parallel elements turns where its energy is used up", "[reference][P08]") {
    // 2 kg, energy under the backbone to 8 mm
    const double peak = 0.008, mass = 2;
    expect_trends(
        "P08",
        [&](double step) {
            Oscillator body(mass, Law(elements).stiffness(), Law(elements));
            const double speed = std::sqrt(2 * area(peak) / mass);
            body.set_velocity(speed);
            const auto turns = peaks(body, step, 0.2, [](double) { return 0.0; });
            return std::vector<Quantity>{
                {"peak", "m", turns.at(0).position, peak, Trend::second_order},
                {"ledger", "J", body.unexplained(mass * speed * speed / 2), 0, Trend::exact}};
        },
        {.dt = 1e-3});
}

TEST_CASE("P08 an implicit row of parallel elements keeps its loops", "[reference][P08]") {
    for (const int steps : {10, 80, 640}) {
        INFO(steps << " steps a leg");
        Driven path(false);
        path.move(0.008, steps);
        for (int turn = 0; turn < 100; ++turn) {
            const double work = path.joint.state().plastic_work;
            path.move(-0.008, steps);
            path.move(0.008, steps);
            CHECK(path.joint.state().plastic_work - work == Approx(0.384).epsilon(1e-9));
        }
        CHECK(path.force() == Approx(26).epsilon(1e-9));
    }
}
