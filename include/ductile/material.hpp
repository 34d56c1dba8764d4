// SPDX-License-Identifier: MIT
//
// An isotropic ductile material: what a section needs to know to have a strength and a stiffness.
//
// Symbols
//   rho  density                    [kg/m³]
//   E    Young's modulus            [Pa]
//   nu   Poisson's ratio            [-]
//   f_y  yield stress               [Pa]
//   G    shear modulus E/(2(1+nu))  [Pa]
#pragma once

#include <concepts>
#include <limits>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct MaterialParameters {
    S density = std::numeric_limits<S>::quiet_NaN();        ///< rho [kg/m³], > 0
    S youngs_modulus = std::numeric_limits<S>::quiet_NaN(); ///< E [Pa], > 0
    S poisson_ratio = std::numeric_limits<S>::quiet_NaN();  ///< nu [-], in (-1, 0.5)
    S yield_stress = std::numeric_limits<S>::quiet_NaN();   ///< f_y [Pa], > 0
};

/// Immutable value; all members are noexcept after construction.
template <std::floating_point S>
class Material {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN) or out of range.
    explicit Material(const MaterialParameters<S>& parameters)
        : density_(check::positive("Material.density", parameters.density, "kg/m^3")),
          youngs_modulus_(check::positive("Material.youngs_modulus", parameters.youngs_modulus, "Pa")),
          poisson_ratio_(check::between("Material.poisson_ratio", parameters.poisson_ratio, S(-1),
                                        S(0.5), "")),
          yield_stress_(check::positive("Material.yield_stress", parameters.yield_stress, "Pa")) {}

    [[nodiscard]] S density() const noexcept { return density_; }               ///< rho [kg/m³]
    [[nodiscard]] S youngs_modulus() const noexcept { return youngs_modulus_; } ///< E [Pa]
    [[nodiscard]] S poisson_ratio() const noexcept { return poisson_ratio_; }   ///< nu [-]
    [[nodiscard]] S yield_stress() const noexcept { return yield_stress_; }     ///< f_y [Pa]

    /// G = E / (2 (1 + nu)) [Pa]
    [[nodiscard]] S shear_modulus() const noexcept {
        return youngs_modulus_ / (2 * (1 + poisson_ratio_));
    }

  private:
    S density_;
    S youngs_modulus_;
    S poisson_ratio_;
    S yield_stress_;
};

template <std::floating_point S>
Material(const MaterialParameters<S>&) -> Material<S>;

} // namespace ductile
