// SPDX-License-Identifier: MIT
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>
#include <vector>

#include "core/law/travel_after.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/multilinear.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/law/softening.hpp"
#include "ductile/law/voce.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

struct NoWork {
    using Scalar = double;
    double value(double) const noexcept { return 1; }
    double slope(double) const noexcept { return 0; }
};
struct MayThrow {
    using Scalar = double;
    double value(double) const { return 1; }
    double slope(double) const { return 0; }
    double work(double, double) const { return 0; }
};
static_assert(!StrengthLaw<NoWork> && !StrengthLaw<MayThrow>);
static_assert(std::is_trivially_copyable_v<Multilinear<double>>);

template <class S>
Multilinear<S> hardening_pairs() {
    return Multilinear<S>({{0, 10}, {S(0.1), 16}, {S(0.3), 22}, {1, 28}});
}
template <class S>
Multilinear<S> fading_pairs() {
    return Multilinear<S>({{0, 10}, {S(0.1), 13}, {S(0.4), 5}, {S(0.7), 0}});
}

/// One of each law, in every branch, lengths and forces of order 1 and 10.
template <class S>
auto all_laws() {
    return std::tuple{
        Perfect<S>({.strength = 10}),
        Linear<S>({.strength = 10, .hardening = 7}),
        Voce<S>({.strength = 10, .saturation = 6, .rate = 8, .hardening = 1}),
        Voce<S>({.strength = 10, .saturation = -4, .rate = 8}),
        hardening_pairs<S>(),
        fading_pairs<S>(),
        Softening<S>({.strength = 10, .plateau = S(0.2), .exhaustion = S(0.9)}),
        Softening<S>({.strength = 10, .exhaustion = S(0.5)}),
    };
}
template <class S, class F>
void for_each_law(F&& f) {
    std::apply([&](const auto&... law) { (f(law), ...); }, all_laws<S>());
}

/// Integral of the law by Simpson's rule on 2000 panels: independent of its own work().
template <class Law>
double numerical_work(const Law& law, double from, double to) {
    constexpr int panels = 2000;
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
        const double a = from + (to - from) * i / panels;
        const double b = from + (to - from) * (i + 1) / panels;
        sum += (law.value(a) + 4 * law.value((a + b) / 2) + law.value(b)) / 6 * (b - a);
    }
    return sum;
}

double share(int parts_of_thousand) { return parts_of_thousand / 1000.0; }

} // namespace

TEST_CASE("linear hardening, Voce and softening take their closed forms", "[law]") {
    const Linear linear(LinearParameters<double>{.strength = 4.0, .hardening = 20.0});
    CHECK(linear.value(0.1) == 6.0);
    CHECK(linear.work(0.1, 0.3) == Approx(0.2 * 8).epsilon(1e-15));

    const Voce voce(VoceParameters<double>{
        .strength = 250.0, .saturation = 100.0, .rate = 20.0, .hardening = 50.0});
    CHECK(voce.value(0.0) == 250.0);
    CHECK(voce.value(0.05) == Approx(250 + 100 * (1 - std::exp(-1.0)) + 2.5).epsilon(1e-14));
    CHECK(voce.slope(0.0) == 100.0 * 20 + 50);
    CHECK(voce.work(0, 0.05) ==
          Approx(350 * 0.05 - 5 * (1 - std::exp(-1.0)) + 25 * 0.0025).epsilon(1e-14));

    const Softening softening(
        SofteningParameters<double>{.strength = 10.0, .plateau = 0.2, .exhaustion = 0.6});
    CHECK(softening.value(0.2) == 10.0);
    CHECK(softening.value(0.4) == Approx(5).epsilon(1e-15));
    CHECK(softening.value(0.6) == 0.0);
    CHECK(softening.value(7.0) == 0.0);
    CHECK(softening.work(0, 7) == Approx(10 * (0.2 + 0.6) / 2).epsilon(1e-15));
}

