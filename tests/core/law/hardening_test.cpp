// SPDX-License-Identifier: MIT
//
// Hardening as a rigid-plastic row sees it. The row of the dynamic tests is solved in closed form:
// one mass, one bounded row.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "ductile/law/hardening.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/multilinear.hpp"
#include "ductile/law/voce.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

struct NotALaw {
    using Scalar = double;
    using State = int;
};
static_assert(!CyclicLaw<NotALaw> && !CyclicLaw<Perfect<double>>);
static_assert(std::is_trivially_copyable_v<HardeningState<double>>);

using Kinematic = KinematicHardening<double>;
using Isotropic = IsotropicHardening<Linear<double>>;
using Mixed = Hardening<Voce<double>, ArmstrongFrederick<double>>;

const Kinematic kinematic(Perfect(PerfectParameters<double>{.strength = 4.0}),
                          Prager(PragerParameters<double>{.modulus = 20.0}));
const Isotropic isotropic(Linear(LinearParameters<double>{.strength = 4.0, .hardening = 20.0}));
const Mixed mixed(Voce(VoceParameters<double>{.strength = 4.0, .saturation = 2.0, .rate = 5.0}),
                  ArmstrongFrederick(ArmstrongFrederickParameters<double>{.modulus = 60.0,
                                                                          .recall = 12.0}));

struct Flown {
    double displacement = 0; ///< u_p, work-conjugate
    double dissipated = 0;
    double stored = 0;
    double row_work = 0; ///< impulse × mean velocity: exactly the loss of kinetic energy
};

/// A mass 2 kg with 1 m/s is stopped by a rigid-plastic row; it may flow back where the range has
/// left zero.
template <CyclicLaw Law>
Flown stop(const Law& law, double dt) {
    constexpr double mass = 2;
    typename Law::State state;
    Flown flown;
    double velocity = 1;
    for (int i = 0; i < 100000; ++i) {
        const auto [lower, upper] = law.prepare(state, velocity * dt);
        // the row exerts -force on the mass, and stops it where the range allows
        const double force = std::clamp(mass * velocity / dt, lower, upper);
        const double next = velocity - force * dt / mass;
        const bool flows = force == lower || force == upper;
        const double mean = (velocity + next) / 2;
        // the step to rest does what the bound would have done until rest
        const double increment =
            flows ? mean * dt : force * mean * dt / (velocity > 0 ? upper : lower);
        const FlowWork<double> work = law.commit(state, increment);
        flown.displacement += increment;
        flown.dissipated += work.dissipated;
        flown.stored += work.stored;
        flown.row_work += force * mean * dt;
        velocity = next;
        if (velocity == 0 && law.prepare(state, 0).lower <= 0 && law.prepare(state, 0).upper >= 0)
            break;
    }
    return flown;
}

double order(double coarse, double fine) { return std::log2(std::abs(coarse / fine)); }

} // namespace

TEST_CASE("isotropic hardening widens the range, kinematic hardening moves it",
          "[law][hardening]") {
    HardeningState<double> state;
    CHECK(isotropic.prepare(state, 0) == ForceRange<double>{-4, 4});
    isotropic.commit(state, 0.1);
    CHECK(isotropic.prepare(state, 0) == ForceRange<double>{-6, 6});
    isotropic.commit(state, -0.1);
    CHECK(isotropic.prepare(state, 0) == ForceRange<double>{-8, 8});

    state = {};
    kinematic.commit(state, 0.1);
    CHECK(kinematic.prepare(state, 0) == ForceRange<double>{-2, 6});
    kinematic.commit(state, 0.2);
    CHECK(kinematic.prepare(state, 0).lower == Approx(2)); // zero is outside: Bauschinger
    kinematic.commit(state, -0.3);
    CHECK(kinematic.prepare(state, 0).lower == Approx(-4));
    CHECK(kinematic.stored(state) == Approx(0).margin(1e-28));
    CHECK(state.plastic_travel == Approx(0.6));
}

