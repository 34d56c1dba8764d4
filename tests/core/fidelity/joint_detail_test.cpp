// SPDX-License-Identifier: MIT
//
// The choice of detail against what the oscillator really does with and without its elastic part.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "core/fidelity/oscillator.hpp"
#include "ductile/fidelity/joint_detail.hpp"
#include "ductile/material.hpp"
#include "ductile/section/rectangle.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using Catch::Matchers::Contains;
using ductile::test::elastic_plastic_peak;
using ductile::test::message_of;
using ductile::test::rigid_plastic_peak;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A joint where only Mx has anything to do.
JointDetailParameters<double> only_bending(const AxisSystem<double>& system,
                                           const std::optional<AxisEvent<double>>& event,
                                           double dt) {
    JointDetailParameters<double> p;
    p.capacity.capacity.fill(1e6);
    p.capacity.stiffness.fill(1e9);
    p.mass.fill(1);
    p.event.fill(AxisEvent<double>{});
    p.dt = dt;
    p.capacity.capacity[3] = system.strength;
    p.capacity.stiffness[3] = system.stiffness;
    p.mass[3] = system.mass;
    p.event[3] = event;
    return p;
}

constexpr std::size_t mx = 3;

} // namespace

TEST_CASE("below yield a joint is rigid", "[joint_detail]") {
    // a load of 0.4 R put on at once reaches 0.8 R; with the margin of 10 % 0.88
    const AxisSystem<double> system{.mass = 100, .stiffness = 4e4, .strength = 2000};
    const auto joint = choose_detail(only_bending(system, AxisEvent<double>{.load = 800}, 1e-3));
    CHECK(joint.detail() == AxisDetail::rigid);
    CHECK(joint.axis[mx].utilisation == Approx(0.8).epsilon(1e-12));
    CHECK(joint.axis[mx].reason == "sees 80 % of its capacity, and all axes together do not yield");
    // 0.46 R reaches 0.92 R, beyond what a margin of 10 % leaves
    const auto more = choose_detail(only_bending(system, AxisEvent<double>{.load = 920}, 1e-3));
    CHECK(more.detail() != AxisDetail::rigid);
    // the same load held from before is not amplified
    const auto held = choose_detail(only_bending(system, AxisEvent<double>{.held = 920}, 1e-3));
    CHECK(held.detail() == AxisDetail::rigid);
    CHECK(held.axis[mx].utilisation == Approx(0.46).epsilon(1e-12));
}

TEST_CASE("axes that yield only together are not called rigid", "[joint_detail]") {
    auto p = only_bending({.mass = 1, .stiffness = 1e6, .strength = 10}, {}, 1e-3);
    p.capacity.capacity.fill(10);
    p.event.fill(AxisEvent<double>{});
    p.event[2] = AxisEvent<double>{.held = 6};
    p.event[mx] = AxisEvent<double>{.held = 6}; // Σ n = 1.2: yields on |n| + |m| = 1
    const auto joint = choose_detail(p);
    CHECK(joint.axis[mx].detail != AxisDetail::rigid);
    CHECK(joint.axis[2].detail != AxisDetail::rigid);
    p.event[2] = AxisEvent<double>{.held = 3};
    CHECK(choose_detail(p).detail() == AxisDetail::rigid); // (1 + 0.1) 0.9 < 1
}

TEST_CASE("an axis too weakly loaded to weaken the one that yields stays rigid", "[joint_detail]") {
    // axial force on a rectangle takes n² of its moment: (1.1 n)² <= 0.05 up to n = 0.203
    auto p = only_bending({.mass = 1, .stiffness = 1e6, .strength = 10},
                          AxisEvent<double>{.speed = 10}, 1e-3);
    p.capacity.capacity[2] = 100;
    p.event[2] = AxisEvent<double>{.held = 20};
    CHECK(choose_detail(p).axis[2].detail == AxisDetail::rigid);
    CHECK(choose_detail(p).axis[2].reason ==
          "sees 20 % of its capacity, too little to weaken the others");
    p.event[2] = AxisEvent<double>{.held = 21};
    CHECK(choose_detail(p).axis[2].detail == AxisDetail::rigid_plastic);
    // two such axes together take too much: the stronger loaded one yields too
    p.event[2] = AxisEvent<double>{.held = 15};
    p.capacity.capacity[0] = 100;
    p.event[0] = AxisEvent<double>{.held = 16};
    CHECK(choose_detail(p).axis[2].detail == AxisDetail::rigid);
    CHECK(choose_detail(p).axis[0].detail == AxisDetail::rigid_plastic);
}