TEST_CASE("multilinear pairs are met, joined by lines and followed by a constant", "[law]") {
    const auto law = hardening_pairs<double>();
    CHECK(law.size() == 4);
    for (std::size_t i = 0; i < law.size(); ++i) {
        CHECK(law.value(law.point(i).travel) == law.point(i).strength);
    }
    CHECK(law.value(0.2) == Approx(19).epsilon(1e-15));
    CHECK(law.slope(0.1) == Approx(30).epsilon(1e-14));
    CHECK(law.value(5) == 28);
    CHECK(law.slope(5) == 0);
    CHECK(law.work(0, 2) == Approx(1.3 + 3.8 + 0.7 * 25 + 28).epsilon(1e-14));
    CHECK(law.work(0.3, 0.05) == -law.work(0.05, 0.3));
}

TEST_CASE("a law that fades says where, others say never", "[law]") {
    constexpr double never = std::numeric_limits<double>::infinity();
    CHECK(exhaustion(fading_pairs<double>()) == 0.7);
    CHECK(exhaustion(Softening<double>({.strength = 1, .exhaustion = 0.5})) == 0.5);
    CHECK(exhaustion(hardening_pairs<double>()) == never);
    CHECK(exhaustion(Perfect<double>({.strength = 1})) == never);
}

TEST_CASE("the slope of every law is its finite difference away from kinks", "[law][property]") {
    test::prop("central difference", [] {
        const double p = 1e-3 + share(*rc::gen::inRange(0, 1200));
        for_each_law<double>([&](const auto& law) {
            constexpr double h = 1e-6;
            const double left = law.slope(p - h);
            const double right = law.slope(p + h);
            // one-sided slopes differ at a kink only by the jump; skip those
            if (std::abs(left - right) > 1e-2) return;
            const double difference = (law.value(p + h) - law.value(p - h)) / (2 * h);
            // third derivative up to Q b³ ~ 3e3: h² of it, plus round-off 1e-15 × 10 / h
            RC_ASSERT(std::abs(difference - law.slope(p)) < 1e-7);
        });
    });
}

TEST_CASE("the work of every law is the integral of its value", "[law][property]") {
    test::prop("against Simpson's rule, and additive", [] {
        const double a = share(*rc::gen::inRange(0, 1200));
        const double b = share(*rc::gen::inRange(0, 1200));
        const double c = share(*rc::gen::inRange(0, 1200));
        for_each_law<double>([&](const auto& law) {
            // a kink inside one of 2000 panels costs at most slope × panel²: 27 × (1.2/2000)² =
            // 1e-5
            RC_ASSERT(std::abs(law.work(a, b) - numerical_work(law, a, b)) < 1e-5);
            RC_ASSERT(std::abs(law.work(a, b) + law.work(b, c) - law.work(a, c)) < 1e-12);
            RC_ASSERT(law.work(a, a) == 0);
        });
    });
    test::prop("small steps keep their digits", [] {
        const double p = share(*rc::gen::inRange(0, 1200));
        for_each_law<double>([&](const auto& law) {
            constexpr double step = 1e-7;
            // midpoint rule, exact to slope jump × step²/8 ~ 1e-13 of a work of 1e-6
            RC_ASSERT(std::abs(law.work(p, p + step) - step * law.value(p + step / 2)) < 2e-13);
        });
    });
}

TEST_CASE("strength never is negative, and hardening laws never fall", "[law][property]") {
    test::prop("order", [] {
        const double a = share(*rc::gen::inRange(0, 3000));
        const double b = a + share(*rc::gen::inRange(0, 3000));
        for_each_law<double>([&](const auto& law) {
            RC_ASSERT(law.value(a) >= 0);
            RC_ASSERT(law.work(a, b) >= 0);
            const bool hardens = law.value(3) >= law.value(0);
            if (hardens) RC_ASSERT(law.value(b) >= law.value(a));
            if (a >= exhaustion(law)) RC_ASSERT(law.value(a) == 0 && law.work(a, b) == 0);
        });
    });
}

