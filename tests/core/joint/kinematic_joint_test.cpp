// SPDX-License-Identifier: MIT
//
// A mass on a bar whose elastic range moves by more than its half width, so that the bar drives the
// mass back: Prager and Armstrong-Frederick with an elastic part of any stiffness. Exact for Prager
// and k → ∞: v0 = 20 m/s, R = 10 N, H = 20 N/m swing to 4, -3, 2, -1 and rest at 0 m with 200 J
// dissipated.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/fracture/energy_limit.hpp"
#include "ductile/joint/one_axis_joint.hpp"

using namespace ductile;

namespace {

constexpr double speed = 20, energy = 200, strength = 10, modulus = 20, duration = 10;

template <class Back>
using Kinematic = Hardening<Perfect<double>, Back>;

/// A mass of 1 kg whose row is solved exactly.
template <class Joint>
struct Mass {
    void step(double dt) {
        const RowLimits<double> row = joint.prepare({position, velocity, 1}, dt);
        const double wanted = (row.bias - velocity) / (1 + row.compliance);
        const double impulse = std::clamp(wanted, row.lower * dt, row.upper * dt);
        velocity += impulse;
        position += velocity * dt;
        const Step<double> done = joint.commit({impulse / dt, velocity, position}, dt);
        unreliable += done.outcome == Outcome::unreliable;
        velocity = std::copysign(std::sqrt(velocity * velocity + 2 * done.release), velocity);
    }

    Joint joint;
    double position = 0, velocity = speed;
    int unreliable = 0;
};

/// The same by velocity Verlet in fine steps and a return map written out: no row, no account of
/// work.
struct Exact {
    Exact(double k, double recall) : stiffness(k), gamma(recall) {
        const auto steps = long(std::ceil(duration / std::min(1e-4, 0.02 / std::sqrt(k))));
        const double dt = duration / double(steps);
        for (long i = 0; i < steps; ++i) {
            const double before = force();
            position += (velocity + before * dt / 2) * dt;
            flow();
            velocity += (before + force()) * dt / 2;
        }
    }
    [[nodiscard]] double force() const { return -stiffness * (position - offset); }
    void flow() {
        const double beyond = -force() - back, direction = std::copysign(1.0, beyond);
        const double slope = modulus - gamma * back * direction;
        const double travel = (std::abs(beyond) - strength) / (stiffness + slope);
        if (!(travel > 0)) return;
        dissipated += (strength + gamma * back * back / modulus) * travel;
        back += direction * slope * travel;
        offset += direction * travel;
    }

    double stiffness, gamma;
    double position = 0, velocity = speed, offset = 0, back = 0, dissipated = 0;
};

/// `recall` 0: Prager.
template <class Back>
void swing(const Back& back, double recall, double a, double dt) {
    const double k = a / (dt * dt);
    INFO("a = k dt²/m = " << a << ", dt = 1/" << 1 / dt);
    Mass<OneAxisJoint<Kinematic<Back>>> mass{
        OneAxisJoint(Kinematic<Back>(Perfect<double>({.strength = strength}), back),
                     TravelLimit<double>(), {.stiffness = k})};
    for (int i = 0; i < int(std::round(duration / dt)); ++i) mass.step(dt);
    const auto& s = mass.joint.state();

    // beyond that stiffness nothing changes any more but the number of fine steps
    const Exact exact(std::min(k, 2e6), recall);
    // first order: ten steps a swing at 1/30 s. In between, where the row is neither the spring nor
    // the implicit one, it damps each of the four swings
    const double order = 30 * dt;
    const bool between = a > 0.25 && a < 4;
    CHECK(s.plastic_work ==
          Approx(exact.dissipated).margin((between ? 0.12 : 0.02) * order * energy));
    if (k > 100) CHECK(s.plastic_offset == Approx(exact.offset).margin(speed * dt));
    CHECK(s.other_work > -0.02 * order * energy);
    CHECK(mass.velocity * mass.velocity / 2 <= strength * strength / (2 * k) * 1.3 + 1e-9);
    CHECK(mass.unreliable == 0);
}

} // namespace

TEST_CASE("a bar that drives its mass back makes no energy and rests where the exact one does",
          "[one_axis_joint][kinematic]") {
    const double dt = GENERATE(1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 1000);
    const double a = GENERATE(0.01, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0, 100.0, 1e4, 1e6);
    swing(Prager<double>({.modulus = modulus}), 0, a, dt);
    swing(ArmstrongFrederick<double>({.modulus = modulus, .recall = 0.5}), 0.5, a, dt);
}

TEST_CASE("an energy limit counts what is dissipated, not what a back force holds",
          "[one_axis_joint][kinematic]") {
    // 40 J on the way to 4 m, where the bar resists with 90 N; 120 J after 12 m
    const double k = GENERATE(1e5, 1e8, double(std::numeric_limits<double>::infinity()));
    using Law = Kinematic<Prager<double>>;
    const Law law(Perfect<double>({.strength = strength}), Prager<double>({.modulus = modulus}));
    Mass<OneAxisJoint<Law, EnergyLimit<double>>> mass{
        OneAxisJoint(law, EnergyLimit<double>({.limit = 120}), {.stiffness = k})};
    for (int i = 0; i < 10000 && !mass.joint.state().broken; ++i) mass.step(1e-3);
    INFO("k = " << k);
    CHECK(mass.joint.state().broken);
    CHECK(mass.joint.state().plastic_work == Approx(120).epsilon(1e-9));
    CHECK(mass.joint.state().plastic_travel == Approx(12).epsilon(1e-3));
}

TEST_CASE("a back force beyond the strength uses all of it while it drives the flow back",
          "[one_axis_joint]") {
    const Kinematic<Prager<double>> law(Perfect<double>({.strength = strength}),
                                        Prager<double>({.modulus = modulus}));
    Mass<OneAxisJoint<Kinematic<Prager<double>>>> mass{OneAxisJoint(law)};
    const auto used = [&] { return mass.joint.utilisation(mass.joint.state().force); };
    mass.step(1e-3);
    CHECK(used() == Approx(1).epsilon(0.03));
    while (mass.velocity > 0) mass.step(1e-3);
    for (int i = 0; i < 200; ++i) mass.step(1e-3);
    REQUIRE(mass.velocity < -1); // 80 N back, 10 N of strength
    CHECK(used() == Approx(1).epsilon(0.03));
    const double held = mass.joint.state().law.back_force; // in the middle of its range
    CHECK(mass.joint.utilisation(-held) < 0.95);
}
