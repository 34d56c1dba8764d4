// SPDX-License-Identifier: MIT
//
// The contract of an adapter, continued: elastic rows and bounds that differ both ways. P03, P04
// and P07a on a turning and on a sliding row; P06 with kinematic hardening; P23 with two axes on
// one surface. The reference integrator gives the answer in discrete time, closed forms the order.
// Compiled for every engine and precision (RIG_HEADER), run with every solver.
#include RIG_HEADER

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "adapters/features.hpp"
#include "adapters/six_axis.hpp"
#include "reference/order.hpp"
#include "reference/problems/oscillator.hpp"

using namespace ductile;
using namespace ductile::test;
using reference::Bilinear;
using reference::no_force;
using reference::Oscillator;
using reference::Peak;
using reference::peaks;
using reference::perfect;
using reference::Quantity;
using reference::Trend;

namespace {

enum class Kind { turning, sliding };
const std::vector<std::string> kind_names{"turning", "sliding"};

/// Enough for sequential impulse, whose error on a soft row each sweep at least halves.
constexpr int sweeps = 60;

/// Mass of a body that goes on as it is told [kg | kg m²]. Stock sequential impulse leaves rows out
/// whose inverse mass is less than SIMD_EPSILON, in float 1.2e-7.
constexpr double heavy = Rig::single ? 1e6 : 1e9;

/// A mass on an elastic-plastic row of the engine, along a crooked axis; same verbs as the
/// reference's.
template <class Law>
class RigOscillator {
    using RowLaw = OneAxisJoint<Law>;
    using Hinge = std::remove_reference_t<decltype(std::declval<Rig&>().hinge_of(
        Rig::Body(), Rig::Body(), V3(), V3(), std::declval<RowLaw>()))>;
    using Slider = std::remove_reference_t<decltype(std::declval<Rig&>().slider_of(
        Rig::Body(), Rig::Body(), V3(), std::declval<RowLaw>()))>;

  public:
    RigOscillator(Kind kind, double mass, double stiffness, const Law& law,
                  const std::string& solver)
        : rig_(solver, none) {
        rig_.set_iterations(sweeps);
        const RowLaw joint(law, TravelLimit<double>(), {.stiffness = stiffness});
        const bool turns = kind == Kind::turning;
        body_ = rig_.body(turns ? 1 : mass, sphere(turns ? mass : 1), none, none, none);
        if (turns) {
            hinge_ = &rig_.hinge_of(body_, nullptr, none, axis_, joint);
        } else {
            slider_ = &rig_.slider_of(body_, nullptr, axis_, joint);
        }
        rig_.open_ledger();
    }

    void step(double dt, double load = 0) {
        if (hinge_ != nullptr) {
            Rig::apply_torque(body_, load * axis_);
        } else {
            Rig::apply_force(body_, load * axis_);
        }
        rig_.step(dt);
    }
    void set_velocity(double velocity) {
        if (hinge_ != nullptr) {
            Rig::set_spin(body_, velocity * axis_);
        } else {
            Rig::set_velocity(body_, velocity * axis_);
        }
        rig_.open_ledger();
    }
    [[nodiscard]] double position() {
        return hinge_ != nullptr ? hinge_->rotation() : slider_->elongation();
    }
    [[nodiscard]] double velocity() {
        return hinge_ != nullptr ? hinge_->velocity() : slider_->velocity();
    }
    [[nodiscard]] double force() { return hinge_ != nullptr ? hinge_->moment() : slider_->force(); }
    [[nodiscard]] const auto& state() {
        return hinge_ != nullptr ? hinge_->joint().state() : slider_->joint().state();
    }
    [[nodiscard]] double unexplained() const { return rig_.ledger().unexplained(); }

