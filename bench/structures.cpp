// SPDX-License-Identifier: MIT
//
// What does a step of one large island cost, and does it stand? Frames of 36 to 1008 joints that
// stand, sleep, fall or have lost a column, and chains of 10 to 1000 joints at rest and struck,
// beside the same bodies with the engine's own fixed joints, and without joints.
//
//   structures-bullet-double [--quick] [--scene NAME] [--csv FILE]
//
// Columns of the CSV:
// engine,precision,solver,scene,method,joints,median_us,worst_us,absorbed_joule, sway_m,warnings.
// Times are CPU times of whole steps of 1/60 s (chains: 1/1000 s), collision and the World's
// account included; methods take their steps in turn. absorbed_joule: of ours, at the end; sway_m:
// the largest way of a beam along x or y while it was measured. ODE: dWorldStep ("direct"), which
// is given up for fixed joints beyond 110, or dWorldQuickStep ("quick").
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cpu_time.hpp"
#ifdef BENCH_ODE
#include "structures/ode_site.hpp"
#else
#include "structures/bullet_site.hpp"
#endif

using namespace bench::structures;

namespace {

struct Scene {
    std::string name;
    Plan plan;
    double dt = 1.0 / 60;
    int before = 60, steps = 120; ///< not measured, and measured
    bool awake = true, loses_column = false;
};

class Bench {
  public:
    Bench(const std::string& csv, std::string only) : only_(std::move(only)) {
        if (!csv.empty()) {
            file_.open(csv);
            if (!file_) throw std::invalid_argument("--csv = " + csv + ": cannot be written");
            file_ << "engine,precision,solver,scene,method,joints,median_us,worst_us,"
                     "absorbed_joule,sway_m,warnings\n";
        }
        fmt::print("{} {}\n{:<8} {:<28} {:<12} {:>7} {:>11} {:>11} {:>12} {:>10} {:>9}\n",
                   Site::engine, Site::precision, "solver", "scene", "method", "joints",
                   "median [us]", "worst [us]", "absorbed [J]", "sway [m]", "warnings");
    }

    /// Median of the elastic method [s].
    double run(const Scene& scene) {
        double ours = 0;
        if (!only_.empty() && scene.name != only_) return ours;
        for (const std::string& solver : Site::solvers()) {
            std::vector<Running> all;
            for (const auto& [method, name] : method_names) {
                if (!Site::sensible(solver, method, scene.plan.joints.size())) continue;
                if (scene.loses_column && method == Method::none) continue;
                all.push_back(
                    {name, std::make_unique<Site>(scene.plan, method, solver, scene.awake)});
            }
            for (Running& each : all) begin(scene, each);
            for (int i = 0; i < scene.steps; ++i) {
                for (Running& each : all) measure(scene, each);
            }
            for (const Running& each : all) {
                const double median = bench::median(each.times);
                if (each.name == "elastic") ours = median;
                report(scene, solver, each, median);
            }
        }
        return ours;
    }

  private:
    struct Running {
        std::string_view name;
        std::unique_ptr<Site> site;
        std::vector<double> times{};
        std::vector<V3> from{};
        double sway = 0;
    };

