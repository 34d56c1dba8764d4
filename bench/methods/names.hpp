// SPDX-License-Identifier: MIT
//
// The methods by name, for every engine: the names of examples/charpy and three more. In scenes
// with a sliding joint the same names stand for the slider: plastic-hinge is PlasticSlider there,
// hinge-motor the slider's motor.
//
// To add a method: one header with its Holder in bench/methods/bullet and bench/methods/ode, one
// line in each all.hpp, and its name here and in bench/pareto.py. A name without a line in all.hpp
// is listed as not there.
#pragma once

#include <array>
#include <string_view>

namespace bench {

struct MethodName {
    std::string_view name;
    bool ours;
    std::string_view what;
};

inline constexpr std::array<MethodName, 10> method_names{{
    {"zero-limits", false, "the engine's fixed joint with a breaking impulse"},
    {"spring", false, "the engine's spring; strength per radian where the joint is rigid-plastic"},
    {"spring2", false, "Bullet's second spring, limited by itself"},
    {"spring2-unlimited", false, "Bullet's second spring, not limited"},
    {"hinge-motor", false, "the engine's motor at zero speed, as strong as the joint; no account"},
    {"seed-account", false, "that motor with the account of Nikula (2017)"},
    {"explicit-clamp", false, "explicit spring, clamped, rest position shifted"},
    {"plastic-hinge", true, "ours, rigid-plastic"},
    {"elastic-plastic", true, "ours, elastic-plastic; where the joint has a stiffness"},
    {"plastic-joint", true, "ours, six axes, elastic where the joint has a stiffness"},
}};

/// Ours in a World with a tolerance are named with this after the method's name.
inline constexpr std::string_view frames_suffix = "-frames";

[[nodiscard]] constexpr bool is_ours(std::string_view method) {
    for (const MethodName& m : method_names) {
        if (m.name == method) return m.ours;
    }
    return false;
}

} // namespace bench
