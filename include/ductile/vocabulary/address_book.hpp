// SPDX-License-Identifier: MIT
//
// Numbers addresses from 0 on, in the order in which they come, so that what is known of each can
// stand in an array. For what is listed anew in every step: nothing is given back to the allocator,
// and `clear` takes no time.
//
// A table of twice as many places, a power of two, in which an address stands at its hash or at the
// next place that is free: linear probing, Knuth, The Art of Computer Programming 3, section 6.4;
// multiplicative hash, same section.
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ductile {

class AddressBook {
  public:
    static constexpr std::size_t unknown = std::size_t(-1);

    /// The number of an address, given now where it had none.
    std::size_t enter(const void* address) {
        if (2 * (count_ + 1) > places_.size()) grow();
        Place& place = places_[find_place(address)];
        if (place.round != round_) place = {address, count_++, round_};
        return place.number;
    }
    [[nodiscard]] std::size_t find(const void* address) const {
        if (places_.empty()) return unknown;
        const Place& place = places_[find_place(address)];
        return place.round == round_ ? place.number : unknown;
    }
    [[nodiscard]] bool has(const void* address) const { return find(address) != unknown; }
    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    void clear() noexcept {
        ++round_;
        count_ = 0;
    }

  private:
    struct Place {
        const void* address = nullptr;
        std::size_t number = 0;
        std::uint64_t round = 0; ///< in which it was entered
    };

    /// Where it stands, or would.
    [[nodiscard]] std::size_t find_place(const void* address) const {
        constexpr std::uint64_t golden = 0x9E3779B97F4A7C15u; // 2^64/golden ratio
        constexpr int upper_half = 32;
        const std::uint64_t mixed =
            std::uint64_t(reinterpret_cast<std::uintptr_t>(address)) * golden;
        const std::size_t last = places_.size() - 1;
        std::size_t at = std::size_t(mixed >> upper_half) & last;
        while (places_[at].round == round_ && places_[at].address != address) at = (at + 1) & last;
        return at;
    }
    void grow() {
        constexpr std::size_t fewest = 16;
        std::vector<Place> old(places_.empty() ? fewest : 2 * places_.size());
        old.swap(places_);
        for (const Place& place : old) {
            if (place.round == round_) places_[find_place(place.address)] = place;
        }
    }

    std::vector<Place> places_;
    std::size_t count_ = 0;
    std::uint64_t round_ = 1;
};

/// What is known of each.
template <class Value>
class AddressMap {
  public:
    /// Made where there was none.
    Value& operator[](const void* address) {
        const std::size_t number = numbers_.enter(address);
        if (number == values_.size()) values_.emplace_back();
        return values_[number];
    }
    /// Null where there is none.
    [[nodiscard]] const Value* find(const void* address) const {
        const std::size_t number = numbers_.find(address);
        return number != AddressBook::unknown ? &values_[number] : nullptr;
    }
    [[nodiscard]] Value* find(const void* address) {
        const std::size_t number = numbers_.find(address);
        return number != AddressBook::unknown ? &values_[number] : nullptr;
    }
    [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }
    void clear() noexcept {
        numbers_.clear();
        values_.clear();
    }

  private:
    AddressBook numbers_;
    std::vector<Value> values_; ///< by number
};

} // namespace ductile
