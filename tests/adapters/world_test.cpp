// SPDX-License-Identifier: MIT
//
// The World of an adapter: events, names, ledger, certificate, effort, steps that follow the
// motion. Compiled for every engine and precision (RIG_HEADER).
#include RIG_HEADER

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "reference/problems/impact.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;
using ductile::reference::parkes_cases;
using ductile::reference::ParkesAnswer;
using ductile::reference::ParkesCase;

namespace {

const V3 none = V3::Zero();
constexpr double unlimited = std::numeric_limits<double>::infinity();
/// Sums over a few hundred steps.
constexpr double round_off = WorldRig::single ? 2e-4 : 1e-9;

Joint joint(double strength, double limit = unlimited) {
    return Joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}));
}

/// A rotor of 2 kg m² about z at `at` on a hinge to the static world, that spins.
WorldRig::Body rotor(WorldRig& rig, const V3& at, double spin) {
    const auto body = rig.body(1, V3::Constant(2), at);
    WorldRig::set_spin(body, V3(0, 0, spin));
    return body;
}

/// A cantilever of rods joined by plastic hinges, a mass on its tip, struck as Parkes (1955) did.
struct Cantilever {
    Cantilever(WorldRig& world_rig, const ParkesCase& c, const ParkesAnswer& exact)
        : rig(world_rig), p(c.parameters), n(exact.segments) {
        const double l = p.length / n;
        for (int i = 0; i < n; ++i) {
            const double mass = p.mass_per_length * l, tip = i + 1 == n ? p.tip_mass : 0;
            const double shift = tip / (mass + tip) * l / 2;
            const double across =
                mass * (l * l / 12 + shift * shift) + tip * (l / 2 - shift) * (l / 2 - shift);
            bodies.push_back(rig.body(mass + tip, V3(across / 100, across, across),
                                      V3((i + 0.5) * l + shift, 0, 0)));
            hinges.push_back(&rig.hinge(bodies.back(), i > 0 ? bodies[std::size_t(i - 1)] : nullptr,
                                        V3(i * l, 0, 0), joint(p.plastic_moment),
                                        "hinge " + std::to_string(i)));
        }
        // the impulse takes the hinges, which can carry none, as free: from the planar reference
        reference::Beam<double> plane({.length = p.length,
                                       .mass_per_length = p.mass_per_length,
                                       .plastic_moment = p.plastic_moment,
                                       .segments = n,
                                       .tip_mass = p.tip_mass});
        reference::Vector<double> impulse = plane.world().no_load();
        plane.add_force(impulse, p.length, p.tip_mass * p.speed);
        plane.world().strike(impulse);
        for (int i = 0; i < n; ++i) {
            const auto v = plane.world().velocity().segment<3>(3 * i);
            WorldRig::set_velocity(bodies[std::size_t(i)], V3(v[0], v[1], 0));
            WorldRig::set_spin(bodies[std::size_t(i)], V3(0, 0, v[2]));
        }
    }
    [[nodiscard]] double tip() const {
        double angle = 0, sum = 0;
        for (auto* hinge : hinges) {
            angle += hinge->rotation();
            sum += p.length / n * std::sin(angle);
        }
        return sum;
    }

    WorldRig& rig;
    reference::Parkes p;
    int n;
    std::vector<WorldRig::Body> bodies;
    std::vector<WorldRig::Hinge*> hinges;
};

/// What became of a struck cantilever.
struct Struck {
    double tip_error = 0;    ///< share of the exact deflection
    double energy_error = 0; ///< share of the energy after the blow
    Effort most;             ///< that was ever made
    Effort last;
    std::vector<std::string> warnings;
    std::vector<std::string> suspects; ///< joints that were ever unreliable
    std::size_t unreliable_steps = 0;
    double worst = 0;
    std::string worst_name;
};