TEST_CASE("a steel bar hit hard is a rigid-plastic hinge about one axis", "[joint_detail]") {
    // 10 × 8 mm (notched) of 400 MPa, M_p = 64 N m, joint length 10 mm, hit by 20 kg at 5 m/s in
    // the middle of 40 mm: per radian of the hinge 10 mm, so 20 kg × (10 mm)² and 500 rad/s, 250 J
    const Material<double> steel(
        {.density = 7800, .youngs_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = 400e6});
    JointDetailParameters<double> p;
    p.capacity = joint_capacity(Rectangle<double>({.width = 0.01, .height = 0.008}), steel,
                                {.length = 0.01});
    p.mass = {0.01, 0.01, 0.01, 2e-3, 2e-6, 2e-7};
    p.dt = 1e-5;
    p.event.fill(AxisEvent<double>{});
    p.event[mx] = AxisEvent<double>{.speed = 500};
    p.event[1] = std::nullopt; // the shear is not known, but the arms are 20 mm
    p.lever = 0.02;
    const auto joint = choose_detail(p);
    CHECK(joint.axis[mx].detail == AxisDetail::rigid_plastic);
    CHECK(joint.detail() == AxisDetail::rigid_plastic);
    // U_y = M_p²/(2 E I/L), 8533 N m/rad
    CHECK(joint.axis[mx].error == Approx(0.24 / 250.24).epsilon(1e-9));
    for (const std::size_t i : {0u, 2u, 4u, 5u}) CHECK(joint.axis[i].detail == AxisDetail::rigid);
    // V <= 2 M_p/ℓ = 6400 N of V_p = 80 mm² × 400 MPa/√3 = 18475 N
    CHECK(joint.axis[1].utilisation == Approx(6400 / (80e-6 * 400e6 / std::numbers::sqrt3)));
    CHECK_THAT(joint.reason(), Contains("Mx rigid-plastic: "));
    // without the lever nothing bounds the shear
    p.lever = infinity;
    CHECK(choose_detail(p).axis[1].detail == AxisDetail::rigid_plastic);
    CHECK(choose_detail(p).axis[1].utilisation == infinity);
}

TEST_CASE("a hard hit needs no elastic part, a soft one does", "[joint_detail]") {
    // error U_y/(E + U_y): U_y = 0.25 J; E = 2.25 J gives 10 %, E = 10 J gives 2.4 %
    const AxisSystem<double> system{.mass = 0.5, .stiffness = 200, .strength = 10};
    const double dt = 1e-3; // 314 steps per period
    const auto soft = choose_detail(only_bending(system, AxisEvent<double>{.speed = 3}, dt));
    CHECK(soft.axis[mx].detail == AxisDetail::elastic_plastic);
    CHECK(soft.axis[mx].error == Approx(std::pow(std::numbers::pi / 314.16, 2)).epsilon(1e-3));
    CHECK(soft.axis[mx].reason ==
          "without elasticity the peak would be off by 10 %; 314 steps per elastic period leave an "
          "error of 0.01 %");
    const auto hard =
        choose_detail(only_bending(system, AxisEvent<double>{.speed = std::sqrt(40.0)}, dt));
    CHECK(hard.axis[mx].detail == AxisDetail::rigid_plastic);
    CHECK(hard.axis[mx].error == Approx(0.25 / 10.25).epsilon(1e-12));
    CHECK(hard.axis[mx].reason == "elasticity changes the peak by 2.44 %, tolerable");
}

