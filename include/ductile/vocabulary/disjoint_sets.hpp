// SPDX-License-Identifier: MIT
//
// Which of n things hang together, numbered from 0; the least number of those that do stands for
// all of them.
//
// Source: union-find with path halving, Tarjan and van Leeuwen (1984), Worst-case analysis of set
// union algorithms.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace ductile {

class DisjointSets {
  public:
    /// Each of `count` by itself.
    void reset(std::size_t count) {
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    [[nodiscard]] int size() const noexcept { return int(parent_.size()); }
    /// Who stands for all that hangs together with `one`.
    [[nodiscard]] int root(int one) noexcept {
        while (parent_[std::size_t(one)] != one) {
            int& above = parent_[std::size_t(one)];
            above = parent_[std::size_t(above)];
            one = above;
        }
        return one;
    }
    void unite(int a, int b) noexcept {
        const int of_a = root(a), of_b = root(b);
        parent_[std::size_t(std::max(of_a, of_b))] = std::min(of_a, of_b);
    }

  private:
    std::vector<int> parent_;
};

} // namespace ductile
