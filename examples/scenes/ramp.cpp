// SPDX-License-Identifier: MIT
//
// A ramp hangs from one elastic-plastic joint; cars jump onto it.
//
// A scene of S. Nikula's Box2D tests: a plate of 18 m, 2160 kg, level at 5 m, held at one end by a
// joint of 1 Hz of the plate's turn about its middle, k = 2.3024 MN m/rad, a damper of ζ = 0.2
// there, M_p = 0.12 rad k = 276.29 kN m and 0.4 rad of plastic travel. Cars of 680 kg on two axles
// of 50 kg. At rest the weight is 0.69 of M_p; let go all at once it swings to more and flows. The
// car leaves a pad at the height to which his hill throws it, at the 9.86 m/s that his motor gives
// it from a standstill, then at the 13.72 m/s of its full speed.
//
//   share of the 0.4 rad    the author    with dampers    without
//   own weight                 13 %          8.79 %        17.78 %
//   first jump                 50 %         31.5 %         22.7 %
//   each later one              7 %         at most 1.3 %  at most 0.1 %
//
// The last two columns are of ramp.py, which integrates ramp and cars in the plane by itself; plain
// steps (--tolerance 0) read no damper (OneAxisParameters::damping_time). Why not the author's: he
// has g = 10 (own weight 10.3 %), a spring that is solved to the end of each step, and cars that
// fly off a hill, the later ones from 1.7 m higher. What a later jump takes is all or nothing, as
// the ramp swings when the car comes: so only their sum with the first is held to anything.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "scene.hpp"

namespace ductile::scenes {

namespace {

constexpr double length = 18, thick = 0.04, gap = 0.02, mass = 2160, wide = 2.4;
constexpr double pivot_x = 60, pivot_z = 5, edge = 41, pad = 5.8; ///< where the cars leave [m]
constexpr double chassis = 680, axle = 50, radius = 0.4, base = 0.9, height = 0.7;
constexpr double life = 0.4; ///< plastic travel at which the joint breaks [rad]
constexpr std::array<double, 3> speeds{9.86, 13.72, 13.72}; ///< of the cars [m/s]

struct Shares { // of the life, by ramp.py
    double own, first, all;
};
constexpr Shares damped{0.0879, 0.3154, 0.4195}, undamped{0.1778, 0.2270, 0.4052};

class Ramp final : public Scene {
  public:
    [[nodiscard]] std::string name() const override { return "ramp"; }
    [[nodiscard]] std::string about() const override {
        return "a ramp of 2.2 t on one elastic-plastic joint, under its weight and three cars";
    }
    [[nodiscard]] std::vector<Option> options() override {
        return {
            {"elastic-rotation", "of the joint where it yields", "rad", &elastic_, 0.05, 0.3, ""}};
    }
    [[nodiscard]] std::vector<Part> parts() override {
        return {{"cars", [this](Run& run) { jump(run); }}};
    }

  private:
    void jump(Run& run) const {
        Take take = run.take("cars", "Cars jump onto a ramp that hangs from one joint.");
        Stage& stage = take.stage();
        const double turn = 2 * std::numbers::pi, inertia = mass * length * length / 12;
        const double stiffness = inertia * turn * turn, moment = elastic_ * stiffness;
        const auto road = stage.add({.name = "upper road",
                                     .half = {100, wide / 2, thick / 2},
                                     .at = {pivot_x + 100, 0, pivot_z}});
        const auto ramp = stage.add({.name = "ramp",
                                     .mass = mass,
                                     .half = {length / 2 - gap, wide / 2, thick / 2},
                                     .at = {pivot_x - length / 2, 0, pivot_z}});
        stage.add({.name = "pad", .half = {12, wide / 2, pad / 2}, .at = {edge - 12, 0, pad / 2}});
        JointQueries& joint =
            stage.hinge("joint", ramp, road, {pivot_x, 0, pivot_z}, {0, 1, 0},
                        UsualAxisJoint(Perfect<double>({.strength = moment}),
                                       TravelLimit<double>({.limit = life}),
                                       {.stiffness = stiffness, .damping_time = 0.4 / turn}));
        std::array<Car, speeds.size()> cars;
        for (std::size_t i = 0; i < cars.size(); ++i) {
            cars[i] = car(stage, std::to_string(i + 1), edge - 2 - 6 * double(i));
        }
        stage.describe([](const std::string& of) {
            return Stage::Facts{{"section", of == "joint" ? "elastic-plastic hinge of the ramp"
                                                          : "spring and damper of a wheel"}};
        });
        stage.keep_awake();
        take.action(60);
        take.run(10);
        const bool frames = stage.keeps_tolerance();
        const Shares& by = frames ? damped : undamped;
        const auto used = [&] { return joint.plastic_travel() / life; };
        // the shares are of the given joint
        const auto compare = [&](const std::string& what, double came_out, double expected,
                                 double within) {
            if (elastic_ == given) {
                run.expect(what, came_out, expected, within);
            } else {
                run.tell(what, came_out);
            }
        };
        compare("own weight: share of the plastic travel", used(), by.own, 0.01);
        for (std::size_t i = 0; i < cars.size(); ++i) {
            const double before = used();
            for (const auto body : cars[i]) stage.set_velocity(body, {speeds[i], 0, 0});
            take.run(4);
            const std::string of = "jump " + std::to_string(i + 1) + ": ";
            if (i == 0) {
                compare(of + "share", used() - before, by.first, frames ? 0.01 : 0.04);
            } else {
                run.tell(of + "share", used() - before);
            }
            run.tell(of + "speed of the car after it", stage.velocity(cars[i][0]).x(), "m/s");
        }
        compare("all: share", used(), by.all, 0.05);
        run.expect("all: work over M_p x travel",
                   joint.absorbed_energy() / (moment * joint.plastic_travel()), 1, 1e-3);
        run.expect("unexplained of what the joint took",
                   stage.world().ledger().unexplained() / joint.absorbed_energy(), 0, 0.01);
        take.cut();
    }
    using Car = std::array<Stage::BodyNumber, 5>; ///< the chassis, then its wheels

    /// On springs of 4 Hz of what they carry, 0.7 of the critical damping; wheels do not turn, and
    /// slide without friction.
    static Car car(Stage& stage, const std::string& number, double x) {
        constexpr double frequency = 2 * std::numbers::pi * 4;
        constexpr double spring = chassis / 4 * frequency * frequency;
        const UsualAxisJoint strut(Perfect<double>({.strength = 1e7}), TravelLimit<double>(),
                                   {.stiffness = spring, .damping_time = 2 * 0.7 / frequency});
        Car made;
        made[0] = stage.add({.name = "car " + number,
                             .mass = chassis,
                             .half = {1.5, 0.8, 0.45},
                             .at = {x, 0, pad + radius + height},
                             .collides = false});
        for (std::size_t i = 0; i < 4; ++i) {
            const Vector3<double> at(x + (i < 2 ? -base : base), i % 2 == 0 ? -0.7 : 0.7,
                                     pad + radius);
            const std::string of = number + std::to_string(i);
            made[i + 1] = stage.add({.name = "wheel " + of,
                                     .mass = axle / 2,
                                     .half = {radius, radius, radius},
                                     .at = at,
                                     .ball = true});
            stage.slider("strut " + of, made[i + 1], made[0], at, {0, 0, 1}, strut);
        }
        return made;
    }

    static constexpr double given = 0.12;
    double elastic_ = given;
};

} // namespace

std::unique_ptr<Scene> ramp_scene() { return std::make_unique<Ramp>(); }

} // namespace ductile::scenes
