// SPDX-License-Identifier: MIT
//
// The six rows of a link solved as if its two bodies were alone in the world: what an adapter can
// say before the engine solves, and all there is to say where the engine knows no compliance.
//
//   (K + C) λ = b - u_free,   lower dt <= λ <= upper dt
//
// Exact where no row reaches a bound. Rows that do are held there, the worst first, and the others
// solved again, until none is left; a row held is not let go any more.
//
// Symbols (vectors and matrices over the six rows, along the axes of frame B)
//   K       inverse mass at the joint        [1/kg ... 1/(kg m²)], 6×6, symmetric
//   C       compliance of the rows, diagonal [1/kg | 1/(kg m²)]
//   u_free  row velocities without the joint [m/s | rad/s]
//   b       target velocities                [m/s | rad/s]
//   λ       impulses                         [N s | N m s]
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "ductile/joint/link_types.hpp"
#include "ductile/numeric/ldlt.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// λ/dt of the rows [N | N m]. `k` and `free`: K and u_free; `dt` > 0 [s]. Zero where the bodies
/// cannot tell (both without mass on some axis). O(1): at most seven 6×6 factorisations.
template <std::floating_point S>
[[nodiscard]] Vector6<S> forces_of_isolated_pair(const std::array<RowLimits<S>, 6>& rows,
                                                 const Matrix6<S>& k, const Vector6<S>& free,
                                                 S dt) noexcept {
    Vector6<S> impulse = Vector6<S>::Zero();
    std::array<bool, 6> held{};
    for (int pass = 0; pass <= 6; ++pass) {
        Matrix6<S> system = k;
        Vector6<S> wanted;
        for (int i = 0; i < 6; ++i) {
            const RowLimits<S>& limits = rows[std::size_t(i)];
            system(i, i) += limits.compliance;
            wanted[i] = limits.bias - free[i];
            for (int j = 0; j < 6; ++j) {
                if (held[std::size_t(j)] && j != i) wanted[i] -= k(i, j) * impulse[j];
            }
        }
        for (int i = 0; i < 6; ++i) {
            if (!held[std::size_t(i)]) continue;
            for (int j = 0; j < 6; ++j) system(i, j) = system(j, i) = i == j ? S(1) : S(0);
            wanted[i] = impulse[i];
        }
        impulse = numeric::solve_semidefinite(system, wanted);
        if (!is_finite(linear(impulse)) || !is_finite(angular(impulse))) {
            return Vector6<S>::Zero();
        }

        int worst = -1;
        S most = 1;
        for (int i = 0; i < 6; ++i) {
            if (held[std::size_t(i)]) continue;
            const RowLimits<S>& limits = rows[std::size_t(i)];
            const S over = std::max(impulse[i] - limits.upper * dt, limits.lower * dt - impulse[i]);
            const S bound = std::max(std::abs(limits.upper), std::abs(limits.lower)) * dt;
            if (!(over > 0)) continue;
            const S share = bound > 0 ? 1 + over / bound : std::numeric_limits<S>::max();
            if (share > most) {
                most = share;
                worst = i;
            }
        }
        if (worst < 0) break;
        held[std::size_t(worst)] = true;
        const RowLimits<S>& limits = rows[std::size_t(worst)];
        impulse[worst] = std::clamp(impulse[worst], limits.lower * dt, limits.upper * dt);
    }
    return twist_of(scaled(1 / dt, linear(impulse)), scaled(1 / dt, angular(impulse)));
}

} // namespace ductile