TEST_CASE("the range stands at the midpoint of the predicted flow, on its side only",
          "[law][hardening]") {
    const HardeningState<double> state{.plastic_travel = 0.1, .back_force = 1};
    const ForceRange<double> still = mixed.prepare(state, 0);
    const ForceRange<double> forward = mixed.prepare(state, 0.02);
    const ForceRange<double> backward = mixed.prepare(state, -0.02);
    CHECK(forward.lower == still.lower);
    CHECK(backward.upper == still.upper);
    HardeningState<double> half = state;
    mixed.commit(half, 0.01);
    CHECK(forward.upper == Approx(mixed.prepare(half, 0).upper).epsilon(1e-14));
    half = state;
    mixed.commit(half, -0.01);
    CHECK(backward.lower == Approx(mixed.prepare(half, 0).lower).epsilon(1e-14));
}

TEST_CASE("dissipated and stored work are the integrals over the flow", "[law][hardening]") {
    // P07's account: dissipated R × accumulated travel, stored H u_p²/2
    HardeningState<double> state;
    FlowWork<double> sum;
    for (const double increment : {0.11, -0.14, 0.04}) {
        const auto work = kinematic.commit(state, increment);
        sum.dissipated += work.dissipated;
        sum.stored += work.stored;
    }
    CHECK(sum.dissipated == Approx(4 * 0.29).epsilon(1e-14));
    CHECK(sum.stored == Approx(20 * 0.01 * 0.01 / 2).epsilon(1e-12));

    // any law: against the midpoint sum of the resistance, order 2
    state = {.plastic_travel = 0.05, .back_force = -2};
    HardeningState<double> stepped = state;
    const auto whole = mixed.commit(state, 0.2);
    double integral = 0;
    constexpr int parts = 2000;
    for (int i = 0; i < parts; ++i) {
        integral += mixed.prepare(stepped, 0.2 / parts).upper * 0.2 / parts;
        mixed.commit(stepped, 0.2 / parts);
    }
    CHECK(whole.dissipated + whole.stored == Approx(integral).epsilon(1e-6));
    CHECK(whole.dissipated > 0);
    CHECK(state.back_force == Approx(stepped.back_force).epsilon(1e-12));
    CHECK(state.plastic_travel == Approx(stepped.plastic_travel).epsilon(1e-12));
}

TEST_CASE("cutting an increment in two changes nothing", "[law][hardening][property]") {
    test::prop("split", [] {
        const double x = *rc::gen::inRange(-490, 490) / 100.0;
        const double whole = *rc::gen::inRange(-1000, 1000) / 1000.0;
        const double cut = *rc::gen::inRange(0, 1000) / 1000.0;
        const auto check = [&](const auto& law) {
            HardeningState<double> one{.plastic_travel = 0.02, .back_force = x};
            HardeningState<double> two = one;
            const auto work = law.commit(one, whole);
            const auto first = law.commit(two, whole * cut);
            const auto second = law.commit(two, whole - whole * cut);
            RC_ASSERT(std::abs(one.back_force - two.back_force) < 1e-12);
            RC_ASSERT(std::abs(one.plastic_travel - two.plastic_travel) < 1e-14);
            RC_ASSERT(std::abs(work.dissipated - first.dissipated - second.dissipated) < 1e-12);
            RC_ASSERT(std::abs(work.stored - first.stored - second.stored) < 1e-12);
        };
        check(kinematic);
        check(isotropic);
        check(mixed);
    });
}

TEST_CASE("the tangent is the finite difference of the resistance", "[law][hardening][property]") {
    test::prop("both directions", [] {
        const HardeningState<double> state{.plastic_travel = 0.02,
                                           .back_force = *rc::gen::inRange(-490, 490) / 100.0};
        const double travel = 1e-3 + *rc::gen::inRange(0, 1000) / 1000.0;
        const auto check = [&](const auto& law, double direction) {
            constexpr double h = 1e-6;
            const double difference = (law.resistance(state, travel + h, direction) -
                                       law.resistance(state, travel - h, direction)) /
                                      (2 * h * direction);
            RC_ASSERT(std::abs(difference - law.tangent(state, travel, direction)) < 1e-6);
        };
        for (const double direction : {-1.0, 1.0}) {
            check(kinematic, direction);
            check(isotropic, direction);
            check(mixed, direction);
        }
    });
}

