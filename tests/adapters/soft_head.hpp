// SPDX-License-Identifier: MIT
//
// A mass thrown down on a head that a rigid-plastic slider holds, with a contact between them that
// is a spring and a damper and only pushes. One dimension, integrated in steps of 1/1000 of the
// fastest time in it: an answer that no engine has a part in.
#pragma once

#include <algorithm>
#include <cmath>

namespace ductile::test {

struct SoftHead {
    double mass, head;         ///< [kg]
    double speed;              ///< of the mass, down, where it meets the head [m/s]
    double stiffness, damping; ///< of the contact [N/m, N s/m]
    double strength;           ///< of the slider [N]
    double gravity = 0;        ///< [m/s²]

    /// Of what engines have in a step of `frame` [s].
    [[nodiscard]] double cfm(double frame) const { return 1 / (damping + frame * stiffness); }
    [[nodiscard]] double erp(double frame) const { return frame * stiffness * cfm(frame); }

    /// What the slider takes in `duration` [s] [J].
    [[nodiscard]] double absorbed(double duration) const {
        const double yields = 1 / mass + 1 / head;
        const double h = 1e-3 / std::max(std::sqrt(stiffness * yields), damping * yields);
        double at = 0, down = speed, head_at = 0, head_down = 0, work = 0;
        for (double time = 0; time < duration; time += h) {
            const double overlap = at - head_at + h / 2 * (down - head_down);
            const double force =
                overlap > 0 ? std::max(0.0, stiffness * overlap + damping * (down - head_down)) : 0;
            const double before = head_down;
            at += h / 2 * down;
            down += h * (gravity - force / mass);
            at += h / 2 * down;
            head_at += h / 2 * head_down;
            head_down += h * (gravity + force / head);
            const double held = std::clamp(head * head_down, -h * strength, h * strength);
            head_down -= held / head;
            head_at += h / 2 * head_down;
            work += held * (before + head_down) / 2;
        }
        return work;
    }
};

/// Damped and not, a light head and a heavy one, softer and harder than a frame resolves.
inline constexpr SoftHead soft_heads[] = {
    {100, 50, 3, 4e5, 2e3, 8e3, 9.81}, {100, 5, 2, 1e6, 1e4, 1e4, 9.81},
    {20, 200, 5, 1e7, 2e3, 3e4},       {300, 20, 1, 1e5, 1e5, 2e4},
    {50, 50, 8, 1e8, 4e4, 1e5},        {5, 100, 4, 1e5, 50, 1500},
};

} // namespace ductile::test
