// SPDX-License-Identifier: MIT
//
// A field of many joints, for what a joint costs: as islands of one to five joints far apart, or as
// one chain. Nothing sleeps, and only what stands on a floor has contacts.
//
//   pairs    two bodies turn about the joint's axis against each other at 1 rad/s: a weak joint
//            yields for as long as anybody measures, a strong one stops them in the first step
//   chain    one of count + 1 bodies, at rest and without gravity
//   ground   one body on the ground that turns at 1 rad/s; a strong joint stops it
//   post     a lamp-post of 6 m and 100 kg on its foot, with 200 N of wind at its middle (600 N m)
//   fives    chains of five bodies of 1 m that stand out from the ground under gravity: 123 N m at
//            the wall, 20 N m of a weak joint
//   floor    two cubes of 1 m and 1 kg with an upright joint stand on a floor, friction 0.25, that
//            holds each with 2.45 N. With strong joints they are pushed by 1 N and -0.5 N, and
//            stick; with weak ones, 0.5 N m, one of them by 6 N: they slide and the joint flows
#pragma once

#include <malloc.h>

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/vocabulary/vector.hpp"

namespace bench::cost {

enum class Joint { none, plastic_hinge, plastic_joint, hinge_motor, spring2, fixed };

inline constexpr std::array<std::pair<Joint, std::string_view>, 6> joint_names{{
    {Joint::none, "bodies-only"},
    {Joint::plastic_hinge, "plastic-hinge"},
    {Joint::plastic_joint, "plastic-joint"},
    {Joint::hinge_motor, "hinge-motor"},
    {Joint::spring2, "spring2"},
    {Joint::fixed, "fixed"},
}};

enum class SetUp { pairs, chain, ground, post, fives, floor };

struct FieldSettings {
    Joint joint = Joint::none;
    int count = 100; ///< of joints
    SetUp set_up = SetUp::pairs;
    int weak_every = 0;        ///< each so many joints one is weak; 0: none
    bool split_islands = true; ///< Bullet's setSplitIslands; ODE always splits
    bool direct = true;        ///< ODE: dWorldStep, or dWorldQuickStep
    bool ledger = false;       ///< stepped by a ductile World that keeps it
};

using V3 = ductile::Vector3<double>;

struct Body {
    V3 at;
    double mass = 1;
    V3 inertia = V3::Ones();
    V3 velocity = V3::Zero(), spin = V3::Zero(), push = V3::Zero();
};
/// A joint at a place, its axis along z.
struct Link {
    int a, b; ///< `ground` or a body
    V3 at;
    double strength;
};
inline constexpr int ground = -1;

struct Plan {
    std::vector<Body> bodies;
    std::vector<Link> links;
    V3 gravity = V3::Zero();
    double dt = 1e-3;       ///< [s]
    double stiffness = 100; ///< of the engine's springs [N m | N/m]
    bool floor = false;     ///< bodies are cubes that stand on it
};

inline constexpr double half_length = 0.5;
inline constexpr double floor_friction = 0.5; ///< of the floor and of each cube; both multiplied

namespace detail {

struct Strengths {
    double weak, strong; ///< [N m | N]
};
[[nodiscard]] inline Strengths strengths(SetUp set_up) {
    switch (set_up) {
        case SetUp::post:
            return {500, 3000};
        case SetUp::fives:
            return {20, 1e3};
        case SetUp::floor:
            return {0.5, 1e3};
        default:
            return {1e-6, 1e3};
    }
}

} // namespace detail

[[nodiscard]] inline Plan plan_of(const FieldSettings& settings) {
    constexpr double g = 9.81, distance = 4; // of islands in a square field [m]
    constexpr int row = 300;
    const SetUp set_up = settings.set_up;
    const auto [weak, strong] = detail::strengths(set_up);
    const V3 out(half_length, 0, 0);
    Plan plan;
    if (set_up == SetUp::post || set_up == SetUp::fives) plan.gravity.y() = -g;
    if (set_up == SetUp::floor) plan.gravity.z() = -g;
    if (set_up == SetUp::post || set_up == SetUp::floor) plan.dt = 1.0 / 60;
    if (set_up == SetUp::post) plan.stiffness = 1e5;
    plan.floor = set_up == SetUp::floor;
    plan.bodies.reserve(2 * std::size_t(settings.count));
    plan.links.reserve(std::size_t(settings.count));
    const auto add = [&plan](const Body& body) {
        plan.bodies.push_back(body);
        return int(plan.bodies.size()) - 1;
    };
    if (set_up == SetUp::chain) add({.at = V3::Zero()});
    int last = ground; // body of a chain
    for (int i = 0; i < settings.count; ++i) {
        const bool is_weak = settings.weak_every > 0 && i % settings.weak_every == 0;
        const V3 island(distance * (i % row), distance * (i / row), 0);
        Link link{ground, ground, island, is_weak ? weak : strong};
        switch (set_up) {
            case SetUp::pairs:
                for (const int side : {-1, 1}) {
                    (side < 0 ? link.a : link.b) = add({.at = island + side * out,
                                                        .velocity = {0, 0.25, 0},
                                                        .spin = {0, 0, side * 0.5}});
                }
                break;
            case SetUp::chain:
                link.a = int(plan.bodies.size()) - 1;
                link.at = plan.bodies.back().at + out;
                link.b = add({.at = link.at + out});
                break;
            case SetUp::ground:
                link.a = add({.at = island + out, .velocity = {0, 0.5, 0}, .spin = {0, 0, 1}});
                break;
            case SetUp::post:
                link.a = add({.at = island + V3(0, 3, 0),
                              .mass = 100,
                              .inertia = {300, 1, 300},
                              .push = {200, 0, 0}});
                break;
            case SetUp::fives: {
                const int place = i % 5;
                link.at = V3(6.0 * distance * (i / 5 % row) + place, distance * (i / 5 / row), 0);
                link.b = place == 0 ? ground : last;
                link.a = last = add({.at = link.at + out, .inertia = V3::Constant(0.1)});
                break;
            }
            case SetUp::floor:
                link.at.z() = half_length;
                for (const int side : {-1, 1}) {
                    const double pushed = side < 0 ? (is_weak ? 6 : 1) : (is_weak ? 0 : -0.5);
                    (side < 0 ? link.a : link.b) = add({.at = link.at + side * V3(0.51, 0, 0),
                                                        .inertia = V3::Constant(1.0 / 6),
                                                        .push = {0, pushed, 0}});
                }
                break;
        }
        plan.links.push_back(link);
    }
    return plan;
}

/// Bytes that the process has from its allocator, whoever asked for them.
[[nodiscard]] inline double heap_in_use() {
    const struct mallinfo2 info = mallinfo2();
    return double(info.uordblks) + double(info.hblkhd);
}

} // namespace bench::cost
