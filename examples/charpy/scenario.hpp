// SPDX-License-Identifier: MIT
//
// The Charpy impact test of Nikula (2017), section 2.2, as numbers: every dimension is a parameter.
//
// Axes: x horizontal, positive where the hammer comes from; y up; z along the specimen, z = 0 the plane
// of symmetry. The specimen's bottom is at y = 0.2 m and its back at x = 0, against two anvils; the
// hammer is a pendulum about z that swings down and strikes the specimen's middle towards -x when its
// centre of mass is at its lowest point.
#pragma once

#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "ductile/ductile.hpp"

namespace charpy {

enum class Method { rigid, zero_limits, spring, spring2, hinge_motor, plastic_hinge };

inline constexpr std::array<std::pair<Method, std::string_view>, 6> method_names{{
    {Method::rigid, "rigid"},
    {Method::zero_limits, "zero-limits"},
    {Method::spring, "spring"},
    {Method::spring2, "spring2"},
    {Method::hinge_motor, "hinge-motor"},
    {Method::plastic_hinge, "plastic-hinge"},
}};

[[nodiscard]] constexpr std::string_view to_string(Method method) {
    for (const auto& [value, name] : method_names) {
        if (value == method) return name;
    }
    return "unknown";
}

/// ODE's own joints neither break nor have a second kind of spring.
[[nodiscard]] constexpr bool ode_has(Method method) {
    return method != Method::zero_limits && method != Method::spring2;
}
/// @throws std::invalid_argument where ODE has no such method.
inline void require_in_ode(Method method) {
    if (ode_has(method)) return;
    throw std::invalid_argument(
        "--method = " + std::string(to_string(method)) +
        ": must be rigid, spring, hinge-motor or plastic-hinge with --engine ode, whose own joints "
        "neither break nor have a second kind of spring");
}

/// All lengths [m], masses [kg], angles [rad], stresses [Pa].
struct Scenario {
    // specimen
    double length = 0.055;
    double width = 0.010;  ///< b, along y
    double height = 0.010; ///< h, along x, the direction of the blow
    double notch = 0.002;
    double density = 7800; ///< [kg/m³]
    double youngs_modulus = 200e9;
    double poisson_ratio = 0.3;
    double yield_stress = 400e6;
    double max_plastic_rotation = std::numeric_limits<double>::infinity();
    int parts = 2; ///< equal bodies in a row; even, so that a hinge is under the hammer
    // anvils
    double anvil_gap = 0.040;
    double anvil_width = 0.040;
    // hammer: a box whose centre is 1 m below the pivot, a thin nose in front, an arm
    double hammer_mass = 19.5;
    double hammer_width = 0.5;      ///< along x
    double hammer_height = 0.25;    ///< along y
    double hammer_thickness = 0.02; ///< along z
    double nose_length = 0.04;      ///< the draft in front of the box, along x
    double nose_width = 0.002;      ///< flat of the nose, along z
    double arm_mass = 12.48;
    double arm_length = 1.0; ///< ends half a hammer height above the box's centre
    double arm_width = 0.04;
    double start_angle = 1.8;
    // world
    double gravity = 9.81;  ///< [m/s²]
    double friction = 0;    ///< Coulomb coefficient of every contact
    double restitution = 0;
    int iterations = 10;    ///< of iterative solvers
    // time
    bool adaptive = true;
    double dt = 1e-3; ///< fixed step, or the longest one where adaptive [s]

    /// Distance of the struck point from the pivot [m].
    static constexpr double swing_radius = 1.0;
    static constexpr double specimen_bottom = 0.2;

    [[nodiscard]] double specimen_mass() const { return density * length * width * height; }
    [[nodiscard]] double total_hammer_mass() const { return hammer_mass + arm_mass; }
    /// Distance of the arm's centre below the pivot [m].
    [[nodiscard]] double arm_centre() const {
        return swing_radius - hammer_height / 2 - arm_length / 2;
    }
    /// Distance of the pendulum's centre of mass below the pivot [m].
    [[nodiscard]] double hammer_centre() const {
        return (hammer_mass * swing_radius + arm_mass * arm_centre()) / total_hammer_mass();
    }
    /// Moment of inertia of hammer and arm about the pivot [kg m²]; the nose weighs nothing.
    [[nodiscard]] double hammer_inertia() const {
        const double box = hammer_mass * ((hammer_width * hammer_width +
                                           hammer_height * hammer_height) / 12 +
                                          swing_radius * swing_radius);
        const double arm = arm_mass * ((arm_length * arm_length + arm_width * arm_width) / 12 +
                                       arm_centre() * arm_centre());
        return box + arm;
    }
    /// x of the pivot [m]: the nose touches the specimen's front when the box hangs straight down.
    [[nodiscard]] double pivot_x() const { return height + nose_length + hammer_width / 2; }
    /// y of the pivot [m].
    [[nodiscard]] double pivot_y() const { return specimen_bottom + width / 2 + swing_radius; }

    [[nodiscard]] ductile::Material<double> steel() const {
        return ductile::Material<double>({.density = density,
                                          .youngs_modulus = youngs_modulus,
                                          .poisson_ratio = poisson_ratio,
                                          .yield_stress = yield_stress});
    }
    /// M_p of the notched middle [N m].
    [[nodiscard]] double notched_moment() const {
        return ductile::plastic_moment(
            ductile::NotchedRectangle<double>({.width = width, .height = height, .notch = notch}),
            steel());
    }
    /// M_p away from the notch [N m].
    [[nodiscard]] double full_moment() const {
        return ductile::plastic_moment(
            ductile::Rectangle<double>({.width = width, .height = height}), steel());
    }

    /// @throws std::invalid_argument naming the option, its value and the allowed range.
    void check() const {
        using namespace ductile::check;
        positive("--length", length, "m");
        positive("--width", width, "m");
        positive("--height", height, "m");
        non_negative("--notch", notch, "m");
        if (!(notch < height)) between("--notch", notch, 0.0, height, "m");
        positive("--density", density, "kg/m^3");
        positive("--youngs-modulus", youngs_modulus, "Pa");
        positive("--yield-stress", yield_stress, "Pa");
        positive_or_infinite("--max-plastic-rotation", max_plastic_rotation, "rad");
        if (parts < 2 || parts > 50 || parts % 2 != 0) {
            fail("--parts", double(parts), "", "an even number in [2, 50]");
        }
        between("--anvil-gap", anvil_gap, 0.0, length, "m");
        positive("--anvil-width", anvil_width, "m");
        positive("--hammer-mass", hammer_mass, "kg");
        positive("--hammer-width", hammer_width, "m");
        between("--hammer-height", hammer_height, 0.0, 2 * swing_radius, "m");
        positive("--hammer-thickness", hammer_thickness, "m");
        positive("--nose-length", nose_length, "m");
        between("--nose-width", nose_width, 0.0, anvil_gap, "m");
        positive("--arm-mass", arm_mass, "kg");
        positive("--arm-length", arm_length, "m");
        positive("--arm-width", arm_width, "m");
        between("--start-angle", start_angle, 0.0, 3.141592653589793, "rad");
        positive("--gravity", gravity, "m/s^2");
        non_negative("--friction", friction, "");
        between("--restitution", restitution, 0.0, 1.0, "", true);
        if (iterations < 1) fail("--iterations", double(iterations), "", ">= 1");
        positive("--dt", dt, "s");
        if (dt > 0.1) between("--dt", dt, 0.0, 0.1, "s", true);
    }
};

} // namespace charpy
