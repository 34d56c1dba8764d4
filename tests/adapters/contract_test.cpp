// SPDX-License-Identifier: MIT
//
// The contract of an adapter: this file is compiled for every engine and precision (RIG_HEADER) and
// run with every solver. Problems with known answers; where the engine's update is symplectic Euler
// with an exactly solved row, the answer in discrete time is known too and is what the test asks
// for.
#include RIG_HEADER

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include "adapters/features.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Round-off of an exact answer: accumulated over at most some thousand steps.
constexpr double exact = Rig::single ? 2e-4 : 1e-9;
/// The ledger's round-off, as a share of the energy put in.
constexpr double ledger_round_off = Rig::single ? 1e-4 : 1e-9;

const V3 none = V3::Zero();

Joint joint(double strength, double limit = infinity) {
    return Joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}));
}

/// Moment of inertia `i` about any axis.
V3 sphere(double i) { return V3::Constant(i); }

/// Travel of a row that stops from speed `u` at deceleration `a`, as symplectic Euler moves it.
double discrete_travel(double u, double a, double dt) {
    const double n = std::floor(u / (a * dt) * (1 + 1e-12));
    return dt * (n * u - a * dt * n * (n + 1) / 2);
}

} // namespace

TEST_CASE("a spinning rotor stops on its hinge", "[contract]") {
    // I = 2 kg m², M_p = 40 N m; 10 rad/s and 30 rad/s (many turns); along z and along (1, 2, 2)/3
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double rate = GENERATE(60.0, 240.0, 1000.0);
    const V3 axis = GENERATE(V3(0, 0, 1), V3(1.0 / 3, 2.0 / 3, 2.0 / 3));
    const double spin = GENERATE(10.0, 30.0);
    const double dt = 1 / rate;
    INFO(solver << ", dt = 1/" << rate << ", spin " << spin);
    Shown shown(solver, "P01 hinge stops");
    Rig rig(solver, none);
    auto rotor = rig.body(1, sphere(2), none, none, spin * axis);
    auto& hinge = rig.hinge(rotor, nullptr, none, axis, joint(40));
    rig.open_ledger();
    for (double t = 0; t < spin / 20 + 2 * dt; t += dt) rig.step(dt);

    shown.close(hinge.rotation(), discrete_travel(spin, 20, dt));
    shown.close(hinge.absorbed_energy(), spin * spin);
    shown.close(hinge.plastic_rotation(), spin * spin / 40);
    shown.close(Rig::spin(rotor).norm(), 0);
    CHECK(std::abs(rig.ledger().unexplained()) < ledger_round_off * spin * spin);
    CHECK(hinge.residual_max() < 1e-3);
}

TEST_CASE("a hinge that hardens stops both ways after the same travel", "[contract]") {
    // I = 2 kg m², R = 40 + 30 p: 40 p + 15 p² = 100 J
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double spin = GENERATE(10.0, -10.0);
    INFO(solver << ", spin " << spin);
    Shown shown(solver, "hardening");
    Rig rig(solver, none);
    auto rotor = rig.body(1, sphere(2), none, none, {0, 0, spin});
    auto& hinge = rig.hardening_hinge(rotor, none, {0, 0, 1}, 40, 30);
    for (int i = 0; i < 2000; ++i) rig.step(1e-3);
    const double travel = (-40 + std::sqrt(1600 + 60 * 100)) / 30;
    // the strength at the predicted midpoint: second order in the step
    CHECK(hinge.plastic_rotation() == Approx(travel).epsilon(1e-4));
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(1e-4));
    CHECK(std::abs(hinge.rotation()) == Approx(travel).margin(1.5 * 10 * 1e-3 / 2));
}

TEST_CASE("two coaxial rotors come to a common speed", "[contract]") {
    // I = 2 and 3 kg m², M_p = 12 N m: common 4 rad/s, 60 J, relative turn 5 rad less ω₀ dt/2
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const V3 axis = GENERATE(V3(0, 0, 1), V3(1.0 / 3, 2.0 / 3, 2.0 / 3));
    const double dt = 1.0 / 240;
    INFO(solver);
    Shown shown(solver, "P01 hinge stops");
    Rig rig(solver, none);
    auto a = rig.body(1, sphere(2), none, none, 10 * axis);
    auto b = rig.body(1, sphere(3), none, none, none);
    auto& hinge = rig.hinge(a, b, none, axis, joint(12));
    rig.open_ledger();
    for (double t = 0; t < 1.2; t += dt) rig.step(dt);

    shown.close(axis.dot(Rig::spin(a)), 4);
    shown.close(axis.dot(Rig::spin(b)), 4);
    shown.close(hinge.rotation(), discrete_travel(10, 10, dt));
    shown.close(hinge.absorbed_energy(), 60);
    CHECK(std::abs(rig.ledger().unexplained()) < ledger_round_off * 100);
}

