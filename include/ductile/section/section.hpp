// SPDX-License-Identifier: MIT
//
// What every cross-section offers, and what follows from it and a material. One header per shape:
// rectangle, notched rectangle, circle, tube, box, I, T, L, channel, polygon.
//
// Axes. x and y lie in the section and meet at its centroid: x to the right, y up; z runs along the
// member. Bending *about* x strains fibres by their height y, bending about y by their height x.
// Where an axis can be left out it is x. Neither axis need be a principal one (see principal.hpp).
//
// Symbols
//   A    area                                                                   [m²]
//   I    second moment of area about a centroidal axis: I_x = ∫ y² dA           [m⁴]
//   I_xy product of inertia ∫ x y dA                                            [m⁴]
//   W_el elastic section modulus I / (distance of extreme fibre)                [m³]
//   W_pl plastic section modulus, about the parallel axis that halves the area  [m³]
//   A_v  area that carries a shear force when all of it flows                   [m²]
//   A_s  area that carries it elastically: shear angle = V / (G A_s)            [m²]
//   J    torsion constant of St Venant, twist per length = T / (G J)            [m⁴]
//   W_T  plastic torsion modulus, twice the volume of the sand heap             [m³]
//   M_y  moment at first yield, f_y W_el                                        [N m]
//   M_p  plastic moment, f_y W_pl                                               [N m]
//
// Shear. A solid section flows as a whole, A_v = A, and is stiff as A_s = 5/6 A (rectangle, polygon)
// or 6/7 A (circle): G. R. Cowper (1966), J. Appl. Mech. 33, 335-340, at nu = 0. In a thin-walled
// section the stress runs along the walls: A_v is the area of the walls parallel to the force, corners
// included (AISC 360-16, chapter G; EN 1993-1-1, 6.2.6 for the round tube), and A_s counts a wall held
// by others at both ends fully and one with a free end by 5/6.
#pragma once

#include <concepts>

#include "ductile/material.hpp"

namespace ductile {

/// A centroidal axis of a section: the one bent about, or the one a shear force acts along.
enum class SectionAxis { x, y };

/// A cross-section bent about its x axis. All results are positive and finite.
template <class T>
concept Section = requires(const T section) {
    typename T::Scalar;
    { section.area() } -> std::same_as<typename T::Scalar>;
    { section.second_moment() } -> std::same_as<typename T::Scalar>;
    { section.elastic_modulus() } -> std::same_as<typename T::Scalar>;
    { section.plastic_modulus() } -> std::same_as<typename T::Scalar>;
};

/// A section bent about either axis.
template <class T>
concept BiaxialSection = Section<T> && requires(const T section, SectionAxis axis) {
    { section.second_moment(axis) } noexcept -> std::same_as<typename T::Scalar>;
    { section.product_of_inertia() } noexcept -> std::same_as<typename T::Scalar>;
    { section.elastic_modulus(axis) } noexcept -> std::same_as<typename T::Scalar>;
    { section.plastic_modulus(axis) } noexcept -> std::same_as<typename T::Scalar>;
};

/// A section that carries shear along either axis and torsion.
template <class T>
concept ShearSection = requires(const T section, SectionAxis axis) {
    { section.shear_area(axis) } noexcept -> std::same_as<typename T::Scalar>;
    { section.elastic_shear_area(axis) } noexcept -> std::same_as<typename T::Scalar>;
    { section.torsion_constant() } noexcept -> std::same_as<typename T::Scalar>;
    { section.plastic_torsion_modulus() } noexcept -> std::same_as<typename T::Scalar>;
};

/// What integration over fibres needs: the total length of the chord at a height measured from the
/// centroid (0 outside the section, either limit where the width jumps), and the lowest (< 0) and
/// highest (> 0) fibre. Bending about x; every section here also takes a SectionAxis as last argument,
/// and for SectionAxis::y heights are x.
template <class T>
concept SectionWidth = requires(const T section, typename T::Scalar height) {
    { section.width_at(height) } noexcept -> std::same_as<typename T::Scalar>;
    { section.lowest() } noexcept -> std::same_as<typename T::Scalar>;
    { section.highest() } noexcept -> std::same_as<typename T::Scalar>;
};

/// All of the above: enough for a joint of six axes.
template <class T>
concept FullSection = BiaxialSection<T> && ShearSection<T> && SectionWidth<T>;

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

/// M_y about `axis` [N m].
template <BiaxialSection T>
[[nodiscard]] typename T::Scalar yield_moment(const T& section,
                                              const Material<typename T::Scalar>& material,
                                              SectionAxis axis) noexcept {
    return material.yield_stress() * section.elastic_modulus(axis);
}

/// M_p about `axis` [N m].
template <BiaxialSection T>
[[nodiscard]] typename T::Scalar plastic_moment(const T& section,
                                                const Material<typename T::Scalar>& material,
                                                SectionAxis axis) noexcept {
    return material.yield_stress() * section.plastic_modulus(axis);
}

} // namespace ductile
