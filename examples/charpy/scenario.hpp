// SPDX-License-Identifier: MIT
//
// The Charpy impact test of Nikula (2017), section 2.2, as numbers: every dimension is a parameter.
//
// Axes: x horizontal, positive where the hammer comes from; y up; z along the specimen, z = 0 the plane
// of symmetry. The specimen's bottom is at y = 0.2 m and its back at x = 0, against two anvils; the
// hammer is a pendulum about z that swings down and strikes the specimen's middle towards -x when its
// centre of mass is at its lowest point.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "ductile/ductile.hpp"

namespace charpy {

/// The eight of the source, sections 2.3 to 2.10.
enum class Method {
    rigid,
    zero_limits,
    spring,
    spring2,
    hinge_motor,
    plastic_hinge,
    elastic_plastic,  ///< six axes, each elastic up to its own capacity, then flowing
    elastic_plastic_2 ///< six axes, elastic inside one surface that they share
};

inline constexpr std::array<std::pair<Method, std::string_view>, 8> method_names{{
    {Method::rigid, "rigid"},
    {Method::zero_limits, "zero-limits"},
    {Method::spring, "spring"},
    {Method::spring2, "spring2"},
    {Method::hinge_motor, "hinge-motor"},
    {Method::plastic_hinge, "plastic-hinge"},
    {Method::elastic_plastic, "elastic-plastic"},
    {Method::elastic_plastic_2, "elastic-plastic-2"},
}};

[[nodiscard]] constexpr std::string_view to_string(Method method) {
    for (const auto& [value, name] : method_names) {
        if (value == method) return name;
    }
    return "unknown";
}

/// @throws std::invalid_argument where there is no such method.
[[nodiscard]] inline Method method_of(std::string_view name) {
    for (const auto& [value, known] : method_names) {
        if (known == name) return value;
    }
    throw std::invalid_argument("--method = " + std::string(name) + ": no such method");
}

/// Names that an engine's scene takes.
inline constexpr std::string_view bullet_solvers = "mlcp, island, si or nncg";
inline constexpr std::string_view ode_solvers = "direct or quick";

/// True where the joint follows a stiffness below yield.
[[nodiscard]] constexpr bool is_elastic(Method method) {
    return method == Method::elastic_plastic || method == Method::elastic_plastic_2;
}
/// True where the specimen's joints are this library's.
[[nodiscard]] constexpr bool is_plastic(Method method) {
    return method == Method::plastic_hinge || is_elastic(method);
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
    static constexpr double anvil_width = 0.040; ///< the bar leans on the inner edges alone
    // hammer: a box whose centre is 1 m below the pivot, a thin nose in front, an arm
    double hammer_mass = 19.5;
    double hammer_width = 0.5;      ///< along x
    double hammer_height = 0.25;    ///< along y
    double hammer_thickness = 0.02; ///< along z
    double nose_length = 0.04;      ///< the draft: the box tapers to the nose over it, along x
    double nose_width = 0.002;      ///< flat of the nose, along z; that of the box without draft
    double arm_mass = 12.48;
    double arm_length = 1.0; ///< ends half a hammer height above the box's centre
    double arm_width = 0.04;
    double start_angle = 1.8;
    // world
    double gravity = 9.81;  ///< [m/s²]
    double friction = 0;    ///< Coulomb coefficient of every contact
    double restitution = 0; ///< of every contact, by Newton's rule; 0 is perfectly inelastic
    int iterations = 10;    ///< of iterative solvers
    // time, of this library's joints
    double frame = 1.0 / 60;  ///< [s]
    double tolerance = 0.01; ///< share of the plastic work that a frame may misplace

    /// Distance of the struck point from the pivot [m].
    static constexpr double swing_radius = 1.0;
    /// Way of the nose to the specimen where a run begins, with the speed that the swing gave: in a
    /// step of 1/60 s the engines' own hinges lose 2.6 % of a swing from 1.8 rad [m].
    static constexpr double approach = 0.02;
    static constexpr double specimen_bottom = 0.2;

    /// Flat that strikes, along z [m].
    [[nodiscard]] double flat() const { return nose_length > 0 ? nose_width : hammer_thickness; }
    /// Length of bar that each joint stands for: between the centres of two parts [m].
    [[nodiscard]] double joint_length() const { return length / parts; }
    /// Hinge angle at which the two halves slip through between the anvils [rad]; reference.hpp.
    [[nodiscard]] double pass_rotation() const {
        return 2 * (std::atan(height / length) + std::acos(anvil_gap / std::hypot(length, height)));
    }
    /// Clear width between the ends of the folded specimen as it slips through [m].
    [[nodiscard]] double folded_width() const {
        const double phi = pass_rotation() / 2;
        return length * std::cos(phi) - height * std::sin(phi);
    }
    /// Thickness at which the hammer's flanks would meet those ends, or the anvils [m]. Its edges
    /// meet the specimen's face only; a thicker hammer would have to meet more.
    [[nodiscard]] double thickest_hammer() const {
        const double phi = pass_rotation() / 2;
        const double struck = (nose_width + height * std::sin(phi)) / 2 / std::cos(phi);
        const double depth = (length / 2 - struck) * std::sin(phi); // of the ends behind the nose
        const double taper = nose_length > depth ? nose_length / depth : 1;
        return std::min(anvil_gap, nose_width + (folded_width() - nose_width) * taper);
    }

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
    /// What the hammer's swing gives it [J].
    [[nodiscard]] double strike_energy() const {
        return total_hammer_mass() * gravity * hammer_centre() * (1 - std::cos(start_angle));
    }
    /// Angle of the hammer from its lowest position where a run begins [rad].
    [[nodiscard]] double angle_before_strike() const { return approach / swing_radius; }
    /// Of the hammer there [rad/s].
    [[nodiscard]] double spin_before_strike() const {
        const double fall = total_hammer_mass() * gravity * hammer_centre() *
                            (1 - std::cos(angle_before_strike()));
        return -std::sqrt(2 * (strike_energy() - fall) / hammer_inertia());
    }
    /// From there to the strike [s].
    [[nodiscard]] double time_to_strike() const {
        return angle_before_strike() / -spin_before_strike();
    }
    /// With its centre of mass at `y` [m], beside its lowest position [J].
    [[nodiscard]] double hammer_potential(double y) const {
        return total_hammer_mass() * gravity * (y - (pivot_y() - hammer_centre()));
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
    [[nodiscard]] ductile::NotchedRectangle<double> notched_section() const {
        return ductile::NotchedRectangle<double>(
            {.width = width, .height = height, .notch = notch});
    }
    [[nodiscard]] ductile::Rectangle<double> full_section() const {
        return ductile::Rectangle<double>({.width = width, .height = height});
    }
    /// M_p of the notched middle [N m].
    [[nodiscard]] double notched_moment() const {
        return ductile::plastic_moment(notched_section(), steel());
    }
    /// Elastic stiffness of the notched middle in bending, over the length it stands for
    /// [N m/rad].
    [[nodiscard]] double notched_stiffness() const {
        return youngs_modulus * notched_section().second_moment() / joint_length();
    }
    /// M_p away from the notch [N m].
    [[nodiscard]] double full_moment() const {
        return ductile::plastic_moment(full_section(), steel());
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
        positive("--hammer-mass", hammer_mass, "kg");
        positive("--hammer-width", hammer_width, "m");
        between("--hammer-height", hammer_height, 0.0, 2 * swing_radius, "m");
        non_negative("--draft", nose_length, "m");
        between("--nose-width", nose_width, 0.0, std::min(anvil_gap, folded_width()), "m");
        if (!(hammer_thickness >= nose_width && hammer_thickness < thickest_hammer())) {
            fail("--hammer-thickness", hammer_thickness, "m",
                 fmt::format("in [{:.4g}, {:.4g}) m: not thinner than the nose, and clear of the "
                             "anvils and of the folded specimen's ends",
                             nose_width, thickest_hammer()));
        }
        positive("--arm-mass", arm_mass, "kg");
        positive("--arm-length", arm_length, "m");
        positive("--arm-width", arm_width, "m");
        between("--start-angle", start_angle, 0.0, 3.141592653589793, "rad");
        positive("--gravity", gravity, "m/s^2");
        non_negative("--friction", friction, "");
        between("--restitution", restitution, 0.0, 1.0, "", true);
        if (iterations < 1) fail("--iterations", double(iterations), "", ">= 1");
        positive("--frame", frame, "s");
        if (frame > 0.1) between("--frame", frame, 0.0, 0.1, "s", true);
        positive("--tolerance", tolerance, "");
    }
};

} // namespace charpy
