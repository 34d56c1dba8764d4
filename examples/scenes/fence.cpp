// SPDX-License-Identifier: MIT
//
// A beam that lies free is struck in the middle by what sticks to it.
//
// Reference problem P40a: 2 m of 2 kg/m, M_p = 100 N m, 4 kg at 4 m/s. All of it moves on at 2 m/s
// after 0.02 s, whatever the number of rods; the hinges take 9.6, 12, 13.846 J with 1, 2, 4 rods a
// half, 16 J a beam that bends everywhere.
#include <array>
#include <string>
#include <vector>

#include "scene.hpp"

namespace ductile::scenes {

namespace {

class Fence final : public Scene {
  public:
    [[nodiscard]] std::string name() const override { return "fence"; }
    [[nodiscard]] std::string about() const override {
        return "a free beam is struck in the middle: momentum stays, the hinges take what P40 says";
    }
    [[nodiscard]] std::vector<Part> parts() override {
        std::vector<Part> parts;
        for (const auto& [rods, work] : {std::pair{4, 13.8461538}, {2, 12.0}, {1, 9.6}}) {
            parts.push_back({std::to_string(rods) + " rods a half",
                             [rods = rods, work = work](Run& run) { strike(run, rods, work); }});
        }
        return parts;
    }

  private:
    static void strike(Run& run, int rods, double work) {
        constexpr double half_length = 1, per_length = 2, strike = 4, speed = 4, moment = 100;
        const std::string of = std::to_string(rods) + " rods a half";
        Take take =
            run.take(of, "A free beam, struck in the middle.", {.gravity = 0, .floor = false});
        Stage& stage = take.stage();
        const UsualAxisJoint hinge(Perfect<double>({.strength = moment}), TravelLimit<double>());
        const double length = half_length / rods;
        const auto mass = stage.add({.name = "mass",
                                     .mass = strike,
                                     .half = {1e-3, 0.05, 0.05},
                                     .velocity = {0, 0, -speed},
                                     .collides = false});
        std::vector<JointQueries*> hinges;
        std::vector<Stage::BodyNumber> all{mass};
        for (const double side : {-1.0, 1.0}) {
            Stage::BodyNumber inner = mass;
            for (int i = 0; i < rods; ++i) {
                const auto rod =
                    stage.add({.name = (side < 0 ? "left " : "right ") + std::to_string(i),
                               .mass = per_length * length,
                               .half = {length / 2, 1e-3, 1e-3},
                               .at = {side * length * (i + 0.5), 0, 0},
                               .collides = false});
                hinges.push_back(&stage.hinge("hinge " + std::to_string(hinges.size()), rod, inner,
                                              {side * length * i, 0, 0}, {0, 1, 0}, hinge));
                inner = rod;
                all.push_back(rod);
            }
        }
        stage.keep_awake();
        take.action(1000);
        take.run(0.1);
        double absorbed = 0, momentum = 0;
        for (const JointQueries* joint : hinges) absorbed += joint->absorbed_energy();
        for (const auto body : all) {
            momentum += stage.velocity(body).z() * (body == mass ? strike : per_length * length);
        }
        run.expect(of + ": momentum", -momentum, strike * speed, 1e-9, "N s");
        run.expect(of + ": final speed", -stage.velocity(mass).z(), 2, 0.01, "m/s");
        if (stage.keeps_tolerance()) {
            run.expect(of + ": plastic work", absorbed, work, 0.01, "J");
        } else { // a step that is longer than what it shows
            run.tell(of + ": plastic work", absorbed, "J");
        }
        take.cut();
    }
};

} // namespace

std::unique_ptr<Scene> fence_scene() { return std::make_unique<Fence>(); }

} // namespace ductile::scenes