  private:
    V3 axis_ = V3(1, 2, 2) / 3;
    Rig rig_;
    Rig::Body body_ = nullptr;
    Hinge* hinge_ = nullptr;
    Slider* slider_ = nullptr;
};

/// Steps both and compares everything that a user can ask for.
template <class Law>
void same_as_reference(Shown& shown, Kind kind, const std::string& solver, double mass,
                       double stiffness, const Law& law, double speed, double load, double dt) {
    RigOscillator engine(kind, mass, stiffness, law, solver);
    Oscillator same(mass, stiffness, law);
    engine.set_velocity(speed);
    same.set_velocity(speed);
    const double size = std::abs(speed) + 0.1;
    double off = 0;
    for (int i = 0; i < 300; ++i) {
        engine.step(dt, load);
        same.step(dt, load);
        off = std::max({off, std::abs(engine.position() - same.position()) / size,
                        std::abs(engine.velocity() - same.velocity()) / size});
    }
    shown.small(off, exact);
    const auto& a = engine.state();
    const auto& b = same.state();
    shown.small(a.plastic_offset - b.plastic_offset, exact);
    shown.small(a.plastic_travel - b.plastic_travel, exact);
    const double given = mass * speed * speed / 2 + std::abs(load * engine.position());
    shown.small((a.plastic_work - b.plastic_work) / given, exact);
    shown.small((a.stored - b.stored) / given, exact);
    shown.small(engine.unexplained() / given, exact);
    CHECK(a.residual_max < (Rig::single ? 1e-4 : 1e-6) * size);
}

Hardening<Perfect<double>, Prager<double>> kinematic() {
    const Bilinear b;
    return Hardening(perfect(b.strength), Prager<double>({.modulus = b.hardening()}));
}

/// Second order, in double: the errors of float end in round-off before they fall regularly.
void second_order(const reference::Run& run) {
    if (Rig::single) return;
    const double dt = 1.0 / 240;
    const std::vector<double> order = reference::observed_orders(run, dt, 8, 3);
    const std::vector<Quantity> named = run(dt);
    for (std::size_t i = 0; i < order.size(); ++i) {
        INFO(named[i].name << ": order " << order[i]);
        CHECK(order[i] >= 1.8);
    }
}

} // namespace

TEST_CASE("an elastic row moves as in the reference integrator at every step, resolved or not",
          "[contract][axes]") {
    // ω = 20 rad/s: k dt²/m from 4e-4 (symplectic) to 16 (implicit)
    const auto solver = GENERATE(from_range(solvers_with<Rig>(Capability::any_rows)));
    const auto kind = GENERATE(Kind::turning, Kind::sliding);
    const double dt = GENERATE(1e-3, 1.0 / 240, 1.0 / 30, 1.0 / 15, 0.2);
    INFO(solver << ", " << kind_names[std::size_t(kind)] << ", dt = " << dt);
    SECTION("P03, free past yield") {
        Shown shown(solver, "P03 elastic row");
        same_as_reference(shown, kind, solver, 0.5, 200, perfect(10), 3, 0, dt);
        same_as_reference(shown, kind, solver, 0.5, 200, perfect(10), -3, 0, dt);
    }
    SECTION("P04, a load applied at once and held") {
        Shown shown(solver, "P04 elastic row");
        same_as_reference(shown, kind, solver, 100, 4e4, perfect(2000), 0, 1600, dt);
    }
    SECTION("P07a, kinematic hardening: the bounds shift") {
        Shown shown(solver, "P07a kinematic hardening");
        const Bilinear b;
        same_as_reference(shown, kind, solver, b.mass, b.stiffness, kinematic(), b.speed, 0, dt);
        same_as_reference(shown, kind, solver, b.mass, b.stiffness, kinematic(), -b.speed, 0, dt);
    }
    SECTION("P07a, isotropic hardening") {
        Shown shown(solver, "P07a isotropic hardening");
        const Bilinear b;
        const Linear<double> law({.strength = b.strength, .hardening = b.hardening()});
        same_as_reference(shown, kind, solver, b.mass, b.stiffness, law, b.speed, 0, dt);
    }
}

TEST_CASE("a rigid row with a back force has bounds that differ both ways", "[contract][axes]") {
    const auto solver = GENERATE(from_range(solvers_with<Rig>(Capability::any_rows)));
    const auto kind = GENERATE(Kind::turning, Kind::sliding);
    const double dt = GENERATE(1.0 / 60, 1.0 / 240);
    INFO(solver << ", " << kind_names[std::size_t(kind)] << ", dt = " << dt);
    // R = 4 N, H = 40 N/m, m = 2 kg at 3 m/s: 4 x + 20 x² = 9 J; the back force at rest is 40 x =
    // 23 N, so the bar pushes back and stops where |40 x| = 4
    Shown shown(solver, "rigid row with a back force");
    RigOscillator engine(kind, 2, infinity, Hardening(perfect(4), Prager<double>({.modulus = 40})),
                         solver);
    Oscillator same(2, infinity, Hardening(perfect(4), Prager<double>({.modulus = 40})));
    engine.set_velocity(3);
    same.set_velocity(3);
    double off = 0;
    for (int i = 0; i < 200; ++i) {
        engine.step(dt);
        same.step(dt);
        off = std::max({off, std::abs(engine.position() - same.position()),
                        std::abs(engine.velocity() - same.velocity())});
    }
    shown.small(off, exact);
    shown.small(engine.unexplained() / 9, exact);
    CHECK(engine.state().plastic_travel > 0.8); // there and back
}

