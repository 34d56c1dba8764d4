// SPDX-License-Identifier: MIT
//
// Is the detail that the core chooses for a tolerance within it, and is it the cheapest that is?
// Every scene of scenes/detail_case.hpp on one build of one engine, at 10, 3 and 1 %: the chosen
// model at the chosen step, and every other model at the longest step from which on every finer one
// keeps the tolerance. Those steps are looked at 15 % apart (20 % with --quick), from a game's step
// down to a third of the finest that the core chose: errors that happen to change sign do not
// count.
//
//   detail-ode-double [--quick] [--scene NAME]     rows as CSV on the standard output
//   detail-ode-double --reasons                    why the core chose what it chose, as text
//
// Columns: scene,engine,precision,tolerance,detail,chosen,joints,dt_s,error_rel,cpu_s_per_sim_s,
// meets,cost_ratio,row_steps,count_ratio,unreliable_steps. A model that never keeps the tolerance
// has its finest step here. cost_ratio: CPU time over that of the cheapest model that meets;
// count_ratio the same for row_steps, steps × six rows per joint, which repeats exactly.
#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "engines/run_scene.hpp"
#include "engines/world.hpp"
#include "scenes/detail_case.hpp"

using namespace bench;

namespace {

constexpr double tolerances[] = {0.1, 0.03, 0.01};

struct Plan {
    double ratio;    ///< of a step to the next finer one
    int starts;      ///< within a step, where there is a contact
    int repeats;     ///< of the timing
    double at_least; ///< CPU time of all repeats of a row [s]
};
constexpr Plan full{1.15, 8, 5, 0.05}, quick_plan{1.2, 5, 3, 0.003};

Settings settings(const Model& model, double dt, double first = 0) {
    return {.solver = std::string(World::exact_solver),
            .iterations = 200,
            .method = model.method,
            .dt = dt,
            .first = first};
}

/// A step, and when in it the first one begins [s].
struct Start {
    double dt, first;
};

/// A model at a step: how far off it is.
struct Trial {
    double dt = 0;
    double error = infinity;
    long steps = 0, unreliable = 0;
    double time = 0; ///< simulated [s]
};

Trial run_once(const Model& model, double dt, double first, double answer) {
    Quantity quantity = model.scene.quantities.front();
    quantity.expected = answer;
    const RunResult run = observe<World>(model.scene, settings(model, dt, first));
    return {dt, relative_error(quantity, run).value_or(infinity), run.steps, run.unreliable_steps,
            run.end.time};
}

/// Each in a process of its own, as many at once as there are cores: an engine's assertion ends
/// that one, and the model counts as wrong.
std::vector<Trial> run_apart(const Model& model, const std::vector<Start>& starts, double answer) {
    static_assert(std::is_trivially_copyable_v<Trial>);
    struct Child {
        pid_t process;
        int told;
    };
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    std::vector<Trial> trials;
    for (std::size_t from = 0; from < starts.size(); from += cores) {
        std::vector<Child> children;
        for (std::size_t i = from; i < std::min(from + cores, starts.size()); ++i) {
            int ends[2];
            if (pipe(ends) != 0) throw std::runtime_error("detail: no pipe");
            const pid_t child = fork();
            if (child < 0) throw std::runtime_error("detail: no process");
            if (child == 0) {
                const Trial trial = run_once(model, starts[i].dt, starts[i].first, answer);
                _exit(write(ends[1], &trial, sizeof trial) == sizeof trial ? 0 : 1);
            }
            close(ends[1]);
            children.push_back({child, ends[0]});
        }
        for (const Child& child : children) {
            Trial trial;
            if (read(child.told, &trial, sizeof trial) != sizeof trial) {
                trial = {.dt = starts[trials.size()].dt, .steps = 1, .time = 1};
            }
            close(child.told);
            waitpid(child.process, nullptr, 0);
            trials.push_back(trial);
        }
    }
    return trials;
}

/// Errors of a model at these steps. The worst of several starts spread over a step where there is
/// a contact: it falls anywhere in a step, and no one can count on where.
std::vector<Trial> attempts(const Model& model, const std::vector<double>& steps, double answer,
                            const Plan& plan) {
    const int count = model.scene.contacts.empty() ? 1 : plan.starts;
    std::vector<Start> starts;
    for (const double dt : steps) {
        for (int i = 0; i < count; ++i) starts.push_back({dt, i * dt / count});
    }
    std::vector<Trial> worst;
    for (const Trial& trial : run_apart(model, starts, answer)) {
        if (worst.empty() || worst.back().dt != trial.dt) {
            worst.push_back(trial);
            continue;
        }
        worst.back().error = std::max(worst.back().error, trial.error);
        worst.back().unreliable = std::max(worst.back().unreliable, trial.unreliable);
    }
    return worst;
}

/// Errors of a model over the step, longest first.
std::vector<Trial> ladder(const Model& model, double answer, double finest, const Plan& plan) {
    std::vector<double> steps;
    for (double dt = longest_step; dt >= finest; dt /= plan.ratio) steps.push_back(dt);
    return attempts(model, steps, answer, plan);
}

/// The longest step from which on every finer one keeps the tolerance; else the finest.
const Trial& reaches(const std::vector<Trial>& trials, double tolerance) {
    std::size_t good = trials.size();
    while (good > 0 && trials[good - 1].error <= tolerance) --good;
    return trials[std::min(good, trials.size() - 1)];
}

struct Row {
    std::string detail;
    bool chosen;
    int joints;
    Trial trial;
    double cpu;  ///< per simulated second [-]
    double cost; ///< the same in yardsticks [1/s]

