// SPDX-License-Identifier: MIT
//
// A wire is bent to and fro by hand until it breaks.
//
// Reference problem P36: d = 1 mm, S355, M_p = f_y d³/6 = 0.0591667 N m, rigid below yield. Every
// half cycle uses 1/2N_f of its life (Miner), 2N_f = (ε/ε_f')^(1/c) at the strain amplitude ε =
// (d/2)/L_p × range/2, the one that runs too. Three wires, bent to A, -A, A, ... from straight (leg
// 1 is 0 to A):
//
//   L_p    ε_f'   c      A      breaks in leg, after turning   total travel, work
//   3 mm   1      -0.6   90°    11   0.288447 rad              30.133577 rad  1.782903 J
//   2 mm   0.59   -0.58  90°    3    2.58574                   7.2981296      0.431806
//   1 mm   0.59   -0.58  45°    3    1.29287                   3.6490648      0.215903
//
// and the first bent one way: 12 rad. The hand turns the end as A sin ωt, a half cycle in a second.
// At frames of 1/30 to 1/240 s wire 1 takes within 0.02 % of its travel.
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/fracture/hinge_strain.hpp"
#include "scene.hpp"

namespace ductile::scenes {

namespace {

struct Wire {                                            // of P36
    double hinge_length, ductility, exponent, amplitude; ///< [m], [-], [-], [rad]
    int leg;
    double turned, travel, work; ///< in that leg [rad], in all [rad], [J]
};
constexpr double right_angle = std::numbers::pi / 2, diameter = 1e-3;
constexpr double moment = 355e6 * diameter * diameter * diameter / 6;
constexpr std::array<Wire, 3> wires{{
    {3e-3, 1, -0.6, right_angle, 11, 0.288447, 30.133577, 1.782903},
    {2e-3, 0.59, -0.58, right_angle, 3, 2.58574, 7.2981296, 0.431806},
    {1e-3, 0.59, -0.58, right_angle / 2, 3, 1.29287, 3.6490648, 0.215903},
}};

class Paperclip final : public Scene {
  public:
    [[nodiscard]] std::string name() const override { return "paperclip"; }
    [[nodiscard]] std::string about() const override {
        return "a wire of 1 mm is bent to and fro until it breaks in the leg that Coffin-Manson "
               "says";
    }
    [[nodiscard]] std::vector<Option> options() override {
        return {{"half-cycle", "time from one side to the other", "s", &half_cycle_, 0.2, 5, ""}};
    }
    [[nodiscard]] std::vector<Part> parts() override {
        std::vector<Part> parts;
        for (std::size_t i = 0; i < wires.size(); ++i) {
            parts.push_back(
                {"wire " + std::to_string(i + 1), [this, i](Run& run) { to_and_fro(run, i); }});
        }
        parts.push_back({"one way", one_way});
        return parts;
    }

  private:
    /// The wire's half that a hand turns about z, and the one that a vice holds.
    static JointQueries& build(Stage& stage, const Wire& wire, Stage::BodyNumber& hand) {
        const auto vice = stage.add({.name = "vice",
                                     .mass = 1e6, // and what the vice is bolted to
                                     .half = {0.01, 0.003, 0.003},
                                     .at = {-0.01, 0, 0},
                                     .collides = false});
        hand = stage.add({.name = "hand",
                          .half = {0.01, diameter / 2, diameter / 2},
                          .collides = false,
                          .driven = true});
        stage.keep_awake();
        const LowCycleFatigue<CoffinManson<double>> life(
            CoffinManson<double>(
                {.ductility_coefficient = wire.ductility, .ductility_exponent = wire.exponent}),
            {.strain_per_travel =
                 hinge_strain<double>({.height = diameter, .hinge_length = wire.hinge_length})});
        const FatigueAxisJoint bend(Perfect<double>({.strength = moment}), life);
        stage.describe(
            {{"section", "wire of 1 mm"},
             {"material", "Coffin-Manson: ductility " + replay::quantity(wire.ductility, "") +
                              ", exponent " + replay::quantity(wire.exponent, "")}});
        return stage.hinge("bend", hand, vice, {0, 0, 0}, {0, 0, 1}, bend);
    }
    void to_and_fro(Run& run, std::size_t number) const {
        const Wire& wire = wires[number];
        const std::string of = "wire " + std::to_string(number + 1) + ": ";
        Take take = run.take("wire " + std::to_string(number + 1), "A wire is bent to and fro.",
                             {.gravity = 0, .floor = false});
        Stage& stage = take.stage();
        Stage::BodyNumber hand = 0;
        JointQueries& bend = build(stage, wire, hand);
        take.action(60);
        const auto angle = [&](double t) {
            return wire.amplitude * std::sin(std::numbers::pi / half_cycle_ * t);
        };
        double t = 0;
        for (int i = 1; t < 20 * half_cycle_ && !bend.broken(); ++i) {
            const double next = i * take.frame();
            stage.turn(hand, angle(t), angle(next), take.frame());
            take.step();
            t = next;
        }
        const double before = wire.amplitude * (2 * wire.leg - 3); // of the leg
        run.expect(of + "breaks in leg",
                   1 + std::ceil((bend.plastic_travel() - wire.amplitude) / (2 * wire.amplitude)),
                   wire.leg, 0);
        run.expect(of + "after turning in it", bend.plastic_travel() - before, wire.turned,
                   0.08 / wire.turned, "rad");
        run.expect(of + "travel in all", bend.plastic_travel(), wire.travel, 0.003, "rad");
        run.expect(of + "work", bend.absorbed_energy(), wire.work, 0.003, "J");
        take.cut();
    }
    static void one_way(Run& run) {
        Take take = run.take("one way", "A wire is bent one way.", {.gravity = 0, .floor = false});
        Stage::BodyNumber hand = 0;
        JointQueries& bend = build(take.stage(), wires[0], hand);
        take.action(60);
        for (int i = 0; i * take.frame() < 20 && !bend.broken(); ++i) { // at 1 rad/s
            take.stage().turn(hand, i * take.frame(), (i + 1) * take.frame(), take.frame());
            take.step();
        }
        run.expect("one way: travel in all", bend.plastic_travel(), 12, 1e-3, "rad");
        take.cut();
    }

    double half_cycle_ = 1;
};

} // namespace

std::unique_ptr<Scene> paperclip_scene() { return std::make_unique<Paperclip>(); }

} // namespace ductile::scenes