TEST_CASE("P03, P04 and P07a converge to their closed forms in the engine", "[contract][axes]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const auto kind = GENERATE(Kind::turning, Kind::sliding);
    INFO(solver << ", " << kind_names[std::size_t(kind)]);
    SECTION("P03") {
        second_order([&](double dt) {
            RigOscillator body(kind, 0.5, 200, perfect(10), solver);
            body.set_velocity(3);
            const std::vector<Peak> turns = peaks(body, dt, 0.4, no_force);
            return std::vector<Quantity>{
                {"peak", "rad", turns.at(0).position, 0.25, Trend::second_order},
                {"set", "rad", body.state().plastic_offset, 0.2, Trend::second_order},
                {"plastic work", "J", body.state().plastic_work, 2, Trend::second_order},
                {"swing back", "rad", turns.at(1).position, 0.15, Trend::second_order}};
        });
    }
    SECTION("P04, F/R = 0.8") {
        second_order([&](double dt) {
            RigOscillator body(kind, 100, 4e4, perfect(2000), solver);
            const std::vector<Peak> turns = peaks(body, dt, 0.6, [](double) { return 1600.0; });
            return std::vector<Quantity>{
                {"peak", "m", turns.at(0).position, 0.125, Trend::second_order},
                {"set", "m", body.state().plastic_offset, 0.075, Trend::second_order},
                {"mean after", "m", (turns.at(0).position + turns.at(1).position) / 2, 0.115,
                 Trend::second_order}};
        });
    }
    SECTION("P07a") {
        second_order([&](double dt) {
            const Bilinear b;
            RigOscillator body(kind, b.mass, b.stiffness, kinematic(), solver);
            body.set_velocity(b.speed);
            const std::vector<Peak> turns = peaks(body, dt, 1.2, no_force);
            return std::vector<Quantity>{
                {"first peak", "m", turns.at(0).position, b.first_peak(), Trend::second_order},
                {"second peak", "m", turns.at(1).position, b.second_peak(), Trend::second_order},
                {"set", "m", body.state().plastic_offset, b.set(), Trend::second_order},
                {"plastic work", "J", body.state().plastic_work, b.strength * b.travel(),
                 Trend::second_order}};
        });
    }
}

TEST_CASE("P03 has the tabulated peak at 1/240 s", "[contract][axes]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const auto kind = GENERATE(Kind::turning, Kind::sliding);
    INFO(solver << ", " << kind_names[std::size_t(kind)]);
    RigOscillator body(kind, 0.5, 200, perfect(10), solver);
    body.set_velocity(3);
    double most = 0;
    for (int i = 0; i < 100; ++i) {
        body.step(1.0 / 240);
        most = std::max(most, body.position());
    }
    CHECK(most == Approx(0.2501364).epsilon(Rig::single ? 1e-5 : 3e-7)); // the table's digits
}

TEST_CASE("a kinematic row that is bent to and fro yields at twice its strength from each turn",
          "[contract][axes]") {
    // a mass that goes on as it is told, to ± a: each half cycle 2 u_y elastic, then flow
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const auto kind = GENERATE(Kind::turning, Kind::sliding);
    INFO(solver << ", " << kind_names[std::size_t(kind)]);
    const Bilinear b;
    const double a = 3 * b.yield(), dt = 1e-3, tangent = b.tangent();
    const int quarter = 50, cycles = 3;
    Shown shown(solver, "Prager reversed");
    RigOscillator body(kind, heavy, b.stiffness, kinematic(), solver);
    const auto move = [&](double distance, int steps) {
        for (int i = 0; i < steps; ++i) {
            body.set_velocity(distance / (steps * dt));
            body.step(dt);
        }
    };
    // its force is that of where it was when the step began: one more, in which it stands
    const auto force = [&] {
        move(0, 1);
        return -body.force();
    };
    const double peak = b.strength + tangent * (a - b.yield());
    double travel = (1 - b.share) * (a - b.yield());
    move(a, quarter);
    shown.close(force(), peak);
    shown.close(body.state().plastic_travel, travel);
    for (int i = 0; i < cycles; ++i) {
        for (const double sign : {-1.0, 1.0}) {
            move(sign * 2 * b.yield(), quarter); // to the yield point on the other side, no flow
            shown.close(force(), -sign * (peak - 2 * b.strength));
            shown.close(body.state().plastic_travel, travel);
            move(sign * 2 * (a - b.yield()), quarter);
            travel += (1 - b.share) * 2 * (a - b.yield());
            shown.close(force(), sign * peak);
            shown.close(body.state().plastic_travel, travel);
            shown.close(body.state().plastic_offset, sign * (1 - b.share) * (a - b.yield()));
        }
    }
    shown.close(body.state().plastic_work, b.strength * travel);
}

