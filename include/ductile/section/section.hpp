// SPDX-License-Identifier: MIT
//
// What every cross-section offers, and what follows from it and a material.
//
// Bending is about the section's x axis, which lies in the section through its centroid; height is
// measured along y. Circle, rectangle, notched rectangle: one header each.
//
// Symbols
//   A    area                                                     [m²]
//   I    second moment of area about the centroidal x axis        [m⁴]
//   W_el elastic section modulus I / (distance of extreme fibre)  [m³]
//   W_pl plastic section modulus, about the equal-area axis       [m³]
//   M_y  moment at first yield, f_y W_el                          [N m]
//   M_p  plastic moment, f_y W_pl                                 [N m]
#pragma once

#include <concepts>

#include "ductile/material.hpp"

namespace ductile {

/// A cross-section bent about its x axis. All results are positive and finite.
template <class T>
concept Section = requires(const T section) {
    typename T::Scalar;
    { section.area() } -> std::same_as<typename T::Scalar>;
    { section.second_moment() } -> std::same_as<typename T::Scalar>;
    { section.elastic_modulus() } -> std::same_as<typename T::Scalar>;
    { section.plastic_modulus() } -> std::same_as<typename T::Scalar>;
};

/// M_y = f_y W_el [N m]: the largest moment that leaves no set.
template <Section T>
[[nodiscard]] typename T::Scalar yield_moment(const T& section,
                                              const Material<typename T::Scalar>& material) noexcept {
    return material.yield_stress() * section.elastic_modulus();
}

/// M_p = f_y W_pl [N m]: the moment at which the whole section flows.
template <Section T>
[[nodiscard]] typename T::Scalar plastic_moment(const T& section,
                                                const Material<typename T::Scalar>& material) noexcept {
    return material.yield_stress() * section.plastic_modulus();
}

} // namespace ductile
