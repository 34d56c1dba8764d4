// SPDX-License-Identifier: MIT
//
// The source's chapter 3 run again: every method on every engine and scalar, frames of four lengths
// where it has five steps, and its break at a largest plastic rotation, each beside the published
// figure with a line on why it is right or wrong.
#pragma once

#include <fmt/core.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "published.hpp"
#include "report.hpp"
#include "text_table.hpp"

namespace charpy {

/// One engine build with one solver.
struct Block {
    std::string engine, precision, solver;
};

/// What to run for one row.
struct PublishedRun {
    Block block;
    Method method = Method::rigid;
    std::vector<std::string> options; ///< beyond engine, scalar, solver and method
    std::string step;                 ///< of frames their length [ms]
    std::string says;                 ///< the published figure
    double max_plastic_rotation = std::numeric_limits<double>::infinity(); ///< [rad]
};

struct PublishedPart {
    std::string title;
    std::vector<PublishedRun> runs;
};

[[nodiscard]] inline std::vector<PublishedPart> published_plan(const Scenario& s) {
    const std::vector<Block> blocks{{"bullet", "double", "mlcp"},
                                    {"ode", "double", "direct"},
                                    {"bullet", "float", "mlcp"},
                                    {"bullet", "float", "si"}};
    const std::string frame = fmt::format("{:.2f}", 1e3 * s.frame);
    PublishedPart methods{fmt::format("All methods, friction {:g}", s.friction), {}};
    PublishedPart frames{"Frames of 1/240 to 1/30 s beside the steps of table 3.1", {}};
    PublishedPart breaks{fmt::format("Largest plastic rotation {:g} rad", published_break_rotation), {}};
    for (const Block& block : blocks) {
        const bool ours = block.solver != "si"; // of our joints the island's solver is ours
        for (const Published& p : published) {
            if (is_plastic(p.method) && !ours) continue;
            methods.runs.push_back({.block = block,
                                    .method = p.method,
                                    .options = {},
                                    .step = is_plastic(p.method) ? frame : "follows the blow",
                                    .says = std::string(p.says)});
        }
        if (!ours) continue;
        for (const Method method :
             {Method::plastic_hinge, Method::elastic_plastic, Method::elastic_plastic_2}) {
            for (const double length : {1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30}) {
                frames.runs.push_back({.block = block,
                                       .method = method,
                                       .options = {fmt::format("--frame={}", length)},
                                       .step = fmt::format("{:.2f}", 1e3 * length),
                                       .says = std::string(published_steps)});
            }
            breaks.runs.push_back(
                {.block = block,
                 .method = method,
                 .options = {fmt::format("--max-plastic-rotation={}", published_break_rotation)},
                 .step = frame,
                 .says = std::string(published_break_loss),
                 .max_plastic_rotation = published_break_rotation});
        }
    }
    return {methods, frames, breaks};
}

/// `run` makes one run and returns its result as JSON.
[[nodiscard]] inline TextTable published_table(
    const PublishedPart& part, Scenario scenario,
    const std::function<nlohmann::ordered_json(const PublishedRun&)>& run) {
    TextTable table{part.title,
                    {"engine", "solver", "scalar", "method", "step ms", "hammer loss J",
                     "plastic work J", "expected J", "believed", "published J", "right", "why"},
                    {}};
    for (const PublishedRun& wanted : part.runs) {
        scenario.max_plastic_rotation = wanted.max_plastic_rotation;
        const nlohmann::ordered_json r = run(wanted);
        const Reference expected = reference(scenario, wanted.method);
        const Judgement judged = judge(wanted.method, r, expected);
        const auto joules = [&r](const char* key) {
            return r.at(key).is_number() ? fmt::format("{:.2f}", r.at(key).get<double>()) : "-";
        };
        table.rows.push_back({wanted.block.engine, wanted.block.solver, wanted.block.precision,
                              std::string(to_string(wanted.method)), wanted.step,
                              joules("hammer_loss_J"), joules("plastic_work_J"),
                              wanted.method == Method::rigid
                                  ? std::string("-")
                                  : fmt::format("{:.2f}", expected.plastic_work),
                              !is_plastic(wanted.method)        ? "-"
                              : r.at("believed").get<bool>() ? "yes"
                                                             : "no",
                              wanted.says,
                              judged.right ? "yes" : "no", judged.why});
    }
    return table;
}

} // namespace charpy
