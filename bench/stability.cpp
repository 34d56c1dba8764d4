// SPDX-License-Identifier: MIT
//
// Where methods fail: scenes with a known answer over grids of step, yield stress or stiffness,
// mass ratio, chain length and iterations, each cell classed (stability/classify.hpp), on one build
// of one engine. bench/stability.py runs the programs of all builds and joins their rows.
//
//   stability-bullet-double [--quick] --list             GRID SOLVER METHOD CELLS, a line per job
//   stability-bullet-double [--quick] --job GRID,SOLVER,METHOD [--from K [--died]]
//                                                        the cells of a job as CSV, from the K-th,
//                                                        which is not run where the program died in
//                                                        it
//
// Columns: scene,engine,solver,precision,method,x_name,x,y_name,y,class,error_rel,energy_gain_rel,
// said,coarse,energy_error_rel,steps
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "engines/world.hpp"
#include "methods/names.hpp"
#include "stability/classify.hpp"

using namespace bench;
using namespace bench::stability;

namespace {

/// Steps × bodies³ of a cell.
constexpr double full_work = 1e7, quick_work = 2e6;

void run_job(const Grid& grid, const std::string& solver, const std::string& method,
             std::size_t from, bool died, double work) {
    std::size_t index = 0;
    for (const double x : grid.x) {
        for (const double y : grid.y) {
            if (index++ < from) continue;
            const bool skip = died && index == from + 1;
            const Settings settings{
                .solver = solver,
                .iterations = grid.over_iterations() ? int(x) : World::default_iterations,
                .method = method,
                .dt = grid.over_iterations() ? step_of_iterations : x};
            const Cell c = skip ? Cell{.verdict = "not-finished"}
                                : run_cell<World>(grid.trial(settings.dt, y), settings, work);
            fmt::print("{},{},{},{},{},{},{:.6g},{},{:.6g},{},{:.6e},{:.6e},{:d},{:d},{:.6e},{}\n",
                       grid.name, World::engine, solver, World::precision, method, grid.x_name, x,
                       grid.y_name, y, c.verdict, c.error, c.energy_gain, c.said, c.coarse,
                       c.energy_error, c.steps);
            std::fflush(stdout);
        }
    }
}

[[nodiscard]] bool rigid(std::string_view method) {
    constexpr std::array<std::string_view, 4> names{"zero-limits", "hinge-motor", "seed-account",
                                                    "plastic-hinge"};
    return std::find(names.begin(), names.end(), method) != names.end();
}

/// Iterations matter to iterative solvers, and to direct ones only where they give up.
bool takes(const SolverName& solver, const Grid& grid) {
    return !grid.over_iterations() || solver.iterations == Iterations::solve;
}

std::string key(const Grid& grid) { return grid.name + "/" + grid.x_name; }

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("Where methods of holding a plastic joint fail, on one engine build");
    bool quick = false, list = false, died = false;
    std::string job;
    std::size_t from = 0;
    app.add_flag("--quick", quick, "coarse grids");
    app.add_flag("--list", list, "print the jobs");
    app.add_option("--job", job, "GRID,SOLVER,METHOD");
    app.add_option("--from", from, "first cell");
    app.add_flag("--died", died, "do not run the first cell");
    CLI11_PARSE(app, argc, argv);

    bool found = false;
    for (const Grid& grid : grids(quick)) {
        for (const SolverName& solver : World::solvers) {
            if (!takes(solver, grid)) continue;
            for (const MethodName& method : method_names) {
                if (!World::has(method.name) || (grid.elastic && rigid(method.name))) continue;
                if (list) {
                    fmt::print("{} {} {} {}\n", key(grid), solver.name, method.name,
                               grid.x.size() * grid.y.size());
                } else if (job == fmt::format("{},{},{}", key(grid), solver.name, method.name)) {
                    found = true;
                    run_job(grid, std::string(solver.name), std::string(method.name), from, died,
                            quick ? quick_work : full_work);
                }
            }
        }
    }
    if (!list && !found) throw std::invalid_argument("--job = " + job + ": no such job");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
