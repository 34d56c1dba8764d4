// SPDX-License-Identifier: MIT
//
// What a solver says of an island.
#pragma once

namespace ductile::solve {

/// Plain value.
struct IslandReport {
    bool solved = true;
    double residual = 0; ///< worst violation of a row by what was answered [m/s | rad/s]
    double gives = 0;    ///< by what a chain of rigid rows still gives, all of them [m/s | rad/s]
    double scale = 0;    ///< largest velocity that a row gives by itself [m/s | rad/s]
    int rounds = 0;      ///< of the active set
    int factorisations = 0;
    int safe_ways = 0; ///< how often the active set did not settle, and a safe way was asked
};

/// An answer is solved where its residual is at most this share of `scale` [-].
inline constexpr double solved_residual = 1e-5;
/// One that is within this share of it needs no other way to be looked for [-].
inline constexpr double solved_well = 1e-8;

/// What is not solved is no answer for an island's joints where its residual is more than this
/// share of `scale` [-], or than this velocity [m/s | rad/s]: what their own rows may be off by.
inline constexpr double unsolved_share = 1e-2, unsolved_speed = 1e-3;

} // namespace ductile::solve
