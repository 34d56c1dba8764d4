// SPDX-License-Identifier: MIT
//
// A cantilever with a mass at its tip, struck there: Parkes (1955), as a chain of N equal rigid
// segments with a plastic hinge at every joint (problem P13a of tests/reference). The impulse G V₀
// acts at t = 0 with all hinges free to turn, so the chain starts with the velocities of the
// impulsive motion.
//
// Symbols
//   L, μ, M_p   length [m], mass per length [kg/m], plastic moment [N m]
//   G, V₀       tip mass [kg] and the speed it would have alone [m/s]
//   θ'          spins of the segments, from M θ' = J_tipᵀ G V₀, M the chain's mass matrix
//
// The expected values are those of the N-segment chain, not of the continuum: event-driven exact
// solutions for small displacements, for N = 5 with finite rotation. With the segments' mass at
// their ends they are the closed form of ductile/fidelity/struck_cantilever.hpp, for every N.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <stdexcept>

#include "ductile/fidelity/struck_cantilever.hpp"
#include "scenes/scene.hpp"

namespace bench {

struct StruckCantileverParameters {
    int segments = 5;
    double length = 1;
    double mass_per_length = 2;
    double plastic_moment = 100;
    double tip_mass = 1;
    double speed = 4;
    bool mass_at_ends = false; ///< half a segment's mass at either end of it, instead of a rod
};

/// Answers of P13 a for those N that the reference lists.
struct ChainAnswer {
    int segments;
    double tip;    ///< [m]
    double root;   ///< [rad]
    double energy; ///< after the impulse, all absorbed [J]
};
inline constexpr std::array<ChainAnswer, 8> struck_chain_answers{{
    {1, 0.048, 0.048, 4.8},
    {2, 0.0530286227, 0.0453604712, 6.19354839},
    {3, 0.0533768799, 0.0429069058, 6.70807453},
    {4, 0.0534942596, 0.0414763964, 6.99089727},
    {5, 0.05377271, 0.04077867, 7.1718616},
    {8, 0.0535874791, 0.0388522198, 7.46151177},
    {10, 0.0534009366, 0.0381141855, 7.56333089},
    {20, 0.0526932364, 0.0363373977, 7.77553951},
}};

/// @throws std::invalid_argument where the answer for so many segments is not known.
[[nodiscard]] inline Scene struck_cantilever(const StruckCantileverParameters& p = {}) {
    const auto answer = std::find_if(struck_chain_answers.begin(), struck_chain_answers.end(),
                                     [&](const auto& a) { return a.segments == p.segments; });
    if (answer == struck_chain_answers.end() && !p.mass_at_ends) {
        throw std::invalid_argument("struck_cantilever.segments: no answer known for this number");
    }
    const int n = p.segments;
    const double s = p.length / n;
    const double mass = p.mass_per_length * s;
    Scene scene;
    scene.name = "struck-cantilever";
    scene.source = "P13 a, N = " + std::to_string(n);

    Eigen::MatrixXd inertia = Eigen::MatrixXd::Zero(n, n);
    std::vector<Eigen::VectorXd> centre_rows; // speed of each centre of mass per spin
    const auto row_at = [&](int segment, double x) {
        Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
        row.head(segment).setConstant(s);
        row[segment] = x - segment * s;
        return row;
    };
    for (int i = 0; i < n; ++i) {
        const double middle = (i + 0.5) * s;
        const double tip = i + 1 == n ? p.tip_mass : 0;
        const double total = mass + tip;
        const double centre = (mass * middle + tip * p.length) / total;
        const double alone =
            p.mass_at_ends ? ductile::segment_inertia(mass, s, n) : mass * s * s / 12;
        const double about =
            alone + mass * std::pow(middle - centre, 2) + tip * std::pow(p.length - centre, 2);
        centre_rows.push_back(row_at(i, centre));
        inertia += total * centre_rows.back() * centre_rows.back().transpose();
        inertia(i, i) += about;
        scene.bodies.push_back({.mass = total,
                                .inertia = Vector::Constant(about),
                                .start = {.position = {centre, 0, 0}}});
        scene.joints.push_back({.a = i,
                                .b = i == 0 ? ground : i - 1,
                                .anchor = {i * s, 0, 0},
                                .strength = p.plastic_moment});
    }
    const Eigen::VectorXd spins =
        inertia.ldlt().solve(row_at(n - 1, p.length) * p.tip_mass * p.speed);
    for (int i = 0; i < n; ++i) {
        BodyState& start = scene.bodies[std::size_t(i)].start;
        start.spin = {0, 0, spins[i]};
        start.velocity = {0, centre_rows[std::size_t(i)].dot(spins), 0};
    }
    const Vector tip_in_last(p.length - scene.bodies.back().start.position.x(), 0, 0);
    scene.duration = 0.06;
    const auto tip = [tip_in_last](const Observation& o) {
        return o.bodies.back().point(tip_in_last).y();
    };
    if (p.mass_at_ends) {
        const ductile::StruckCantilever<double> beam{.length = p.length,
                                                     .mass_per_length = p.mass_per_length,
                                                     .plastic_moment = p.plastic_moment,
                                                     .tip_mass = p.tip_mass,
                                                     .speed = p.speed};
        const double blow = p.tip_mass * p.speed * ductile::chain_start_speed(beam, n) / 2;
        scene.quantities = {{"tip_deflection", ductile::chain_deflection(beam, n), tip},
                            absorbed_energy(blow)};
        return scene;
    }
    scene.quantities = {
        {"tip_deflection", answer->tip, tip},
        {"root_rotation", answer->root, [](const Observation& o) { return o.travel[0]; }},
        absorbed_energy(answer->energy)};
    return scene;
}

} // namespace bench
