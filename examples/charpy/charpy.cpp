// SPDX-License-Identifier: MIT
//
// The Charpy impact test on every engine: a hammer on a pendulum bends a notched steel bar between two
// anvils, and what it loses is plastic moment × hinge angle. Scenario and dimensions: Nikula (2017),
// section 2.2; expected values: reference.hpp.
//
//   charpy                                           every method on every engine
//   charpy --engine ode --method plastic-hinge       one run
//   charpy --frame 0.0001 --plots FOLDER             pictures of the blow, which lasts 8 ms
//   charpy --table FOLDER                            the source's chapter 3 beside ours
//   charpy --help                                    all options with units
//
// Exit status: 0 done, 2 bad input (one line says what), 1 a run failed.
#include <fmt/core.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "options.hpp"
#include "output_file.hpp"
#include "process.hpp"
#include "published_table.hpp"
#include "report.hpp"

namespace {

namespace fs = std::filesystem;
using charpy::BadInput;
using charpy::Options;
using charpy::output_of;
using charpy::OutputFile;
using nlohmann::ordered_json;

/// One row of the table to be.
struct Run {
    std::string engine, precision, solver, method;
};

std::vector<Run> plan(const Options& o) {
    const std::vector<std::string> engines =
        o.engine == "all" ? std::vector<std::string>{"bullet", "ode"} : std::vector{o.engine};
    std::vector<Run> runs;
    for (const std::string& engine : engines) {
        const bool bullet = engine == "bullet";
        const bool of_ode = o.solver == "direct" || o.solver == "quick";
        if (!o.solver.empty() && bullet == of_ode) {
            if (o.engine == "all") continue; // that solver belongs to the other engine
            throw BadInput(fmt::format("--solver = {}: must be {} with --engine {}", o.solver,
                                       bullet ? charpy::bullet_solvers : charpy::ode_solvers,
                                       engine));
        }
        const std::string solver = !o.solver.empty() ? o.solver : bullet ? "mlcp" : "direct";
        for (const auto& method : charpy::method_names) {
            const std::string name(method.second);
            if (o.method != "all" && o.method != name) continue;
            runs.push_back({engine, bullet ? o.precision : "double", solver, name});
        }
    }
    // the whole picture also shows our own joint in the other scalar and with ODE's iterative solver;
    // in Bullet the solver of its island is ours
    if (o.engine == "all" && o.method == "all" && o.solver.empty()) {
        runs.push_back({"bullet", "float", "mlcp", "plastic-hinge"});
        runs.push_back({"ode", "double", "quick", "plastic-hinge"});
    }
    return runs;
}

void write_history(std::ostream& csv, const ordered_json& result, const nlohmann::json& history) {
    const std::string key = fmt::format(
        "{},{},{},{},{},{}", result.at("engine").get<std::string>(),
        result.at("solver").get<std::string>(), result.at("precision").get<std::string>(),
        result.at("method").get<std::string>(), result.at("frame_s").get<double>(),
        result.at("friction").get<double>());
    for (const auto& row : history) {
        csv << key;
        for (const auto& value : row) csv << ',' << value.dump();
        csv << '\n';
    }
}

void print_expected(const charpy::Scenario& s, const charpy::Reference& expected) {
    fmt::print(
        "Charpy impact test: steel {:.0f} MPa, section {:.0f} x {:.0f} mm with a {:.0f} mm notch, "
        "plastic moment {:.1f} N m\n"
        "hammer {:.2f} kg m^2 about its pivot, {:.1f} rad drop, strikes at {:.3f} m/s; friction {:g}\n"
        "expected by mechanics (frictionless, perfectly inelastic): rotation {:.4f} rad, plastic work {:.2f} J, hammer loss "
        "{:.2f} J, halves {:.3f} J\n\n",
        s.yield_stress / 1e6, 1e3 * s.width, 1e3 * s.height, 1e3 * s.notch, s.notched_moment(),
        s.hammer_inertia(), s.start_angle, expected.strike_speed, s.friction, expected.rotation,
        expected.plastic_work, expected.hammer_loss, expected.specimen_kinetic);
}

void draw(const std::string& csv, const std::string& folder) {
    fs::create_directories(folder);
    const std::string text = output_of(CHARPY_PLOT_SCRIPT, {csv, folder});
    fmt::print("{}", text);
}

/// Runs one method on one engine's program. `given`: the user's own options; what this run fixes
/// follows, and the last value of an option counts.
ordered_json run_one(const std::vector<std::string>& given, const Run& r,
                     const std::vector<std::string>& fixed = {}) {
    const fs::path program =
        charpy::own_folder() / fmt::format("charpy-{}-{}", r.engine, r.precision);
    std::vector<std::string> arguments = given;
    for (const std::string& option : {"--engine=" + r.engine, "--precision=" + r.precision,
                                      "--solver=" + r.solver, "--method=" + r.method}) {
        arguments.push_back(option);
    }
    arguments.insert(arguments.end(), fixed.begin(), fixed.end());
    return ordered_json::parse(output_of(program, arguments));
}

/// Writes the published figures beside ours.
int run_published(const Options& options, const std::vector<std::string>& given) {
    std::error_code failed;
    fs::create_directories(options.table, failed);
    if (failed) throw BadInput(fmt::format("--table = {}: cannot be made", options.table));
    const auto file = [&options](const char* name) {
        return (fs::path(options.table) / name).string();
    };
    OutputFile text("--table", file("published.txt"));
    OutputFile markdown("--table", file("published.md"));
    OutputFile csv("--table", file("published.csv"));

    const auto parts = charpy::published_plan(options.scenario);
    std::size_t count = 0, done = 0;
    for (const charpy::PublishedPart& part : parts) count += part.runs.size();
    for (const charpy::PublishedPart& part : parts) {
        const charpy::TextTable table = charpy::published_table(
            part, options.scenario, [&](const charpy::PublishedRun& wanted) {
                const auto& [engine, precision, solver] = wanted.block;
                const Run r{engine, precision, solver, std::string(to_string(wanted.method))};
                fmt::print(stderr, "[{:>3}/{}] {} {} {} {} {}\n", ++done, count, r.engine,
                           r.precision, r.solver, r.method, wanted.step);
                return run_one(given, r, wanted.options).at("result");
            });
        fmt::print("{}\n", table.text());
        text.stream() << table.text() << '\n';
        markdown.stream() << table.markdown() << '\n';
        csv.stream() << table.csv(&part == &parts.front());
    }
    text.finish();
    markdown.finish();
    csv.finish();
    return 0;
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app("Charpy impact test on Bullet and ODE: what a hammer loses by bending a steel bar.\n"
                 "Without options: every method on every engine.");
    charpy::declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        fmt::print("{}", app.help());
        return 0;
    } catch (const CLI::ParseError& error) {
        throw BadInput(charpy::one_line(error));
    }
    charpy::finish(options);
    charpy::require_effect(app, options);
    const std::vector<Run> runs = plan(options);
    const std::vector<std::string> given(argv + 1, argv + argc);
    if (!options.ccd.empty()) {
        fmt::print("--ccd {}: no effect, contacts come from exact geometry before surfaces meet\n",
                   options.ccd);
    }
    if (!options.table.empty()) return run_published(options, given);

