// SPDX-License-Identifier: MIT
//
// What does one joint cost beside the engine's own? World step minus the step of the same bodies
// without joints, per joint, medians of rounds in which all joints are measured in turn.
//
//   joint_cost-bullet-double [--quick] [--csv FILE]
//
// Columns of the CSV: engine,precision,joint,count,islands,ns_per_joint_step,ns_bodies_only; the
// last is the bodies' step without joints, per joint. islands is 1 (a chain) or count (pairs).
// Bullet: sequential impulse, ten iterations; its island callback looks at every constraint for
// every island, which is most of the cost of 10,000 pairs for any joint. ODE: dWorldStep for pairs,
// dWorldQuickStep with twenty iterations for a chain.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#ifdef BENCH_ODE
#include "cost/ode_field.hpp"
#else
#include "cost/bullet_field.hpp"
#endif
#include "cost/measure.hpp"

using namespace bench::cost;

int main(int argc, char** argv) try {
    CLI::App app("Cost of a joint per step, beside the engine's own joints");
    bool quick = false;
    std::string csv;
    app.add_flag("--quick", quick, "fewer joints and rounds");
    app.add_option("--csv", csv, "file to write");
    CLI11_PARSE(app, argc, argv);

    std::ofstream file;
    if (!csv.empty()) {
        file.open(csv);
        if (!file) throw std::invalid_argument("--csv = " + csv + ": cannot be written");
        file << "engine,precision,joint,count,islands,ns_per_joint_step,ns_bodies_only\n";
    }
    fmt::print("{} {}\n{:<14} {:>7} {:>8} {:>18} {:>15} {:>12}\n", Field::engine, Field::precision,
               "joint", "count", "islands", "ns per joint step", "ns bodies only", "/hinge-motor");
    const std::vector<int> counts = quick ? std::vector{100, 1000} : std::vector{100, 1000, 10000};
    for (const bool chain : {true, false}) {
        for (const int count : counts) {
            std::vector<std::unique_ptr<Field>> fields;
            std::vector<std::string_view> names;
            for (const auto& [joint, name] : joint_names) {
                if (!Field::has(joint)) continue;
                fields.push_back(std::make_unique<Field>(
                    FieldSettings{.joint = joint,
                                  .count = count,
                                  .set_up = chain ? SetUp::chain : SetUp::pairs,
                                  .weak_every = chain ? 0 : 1,
                                  .direct = !chain}));
                names.push_back(name);
            }
            const auto times = step_times(fields, quick ? 7 : 21, quick ? 2e-3 : 1e-2);
            const double bodies = times.front();
            double motor = 0;
            for (std::size_t i = 0; i < names.size(); ++i) {
                if (names[i] == "hinge-motor") motor = times[i] - bodies;
            }
            for (std::size_t i = 1; i < names.size(); ++i) {
                const double joint = 1e9 * (times[i] - bodies) / count;
                const int islands = chain ? 1 : count;
                fmt::print("{:<14} {:>7} {:>8} {:>18.1f} {:>15.1f} {:>12.2f}\n", names[i], count,
                           islands, joint, 1e9 * bodies / count, (times[i] - bodies) / motor);
                std::fflush(stdout);
                file << fmt::format("{},{},{},{},{},{:.2f},{:.2f}\n", Field::engine,
                                    Field::precision, names[i], count, islands, joint,
                                    1e9 * bodies / count);
            }
        }
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
