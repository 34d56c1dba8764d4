// SPDX-License-Identifier: MIT
//
// Parallel elements with memory (P08, P09 of tests/reference).
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "ductile/law/iwan.hpp"
#include "ductile/law/uniaxial.hpp"
#include "ductile/law/uniaxial_return.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

static_assert(std::is_trivially_copyable_v<IwanState<double, 4>>);

template <class S>
constexpr std::array<IwanElement<S>, 4> elements{{{4000, 4}, {3000, 6}, {2000, 8}, {1000, 10}}};
template <class S>
constexpr std::array<BackbonePoint<S>, 4> backbone{
    {{S(0.001), 10}, {S(0.002), 16}, {S(0.004), 22}, {S(0.010), 28}}};

template <HysteresisLaw Law>
double loop_energy(const Law& law, double amplitude, int parts) {
    typename Law::State state;
    law.project(state, amplitude);
    double dissipated = 0;
    for (const double sign : {-1.0, 1.0}) {
        for (int i = 1; i <= parts; ++i) {
            dissipated += law.project(state, sign * amplitude * (2.0 * i / parts - 1)).dissipated;
        }
    }
    return dissipated;
}

/// The Ramberg-Osgood curve as N elements, knots at strain ε_a (i/N)^1.5.
template <std::size_t N>
Iwan<double, N> fitted(const RambergOsgood<double>& curve, double amplitude) {
    std::array<BackbonePoint<double>, N> points;
    for (std::size_t i = 0; i < N; ++i) {
        const double strain = amplitude * std::pow(double(i + 1) / N, 1.5);
        points[i] = {strain, curve.stress(strain)};
    }
    return Iwan<double, N>::from_backbone(points);
}

} // namespace

TEMPLATE_TEST_CASE("elements and backbone are two readings of one law (P08)", "[law][iwan]", float,
                   double) {
    using S = TestType;
    const double round_off = 100 * std::numeric_limits<S>::epsilon();
    const Iwan<S, 4> given(elements<S>);
    const auto taken_apart = Iwan<S, 4>::from_backbone(backbone<S>);
    REQUIRE(taken_apart.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(double(taken_apart.element(i).stiffness) ==
              Approx(elements<S>[i].stiffness).epsilon(round_off));
        CHECK(double(taken_apart.element(i).slip_force) ==
              Approx(elements<S>[i].slip_force).epsilon(round_off));
        typename Iwan<S, 4>::State state;
        CHECK(double(given.project(state, backbone<S>[i].position).force) ==
              Approx(backbone<S>[i].force).epsilon(round_off));
    }
    CHECK(given.stiffness() == 10000);
}

TEST_CASE("a path with a small cycle rejoins the branch it left (P08)", "[law][iwan]") {
    const Iwan<double, 4> law(elements<double>);
    for (const int parts : {1, 3, 50}) {
        Iwan<double, 4>::State state;
        double from = 0;
        std::vector<double> forces;
        for (const double to : {8e-3, -4e-3, 6e-3, 8e-3, 12e-3, 0.0, -12e-3}) {
            for (int i = 1; i <= parts; ++i) law.project(state, from + (to - from) * i / parts);
            from = to;
            forces.push_back(law.force(state, to));
        }
        const std::vector<double> known{26, -22, 24, 26, 28, -20, -28};
        for (std::size_t i = 0; i < known.size(); ++i) {
            CHECK(forces[i] == Approx(known[i]).epsilon(1e-12));
        }
    }
}

TEST_CASE("the loop energy is the sum over the elements (P08)", "[law][iwan]") {
    const Iwan<double, 4> law(elements<double>);
    for (const int parts : {1, 13}) {
        CHECK(loop_energy(law, 3e-3, parts) == Approx(0.056).epsilon(1e-12));
        CHECK(loop_energy(law, 8e-3, parts) == Approx(0.384).epsilon(1e-12));
        CHECK(loop_energy(law, 12e-3, parts) == Approx(0.752).epsilon(1e-12));
    }
}