/// With an iterative solver of ten iterations.
Struck strike(const EffortParameters& effort, int segments, int calm_steps = 0) {
    const ParkesCase& c = parkes_cases[0];
    const ParkesAnswer& exact =
        *std::find_if(c.answers.begin(), c.answers.end(),
                      [segments](const ParkesAnswer& a) { return a.segments == segments; });
    Struck result;
    WorldRig rig(true, effort,
                 [&result](const std::string& line) { result.warnings.push_back(line); });
    Cantilever beam(rig, c, exact);
    const double dt = exact.stop / 800;
    const int steps = int(1.3 * exact.stop / dt) + calm_steps;
    for (int i = 0; i < steps; ++i) {
        rig.world().step(dt);
        const Effort& now = rig.world().effort();
        result.most.iterations = std::max(result.most.iterations, now.iterations);
        result.most.parts = std::max(result.most.parts, now.parts);
        result.most.direct = result.most.direct || now.direct;
    }
    double absorbed = 0;
    for (auto* hinge : beam.hinges) absorbed += hinge->absorbed_energy();
    result.tip_error = std::abs(beam.tip() / exact.tip - 1);
    result.energy_error = std::abs(absorbed / exact.struck_energy - 1);
    result.last = rig.world().effort();
    const Watch<double>& watch = rig.world().watch();
    for (std::size_t i = 0; i < beam.hinges.size(); ++i) {
        result.unreliable_steps += watch.unreliable_steps(i);
        if (watch.unreliable_steps(i) > 0) result.suspects.push_back(watch.name(i));
    }
    result.worst = watch.worst_ever().residual;
    result.worst_name = watch.name(watch.worst_ever().joint);
    return result;
}

std::string to_text(const Struck& s) {
    std::string text = "tip off by " + std::to_string(100 * s.tip_error) + " %, energy by " +
                       std::to_string(100 * s.energy_error) + " %; most iterations " +
                       std::to_string(s.most.iterations) + ", parts " +
                       std::to_string(s.most.parts) + (s.most.direct ? ", direct" : "") + "; " +
                       std::to_string(s.unreliable_steps) + " unreliable, worst " +
                       std::to_string(s.worst) + " at " + s.worst_name;
    for (const std::string& line : s.warnings) text += "\n  " + line;
    return text;
}

} // namespace

TEST_CASE("a world tells first yield and break by name, with time, criterion and energies",
          "[world]") {
    // 2 kg m², 10 rad/s, 64 N m, 1.5 rad: breaks at √(100 - 96) = 2 rad/s after 8/32 = 0.25 s
    constexpr double dt = 1.0 / 250;
    WorldRig rig(GENERATE(false, true));
    const auto fast = rotor(rig, none, 10), slow = rotor(rig, {0, 5, 0}, 1);
    auto& post = rig.hinge(fast, nullptr, none, joint(64, 1.5), "lamp post");
    rig.hinge(slow, nullptr, {0, 5, 0}, joint(64), "sign");
    std::vector<std::string> told;
    rig.world().on_event([&told](const JointEvent<double>& event) {
        told.push_back(event.name + " " + std::string(to_string(event.kind)));
    });
    rig.world().step(dt);
    const std::vector<std::string> yields{"lamp post yielded", "sign yielded"};
    CHECK(told == yields);
    REQUIRE(rig.world().events().size() == 2);
    CHECK(rig.world().events()[0].time == dt);
    std::vector<JointEvent<double>> later;
    for (int i = 1; i < 100; ++i) {
        rig.world().step(dt);
        const auto events = rig.world().events();
        later.insert(later.end(), events.begin(), events.end());
    }
    REQUIRE(later.size() == 2);
    CHECK(told.size() == 4);
    // the slow one stops within 8 steps, which leaves it an eighth short
    CHECK(later[0].kind == EventKind::coarse);
    CHECK(later[0].name == "sign");
    CHECK(later[0].report.step_error == Approx(dt / (1 / 32.0)).epsilon(0.15));
    const JointEvent<double>& event = later[1];
    CHECK(event.kind == EventKind::broke);
    CHECK(event.name == "lamp post");
    CHECK(event.time >= 0.25);
    CHECK(event.time < 0.25 + dt);
    REQUIRE(event.report.fracture.has_value());
    CHECK(event.report.fracture->name() == "plastic travel");
    CHECK(event.report.fracture->absorbed_energy == Approx(96).epsilon(round_off));
    CHECK(event.report.plastic_travel == Approx(1.5).epsilon(round_off));
    CHECK(post.broken());
    CHECK(event.report.rotation_rate == 0); // step control has nothing to follow
    CHECK(WorldRig::spin(fast).z() == Approx(2).epsilon(round_off));
    CHECK(rig.world().time() == Approx(100 * dt).epsilon(1e-12));
}

