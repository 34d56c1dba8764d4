// SPDX-License-Identifier: MIT
//
// A contact that gives way, as both engines have them: a spring and a damper that push and never
// pull,
//
//   F = max(0, k δ - d u),   δ: overlap, u: speed at which it opens
//
// It is no blow, however fast it is met: in one it gives nothing, and in a part the mean of its
// forces (law_row). What a part does not follow of it, its peak or its beginning, is told as of a
// spring of the frequency max(√(k/m), d/m) (OwnForces).
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/frame/part_engine.hpp"
#include "ductile/frame/part_settings.hpp"

namespace ductile {

struct SoftContact {
    double stiffness = 0, damping = 0; ///< k, d [N/m, N s/m]
    double mass = 0;                   ///< effective one of the point, both bodies free [kg]
    double heavy = 0; ///< the larger one of one of both alone: what the other hangs on may hold it

    SoftContact() = default;
    /// `of_a`, `of_b`: velocity that a unit impulse gives at the point of either; one moves [1/kg].
    SoftContact(double k, double d, double of_a, double of_b) noexcept
        : stiffness(k), damping(d), mass(1 / (of_a + of_b)) {
        heavy = 1 / (of_a > 0 && of_b > 0 ? std::min(of_a, of_b) : std::max(of_a, of_b));
    }
    /// Of what an engine has in a step of `frame` [s]: u' + compliance F = erp δ/frame.
    [[nodiscard]] static SoftContact of(const Softness& usual, double of_a, double of_b,
                                        double frame) noexcept {
        return {usual.erp / (frame * usual.compliance), (1 - usual.erp) / usual.compliance, of_a,
                of_b};
    }
    /// It stops what meets it within so little time that it is a hard one, in any shorter frame
    /// too, and what would come back is damped, or nothing that a step of the frame sends back.
    [[nodiscard]] bool is_hard(double frame) const noexcept {
        constexpr double at_once = 1e-3, longest = 1.0 / 30; // of a frame [-], that of games [s]
        constexpr double damped = 0.8, stiff = 1e4;          // [-], (ω frame)²
        return heavy < at_once * std::max(frame, longest) * (damping + frame * stiffness) &&
               (damping * damping > 4 * damped * damped * stiffness * heavy ||
                stiffness * frame * frame > stiff * heavy);
    }
    /// Overlap at which it is taken to begin, of what comes at `speed` [m/s] [m].
    [[nodiscard]] double beginning(double speed) const noexcept {
        constexpr double share = 1e-3; // of the overlap that it comes to
        const double fast = std::max(std::sqrt(stiffness / mass), damping / mass);
        return share * std::abs(speed) / fast;
    }
    /// For a part of `h` [s] in the middle of which it overlaps by `overlap` [m], and in which it
    /// begins with `start` [m/s]. What is too fast for the part has its force at the end, which
    /// takes energy: where a part met it late, the mean one would give some.
    [[nodiscard]] LawRow row(double overlap, double start, double h) const noexcept {
        if (!(stiffness * h * h > heavy)) {
            return law_row(stiffness, damping, mass, -overlap, start, h);
        }
        const double own = stiffness * h * h / 2 + damping * h;
        return {stiffness * h * overlap / own, 1 / own};
    }
    /// Adds what it did in the part, which it left with `end` [m/s], by its mean force [N].
    void tell(OwnForces& forces, double force, double start, double end, double h) const noexcept {
        constexpr double most = 1e3, held = 0.01;
        if (!(force > 0)) return;
        const double moved = std::clamp(force * h / std::abs(end - start), mass, most * mass);
        const double followed = std::max(stiffness, damping * damping / moved);
        forces.add_spring(followed, moved, force, start, end, h, held);
        const double later = damper_share(damping * h, mass) - 0.5;
        forces.late = std::max(forces.late, later * damping * std::abs(end - start) / force);
    }
};

} // namespace ductile
