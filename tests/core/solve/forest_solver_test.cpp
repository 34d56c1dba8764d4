// SPDX-License-Identifier: MIT
//
// Chains and trees of a few joints by their own way, beside the way of any island.
#include "ductile/solve/forest_solver.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <utility>

#include "core/solve/islands.hpp"
#include "ductile/solve/island_solver.hpp"

using namespace ductile::solve;
using ductile::Vector6;

namespace {

/// A tree of two to eight joints, masses up to 1e4 apart, on the ground or free, joints either way
/// round; rows rigid, as stiff as `compliance` of their own effect at least, or held by a bound,
/// and joints that hold on ellipsoids.
Island forest(std::mt19937& random, double compliance) {
    islands::Random make{random};
    const int joints = 2 + int(6.99 * make.uniform());
    const bool grounded = make.uniform() < 0.5;
    Island result;
    const auto link = [&](int a, int b) {
        if (make.uniform() < 0.5) std::swap(a, b);
        if (a < 0) std::swap(a, b);
        const int first = islands::add_joint(result, a, b, make.point(), make.point());
        const bool weak = make.uniform() < 0.4, shares = make.uniform() < 0.3;
        IslandBlock block{.first = first, .count = 6};
        for (int k = 0; k < 6; ++k) {
            IslandRow& row = result.rows[std::size_t(first + k)];
            row.target = make.normal();
            if (make.uniform() < 0.3) row.compliance = compliance * own_effect(result, row);
            block.size[std::size_t(k)] = 1e9;
            if (shares || !weak || make.uniform() < 0.5) continue;
            row.upper = make.decades(-2, 1);
            row.lower = make.uniform() < 0.2 ? 0 : -row.upper;
        }
        if (shares) result.blocks.push_back(block);
    };
    for (int i = 0; i < joints + (grounded ? 0 : 1); ++i) {
        result.bodies.push_back(islands::body(make.decades(-2, 2), 0.2 + make.uniform()));
    }
    if (grounded) link(0, immovable);
    for (int i = 1; i < int(result.bodies.size()); ++i) link(i, int(make.uniform() * i));
    random = make.random;
    return result;
}

bool solve_forest(Island& island, IslandReport& report) {
    return ForestSolver::serves(island) && ForestSolver().solve(island, report);
}

} // namespace

TEST_CASE("Chains and trees have the answer of the way of any island", "[solve]") {
    std::mt19937 random(3);
    int taken = 0;
    for (int repeat = 0; repeat < 600; ++repeat) {
        Island island = forest(random, repeat % 2 == 0 ? 0.1 : 1e3);
        Island any = island;
        IslandReport report;
        if (!solve_forest(island, report)) continue; // its sides went in circles
        ++taken;
        const IslandReport of_any = GeneralSolver().solve(any);
        CAPTURE(repeat, island.rows.size(), report.residual, of_any.residual);
        REQUIRE(of_any.solved);
        CHECK(report.solved);
        CHECK(report.scale == Approx(of_any.scale).epsilon(1e-9));
        double largest = 0, apart = 0;
        for (std::size_t i = 0; i < island.bodies.size(); ++i) {
            const Vector6<double>& v = island.bodies[i].velocity;
            largest = std::max(largest, v.cwiseAbs().maxCoeff());
            apart = std::max(apart, (v - any.bodies[i].velocity).cwiseAbs().maxCoeff());
        }
        CHECK(apart <= 1e-8 * largest);
        for (std::size_t i = 0; i < island.rows.size(); ++i) {
            const IslandRow &row = island.rows[i], &other = any.rows[i];
            CHECK(std::abs(row.impulse - other.impulse) <=
                  1e-7 * (std::abs(other.impulse) + largest / own_effect(island, row)));
            CHECK(row.side == other.side);
        }
        IslandReport again; // from where it was
        CHECK(solve_forest(island, again));
        CHECK(again.rounds == 1);
    }
    CHECK(taken >= 580);
}

TEST_CASE("What is no forest is left to the way of any island, as it was", "[solve]") {
    std::mt19937 random(5);
    Island tree = forest(random, 1);
    while (tree.bodies.size() < 4 || tree.blocks.empty()) tree = forest(random, 1);
    const auto declined = [](Island island) {
        const Island before = island;
        IslandReport report;
        if (solve_forest(island, report)) return false;
        for (std::size_t i = 0; i < island.rows.size(); ++i) {
            if (island.rows[i].impulse != before.rows[i].impulse) return false;
            if (island.rows[i].side != before.rows[i].side) return false;
        }
        return true;
    };
    REQUIRE_FALSE(declined(tree));
    SECTION("a loop") {
        islands::add_joint(tree, 3, 0, {1, 0, 0}, {0, 1, 0});
        CHECK(declined(tree));
    }
    SECTION("held twice") {
        islands::add_joint(tree, 3, immovable, {1, 0, 0}, {0, 0, 0});
        islands::add_joint(tree, 2, immovable, {1, 0, 0}, {0, 0, 0});
        CHECK(declined(tree));
    }
    SECTION("a contact") {
        islands::add_contact(tree, 0, immovable, {0, 0, 0}, {0, 0, 0}, 0.5);
        CHECK(declined(tree));
    }
    SECTION("a joint that flows on its surface") {
        tree.blocks[0].state = BlockState::surface;
        CHECK(declined(tree));
    }
    SECTION("a joint beyond its surface") {
        tree.blocks[0].size.fill(1e-9);
        CHECK(declined(tree));
    }
    SECTION("a locked axis") {
        tree.bodies[1].inverse_mass[2] = 0;
        CHECK(declined(tree));
    }
    SECTION("what is not finite") {
        for (const double bad :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
            Island island = tree;
            island.rows[7].target = bad;
            CHECK(declined(island));
            island = tree;
            island.rows[7].on_a[1] = bad;
            CHECK(declined(island));
            island = tree;
            island.rows[7].compliance = bad;
            CHECK(declined(island));
        }
    }
}

TEST_CASE("Rows that a block shares have no bounds in a forest", "[solve]") {
    std::mt19937 random(5);
    Island tree = forest(random, 1);
    while (tree.blocks.empty()) tree = forest(random, 1);
    Island bounded = tree; // by what is not read
    for (int k = 0; k < 6; ++k) {
        IslandRow& row = bounded.rows[std::size_t(tree.blocks[0].first + k)];
        row.lower = -(row.upper = 1e-9);
    }
    IslandReport report;
    REQUIRE(solve_forest(tree, report));
    REQUIRE(solve_forest(bounded, report));
    for (std::size_t i = 0; i < tree.rows.size(); ++i) {
        CHECK(tree.rows[i].impulse == bounded.rows[i].impulse);
    }
}
