// SPDX-License-Identifier: MIT
//
// The World of an adapter: events, names, ledger, certificate, steps that follow the
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
    std::vector<std::string> warnings;
    std::size_t unreliable_steps = 0;
    double worst = 0;
};

/// With an engine's iterative solver, in place of which the World solves.
Struck strike(int segments) {
    const ParkesCase& c = parkes_cases[0];
    const ParkesAnswer& exact =
        *std::find_if(c.answers.begin(), c.answers.end(),
                      [segments](const ParkesAnswer& a) { return a.segments == segments; });
    Struck result;
    WorldRig rig(true, [&result](const std::string& line) { result.warnings.push_back(line); });
    Cantilever beam(rig, c, exact);
    const double dt = exact.stop / 800;
    const int steps = int(1.3 * exact.stop / dt);
    for (int i = 0; i < steps; ++i) rig.world().step(dt);
    double absorbed = 0;
    for (auto* hinge : beam.hinges) absorbed += hinge->absorbed_energy();
    result.tip_error = std::abs(beam.tip() / exact.tip - 1);
    result.energy_error = std::abs(absorbed / exact.struck_energy - 1);
    const Watch<double>& watch = rig.world().watch();
    for (std::size_t i = 0; i < beam.hinges.size(); ++i) {
        result.unreliable_steps += watch.unreliable_steps(i);
    }
    result.worst = watch.worst_ever().residual;
    return result;
}

std::string to_text(const Struck& s) {
    std::string text = "tip off by " + std::to_string(100 * s.tip_error) + " %, energy by " +
                       std::to_string(100 * s.energy_error) + " %; " +
                       std::to_string(s.unreliable_steps) + " unreliable, worst " +
                       std::to_string(s.worst);
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
    CHECK(event.time == Approx(0.25).epsilon(round_off));
    REQUIRE(event.report.fracture.has_value());
    CHECK(event.report.fracture->name() == "plastic travel");
    CHECK(event.report.fracture->absorbed_energy == Approx(96).epsilon(round_off));
    CHECK(event.report.plastic_travel == Approx(1.5).epsilon(round_off));
    CHECK(post.broken());
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

    WorldRig silent(false, nullptr, false);
    CHECK_THROWS_AS(silent.world().ledger(), std::logic_error);
}

TEST_CASE("the worst certificate names the joint that has it", "[world]") {
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

TEST_CASE("a struck chain is right whatever the engine's solver, as the World solves it",
          "[world]") {
    for (const int segments : {5, 10}) {
        const Struck struck = strike(segments);
        INFO(to_text(struck));
        CHECK(struck.tip_error < 0.01);
        CHECK(struck.energy_error < 0.005);
        CHECK(struck.unreliable_steps == 0);
        for (const std::string& line : struck.warnings) {
            CHECK(line.find("unsolved") == std::string::npos);
        }
    }
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

TEST_CASE("a step within a step is refused", "[world]") {
    WorldRig rig(false);
    rig.hinge(rotor(rig, none, 10), nullptr, none, joint(64), "post");
    std::string said;
    rig.world().on_event([&](const JointEvent<double>&) {
        try {
            rig.world().step(1e-2);
        } catch (const std::logic_error& error) {
            said = error.what();
        }
    });
    rig.world().step(1e-2);
    CHECK(said == "World.step: must not be called within a step, as by a callback");
    CHECK(rig.world().time() == 1e-2);
    CHECK_NOTHROW(rig.world().step(1e-2));
}

TEST_CASE("joints without a name are told by their number", "[world]") {
    WorldRig rig(false);
    rig.hinge(rotor(rig, none, 10), nullptr, none, joint(64), "");
    rig.world().step(1e-2);
    REQUIRE(rig.world().events().size() == 1);
    CHECK(rig.world().events()[0].name == "joint 0");
}

TEST_CASE("two runs of a world are equal bit for bit", "[world]") {
    const Struck one = strike(5), two = strike(5);
    CHECK(one.tip_error == two.tip_error);
    CHECK(one.energy_error == two.energy_error);
    CHECK(one.unreliable_steps == two.unreliable_steps);
    CHECK(one.worst == two.worst);
    CHECK(one.warnings == two.warnings);
}

TEST_CASE("a world names what it is given wrongly", "[world]") {
    WorldRig rig(false);
    auto& hinge = rig.hinge(rotor(rig, none, 1), nullptr, none, joint(64), "post");
    CHECK(message_of([&] { rig.world().add(hinge, "again"); }) ==
          "World.add.joint: must not be in the world already");
    CHECK(message_of([&] { rig.world().step(0); }) ==
          "World.step.dt = 0 s: must be finite and > 0");
    CHECK(message_of([&] { rig.world().step(std::nan("")); }) ==
          "World.step.dt = nan s: must be finite and > 0");
    CHECK(rig.world().time() == 0);
    rig.world().step(1e-3);
    CHECK(rig.world().time() == 1e-3);
}
