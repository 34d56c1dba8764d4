// SPDX-License-Identifier: MIT
//
// What a structure is made of, whatever the engine: the three-storey frame of reference problem
// P29, as many of it one on the other as wanted, and chains of rods.
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/material/named.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace bench::structures {

using V3 = ductile::Vector3<double>;
using M3 = ductile::Matrix3<double>;
using Section = ductile::SectionJoint<double>;

inline constexpr int ground = -1;
inline constexpr double friction = 0.6;

enum class Method { none, fixed, elastic, rigid }; ///< no joints, the engine's own, ours
inline constexpr std::array<std::pair<Method, std::string_view>, 4> method_names{{
    {Method::none, "bodies-only"},
    {Method::fixed, "fixed"},
    {Method::elastic, "elastic"},
    {Method::rigid, "rigid"},
}};

struct Part {
    double mass; ///< [kg]
    V3 half;     ///< of its box [m]
    V3 at;
    bool collides = false, beam = false;
    V3 velocity = V3::Zero();
};
struct Joint {
    int a, b;
    V3 at;
    M3 axes;
    bool column;
};
struct Plan {
    std::vector<Part> parts;
    std::vector<Joint> joints;
    double gravity = 9.81;  ///< [m/s²]
    double layer = 0;       ///< depth at which the engine lets a contact rest [m]
    int to_remove = ground; ///< column 00

    int add(const Part& part) {
        parts.push_back(part);
        return int(parts.size()) - 1;
    }
};

struct FramePlan {
    int frames = 1;        ///< one on the other, gravity shared by them
    double slab = 3000;    ///< that each beam bears [kg]
    int crates = 0;        ///< of 1 t on every beam
    bool loose = false;    ///< on footings that lie on the ground
    bool contacts = false; ///< members collide
    double layer = 0;
};

[[nodiscard]] inline Plan frame(const FramePlan& wanted) {
    constexpr double storey = 3.5, gap = 0.01;
    constexpr std::array<double, 4> x{0, 6, 6, 0}, y{0, 0, 5, 5};
    const double base = wanted.loose ? 0.3 - wanted.layer : 0;
    M3 along_x, along_y;
    along_x << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    along_y << -1, 0, 0, 0, 0, 1, 0, 1, 0;
    Plan plan;
    plan.gravity /= wanted.frames;
    plan.layer = wanted.layer;
    std::array<int, 4> below{ground, ground, ground, ground};
    if (wanted.loose) {
        for (std::size_t c = 0; c < 4; ++c) {
            below[c] = plan.add({260, V3(0.3, 0.3, 0.15), V3(x[c], y[c], base - 0.15), true});
        }
    }
    for (int level = 0; level < 3 * wanted.frames; ++level) {
        const double z = base + storey * level, top = z + storey - 0.15 - gap;
        for (std::size_t c = 0; c < 4; ++c) {
            const int column = plan.add({61.3 * storey, V3(0.1, 0.1, storey / 2 - gap),
                                         V3(x[c], y[c], z + storey / 2), wanted.contacts});
            plan.joints.push_back({column, below[c], V3(x[c], y[c], z), M3::Identity(), true});
            below[c] = column;
            if (plan.to_remove == ground) plan.to_remove = column;
        }
        for (std::size_t b = 0; b < 4; ++b) {
            const std::size_t next = (b + 1) % 4;
            const bool is_x = b % 2 == 0;
            const double length = is_x ? 6 : 5, half = length / 2 - 0.1 - gap;
            const V3 middle((x[b] + x[next]) / 2, (y[b] + y[next]) / 2, top);
            const V3 way =
                is_x ? V3(x[next] > x[b] ? 1 : -1, 0, 0) : V3(0, y[next] > y[b] ? 1 : -1, 0);
            const int beam = plan.add({42.2 * length + wanted.slab,
                                       is_x ? V3(half, 0.075, 0.15) : V3(0.075, half, 0.15), middle,
                                       wanted.contacts || wanted.crates > 0, true});
            for (const bool end : {false, true}) {
                const double side = end ? 1 : -1;
                plan.joints.push_back({beam, below[end ? next : b],
                                       middle + side * (length / 2 - 0.1) * way,
                                       is_x ? along_x : along_y, false});
            }
            for (int k = 0; k < wanted.crates; ++k) {
                const double aside = (k - (wanted.crates - 1) / 2.0) * 1.5;
                plan.add({1000, V3(0.4, 0.4, 0.4),
                          middle + aside * way + V3(0, 0, 0.55 - wanted.layer), true});
            }
        }
    }
    return plan;
}

/// Rods of 1 m and 42.2 kg along x from the ground on; `speed` of the last one across [m/s].
[[nodiscard]] inline Plan chain(int joints, double speed) {
    M3 along_x;
    along_x << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    Plan plan;
    plan.gravity = 0;
    for (int i = 0; i < joints; ++i) {
        plan.add({42.2, V3(0.49, 0.075, 0.15), V3(i + 0.5, 0, 0)});
        plan.joints.push_back({i, i - 1, V3(i, 0, 0), along_x, false});
    }
    plan.parts.back().velocity = V3(0, 0, -speed);
    return plan;
}

[[nodiscard]] inline Section section(bool column, Method method) {
    const ductile::Material<double> steel(ductile::s355<double>());
    const bool elastic = method == Method::elastic;
    if (column) {
        return ductile::section_joint(
            ductile::ISection<double>(
                {.width = 0.2, .height = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015}),
            steel, {.length = 0.2, .elastic = elastic});
    }
    return ductile::section_joint(
        ductile::ISection<double>(
            {.width = 0.15, .height = 0.3, .web_thickness = 0.0071, .flange_thickness = 0.0107}),
        steel, {.length = 0.3, .elastic = elastic});
}

} // namespace bench::structures
