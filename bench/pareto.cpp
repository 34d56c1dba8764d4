// SPDX-License-Identifier: MIT
//
// What accuracy costs: every scene with a known answer × every method × solver × step × iterations
// on one build of one engine; errors and CPU time as CSV on the standard output. Bullet's float and
// double libraries share their symbols, so each engine build has a program of its own;
// bench/pareto.py runs them, joins their rows and adds instructions.
//
//   pareto-bullet-double [--quick] [--scene NAME]       all rows
//   pareto-bullet-double [--quick] --list               the rows with their steps, not run
//   pareto-bullet-double --scene NAME --row SOLVER,METHOD,DT,TOLERANCE,ITERATIONS
//                                                       one run without observation, for callgrind
//
// Columns: scene,engine,solver,precision,method,dt_s,tolerance,iterations,quantity,error_rel,
// cpu_s_per_sim_s,yardstick_s,steps,unreliable_steps; before them lines with a point and the number
// of passes, one for each row and pass. yardstick_s is what a step of the same
// bodies took at that time (run_scene.hpp). tolerance: of a World whose frames are of dt_s; 0 for
// fixed steps; iterations of Bullet's mlcp are those of its fallback, 0 where there are none.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "engines/run_scene.hpp"
#include "engines/world.hpp"
#include "methods/names.hpp"
#include "scenes/all.hpp"

using namespace bench;

namespace {

struct Plan {
    std::vector<double> steps;
    std::vector<double> tolerances, frames; ///< of ours in a World with a tolerance
    std::vector<int> iterations;            ///< of iterative solvers
    std::vector<int> fallback;              ///< of direct solvers where they give up
    long longest = 0;                       ///< runs of more steps are left out
    int passes = 3;      ///< over all rows of a scene, in each of which every one is timed
    double at_least = 0; ///< CPU time of a row in a pass [s]
};

const Plan full{
    {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5},
    {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003},
    {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240},
    {4, 10, 50, 200},
    {10, 200},
    20000,
    4,
    0.004};
const Plan quick{{1.0 / 60, 1.0 / 240, 1e-3, 5e-4, 2e-4, 1e-4, 2e-5},
                 {0.1, 0.01, 0.001},
                 {1.0 / 60},
                 {10, 50},
                 {200},
                 8000,
                 3,
                 0.001};

std::vector<int> iterations_of(const SolverName& solver, const Plan& plan) {
    switch (solver.iterations) {
        case Iterations::none:
            return {0};
        case Iterations::fallback:
            return plan.fallback;
        case Iterations::solve:
            return plan.iterations;
    }
    return {};
}

/// Without a stiffness elastic-plastic would be plastic-hinge once more.
bool stands_for(const MethodName& method, const Scene& scene) {
    return method.name != "elastic-plastic" ||
           std::any_of(scene.joints.begin(), scene.joints.end(),
                       [](const JointSpec& joint) { return std::isfinite(joint.stiffness); });
}

/// Every run of a scene on this engine build.
std::vector<Settings> rows(const Scene& scene, const Plan& plan) {
    std::vector<Settings> result;
    for (const SolverName& solver : World::solvers) {
        for (const int iterations : iterations_of(solver, plan)) {
            for (const MethodName& method : method_names) {
                if (!World::has(method.name) || !stands_for(method, scene)) continue;
                Settings row{.solver = std::string(solver.name),
                             .iterations = iterations,
                             .method = std::string(method.name)};
                for (const double dt : plan.steps) {
                    row.dt = dt;
                    if (scene.duration / dt <= double(plan.longest)) result.push_back(row);
                }
            }
        }
    }
    if (!World::has_frames) return result;
    for (const MethodName& method : method_names) {
        if (!method.ours || !stands_for(method, scene)) continue;
        for (const double tolerance : plan.tolerances) {
            for (const double frame : plan.frames) {
                result.push_back({.solver = std::string(World::exact_solver),
                                  .method = std::string(method.name),
                                  .dt = frame,
                                  .tolerance = tolerance});
            }
        }
    }
    return result;
}

std::string name(const Settings& row) {
    return row.method + (row.in_frames() ? std::string(frames_suffix) : "");
}

/// The run of a row's name; its other fields are set by the caller.
Settings named(const std::string& method) {
    Settings row;
    row.method = method;
    if (method.ends_with(frames_suffix)) row.method.resize(method.size() - frames_suffix.size());
    return row;
}

/// A row as it was observed, and what it cost in each pass so far.
struct Measured {
    Settings row;
    RunResult result;
    std::vector<Cost> costs;

