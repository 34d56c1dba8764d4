// SPDX-License-Identifier: MIT
//
// Checks a problem's quantities against their exact values and trends, as Catch assertions.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "reference/order.hpp"

namespace ductile::reference {

struct Sweep {
    double dt = 1.0 / 240; ///< coarsest step [s]
    int steps = 8;         ///< per octave
    int halvings = 3;
};

/// Exact quantities hold to 1e-9 and events to ± dt at the coarsest and finest step; the others
/// fall with an order of at least 0.9 or 1.8.
inline void expect_trends(const std::string& problem, const Run& run, const Sweep& sweep = {}) {
    constexpr double exact = 1e-9, first = 0.9, second = 1.8;
    const std::vector<double> order = observed_orders(run, sweep.dt, sweep.steps, sweep.halvings);
    for (const double dt : {sweep.dt, std::ldexp(sweep.dt, -sweep.halvings)}) {
        const std::vector<Quantity> quantities = run(dt);
        for (std::size_t i = 0; i < quantities.size(); ++i) {
            const Quantity& q = quantities[i];
            INFO(problem << ", " << q.name << " at dt = " << dt << ": " << q.measured << " against "
                         << q.exact << ' ' << q.unit);
            if (q.trend == Trend::exact) {
                CHECK(std::abs(q.error()) <= exact * std::max(1.0, std::abs(q.exact)));
            } else if (q.trend == Trend::within_step) {
                CHECK(std::abs(q.error()) <= dt * (1 + exact));
            } else {
                CHECK(order[i] >= (q.trend == Trend::first_order ? first : second));
            }
        }
    }
}

} // namespace ductile::reference
