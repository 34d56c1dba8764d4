// SPDX-License-Identifier: MIT
//
// Whether a joint, and the structure that it is in, still swings or flows, or has come to rest.
//
// An elastic joint that keeps energy swings for ever. So a structure in which nothing has flowed
// for a second, and that was not used more than before either, is damped until it rests
// (rest_damping), at first by next to nothing: a damper that begins at once pushes harder than the
// swing that it ends, so that joints yield to it. What flows, or will soon, is not touched, be it
// loaded at once or slowly. Each joint is compared with its own last while, so that a load on what
// has come to rest stirs it again, wherever it acts. A structure that does not come to rest then is
// driven by something; it is left alone until it rests by itself or flows.
//
// A joint rests once its utilisation has stayed within a band for a second, whatever its speed: an
// engine's own threshold is met in the middle of a swing.
//
// Symbols
//   U   utilisation, share of the strength that the forces use; 0 of a joint without springs [-]
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

namespace ductile {

/// Plain value; part of what a joint remembers. `quiet` is that of its structure.
template <std::floating_point S>
struct SwingState {
    S used = 0;          ///< U [-]
    S peak = 0;          ///< largest U in the last while [-]
    S highest = 0;       ///< largest U in the present one [-]
    S lasts = 0;         ///< of that so far [s]
    S quiet = 0;         ///< time since something flowed or U came to a new peak [s]
    S held = 0;          ///< U about which it stays [-]
    S still = 0;         ///< time for which it has [s]
    bool flows = false;  ///< in its last step
    bool left = false;   ///< in it: where it rested, or it was kicked
    bool driven = false; ///< what damping did not bring to rest

    bool operator==(const SwingState&) const = default;

    /// Somebody woke it, or changed the structure.
    void stir() noexcept { *this = {}; }
    /// Its bodies have velocities that it did not give them.
    void kick() noexcept { left = true; }
    /// After a step of `dt` [s] of a joint without springs: what does not flow rests.
    void step(bool flowed, S dt) noexcept {
        step(S(0), flowed, dt);
        if (!flowed) still = std::max(still, 2 * waits);
    }
    /// After a step of `dt` [s] that left an elastic joint with `utilisation`.
    void step(S utilisation, bool flowed, S dt) noexcept {
        used = utilisation;
        flows = flowed;
        left = rests() && std::abs(used - held) > band / 2;
        quiet += dt;
        still += dt;
        lasts += dt;
        if (flows || std::abs(used - held) > band / 2) {
            held = used;
            still = 0;
        }
        driven = (driven || quiet > comes_to_rest) && !rests();
    }
    /// What its structure did, of which it is one.
    void share(bool stirred, bool flowed) noexcept {
        if (stirred) quiet = 0;
        peak = std::max(peak, stirs() ? used : S(0));
        highest = std::max(highest, used);
        if (lasts > a_while) {
            peak = highest;
            highest = lasts = 0;
        }
        driven = driven && !flowed;
    }
    /// It flows, is used more than before, or no longer as where it rested.
    [[nodiscard]] bool stirs() const noexcept {
        return flows || left || used > S(1.01) * peak + band;
    }
    /// May be damped until it rests.
    [[nodiscard]] bool is_quiet() const noexcept { return quiet > waits && !driven; }
    /// Since it may [s].
    [[nodiscard]] S calm() const noexcept { return is_quiet() ? quiet - waits : S(0); }
    [[nodiscard]] bool rests() const noexcept { return still > waits; }

    static constexpr S band = S(0.002);    ///< [-]
    static constexpr S waits = 1;          ///< [s]
    static constexpr S a_while = 10;       ///< [s]
    static constexpr S comes_to_rest = 60; ///< a structure that nothing drives [s]
};

/// τ of all elastic axes of a structure that is quiet, for each second that it has been, so that
/// slow swings end too [-].
template <std::floating_point S>
inline constexpr S rest_damping = S(0.05);

} // namespace ductile