TEST_CASE("a step that does not resolve the elastic part leaves the error and says so",
          "[joint_detail]") {
    const AxisSystem<double> system{.mass = 0.5, .stiffness = 200, .strength = 10}; // T = 0.314 s
    const auto coarse =
        choose_detail(only_bending(system, AxisEvent<double>{.speed = 3}, 1.0 / 30));
    CHECK(coarse.axis[mx].detail == AxisDetail::rigid_plastic);
    CHECK(coarse.axis[mx].error == Approx(0.1).epsilon(1e-12));
    CHECK(coarse.axis[mx].steps_per_period == Approx(9.42477796));
    CHECK(coarse.axis[mx].reason ==
          "elasticity would change the peak by 10 %, but 9.42 steps per elastic period do not "
          "resolve it; dt <= 0.0224 s would");
    // and that step would indeed
    const auto fine = choose_detail(only_bending(system, AxisEvent<double>{.speed = 3}, 0.0223));
    CHECK(fine.axis[mx].detail == AxisDetail::elastic_plastic);
    CHECK(fine.axis[mx].error <= 0.05);
    // the frequency ratio is the user's
    auto p = only_bending(system, AxisEvent<double>{.speed = 3}, 0.0223);
    p.steps_per_period = 20;
    CHECK(choose_detail(p).axis[mx].detail == AxisDetail::rigid_plastic);
}

TEST_CASE("of two errors the smaller one is chosen", "[joint_detail]") {
    // 12.5 steps per period: error (π/12.5)² = 6.3 %; U_y/(E + U_y) of 6 % and of 7 %
    const AxisSystem<double> system{.mass = 0.5, .stiffness = 200, .strength = 10};
    const double dt = 2 * std::numbers::pi / 20 / 12.5;
    const auto choice = [&](double ignored) {
        const double energy = 0.25 * (1 - ignored) / ignored;
        const AxisEvent<double> event{.speed = std::sqrt(4 * energy)};
        return choose_detail(only_bending(system, event, dt)).axis[mx];
    };
    CHECK(choice(0.06).detail == AxisDetail::rigid_plastic);
    CHECK(choice(0.06).error == Approx(0.06).epsilon(1e-9));
    CHECK(choice(0.07).detail == AxisDetail::elastic_plastic);
    CHECK(choice(0.07).error == Approx(0.0631654682).epsilon(1e-9));
    // and where the event is not known, the elastic part has to be within the tolerance of 5 %
    CHECK(choose_detail(only_bending(system, {}, dt)).axis[mx].detail == AxisDetail::rigid_plastic);
}

TEST_CASE("an event that is not known gets the elastic part where it costs nothing",
          "[joint_detail]") {
    const AxisSystem<double> system{.mass = 0.5, .stiffness = 200, .strength = 10};
    CHECK(choose_detail(only_bending(system, {}, 1e-3)).axis[mx].detail ==
          AxisDetail::elastic_plastic);
    const auto coarse = choose_detail(only_bending(system, {}, 1.0 / 30));
    CHECK(coarse.axis[mx].detail == AxisDetail::rigid_plastic);
    CHECK(coarse.axis[mx].error == infinity);
    CHECK(coarse.axis[mx].reason ==
          "the event is not known; elasticity stores up to 0.25 J, but 9.42 steps per elastic "
          "period do not resolve it; dt <= 0.0224 s would");
    const auto rigid =
        choose_detail(only_bending({.mass = 1, .stiffness = infinity, .strength = 10}, {}, 1e-3));
    CHECK(rigid.axis[mx].detail == AxisDetail::rigid_plastic);
    CHECK(rigid.axis[mx].error == 0);
}

TEST_CASE("the error told is the error made by leaving the elastic part out", "[joint_detail]") {
    // the suddenly applied load of P04, alone and after a hit: the elastic-plastic oscillator and
    // the rigid-plastic joint stepped so finely that only the model differs
    test::prop("any hit, load and length of it", [] {
        const AxisSystem<double> system{.mass = 100, .stiffness = 4e4, .strength = 2000};
        const double omega = 20, dt = 1e-3 / omega;
        // past yield: hit at more than ω u_y = 1 m/s, or loaded for long with more than R/2
        const bool hit = *rc::gen::arbitrary<bool>();
        const AxisEvent<double> event{
            .speed = hit ? *rc::gen::inRange(24, 100) / 20.0 : 0,
            .load = *rc::gen::inRange(hit ? 0 : 24, 60) * 50.0,
            .duration = *rc::gen::inRange(hit ? 10 : 60, 100) / 20.0 / omega};
        auto p = only_bending(system, event, 1 / omega); // too coarse for the elastic part
        p.tolerance = *rc::gen::element(0.01, 0.05, 0.2);
        const auto choice = choose_detail(p).axis[mx];
        RC_ASSERT(choice.detail == AxisDetail::rigid_plastic);
        const double with = elastic_plastic_peak(system, event, dt);
        const double without = rigid_plastic_peak(system, event, dt);
        // both steppings are first order in ω dt = 1e-3
        RC_ASSERT(std::abs(with - without) / with == Approx(choice.error).margin(5e-3));
    });
}

