// SPDX-License-Identifier: MIT
//
// Problems of one or two rotors and masses on rigid-plastic rows, from an initial speed to rest or
// to the break: P01, P02, P22, P25, P27. Formulas stand by each function.
//
// A row that stops from speed u inside an engine that moves with the new velocity ends u dt/2
// short: that is the geometric rest position. The work-conjugate travel and the energy are exact.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "reference/order.hpp"
#include "reference/world.hpp"

namespace ductile::reference {

template <std::floating_point S>
using PerfectJoint = OneAxisJoint<Perfect<S>>;

template <std::floating_point S = double>
[[nodiscard]] PerfectJoint<S> perfect_joint(S strength,
                                            S limit = std::numeric_limits<S>::infinity()) {
    return OneAxisJoint(Perfect<S>({.strength = strength}), TravelLimit<S>({.limit = limit}));
}

/// Below this a body that was moving is at rest [m/s | rad/s].
inline constexpr double at_rest = 1e-9;

// ---- P01 and P02: one rotor against the ground --------------------------------------------------

struct Rotor {
    double inertia = 2, moment = 40, speed = 10;
    double limit = std::numeric_limits<double>::infinity();

    [[nodiscard]] double deceleration() const { return moment / inertia; }
};

struct RotorEnd {
    PerfectJoint<double>::State joint;
    double time = 0, speed = 0, angle = 0;
    double unexplained = 0; ///< loss of kinetic energy less what the joint took [J]
};

/// Until it stops or breaks.
[[nodiscard]] inline RotorEnd spin_down(const Rotor& rotor, double dt) {
    World<double> world;
    PerfectJoint<double> joint = perfect_joint(rotor.moment, rotor.limit);
    const int wheel = world.add_degree(rotor.inertia);
    world.add_row({{wheel}}, joint);
    world.velocity()[wheel] = rotor.speed;
    int steps = 0;
    while (std::abs(world.velocity()[wheel]) > at_rest && !joint.state().broken) {
        world.step(dt);
        ++steps;
    }
    const double speed = world.velocity()[wheel];
    const double lost = rotor.inertia * (rotor.speed * rotor.speed - speed * speed) / 2;
    const double taken = joint.state().plastic_work + joint.state().other_work;
    return {joint.state(), steps * dt, speed, world.displacement()[wheel], lost - taken};
}

/// P01: t = ω0/α, θ = ω0²/(2α), E = I ω0²/2 with α = M_p/I.
[[nodiscard]] inline std::vector<Quantity> p01_rotor(const Rotor& rotor, double dt) {
    const RotorEnd end = spin_down(rotor, dt);
    const double theta = rotor.speed * rotor.speed / (2 * rotor.deceleration());
    return {{"angle", "rad", end.joint.plastic_offset, theta, Trend::first_order},
            {"plastic rotation", "rad", end.joint.plastic_travel, theta, Trend::exact},
            {"plastic work", "J", end.joint.plastic_work, rotor.moment * theta, Trend::exact},
            {"unexplained energy", "J", end.unexplained, 0, Trend::exact},
            {"stop", "s", end.time, rotor.speed / rotor.deceleration(), Trend::within_step}};
}

/// P02: ω_res = √(ω0² - 2 α θ_max), E = M_p θ_max.
[[nodiscard]] inline std::vector<Quantity> p02_rotor_break(const Rotor& rotor, double dt) {
    const RotorEnd end = spin_down(rotor, dt);
    const double residual =
        std::sqrt(rotor.speed * rotor.speed - 2 * rotor.deceleration() * rotor.limit);
    return {{"residual speed", "rad/s", end.speed, residual, Trend::exact},
            {"plastic work", "J", end.joint.plastic_work, rotor.moment * rotor.limit, Trend::exact},
            {"unexplained energy", "J", end.unexplained, 0, Trend::exact},
            {"break", "s", end.time, (rotor.speed - residual) / rotor.deceleration(),
             Trend::within_step}};
}

// ---- P01c and P02c: two free coaxial bodies -----------------------------------------------------

struct Pair {
    double inertia1 = 2, inertia2 = 3, moment = 12, speed1 = 10;
    double limit = std::numeric_limits<double>::infinity();
};

struct PairEnd {
    PerfectJoint<double>::State joint;
    double time = 0, speed1 = 0, speed2 = 0, angle1 = 0, angle2 = 0;
};

/// Until they turn together or the joint breaks. The bodies are spheres free to turn about any
/// axis; two rigid rows keep them coaxial on `axis`.
[[nodiscard]] inline PairEnd couple(const Pair& pair, const Eigen::Vector3d& axis, double dt) {
    World<double> world;
    PerfectJoint<double> joint = perfect_joint(pair.moment, pair.limit);
    std::array<int, 2> first{};
    for (int body : {0, 1}) {
        for (int i = 0; i < 3; ++i) {
            const int degree = world.add_degree(body == 0 ? pair.inertia1 : pair.inertia2);
            if (i == 0) first[std::size_t(body)] = degree;
        }
    }
    const auto along = [&](const Eigen::Vector3d& direction) {
        std::vector<Term<double>> terms;
        for (int i = 0; i < 3; ++i) terms.push_back({first[0] + i, direction[i]});
        for (int i = 0; i < 3; ++i) terms.push_back({first[1] + i, -direction[i]});
        return terms;
    };
    const Eigen::Vector3d across = axis.unitOrthogonal();
    world.add_rigid_row(along(across));
    world.add_rigid_row(along(axis.cross(across)));
    world.add_row(along(axis), joint);

    world.velocity().segment<3>(first[0]) = pair.speed1 * axis;
    const auto speed = [&](int body) {
        return axis.dot(world.velocity().segment<3>(first[std::size_t(body)]));
    };
    const auto angle = [&](int body) {
        return axis.dot(world.displacement().segment<3>(first[std::size_t(body)]));
    };
    int steps = 0;
    while (std::abs(speed(0) - speed(1)) > at_rest && !joint.state().broken) {
        world.step(dt);
        ++steps;
    }
    return {joint.state(), steps * dt, speed(0), speed(1), angle(0), angle(1)};
}

/// As P01 with I -> I1 I2/(I1 + I2); momentum gives the common speed.
[[nodiscard]] inline std::vector<Quantity> p01_pair(double dt) {
    const PairEnd end = couple({}, Eigen::Vector3d(1, 2, 2) / 3, dt);
    return {{"relative angle", "rad", end.joint.plastic_offset, 5, Trend::first_order},
            {"plastic work", "J", end.joint.plastic_work, 60, Trend::exact},
            {"common speed", "rad/s", end.speed1, 4, Trend::exact},
            {"stop", "s", end.time, 1, Trend::within_step}};
}

[[nodiscard]] inline std::vector<Quantity> p02_pair_break(double dt) {
    const PairEnd end = couple({.limit = 3.2}, Eigen::Vector3d(1, 2, 2) / 3, dt);
    return {{"speed 1", "rad/s", end.speed1, 7.6, Trend::exact},
            {"speed 2", "rad/s", end.speed2, 1.6, Trend::exact},
            {"plastic work", "J", end.joint.plastic_work, 38.4, Trend::exact},
            {"break", "s", end.time, 0.4, Trend::within_step}};
}

// ---- P22 and P25: a weight on a yielding bar ----------------------------------------------------

struct Weight {
    double mass = 0, strength = 0, gravity = 0;
    double speed = 0; ///< downwards
    double limit = std::numeric_limits<double>::infinity();