TEST_CASE("a joint that yields and breaks within one step tells both, once", "[world]") {
    WorldRig rig(false);
    rig.hinge(rotor(rig, none, 10), nullptr, none, joint(64, 0.01), "pin");
    std::vector<EventKind> kinds;
    for (int i = 0; i < 5; ++i) {
        rig.world().step(1e-2);
        for (const auto& event : rig.world().events()) kinds.push_back(event.kind);
    }
    CHECK(kinds == std::vector<EventKind>{EventKind::yielded, EventKind::broke});
}

TEST_CASE("the ledger of a world closes", "[world]") {
    WorldRig rig(false);
    const auto body = rotor(rig, none, 10);
    rig.hinge(body, nullptr, none, joint(64, 1.5), "lamp post");
    for (int i = 0; i < 100; ++i) rig.world().step(1.0 / 250);
    const Ledger<double>& ledger = rig.world().ledger();
    CHECK(ledger.booked(Account::plastic) == Approx(96).epsilon(round_off));
    CHECK(ledger.held().kinetic == Approx(4).epsilon(round_off));
    CHECK(std::abs(ledger.unexplained()) < round_off * 100);

    WorldRig silent(false, {}, nullptr, false);
    CHECK_THROWS_AS(silent.world().ledger(), std::logic_error);
}

TEST_CASE("the worst certificate names the joint that has it", "[world]") {
    if (!WorldRig::may_be_iterative) return; // solved at once
    WorldRig rig(true);
    Cantilever beam(rig, parkes_cases[0], parkes_cases[0].answers[4]);
    double most_ever = 0;
    for (int i = 0; i < 50; ++i) {
        rig.world().step(1e-4);
        std::vector<double> residuals;
        for (auto* hinge : beam.hinges) {
            residuals.push_back(std::max(hinge->residual(), hinge->rigid_residual()));
        }
        const auto worst = std::max_element(residuals.begin(), residuals.end());
        REQUIRE(*worst > 0);
        CHECK(rig.world().worst().residual == *worst);
        CHECK(rig.world().worst().joint == std::size_t(worst - residuals.begin()));
        CHECK(rig.world().watch().name(rig.world().worst().joint) ==
              "hinge " + std::to_string(worst - residuals.begin()));
        most_ever = std::max(most_ever, *worst);
    }
    CHECK(rig.world().watch().worst_ever().residual == most_ever);
}

TEST_CASE("a struck chain is right with the engine's default solver where the World solves it",
          "[world]") {
    if (WorldRig::may_be_iterative) return;
    for (const int segments : {5, 10}) {
        const Struck struck = strike({}, segments);
        INFO(to_text(struck));
        CHECK(struck.tip_error < 0.01);
        CHECK(struck.energy_error < 0.005);
        CHECK(struck.unreliable_steps == 0);
        for (const std::string& line : struck.warnings) {
            CHECK(line.find("unsolved") == std::string::npos);
        }
    }
}

TEST_CASE("a chain that ten iterations get wrong is told in few lines, by the worst joint's name",
          "[world]") {
    if (!WorldRig::may_be_iterative) return; // solved at once
    const Struck struck = strike({}, 10);
    INFO(to_text(struck));
    CHECK(struck.tip_error > 0.5);
    CHECK(struck.most == Effort{});
    CHECK(struck.suspects.size() >= 5);
    REQUIRE_FALSE(struck.warnings.empty());
    CHECK(struck.warnings[0].find(" s (off by ") != std::string::npos);
    CHECK(struck.warnings.size() <= 5); // 1, 2, 4 and 8 joints, and the steps
}

