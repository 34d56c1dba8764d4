// SPDX-License-Identifier: MIT
//
// A cage of 54 tubes of 50 x 3 mm, S355, that has rolled by 150 degrees and falls on the edge of
// its roof: four hoops with rails, floor and braces. Redundant in every way. What it weighs on, a
// vehicle or masses, is for others to put to the corners of its floor.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/material/named.hpp"
#include "ductile/section/tube.hpp"
#include "ductile/structure/structure_model.hpp"

namespace ductile::scenes {

struct RolledCage {
    StructureModel model;
    std::vector<NodeId> floor; ///< its corners, two a hoop

    static constexpr double roll = 150 * std::numbers::pi / 180; ///< about x [rad]
    /// Of a point that was `across` and `up` before it rolled [m].
    [[nodiscard]] static Vector3<double> place(double along, double across, double up) {
        return {along, across * std::cos(roll) - up * std::sin(roll),
                2 + across * std::sin(roll) + up * std::cos(roll)};
    }
};

inline RolledCage rolled_cage(bool elastic) {
    const Tube<double> tube({.outer_radius = 0.025, .inner_radius = 0.022});
    const Material<double> steel(s355<double>());
    RolledCage cage{StructureModel({.elastic = elastic}), {}};
    StructureModel& model = cage.model;
    constexpr int hoops = 4, corners = 6; // across: floor, belt and roof, left and right
    constexpr std::array<std::array<double, 2>, corners> outline{
        {{-0.75, 0}, {-0.75, 0.6}, {-0.5, 1.2}, {0.5, 1.2}, {0.75, 0.6}, {0.75, 0}}};
    std::array<std::array<NodeId, corners>, hoops> at;
    for (int i = 0; i < hoops; ++i) {
        for (std::size_t k = 0; k < corners; ++k) {
            const auto& [y, z] = outline[k];
            at[std::size_t(i)][k] = model.node(RolledCage::place(0.8 * i, y, z));
        }
        for (const std::size_t floor : {0U, 5U}) cage.floor.push_back(at[std::size_t(i)][floor]);
    }
    int number = 0;
    const auto member = [&](NodeId a, NodeId b) {
        model.member("tube " + std::to_string(number++), a, b, tube, steel,
                     {.joint_length = 0.1, .gap = 0.03});
    };
    for (std::size_t i = 0; i < hoops; ++i) {
        for (std::size_t k = 0; k < corners; ++k) {
            member(at[i][k], at[i][(k + 1) % corners]);
            if (i > 0) member(at[i - 1][k], at[i][k]);
        }
        if (i == 0) continue;
        member(at[i - 1][0], at[i][1]); // sides, roof
        member(at[i - 1][5], at[i][4]);
        member(at[i - 1][2], at[i][3]);
    }
    for (const std::size_t i : {0U, 1U, 3U}) member(at[i][0], at[i][3]);
    return cage;
}

} // namespace ductile::scenes
