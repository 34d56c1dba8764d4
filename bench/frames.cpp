// SPDX-License-Identifier: MIT
//
// The frame map: what a user gets who gives a frame and a tolerance, and what the peers give for the
// same frame, cell by cell (frames/grids.hpp), on one build of one engine. bench/frames.py runs the
// programs of all builds and reads their rows.
//
//   frames-bullet-double [--scene NAME] [--method NAME] [--tolerance T]
//
//   ours                a World with the tolerance, the engine's default solver, nothing else said
//   hinge-motor         the engine's own motor with an account, in 1, 2, 4 ... equal parts a frame,
//                       until it is right within 1 % three times on end
//   explicit-clamp      the tutorial's spring, likewise
//
// Columns: scene,engine,precision,y_name,y,frame_s,method,solver,tolerance,parts,error_rel,
// energy_error_rel,believed,left_rel,energy_gain_rel,solves,rejected,worst_frame,cpu_s
//   parts              of a frame, fixed; 0: as many as the tolerance needs
//   energy_error_rel   of the absorbed energy; -1: no account
//   left_rel           what the run says it left unresolved, of its plastic work
//   cpu_s              CPU time of the whole run, the shortest of some
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "engines/run_scene.hpp"
#include "engines/world.hpp"
#include "frames/grids.hpp"

using namespace bench;

namespace {

struct Method {
    std::string_view name;
    std::string_view joint; ///< of bench/methods
    bool ours;
};
constexpr std::array<Method, 3> methods{{{"ours", "elastic-plastic", true},
                                         {"hinge-motor", "seed-account", false},
                                         {"explicit-clamp", "explicit-clamp", false}}};

struct Cell {
    const Grid& grid;
    double y, frame, energy;
    Scene scene;
};

/// CPU time of the steps alone: the shortest of some runs [s].
double cpu_time(const Scene& scene, const Settings& settings, long steps) {
    constexpr int most = 5;
    constexpr double enough = 0.02; // [s]
    double best = infinity, sum = 0;
    for (int i = 0; i < most && sum < enough; ++i) {
        World world(scene, settings);
        Stepping stepping(scene, settings);
        const double start = cpu_now();
        bench_steps(world, stepping, steps);
        const double taken = cpu_now() - start;
        best = std::min(best, taken);
        sum += taken;
    }
    return best;
}

/// Runs a cell, prints its row; returns its error.
double run(const Cell& cell, const Method& method, const Settings& settings, int parts) {
    const RunResult result = observe<World>(cell.scene, settings);
    const double error =
        relative_error(cell.scene.quantities.front(), result).value_or(infinity);
    double energy_error = -1;
    for (const Quantity& quantity : cell.scene.quantities) {
        if (quantity.name != "absorbed_energy") continue;
        energy_error = relative_error(quantity, result).value_or(-1);
    }
    const double gain =
        result.finite ? std::max(result.energy_highest - result.energy_start, 0.0) / cell.energy
                      : infinity;
    const ductile::RunReport& frames = result.frames;
    const bool ours = settings.in_frames();
    const std::size_t solves =
        ours ? frames.parts + frames.rejected + frames.blows : std::size_t(result.steps);
    fmt::print("{},{},{},{},{:.6g},{:.9g},{},{},{:g},{},{:.6e},{:.6e},{:d},{:.6e},{:.6e},{},{},{},{:.6e}\n",
               cell.grid.name, World::engine, World::precision, cell.grid.y_name, cell.y, cell.frame,
               method.name, settings.solver, settings.tolerance, parts, error, energy_error,
               !ours || frames.believed(),
               frames.plastic_work > 0 ? frames.left.energy / frames.plastic_work : 0.0, gain,
               solves, frames.rejected, frames.worst_frame,
               cpu_time(cell.scene, settings, result.steps));
    std::fflush(stdout);
    return error;
}

/// 1, 2, 4 ... parts a frame until it is right and stays so.
void run_fixed(const Cell& cell, const Method& method, Settings settings) {
    constexpr int most_parts = 4096, on_end = 3;
    constexpr double most_work = 4e6, right = 0.01; // work: steps × bodies²
    const double bodies = double(cell.scene.bodies.size());
    int streak = 0;
    for (int parts = 1; parts <= most_parts && streak < on_end; parts *= 2) {
        settings.dt = cell.frame / parts;
        if (cell.scene.duration / settings.dt * bodies * bodies > most_work) break;
        streak = run(cell, method, settings, parts) <= right ? streak + 1 : 0;
    }
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("What a frame gives, ours and others', on one engine build");
    std::string only, only_method;
    double tolerance = 0.01;
    app.add_option("--scene", only, "this scene only");
    app.add_option("--method", only_method, "this method only");
    app.add_option("--tolerance", tolerance, "of ours");
    CLI11_PARSE(app, argc, argv);

    bool found = false;
    for (const Grid& grid : grids()) {
        if (!only.empty() && grid.name != only) continue;
        for (const double y : grid.y) {
            for (const double frame : frames) {
                double energy = 1;
                Scene scene = grid.scene(frame, y, energy);
                const Cell cell{grid, y, frame, energy, std::move(scene)};
                for (const Method& method : methods) {
                    if (!only_method.empty() && method.name != only_method) continue;
                    found = true;
                    Settings settings{.solver = std::string(World::default_solver),
                                      .method = std::string(method.joint),
                                      .dt = frame};
                    if (method.ours) {
                        settings.tolerance = tolerance;
                        run(cell, method, settings, 0);
                        continue;
                    }
                    if (grid.elastic && method.name == "hinge-motor") continue;
                    for (const std::string_view solver : World::solvers_of_peers) {
                        settings.solver = solver;
                        run_fixed(cell, method, settings);
                    }
                }
            }
        }
    }
    if (!found) throw std::invalid_argument("--scene = " + only + ", --method = " + only_method + ": nothing to run");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