TEST_CASE("effort makes the chain right and is lowered when all is calm", "[world]") {
    if (!WorldRig::may_be_iterative) return; // solved at once
    // calm: 7 times 120 steps at rest
    constexpr int calm = 7 * 120;
    SECTION("more iterations") {
        const Struck struck = strike({.action = OnUnconverged::raise_iterations}, 5, calm);
        INFO(to_text(struck));
        CHECK(strike({}, 5).energy_error > 0.03);
        CHECK(struck.tip_error < 0.005);
        CHECK(struck.energy_error < 0.002);
        CHECK(struck.most == Effort{.iterations = 64});
        CHECK(struck.last == Effort{});
        // ten segments want more than 64 times as many, but are no longer wrong in kind
        CHECK(strike({.action = OnUnconverged::raise_iterations}, 10).tip_error < 0.02);
    }
    SECTION("parts of a step") {
        // ten segments are beyond this: they creep on for ever, and say so
        const Struck unhelped = strike({}, 5);
        const Struck struck = strike({.action = OnUnconverged::split_step}, 5);
        INFO(to_text(struck));
        CHECK(unhelped.energy_error > 0.03);
        CHECK(struck.energy_error < 0.005);
        CHECK(struck.tip_error < 0.01);
        CHECK(struck.most == Effort{.parts = 16});
        const Struck calmed = strike({.action = OnUnconverged::split_step}, 3, calm);
        CHECK(calmed.most == Effort{.parts = 16});
        CHECK(calmed.last == Effort{});
    }
    SECTION("a direct solver") {
        const Struck struck = strike({.action = OnUnconverged::direct_solver}, 10, calm);
        INFO(to_text(struck));
        // in float Dantzig's method gives some steps back to the iterations, which are reported
        CHECK(struck.tip_error < (WorldRig::single ? 0.05 : 0.01));
        CHECK(struck.energy_error < (WorldRig::single ? 0.02 : 0.005));
        CHECK(struck.most == Effort{.direct = true});
        CHECK(struck.last == Effort{});
        CHECK(struck.unreliable_steps < strike({}, 10).unreliable_steps / 20);
    }
}

TEST_CASE("what the user set and applied is his again after a step of more effort", "[world]") {
    if (!WorldRig::may_be_iterative) return; // solved at once
    const auto action = GENERATE(OnUnconverged::raise_iterations, OnUnconverged::split_step);
    WorldRig rig(true, {.action = action});
    Cantilever beam(rig, parkes_cases[0], parkes_cases[0].answers[6]);
    const auto free = rig.body(2, V3::Constant(1), {0, 50, 0});
    const int iterations = rig.iterations();
    constexpr double dt = 1e-4;
    const auto strained = [&rig] {
        return rig.world().effort().parts >= 4 || rig.world().effort().iterations >= 4;
    };
    for (int i = 0; i < 100 && !strained(); ++i) rig.world().step(dt);
    REQUIRE(strained());
    WorldRig::apply_force(free, {30, 0, 0});
    rig.world().step(dt);
    CHECK(WorldRig::velocity(free).x() == Approx(15 * dt).epsilon(round_off));
    rig.world().step(dt); // the force was for one step
    CHECK(WorldRig::velocity(free).x() == Approx(15 * dt).epsilon(round_off));
    CHECK(rig.iterations() == iterations);
    const Ledger<double>& ledger = rig.world().ledger();
    CHECK(std::abs(ledger.unexplained()) < round_off * ledger.opened().total() + round_off * 10);
}

TEST_CASE("steps that follow the motion end on time and turn no hinge too far", "[world]") {
    WorldRig rig(false);
    auto& hinge = rig.hinge(rotor(rig, none, 10), nullptr, none, joint(64), "post");
    StepControl<double> control({.min_step = 1e-5, .max_step = 1.0 / 60, .plastic_rotation = 2e-3});
    double before = 0, most = 0;
    int steps = 0;
    const auto watch_rotation = [&] {
        most = std::max(most, hinge.plastic_rotation() - before);
        before = hinge.plastic_rotation();
        ++steps;
        return SceneMotion<double>{};
    };
    rig.world().advance(0.1, control, watch_rotation);
    CHECK(rig.world().time() == 0.1);
    CHECK(most > 1e-3);
    CHECK(most <= 2e-3 * (1 + round_off));
    CHECK(rig.world().events().size() == 1); // of all steps of the advance
    const double then = rig.world().time();
    rig.world().advance(0.3, control); // the hinge comes to rest after 0.3125 s
    CHECK(rig.world().time() == then + 0.3);
    CHECK(hinge.plastic_rotation() == Approx(100.0 / 64).epsilon(round_off));
    // at rest the longest steps do
    CHECK(control.step() == Approx(1.0 / 60));

    // what the scene says counts too: 1 m/s towards 0.1 m, 0.5 % a step
    int calls = 0;
    rig.world().advance(0.1, control, [&calls] {
        ++calls;
        return SceneMotion<double>{.closing_speed = 1, .thickness = 0.1};
    });
    CHECK(calls >= 200);
    CHECK(calls < 210);
    CHECK(steps > 300);
}

