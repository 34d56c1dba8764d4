// SPDX-License-Identifier: MIT
//
// Boxes on plastic joints that are thrown between walls: contacts on all sides, whose friction
// jams them, so that the normals that bound it in one round are far from those of the next.
#include "ductile/solve/island_solver.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/solve/islands.hpp"

using namespace ductile::solve;
using ductile::Vector3;
using ductile::Vector6;

namespace {

/// A contact of body `a` at `arm` with what does not move, whose normal is `normal`.
void touch(Island& island, int a, const Vector3<double>& arm, const Vector3<double>& normal,
           double friction) {
    const int first = int(island.rows.size());
    const Vector3<double> along = islands::unit(std::abs(normal[0]) < 0.7 ? 0 : 1);
    const Vector3<double> across = ductile::cross(normal, along).normalized();
    for (const Vector3<double>& direction :
         {normal, Vector3<double>(ductile::cross(across, normal)), across}) {
        IslandRow row;
        row.a = a;
        row.on_a = islands::push(arm, direction);
        row.softness = contact_softness * own_effect(island, row);
        island.rows.push_back(row);
    }
    island.rows[std::size_t(first)].lower = 0;
    island.blocks.push_back(
        {.kind = BlockKind::contact, .first = first, .count = 3, .size = {0, friction, friction}});
}

/// Two to six boxes in a row, masses `decades` apart, in a trough: a step of 1/60 s.
Island jammed_boxes(std::mt19937& random, double decades) {
    constexpr double dt = 1.0 / 60;
    const auto between = [&random](double from, double to) {
        return from + (to - from) * double(random()) / double(std::mt19937::max());
    };
    Island result;
    std::vector<Vector6<double>> speed;
    const int boxes = 2 + int(between(0, 4.99)), walls = 1 + int(between(0, 1.99));
    const double friction = between(0.3, 1.2);
    for (int i = 0; i < boxes; ++i) {
        result.bodies.push_back(
            islands::body(std::pow(10, between(0, decades)), between(0.2, 0.6)));
        const double fast = between(0, 1) < 0.5 ? 0.05 : 3;
        Vector6<double>& v = speed.emplace_back();
        for (int k = 0; k < 6; ++k) v[k] = between(-1, 1) * (k < 3 ? fast : 0.3);
        v[2] -= 9.81 * dt;
        if (i == 0) continue;
        const int first = islands::add_joint(result, i, i - 1, {-0.5, 0, 0}, {0.5, 0, 0});
        const int flows = int(between(0, 2.99)); // a hinge, a slider, all six
        for (int k = 0; k < 6; ++k) {
            IslandRow& row = result.rows[std::size_t(first + k)];
            const double cap = std::pow(10, between(-1, 2)) * 50 * dt;
            if (flows == 2 || k == (flows == 0 ? 4 : 0)) row.lower = -(row.upper = cap);
        }
    }
    for (int i = 0; i < boxes; ++i) {
        for (const double x : {-0.4, 0.4}) {
            for (const double side : {-0.3, 0.3}) {
                touch(result, i, {x, side, -0.3}, {0, 0, 1}, friction);
                if (walls > 1) touch(result, i, {x, 0.3, side}, {0, -1, 0}, friction);
            }
        }
    }
    for (const double z : {-0.3, 0.3}) {
        for (const double y : {-0.3, 0.3}) {
            if (between(0, 1) < 0.7) touch(result, 0, {-0.5, y, z}, {1, 0, 0}, friction);
            if (between(0, 1) < 0.7) touch(result, boxes - 1, {0.5, y, z}, {-1, 0, 0}, friction);
        }
    }
    for (IslandRow& row : result.rows) {
        row.target = -row.on_a.dot(speed[std::size_t(row.a)]);
        if (row.b >= 0) row.target -= row.on_b.dot(speed[std::size_t(row.b)]);
    }
    return result;
}

} // namespace

TEST_CASE("Jointed boxes that jam between walls are solved, all but one", "[solve]") {
    std::mt19937 random(1);
    int solved = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        Island island = jammed_boxes(random, repeat % 3);
        const IslandReport report = IslandSolver().solve(island);
        INFO("island " << repeat << ", off by " << report.residual << " of " << report.scale);
        CHECK(island.unsolved == 0);
        solved += report.solved ? 1 : 0;
    }
    CHECK(solved >= 299);
}

TEST_CASE("How fast a light body turns beside them is no measure of what jammed boxes are off by",
          "[solve]") {
    std::mt19937 random(1);
    for (int repeat = 0; repeat < 300; ++repeat) {
        Island island = jammed_boxes(random, repeat % 3);
        island.bodies.push_back(islands::body(1e-3, 1e-3));
        IslandRow row;
        row.a = int(island.bodies.size()) - 1;
        row.on_a = islands::turn({0, 0, 1});
        row.target = 1e6;
        row.lower = -(row.upper = 1e-9);
        island.rows.push_back(row);
        const IslandReport report = IslandSolver().solve(island);
        INFO("island " << repeat << ", off by " << report.residual << " of " << report.scale);
        CHECK((report.residual <= unsolved_speed || island.unsolved > 0));
    }
}

// blocks that left their surface while others were not yet solved came back in the next round
TEST_CASE("A wall on plastic joints that is struck and slides on a floor is solved", "[solve]") {
    constexpr int wide = 6, high = 4;
    std::mt19937 random(1);
    int safe_ways = 0;
    for (int repeat = 0; repeat < 60; ++repeat) {
        Island island = islands::struck_grid(random, wide, 1, high, 0.5 * (1 + repeat % 10), 1e-12);
        for (int i = 0; i < wide; ++i) {
            for (const double x : {-0.15, 0.15}) {
                for (const double y : {-0.1, 0.1}) {
                    const std::size_t first = island.rows.size();
                    touch(island, i, {x, y, -0.15}, {0, 0, 1}, 0.6);
                    island.rows[first].target = 0.16;    // its weight, for a step
                    island.rows[first + 2].target = 0.5; // the floor drags it
                }
            }
        }
        const IslandReport report = IslandSolver().solve(island);
        INFO("island " << repeat << ", off by " << report.residual << " of " << report.scale);
        CHECK(report.solved);
        CHECK(island.unsolved == 0);
        safe_ways += report.safe_ways;
    }
    CHECK(safe_ways <= 5);
}