TEST_CASE("a hinge breaks with the right residual speed at every step", "[contract]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double rate = GENERATE(15.0, 60.0, 240.0, 1000.0);
    INFO(solver << ", dt = 1/" << rate);
    Shown shown(solver, "P02 hinge breaks");
    const auto rotor_after = [&](double limit) {
        Rig rig(solver, none);
        auto rotor = rig.body(1, sphere(2), none, none, {0, 0, 10});
        auto& hinge = rig.hinge(rotor, nullptr, none, {0, 0, 1}, joint(40, limit));
        rig.open_ledger();
        for (int i = 0; i < 2000 && !hinge.broken(); ++i) rig.step(1 / rate);
        CHECK(hinge.broken());
        CHECK(hinge.outcome() == Outcome::broken);
        shown.close(hinge.absorbed_energy(), 40 * limit);
        CHECK(std::abs(rig.ledger().unexplained()) < ledger_round_off * 100);
        const double residual = Rig::spin(rotor).z();
        rig.step(1 / rate);
        shown.close(Rig::spin(rotor).z(), residual); // it stays broken
        return residual;
    };
    shown.close(rotor_after(1.6), 6);
    shown.close(rotor_after(1.3), 6.92820323);

    Rig rig(solver, none); // two bodies: 6 rad/s relative, 7.6 and 1.6 each
    auto a = rig.body(1, sphere(2), none, none, {0, 0, 10});
    auto b = rig.body(1, sphere(3), none, none, none);
    auto& hinge = rig.hinge(a, b, none, {0, 0, 1}, joint(12, 3.2));
    for (int i = 0; i < 2000 && !hinge.broken(); ++i) rig.step(1 / rate);
    shown.close(Rig::spin(a).z(), 7.6);
    shown.close(Rig::spin(b).z(), 1.6);
    shown.close(hinge.absorbed_energy(), 38.4);
}

TEST_CASE("a break hands its energy back through a joint off the centres of mass", "[contract]") {
    // two bars that turn about a pin between them; whatever the break gives back, the ledger knows
    // it
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double rate = GENERATE(60.0, 1000.0);
    INFO(solver << ", dt = 1/" << rate);
    Shown shown(solver, "P02 hinge breaks");
    Rig rig(solver, none);
    auto a = rig.body(1, {0.1, 0.4, 0.3}, {-1, 0, 0}, {0, -5, 0}, {0, 0, 5});
    auto b = rig.body(2, {0.2, 0.6, 0.5}, {1, 0, 0}, {0, -5, 0}, {0, 0, -5});
    auto& hinge = rig.hinge(a, b, none, {0, 0, 1}, joint(15, 0.5));
    rig.open_ledger();
    const V3 momentum = Rig::velocity(a) + 2 * Rig::velocity(b);
    const double input = rig.ledger().held().kinetic;
    for (int i = 0; i < 2000 && !hinge.broken(); ++i) rig.step(1 / rate);
    CHECK(hinge.broken());
    shown.close(hinge.absorbed_energy(), 15 * 0.5);
    CHECK(std::abs(rig.ledger().unexplained()) < ledger_round_off * input);
    CHECK((Rig::velocity(a) + 2 * Rig::velocity(b) - momentum).norm() <
          (Rig::single ? 1e-4 : 1e-10) * momentum.norm());
}

