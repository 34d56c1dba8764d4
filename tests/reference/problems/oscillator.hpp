// SPDX-License-Identifier: MIT
//
// A mass on an elastic-plastic row: P03 (free), P04 (load held), P05 (pulses), P06 (imposed
// motion), P07 (kinematic and isotropic hardening). Where the step resolves the spring the row is
// the symplectic one, second order in every peak.
//
// Source of the chart: Biggs (1964), Introduction to Structural Dynamics, figures 2.23-2.26; the
// numbers here are exact piecewise integrations.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/hardening.hpp"
#include "ductile/law/linear.hpp"
#include "reference/order.hpp"
#include "reference/world.hpp"

namespace ductile::reference {

/// Joint and mass; the load is given per step, sampled at mid-step.
template <class Law>
class Oscillator {
  public:
    Oscillator(double mass, double stiffness, Law law, bool mass_known = true)
        : joint_(std::move(law), TravelLimit<double>(), {.stiffness = stiffness}) {
        if (!mass_known) world_.withhold_mass();
        degree_ = world_.add_degree(mass);
        world_.add_row({{degree_}}, joint_);
    }
    Oscillator(const Oscillator&) = delete;
    Oscillator& operator=(const Oscillator&) = delete;

    void step(double dt, double load = 0) {
        Vector<double> forces = world_.no_load();
        forces[degree_] = load;
        world_.step(dt, forces);
        time_ += dt;
    }
    void set_velocity(double velocity) { world_.velocity()[degree_] = velocity; }

    [[nodiscard]] double time() const { return time_; }
    [[nodiscard]] double position() { return world_.displacement()[degree_]; }
    [[nodiscard]] double velocity() { return world_.velocity()[degree_]; }
    [[nodiscard]] const auto& state() const { return joint_.state(); }
    /// `start` [J] and what was supplied, less what moves, is stored or was taken; as a share of it
    /// all.
    [[nodiscard]] double unexplained(double start) {
        const double given = start + world_.supplied();
        const double found =
            world_.kinetic_energy() + state().stored + state().plastic_work + state().other_work;
        return (given - found) / (std::abs(given) + found);
    }

