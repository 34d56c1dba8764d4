// SPDX-License-Identifier: MIT
//
// A World that leapfrogs: what moves under loads and yields is right to second order in the step.
// Compiled for every engine and precision (RIG_HEADER).
#include RIG_HEADER

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace ductile;
using namespace ductile::test;

namespace {

const V3 none = V3::Zero();
constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double round_off = WorldRig::single ? 2e-4 : 1e-9;
/// Lengths of steps, one after the other [s].
constexpr std::array<double, 5> uneven{1.0 / 60, 1.0 / 240, 1.0 / 500, 1.0 / 120, 1.0 / 60};

struct Rig : WorldRig {
    Rig() : WorldRig(false, nullptr, true, true) {}
};

Joint joint(double strength, double limit = unlimited, double stiffness = unlimited) {
    return Joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}),
                 {.stiffness = stiffness});
}

WorldRig::Body rotor(WorldRig& rig, double spin) {
    const auto body = rig.body(1, V3::Constant(2), none);
    WorldRig::set_spin(body, V3(0, 0, spin));
    return body;
}

/// Whether a stop from 10 rad/s within 100/64 rad is rightly said to be off by more than 4 %.
bool coarse(double dt, bool leapfrog) { return !leapfrog && 10 * dt / 2 > 0.04 * 100 / 64; }

/// Rotation at rest of a rotor of 2 kg m² and 10 rad/s on a hinge of 64 N m.
double rotation_at_rest(double dt, bool leapfrog) {
    WorldRig rig(false, nullptr, true, leapfrog);
    auto& hinge = rig.hinge(rotor(rig, 10), nullptr, none, joint(64), "hinge");
    while (rig.world().time() < 0.5) rig.world().step(dt);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(round_off));
    CHECK(std::abs(rig.world().ledger().unexplained()) < 100 * round_off);
    CHECK((rig.world().watch().coarse_steps(0) > 0) == coarse(dt, leapfrog));
    return hinge.rotation();
}

} // namespace

TEST_CASE("a body falls by a t^2/2 under gravity and an applied force", "[leapfrog]") {
    Rig rig;
    rig.set_gravity({0, -10, 0});
    const auto body = rig.body(2, V3::Constant(1), none);
    for (int i = 0; i < 20; ++i) {
        WorldRig::apply_force(body, {4, 0, 0});
        rig.world().step(uneven[std::size_t(i) % uneven.size()]);
        const double t = rig.world().time();
        CHECK(WorldRig::position(body).x() == Approx(t * t).epsilon(round_off));
        CHECK(WorldRig::position(body).y() == Approx(-5 * t * t).epsilon(round_off));
    }
    const Ledger<double>& ledger = rig.world().ledger();
    CHECK(std::abs(ledger.unexplained()) < round_off * ledger.held().kinetic);
    // by the forces, each over the time for which it acted
    // the applied force's work, over the time for which it acted
    const double speed = WorldRig::velocity(body).x();
    CHECK(ledger.supplied() == Approx(2 * speed * speed / 2).epsilon(10 * round_off));
}

TEST_CASE("a hinge that stops a rotor rests where it should to second order", "[leapfrog]") {
    const double exact = 100.0 / 64, rate = 64.0 / 2;
    for (const double dt : {1.0 / 60, 1.0 / 100, 1.0 / 240}) {
        CHECK(std::abs(rotation_at_rest(dt, true) - exact) < rate * dt * dt / 8 + 10 * round_off);
        // without it, by half a step of the first speed
        CHECK(std::abs(rotation_at_rest(dt, false) - exact) > 0.4 * 10 * dt);
    }
}

TEST_CASE("steps of changing length, a new start and a break leapfrog as well", "[leapfrog]") {
    Rig rig;
    const auto body = rotor(rig, 10);
    auto& hinge = rig.hinge(body, nullptr, none, joint(64, 2.5), "hinge");
    for (int i = 0; i < 50; ++i) rig.world().step(uneven[std::size_t(i) % uneven.size()]);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(round_off));
    CHECK(hinge.rotation() == Approx(100.0 / 64).margin(64.0 / 2 / 60 / 60 / 4));

    // 160 J are the end of it: 60 more
    const double before = hinge.rotation();
    WorldRig::set_spin(body, V3(0, 0, 4));
    rig.world().restart();
    for (int i = 0; i < 40; ++i) rig.world().step(1.0 / 60);
    CHECK(hinge.rotation() - before == Approx(16.0 / 64).margin(64.0 / 2 / 60 / 60 / 4));
    WorldRig::set_spin(body, V3(0, 0, 10));
    rig.world().restart();
    for (int i = 0; i < 40; ++i) rig.world().step(uneven[std::size_t(i) % uneven.size()]);
    CHECK(hinge.broken());
    CHECK(hinge.absorbed_energy() == Approx(160).epsilon(round_off));
    CHECK(WorldRig::spin(body).z() == Approx(std::sqrt(100 - (160 - 116))).epsilon(round_off));
    const Ledger<double>& ledger = rig.world().ledger();
    CHECK(std::abs(ledger.unexplained()) < 200 * round_off);
}

