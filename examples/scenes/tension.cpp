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
    [[nodiscard]] std::vector<Option> options() override {
        return {{"mass", "of the block", "kg", &mass_, 1000, 12000, ""},
                {"steel", "share of the section", "-", &steel_, 1e-4, 1e-3, ""}};
    }
    [[nodiscard]] std::vector<Part> parts() override {
        return {{"held", [this](Run& run) { hold(run); }}};
    }

  private:
    void hold(Run& run) const {
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
        stage.describe({{"section", "steel bars of " + std::to_string(steel_ * 1e4) + " cm²"},
                        {"material", "200 MPa, 200 GPa"}});
        take.action();
        const int steps = int(std::lround(1 / take.frame()));
        for (int i = 1; i <= steps; ++i) {
            stage.set_gravity(9.81 * i / steps);
            take.step();
        }
        take.run(10);
        const double weight = 9.81 * mass_;
        if (weight > strength) { // the bars flow, without an end
            run.expect("it falls (1) or not (0)", stage.place(block).z() < 2 ? 1 : 0, 1, 0);
            take.cut();
            return;
        }
        run.expect("force of its strength", std::abs(joint.force(JointAxis::axial)) / strength,
                   weight / strength, 0.001);
        run.expect("longer by", 2.25 - stage.place(block).z(), weight / stiffness, 0.01, "m");
        if (weight < 0.95 * strength) { // closer, what swings as it is put on flows
            run.expect("absorbed by flow", joint.absorbed_energy(), 0, 0, "J");
        } else {
            run.tell("absorbed by flow", joint.absorbed_energy(), "J");
        }
        take.cut();
    }
    double mass_ = 6000, steel_ = 4e-4;
};

} // namespace

std::unique_ptr<Scene> tension_scene() { return std::make_unique<Tension>(); }

} // namespace ductile::scenes