TEMPLATE_TEST_CASE("travel after a work inverts the work of every law", "[law][property]", float,
                   double) {
    using S = TestType;
    // Round-off of the work at p ~ 1 (W ~ 20), through the smallest strength met (0.1)
    constexpr S travel_tolerance = 4000 * std::numeric_limits<S>::epsilon();
    test::prop("there and back", [&] {
        const S p0 = S(share(*rc::gen::inRange(0, 400)));
        const S p1 = p0 + S(share(*rc::gen::inRange(0, 2000)));
        for_each_law<S>([&](const auto& law) {
            const S end = exhaustion(law);
            if (law.value(p1) < S(0.1)) return;
            const S energy = law.work(p0, p1);
            const S back = travel_after(law, p0, energy);
            RC_ASSERT(back >= p0 && back <= end);
            RC_ASSERT(std::abs(back - p1) <= travel_tolerance * (1 + p1));
        });
    });
}

TEST_CASE("a law that fades takes exactly its area, and the break hands back the rest", "[law]") {
    const auto check_break = [](const auto& law, double area) {
        const double end = law.exhaustion();
        CHECK(law.work(0, end) == Approx(area).epsilon(1e-14));
        // the same break energy in 3 steps or in 3000
        for (const int steps : {3, 30, 3000}) {
            const double energy = 1.1 * area / steps;
            double travel = 0;
            double taken = 0;
            for (int i = 0; i < steps; ++i) {
                const double next = travel_after(law, travel, energy);
                taken += law.work(travel, next);
                travel = next;
            }
            CHECK(travel == end);
            CHECK(taken == Approx(area).epsilon(1e-12));
        }
        CHECK(travel_after(law, end, 1.0) == end);
        CHECK(travel_after(law, 0.1, 0.0) == 0.1);
        CHECK(travel_after(law, 0.1, -1.0) == 0.1);
    };
    check_break(Softening<double>({.strength = 10, .plateau = 0.2, .exhaustion = 0.6}), 4.0);
    check_break(fading_pairs<double>(), 1.15 + 2.7 + 0.75);
}

TEST_CASE("laws give the same answer in mm-t-s as in m-kg-s", "[law][units]") {
    // forces stay in N (t mm/s² = N), lengths × 1000, slopes and 1/length ÷ 1000, work in mJ × 1000
    const Voce m(
        VoceParameters<double>{.strength = 9e3, .saturation = 4e3, .rate = 30.0, .hardening = 2e4});
    const Voce mm(VoceParameters<double>{
        .strength = 9e3, .saturation = 4e3, .rate = 30e-3, .hardening = 20.0});
    const Softening soft_m(
        SofteningParameters<double>{.strength = 9e3, .plateau = 0.01, .exhaustion = 0.05});
    const Softening soft_mm(
        SofteningParameters<double>{.strength = 9e3, .plateau = 10.0, .exhaustion = 50.0});
    const Multilinear<double> pairs_m({{0, 9e3}, {0.02, 11e3}, {0.06, 8e3}});
    const Multilinear<double> pairs_mm({{0, 9e3}, {20, 11e3}, {60, 8e3}});
    constexpr double round_off = 1e-13;
    const auto same = [&](const auto& a, const auto& b) {
        for (const double p : {0.003, 0.013, 0.04, 0.07}) {
            CHECK(b.value(1e3 * p) == Approx(a.value(p)).epsilon(round_off));
            CHECK(1e3 * b.slope(1e3 * p) == Approx(a.slope(p)).epsilon(round_off));
            const double work = a.work(0.001, p);
            CHECK(b.work(1.0, 1e3 * p) == Approx(1e3 * work).epsilon(round_off));
            CHECK(travel_after(b, 1.0, 1e3 * work) ==
                  Approx(1e3 * travel_after(a, 0.001, work)).epsilon(round_off));
        }
    };
    same(m, mm);
    same(soft_m, soft_mm);
    same(pairs_m, pairs_mm);
}