TEST_CASE("a saved run that leapfrogs goes on bit for bit", "[leapfrog]") {
    Rig rig;
    const auto body = rotor(rig, 10);
    auto& hinge = rig.hinge(body, nullptr, none, joint(8), "hinge");
    CHECK(rig.world().last_step() == 0);
    for (const double dt : uneven) rig.world().step(dt);
    CHECK(rig.world().last_step() == uneven.back());
    const auto saved = WorldRig::save(body, hinge);
    const double absorbed = hinge.absorbed_energy();
    const auto after = [&](double last) {
        WorldRig::put_back(body, hinge, saved); // an engine may round what it is given
        rig.world().resume(last);
        for (const double dt : {1.0 / 500, 1.0 / 100, 1.0 / 60}) rig.world().step(dt);
        return WorldRig::save(body, hinge);
    };
    const auto once = after(uneven.back());
    CHECK(hinge.absorbed_energy() > absorbed);
    rig.world().step(0.1);
    CHECK(after(uneven.back()) == once);
    CHECK_FALSE(after(0) == once); // its first step would be half a one
    CHECK_THROWS_AS(rig.world().resume(-1), std::invalid_argument);
}

TEST_CASE("what carries its weight stays still however steps change", "[leapfrog]") {
    const double share = GENERATE(0.99, 1.01);
    Rig rig;
    rig.set_gravity({0, -10, 0});
    const auto body = rig.body(2, V3::Constant(0.5), {1, 0, 0});
    auto& hinge = rig.hinge(body, nullptr, none, joint(20 / share), "hinge");
    for (int i = 0; i < 60; ++i) rig.world().step(uneven[std::size_t(i) % uneven.size()]);
    if (share < 1) {
        CHECK(hinge.absorbed_energy() == 0);
        CHECK(std::abs(hinge.rotation()) < round_off);
        CHECK(std::abs(hinge.moment()) ==
              Approx(20).epsilon(round_off)); // whatever the step's share
    } else {
        // falls by what it cannot carry, I = 2.5 kg m² about the hinge
        const double t = rig.world().time(), rate = (20 - 20 / share) / 2.5;
        CHECK(std::abs(hinge.rotation()) == Approx(rate * t * t / 2).epsilon(5e-3));
    }
}

TEST_CASE("a spring under a sudden load swings to twice its rest", "[leapfrog]") {
    Rig rig;
    rig.set_gravity({0, -10, 0});
    const auto body = rig.body(2, V3::Constant(0.5), {1, 0, 0});
    auto& hinge = rig.hinge(body, nullptr, none, joint(1000, unlimited, 2000), "spring");
    double most = 0;
    const double period = 2 * std::acos(-1.0) * std::sqrt(2.5 / 2000);
    int i = 0;
    while (rig.world().time() < 1.2 * period) {
        rig.world().step(uneven[std::size_t(i++) % uneven.size()] / 4);
        most = std::max(most, std::abs(hinge.rotation()));
    }
    CHECK(most == Approx(2 * 20.0 / 2000).epsilon(0.02));
    CHECK(hinge.absorbed_energy() == 0);
    CHECK(std::abs(rig.world().ledger().unexplained()) < round_off);
}

TEST_CASE("six axes leapfrog as one does", "[leapfrog]") {
    const auto capacity = Vector6<double>::Constant(64).eval();
    const auto rest = [&capacity](double dt, bool leapfrog) {
        WorldRig rig(false, nullptr, true, leapfrog);
        auto& six = rig.six_axes(rotor(rig, 10), none,
                                 SixAxes(Ellipsoid<double, 6>({.capacity = capacity}),
                                         Perfect<double>({.strength = 64})));
        while (rig.world().time() < 0.5) rig.world().step(dt);
        CHECK(six.absorbed_energy() == Approx(100).epsilon(10 * round_off));
        CHECK(std::abs(rig.world().ledger().unexplained()) < 100 * round_off);
        CHECK((rig.world().watch().coarse_steps(0) > 0) == coarse(dt, leapfrog));
        return six.position(JointAxis::torsion);
    };
    for (const double dt : {1.0 / 60, 1.0 / 240}) {
        CHECK(std::abs(rest(dt, true) - 100.0 / 64) < 32 * dt * dt / 8 + 10 * round_off);
        CHECK(std::abs(rest(dt, false) - 100.0 / 64) > 0.4 * 10 * dt);
    }
}