TEST_CASE("Armstrong-Frederick saturates, and tends to Prager without recall", "[law][hardening]") {
    const ArmstrongFrederick law(
        ArmstrongFrederickParameters<double>{.modulus = 60.0, .recall = 12.0});
    CHECK(law.shifted(0, 10) == Approx(5).epsilon(1e-14));
    CHECK(law.shifted(0, -10) == Approx(-5).epsilon(1e-14));
    CHECK(law.shifted(0, 0.1) == Approx(5 * (1 - std::exp(-1.2))).epsilon(1e-14));
    // all work at saturation is lost: rate γ a²/C = a
    CHECK(law.dissipated(5, 0.1) == Approx(0.5).epsilon(1e-13));
    const ArmstrongFrederick straight(
        ArmstrongFrederickParameters<double>{.modulus = 60.0, .recall = 1e-9});
    const Prager prager(PragerParameters<double>{.modulus = 60.0});
    CHECK(straight.shifted(0.5, 0.2) == Approx(prager.shifted(0.5, 0.2)).epsilon(1e-8));
    CHECK(straight.stored(0.5) == prager.stored(0.5));
}

TEST_CASE("a rigid-plastic row with hardening stops where energy says, to second order",
          "[law][hardening][order]") {
    // m v0²/2 = 1 J = R u + H u²/2 in the first excursion, R = 4, H = 20
    const double exact = (-4 + std::sqrt(16 + 2 * 20.0)) / 20;
    std::array<double, 4> error{};
    std::array<double, 4> unbalanced{};
    double dt = 1.0 / 60;
    for (std::size_t i = 0; i < error.size(); ++i, dt /= 2) {
        const Flown flown = stop(isotropic, dt);
        error[i] = flown.displacement - exact;
        unbalanced[i] = flown.row_work - flown.dissipated - flown.stored;
        CHECK(flown.row_work == Approx(1).epsilon(1e-12));
    }
    for (std::size_t i = 1; i < error.size(); ++i) {
        CHECK(order(error[i - 1], error[i]) >= 1.8);
        CHECK(order(unbalanced[i - 1], unbalanced[i]) >= 1.8);
    }
}

TEST_CASE("kinematic hardening gives stored work back until zero force is inside the range",
          "[law][hardening][order]") {
    // First stop at x = H u > R: flows back from rest; every excursion by energy,
    // H u²/2 + R |u - u0| = H u0²/2
    const Kinematic law(Perfect(PerfectParameters<double>{.strength = 1.0}),
                        Prager(PragerParameters<double>{.modulus = 20.0}));
    double u = (-1 + std::sqrt(1 + 40.0)) / 20;
    double travel = u;
    while (20 * std::abs(u) > 1) {
        const double next = std::copysign(0.1, u) - u; // H (u + next)/2 = ±R
        travel += std::abs(u - next);
        u = next;
    }
    std::array<double, 4> error{};
    double dt = 1.0 / 240;
    for (std::size_t i = 0; i < error.size(); ++i, dt /= 2) {
        const Flown flown = stop(law, dt);
        error[i] = flown.displacement - u;
        CHECK(flown.dissipated == Approx(travel).epsilon(0.1 * 240 * dt));
        CHECK(flown.row_work == Approx(1).epsilon(1e-12));
    }
    CAPTURE(error, u, travel);
    CHECK(std::abs(error[3]) < 1e-3 * std::abs(u));
    CHECK(order(error[0], error[3]) / 3 >= 1.8);
}

TEST_CASE("back forces refuse bad parameters by name, value, unit and range",
          "[law][hardening][input]") {
    CHECK(message_of([] { Prager<double>({}); }) ==
          "Prager.modulus = nan N/m or N m/rad: must be finite and > 0");
    CHECK(message_of([] { ArmstrongFrederick<double>({.modulus = 0, .recall = 1}); }) ==
          "ArmstrongFrederick.modulus = 0 N/m or N m/rad: must be finite and > 0");
    CHECK(message_of([] { ArmstrongFrederick<double>({.modulus = 1, .recall = -2}); }) ==
          "ArmstrongFrederick.recall = -2 1/m or 1/rad: must be finite and > 0");
}