TEST_CASE("an elastic hinge off the centre of mass knows the mass it moves", "[contract][axes]") {
    // a bar 2 m from its pin: I = 0.5 + 3·4 = 12.5 kg m², k = 5000: ω = 20 rad/s as in P03. Were
    // the mass that about the centre of mass, k dt²/m would be 0.17 and not 0.007; at 1/60 s 2.8
    // and not 0.11, which is the damped row.
    const auto solver = Rig::solvers().front();
    const double dt = GENERATE(1.0 / 240, 1.0 / 60);
    Rig rig(solver, none);
    rig.set_iterations(sweeps);
    auto bar = rig.body(3, sphere(0.5), {2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1});
    auto& hinge =
        rig.hinge_of(bar, nullptr, none, {0, 0, 1},
                     OneAxisJoint(perfect(1e4), TravelLimit<double>(), {.stiffness = 5000}));
    rig.open_ledger();
    double low = 0, high = 0;
    for (double t = 0; t < 10; t += dt) {
        rig.step(dt);
        low = std::min(low, hinge.rotation());
        high = std::max(high, hinge.rotation());
    }
    // 0.1/20 rad in undamped swings; the symplectic peak is off by (ω dt)²/8 and sampled within
    // that
    const double wide = 0.005, off = wide * std::pow(20 * dt, 2) / 4;
    CHECK(high == Approx(wide).margin(off));
    CHECK(low == Approx(-wide).margin(off));
    CHECK(hinge.absorbed_energy() == 0);
    // a slow bar: positions of metres move by less than a float holds
    CHECK(std::abs(rig.ledger().unexplained()) <
          (Rig::single ? 1e-2 : 1e-9) * 12.5 * 0.1 * 0.1 / 2);
}

TEST_CASE("an elastic hinge that breaks hands back what it took in excess and loses what it stored",
          "[contract][axes]") {
    // I = 2 kg m², k = 2000 N m/rad, M_p = 40 N m, break at 1.6 rad: 64 J of flow, 0.4 J stored and
    // lost
    const double dt = GENERATE(1.0 / 60, 1.0 / 240, 1e-3);
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver << ", dt = " << dt);
    Shown shown(solver, "elastic row breaks");
    Rig rig(solver, none);
    rig.set_iterations(sweeps);
    auto rotor = rig.body(1, sphere(2), none, none, {0, 0, 10});
    auto& hinge = rig.hinge_of(
        rotor, nullptr, none, {0, 0, 1},
        OneAxisJoint(perfect(40), TravelLimit<double>({.limit = 1.6}), {.stiffness = 2000}));
    rig.open_ledger();
    for (int i = 0; i < 2000 && !hinge.broken(); ++i) rig.step(dt);
    REQUIRE(hinge.broken());
    shown.close(hinge.absorbed_energy(), 64);
    shown.close(hinge.stored_energy(), 0);
    shown.small(rig.ledger().unexplained() / 100, exact);
    // 100 - 64 - 0.4 J; the yield point is crossed within a step, which costs up to its share of a
    // step
    const double left = std::pow(Rig::spin(rotor).z(), 2);
    const double lost = hinge.joint().state().lost, other = hinge.joint().state().other_work;
    shown.close(left, 36 - lost - other);
    CHECK(lost == Approx(0.4).epsilon(Rig::single ? 1e-4 : 1e-6));
    const double spin = Rig::spin(rotor).z();
    rig.step(dt);
    CHECK(Rig::spin(rotor).z() == Approx(spin).epsilon(Rig::single ? 1e-6 : 1e-12));
}

