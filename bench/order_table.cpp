// SPDX-License-Identifier: MIT
//
// Question: how far off is each measured quantity at the step I can afford, and how fast does that
// fall?
//
// Every problem with a known answer runs on the reference integrator of the tests (small, dense,
// exact boxed solve), so what is left is the error of time stepping and of the joint, not of a
// solver. Per quantity: the error, measured - exact, at steps from 1/30 to 1/4000 s, and the
// observed order: how often the root mean square error over an octave of steps halves when dt does,
// from 1/250 to 1/4000 s. "exact" marks round-off at every step, "event" a time known to ± dt only.
//
// Some rows tell more than their number: plastic work is exact or second order where the rest
// position is first order; a beam of many segments needs steps that resolve its first hinges.
//
// Usage: order_table [--csv FILE]
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "reference/order.hpp"
#include "reference/problems/impact.hpp"
#include "reference/problems/oscillator.hpp"
#include "reference/problems/pendulum.hpp"
#include "reference/problems/rotors.hpp"

namespace {

using namespace ductile::reference;

constexpr std::array<int, 8> rates{30, 60, 125, 250, 500, 1000, 2000, 4000};
constexpr double order_from = 1.0 / 250;
constexpr int samples = 16, halvings = 4;

struct Problem {
    std::string name;
    std::string statement;
    Run run;
};

std::vector<Problem> problems() {
    const ParkesCase& parkes = parkes_cases.front();
    const Pulse rectangular{false, 0.5, 0.8, 4.95375, 0.76544};
    const Pulse triangular{true, 1, 1, 1.88901, 0.57595};
    return {
        {"P01a", "rotor stopped by its hinge", [](double dt) { return p01_rotor({}, dt); }},
        {"P01c", "two coaxial bodies", p01_pair},
        {"P02b", "hinge breaks in mid-motion",
         [](double dt) { return p02_rotor_break({.limit = 1.3}, dt); }},
        {"P03", "free oscillator past yield", p03_free},
        {"P04", "load at 0.8 of the strength, held",
         [](double dt) { return p04_step_load(0.8, dt); }},
        {"P05", "rectangular pulse, T/2", [=](double dt) { return p05_pulse(rectangular, dt); }},
        {"P05", "triangular pulse, T", [=](double dt) { return p05_pulse(triangular, dt); }},
        {"P07a", "kinematic hardening", p07_kinematic},
        {"P07a", "isotropic hardening", p07_isotropic},
        {"P13a", "struck cantilever, 2 segments",
         [&](double dt) { return p13_cantilever(parkes.parameters, parkes.answers.at(1), dt); }},
        {"P13a", "struck cantilever, 5 segments",
         [&](double dt) { return p13_cantilever(parkes.parameters, parkes.answers.at(4), dt); }},
        {"P15a", "thrown beam, 2 segments per half",
         [](double dt) { return p15_thrown(Support::pinned, thrown_beams[1], dt); }},
        {"P24a", "leaning column, 0.9 of critical",
         [](double dt) { return p24_stops(0.9, 0.115589856, 0.8174509, dt); }},
        {"P24a", "falling column, 1.1 of critical",
         [](double dt) { return p24_falls(1.1, 2.14724, 2.773873, dt); }},
        {"P24b", "elastic hinge, 0.9 of critical", p24_elastic},
        {"P25a", "mass on a crushing column", p25_crush},
        {"P25b", "the column breaks", p25_break},
        {"P27a", "two rotors in series", p27_series},
    };
}

struct Row {
    std::string problem, statement;
    Quantity quantity; ///< at the finest step
    std::array<double, rates.size()> measured{};
    double order = 0;
};

std::vector<Row> measure(const Problem& problem) {
    std::vector<Row> rows;
    for (std::size_t j = rates.size(); j-- > 0;) {
        std::vector<Quantity> quantities;
        try {
            quantities = problem.run(1.0 / rates[j]);
        } catch (const std::exception&) {
            quantities.clear(); // a step so long that the motion has no such event
        }
        if (rows.empty()) {
            for (const Quantity& q : quantities)
                rows.push_back({problem.name, problem.statement, q});
        }
        for (std::size_t i = 0; i < rows.size(); ++i) {
            rows[i].measured[j] = i < quantities.size() ? quantities[i].measured
                                                        : std::numeric_limits<double>::quiet_NaN();
        }
    }
    const std::vector<double> orders = observed_orders(problem.run, order_from, samples, halvings);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].order = orders[i];
    return rows;
}

std::string trend(const Row& row) {
    if (row.quantity.trend == Trend::exact) return "exact";
    if (row.quantity.trend == Trend::within_step) return "event";
    return fmt::format("{:.2f}", row.order);
}

void print(const std::vector<Row>& rows) {
    fmt::print("{:<6}{:<20}{:>6}{:>13}  error at dt [s] =\n", "", "quantity", "unit", "exact");
    fmt::print("{:<45}", "");
    for (const int rate : rates) fmt::print("{:>11}", fmt::format("1/{}", rate));
    fmt::print("{:>8}\n", "order");
    std::string last;
    for (const Row& row : rows) {
        if (row.problem + row.statement != last) {
            fmt::print("{:<6}{}\n", row.problem, row.statement);
            last = row.problem + row.statement;
        }
        fmt::print("{:<6}{:<20}{:>6}{:>13.6g}", "", row.quantity.name, row.quantity.unit,
                   row.quantity.exact);
        for (const double measured : row.measured) {
            const double error = measured - row.quantity.exact;
            fmt::print("{:>11}", std::isnan(error) ? "-" : fmt::format("{:.1e}", error));
        }
        fmt::print("{:>8}\n", trend(row));
    }
}

bool write_csv(const std::vector<Row>& rows, const std::string& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "w"),
                                                               &std::fclose);
    if (!file) return false;
    fmt::print(file.get(), "problem,statement,quantity,unit,dt,measured,exact,error,order\n");
    for (const Row& row : rows) {
        for (std::size_t j = 0; j < rates.size(); ++j) {
            fmt::print(file.get(), "{},\"{}\",{},{},{:.9g},{:.12g},{:.12g},{:.6g},{}\n",
                       row.problem, row.statement, row.quantity.name, row.quantity.unit,
                       1.0 / rates[j], row.measured[j], row.quantity.exact,
                       row.measured[j] - row.quantity.exact, trend(row));
        }
    }
    return true;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Error of every problem with a known answer over the time step"};
    std::string csv;
    app.add_option("--csv", csv, "write every value to this file");
    CLI11_PARSE(app, argc, argv);

    std::vector<Row> rows;
    for (const Problem& problem : problems()) {
        for (Row& row : measure(problem)) rows.push_back(std::move(row));
    }
    print(rows);
    if (!csv.empty() && !write_csv(rows, csv)) {
        fmt::print(stderr, "order_table: cannot write {}\n", csv);
        return 1;
    }
}
