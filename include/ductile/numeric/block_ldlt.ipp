// SPDX-License-Identifier: MIT
//
// Bodies of block_ldlt.hpp.
#pragma once

#include <algorithm>

#include "ductile/numeric/block_ldlt.hpp"

namespace ductile::numeric {

namespace detail {

/// L D Lᵀ of one block in place: L below, D on the diagonal; reads the lower triangle.
DUCTILE_INLINE bool factor_block(BlockLdlt::Block& a) noexcept {
    bool positive = true;
    for (int j = 0; j < 6; ++j) {
        const double pivot = a(j, j);
        positive = positive && pivot > 0;
        const double inverse = 1 / pivot;
        for (int k = j + 1; k < 6; ++k) {
            const double l = a(k, j) * inverse;
            for (int i = k; i < 6; ++i) a(i, k) -= a(i, j) * l;
        }
        for (int i = j + 1; i < 6; ++i) a(i, j) *= inverse;
    }
    return positive;
}

} // namespace detail

DUCTILE_INLINE void BlockLdlt::set_pattern(int n, const std::vector<Edge>& edges) {
    n_ = n;
    order_blocks(edges);
    plan_updates();
    diagonal_.resize(at(n));
    off_.resize(row_.size());
    across_.resize(row_.size());
    pivots_.resize(at(n));
    solution_.resize(at(n));
}

DUCTILE_INLINE void BlockLdlt::order_blocks(const std::vector<Edge>& edges) {
    std::vector<std::vector<int>> neighbours(at(n_)); // sorted; of what is left
    for (const auto& [i, j] : edges) {
        if (i == j) continue;
        neighbours[at(i)].push_back(j);
        neighbours[at(j)].push_back(i);
    }
    const auto tidy = [](std::vector<int>& list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    // blocks by degree, so that the next one is found without a search over all
    std::vector<std::pair<int, int>> queue; // (degree, block), a heap; stale entries are dropped
    const auto later = [](const auto& a, const auto& b) { return a > b; };
    for (int i = 0; i < n_; ++i) {
        tidy(neighbours[at(i)]);
        queue.emplace_back(int(neighbours[at(i)].size()), i);
    }
    std::make_heap(queue.begin(), queue.end(), later);

    order_.clear();
    place_.assign(at(n_), -1);
    column_.assign(1, 0);
    std::vector<std::vector<int>> below(at(n_)); // by place, the caller's numbers
    while (int(order_.size()) < n_) {
        std::pop_heap(queue.begin(), queue.end(), later);
        const auto [degree, next] = queue.back();
        queue.pop_back();
        if (place_[at(next)] >= 0 || degree != int(neighbours[at(next)].size())) continue;
        place_[at(next)] = int(order_.size());
        order_.push_back(next);
        std::vector<int>& clique = below[order_.size() - 1];
        clique = std::move(neighbours[at(next)]);
        for (const int i : clique) {
            std::vector<int>& list = neighbours[at(i)];
            list.insert(list.end(), clique.begin(), clique.end());
            tidy(list);
            std::erase_if(list,
                          [&, eliminated = next](int j) { return j == i || j == eliminated; });
            queue.emplace_back(int(list.size()), i);
            std::push_heap(queue.begin(), queue.end(), later);
        }
    }
    row_.clear();
    for (std::vector<int>& column : below) {
        for (int& i : column) i = place_[at(i)];
        std::sort(column.begin(), column.end());
        row_.insert(row_.end(), column.begin(), column.end());
        column_.push_back(int(row_.size()));
    }
}

/// For each column the block (row, row) and, below it, the blocks that its outer product changes.
DUCTILE_INLINE void BlockLdlt::plan_updates() {
    update_.clear();
    std::size_t longest = 0;
    for (int j = 0; j < n_; ++j) {
        const int begin = column_[at(j)], end = column_[at(j) + 1];
        longest = std::max(longest, at(end - begin));
        for (int q = begin; q < end; ++q) {
            int slot = column_[at(row_[at(q)])];
            for (int r = q + 1; r < end; ++r) {
                while (row_[at(slot)] != row_[at(r)]) ++slot;
                update_.push_back(slot);
            }
        }
    }
    scaled_.resize(longest);
}

DUCTILE_INLINE void BlockLdlt::clear() noexcept {
    for (Block& block : diagonal_) block.setZero();
    for (Block& block : off_) block.setZero();
}

DUCTILE_INLINE auto BlockLdlt::place(int i, int j) const noexcept -> Place {
    const int p = place_[at(i)], q = place_[at(j)];
    const int column = std::min(p, q), row = std::max(p, q);
    const auto begin = row_.begin() + column_[at(column)];
    const auto end = row_.begin() + column_[at(column) + 1];
    return {int(std::lower_bound(begin, end, row) - row_.begin()), p < q};
}

DUCTILE_INLINE bool BlockLdlt::factor() noexcept {
    general_ = false;
    bool positive = true;
    const int* update = update_.data();
    for (int j = 0; j < n_; ++j) {
        const Block& d = diagonal_[at(j)];
        positive = detail::factor_block(diagonal_[at(j)]) && positive;
        const int begin = column_[at(j)], end = column_[at(j) + 1];
        Entry inverse;
        for (int k = 0; k < 6; ++k) inverse[k] = 1 / d(k, k);
        for (int q = begin; q < end; ++q) {
            Block& x = off_[at(q)]; // A L⁻ᵀ, then divided by D
            for (int c = 1; c < 6; ++c) {
                for (int k = 0; k < c; ++k) x.col(c) -= d(c, k) * x.col(k);
            }
            scaled_[at(q - begin)] = x.transpose();
            for (int c = 0; c < 6; ++c) x.col(c) *= inverse[c];
        }
        for (int q = begin; q < end; ++q) {
            const Block& right = scaled_[at(q - begin)];
            diagonal_[at(row_[at(q)])].noalias() -= off_[at(q)] * right;
            for (int r = q + 1; r < end; ++r) off_[at(*update++)].noalias() -= off_[at(r)] * right;
        }
    }
    return positive;
}

DUCTILE_INLINE void BlockLdlt::mirror() noexcept {
    for (std::size_t q = 0; q < off_.size(); ++q) across_[q] = off_[q].transpose();
}

/// A_rq -= A_rj A_jj⁻¹ A_jq for all pairs of a column j.
DUCTILE_INLINE void BlockLdlt::factor_general() noexcept {
    general_ = true;
    const int* update = update_.data();
    for (int j = 0; j < n_; ++j) {
        const Lu<double, 6>& pivot = pivots_[at(j)] = Lu<double, 6>(diagonal_[at(j)]);
        const int begin = column_[at(j)], end = column_[at(j) + 1];
        for (int q = begin; q < end; ++q) {
            for (int c = 0; c < 6; ++c) {
                across_[at(q)].col(c) = pivot.solve(Entry(across_[at(q)].col(c)));
            }
        }
        for (int q = begin; q < end; ++q) {
            diagonal_[at(row_[at(q)])].noalias() -= off_[at(q)] * across_[at(q)];
            for (int r = q + 1; r < end; ++r, ++update) {
                off_[at(*update)].noalias() -= off_[at(r)] * across_[at(q)];
                across_[at(*update)].noalias() -= off_[at(q)] * across_[at(r)];
            }
        }
    }
}

DUCTILE_INLINE void BlockLdlt::solve_general() const noexcept {
    for (int j = 0; j < n_; ++j) {
        Entry& z = solution_[at(j)];
        z = pivots_[at(j)].solve(z);
        for (int q = column_[at(j)]; q < column_[at(j) + 1]; ++q) {
            solution_[at(row_[at(q)])].noalias() -= off_[at(q)] * z;
        }
    }
    for (int j = n_ - 1; j >= 0; --j) {
        for (int q = column_[at(j)]; q < column_[at(j) + 1]; ++q) {
            solution_[at(j)].noalias() -= across_[at(q)] * solution_[at(row_[at(q)])];
        }
    }
}

DUCTILE_INLINE void BlockLdlt::solve(std::vector<Entry>& x) const noexcept {
    for (int j = 0; j < n_; ++j) solution_[at(j)] = x[at(order_[at(j)])];
    general_ ? solve_general() : solve_symmetric();
    for (int j = 0; j < n_; ++j) x[at(order_[at(j)])] = solution_[at(j)];
}

DUCTILE_INLINE void BlockLdlt::solve_symmetric() const noexcept {
    for (int j = 0; j < n_; ++j) {
        Entry& z = solution_[at(j)];
        const Block& d = diagonal_[at(j)];
        for (int c = 0; c < 6; ++c) {
            for (int r = c + 1; r < 6; ++r) z[r] -= d(r, c) * z[c];
        }
        for (int q = column_[at(j)]; q < column_[at(j) + 1]; ++q) {
            solution_[at(row_[at(q)])].noalias() -= off_[at(q)] * z;
        }
    }
    for (int j = n_ - 1; j >= 0; --j) {
        Entry& z = solution_[at(j)];
        const Block& d = diagonal_[at(j)];
        for (int k = 0; k < 6; ++k) z[k] /= d(k, k);
        for (int q = column_[at(j)]; q < column_[at(j) + 1]; ++q) {
            z.noalias() -= off_[at(q)].transpose() * solution_[at(row_[at(q)])];
        }
        for (int c = 5; c >= 0; --c) {
            for (int r = c + 1; r < 6; ++r) z[c] -= d(r, c) * z[r];
        }
    }
}

} // namespace ductile::numeric