TEST_CASE("an elastic bar between two free bodies swings about their centre of mass",
          "[contract][axes]") {
    // 2 and 3 kg: reduced mass 1.2 kg; k = 480 N/m: ω = 20 rad/s; the bar is askew of the line of
    // centres
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    const double dt = 1.0 / 240;
    Rig rig(solver, none);
    const V3 axis = V3(1, 2, 2) / 3;
    auto a = rig.body(2, sphere(0.4), none, 2 * axis, none);
    auto b = rig.body(3, sphere(0.6), {0.5, 0, 0}, none, none);
    auto& bar = rig.slider_of(
        a, b, axis, OneAxisJoint(perfect(1e4), TravelLimit<double>(), {.stiffness = 480}));
    rig.open_ledger();
    const V3 momentum = 2 * Rig::velocity(a) + 3 * Rig::velocity(b);
    const auto spin = [&] {
        return V3(0.4 * Rig::spin(a) + 0.6 * Rig::spin(b) +
                  2 * Rig::position(a).cross(Rig::velocity(a)) +
                  3 * Rig::position(b).cross(Rig::velocity(b)));
    };
    const V3 turning = spin();
    double most = 0;
    for (int i = 0; i < 480; ++i) {
        rig.step(dt);
        most = std::max(most, bar.elongation());
    }
    const bool iterative = !Rig::can(solver, Capability::coupled);
    Shown shown(solver, "elastic bar between free bodies");
    CHECK(most > 0.05);
    CHECK((2 * Rig::velocity(a) + 3 * Rig::velocity(b) - momentum).norm() <
          (Rig::single ? 1e-5 : 1e-11));
    // the engine's own drift of angular momentum is first order in dt; the row adds none of its own
    CHECK((spin() - turning).norm() <
          (iterative ? 0.05 : 0.02) * turning.norm() + (Rig::single ? 1e-5 : 1e-9));
    shown.small(rig.ledger().unexplained() / 4, exact);
}

TEST_CASE("bending and torsion flow together along the ellipse", "[contract][axes][P23]") {
    // bent to yield, then twisted by δ yield strains: t = tanh δ, m = sech δ (Krieg & Krieg 1977);
    // a body so heavy that it goes on as it is told, and rows that the step resolves
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double delta = GENERATE(0.5, 1.0, 2.0);
    INFO(solver << ", delta " << delta);
    using Bend = CoupledJoint<Ellipsoid<double, 2>, Perfect<double>>;
    const Eigen::Vector2d capacity(1000, 800), stiffness(50e3, 32e3);
    const double dt = 1e-3;
    struct End {
        double bending, torsion, utilisation, work;
    };
    const auto run = [&](int steps) {
        Rig rig(solver, none);
        auto body = rig.body(1, sphere(heavy), none, none, none);
        auto& joint = rig.six_axis(
            body, nullptr, Frame{},
            Bend(Ellipsoid<double, 2>({.capacity = capacity}), Perfect<double>({.strength = 1}),
                 TravelLimit<double>(), {.stiffness = stiffness}),
            std::array{JointAxis::bending_x, JointAxis::torsion});
        const double bend = capacity[0] / stiffness[0], twist = delta * capacity[1] / stiffness[1];
        for (int i = 0; i < 2 * steps; ++i) {
            const double rate = (i < steps ? bend : twist) / (steps * dt);
            Rig::set_spin(body, i < steps ? V3(rate, 0, 0) : V3(0, 0, rate));
            rig.step(dt);
        }
        return End{-joint.force(JointAxis::bending_x) / capacity[0],
                   -joint.force(JointAxis::torsion) / capacity[1], joint.utilisation(),
                   joint.absorbed_energy()};
    };
    const double m = 1 / std::cosh(delta), t = std::tanh(delta);
    const auto off = [&](const End& end) { return std::hypot(end.bending - m, end.torsion - t); };
    constexpr int fine = 400;
    const End end = run(fine);
    Shown shown(solver, "P23 bending and torsion");
    shown.close(end.bending, m, 2 * delta / fine); // first order, in yield strains per step
    shown.close(end.torsion, t, 2 * delta / fine);
    CHECK(end.utilisation == Approx(1).epsilon(delta / fine));
    // what the twist supplied, less what the springs hold now and held at yield
    const double work = capacity[1] * capacity[1] / stiffness[1] * std::log(std::cosh(delta));
    CHECK(end.work == Approx(work).epsilon(0.02));
    if (!Rig::single) {
        const double order = std::log2(off(run(fine / 8)) / off(end)) / 3;
        INFO("order " << order);
        CHECK(order >= 0.9);
    }
}

