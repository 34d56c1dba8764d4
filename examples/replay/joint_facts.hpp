// SPDX-License-Identifier: MIT
//
// What a reader wants to know of a joint of constant strength, for a recorder: capacities and where
// it breaks as facts, and the share of its life that is used.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/joint/usual_joints.hpp"
#include "recording.hpp"

namespace ductile::replay {

/// 360000, "N m" -> "360 kN m"
[[nodiscard]] inline std::string quantity(double value, const char* unit) {
    const double size = std::abs(value);
    const std::pair<double, const char*> by = size >= 1e6   ? std::pair(1e6, "M")
                                              : size >= 1e3 ? std::pair(1e3, "k")
                                                            : std::pair(1.0, "");
    char text[64];
    std::snprintf(text, sizeof text, "%.4g %s%s", value / by.first, by.second, unit);
    return text;
}

/// Appended to `words`, what the user knows: section, material.
[[nodiscard]] inline std::vector<Fact> facts_of(const UsualSixAxisJoint& joint,
                                                std::vector<Fact> words = {}) {
    for (const JointAxis axis : all_joint_axes) {
        const Eigen::Index i = Eigen::Index(index(axis));
        words.emplace_back("capacity, " + std::string(to_string(axis)),
                           quantity(joint.surface().capacity()[i], turns(axis) ? "N m" : "N"));
        const double largest = joint.parameters().largest_travel[i];
        if (std::isfinite(largest)) {
            words.emplace_back("breaks by it alone at",
                               quantity(largest, turns(axis) ? "rad" : "m"));
        }
    }
    return words;
}

/// `rotates`: a hinge, not a slider.
template <class Criterion>
[[nodiscard]] std::vector<Fact> facts_of(const OneAxisJoint<Perfect<double>, Criterion>& joint,
                                         bool rotates, std::vector<Fact> words = {}) {
    words.emplace_back("capacity", quantity(joint.strength(), rotates ? "N m" : "N"));
    const double stiffness = joint.parameters().stiffness;
    if (std::isfinite(stiffness)) {
        words.emplace_back("stiffness", quantity(stiffness, rotates ? "N m/rad" : "N/m"));
    }
    if constexpr (std::is_same_v<Criterion, TravelLimit<double>>) {
        const double limit = joint.criterion().limit();
        if (std::isfinite(limit)) {
            words.emplace_back("breaks at", quantity(limit, rotates ? "rad" : "m"));
        }
    }
    return words;
}

/// Of an engine's joint, which must stay; empty where its life has no end.
template <class Made>
[[nodiscard]] std::function<double()> life_used(const Made& made) {
    const auto& joint = made.joint();
    if constexpr (requires { joint.damage(); }) {
        using Criterion = std::decay_t<decltype(joint.criterion())>;
        if constexpr (std::is_same_v<Criterion, TravelLimit<double>>) {
            if (!std::isfinite(joint.criterion().limit())) return {};
        }
        return [&made] { return made.joint().damage(); };
    } else {
        const bool limited =
            std::isfinite(joint.criterion().limit()) ||
            joint.parameters().largest_travel.minCoeff() < std::numeric_limits<double>::infinity();
        if (!limited) return {};
        return [&made] {
            const auto& state = made.joint().state();
            return state.broken ? 1.0
                                : std::min(1.0, std::max(double(state.life),
                                                         double(made.joint().criterion().damage(
                                                             state.criterion))));
        };
    }
}

} // namespace ductile::replay
