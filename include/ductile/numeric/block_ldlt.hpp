// SPDX-License-Identifier: MIT
//
// Sparse systems of 6×6 blocks, one block row a body, by L D Lᵀ, or by L U where they are not
// symmetric.
//
//   set_pattern(n, edges)      order and fill: once per topology
//   clear(); diagonal(i) += ..; add(i, j, ..)
//   factor()                   L D Lᵀ in the stored order
//   solve(x)                   in place
//
//   mirror(); mirrored(..) += ..; factor_general(): from `mirror` on both sides of the diagonal
//   differ
//
// Order. Greedy minimum degree on the graph of the blocks: the block with the fewest neighbours
// left goes first, and its neighbours become neighbours of each other. A chain gets no fill, a
// frame of 36 members some dozen blocks. No pivoting: right for positive definite matrices in any
// order. Without symmetry there is pivoting within the blocks of the diagonal alone: right near
// such matrices.
//
// Symbols
//   n   number of block rows;  edges   pairs (i, j), i ≠ j, whose block A_ij may differ from zero
//   L   unit lower triangular by scalars;  D   diagonal
//
// Limit cases: no edges: n factorisations of 6×6; a chain: O(n).
//
// Source: George & Liu (1989), doi:10.1137/1031001 (minimum degree); Golub & Van Loan (2013),
// Matrix Computations, 4th edition, algorithm 4.1.2, by blocks and right-looking.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "ductile/numeric/lu.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::numeric {

/// Not thread-safe: `solve` uses room of its own. Allocates in set_pattern alone.
class BlockLdlt {
  public:
    using Block = Eigen::Matrix<double, 6, 6>;
    using Entry = Eigen::Matrix<double, 6, 1>;
    using Edge = std::pair<int, int>;

    /// Where a block is kept, and whether as its transpose.
    struct Place {
        int at = 0;
        bool transposed = false;
    };

    /// `edges` in any order, each once or more. Cost: O(Σ degree²) of the filled graph.
    void set_pattern(int n, const std::vector<Edge>& edges);

    [[nodiscard]] int size() const noexcept { return n_; }
    /// Blocks below the diagonal of L, fill included.
    [[nodiscard]] std::size_t off_diagonal_blocks() const noexcept { return off_.size(); }

    void clear() noexcept;
    [[nodiscard]] Block& diagonal(int i) noexcept { return diagonal_[at(place_[at(i)])]; }
    /// Of the edge (i, j): A_ij is kept there, or its transpose where `transposed`.
    [[nodiscard]] Place place(int i, int j) const noexcept;
    [[nodiscard]] Block& off_diagonal(const Place& place) noexcept { return off_[at(place.at)]; }

    /// False where a pivot is not a positive number; `solve` is then of no use.
    [[nodiscard]] bool factor() noexcept;

    /// Sets the blocks across the diagonal from those that are there.
    void mirror() noexcept;
    /// The block across the diagonal from `off_diagonal`.
    [[nodiscard]] Block& mirrored(const Place& place) noexcept { return across_[at(place.at)]; }
    /// Without symmetry, from `mirrored` too. Where it is singular `solve` gives what is not
    /// finite.
    void factor_general() noexcept;

    /// A x = b, b in and x out: `size()` entries in the caller's order. After either factorisation.
    void solve(std::vector<Entry>& x) const noexcept;

  private:
    [[nodiscard]] static constexpr std::size_t at(int i) noexcept { return std::size_t(i); }
    void order_blocks(const std::vector<Edge>& edges);
    void plan_updates();
    void solve_symmetric() const noexcept;
    void solve_general() const noexcept;

    int n_ = 0;
    std::vector<int> order_;  ///< place -> the caller's block
    std::vector<int> place_;  ///< and back
    std::vector<int> column_; ///< of L: where it begins in row_ and off_; n + 1
    std::vector<int> row_;    ///< places below the diagonal, rising in each column
    std::vector<int> update_; ///< what factor() writes, in the order in which it does
    std::vector<Block> diagonal_, off_;
    std::vector<Block> across_;           ///< A above the diagonal, then U divided by its own
    std::vector<Lu<double, 6>> pivots_;   ///< of the diagonal of U
    bool general_ = false;                ///< the last factors are those without symmetry
    std::vector<Block> scaled_;           ///< a column before it is divided by D
    mutable std::vector<Entry> solution_; ///< by place
};

} // namespace ductile::numeric

#ifndef DUCTILE_COMPILED
#include "ductile/numeric/block_ldlt.ipp"
#endif