    OutputFile json("--json", options.json);
    const bool draws = !options.plots.empty();
    const std::string csv_path =
        options.csv.empty() && draws ? (fs::path(options.plots) / "history.csv").string() : options.csv;
    if (draws) {
        std::error_code failed;
        fs::create_directories(options.plots, failed);
        if (failed) throw BadInput(fmt::format("--plots = {}: cannot be made", options.plots));
    }
    OutputFile csv("--csv", csv_path);
    if (csv) csv.stream() << charpy::history_header << '\n';

    const charpy::Reference expected = charpy::reference(options.scenario);
    print_expected(options.scenario, expected);
    auto results = ordered_json::array();
    std::string table;
    int failures = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run& r = runs[i];
        fmt::print(stderr, "[{:>2}/{}] {} {} {} {} ... ", i + 1, runs.size(), r.engine, r.precision,
                   r.solver, r.method);
        const auto start = std::chrono::steady_clock::now();
        try {
            const ordered_json document = run_one(given, r);
            results.push_back(document.at("result"));
            table += charpy::table_row(
                document.at("result"),
                charpy::reference(options.scenario, charpy::method_of(r.method)));
            if (csv) write_history(csv.stream(), document.at("result"), document.at("history"));
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
            fmt::print(stderr, "{:.2f} s\n", taken.count());
        } catch (const std::exception& error) {
            ++failures;
            fmt::print(stderr, "failed: {}\n", error.what());
        }
    }
    fmt::print("\n{}{}", charpy::table_header(), table);
    fmt::print("\nplastic work of the engines' own joints: all that the joint took from the bodies\n");
    if (json) json.stream() << results.dump(2) << '\n';
    json.finish();
    csv.finish();
    if (draws) draw(csv_path, options.plots);
    return failures == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) try {
    return run(argc, argv);
} catch (const std::exception& error) {
    fmt::print(stderr, "charpy: {}\n", error.what());
    return 2;
}
