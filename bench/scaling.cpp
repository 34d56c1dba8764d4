// SPDX-License-Identifier: MIT
//
// What do many joints cost? A step of 10 to 100,000 pairs of bodies, with no joint, the engine's
// hinge with a motor and ours, where none, one in a hundred or all of them yield; and the memory of
// a joint.
//
//   scaling-bullet-double [--quick] [--csv FILE]
//
// Columns of the CSV: engine,precision,solver,method,joints,split_islands,yielding,ns_per_step,
// ns_per_joint_step,bytes_sizeof,bytes_heap. bytes_heap is what making and adding the joint took
// from the allocator, the object itself included. Bullet's island callback is
// O(islands × constraints): split_islands 0 is setSplitIslands(false), and split fields stop at
// 1,000 pairs.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
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

namespace {

struct Case {
    Joint joint;
    std::string_view method;
    int weak_every;
    double yielding;
};

constexpr int most_split_pairs = 1000;

/// `large`: of 100,000 pairs none yields, or all do.
std::vector<Case> cases(bool large) {
    std::vector<Case> result;
    for (const auto& [joint, name] : joint_names) {
        const bool wanted = joint != Joint::spring2 && joint != Joint::fixed;
        if (!wanted || !Field::has(joint)) continue;
        result.push_back({joint, name, 0, 0});
        if (joint == Joint::none) continue;
        if (!large) result.push_back({joint, name, 100, 0.01});
        result.push_back({joint, name, 1, 1});
    }
    return result;
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("Cost of a step of many joints");
    bool quick = false;
    std::string csv;
    app.add_flag("--quick", quick, "fewer joints and rounds");
    app.add_option("--csv", csv, "file to write");
    CLI11_PARSE(app, argc, argv);

    std::ofstream file;
    if (!csv.empty()) {
        file.open(csv);
        if (!file) throw std::invalid_argument("--csv = " + csv + ": cannot be written");
        file << "engine,precision,solver,method,joints,split_islands,yielding,ns_per_step,"
                "ns_per_joint_step,bytes_sizeof,bytes_heap\n";
    }
    fmt::print("{} {}\n{:<14} {:>7} {:>6} {:>9} {:>14} {:>12} {:>8} {:>8}\n", Field::engine,
               Field::precision, "method", "joints", "split", "yielding", "ns per step",
               "per joint", "sizeof", "heap");
    const std::vector<int> counts =
        quick ? std::vector{10, 100, 1000} : std::vector{10, 100, 1000, 10000, 100000};
    for (const bool split : {true, false}) {
        if (!split && !Field::splits_by_choice) continue;
        for (const int count : counts) {
            if (split && Field::splits_by_choice && count > most_split_pairs) continue;
            const bool large = count > 20000; // one field at a time
            const auto all = cases(large);
            const std::size_t together = large ? 1 : all.size();
            const double enough = large ? 3 : 10; // [s]
            for (std::size_t from = 0; from < all.size(); from += together) {
                std::vector<std::unique_ptr<Field>> fields;
                std::vector<FieldSettings> settings;
                for (std::size_t i = from; i < std::min(from + together, all.size()); ++i) {
                    settings.push_back({.joint = all[i].joint,
                                        .count = count,
                                        .weak_every = all[i].weak_every,
                                        .split_islands = split});
                    fields.push_back(std::make_unique<Field>(settings.back()));
                }
                const auto times = step_times(fields, quick ? 5 : 11, quick ? 2e-3 : 1e-2, enough);
                for (std::size_t i = 0; i < times.size(); ++i) {
                    const Case& c = all[from + i];
                    const double step = 1e9 * times[i];
                    const double heap = fields[i]->heap() / count;
                    fmt::print("{:<14} {:>7} {:>6} {:>9} {:>14.0f} {:>12.1f} {:>8} {:>8.0f}\n",
                               c.method, count, split, c.yielding, step, step / count,
                               Field::size_of(c.joint), heap);
                    std::fflush(stdout);
                    file << fmt::format("{},{},{},{},{},{:d},{},{:.1f},{:.2f},{},{:.1f}\n",
                                        Field::engine, Field::precision, Field::solver(settings[i]),
                                        c.method, count, split, c.yielding, step, step / count,
                                        Field::size_of(c.joint), heap);
                }
            }
        }
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
