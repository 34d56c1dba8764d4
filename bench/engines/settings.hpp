// SPDX-License-Identifier: MIT
//
// With what a scene is run.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace bench {

struct Settings {
    std::string solver;
    int iterations = 10; ///< of an iterative solver or a direct one's fallback; 0: does not apply
    std::string method;
    double dt = 1.0 / 60; ///< fixed step, or frame [s]
    double first = 0;     ///< first step where it is another one [s]; 0: like the others
    double tolerance = 0; ///< > 0: a step is a frame of a World with this tolerance, of ours only

    [[nodiscard]] bool in_frames() const { return tolerance > 0; }
};

/// What a solver's number of iterations is for: nothing, a direct solver's fallback where it gives
/// up, or the solve itself.
enum class Iterations { none, fallback, solve };

struct SolverName {
    std::string_view name;
    Iterations iterations;
};

/// Share of a joint's position error that an engine removes in a step [-]: 0.2, the engines' own
/// default, at steps of 1 ms and more, and in proportion to the step below (as in examples/charpy).
[[nodiscard]] inline double drift_correction(double dt) { return std::min(0.2, dt / 5e-3); }

} // namespace bench
