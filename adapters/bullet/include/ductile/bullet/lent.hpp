// SPDX-License-Identifier: MIT
//
// Numbers of Bullet's that are others for a while.
//
// Not thread-safe.
#pragma once

#include <utility>
#include <vector>

namespace ductile::bullet {

/// Where this ends they are what they were. Each is there as long, and put once.
template <class Number>
class Lent {
  public:
    Lent() = default;
    ~Lent() { put_back(); }
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;

    void put(Number& place, Number value) {
        usual_.emplace_back(&place, place);
        place = value;
    }
    void put_back() {
        for (const auto& [place, value] : usual_) *place = value;
        usual_.clear();
    }

  private:
    std::vector<std::pair<Number*, Number>> usual_;
};

} // namespace ductile::bullet
