// SPDX-License-Identifier: MIT
//
// A block hangs from bars that carry a third more than it weighs.
//
// 6,000 kg of concrete of 1 m², reinforced with 0.04 % of steel that yields at 200 MPa: 80 kN, 8e7
// N/m over 1 m of length. Weight 58.86 kN, put on in a second: 0.7358 of the strength, 0.7358 mm
// longer, and nothing flows. (A strength met by bounds that an iterative solver approaches from
// above flows a little in every step.)
#include "ductile/material.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/section/rectangle.hpp"
#include "scene.hpp"

namespace ductile::scenes {

namespace {

class Tension final : public Scene {
  public:
    [[nodiscard]] std::string name() const override { return "tension"; }
    [[nodiscard]] std::string about() const override {
        return "a block of 6 t hangs from bars of 80 kN: held without a trace of flow";
    }
    void add_options(CLI::App& app) override {
        app.add_option("--mass", mass_, "of the block [kg]")->capture_default_str();
        app.add_option("--steel", steel_, "share of the section [-]")->capture_default_str();
    }
    void play(Run& run) override {
        const double side = std::sqrt(steel_);
        const Rectangle<double> bars({.width = side, .height = side});
        const Material<double> steel({.density = 7800,
                                      .youngs_modulus = 200e9,
                                      .poisson_ratio = 0.3,
                                      .yield_stress = 200e6});
        const double strength = 200e6 * steel_, stiffness = 200e9 * steel_;
        Take take = run.take("held", "A block of 6 t hangs from bars of 80 kN.", {.gravity = 0});
        Stage& stage = take.stage();
        const auto beam = stage.add({.name = "beam", .half = {1, 1, 0.5}, .at = {0, 0, 5}});
        const auto block = stage.add(
            {.name = "block", .mass = mass_, .half = {0.5, 0.5, 1.25}, .at = {0, 0, 2.25}});
        Matrix3<double> axes = Matrix3<double>::Identity();
        LinkQueries& joint =
            stage.connect("bars", block, beam, {0, 0, 4}, axes,
                          section_joint(bars, steel, {.length = 1, .elastic = true}));
        stage.keep_awake();
        take.action();
        const int steps = int(std::lround(1 / take.frame()));
        for (int i = 1; i <= steps; ++i) {
            stage.set_gravity(9.81 * i / steps);
            take.step();
        }
        take.run(10);
        const double weight = 9.81 * mass_;
        run.expect("force of its strength", std::abs(joint.force(JointAxis::axial)) / strength,
                   weight / strength, 0.001);
        run.expect("longer by", 2.25 - stage.place(block).z(), weight / stiffness, 0.01, "m");
        run.expect("absorbed by flow", joint.absorbed_energy(), 0, 0, "J");
        take.cut();
    }

  private:
    double mass_ = 6000, steel_ = 4e-4;
};

} // namespace

std::unique_ptr<Scene> tension_scene() { return std::make_unique<Tension>(); }

} // namespace ductile::scenes
