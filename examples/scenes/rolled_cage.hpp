// SPDX-License-Identifier: MIT
//
// A cage of 54 tubes of 50 x 3 mm, S355, that has rolled by 150 degrees and falls on the edge of
// its roof: four hoops with rails, floor and braces, and 1500 kg on the floor. Redundant in every
// way.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "ductile/material/named.hpp"
#include "ductile/section/tube.hpp"
#include "ductile/structure/structure_model.hpp"

namespace ductile::scenes {

inline StructureModel rolled_cage(bool elastic) {
    const Tube<double> tube({.outer_radius = 0.025, .inner_radius = 0.022});
    const Material<double> steel(s355<double>());
    StructureModel model({.elastic = elastic});
    constexpr int hoops = 4, corners = 6; // across: floor, belt and roof, left and right
    constexpr std::array<std::array<double, 2>, corners> outline{
        {{-0.75, 0}, {-0.75, 0.6}, {-0.5, 1.2}, {0.5, 1.2}, {0.75, 0.6}, {0.75, 0}}};
    const double roll = 150 * std::numbers::pi / 180;
    std::array<std::array<NodeId, corners>, hoops> at;
    for (int i = 0; i < hoops; ++i) {
        for (std::size_t k = 0; k < corners; ++k) {
            const auto& [y, z] = outline[k];
            at[std::size_t(i)][k] = model.node({0.8 * i, y * std::cos(roll) - z * std::sin(roll),
                                                2 + y * std::sin(roll) + z * std::cos(roll)});
        }
        for (const std::size_t floor : {0, 5}) model.mass(at[std::size_t(i)][floor], 187.5);
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
    for (const std::size_t i : {0, 1, 3}) member(at[i][0], at[i][3]);
    return model;
}

} // namespace ductile::scenes