TEST_CASE("unloading follows the backbone doubled, as Masing's rule says",
          "[law][iwan][property]") {
    const Iwan<double, 4> law(elements<double>, 300.0);
    test::prop("F = Fa - 2 f((ua - u)/2)", [&] {
        const double amplitude = *rc::gen::inRange(1, 2000) * 1e-5;
        const double back = amplitude * (*rc::gen::inRange(0, 1000)) * 1e-3;
        Iwan<double, 4>::State loaded;
        const double top = law.project(loaded, amplitude).force;
        Iwan<double, 4>::State virgin;
        const double half = law.project(virgin, back).force;
        const double expected = top - 2 * half;
        RC_ASSERT(std::abs(law.project(loaded, amplitude - 2 * back).force - expected) < 1e-11);
    });
}

TEST_CASE("N elements approach the Ramberg-Osgood loop to second order (P09)",
          "[law][iwan][order]") {
    const RambergOsgood curve(RambergOsgoodParameters<double>{
        .youngs_modulus = 200e9, .coefficient = 1200e6, .exponent = 0.15});
    struct Row {
        double stress;
        std::array<double, 4> energy;
    };
    for (const Row& row : {Row{300e6, {78121.4266, 83966.2965, 85441.6864, 85811.4577}},
                           Row{500e6, {4153411.73, 4274367.26, 4305043.34, 4312723.8}}}) {
        const double amplitude = curve.strain(row.stress);
        const std::array<double, 4> energy{loop_energy(fitted<5>(curve, amplitude), amplitude, 1),
                                           loop_energy(fitted<10>(curve, amplitude), amplitude, 1),
                                           loop_energy(fitted<20>(curve, amplitude), amplitude, 1),
                                           loop_energy(fitted<40>(curve, amplitude), amplitude, 1)};
        for (std::size_t i = 0; i < energy.size(); ++i) {
            CHECK(energy[i] == Approx(row.energy[i]).epsilon(1e-8)); // printed to 9 digits
        }
        const double exact = curve.loop_energy(row.stress);
        for (std::size_t i = 1; i < energy.size(); ++i) {
            CHECK(std::log2((exact - energy[i - 1]) / (exact - energy[i])) >= 1.8);
        }
    }
}

TEST_CASE("elements flow as a rigid law with their stiffness in series", "[law][iwan][property]") {
    test::prop("any path, with and without a final stiffness", [] {
        const double final_stiffness = *rc::gen::inRange(0, 3) * 500.0;
        const Iwan<double, 4> law(elements<double>, final_stiffness);
        const double k = law.stiffness();
        Iwan<double, 4>::State driven, flowing;
        double at = 0, flowed = 0;
        for (int i = 0; i < 40; ++i) {
            at += *rc::gen::inRange(-12000, 12000) * 1e-6;
            const auto step = law.project(driven, at);
            const auto work = law.commit(flowing, step.plastic_increment);
            flowed += step.plastic_increment;
            RC_ASSERT(work.dissipated == Approx(step.dissipated).margin(1e-12));
            RC_ASSERT(k * (at - flowed) == Approx(step.force).margin(1e-9));
            for (int j = 0; j < 4; ++j) {
                const auto at_j = std::size_t(j);
                RC_ASSERT(flowing.slip[at_j] == Approx(driven.slip[at_j]).margin(1e-12));
            }
            RC_ASSERT(law.stored(flowing) + step.force * step.force / (2 * k) ==
                      Approx(law.held(driven, at)).margin(1e-12));
            // on the range's edge where it has just flowed, inside it else
            const auto range = law.prepare(flowing, 0);
            RC_ASSERT(step.force <= range.upper + 1e-9);
            RC_ASSERT(step.force >= range.lower - 1e-9);
            if (step.plastic_increment > 0)
                RC_ASSERT(step.force == Approx(range.upper).margin(1e-9));
            if (step.plastic_increment < 0)
                RC_ASSERT(step.force == Approx(range.lower).margin(1e-9));
            // the tangent is the slope, but for a kink within the difference
            const double travel = *rc::gen::inRange(0, 10000) * 1e-6 + 0.37e-6, h = 1e-9;
            for (const double direction : {-1.0, 1.0}) {
                const double slope = (law.resistance(flowing, travel + h, direction) -
                                      law.resistance(flowing, travel - h, direction)) /
                                     (2 * h) * direction;
                const double before = law.tangent(flowing, travel - h, direction);
                const double after = law.tangent(flowing, travel + h, direction);
                RC_ASSERT(slope <= before + 1e-2);
                RC_ASSERT(slope >= after - 1e-2);
            }
        }
    });
}