TEST_CASE("the limit cases of Voce are linear hardening", "[law]") {
    const Linear line(LinearParameters<double>{.strength = 10.0, .hardening = 3.0});
    const Voce none(
        VoceParameters<double>{.strength = 10.0, .saturation = 0.0, .rate = 5.0, .hardening = 3.0});
    const Voce fast(
        VoceParameters<double>{.strength = 8.0, .saturation = 2.0, .rate = 1e9, .hardening = 3.0});
    for (const double p : {0.01, 0.3, 2.0}) {
        CHECK(none.value(p) == line.value(p));
        CHECK(none.work(0.005, p) == Approx(line.work(0.005, p)).epsilon(1e-14));
        CHECK(fast.value(p) == Approx(line.value(p)).epsilon(1e-14));
        CHECK(fast.work(0, p) == Approx(line.work(0, p)).margin(1e-8)); // Q/b is what it lacks
    }
}

TEST_CASE("laws refuse bad parameters by name, value, unit and range", "[law][input]") {
    CHECK(message_of([] { Linear<double>({.strength = 1}); }) ==
          "Linear.hardening = nan N/m or N m/rad: must be finite and >= 0");
    CHECK(message_of([] { Linear<double>({.strength = 0, .hardening = 1}); }) ==
          "Linear.strength = 0 N or N m: must be finite and > 0");
    CHECK(message_of([] { Voce<double>({.strength = 5, .saturation = -5, .rate = 1}); }) ==
          "Voce.saturation = -5 N or N m: must be in (-5, inf) N or N m");
    CHECK(message_of([] { Voce<double>({.strength = 5, .saturation = 1}); }) ==
          "Voce.rate = nan 1/m or 1/rad: must be finite and > 0");
    CHECK(message_of([] {
              Voce<double>({.strength = 5, .saturation = 1, .rate = 1, .hardening = -1});
          }) == "Voce.hardening = -1 N/m or N m/rad: must be finite and >= 0");
    CHECK(message_of([] { Softening<double>({.strength = 5, .plateau = 1, .exhaustion = 1}); }) ==
          "Softening.exhaustion = 1 m or rad: must be in (1, inf) m or rad");
    CHECK(message_of([] { Softening<double>({.strength = 5, .plateau = -1, .exhaustion = 1}); }) ==
          "Softening.plateau = -1 m or rad: must be finite and >= 0");

    using Pairs = Multilinear<double, 3>;
    CHECK(message_of([] { Pairs(std::span<const StrengthPoint<double>>{}); }) ==
          "Multilinear.size = 0: must be in [1, 3]");
    CHECK(message_of([] {
              Pairs({{0, 1}, {1, 1}, {2, 1}, {3, 1}});
          }) == "Multilinear.size = 4: must be in [1, 3]");
    CHECK(message_of([] {
              Pairs({{0.5, 1}});
          }) == "Multilinear.points[0].travel = 0.5 m or rad: must be 0");
    CHECK(message_of([] {
              Pairs({{0, 1}, {0.2, 2}, {0.2, 3}});
          }) == "Multilinear.points[2].travel = 0.2 m or rad: must be in (0.2, inf) m or rad");
    CHECK(message_of([] {
              Pairs({{0, 1}, {0.2, 0}, {0.3, 3}});
          }) == "Multilinear.points[1].strength = 0 N or N m: must be finite and > 0");
    CHECK(message_of([] {
              Pairs({{0, 1}, {0.2, -1}});
          }) == "Multilinear.points[1].strength = -1 N or N m: must be finite and >= 0");
    CHECK(message_of([] {
              Pairs({{0, 0}});
          }) == "Multilinear.points[0].strength = 0 N or N m: must be finite and > 0");
    CHECK(message_of([] {
              Pairs({{0, 1}, {1, std::nan("")}});
          }) == "Multilinear.points[1].strength = nan N or N m: must be finite and >= 0");
}