TEST_CASE("the error told bounds the error of the explicit spring", "[joint_detail]") {
    // beside the half step that load and speed are apart in symplectic Euler, with any detail;
    // wherever it is chosen, on the events of P03 and P04 and others, from the coarsest step on
    const AxisSystem<double> system{.mass = 100, .stiffness = 4e4, .strength = 2000};
    const double period = 2 * std::numbers::pi / 20;
    int compared = 0;
    for (const double steps : {12.0, 16.0, 25.0, 50.0, 100.0}) {
        for (const double speed : {0.0, 1.2, 2.0, 4.0}) {
            for (const double share : {0.0, 0.3, 0.6, 0.8}) {
                const AxisEvent<double> event{.speed = speed, .load = share * 2000};
                const double dt = period / steps;
                auto p = only_bending(system, event, dt);
                p.tolerance = 1e-3; // so that elastic-plastic is the choice wherever accepted
                const auto choice = choose_detail(p).axis[mx];
                if (choice.detail != AxisDetail::elastic_plastic) continue;
                ++compared;
                // velocities half a step late: the load seems to act dt/2 before the hit
                AxisEvent<double> seen = event;
                seen.speed += event.load * dt / (2 * system.mass);
                const double exact = peak_response(system, seen).displacement;
                INFO("steps per period " << steps << ", v = " << speed << ", F/R = " << share);
                CHECK(std::abs(elastic_plastic_peak(system, event, dt) / exact - 1) <=
                      choice.error);
            }
        }
    }
    CHECK(compared > 30);
}

TEST_CASE("float chooses as double does", "[joint_detail]") {
    JointDetailParameters<float> p;
    p.capacity.capacity.fill(10);
    p.capacity.stiffness.fill(200);
    p.mass.fill(0.5f);
    p.event.fill(AxisEvent<float>{});
    p.event[mx] = AxisEvent<float>{.speed = 3};
    p.dt = 1e-3f;
    const auto joint = choose_detail(p);
    CHECK(joint.axis[mx].detail == AxisDetail::elastic_plastic);
    CHECK(joint.axis[mx].reason ==
          "without elasticity the peak would be off by 10 %; 314 steps per elastic period leave an "
          "error of 0.01 %");
    CHECK(joint.axis[0].detail == AxisDetail::rigid);
}

TEST_CASE("a choice of detail refuses what it cannot decide on, by name", "[joint_detail]") {
    const auto with = [](auto&& change) {
        auto p = only_bending({.mass = 1, .stiffness = 1, .strength = 1}, {}, 0.01);
        change(p);
        return message_of([&] { (void)choose_detail(p); });
    };
    CHECK(with([](auto&) {}) == "nothing thrown");
    CHECK(with([](auto& p) { p.dt = 0; }) == "JointDetail.dt = 0 s: must be finite and > 0");
    CHECK(with([](auto& p) { p.mass[2] = 0; }) ==
          "JointDetail.Fz.mass = 0 kg or kg m^2: must be finite and > 0");
    CHECK(with([](auto& p) { p.capacity.capacity[5] = -1; }) ==
          "JointDetail.Mz.capacity = -1 N or N m: must be > 0 (infinity: no limit)");
    CHECK(with([](auto& p) { p.capacity.stiffness[0] = 0; }) ==
          "JointDetail.Fx.stiffness = 0 N/m or N m/rad: must be > 0 (infinity: no limit)");
    CHECK(with([](auto& p) { p.lever = 0; }) ==
          "JointDetail.lever = 0 m: must be > 0 (infinity: no limit)");
    CHECK(with([](auto& p) { p.tolerance = 1; }) == "JointDetail.tolerance = 1: must be in (0, 1)");
    CHECK(with([](auto& p) { p.margin = -1; }) ==
          "JointDetail.margin = -1: must be finite and >= 0");
    CHECK(with([](auto& p) { p.steps_per_period = 1; }) ==
          "JointDetail.steps_per_period = 1: must be >= 2");
    CHECK(with([](auto& p) { p.event[3] = AxisEvent<double>{.speed = NAN}; }) ==
          "AxisEvent.speed = nan m/s or rad/s: must be finite and >= 0");
}