    [[nodiscard]] double deceleration() const { return strength / mass - gravity; }
};

struct WeightEnd {
    PerfectJoint<double>::State joint;
    double time = 0, speed = 0, fall = 0, supplied = 0;
    int steps = 0;
};

/// Until it stops or the bar breaks; everything downwards.
[[nodiscard]] inline WeightEnd crush(const Weight& weight, double dt) {
    World<double> world;
    PerfectJoint<double> joint = perfect_joint(weight.strength, weight.limit);
    const int block = world.add_degree(weight.mass);
    world.add_row({{block}}, joint);
    world.velocity()[block] = weight.speed;
    Vector<double> load = world.no_load();
    load[block] = weight.mass * weight.gravity;
    int steps = 0;
    while (std::abs(world.velocity()[block]) > at_rest && !joint.state().broken) {
        world.step(dt, load);
        ++steps;
    }
    return {joint.state(),    steps * dt, world.velocity()[block], world.displacement()[block],
            world.supplied(), steps};
}

/// P25: 500 kg fall 2 m onto a head of 50 kg on a column of 30 kN and go on with it.
[[nodiscard]] inline Weight dropped(double limit = std::numeric_limits<double>::infinity()) {
    constexpr double gravity = 9.81, height = 2;
    const double common = 500.0 / 550.0 * std::sqrt(2 * gravity * height);
    return {.mass = 550, .strength = 30e3, .gravity = gravity, .speed = common, .limit = limit};
}

/// s = V1²/(2a), t = V1/a, E = R s with a = R/m - g.
[[nodiscard]] inline std::vector<Quantity> p25_crush(double dt) {
    const Weight weight = dropped();
    const WeightEnd end = crush(weight, dt);
    const double s = weight.speed * weight.speed / (2 * weight.deceleration());
    return {{"crush", "m", end.joint.plastic_offset, s, Trend::first_order},
            {"plastic travel", "m", end.joint.plastic_travel, s, Trend::second_order},
            {"plastic work", "J", end.joint.plastic_work, weight.strength * s, Trend::second_order},
            {"stop", "s", end.time, weight.speed / weight.deceleration(), Trend::within_step}};
}

/// v = √(V1² - 2 a s_max) at the break; what it fell freely in the rest of that step is taken off.
[[nodiscard]] inline std::vector<Quantity> p25_break(double dt) {
    const Weight weight = dropped(0.3);
    const WeightEnd end = crush(weight, dt);
    const double residual =
        std::sqrt(weight.speed * weight.speed - 2 * weight.deceleration() * weight.limit);
    const double time = (weight.speed - residual) / weight.deceleration();
    return {
        {"residual speed", "m/s", end.speed - weight.gravity * (end.time - time), residual,
         Trend::second_order},
        {"plastic work", "J", end.joint.plastic_work, weight.strength * weight.limit, Trend::exact},
        {"break", "s", end.time, time, Trend::within_step}};
}

// ---- P27: two rotors in series ------------------------------------------------------------------

struct SeriesEnd {
    PerfectJoint<double>::State inner, outer;
    double lock_time = 0, lock_speed = 0, locked_moment = 0, time = 0;
};

/// Ground -[20 N m]- I1 = 1 -[50 N m]- I2 = 2, only the second spins, 12 rad/s.
[[nodiscard]] inline SeriesEnd series(double dt) {
    World<double> world;
    PerfectJoint<double> inner = perfect_joint(20.0), outer = perfect_joint(50.0);
    const int one = world.add_degree(1), two = world.add_degree(2);
    world.add_row({{one}}, inner);
    const std::size_t link = world.add_row({{one, -1}, {two, 1}}, outer);
    world.velocity()[two] = 12;
    SeriesEnd end;
    bool locked = false;
    int steps = 0;
    while (std::abs(world.velocity()[two]) > at_rest || !locked) {
        world.step(dt);
        ++steps;
        const double relative = world.velocity()[two] - world.velocity()[one];
        if (!locked && std::abs(relative) < at_rest) {
            locked = true;
            end.lock_time = steps * dt;
            end.lock_speed = world.velocity()[two];
            world.step(dt);
            ++steps;
            end.locked_moment = -world.reaction(link).force;
        }
    }
    end.inner = inner.state();
    end.outer = outer.state();
    end.time = steps * dt;
    return end;
}

/// Lock at 12/55 s with 72/11 rad/s, stop at 1.2 s; momentum of the whole gives the rest.
[[nodiscard]] inline std::vector<Quantity> p27_series(double dt) {
    const SeriesEnd end = series(dt);
    return {{"hinge 2", "rad", end.outer.plastic_offset, 72.0 / 55, Trend::first_order},
            {"hinge 1", "rad", end.inner.plastic_offset, 43.2 / 11, Trend::second_order},
            {"ledger", "J", end.inner.plastic_work + end.outer.plastic_work, 144, Trend::exact},
            {"moment while locked", "N m", end.locked_moment, 40.0 / 3, Trend::exact},
            {"lock", "s", end.lock_time, 12.0 / 55, Trend::within_step},
            {"stop", "s", end.time, 1.2, Trend::within_step}};
}

} // namespace ductile::reference