TEST_CASE("a joint that turns further in a step than can be followed says so", "[contract]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double speed = GENERATE(40.0, 90.0, 400.0), dt = 1.0 / 60;
    INFO(solver << ", " << speed * dt << " rad a step");
    Rig rig(solver, none);
    const auto rotor = [&](const V3& at) {
        return rig.body(1, sphere(2), at, none, {0, 0, speed});
    };
    auto& six_axes = rig.six_axis(rotor({0, 0, 0}), nullptr, Frame{}, six(V6::Constant(0.1)));
    auto& hinge = rig.hinge_of(rotor({9, 0, 0}), nullptr, {9, 0, 0}, {0, 0, 1}, one(0.1));
    double before = 0, hinge_before = 0;
    const auto says = [&](const auto& joint, double turned) {
        const bool right = std::abs(turned - speed * dt) < 0.05 * speed * dt;
        const bool unreliable = joint.outcome() == Outcome::unreliable;
        CHECK(unreliable == !right);
        CHECK(joint.report().unseen_turn == Approx(right ? 0 : speed * dt).epsilon(1e-3));
    };
    for (int i = 0; i < 5; ++i) {
        rig.step(dt);
        const double now = six_axes.position(JointAxis::torsion), hinge_now = hinge.rotation();
        says(six_axes, now - before);
        says(hinge, hinge_now - hinge_before);
        before = now;
        hinge_before = hinge_now;
    }
    if (speed < 50) CHECK(six_axes.outcome() == Outcome::yielding);
    if (speed > 300) CHECK(six_axes.outcome() == Outcome::unreliable);
}

TEST_CASE("rods that stop in one long step absorb together no more than they had", "[contract]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const bool elastic = GENERATE(false, true), six_axes = GENERATE(false, true);
    if (Rig::single && elastic) return; // they yield at 4e-6 rad, which float cannot tell
    INFO(solver << (elastic ? ", elastic" : "") << (six_axes ? ", six axes" : ""));
    Rig rig(solver, none);
    rig.set_iterations(200);
    constexpr int rods = 10;
    const double stiffness = elastic ? 1e8 : infinity;
    V6 all = V6::Constant(infinity);
    if (elastic) all << 1e10, 1e10, 1e10, 1e8, 1e8, 1e8;
    std::vector<Rig::Body> bodies;
    std::vector<std::function<double()>> absorbed;
    std::vector<std::function<bool()>> unreliable;
    V3 joint_velocity = none;
    for (int i = 0; i < rods; ++i) {
        const double spin = (i % 2 == 0 ? 1 : -1) * (1 + 0.3 * i);
        const V3 at(0.2 * i, 0, 0), centre = at + V3(0.1, 0, 0);
        const Rig::Body before = i == 0 ? Rig::Body(nullptr) : bodies.back();
        const Rig::Body rod = rig.body(2, sphere(2 * 0.04 / 12), centre,
                                       joint_velocity + V3(0, 0.1 * spin, 0), {0, 0, spin});
        bodies.push_back(rod);
        joint_velocity += V3(0, 0.2 * spin, 0);
        const auto ask = [&](auto& joint) {
            absorbed.emplace_back([&joint] { return joint.absorbed_energy(); });
            unreliable.emplace_back([&joint] { return joint.outcome() == Outcome::unreliable; });
        };
        if (six_axes) {
            V6 capacity;
            capacity << 1e6, 1e6, 1e6, 400, 400, 400;
            ask(rig.six_axis(rod, before, Frame{at, M3::Identity()}, six(capacity, infinity, all)));
        } else {
            ask(rig.hinge_of(rod, before, at, {0, 0, 1}, one(400, infinity, stiffness)));
        }
    }
    const auto kinetic = [&] {
        double sum = 0;
        for (const Rig::Body body : bodies) {
            sum += Rig::velocity(body).squaredNorm() + Rig::spin(body).squaredNorm() * 0.04 / 12;
        }
        return sum;
    };
    const double had = kinetic();
    rig.step(1.0 / 30);
    double sum = 0;
    bool reliable = true;
    for (std::size_t i = 0; i < rods; ++i) {
        sum += absorbed[i]();
        reliable = reliable && !unreliable[i]();
        CHECK(absorbed[i]() >= 0);
    }
    if (!reliable) return;
    const double lost = had - kinetic();
    CHECK(lost > 0.5 * had);
    CHECK(sum <= lost * (1 + (Rig::single ? 1e-3 : 1e-6)));
    // a coupled spring that stops within its strength loses its energy as damping
    if (!(elastic && six_axes)) CHECK(sum > 0.9 * lost);
}
