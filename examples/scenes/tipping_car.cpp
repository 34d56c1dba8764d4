// SPDX-License-Identifier: MIT
//
// A car runs over a post whose foot breaks within one step.
//
// 1200 kg at 50 km/h, against a post of 1 m, 100 × 100 × 4 mm, S355, 12.06 kg/m, between the lanes,
// whose foot breaks at 0.3 rad. The car meets it h = 0.92 m above its foot; the post takes a part
// of the momentum, V1 = M V0/(M + I/h²), then its foot M_p × 0.3 rad: ½ (M + I/h²)(V1² - V²) = 5.89
// kJ, whatever the step: 13.48 m/s are left. The car must not turn over, as it does where a joint
// that breaks within a step keeps its force for all of it.
#include "ductile/material.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/capacity.hpp"
#include "scene.hpp"

namespace ductile::scenes {

namespace {

class TippingCar final : public Scene {
  public:
    [[nodiscard]] std::string name() const override { return "tipping-car"; }
    [[nodiscard]] std::string about() const override {
        return "a car of 1.2 t runs over a post whose foot breaks within one step";
    }
    [[nodiscard]] std::vector<Option> options() override {
        return {{"speed", "of the car", "m/s", &speed_, 5, 30, ""},
                {"largest-rotation", "of the foot before it breaks", "rad", &largest_, 0.05, 1, ""},
                {"yield", "stress of the post", "MPa", &yield_, 235, 500, ""}};
    }
    [[nodiscard]] std::vector<Part> parts() override {
        return {{"foot breaks", [this](Run& run) { run_over(run); }}};
    }

  private:
    void run_over(Run& run) const {
        const Material<double> steel({.density = 7850,
                                      .youngs_modulus = 210e9,
                                      .poisson_ratio = 0.3,
                                      .yield_stress = yield_ * 1e6});
        const Box<double> tube(
            {.width = 0.1, .height = 0.1, .web_thickness = 0.004, .flange_thickness = 0.004});
        const double length = 1, foot_at = -0.72, bottom = 0.2, car_mass = 1200;
        const double mass = steel.density() * tube.area() * length;
        Take take =
            run.take("foot breaks", "The foot of the post breaks at 0.3 rad.", {.floor = false});
        Stage& stage = take.stage();
        const auto car = stage.add({.name = "car",
                                    .mass = car_mass,
                                    .half = {2, 0.8, 0.5},
                                    .at = {-2.5, 0, bottom + 0.5},
                                    .velocity = {speed_, 0, 0}});
        const auto post = stage.add({.name = "post",
                                     .mass = mass,
                                     .half = {0.05, 0.05, length / 2},
                                     .at = {0, 0, foot_at + length / 2}});
        const auto base = stage.add({.name = "base",
                                     .half = {0.3, 0.2, 0.05},
                                     .at = {0, 0, foot_at - 0.2},
                                     .collides = false});
        for (const double side : {-1.0, 1.0}) {
            stage.add({.name = side < 0 ? "right lane" : "left lane",
                       .half = {20, 0.5, 0.1},
                       .at = {10, side * 0.9, bottom - 0.1}});
        }
        const double moment = plastic_moment(tube, steel);
        JointQueries& foot = stage.hinge("foot", post, base, {0, 0, foot_at}, {0, 1, 0},
                                         UsualAxisJoint(Perfect<double>({.strength = moment}),
                                                        TravelLimit<double>({.limit = largest_})));
        stage.describe({{"section", "box 100 x 100 x 4 mm"},
                        {"material", "steel, " + replay::quantity(yield_ * 1e6, "Pa")}});
        take.action(240);
        for (int i = 0; i * take.frame() < 1 && !foot.broken(); ++i) take.step();
        const double after = stage.velocity(car).x();
        const double lever = bottom - foot_at;
        const double felt = mass * (length * length / 3 + 0.01 / 12) / (lever * lever);
        const double shared = speed_ * car_mass / (car_mass + felt);
        const double left = (car_mass + felt) * shared * shared / 2 - moment * largest_;
        run.tell("foot absorbed", foot.absorbed_energy(), "J");
        if (left < 0.1 * moment * largest_) { // the post leans, and lets the car pass or stops it
            run.tell("foot breaks (1) or not (0)", foot.broken() ? 1 : 0);
            take.cut();
            return;
        }
        run.expect("foot absorbed of M_p x its rotation",
                   foot.absorbed_energy() / (moment * largest_), 1, 1e-3);
        run.expect("speed of the car after the break", after,
                   std::sqrt(2 * left / (car_mass + felt)), stage.keeps_tolerance() ? 0.003 : 0.012,
                   "m/s");
        take.run(1);
        run.expect("upright a second later", stage.axes(car)(2, 2), 1, 0.01);
        run.tell("and its speed, the post below it", stage.velocity(car).x(), "m/s");
        take.cut();
    }
    double speed_ = 50 / 3.6, largest_ = 0.3, yield_ = 355;
};

} // namespace

std::unique_ptr<Scene> tipping_car_scene() { return std::make_unique<TippingCar>(); }

} // namespace ductile::scenes
