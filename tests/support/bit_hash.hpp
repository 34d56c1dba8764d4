// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

namespace ductile::test {

/// Hash of numbers by their bits, in order: FNV-1a by words of 64 bits.
class BitHash {
  public:
    void eat(double value) {
        value_ = (value_ ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
    }
    template <class Number>
    void eat(const Number* values, int count) {
        for (int i = 0; i < count; ++i) eat(double(values[i]));
    }
    [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

  private:
    std::uint64_t value_ = 1469598103934665603u;
};

} // namespace ductile::test
