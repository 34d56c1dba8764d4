// SPDX-License-Identifier: MIT
//
// Eigenvalues and eigenvectors of a symmetric 3×3 matrix: the principal axes of an inertia.
//
//   A = V diag(w) Vᵀ
//
// Source: Golub & Van Loan (2013), Matrix Computations, 4th edition, algorithm 8.5.2 (cyclic
// Jacobi). Limit cases: diagonal A: V is the identity, and w is not sorted.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/vocabulary/vector.hpp"

namespace ductile::numeric {

template <std::floating_point S>
struct SymmetricAxes {
    Vector3<S> values = Vector3<S>::Zero();
    Matrix3<S> axes = Matrix3<S>::Identity(); ///< columns, orthonormal, right-handed
};

/// Of the lower and upper half alike. Exact to round-off of the largest entry.
template <std::floating_point S>
[[nodiscard]] SymmetricAxes<S> symmetric_axes(Matrix3<S> a) noexcept {
    SymmetricAxes<S> result;
    constexpr int sweeps = 16; // quadratic: 6 are enough
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const S off = std::abs(a(0, 1)) + std::abs(a(0, 2)) + std::abs(a(1, 2));
        const S on = std::abs(a(0, 0)) + std::abs(a(1, 1)) + std::abs(a(2, 2));
        if (!(off > std::numeric_limits<S>::epsilon() / 8 * on)) break;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (a(p, q) == 0) continue;
                const S tau = (a(q, q) - a(p, p)) / (2 * a(p, q));
                const S t = std::copysign(S(1), tau) / (std::abs(tau) + std::hypot(S(1), tau));
                const S c = 1 / std::hypot(S(1), t), s = t * c;
                Matrix3<S> turn = Matrix3<S>::Identity();
                turn(p, p) = turn(q, q) = c;
                turn(p, q) = s;
                turn(q, p) = -s;
                a = ductile::times(transposed_times(turn, a), turn);
                a(p, q) = a(q, p) = 0;
                result.axes = ductile::times(result.axes, turn);
            }
        }
    }
    for (int i = 0; i < 3; ++i) result.values[i] = a(i, i);
    return result;
}

} // namespace ductile::numeric
