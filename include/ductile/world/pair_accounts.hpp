// SPDX-License-Identifier: MIT
//
// What contacts brought into a world, pair by pair, and joints of the engine's, each by itself: a
// pair that rebounds gives back what it took, one that an engine pushes apart, or pulls together,
// gives what nobody had, and what others lose as they meet is no excuse for that.
//
//   brought in = Σ over pairs of  max(0, -T),  T the least that it had taken since it touched  [J]
//
// A step can be taken back, whole or pair by pair.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <unordered_map>
#include <utility>

namespace ductile {

class PairAccounts {
    struct Account {
        double taken = 0, least = 0; ///< [J]
        std::size_t seen = 0;        ///< the step in which it touched last
    };
    struct Hash {
        [[nodiscard]] std::size_t operator()(const auto& pair) const noexcept {
            const std::hash<const void*> hash;
            return hash(pair.first) ^ (31 * hash(pair.second));
        }
    };

  public:
    using Pair = std::pair<const void*, const void*>; ///< addresses of bodies
    /// By pair; of a step: as they were before it.
    using Accounts = std::unordered_map<Pair, Account, Hash>;

    [[nodiscard]] double brought_in() const noexcept { return brought_in_; }

    /// A step begins; `all`: the one before it was of all pairs, so that what did not touch in it
    /// is apart.
    void begin_step(bool all) {
        before_.clear();
        step_before_ = step_;
        if (!all) return;
        std::erase_if(accounts_, [this](const auto& entry) { return entry.second.seen != step_; });
        ++step_;
    }
    /// A contact of the step took `energy` from the pair [J].
    void book(const Pair& pair, double energy) {
        Account& account = accounts_[pair];
        before_.emplace(pair, account);
        const double least = std::min(account.least, account.taken + energy);
        brought_in_ += account.least - least;
        account = {account.taken + energy, least, step_};
    }
    /// The step was none, of one pair or all.
    void take_back(const Pair& pair) {
        const auto was = before_.find(pair);
        if (was != before_.end()) put(pair, was->second);
    }
    void take_back() {
        for (const auto& [pair, account] : before_) put(pair, account);
        before_.clear();
        step_ = step_before_;
    }
    /// From now on it is this one.
    void swap_step(Accounts& before) noexcept { before_.swap(before); }

  private:
    void put(const Pair& pair, const Account& account) {
        Account& now = accounts_[pair];
        brought_in_ += now.least - account.least;
        now = account;
    }

    Accounts accounts_, before_;
    std::size_t step_ = 0, step_before_ = 0;
    double brought_in_ = 0;
};

} // namespace ductile
