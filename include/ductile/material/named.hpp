// SPDX-License-Identifier: MIT
//
// Materials by name, with guaranteed (lower) values of their standards, not means of a batch: real
// steel is usually 10 to 25 % stronger than its name. For thin products (up to 16 mm, aluminium and
// iron as noted) at room temperature.
//
// Sources
//   structural steel   EN 10025-2:2019 (strength, elongation); EN 1993-1-1:2005, 3.2.6 (E, nu);
//                      EN 1991-1-1:2002, table A.4 (density)
//   reinforcing steel  EN 1992-1-1:2004, 3.2.7 and annex C, class B
//   6061-T6            EN 1999-1-1:2007, table 3.2b and 3.2.5 (extruded, f_o and A)
//   grey cast iron     EN 1561:2011, annex A (30 mm bar)
//   fatigue            uniform material law, A. Bäumel and T. Seeger (1990), Materials Data for Cyclic
//                      Loading, Supplement 1, Elsevier. From the tensile strength R_m:
//                        steel      sigma_f' = 1.5 R_m,  b = -0.087, eps_f' = 0.59 psi, c = -0.58,
//                                   psi = 1 where R_m/E <= 0.003, as it is for all steels here
//                        aluminium  sigma_f' = 1.67 R_m, b = -0.095, eps_f' = 0.35,     c = -0.69
// Ultimate strain is the standard's elongation after fracture (for reinforcing steel the strain at
// the largest force, which is where it necks), on the safe side of the strain in the neck.
#pragma once

#include <concepts>

#include "ductile/material.hpp"

namespace ductile {

namespace detail {

template <std::floating_point S>
constexpr FatigueConstants<S> uniform_law_of_steel(S tensile_strength) noexcept {
    return {.ductility_coefficient = S(0.59),
            .ductility_exponent = S(-0.58),
            .strength_coefficient = S(1.5) * tensile_strength,
            .strength_exponent = S(-0.087)};
}

template <std::floating_point S>
constexpr FatigueConstants<S> uniform_law_of_aluminium(S tensile_strength) noexcept {
    return {.ductility_coefficient = S(0.35),
            .ductility_exponent = S(-0.69),
            .strength_coefficient = S(1.67) * tensile_strength,
            .strength_exponent = S(-0.095)};
}

} // namespace detail

/// Structural steel S235: f_y 235 MPa, R_m 360 MPa, A 26 %.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> s235() noexcept {
    return {.density = S(7850),
            .youngs_modulus = S(210e9),
            .poisson_ratio = S(0.3),
            .yield_stress = S(235e6),
            .ultimate_strain = S(0.26),
            .fatigue = detail::uniform_law_of_steel(S(360e6))};
}

/// Structural steel S355: f_y 355 MPa, R_m 470 MPa, A 22 %.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> s355() noexcept {
    return {.density = S(7850),
            .youngs_modulus = S(210e9),
            .poisson_ratio = S(0.3),
            .yield_stress = S(355e6),
            .ultimate_strain = S(0.22),
            .fatigue = detail::uniform_law_of_steel(S(470e6))};
}

/// Reinforcing steel B500B: f_yk 500 MPa, f_t = 1.08 f_yk, eps_uk 5 %. EN 1992 gives no Poisson ratio;
/// 0.3 is that of steel.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> b500b() noexcept {
    return {.density = S(7850),
            .youngs_modulus = S(200e9),
            .poisson_ratio = S(0.3),
            .yield_stress = S(500e6),
            .ultimate_strain = S(0.05),
            .fatigue = detail::uniform_law_of_steel(S(540e6))};
}

/// Aluminium alloy EN AW-6061 in temper T6: f_o 240 MPa, f_u 260 MPa, A 8 %.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> aluminium_6061_t6() noexcept {
    return {.density = S(2700),
            .youngs_modulus = S(70e9),
            .poisson_ratio = S(0.3),
            .yield_stress = S(240e6),
            .ultimate_strain = S(0.08),
            .fatigue = detail::uniform_law_of_aluminium(S(260e6))};
}

/// Grey cast iron EN-GJL-250, brittle: R_p0.1 165 MPa, R_m 250 MPa, A 0.3 to 0.8 %, E 103 to 118 GPa.
/// It hardly yields and compression is far stronger than tension; these are the values in tension.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> cast_iron_gjl_250() noexcept {
    return {.density = S(7200),
            .youngs_modulus = S(110e9),
            .poisson_ratio = S(0.26),
            .yield_stress = S(165e6),
            .ultimate_strain = S(0.003)};
}

} // namespace ductile
