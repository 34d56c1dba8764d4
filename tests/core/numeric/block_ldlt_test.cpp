// SPDX-License-Identifier: MIT
#include "ductile/numeric/block_ldlt.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <random>

using ductile::numeric::BlockLdlt;

namespace {

using Edges = std::vector<BlockLdlt::Edge>;

struct Filled {
    Eigen::MatrixXd dense;
    std::vector<BlockLdlt::Entry> right;
    Eigen::VectorXd right_dense;
};

/// Positive definite: M + Σ g gᵀ over the edges.
Filled fill(BlockLdlt& factors, int n, const Edges& edges, std::mt19937& random) {
    std::normal_distribution<double> normal;
    Filled result;
    result.dense = Eigen::MatrixXd::Identity(6 * n, 6 * n);
    factors.clear();
    for (int i = 0; i < n; ++i) factors.diagonal(i).setIdentity();
    for (const auto& [i, j] : edges) {
        for (int k = 0; k < 6; ++k) {
            BlockLdlt::Entry a, b;
            for (int q = 0; q < 6; ++q) {
                a[q] = normal(random);
                b[q] = normal(random);
            }
            factors.diagonal(i) += a * a.transpose();
            factors.diagonal(j) += b * b.transpose();
            const auto place = factors.place(i, j);
            factors.off_diagonal(place) += place.transposed ? BlockLdlt::Block(b * a.transpose())
                                                            : BlockLdlt::Block(a * b.transpose());
            result.dense.block<6, 6>(6 * i, 6 * i) += a * a.transpose();
            result.dense.block<6, 6>(6 * j, 6 * j) += b * b.transpose();
            result.dense.block<6, 6>(6 * i, 6 * j) += a * b.transpose();
            result.dense.block<6, 6>(6 * j, 6 * i) += b * a.transpose();
        }
    }
    result.right_dense.resize(6 * n);
    result.right.resize(std::size_t(n));
    for (int i = 0; i < 6 * n; ++i) {
        result.right_dense[i] = result.right[std::size_t(i / 6)][i % 6] = normal(random);
    }
    return result;
}

/// Adds to each block what is not symmetric.
void skew(BlockLdlt& factors, Filled& filled, int n, const Edges& edges, std::mt19937& random) {
    std::uniform_real_distribution<double> some(-0.1, 0.1);
    const auto add = [&](BlockLdlt::Block& block, int i, int j) {
        const BlockLdlt::Block more = BlockLdlt::Block::NullaryExpr([&] { return some(random); });
        block += more;
        filled.dense.block<6, 6>(6 * i, 6 * j) += more;
    };
    for (int i = 0; i < n; ++i) add(factors.diagonal(i), i, i);
    for (const auto& [i, j] : edges) {
        const auto place = factors.place(i, j);
        const bool turned = place.transposed;
        add(factors.off_diagonal(place), turned ? j : i, turned ? i : j);
        add(factors.mirrored(place), turned ? i : j, turned ? j : i);
    }
}

void compare(const Filled& ours, const Eigen::VectorXd& theirs) {
    for (Eigen::Index i = 0; i < theirs.size(); ++i) {
        CHECK(ours.right[std::size_t(i / 6)][i % 6] ==
              Approx(theirs[i]).epsilon(1e-9).margin(1e-9 * theirs.norm()));
    }
}

} // namespace

TEST_CASE("Sparse blocks are solved as Eigen solves the dense matrix", "[numeric]") {
    std::mt19937 random(2);
    BlockLdlt factors;
    for (const int n : {1, 2, 3, 8, 30}) {
        for (const int loops : {0, 1, n}) {
            Edges edges;
            for (int i = 1; i < n; ++i) edges.emplace_back(i - 1, i);
            for (int i = 0; i < loops; ++i) {
                const int a = int(random() % unsigned(n)), b = int(random() % unsigned(n));
                if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
            }
            factors.set_pattern(n, edges);
            Filled filled = fill(factors, n, edges, random);
            REQUIRE(factors.factor());
            factors.solve(filled.right);
            compare(filled, filled.dense.llt().solve(filled.right_dense));

            filled = fill(factors, n, edges, random);
            factors.mirror();
            skew(factors, filled, n, edges, random);
            factors.factor_general();
            factors.solve(filled.right);
            compare(filled, filled.dense.partialPivLu().solve(filled.right_dense));
        }
    }
}

TEST_CASE("Chains and trees get no fill, a ring one chord a block", "[numeric]") {
    BlockLdlt factors;
    Edges chain, tree, ring;
    for (int i = 1; i < 100; ++i) {
        chain.emplace_back(i - 1, i);
        tree.emplace_back((i - 1) / 2, i);
    }
    factors.set_pattern(100, chain);
    CHECK(factors.off_diagonal_blocks() == 99);
    factors.set_pattern(100, tree);
    CHECK(factors.off_diagonal_blocks() == 99);
    ring = chain;
    ring.emplace_back(0, 99);
    factors.set_pattern(100, ring);
    CHECK(factors.off_diagonal_blocks() == 99 + 98);
}

TEST_CASE("A matrix that is not positive definite, or not a number, is told", "[numeric]") {
    BlockLdlt factors;
    factors.set_pattern(2, {{0, 1}});
    for (const double bad : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
        factors.clear();
        factors.diagonal(0).setIdentity();
        factors.diagonal(1).setIdentity();
        factors.diagonal(1)(3, 3) = bad;
        CHECK_FALSE(factors.factor());
    }
}
