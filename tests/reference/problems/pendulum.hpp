// SPDX-License-Identifier: MIT
//
// P24. A mass on a column with a plastic hinge at its base: below a critical initial speed it stops
// and leans, above it falls.
//
//   rigid-plastic   I ω0²/2 = M_p θ - m g L (1 - cos θ) where it stops;  sin θ_c = M_p/(m g L)
//
// Symbols
//   θ    from the vertical         [rad]
//   I    m L²                      [kg m²]
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "reference/order.hpp"
#include "reference/world.hpp"

namespace ductile::reference {

/// 1000 kg on a massless column of 3 m, M_p = 6 kN m.
struct Column {
    double mass = 1000, length = 3, gravity = 9.81, plastic_moment = 6000;
    double stiffness = std::numeric_limits<double>::infinity(); ///< [N m/rad]

    [[nodiscard]] double inertia() const { return mass * length * length; }
    [[nodiscard]] double weight_moment(double theta) const {
        return mass * gravity * length * std::sin(theta);
    }
    [[nodiscard]] OneAxisJoint<Perfect<double>> hinge() const {
        return OneAxisJoint(Perfect<double>({.strength = plastic_moment}), TravelLimit<double>(),
                            {.stiffness = stiffness});
    }
};

struct ColumnEnd {
    double angle = 0;   ///< largest, or π/2 where it fell [rad]
    double plastic = 0; ///< rest position of the hinge [rad]
    double time = 0;    ///< of that angle [s]
    double speed = 0;   ///< there [rad/s]
};

/// From the vertical at `speed` until it turns back or lies flat; weight taken at the start of each
/// step.
[[nodiscard]] inline ColumnEnd swing(const Column& column, double speed, double dt) {
    World<double> world;
    auto joint = column.hinge();
    const int base = world.add_degree(column.inertia());
    world.add_row({{base}}, joint);
    world.velocity()[base] = speed;
    constexpr double flat = std::numbers::pi / 2;
    double now = 0, rate_before = speed;
    for (int steps = 1;; ++steps) {
        world.step(dt, Vector<double>::Constant(1, column.weight_moment(now)));
        const double next = world.displacement()[base], rate = world.velocity()[base];
        if (next > flat) {
            const double share = (flat - now) / (next - now);
            return {flat, joint.state().plastic_offset, (steps - 1 + share) * dt,
                    rate_before + share * (rate - rate_before)};
        }
        if (rate < 1e-9 || steps * dt > 60) {
            return {std::max(now, next), joint.state().plastic_offset, steps * dt, rate};
        }
        now = next;
        rate_before = rate;
    }
}

inline constexpr double critical_speed = 0.369313533;

/// Below the critical speed, at `share` of it.
[[nodiscard]] inline std::vector<Quantity> p24_stops(double share, double angle, double time,
                                                     double dt) {
    const ColumnEnd end = swing({}, share * critical_speed, dt);
    return {{"angle", "rad", end.angle, angle, Trend::first_order},
            {"stop", "s", end.time, time, Trend::first_order}};
}

/// Above it: time and speed at 90°.
[[nodiscard]] inline std::vector<Quantity> p24_falls(double share, double speed, double time,
                                                     double dt) {
    const ColumnEnd end = swing({}, share * critical_speed, dt);
    return {{"speed at 90 deg", "rad/s", end.speed, speed, Trend::first_order},
            {"time at 90 deg", "s", end.time, time, Trend::first_order}};
}

/// With k = 150 kN m/rad, at 0.9 of its critical speed 0.331248878 rad/s.
[[nodiscard]] inline std::vector<Quantity> p24_elastic(double dt) {
    const ColumnEnd end = swing({.stiffness = 150e3}, 0.9 * 0.331248878, dt);
    return {{"angle", "rad", end.angle, 0.12481713, Trend::second_order},
            {"plastic", "rad", end.plastic, 0.084817126, Trend::second_order}};
}

} // namespace ductile::reference
