// SPDX-License-Identifier: MIT
//
// A measured quantity beside its exact value, and the order at which its error falls with the step.
// Problems return quantities; tests check them and the bench prints them.
//
// The error of a motion that stops or breaks somewhere inside a step jumps with the place of that
// event in the step. The order is therefore taken from the root mean square of the error over an
// octave of steps, dt 2^(-j/n), not from single ones.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace ductile::reference {

/// What the error of a quantity does when dt is halved.
enum class Trend {
    exact,        ///< round-off at any step
    first_order,  ///< halves
    second_order, ///< quarters
    within_step,  ///< the time of an event: known to ± dt only
};

struct Quantity {
    std::string name;
    std::string unit;
    double measured = 0;
    double exact = 0;
    Trend trend = Trend::exact;

    [[nodiscard]] double error() const { return measured - exact; }
};

/// All quantities of a problem at one step; always the same ones in the same order.
using Run = std::function<std::vector<Quantity>(double dt)>;

/// Root mean square error of every quantity over the octave of `steps` steps that starts at dt.
[[nodiscard]] inline std::vector<double> errors_over_octave(const Run& run, double dt, int steps) {
    std::vector<double> sum;
    for (int j = 0; j < steps; ++j) {
        const std::vector<Quantity> quantities = run(dt * std::exp2(-double(j) / steps));
        sum.resize(quantities.size(), 0);
        for (std::size_t i = 0; i < quantities.size(); ++i) {
            sum[i] += quantities[i].error() * quantities[i].error();
        }
    }
    for (double& s : sum) s = std::sqrt(s / steps);
    return sum;
}

/// Order at which an error fell over `halvings` halvings.
[[nodiscard]] inline double observed_order(double coarse, double fine, int halvings) {
    return std::log2(std::abs(coarse / fine)) / halvings;
}

/// Observed order of every quantity over `halvings` halvings of dt.
[[nodiscard]] inline std::vector<double> observed_orders(const Run& run, double dt, int steps,
                                                         int halvings = 3) {
    std::vector<double> order = errors_over_octave(run, dt, steps);
    const std::vector<double> fine = errors_over_octave(run, std::ldexp(dt, -halvings), steps);
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = observed_order(order[i], fine[i], halvings);
    }
    return order;
}

} // namespace ductile::reference