  private:
    World<double> world_;
    OneAxisJoint<Law> joint_;
    int degree_ = 0;
    double time_ = 0;
};

/// A turning point of the motion, from the parabola through the three positions around it.
struct Peak {
    double position = 0, time = 0;
};

/// Every turning point within `duration` of anything that steps, and has a position and a velocity.
template <class Body, class LoadAt>
[[nodiscard]] std::vector<Peak> peaks(Body& body, double dt, double duration, LoadAt&& load_at) {
    std::vector<Peak> found;
    double before = body.position(), now = before;
    double last_velocity = body.velocity();
    const auto steps = int(std::ceil(duration / dt - 1e-9));
    for (int i = 0; i < steps; ++i) {
        body.step(dt, load_at((i + 0.5) * dt));
        const double next = body.position(), velocity = body.velocity();
        if (i > 0 && last_velocity * velocity < 0) {
            const double bend = before - 2 * now + next;
            const double shift = bend != 0 ? (before - next) / (2 * bend) : 0;
            found.push_back({now + (next - before) / 4 * shift, (i + shift) * dt});
        }
        before = now;
        now = next;
        last_velocity = velocity;
    }
    return found;
}

inline constexpr auto no_force = [](double) { return 0.0; };

[[nodiscard]] inline Perfect<double> perfect(double strength) {
    return Perfect<double>({.strength = strength});
}

// ---- P03 ----------------------------------------------------------------------------------------

/// I = 0.5 kg m², k = 200 N m/rad, M_y = 10 N m, ω0 = 3 rad/s:
/// θ_max = θ_y + (E0 - k θ_y²/2)/M_y = 0.25, of which 0.2 stay; then elastic between 0.15 and 0.25.
[[nodiscard]] inline std::vector<Quantity> p03_free(double dt) {
    Oscillator body(0.5, 200, perfect(10));
    body.set_velocity(3);
    const std::vector<Peak> turns = peaks(body, dt, 0.7, no_force);
    const double period = 2 * std::numbers::pi / 20;
    return {{"peak", "rad", turns.at(0).position, 0.25, Trend::second_order},
            {"set", "rad", body.state().plastic_offset, 0.2, Trend::second_order},
            {"plastic work", "J", body.state().plastic_work, 2, Trend::second_order},
            {"swing back", "rad", turns.at(1).position, 0.15, Trend::second_order},
            {"period after", "s", turns.at(2).time - turns.at(0).time, period, Trend::second_order},
            {"unexplained energy", "-", body.unexplained(2.25), 0, Trend::exact}};
}

// ---- P04 ----------------------------------------------------------------------------------------

/// m = 100 kg, k = 4e4 N/m, R = 2 kN, F held: μ = 1/(2 (1 - F/R)) by energy, then a swing about
/// u_p + F/k.
[[nodiscard]] inline std::vector<Quantity> p04_step_load(double ratio, double dt) {
    constexpr double m = 100, k = 4e4, R = 2000, yield = R / k;
    const double load = ratio * R;
    Oscillator body(m, k, perfect(R));
    const std::vector<Peak> turns = peaks(body, dt, 1.2, [&](double) { return load; });
    const double peak = yield / (2 * (1 - ratio)), set = peak - yield;
    return {{"peak", "m", turns.at(0).position, peak, Trend::second_order},
            {"set", "m", body.state().plastic_offset, set, Trend::second_order},
            {"mean after", "m", (turns.at(0).position + turns.at(1).position) / 2, set + load / k,
             Trend::second_order},
            {"unexplained energy", "-", body.unexplained(0), 0, Trend::exact}};
}

// ---- P05 ----------------------------------------------------------------------------------------

struct Pulse {
    bool triangular = false;
    double duration_per_period = 0; ///< t_d/T
    double strength_per_force = 0;  ///< R/F
    double mu = 0;                  ///< u_max/u_y
    double time_per_period = 0;     ///< t_max/T
};

/// m = 50 kg, T = 0.2 s, F = 4 kN; any other instance of the chart is the same in other units. The
/// step is fitted into the pulse, whose impulse would else be wrong by up to F dt/2. From rest the
/// motion leads by half a step, so the time of the peak is first order.
[[nodiscard]] inline std::vector<Quantity> p05_pulse(const Pulse& pulse, double dt) {
    constexpr double m = 50, T = 0.2, F = 4000;
    const double k = m * std::pow(2 * std::numbers::pi / T, 2);
    const double R = pulse.strength_per_force * F, td = pulse.duration_per_period * T;
    dt = td / std::ceil(td / dt - 1e-9);
    Oscillator body(m, k, perfect(R));
    const auto load = [&](double t) {
        if (t >= td) return 0.0;
        return pulse.triangular ? F * (1 - t / td) : F;
    };
    const double duration = (pulse.time_per_period + 1) * T;
    const std::vector<Peak> turns = peaks(body, dt, duration, load);
    return {{"peak", "m", turns.at(0).position, pulse.mu * R / k, Trend::second_order},
            {"time of peak", "s", turns.at(0).time, pulse.time_per_period * T, Trend::first_order},
            {"set", "m", body.state().plastic_offset, std::max(pulse.mu - 1, 0.0) * R / k,
             Trend::second_order},
            {"unexplained energy", "-", body.unexplained(0), 0, Trend::exact}};
}

// ---- P07 ----------------------------------------------------------------------------------------

/// Tangent α k after yield, so H = α k/(1 - α); from energy and the two frequencies √(k/m), √(α
/// k/m):
///   first peak    m v0²/2 = k u_y²/2 + R x + α k x²/2, u1 = u_y + x, F1 = R + α k x
///   second peak   2 F1 u_y - 2 k u_y² + (F1 - 2R) y - α k y²/2 = 0, u2 = u1 - 2 u_y - y
/// of which (1 - α) x and (1 - α) y are plastic. After it |F| < R: elastic for ever.
struct Bilinear {
    double mass = 2, stiffness = 200, strength = 4, share = 0.1, speed = 1;

