// SPDX-License-Identifier: MIT
//
// A field of many joints, for what a joint costs: as pairs of bodies far apart, each an island of
// its own, or as one chain. No gravity, no contacts, nothing sleeps.
//
// In a pair both bodies turn about the joint's axis against each other at 1 rad/s: a weak joint
// (10⁻⁶ N m) yields for as long as anybody measures, a strong one (10³ N m) stops them in the first
// step and holds. A chain starts at rest and holds.
#pragma once

#include <malloc.h>

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

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

struct FieldSettings {
    Joint joint = Joint::none;
    int count = 100;           ///< of joints
    bool chain = false;        ///< one chain of count + 1 bodies instead of `count` pairs
    int weak_every = 0;        ///< each so many joints one is weak; 0: none
    bool split_islands = true; ///< Bullet's setSplitIslands; ODE always splits
    bool direct = true;        ///< ODE: dWorldStep, or dWorldQuickStep

    [[nodiscard]] double strength(int i) const {
        return weak_every > 0 && i % weak_every == 0 ? 1e-6 : 1e3;
    }
};

inline constexpr double body_mass = 1, body_inertia = 1, half_length = 0.5;
inline constexpr double pair_distance = 4; ///< [m]
inline constexpr double pair_spin = 0.5;   ///< of each body [rad/s]
inline constexpr double dt = 1e-3;         ///< [s]

/// Bytes that the process has from its allocator, whoever asked for them.
[[nodiscard]] inline double heap_in_use() {
    const struct mallinfo2 info = mallinfo2();
    return double(info.uordblks) + double(info.hblkhd);
}

} // namespace bench::cost
