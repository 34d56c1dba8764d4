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
    IslandBody body{.inverse_mass = inverse_mass};
    Matrix3<double>& inverse = body.inverse_inertia;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            inverse(i, j) = (inverse_inertia(i, j) + inverse_inertia(j, i)) / 2;
    }
    const double largest = std::max({0.0, inverse(0, 0), inverse(1, 1), inverse(2, 2)});
    for (int i = 0; i < 3; ++i) {
        if (inverse(i, i) > nothing * largest) continue;
        for (int j = 0; j < 3; ++j) inverse(i, j) = inverse(j, i) = 0;
    }
    return body;
}

DUCTILE_INLINE Matrix6<double> mass(const IslandBody& body) noexcept {
    Matrix6<double> result = Matrix6<double>::Identity();
    Matrix3<double> inverse = body.inverse_inertia;
    for (int i = 0; i < 3; ++i) {
        if (body.inverse_mass[i] > 0) result(i, i) = 1 / body.inverse_mass[i];
        if (inverse(i, i) == 0) inverse(i, i) = 1;
    }
    set_block(result, 3, 3, numeric::inverse(inverse));
    return result;
}

DUCTILE_INLINE double own_effect(const Island& island, const IslandRow& row) noexcept {
    double effect = 0;
    const auto see = [&](int body, const Vector6<double>& on) {
        if (body < 0) return;
        const IslandBody& its = island.bodies[std::size_t(body)];
        for (int i = 0; i < 3; ++i) { // no body turns by a force through its centre
            effect += its.inverse_mass[i] * on[i] * on[i];
            for (int j = 0; j < 3; ++j) {
                effect += its.inverse_inertia(i, j) * on[3 + i] * on[3 + j];
            }
        }
    };
    see(row.a, row.on_a);
    see(row.b, row.on_b);
    return effect;
}

} // namespace ductile::solve