TEST_CASE("the block on the yielding bar follows the seed's table", "[contract]") {
    // 6000 kg, 80 kN, g = 10, dt = 1/60; the row acts from step 2 on
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "P22 slider yields");
    const double dt = 1.0 / 60;
    Rig rig(solver, {0, -10, 0});
    auto block = rig.body(6000, sphere(1000), none, none, none);
    rig.step(dt);
    shown.close(Rig::position(block).y(), -1.0 / 360);
    auto& bar = rig.slider(block, nullptr, {0, 1, 0}, joint(80e3));
    const double start = Rig::position(block).y();
    const double y[] = {-1.0 / 216, -1.0 / 180, -1.0 / 180, -1.0 / 180};
    const double v[] = {-1.0 / 9, -1.0 / 18, 0, 0};
    const double impulse[] = {4000.0 / 3, 4000.0 / 3, 4000.0 / 3, 1000};
    for (int i = 0; i < 4; ++i) {
        rig.step(dt);
        INFO("step " << i + 2);
        shown.close(Rig::position(block).y(), y[i]);
        shown.close(Rig::velocity(block).y(), v[i]);
        CHECK(bar.force() * dt == Approx(impulse[i]).epsilon(Rig::single ? 1e-3 : 1e-9));
    }
    shown.close(bar.elongation(), -1.0 / 360);
    CHECK(Rig::position(block).y() - start == Approx(bar.elongation()).margin(exact));
    shown.close(bar.plastic_elongation(),
                1.0 / 240); // work-conjugate: that of the continuous problem
}

TEST_CASE("a bar that is stronger than its load never moves", "[contract]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "P22 slider holds");
    Rig rig(solver, {0, -10, 0});
    auto block = rig.body(6000, sphere(1000), none, none, none);
    auto& bar = rig.slider(block, nullptr, {0, 1, 0}, joint(80e3));
    for (int i = 0; i < 300; ++i) rig.step(1.0 / 60);
    CHECK(std::abs(Rig::position(block).y()) < (Rig::single ? 1e-5 : 1e-12));
    CHECK(bar.force() == Approx(60e3).epsilon(exact));
    CHECK(bar.plastic_elongation() == 0);
    CHECK(bar.absorbed_energy() == 0);
    CHECK(bar.outcome() == Outcome::elastic);
}

TEST_CASE("a block thrown down its bar stops after the discrete travel", "[contract]") {
    // v₀ = -1 m/s: 0.141666667 m in 18 steps of 1/60 s; continuous 0.15 m
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "P22 slider yields");
    Rig rig(solver, {0, -10, 0});
    auto block = rig.body(6000, sphere(1000), none, {0, -1, 0}, none);
    auto& bar = rig.slider(block, nullptr, {0, 1, 0}, joint(80e3));
    for (int i = 0; i < 20; ++i) rig.step(1.0 / 60);
    shown.close(-bar.elongation(), 0.141666667, Rig::single ? 1e-4 : 1e-8);
    shown.close(bar.plastic_elongation(), 0.15);
}

