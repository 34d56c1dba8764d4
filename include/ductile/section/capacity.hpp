// SPDX-License-Identifier: MIT
//
// Strength and elastic stiffness of a joint on all six axes, from section, material and the length of
// member the joint stands for.
//
//   axis      capacity             stiffness
//   Fx, Fy    V_p = tau_y A_v      G A_s/L     shear along x, y
//   Fz        N_p = f_y A          E A/L       along the member
//   Mx, My    M_p = f_y W_pl       E I/L       bending about x, y: rotation of the two ends of a piece
//                                              of length L under constant moment
//   Mz        T_p = tau_y W_T      G J/L       torsion
//
// Each is that of its axis alone; how they combine is a yield surface. Where x and y are not principal
// axes (L sections) bending about one of them is that of a member held sideways. Models of A_v, A_s
// and J: section.hpp and the section's own header; warping is left out, as for a joint that warps
// freely.
//
// Source: R. von Mises (1913), H. Tresca (1864); Neal (1977), The Plastic Methods of Structural
// Analysis, ch. 1; Gere and Timoshenko, Mechanics of Materials.
//
// Symbols
//   tau_y  yield stress in shear, f_y/√3 (von Mises) or f_y/2 (Tresca) [Pa]
//   L      length of member that the joint stands for                 [m]
#pragma once

#include <array>
#include <concepts>
#include <limits>
#include <numbers>

#include "ductile/material.hpp"
#include "ductile/section/section.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// Which shear stress makes a material flow.
enum class ShearYield { von_mises, tresca };

/// tau_y [Pa].
template <std::floating_point S>
[[nodiscard]] S shear_yield_stress(const Material<S>& material,
                                   ShearYield criterion = ShearYield::von_mises) noexcept {
    return criterion == ShearYield::von_mises
               ? material.yield_stress() * std::numbers::inv_sqrt3_v<S>
               : material.yield_stress() / 2;
}

template <std::floating_point S>
struct CapacityParameters {
    S length = std::numeric_limits<S>::quiet_NaN(); ///< L [m], > 0
    ShearYield shear_yield = ShearYield::von_mises;
};

/// Both arrays in the order Fx, Fy, Fz, Mx, My, Mz: x and y in the section, z along the member.
template <std::floating_point S>
struct JointCapacity {
    std::array<S, 6> capacity{};  ///< largest force [N] and moment [N m]
    std::array<S, 6> stiffness{}; ///< elastic [N/m] and [N m/rad]

    bool operator==(const JointCapacity&) const = default;
};

/// @throws std::invalid_argument where the length is missing (NaN), infinite or not positive.
template <FullSection T>
[[nodiscard]] JointCapacity<typename T::Scalar> joint_capacity(
    const T& section, const Material<typename T::Scalar>& material,
    const CapacityParameters<typename T::Scalar>& parameters) {
    using S = typename T::Scalar;
    constexpr auto x = SectionAxis::x;
    constexpr auto y = SectionAxis::y;
    const S length = check::positive("Capacity.length", parameters.length, "m");
    const S tau = shear_yield_stress(material, parameters.shear_yield);
    const S e = material.youngs_modulus() / length;
    const S g = material.shear_modulus() / length;
    return {.capacity = {tau * section.shear_area(x), tau * section.shear_area(y),
                         material.yield_stress() * section.area(),
                         plastic_moment(section, material, x), plastic_moment(section, material, y),
                         tau * section.plastic_torsion_modulus()},
            .stiffness = {g * section.elastic_shear_area(x), g * section.elastic_shear_area(y),
                          e * section.area(), e * section.second_moment(x),
                          e * section.second_moment(y), g * section.torsion_constant()}};
}

} // namespace ductile
