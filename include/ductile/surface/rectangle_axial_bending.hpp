// SPDX-License-Identifier: MIT
//
// Rectangle under axial force and bending: m = 1 - n², neutral axis at n h/2 from the centroid.
//
// Source: e.g. Neal (1977), The Plastic Methods of Structural Analysis, chapter 6.
#pragma once

#include <concepts>

#include "ductile/surface/axial_bending.hpp"

namespace ductile {

/// n = y, m = 1 - y², a = 2: the same for every rectangle.
template <std::floating_point S>
struct RectangleProfile {
    using Scalar = S;

    [[nodiscard]] S axial(S y) const noexcept { return y; }
    [[nodiscard]] S bending(S y) const noexcept { return (1 - y) * (1 + y); }
    [[nodiscard]] S density(S /*y*/) const noexcept { return 1; }
    [[nodiscard]] S lever() const noexcept { return 2; }
};

/// Normalised surface in (n, m).
template <std::floating_point S>
class RectangleAxialBending : public AxialBending<RectangleProfile<S>> {
  public:
    RectangleAxialBending() noexcept : AxialBending<RectangleProfile<S>>({}) {}
};

static_assert(YieldSurface<RectangleAxialBending<double>> &&
              YieldSurface<RectangleAxialBending<float>>);

} // namespace ductile
