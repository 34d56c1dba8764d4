// SPDX-License-Identifier: MIT
//
// Runs one cell and says what became of it. The same limits for every method:
//
//   not-finished   not run: beyond the limit of work, or the program died in it
//   blown-up       a number was no longer one, or energy rose tenfold above all there was
//   energy-gained  kinetic and potential energy rose by more than 5 % of the scene's energy
//   right          the scene's first quantity is within 5 % and rest is rest
//   refused        not right, and the method itself said in some step not to be believed: unsolved
//                  rows, or steps too long for its flow or for what the scene told to close in
//   drift, jitter  joints that should rest move by more than 2 % of the scene's travel, mostly one
//                  way, or to and fro
//   off            more than 5 % off otherwise
//
// In this order: a run that was said to be unreliable is still blown up where it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "engines/run_scene.hpp"
#include "stability/grids.hpp"

namespace bench::stability {

inline constexpr double allowed_error = 0.05;
inline constexpr double allowed_gain = 0.05;
inline constexpr double blown_up_gain = 10;
inline constexpr double allowed_unrest = 0.02;

struct Cell {
    std::string_view verdict;
    double error = infinity;  ///< of the scene's first quantity, relative
    double energy_gain = 0;   ///< relative to the scene's energy
    bool said = false;        ///< that it should not be believed
    bool coarse = false;      ///< step of a twentieth of the motion or more
    double energy_error = -1; ///< of the absorbed energy, relative; -1: no account
    long steps = 0;
};

/// How far joints moved while they should have been at rest.
class RestWatch {
  public:
    explicit RestWatch(const Trial& trial) : trial_(trial) {}

    void see(const Observation& o) {
        if (o.time < trial_.rest_after) return;
        if (first_.empty()) first_ = low_ = high_ = o.travel;
        for (std::size_t i = 0; i < o.travel.size(); ++i) {
            low_[i] = std::min(low_[i], o.travel[i]);
            high_[i] = std::max(high_[i], o.travel[i]);
        }
        last_ = o.travel;
    }
    /// Class of the unrest; empty where there is none.
    [[nodiscard]] std::string_view verdict() const {
        double range = 0, net = 0;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            if (high_[i] - low_[i] <= range) continue;
            range = high_[i] - low_[i];
            net = std::abs(last_[i] - first_[i]);
        }
        if (!(range > allowed_unrest * trial_.rest_scale)) return {};
        return net > range / 2 ? "drift" : "jitter";
    }

  private:
    const Trial& trial_;
    std::vector<double> first_, last_, low_, high_;
};

/// `work`: limit of steps × bodies³, which is what a direct solver takes; counted and not timed, so that two
/// runs agree. A scene beyond it is not run.
template <class World>
Cell run_cell(const Trial& trial, const Settings& settings, double work) {
    const double bodies = double(trial.scene.bodies.size());
    const double steps = trial.scene.duration / settings.dt;
    if (steps * bodies * bodies * bodies > work) return {.verdict = "not-finished"};

    RestWatch rest(trial);
    const RunResult run = observe<World>(trial.scene, settings,
                                         [&](const World&, const Observation& o) { rest.see(o); });

    Cell cell;
    cell.steps = run.steps;
    cell.said = run.unreliable_steps > 0;
    cell.coarse = settings.dt >= trial.motion_time / 20;
    cell.energy_gain =
        run.finite ? std::max(run.energy_highest - run.energy_start, 0.0) / trial.energy_scale
                   : infinity;
    cell.error = relative_error(trial.scene.quantities.front(), run).value_or(infinity);
    for (const Quantity& quantity : trial.scene.quantities) {
        if (quantity.name != "absorbed_energy") continue;
        cell.energy_error = relative_error(quantity, run).value_or(-1);
    }
    const std::string_view unrest = rest.verdict();
    cell.verdict = [&]() -> std::string_view {
        if (!run.finite || cell.energy_gain > blown_up_gain) return "blown-up";
        if (cell.energy_gain > allowed_gain) return "energy-gained";
        if (cell.error <= allowed_error && unrest.empty()) return "right";
        if (cell.said) return "refused";
        return unrest.empty() ? "off" : unrest;
    }();
    return cell;
}

} // namespace bench::stability
