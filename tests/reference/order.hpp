// SPDX-License-Identifier: MIT
//
// A measured quantity beside its exact value, and the order at which the error falls with the step.
// Problems return quantities; tests check them and the bench prints them.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace ductile::reference {

/// What the error of a quantity does when dt is halved.
enum class Trend {
    exact,       ///< round-off at any step
    first_order, ///< halves
    second_order,///< quarters
    within_step, ///< an event time: known to ± dt only
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

/// log2 of how much the error falls per halving, over `halvings` of them.
[[nodiscard]] inline double observed_order(double coarse_error, double fine_error, int halvings) {
    return std::log2(std::abs(coarse_error) / std::abs(fine_error)) / halvings;
}

} // namespace ductile::reference
