// SPDX-License-Identifier: MIT
//
// Constants of the strain-life curve of a material, for low-cycle fatigue.
//
//   eps_a = (sigma_f'/E) (2N)^b + eps_f' (2N)^c
//
// The second term is the law of Coffin and Manson for the plastic strain amplitude, the first that of
// Basquin for the elastic one. Without sigma_f' only the plastic term is there.
//
// Source: L. F. Coffin (1954), Trans. ASME 76, 931-950; S. S. Manson (1953), NACA TN 2933;
// J. Morrow (1965), ASTM STP 378, 45-87.
//
// Symbols
//   2N        reversals to failure             [-]
//   eps_f', c fatigue ductility coefficient, exponent  [-]
//   sigma_f', b fatigue strength coefficient, exponent [Pa, -]
#pragma once

#include <concepts>
#include <limits>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// An aggregate; `checked` says whether its values can be used.
template <std::floating_point S>
struct FatigueConstants {
    S ductility_coefficient = std::numeric_limits<S>::quiet_NaN(); ///< eps_f' [-], > 0
    S ductility_exponent = std::numeric_limits<S>::quiet_NaN();    ///< c [-], in (-1, 0)
    S strength_coefficient = 0; ///< sigma_f' [Pa], >= 0; 0: no elastic term
    S strength_exponent = 0;    ///< b [-], in (-1, 0) where there is an elastic term

    bool operator==(const FatigueConstants&) const = default;
};

/// The constants, unchanged.
/// @throws std::invalid_argument where one is missing (NaN) or out of range.
template <std::floating_point S>
FatigueConstants<S> checked(const FatigueConstants<S>& constants) {
    check::positive("FatigueConstants.ductility_coefficient", constants.ductility_coefficient, "");
    check::between("FatigueConstants.ductility_exponent", constants.ductility_exponent, S(-1), S(0),
                   "");
    check::non_negative("FatigueConstants.strength_coefficient", constants.strength_coefficient, "Pa");
    if (constants.strength_coefficient > 0) {
        check::between("FatigueConstants.strength_exponent", constants.strength_exponent, S(-1), S(0),
                       "");
    }
    return constants;
}

} // namespace ductile
