// SPDX-License-Identifier: MIT
//
// The rows of a joint as a converged solver of independent rows moves them, told what the surface
// allows.
#pragma once

#include <Eigen/Core>
#include <type_traits>

#include "ductile/numeric/lu.hpp"
#include "ductile/surface/box_projection.hpp"
#include "ductile/surface/row_box.hpp"
#include "ductile/surface/stopping_force.hpp"

namespace ductile::test {

/// Rigid rows of a joint under an outside load, enforced by `Mapping`; plastic travel at the end.
struct Boxed {};
struct Exact {};

template <class Mapping, class T>
struct Rows {
    const T& surface;
    typename T::Matrix mass;
    typename T::Matrix believed_mass = mass;

    using Vector = typename T::Vector;

    Vector force = Vector::Zero(), velocity = force, last_velocity = force, travel = force;

    void step(const Vector& load, double dt) {
        const Vector loaded = velocity + numeric::inverse(mass) * load * dt;
        const Vector trial = -(mass * loaded) / dt;
        if constexpr (std::is_same_v<Mapping, Exact>) {
            force = surface.project(trial, mass);
        } else {
            const typename T::Matrix impedance = believed_mass / dt;
            force = enforce(box_along(surface, predicted_force(surface, force, velocity,
                                                               last_velocity, impedance)),
                            trial, mass);
        }
        last_velocity = velocity;
        velocity = loaded + numeric::inverse(mass) * force * dt;
        travel += velocity * dt;
    }
};

inline const Eigen::Matrix2d masses{{0.05, 0.02}, {0.02, 0.03}};

} // namespace ductile::test