    /// The median, by what they are in yardsticks.
    [[nodiscard]] Cost cost() const {
        std::vector<Cost> sorted = costs;
        const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
        std::nth_element(sorted.begin(), middle, sorted.end(),
                         [](const Cost& a, const Cost& b) { return a.steps() < b.steps(); });
        return *middle;
    }
};

void print(const Scene& scene, const Measured& measured) {
    const auto& [row, result, costs] = measured;
    const Cost cost = measured.cost();
    for (const Quantity& quantity : scene.quantities) {
        const auto error = relative_error(quantity, result);
        if (!error) continue;
        fmt::print("{},{},{},{},{},{:.9e},{},{},{},{:.9e},{:.6e},{:.6e},{},{}\n", scene.name,
                   World::engine, row.solver, World::precision, name(row), row.dt, row.tolerance,
                   row.iterations, quantity.name, *error, cost.cpu / result.end.time,
                   cost.yardstick, result.steps, result.unreliable_steps);
    }
}

/// A line with a point tells of every row that was timed in a pass. What disturbs the machine for a
/// while disturbs a row in one pass only.
void run(const Scene& scene, const Plan& plan) {
    std::vector<Measured> all;
    for (const Settings& row : rows(scene, plan)) all.push_back({row, {}, {}});
    for (int pass = 0; pass < plan.passes; ++pass) {
        for (Measured& one : all) {
            if (pass == 0) one.result = observe<World>(scene, one.row);
            one.costs.push_back(cost_of<World>(scene, one.row, one.result.steps, 1, plan.at_least));
            fmt::print(". {}\n", plan.passes);
            std::fflush(stdout);
        }
    }
    for (const Measured& one : all) print(scene, one);
}

/// One run's steps, for a tool that counts them.
void run_once(const Scene& scene, const Settings& row) {
    const long steps = observe<World>(scene, row).steps;
    World world(scene, row);
    Stepping stepping(scene, row);
    bench_steps(world, stepping, steps);
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("Accuracy and cost of plastic joints on one engine build");
    bool is_quick = false, list = false;
    std::string only, single;
    app.add_flag("--quick", is_quick, "fewer steps, iterations and repeats");
    app.add_flag("--list", list, "print the rows instead of running them");
    app.add_option("--scene", only, "this scene only");
    app.add_option("--row", single, "SOLVER,METHOD,DT,TOLERANCE,ITERATIONS: its steps once");
    CLI11_PARSE(app, argc, argv);
    const Plan& plan = is_quick ? quick : full;

    bool found = false;
    for (const Scene& scene : all_scenes()) {
        if (!only.empty() && scene.name != only) continue;
        found = true;
        if (!single.empty()) {
            const auto fields = CLI::detail::split(single, ',');
            if (fields.size() != 5)
                throw std::invalid_argument("--row = " + single + ": five fields");
            Settings row = named(fields[1]);
            row.solver = fields[0];
            row.dt = std::stod(fields[2]);
            row.tolerance = std::stod(fields[3]);
            row.iterations = std::stoi(fields[4]);
            run_once(scene, row);
            continue;
        }
        if (!list) {
            run(scene, plan);
            continue;
        }
        for (const Settings& row : rows(scene, plan)) {
            fmt::print("{},{},{},{:.9e},{},{},{}\n", scene.name, row.solver, name(row), row.dt,
                       row.tolerance, row.iterations, long(scene.duration / row.dt));
        }
    }
    if (!found) throw std::invalid_argument("--scene = " + only + ": no such scene");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