TEST_CASE("a joint that was removed is told of no more, also where a listener does it", "[world]") {
    WorldRig rig(false);
    const auto body = rotor(rig, none, 10);
    auto& post = rig.hinge(body, nullptr, none, joint(64, 0.1), "post");
    auto& sign = rig.hinge(rotor(rig, {0, 5, 0}, 10), nullptr, {0, 5, 0}, joint(64), "sign");
    rig.world().remove(post);
    rig.world().remove(post); // is not there
    int events = 0;
    rig.world().on_event([&](const JointEvent<double>& event) {
        ++events;
        CHECK(event.name == "sign");
        rig.world().remove(sign);
    });
    for (int i = 0; i < 60; ++i) rig.world().step(1e-2);
    CHECK(events == 1);
    CHECK(WorldRig::spin(body).z() == Approx(10).epsilon(round_off));
    CHECK_FALSE(post.broken());
    rig.world().on_event(nullptr);
    rig.world().add(post, "post again");
    rig.world().step(1e-2);
    REQUIRE(rig.world().events().size() == 1);
    CHECK(rig.world().events()[0].name == "post again");
}

TEST_CASE("joints without a name are told by their number", "[world]") {
    WorldRig rig(false);
    rig.hinge(rotor(rig, none, 10), nullptr, none, joint(64), "");
    rig.world().step(1e-2);
    REQUIRE(rig.world().events().size() == 1);
    CHECK(rig.world().events()[0].name == "joint 0");
}

TEST_CASE("two runs of a world are equal bit for bit", "[world]") {
    const auto action = GENERATE(OnUnconverged::raise_iterations, OnUnconverged::split_step,
                                 OnUnconverged::direct_solver);
    const Struck one = strike({.action = action}, 5), two = strike({.action = action}, 5);
    CHECK(one.tip_error == two.tip_error);
    CHECK(one.energy_error == two.energy_error);
    CHECK(one.unreliable_steps == two.unreliable_steps);
    CHECK(one.worst == two.worst);
    CHECK(one.warnings == two.warnings);
}

TEST_CASE("a world names what it is given wrongly", "[world]") {
    CHECK(message_of([] { WorldRig(false, {.calm_steps = 0}); }) ==
          "Effort.calm_steps = 0: must be >= 1");
    WorldRig rig(false);
    auto& hinge = rig.hinge(rotor(rig, none, 1), nullptr, none, joint(64), "post");
    CHECK(message_of([&] { rig.world().add(hinge, "again"); }) ==
          "World.add.joint: must not be in the world already");
    CHECK(message_of([&] { rig.world().step(0); }) ==
          "World.step.dt = 0 s: must be finite and > 0");
    CHECK(message_of([&] { rig.world().step(std::nan("")); }) ==
          "World.step.dt = nan s: must be finite and > 0");
    StepControl<double> control({.min_step = 1e-6, .max_step = 1e-2});
    CHECK(message_of([&] { rig.world().advance(-1, control); }) ==
          "World.advance.duration = -1 s: must be finite and > 0");
    StepControl<double> stands_still({.min_step = 1e-30, .max_step = 1e-2});
    CHECK(message_of([&] { rig.world().advance(1, stands_still); }) ==
          "StepControl.min_step = 1e-30 s: must be long enough to move the clock");
    CHECK(rig.world().time() == 0);
    rig.world().step(1e-3);
    CHECK(rig.world().time() == 1e-3);
}