TEST_CASE("a mass dropped on a crushing column", "[contract]") {
    // 500 kg falls 2 m on a 50 kg head on a 30 kN column: V₁ = 5.69471264 m/s, 0.362461412 m
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "P25 crush and break");
    const double g = 9.81, v1 = 5.69471264, crush = 0.362461412, deceleration = 44.7354545;

    SECTION("from the common speed on, as symplectic Euler moves it") {
        const double dt = 1.0 / 240;
        Rig rig(solver, {0, -g, 0});
        auto both = rig.body(550, sphere(50), none, {0, -v1, 0}, none);
        auto& column = rig.slider(both, nullptr, {0, 1, 0}, joint(30e3));
        for (int i = 0; i < 60; ++i) rig.step(dt);
        shown.close(-column.elongation(), discrete_travel(v1, deceleration, dt));
        // the last, partial step also works against gravity, hence second order and not exact
        CHECK(column.absorbed_energy() ==
              Approx(10873.8424).epsilon(2 * std::pow(deceleration * dt / v1, 2)));
        CHECK(-column.elongation() == Approx(crush).margin(1.5 * v1 * dt / 2));
    }
    SECTION("through the contact") {
        const double dt = 1.0 / 4000;
        Rig rig(solver, {0, -g, 0});
        auto head = rig.body(50, sphere(10), none, none, none);
        auto mass = rig.body(500, sphere(50), {0, 2.5, 0}, none, none);
        auto& column = rig.slider(head, nullptr, {0, 1, 0}, joint(30e3));
        rig.stack(head, mass, 0.5);
        rig.open_ledger();
        bool suspects = false;
        const auto step = [&] {
            rig.step(dt);
            suspects = suspects || column.outcome() == Outcome::unreliable;
        };
        while (Rig::position(mass).y() > 0.55) step();
        for (double t = 0; t < 0.25; t += dt) step();
        // a solver that lacks the capability may be wrong where it says so
        if (suspects && !Rig::can(solver, Capability::coupled)) return;
        // the contact is made up to a step early or late: twice the row's own -V₁ dt/2
        CHECK(-column.elongation() == Approx(crush).margin(3 * v1 * dt / 2));
        // while the contact is being made the column's force acts against it for half to one and a
        // half steps, which is then booked as contact instead of flow
        const double making = 1.5 * 30e3 * v1 * dt;
        CHECK(column.absorbed_energy() == Approx(10873.8424).margin(making));
        CHECK(rig.ledger().booked(Account::contact) == Approx(891.81818).margin(making));
        CHECK(std::abs(rig.ledger().unexplained()) < ledger_round_off * 500 * g * 2.5);
    }
    SECTION("and broken at 0.3 m") {
        const double dt = GENERATE(1.0 / 60, 1.0 / 240, 1.0 / 1000);
        Rig rig(solver, {0, -g, 0});
        auto both = rig.body(550, sphere(50), none, {0, -v1, 0}, none);
        auto& column = rig.slider(both, nullptr, {0, 1, 0}, joint(30e3, 0.3));
        for (int i = 0; i < 1000 && !column.broken(); ++i) rig.step(dt);
        CHECK(column.broken());
        shown.close(column.absorbed_energy(), 9000);
        // speed at the end of the breaking step: gravity acts on for at most the rest of it
        CHECK(-Rig::velocity(both).y() == Approx(2.36399648).margin(1.01 * g * dt));
    }
}

TEST_CASE("two rotors in series lock and stop together", "[contract]") {
    // ground -[20 N m]- 1 kg m² -[50 N m]- 2 kg m², the second spins at 12 rad/s; dt = 1/60
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "P27a two hinges in series");
    const double dt = 1.0 / 60;
    Rig rig(solver, none);
    auto first = rig.body(1, sphere(1), none, none, none);
    auto second = rig.body(1, sphere(2), none, none, {0, 0, 12});
    auto& to_ground = rig.hinge(first, nullptr, none, {0, 0, 1}, joint(20));
    auto& between = rig.hinge(second, first, none, {0, 0, 1}, joint(50));
    rig.open_ledger();
    double locked_moment = 0;
    for (double t = 0; t < 1.4; t += dt) {
        rig.step(dt);
        if (t > 0.5 && t < 0.55) locked_moment = between.moment();
    }
    const bool iterative = !Rig::can(solver, Capability::coupled);
    // an iterative solver leaves the two rows coupled to its own accuracy
    const double tolerance = iterative ? 2e-3 : exact;
    shown.close(to_ground.rotation(), 4241.0 / 1080, tolerance);
    shown.close(between.rotation(), 871.0 / 720, tolerance);
    CHECK(std::abs(locked_moment) == Approx(13.33333).epsilon(iterative ? 0.02 : 1e-5));
    shown.close(to_ground.absorbed_energy() + between.absorbed_energy(), 144,
                iterative ? 2e-3 : exact);
    CHECK(std::abs(rig.ledger().unexplained()) < ledger_round_off * 144);
}

namespace {

/// Ten segments of 1 kg and 0.1 m that stand out from a wall, a load of 50 kg at their end, every
/// joint of the same strength.
class Cantilever {
  public:
    static constexpr double length = 0.1, mass = 1, load = 50, gravity = 9.81;
    static constexpr int segments = 10;

    /// `share` of the collapse load: that at which the root yields.
    Cantilever(const std::string& solver, double share) : rig_(solver, {0, -gravity, 0}) {
        const double strength = root_moment() / share;
        Rig::Body last = nullptr;
        for (int i = 0; i <= segments; ++i) {
            const double m = i < segments ? mass : load;
            bodies_.push_back(
                rig_.body(m, sphere(inertia(m)), {(i + 0.5) * length, 0, 0}, none, none));
            hinges_.push_back(
                &rig_.hinge(bodies_.back(), last, {i * length, 0, 0}, {0, 0, 1}, joint(strength)));
            last = bodies_.back();
        }
    }
    /// About the root, of all weights [N m].
    static double root_moment() {
        return sum([](double m, double x) { return m * gravity * x; });
    }
    /// About the root [kg m²].
    static double root_inertia() {
        return sum([](double m, double x) { return inertia(m) + m * x * x; });
    }

