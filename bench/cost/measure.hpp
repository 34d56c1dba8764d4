// SPDX-License-Identifier: MIT
//
// CPU time of steps of several fields, measured in turn so that a busy machine disturbs all alike.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "cpu_time.hpp"

namespace bench::cost {

/// Median CPU time of a step of every field [s], over `rounds` rounds in each of which every field
/// steps for at least `at_least` seconds; over three and more where they take longer than
/// `enough` seconds together.
template <class Field>
std::vector<double> step_times(std::vector<std::unique_ptr<Field>>& fields, int rounds,
                               double at_least, double enough = 10) {
    constexpr int fewest = 3;
    const double opened = cpu_now();
    std::vector<std::vector<double>> times(fields.size());
    for (auto& field : fields) field->step(); // first step: allocations
    for (int round = 0; round < rounds; ++round) {
        if (round >= fewest && cpu_now() - opened > enough) break;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            long steps = 0;
            const double start = cpu_now();
            double now = start;
            do {
                fields[i]->step();
                ++steps;
                now = cpu_now();
            } while (now - start < at_least);
            times[i].push_back((now - start) / double(steps));
        }
    }
    std::vector<double> result;
    result.reserve(times.size());
    for (auto& of_field : times) result.push_back(median(std::move(of_field)));
    return result;
}

} // namespace bench::cost
