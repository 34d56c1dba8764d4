// SPDX-License-Identifier: MIT
//
// The numbers that frame_control.ipp goes by, and what it asks of a part again and again.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ductile/frame/part_engine.hpp"

namespace ductile::detail {

inline constexpr double part_share = 0.1;    ///< κ
inline constexpr double contact_share = 0.3; ///< of the work of contacts that counts as error
inline constexpr double unmissed = 0.05;     ///< of PartRow::least: added to the scale
inline constexpr double of_stored = 10;      ///< of what springs hold: the same
inline constexpr double near_strength = 0.3; ///< share of it from which a spring may come to flow
/// Share of its strength that a row may have at the peak of the engine's springs and motors, from
/// which on they are followed.
inline constexpr double near_peak = 0.5;
inline constexpr double start_share = 1e-3; ///< of a part, where nothing is known of its forces
inline constexpr double many_starts = 0.1;  ///< of the budget: they are not first ones any more
inline constexpr double of_swings = 0.5; ///< of the budget: what then still swings alone is let be
inline constexpr double coarse_from = 0.75;   ///< used of the budget: what is allowed grows
inline constexpr int most_tries = 12;         ///< of one part
inline constexpr int tries_at_gaps = 6;       ///< the same, for gaps that closed in it unforeseen
inline constexpr double hair = 1e-3;          ///< of the shortest part: one that ends at a gap
inline constexpr double nothing_left = 1e-12; ///< of a frame
/// Turn of a body up to which a contact that was asked for where it will be tells its way: what is
/// left, of third order, is some 1e-5 of its arms [rad].
inline constexpr double followed_turn = 0.05;
inline constexpr double of_turns = 0.9; ///< that may be a part's: a body may still become faster

/// What a part's length is multiplied by where its error goes with it as h^order; `least` where the
/// error is no number.
[[nodiscard]] inline double growth(double allowed, double error, int order, double least,
                                   double most) {
    constexpr double margin = 0.85;
    if (error == 0) return most;
    const double ratio = margin * std::pow(allowed / error, 1.0 / order);
    return ratio >= least ? std::min(ratio, most) : least;
}

/// Of a part whose rows do no more than `most` [J]: a change of force that a far shorter part
/// foretold is more than there can be.
template <class Judgement>
[[nodiscard]] double likely_error(const Judgement& judged, double most) noexcept {
    return judged.of_rows > most ? judged.error - judged.of_rows + most : judged.error;
}

/// How far a part turned what a contact pushes, or what is driven and has a row that moves [rad].
[[nodiscard]] inline double turn_of(const PartMotion& motion) noexcept {
    double turn = motion.turned;
    for (const PartRow& row : motion.rows) {
        if (row.moves()) turn = std::max(turn, row.carried);
    }
    return turn;
}

/// Whether a row of a part was in the one before, at the same place.
template <class Past>
[[nodiscard]] bool was_there(const std::vector<Past>& before, const PartMotion& motion,
                             std::size_t row) noexcept {
    return row < before.size() && before[row].row.joint == motion.rows[row].joint &&
           before[row].row.section == motion.rows[row].section;
}

} // namespace ductile::detail