    static void begin(const Scene& scene, Running& each) {
        for (int i = 0; i < scene.before; ++i) each.site->step(scene.dt);
        if (scene.loses_column) each.site->remove_column();
        for (std::size_t i = 0; i < scene.plan.parts.size(); ++i) {
            each.from.push_back(each.site->position(int(i)));
        }
    }
    static void measure(const Scene& scene, Running& each) {
        const double start = bench::cpu_now();
        each.site->step(scene.dt);
        each.times.push_back(bench::cpu_now() - start);
        for (std::size_t i = 0; i < each.from.size(); ++i) {
            if (!scene.plan.parts[i].beam) continue;
            const V3 way = each.site->position(int(i)) - each.from[i];
            each.sway = std::max({each.sway, std::abs(way.x()), std::abs(way.y())});
        }
    }
    void report(const Scene& scene, const std::string& solver, const Running& each, double median) {
        const double worst = *std::max_element(each.times.begin(), each.times.end());
        const std::size_t joints = scene.plan.joints.size();
        fmt::print("{:<8} {:<28} {:<12} {:>7} {:>11.1f} {:>11.1f} {:>12.4g} {:>10.2e} {:>9}\n",
                   solver, scene.name, each.name, joints, 1e6 * median, 1e6 * worst,
                   each.site->absorbed(), each.sway, each.site->warnings());
        std::fflush(stdout);
        file_ << fmt::format("{},{},{},{},{},{},{:.2f},{:.2f},{:.5g},{:.3g},{}\n", Site::engine,
                             Site::precision, solver, scene.name, each.name, joints, 1e6 * median,
                             1e6 * worst, each.site->absorbed(), each.sway, each.site->warnings());
    }

    std::ofstream file_;
    std::string only_; ///< scene that is wanted; empty: all
};

/// Of a power law through the points, by least squares of the logarithms.
double exponent(const std::vector<std::pair<double, double>>& points) {
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& [count, time] : points) {
        const double u = std::log(count), v = std::log(time);
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const auto n = double(points.size());
    return (n * xy - x * y) / (n * xx - x * x);
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("Cost of a step of structures and chains");
    bool quick = false;
    std::string csv, scene;
    app.add_flag("--quick", quick, "fewer joints and steps");
    app.add_option("--csv", csv, "file to write");
    app.add_option("--scene", scene, "one alone");
    CLI11_PARSE(app, argc, argv);

    Bench bench(csv, scene);
    constexpr double layer = Site::layer;
    const std::vector<int> stories = quick ? std::vector{1, 3} : std::vector{1, 3, 9, 28};
    for (const int frames : stories) {
        const Plan plan = frame({.frames = frames, .layer = layer});
        const int steps = frames > 5 ? 40 : 120;
        bench.run({.name = "standing", .plan = plan, .before = 30, .steps = steps});
        bench.run({.name = "asleep", .plan = plan, .before = 240, .steps = steps, .awake = false});
    }
    bench.run({.name = "column lost",
               .plan = frame({.layer = layer}),
               .steps = 600,
               .loses_column = true});
    bench.run({.name = "column lost and hinges form",
               .plan = frame({.slab = 6000, .layer = layer}),
               .steps = 600,
               .loses_column = true});
    bench.run({.name = "column lost with crates",
               .plan = frame({.crates = 1, .contacts = true, .layer = layer}),
               .before = 0,
               .steps = 600,
               .loses_column = true});
    const int minute = quick ? 600 : 3600;
    bench.run({.name = "loose footings for a minute",
               .plan = frame({.loose = true, .layer = layer}),
               .before = minute / 6,
               .steps = minute - minute / 6});
    bench.run({.name = "two frames for a minute",
               .plan = frame({.frames = 2, .layer = layer}),
               .before = minute / 6,
               .steps = minute - minute / 6});
    bench.run({.name = "two crates a beam for a minute",
               .plan = frame({.crates = 2, .layer = layer}),
               .before = minute / 6,
               .steps = minute - minute / 6});
    for (const double speed : {0.0, 30.0}) {
        std::vector<std::pair<double, double>> points;
        const std::string name = speed > 0 ? "chain struck" : "chain at rest";
        for (const int joints :
             quick ? std::vector{10, 50, 100} : std::vector{10, 30, 50, 100, 300, 1000}) {
            const double median = bench.run({.name = name,
                                             .plan = chain(joints, speed),
                                             .dt = 1e-3,
                                             .before = 20,
                                             .steps = joints > 200 ? 100 : 300});
            points.emplace_back(joints, median);
        }
        if (!scene.empty()) continue;
        fmt::print("{}: elastic, time in proportion to n^{:.2f}\n", name, exponent(points));
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
