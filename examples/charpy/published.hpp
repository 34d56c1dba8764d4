// SPDX-License-Identifier: MIT
//
// What Nikula (2017), chapter 3, says of each method, and a judgement of a run beside it: whether the
// method is right by mechanics, and why, from the run's own figures.
//
// The source's figures are hammer losses rounded to 10 J, from single precision, sequential impulse
// with 10 iterations, steps of about 0.1 ms, and a friction that it does not state.
#pragma once

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "reference.hpp"
#include "scenario.hpp"

namespace charpy {

struct Published {
    Method method;
    std::string_view section, says;
};
inline constexpr std::array<Published, 8> published{{
    {Method::rigid, "3.1", "bounces the hammer back"},
    {Method::zero_limits, "3.2", "breaks brittle"},
    {Method::spring, "3.3", "about 50; springs back; unstable at 800 MPa"},
    {Method::spring2, "3.4", "about 40; springs back"},
    {Method::hinge_motor, "3.5", "about 110"},
    {Method::plastic_hinge, "3.6", "as hinge-motor"},
    {Method::elastic_plastic, "3.7", "as plastic-hinge"},
    {Method::elastic_plastic_2, "3.8", "90 to 150 with the step"},
}};

/// Section 3.6, with the largest plastic rotation of that section.
inline constexpr double published_break_rotation = 1.5; // [rad]
inline constexpr std::string_view published_break_loss = "about 95";

/// Table 3.1, of elastic-plastic-2 at steps of 0.05 to 0.1 ms.
inline constexpr std::string_view published_steps = "90 to 150";

struct Judgement {
    bool right = false;
    std::string why; ///< one line
};

namespace published_detail {

inline constexpr double allowed = 0.01; ///< of the plastic work [-]

/// Why a method that yields at M_p is right.
[[nodiscard]] inline std::string reason(Method method, bool broken, const Reference& expected) {
    const std::string elastic =
        fmt::format("the first {:.2f} J are elastic and {}", expected.stored,
                    broken ? "set free by the break" : "spring back");
    switch (method) {
        case Method::hinge_motor:
            return "a motor of strength M_p and target 0 is a rigid-plastic row; it can neither "
                   "break nor say what it took";
        case Method::elastic_plastic:
            return "each axis springs up to its own capacity and flows there; " + elastic;
        case Method::elastic_plastic_2:
            return "six axes on one surface, on which symmetric bending leaves no shear or axial "
                   "force at the notch; " + elastic;
        default: return "yields at M_p, keeps the bend and books impulse x mean velocity";
    }
}

/// For the methods that yield at M_p.
[[nodiscard]] inline Judgement judge_plastic(Method method, const nlohmann::ordered_json& r,
                                             const Reference& expected) {
    const double error = r.at("plastic_work_J").get<double>() / expected.plastic_work - 1;
    const std::string off = fmt::format("{:+.2f} % plastic work", 100 * error);
    const char* says = r.at("believed").get<bool>() ? "" : "; it says that it is not to be believed";
    if (std::abs(error) <= allowed) {
        return {true, off + ": " + reason(method, r.at("broken").get<bool>(), expected) + says};
    }
    return {false, off + (is_plastic(method) ? says : ": the engine's joint has no certificate to tell")};
}

} // namespace published_detail

/// `r`: a run as to_json gives it.
[[nodiscard]] inline Judgement judge(Method method, const nlohmann::ordered_json& r,
                                     const Reference& expected) {
    using published_detail::judge_plastic;
    const auto number = [&r](const char* key) {
        return r.at(key).is_number() ? r.at(key).get<double>() : NAN;
    };
    const double loss = number("hammer_loss_J"), work = number("plastic_work_J");
    if (!std::isfinite(loss) || std::abs(number("unexplained_J")) > 1) {
        return {false, fmt::format("unstable: {:.3g} J that no force explains",
                                   number("unexplained_J"))};
    }
    switch (method) {
        case Method::rigid:
            return {std::abs(loss / expected.strike_energy - 1) <= published_detail::allowed,
                    fmt::format("nothing yields and the hammer loses {:.1f} of its {:.1f} J; "
                                "restitution is 0, so a rebound is energy that the contact adds",
                                loss, expected.strike_energy)};
        case Method::zero_limits: {
            const double contact = number("contact_work_J");
            std::string why = fmt::format("{} after {:.2f} J where steel takes {:.0f} J: a threshold "
                                          "on the force holds none while the bar bends",
                                          r.at("broken").get<bool>() ? "breaks" : "does not break",
                                          work, expected.plastic_work);
            if (contact > expected.plastic_work) {
                why += fmt::format("; until it is read the joint is rigid, and the contact takes "
                                   "{:.0f} J in that one step", contact);
            }
            return {false, why};
        }
        case Method::spring:
        case Method::spring2:
            return {false,
                    fmt::format("no plastic part: {:.1f} J in the halves that fly off, {:.1f} J in "
                                "contacts, {} {:.1f} J{}",
                                number("specimen_kinetic_J"), number("contact_work_J"),
                                work < 0 ? "and the joint adds" : "and the joint keeps", std::abs(work),
                                method == Method::spring2
                                    ? "; softened to a quarter radian of phase a step"
                                    : "; M_p per radian is no stiffness of steel")};
        default: return judge_plastic(method, r, expected);
    }
}

} // namespace charpy
