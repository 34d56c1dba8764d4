// SPDX-License-Identifier: MIT
//
// Bodies of island.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/numeric/lu.hpp"
#include "ductile/solve/island.hpp"

namespace ductile::solve {

DUCTILE_INLINE IslandBody island_body(const Vector3<double>& inverse_mass,
                                      const Matrix3<double>& inverse_inertia) noexcept {
    constexpr double nothing = 1e-12; // of the largest: locked
    IslandBody body;
    for (int i = 0; i < 3; ++i) {
        body.inverse_mass(i, i) = inverse_mass[i];
        if (inverse_mass[i] > 0) body.mass(i, i) = 1 / inverse_mass[i];
    }
    Matrix3<double> inverse;
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            inverse(i, j) = (inverse_inertia(i, j) + inverse_inertia(j, i)) / 2;
        largest = std::max(largest, inverse(i, i));
    }
    std::array<bool, 3> locked{};
    for (int i = 0; i < 3; ++i) {
        locked[std::size_t(i)] = !(inverse(i, i) > nothing * largest);
        if (!locked[std::size_t(i)]) continue;
        inverse.row(i).setZero();
        inverse.col(i).setZero();
    }
    body.inverse_mass.block<3, 3>(3, 3) = inverse;
    for (int i = 0; i < 3; ++i) {
        if (locked[std::size_t(i)]) inverse(i, i) = 1;
    }
    Matrix3<double> inertia = numeric::inverse(inverse);
    body.mass.block<3, 3>(3, 3) = inertia;
    return body;
}

DUCTILE_INLINE double own_effect(const Island& island, const IslandRow& row) noexcept {
    double effect = 0;
    const auto see = [&](int body, const Vector6<double>& on) {
        if (body < 0) return;
        const Matrix6<double>& m = island.bodies[std::size_t(body)].inverse_mass;
        for (int i = 0; i < 3; ++i) { // no body turns by a force through its centre
            effect += m(i, i) * on[i] * on[i];
            for (int j = 0; j < 3; ++j) effect += m(3 + i, 3 + j) * on[3 + i] * on[3 + j];
        }
    };
    see(row.a, row.on_a);
    see(row.b, row.on_b);
    return effect;
}

} // namespace ductile::solve
