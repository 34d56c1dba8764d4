// SPDX-License-Identifier: MIT
//
// Materials by name, with guaranteed (lower) values of their standards, not means of a batch: real
// steel is usually 10 to 25 % stronger than its name. For thin products (up to 16 mm, aluminium and
// iron as noted) at room temperature.
//
// Sources; each value names its own
//   structural steel   EN 10025-2:2019, tables 7 and 8 (R_eH up to 16 mm, R_m and A along the
//   rolling
//                      direction, 3 to 40 mm); EN 1993-1-1:2005, 3.2.6; EN 1991-1-1:2002, table
//                      A.4. EN 1993-1-1, table 3.1 has other R_m for design: 490 MPa for S355
//   reinforcing steel  EN 1992-1-1:2004, 3.2.7 and annex C, class B
//   EN AW-6061 T6      EN 1999-1-1:2007, 3.2.5, table 3.2b (extruded, up to 20 mm; the guaranteed
//   values
//                      of EN 755-2) and table 3.2a (sheet and plate, T6 up to 12.5 mm; EN 485-2)
//   grey cast iron     EN 1561:2011, annex A (separately cast bar of 30 mm)
//   fatigue            uniform material law, A. Bäumel and T. Seeger (1990), Materials Data for
//   Cyclic
//                      Loading, Supplement 1, Elsevier. From the tensile strength R_m:
//                        steel      sigma_f' = 1.5 R_m,  b = -0.087, eps_f' = 0.59 psi, c = -0.58,
//                                   psi = 1 where R_m/E <= 0.003, as it is for all steels here
//                        aluminium  sigma_f' = 1.67 R_m, b = -0.095, eps_f' = 0.35,     c = -0.69
//                      Both are of polished specimens. Ribbed bars last less, as cracks start at
//                      the ribs: J. B. Mander, F. D. Panthaki, A. Kasalanati (1994), Low-cycle
//                      fatigue behavior of reinforcing steel, J. Mater. Civ. Eng. 6(4), 453-468,
//                      rounded:
//                        bars       eps_f' = 0.08, c = -0.5 of the plastic strain, no elastic term
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
constexpr FatigueConstants<S> law_of_ribbed_bars() noexcept {
    return {.ductility_coefficient = S(0.08), .ductility_exponent = S(-0.5)};
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
    return {.density = S(7850),          // EN 1991-1-1, table A.4: 78.5 kN/m³
            .youngs_modulus = S(210e9),  // EN 1993-1-1, 3.2.6
            .poisson_ratio = S(0.3),     // EN 1993-1-1, 3.2.6
            .yield_stress = S(235e6),    // EN 10025-2, table 7: R_eH
            .ultimate_stress = S(360e6), // EN 10025-2, table 7: R_m
            .ultimate_strain = S(0.26),  // EN 10025-2, table 8: A
            .fatigue = detail::uniform_law_of_steel(S(360e6))};
}

/// Structural steel S355: f_y 355 MPa, R_m 470 MPa, A 22 %.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> s355() noexcept {
    return {.density = S(7850),          // EN 1991-1-1, table A.4: 78.5 kN/m³
            .youngs_modulus = S(210e9),  // EN 1993-1-1, 3.2.6
            .poisson_ratio = S(0.3),     // EN 1993-1-1, 3.2.6
            .yield_stress = S(355e6),    // EN 10025-2, table 7: R_eH
            .ultimate_stress = S(470e6), // EN 10025-2, table 7: R_m
            .ultimate_strain = S(0.22),  // EN 10025-2, table 8: A
            .fatigue = detail::uniform_law_of_steel(S(470e6))};
}

/// Reinforcing steel B500B: f_yk 500 MPa, f_t = 1.08 f_yk, eps_uk 5 %. EN 1992 gives no Poisson
/// ratio; 0.3 is that of steel.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> b500b() noexcept {
    return {.density = S(7850),          // EN 1992-1-1, 3.2.7(3)
            .youngs_modulus = S(200e9),  // EN 1992-1-1, 3.2.7(4)
            .poisson_ratio = S(0.3),     // EN 1993-1-1, 3.2.6
            .yield_stress = S(500e6),    // EN 1992-1-1, annex C: f_yk
            .ultimate_stress = S(540e6), // EN 1992-1-1, table C.1: (f_t/f_y)_k = 1.08
            .ultimate_strain = S(0.05),  // EN 1992-1-1, table C.1: eps_uk of class B
            .fatigue = detail::law_of_ribbed_bars<S>()};
}

/// Aluminium alloy EN AW-6061 in temper T6, extruded, up to 20 mm: f_o 240 MPa, f_u 260 MPa, A 8 %.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> aluminium_6061_t6_extruded() noexcept {
    return {.density = S(2700),          // EN 1999-1-1, 3.2.5
            .youngs_modulus = S(70e9),   // EN 1999-1-1, 3.2.5
            .poisson_ratio = S(0.3),     // EN 1999-1-1, 3.2.5
            .yield_stress = S(240e6),    // EN 1999-1-1, table 3.2b: f_o
            .ultimate_stress = S(260e6), // EN 1999-1-1, table 3.2b: f_u
            .ultimate_strain = S(0.08),  // EN 1999-1-1, table 3.2b: A
            .fatigue = detail::uniform_law_of_aluminium(S(260e6))};
}

/// The same alloy in temper T6 as sheet up to 12.5 mm: f_o 240 MPa, f_u 290 MPa, A50 6 %.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> aluminium_6061_t6_sheet() noexcept {
    MaterialParameters<S> sheet = aluminium_6061_t6_extruded<S>(); // the same f_o
    sheet.ultimate_stress = S(290e6);                              // EN 1999-1-1, table 3.2a: f_u
    sheet.ultimate_strain = S(0.06);                               // EN 1999-1-1, table 3.2a: A50
    sheet.fatigue = detail::uniform_law_of_aluminium(S(290e6));
    return sheet;
}

/// Grey cast iron EN-GJL-250, brittle: R_p0.1 165 MPa, R_m 250 MPa, A 0.3 to 0.8 %, E 103 to 118
/// GPa. It hardly yields and compression is far stronger than tension; these are the values in
/// tension.
template <std::floating_point S>
[[nodiscard]] constexpr MaterialParameters<S> cast_iron_gjl_250() noexcept {
    return {.density = S(7200),           // EN 1561, annex A: 7.20 g/cm³
            .youngs_modulus = S(110e9),   // EN 1561, annex A: middle of 103 to 118 GPa
            .poisson_ratio = S(0.26),     // EN 1561, annex A
            .yield_stress = S(165e6),     // EN 1561, annex A: R_p0.1, least of 165 to 228 MPa
            .ultimate_stress = S(250e6),  // EN 1561, annex A: R_m, least of 250 to 350 MPa
            .ultimate_strain = S(0.003)}; // EN 1561, annex A: A, least of 0.3 to 0.8 %
}

} // namespace ductile