    [[nodiscard]] double hardening() const { return share * stiffness / (1 - share); }
    [[nodiscard]] double yield() const { return strength / stiffness; }
    [[nodiscard]] double tangent() const { return share * stiffness; }
    [[nodiscard]] double energy() const { return mass * speed * speed / 2; }
    [[nodiscard]] double frequency() const { return std::sqrt(stiffness / mass); }
    [[nodiscard]] double slow_frequency() const { return std::sqrt(tangent() / mass); }

    /// x
    [[nodiscard]] double first() const {
        const double left = energy() - stiffness * yield() * yield() / 2;
        return (std::sqrt(strength * strength + 2 * tangent() * left) - strength) / tangent();
    }
    [[nodiscard]] double first_force() const { return strength + tangent() * first(); }
    [[nodiscard]] double first_peak() const { return yield() + first(); }
    [[nodiscard]] double first_time() const {
        const double to_yield = std::asin(yield() * frequency() / speed) / frequency();
        const double left = std::sqrt(speed * speed - std::pow(frequency() * yield(), 2));
        return to_yield + std::atan(left * slow_frequency() * mass / strength) / slow_frequency();
    }
    /// y
    [[nodiscard]] double second() const {
        const double pull = 2 * strength - first_force();
        const double left = 2 * first_force() * yield() - 2 * stiffness * yield() * yield();
        return (std::sqrt(pull * pull + 2 * tangent() * left) - pull) / tangent();
    }
    [[nodiscard]] double second_peak() const { return first_peak() - 2 * yield() - second(); }
    [[nodiscard]] double second_time() const {
        const double reach = first_force() / stiffness;
        const double swing = std::acos(1 - 2 * yield() / reach);
        const double left = reach * frequency() * std::sin(swing);
        const double pull = 2 * strength - first_force();
        return first_time() + swing / frequency() +
               std::atan(left * slow_frequency() * mass / pull) / slow_frequency();
    }
    [[nodiscard]] double set() const { return (1 - share) * (first() - second()); }
    [[nodiscard]] double travel() const { return (1 - share) * (first() + second()); }
};

[[nodiscard]] inline std::vector<Quantity> p07_kinematic(double dt) {
    const Bilinear b;
    Oscillator body(b.mass, b.stiffness,
                    Hardening(perfect(b.strength), Prager<double>({.modulus = b.hardening()})));
    body.set_velocity(b.speed);
    const std::vector<Peak> turns = peaks(body, dt, 2.5, no_force);
    const auto& state = body.state();
    return {{"first peak", "m", turns.at(0).position, b.first_peak(), Trend::second_order},
            {"time of first", "s", turns.at(0).time, b.first_time(), Trend::second_order},
            {"second peak", "m", turns.at(1).position, b.second_peak(), Trend::second_order},
            {"time of second", "s", turns.at(1).time, b.second_time(), Trend::second_order},
            {"set", "m", state.plastic_offset, b.set(), Trend::second_order},
            {"plastic travel", "m", state.plastic_travel, b.travel(), Trend::second_order},
            {"plastic work", "J", state.plastic_work, b.strength * b.travel(), Trend::second_order},
            {"unexplained energy", "-", body.unexplained(b.energy()), 0, Trend::exact}};
}

/// One excursion, then elastic with the amplitude F1/k.
[[nodiscard]] inline std::vector<Quantity> p07_isotropic(double dt) {
    const Bilinear b;
    Oscillator body(b.mass, b.stiffness,
                    Linear<double>({.strength = b.strength, .hardening = b.hardening()}));
    body.set_velocity(b.speed);
    const std::vector<Peak> turns = peaks(body, dt, 2.5, no_force);
    const double amplitude = b.first_force() / b.stiffness;
    return {
        {"first peak", "m", turns.at(0).position, b.first_peak(), Trend::second_order},
        {"set", "m", body.state().plastic_offset, (1 - b.share) * b.first(), Trend::second_order},
        {"amplitude after", "m", (turns.at(2).position - turns.at(1).position) / 2, amplitude,
         Trend::second_order},
        {"unexplained energy", "-", body.unexplained(b.energy()), 0, Trend::exact}};
}

} // namespace ductile::reference