TEST_CASE("one element is perfectly plastic, one element and a spring are Prager's law",
          "[law][iwan]") {
    constexpr double k = 200;
    constexpr double alpha = 0.1;
    const std::array<IwanElement<double>, 1> one{{{k * (1 - alpha), 4 * (1 - alpha)}}};
    const Iwan<double, 1> iwan(one, alpha * k);
    const UniaxialReturn prager(
        k, KinematicHardening<double>(
               Perfect(PerfectParameters<double>{.strength = 4.0}),
               Prager(PragerParameters<double>{.modulus = alpha * k / (1 - alpha)})));
    Iwan<double, 1>::State a;
    decltype(prager)::State b;
    for (const double to : {0.1, -0.03, 0.02, -0.3, 0.15}) {
        const auto seen = iwan.project(a, to);
        const auto expected = prager.project(b, to);
        CHECK(seen.force == Approx(expected.force).epsilon(1e-12));
        CHECK(seen.dissipated == Approx(expected.dissipated).margin(1e-13));
        CHECK(iwan.held(a, to) == Approx(prager.held(b, to)).epsilon(1e-12));
        CHECK(seen.plastic_increment == Approx(expected.plastic_increment).margin(1e-13));
    }
}

TEST_CASE("a multilinear law with a spring becomes elements with the same first loading",
          "[law][iwan]") {
    const Multilinear<double> law({{0, 10}, {0.1, 16}, {0.3, 22}, {0.5, 28}, {1, 34}});
    const auto iwan = Iwan<double, 5>::from_law(law, 50.0);
    CHECK(iwan.size() == 4); // two pieces of the same slope need one element
    const UniaxialReturn direct(50.0, IsotropicHardening<Multilinear<double>>(law));
    for (const double q : {0.1, 0.25, 0.5, 0.9, 2.0}) {
        Iwan<double, 5>::State a;
        decltype(direct)::State b;
        const auto seen = iwan.project(a, q);
        const auto expected = direct.project(b, q);
        CHECK(seen.force == Approx(expected.force).epsilon(1e-12));
        CHECK(seen.plastic_increment == Approx(expected.plastic_increment).margin(1e-13));
    }
}

TEST_CASE("elements and backbones that are none are refused by name", "[law][iwan][input]") {
    using Law = Iwan<double, 2>;
    using Points = std::vector<BackbonePoint<double>>;
    using Elements = std::vector<IwanElement<double>>;
    CHECK(message_of([] { Law(Elements{}); }) == "Iwan.size = 0: must be in [1, 2]");
    CHECK(message_of([] { Law(Elements(3, {1, 1})); }) == "Iwan.size = 3: must be in [1, 2]");
    CHECK(message_of([] {
              Law(Elements{{1, 1}, {0, 1}});
          }) == "Iwan.elements[1].stiffness = 0 N/m or N m/rad: must be finite and > 0");
    CHECK(message_of([] {
              Law(Elements{{1, -1}});
          }) == "Iwan.elements[0].slip_force = -1 N or N m: must be finite and > 0");
    CHECK(message_of([] {
              Law(Elements{{1, 1}}, -1);
          }) == "Iwan.final_stiffness = -1 N/m or N m/rad: must be finite and >= 0");
    CHECK(message_of([] {
              (void)Law::from_backbone(Points{{1, 1}, {1, 2}});
          }) == "Iwan.backbone[1].position = 1 m or rad: must be in (1, inf) m or rad");
    CHECK(message_of([] {
              (void)Law::from_backbone(Points{{1, 1}, {2, 3}});
          }) ==
          "Iwan.backbone[0]: secant of the next piece = 2 N/m or N m/rad: must be at most that of "
          "this "
          "piece");
    CHECK(message_of([] {
              (void)Law::from_backbone(Points{{1, 2}}, 2.0);
          }) == "Iwan.size = 0: must be in [1, 2]");
    const Multilinear<double> fading({{0, 5}, {1, 0}});
    CHECK(message_of([&] { (void)Law::from_law(fading, 50.0); }) ==
          "Iwan.backbone[1].force = 0 N or N m: must be finite and > 0");
    CHECK(message_of([&] { (void)Law::from_law(fading, 0.0); }) ==
          "Iwan.stiffness = 0 N/m or N m/rad: must be finite and > 0");
    CHECK(message_of([] { (void)Law::from_backbone(Points{}); }) ==
          "Iwan.size = 0: must be in [1, 2]");
}
