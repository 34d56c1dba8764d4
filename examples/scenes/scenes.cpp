// SPDX-License-Identifier: MIT
//
// Scenes to look at: each prints what must come out beside what came out, and leaves its replay.
//
//   scenes --out FOLDER          all of them, in both engines
//   scenes frame --engine ode --frame 0.0041667
//
// Exit status 1 where something did not come out as it must.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files.hpp"
#include "scene.hpp"
#include "write_glb.hpp"
#include "write_html.hpp"
#include "write_index.hpp"

using namespace ductile::scenes;

namespace {

struct Costs {
    double median = 0, mean = 0; ///< of a frame [s]
    double late = 0;             ///< most that a clock of real time would be ahead [s]
    Run::Cost dearest;
};
Costs costs_of(const Run& run) {
    std::vector<Run::Cost> frames = run.costs();
    if (frames.empty()) return {};
    double sum = 0, late = 0, latest = 0;
    for (const Run::Cost& frame : frames) {
        sum += frame.time;
        late = std::max(late + frame.time - run.options().frame, 0.0);
        latest = std::max(latest, late);
    }
    std::sort(frames.begin(), frames.end(),
              [](const Run::Cost& a, const Run::Cost& b) { return a.time < b.time; });
    return {frames[frames.size() / 2].time, sum / double(frames.size()), latest, frames.back()};
}

/// What a run cost, as a line of measured.csv.
std::string measured(const Run& run, const std::filesystem::path& out) {
    const Costs costs = costs_of(run);
    const auto largest = [&](const char* kind) {
        std::uintmax_t most = 0;
        for (const std::string& replay : run.replays()) {
            std::error_code none; // is not there
            const auto file = (out / replay).replace_extension(kind);
            const std::uintmax_t size = std::filesystem::file_size(file, none);
            if (!none) most = std::max(most, size);
        }
        return most;
    };
    return fmt::format("{},{},{:.6g},{},{:.3f},{:.3f},{:.2f},{},{:.2f},{},{},{}\n", run.scene(),
                       run.options().engine, run.options().frame, run.costs().size(),
                       1e3 * costs.median, 1e3 * costs.mean, 1e3 * costs.dearest.time,
                       costs.dearest.solves, 1e3 * costs.late, run.replays().size(),
                       largest("html"), largest("glb"));
}

void print(const Run& run) {
    for (const Finding& f : run.findings()) {
        const std::string unit = f.unit.empty() ? "" : " " + f.unit;
        if (f.expected) {
            fmt::print("  {} {:<44} {:>12.6g}{}, must be {:.6g} within {:g}{}\n",
                       f.right() ? "ok   " : "WRONG", f.what, f.came_out, unit, *f.expected,
                       *f.expected == 0 ? f.within : 100 * f.within,
                       *f.expected == 0 ? unit : " %");
        } else {
            fmt::print("        {:<44} {:>12.6g}{}\n", f.what, f.came_out, unit);
        }
    }
    for (const std::string& take : run.doubted()) {
        fmt::print("        {}: its World does not vouch for it\n", take);
    }
    if (run.costs().empty()) return;
    const Costs costs = costs_of(run);
    fmt::print(
        "        a frame of {:.2f} ms took {:.3f} ms at the median, {:.3f} ms at the mean, "
        "{:.2f} ms at most, in {} solves; {:.1f} ms late at most\n",
        1e3 * run.options().frame, 1e3 * costs.median, 1e3 * costs.mean, 1e3 * costs.dearest.time,
        costs.dearest.solves, 1e3 * costs.late);
}

/// Says what is wrong with a text that is no number from `low` to `high`, as nan is none.
auto within(double low, double high) {
    return [low, high](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool number = end != text.c_str() && *end == '\0';
        if (number && value >= low && value <= high) return std::string();
        return fmt::format("{}: must be from {} to {}", text, low, high);
    };
}

} // namespace

int main(int argc, char** argv) try {
    const std::vector<std::unique_ptr<Scene>> scenes = all_scenes();

    CLI::App app("Scenes to look at, with what must come out");
    RunOptions options;
    std::filesystem::path out;
    bool glb = false;
    std::string engine = "both";
    app.add_option("--engine", engine)
        ->check(CLI::IsMember({"bullet", "ode", "both"}))
        ->capture_default_str();
    app.add_option("--frame", options.frame, "[s]")
        ->check(within(1e-5, 0.1))
        ->capture_default_str();
    app.add_option("--tolerance", options.tolerance, "of frames, 0: steps as they are [-]")
        ->check(within(0, 0.5))
        ->capture_default_str();
    app.add_option("--budget", options.budget, "solves of a frame [-]")
        ->check(CLI::Range(4, 100000))
        ->capture_default_str();
    app.add_option("--part", options.part,
                   "of the one scene; none: all that is no part of one's own");
    app.add_option("--out", out, "folder of the replays and index.html; none: no replays");
    app.add_flag("--glb", glb, "replays as glTF too");
    app.require_subcommand(0, scenes.size());
    app.fallthrough();
    for (const auto& scene : scenes) {
        CLI::App& command = *app.add_subcommand(scene->name(), scene->about());
        for (const Option& option : scene->options()) {
            command
                .add_option("--" + option.name, *option.value,
                            option.about + " [" + option.unit + "]")
                ->check(within(option.low, option.high))
                ->capture_default_str();
        }
    }
    app.failure_message(
        [](const CLI::App*, const CLI::Error& error) { return std::string(error.what()) + '\n'; });
    CLI11_PARSE(app, argc, argv);

    if (!out.empty()) write_index({}, out); // fails sooner than after all of them
    bool right = true;
    std::string costs =
        "scene,engine,frame_s,frames,median_ms,mean_ms,dearest_ms,dearest_solves,late_ms,replays,"
        "largest_html_B,largest_glb_B\n";
    std::vector<Shown> shown;
    const bool all = app.get_subcommands().empty();
    for (const auto& scene : scenes) {
        if (!all && !app.got_subcommand(scene->name())) continue;
        scene->require_part(options.part);
        for (const char* of : {"bullet", "ode"}) {
            if (engine != "both" && engine != of) continue;
            fmt::print("{} ({}): {}\n", scene->name(), of, scene->about());
            std::fflush(stdout);
            options.engine = of;
            if (!out.empty()) {
                options.keep = [&](const std::string& name,
                                   const ductile::replay::Recording& seen) {
                    std::string file = scene->name() + "-" + name + "-" + of + ".html";
                    std::erase(file, ',');
                    std::replace(file.begin(), file.end(), ' ', '-');
                    ductile::replay::write_html(seen, out / file);
                    if (glb) {
                        ductile::replay::write_glb(
                            seen, std::filesystem::path(out / file).replace_extension("glb"));
                    }
                    return file;
                };
            }
            Run run(scene->name(), options);
            scene->play(run);
            print(run);
            std::fflush(stdout);
            right = right && run.right();
            costs += measured(run, out);
            shown.push_back({scene->about(), of, std::move(run)});
        }
    }
    if (!out.empty()) {
        ductile::replay::write_file(out / "measured.csv", costs);
        write_index(shown, out);
        fmt::print("open {}\n", (out / "index.html").string());
    }
    return right ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
