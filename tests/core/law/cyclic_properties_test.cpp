// SPDX-License-Identifier: MIT
//
// Every hysteretic law over long random histories: no energy from nothing, no NaN, the same
// answer in other units and with moves cut in two.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <concepts>
#include <random>
#include <tuple>
#include <utility>

#include "ductile/law/iwan.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/multilinear.hpp"
#include "ductile/law/softening.hpp"
#include "ductile/law/uniaxial_return.hpp"
#include "ductile/law/voce.hpp"
#include "support/property.hpp"

using namespace ductile;

namespace {

/// The laws of this folder with lengths in `length` (1: m, 1000: mm); forces stay in N. The first
/// three soften somewhere, the others never.
constexpr std::size_t softening_laws = 3;

template <class S>
auto hysteretic_laws(S length = 1) {
    const S slope = 1 / length;
    const S k = 200 * slope;
    const Perfect perfect(PerfectParameters<S>{.strength = 10});
    const Linear linear(LinearParameters<S>{.strength = 10, .hardening = 9 * slope});
    const Voce voce(VoceParameters<S>{
        .strength = 10, .saturation = 5, .rate = S(0.8) * slope, .hardening = S(0.01) * slope});
    const Voce weakening(
        VoceParameters<S>{.strength = 10, .saturation = -5, .rate = S(0.1) * slope});
    const Multilinear<S> pairs({{0, 10}, {S(0.1) * length, 13}, {3 * length, 9}});
    const Softening fading(
        SofteningParameters<S>{.strength = 10, .plateau = 5 * length, .exhaustion = 50 * length});
    const Prager prager(PragerParameters<S>{.modulus = 20 * slope});
    const ArmstrongFrederick recalling(
        ArmstrongFrederickParameters<S>{.modulus = 90 * slope, .recall = 9 * slope});
    const std::array<IwanElement<S>, 4> elements{
        {{80 * slope, 4}, {60 * slope, 6}, {40 * slope, 8}, {20 * slope, 10}}};
    return std::tuple{
        UniaxialReturn(k, Hardening(weakening)),
        UniaxialReturn(k, Hardening(pairs)),
        UniaxialReturn(k, Hardening(fading)),
        UniaxialReturn(k, Hardening(perfect)),
        UniaxialReturn(k, Hardening(linear)),
        UniaxialReturn(k, Hardening(voce)),
        UniaxialReturn(k, Hardening(perfect, prager)),
        UniaxialReturn(k, Hardening(voce, prager)),
        UniaxialReturn(k, Hardening(voce, recalling)),
        Iwan<S, 4>(elements),
        Iwan<S, 4>(elements, 5 * slope),
    };
}
/// Calls f with each law, and with whether it softens where f asks for that.
template <class S, class F>
void for_each_law(F&& f) {
    const auto laws = hysteretic_laws<S>();
    [&]<std::size_t... i>(std::index_sequence<i...>) {
        const auto call = [&](const auto& law, bool softens) {
            if constexpr (std::invocable<F&, decltype(law), bool>) {
                f(law, softens);
            } else {
                f(law);
            }
        };
        (call(std::get<i>(laws), i < softening_laws), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(laws)>>{});
}

/// Random positions: mostly short moves about a drifting centre, some long ones.
template <class S>
class History {
  public:
    explicit History(unsigned seed) : random_(seed) {}

    S next() {
        const double jump = uniform_(random_) * (uniform_(random_) > 0.9 ? 0.5 : 0.05);
        position_ = std::clamp(position_ + jump, -1.0, 1.0);
        return S(position_);
    }

  private:
    std::mt19937 random_;
    std::uniform_real_distribution<double> uniform_{-1, 1};
    double position_ = 0;
};

} // namespace

TEMPLATE_TEST_CASE("100000 random moves create no energy and no NaN", "[law][cyclic][property]",
                   float, double) {
    using S = TestType;
    constexpr S epsilon = std::numeric_limits<S>::epsilon();
    for_each_law<S>([](const auto& law, bool softens) {
        typename std::decay_t<decltype(law)>::State state;
        History<S> history(7);
        S from = 0;
        S force = 0;
        S travel = 0;
        double dissipated = 0;
        double least_work = 0;
        int failed_at = -1;
        // a move may err by the round-off of force × position, and of q_p after many turns
        const S round_off = 16 * epsilon * law.stiffness();
        for (int i = 0; i < 100000 && failed_at < 0; ++i) {
            const S to = history.next();
            const S before = law.held(state, from);
            const auto step = law.project(state, to);
            const S work = step.dissipated + law.held(state, to) - before;
            // Without softening the force goes monotonically from the old value to the new one,
            // which encloses the work from both sides; with it the force may rise above both in
            // between (no law here falls and then rises again).
            const S a = force * (to - from);
            const S b = step.force * (to - from);
            const bool finite = std::isfinite(step.force) && std::isfinite(step.plastic_increment);
            const bool enclosed = work >= std::min(a, b) - round_off &&
                                  (softens || work <= std::max(a, b) + round_off);
            if (!finite || !enclosed || !(step.dissipated >= 0)) failed_at = i;
            dissipated += double(step.dissipated);
            least_work += double(std::min(a, b));
            travel += std::abs(step.plastic_increment);
            force = step.force;
            from = to;
        }
        REQUIRE(failed_at == -1);
        CHECK(travel > 10); // the history did yield
        // what is dissipated and held is never less than what was surely put in
        CHECK(dissipated + double(law.held(state, from)) >= least_work);
    });
}

TEST_CASE("the work of a hardening law over a path is its force integrated along it",
          "[law][cyclic][property]") {
    // an account apart from the law's own: trapezia over short moves
    for_each_law<double>([](const auto& law) {
        typename std::decay_t<decltype(law)>::State state;
        History<double> history(11);
        double from = 0;
        double dissipated = 0;
        double integral = 0;
        double path = 0;
        for (int i = 0; i < 100; ++i) {
            const double to = history.next();
            auto fine = state;
            constexpr int parts = 200;
            for (int j = 1; j <= parts; ++j) {
                const double a = law.force(fine, from + (to - from) * (j - 1) / parts);
                const double b = law.project(fine, from + (to - from) * j / parts).force;
                integral += (a + b) / 2 * (to - from) / parts;
            }
            dissipated += law.project(state, to).dissipated;
            path += std::abs(to - from);
            from = to;
        }
        // each kink costs at most stiffness × part²/8, two kinks a move, ten for Iwan
        const double part = 0.5 / 200;
        CHECK(dissipated + law.held(state, from) ==
              Approx(integral).margin(100 * 10 * law.stiffness() * part * part / 8 * 0.1));
        CHECK(path > 1);
    });
}

TEST_CASE("a closed cycle never gives work", "[law][cyclic][property]") {
    test::prop("out and back to the start, as often as it takes to settle", [] {
        const double a = *rc::gen::inRange(-1000, 1000) / 1000.0;
        const double b = *rc::gen::inRange(-1000, 1000) / 1000.0;
        for_each_law<double>([&](const auto& law) {
            typename std::decay_t<decltype(law)>::State state;
            law.project(state, a);
            for (int i = 0; i < 5; ++i) {
                const double before = law.held(state, a);
                double dissipated = law.project(state, b).dissipated;
                dissipated += law.project(state, a).dissipated;
                // only what was held may come out
                RC_ASSERT(dissipated + law.held(state, a) - before >= -before - 1e-12);
                RC_ASSERT(dissipated >= 0);
            }
        });
    });
}

TEST_CASE("moves cut in two end in the same state", "[law][cyclic][property]") {
    test::prop("split", [] {
        const unsigned seed = *rc::gen::inRange(0u, 1000000u);
        const double cut = *rc::gen::inRange(0, 1000) / 1000.0;
        for_each_law<double>([&](const auto& law) {
            typename std::decay_t<decltype(law)>::State one;
            typename std::decay_t<decltype(law)>::State two;
            History<double> history(seed);
            double from = 0;
            double dissipated = 0;
            for (int i = 0; i < 20; ++i) {
                const double to = history.next();
                dissipated += law.project(one, to).dissipated;
                dissipated -= law.project(two, from + cut * (to - from)).dissipated;
                dissipated -= law.project(two, to).dissipated;
                from = to;
            }
            RC_ASSERT(std::abs(law.force(one, from) - law.force(two, from)) < 1e-10);
            RC_ASSERT(std::abs(dissipated) < 1e-10);
        });
    });
}

TEST_CASE("a history in mm gives the forces of the history in m", "[law][cyclic][units]") {
    const auto in_m = hysteretic_laws<double>();
    const auto in_mm = hysteretic_laws<double>(1000);
    const auto same = [](const auto& m, const auto& mm) {
        typename std::decay_t<decltype(m)>::State a;
        typename std::decay_t<decltype(m)>::State b;
        History<double> history(3);
        for (int i = 0; i < 200; ++i) {
            const double to = history.next();
            const auto seen = m.project(a, to);
            const auto scaled = mm.project(b, 1e3 * to);
            REQUIRE(scaled.force == Approx(seen.force).margin(1e-9));
            REQUIRE(scaled.dissipated == Approx(1e3 * seen.dissipated).margin(1e-8));
            REQUIRE(mm.held(b, 1e3 * to) == Approx(1e3 * m.held(a, to)).margin(1e-8));
        }
    };
    [&]<std::size_t... i>(std::index_sequence<i...>) {
        (same(std::get<i>(in_m), std::get<i>(in_mm)), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(in_m)>>{});
}

TEST_CASE("a state saved and restored goes on bit for bit", "[law][cyclic]") {
    for_each_law<double>([](const auto& law) {
        typename std::decay_t<decltype(law)>::State state;
        History<double> history(5);
        for (int i = 0; i < 50; ++i) law.project(state, history.next());
        auto saved = state;
        CHECK(saved == state);
        const double to = history.next() + 0.5;
        const auto seen = law.project(state, to);
        const auto again = law.project(saved, to);
        CHECK(seen.force == again.force);
        CHECK(seen.dissipated == again.dissipated);
        CHECK(saved == state);
    });
}