    [[nodiscard]] double row_steps() const { return 6.0 * joints * double(trial.steps); }
};

Row row(const Model& model, const Trial& trial, bool chosen, const Plan& plan) {
    if (!std::isfinite(trial.error))
        return {model.detail, chosen, model.joints, trial, infinity, infinity};
    const Cost spent = cost_of<World>(model.scene, settings(model, trial.dt), trial.steps,
                                      plan.repeats, plan.at_least);
    return {model.detail,           chosen,
            model.joints,           trial,
            spent.cpu / trial.time, spent.steps() / trial.time};
}

void print(const DetailCase& c, double tolerance, const std::vector<Row>& rows) {
    double cheapest = infinity, fewest = infinity;
    for (const Row& r : rows) {
        if (!(r.trial.error <= tolerance)) continue;
        cheapest = std::min(cheapest, r.cost);
        fewest = std::min(fewest, r.row_steps() / r.trial.time);
    }
    for (const Row& r : rows) {
        fmt::print("{},{},{},{},{},{:d},{},{:.9e},{:.9e},{:.6e},{:d},{:.3f},{:.0f},{:.3f},{}\n",
                   c.name, World::engine, World::precision, tolerance, r.detail, r.chosen, r.joints,
                   r.trial.dt, r.trial.error, r.cpu, r.trial.error <= tolerance, r.cost / cheapest,
                   r.row_steps(), r.row_steps() / r.trial.time / fewest, r.trial.unreliable);
    }
    std::fflush(stdout);
}

const Model& model_of(const DetailCase& c, const Chosen& chosen) {
    for (const Model& model : c.models) {
        if (model.detail == chosen.detail && model.joints == chosen.joints) return model;
    }
    throw std::runtime_error(fmt::format("{}: {} with {} joints was chosen and is not there",
                                         c.name, chosen.detail, chosen.joints));
}

void run(const DetailCase& c, const Plan& plan) {
    std::vector<Chosen> choices;
    double finest = longest_step;
    for (const double tolerance : tolerances) {
        choices.push_back(c.choose(tolerance));
        finest = std::min(finest, choices.back().dt / 3);
    }
    const double answer =
        c.answer
            ? *c.answer
            : c.models.back()
                  .scene.quantities.front()
                  .value(
                      observe<World>(c.models.back().scene, settings(c.models.back(), c.fine)).end)
                  .value();
    std::vector<std::vector<Trial>> ladders;
    for (const Model& model : c.models) ladders.push_back(ladder(model, answer, finest, plan));
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const Model& model = model_of(c, choices[i]);
        std::vector<Row> rows{
            row(model, attempts(model, {choices[i].dt}, answer, plan).front(), true, plan)};
        for (std::size_t k = 0; k < c.models.size(); ++k) {
            rows.push_back(row(c.models[k], reaches(ladders[k], tolerances[i]), false, plan));
        }
        print(c, tolerances[i], rows);
    }
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("The detail chosen by tolerance against every other one, on one engine build");
    bool quick = false, reasons = false;
    std::string only;
    app.add_flag("--quick", quick, "fewer models and repeats");
    app.add_flag("--reasons", reasons, "print the reasons of the choices instead");
    app.add_option("--scene", only, "this scene only");
    CLI11_PARSE(app, argc, argv);

    bool found = false;
    for (const DetailCase& c : detail_cases(quick)) {
        if (!only.empty() && c.name != only) continue;
        found = true;
        if (reasons) {
            for (const double tolerance : tolerances) {
                const Chosen chosen = c.choose(tolerance);
                fmt::print("{},{},{}\n", c.name, tolerance, chosen.reason);
            }
        } else {
            run(c, quick ? quick_plan : full);
        }
    }
    if (!found) throw std::invalid_argument("--scene = " + only + ": no such scene");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