    void step(double dt) {
        rig_.step(dt);
        for (auto* hinge : hinges_) {
            reliable_ = reliable_ && !says_wrong(*hinge);
        }
    }
    /// True while every joint was solved in every step.
    [[nodiscard]] bool reliable() const { return reliable_; }
    [[nodiscard]] double tip() const { return Rig::position(bodies_.back()).y(); }
    auto& root() { return *hinges_.front(); }
    [[nodiscard]] double plastic_elsewhere() const {
        double result = 0;
        for (std::size_t i = 1; i < hinges_.size(); ++i) result += hinges_[i]->plastic_rotation();
        return result;
    }

  private:
    static double inertia(double m) { return m * length * length / 12; }
    template <class F>
    static double sum(const F& f) {
        double result = 0;
        for (int i = 0; i <= segments; ++i) {
            result += f(i < segments ? mass : load, (i + 0.5) * length);
        }
        return result;
    }

    Rig rig_;
    std::vector<Rig::Body> bodies_;
    std::vector<Rig::Hinge*> hinges_;
    bool reliable_ = true;
};

} // namespace

TEST_CASE("a cantilever below its collapse load stays still, or says that it is unsolved",
          "[contract]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "P11 cantilever of 11 bodies");
    Cantilever beam(solver, 0.9);
    for (int i = 0; i < 100; ++i) beam.step(1e-3);
    if (Rig::can(solver, Capability::chains)) CHECK(beam.reliable());
    shown.right_or_reported(std::abs(beam.tip()) < (Rig::single ? 1e-4 : 1e-8), !beam.reliable());
    if (beam.reliable()) {
        // ODE's global CFM of 1e-10 lets each joint give 540 N · 1e-10 · dt/erp: 3e-9 m in all
        CHECK(std::abs(beam.tip()) < (Rig::single ? 1e-4 : 1e-8));
        CHECK(beam.root().plastic_rotation() == 0);
        CHECK(beam.plastic_elsewhere() == 0);
    }
}

TEST_CASE("a cantilever above its collapse load turns about its root, or says that it is unsolved",
          "[contract]") {
    // a rigid bar on a hinge of moment M_p: I θ'' = M cos θ - M_p, in the engine's steps
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "P11 cantilever of 11 bodies");
    const double dt = 1e-3, share = 1.5;
    Cantilever beam(solver, share);
    double angle = 0, speed = 0;
    for (int i = 0; i < 200; ++i) {
        beam.step(dt);
        speed += dt * Cantilever::root_moment() * (std::cos(angle) - 1 / share) /
                 Cantilever::root_inertia();
        angle += dt * speed;
    }
    if (Rig::can(solver, Capability::chains)) CHECK(beam.reliable());
    if (!beam.reliable()) shown.right_or_reported(false, true);
    if (beam.reliable()) {
        // a chain's links move along tangents: off the bar's circle by second order in the step
        shown.close(-beam.root().rotation(), angle, 1e-3 * angle);
        CHECK(beam.plastic_elsewhere() < 1e-3 * angle);
    }
}

TEST_CASE("two runs are equal bit for bit", "[contract]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const auto run = [&solver] {
        Rig rig(solver, {0, -9.81, 0});
        auto a = rig.body(1, {0.1, 0.4, 0.3}, {1, 0, 0}, none, {1, 2, 3});
        auto b = rig.body(2, {0.2, 0.6, 0.5}, {3, 0, 0}, {0, 4, 1}, none);
        auto& root = rig.hinge(a, nullptr, none, {0, 0, 1}, joint(15));
        auto& link = rig.hinge(b, a, {2, 0, 0}, {0, 0, 1}, joint(5));
        for (int i = 0; i < 300; ++i) rig.step(0.004);
        return std::vector{root.rotation(),        link.rotation(),      root.absorbed_energy(),
                           link.absorbed_energy(), Rig::position(b).x(), Rig::position(b).y()};
    };
    const bool same = run() == run();
    CHECK(same);
    Shown(solver, "two runs equal bit for bit").small(same ? 0 : 1, 0);
}
