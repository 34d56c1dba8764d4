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
//   f_u  ultimate stress            [Pa]
//   eps_y, eps_u  strain at yield f_y/E and at fracture [-]
//
// Stress beyond yield is a curve of its own, material/stress_strain_curve.hpp; named materials are
// in material/named.hpp.
#pragma once

#include <concepts>
#include <limits>
#include <optional>

#include "ductile/material/fatigue_constants.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct MaterialParameters {
    S density = std::numeric_limits<S>::quiet_NaN();        ///< rho [kg/m³], > 0
    S youngs_modulus = std::numeric_limits<S>::quiet_NaN(); ///< E [Pa], > 0
    S poisson_ratio = std::numeric_limits<S>::quiet_NaN();  ///< nu [-], in (-1, 0.5)
    S yield_stress = std::numeric_limits<S>::quiet_NaN();   ///< f_y [Pa], from 1e-7 E to E
    /// f_u [Pa], largest engineering stress, >= f_y; none: not known
    std::optional<S> ultimate_stress = std::nullopt;
    /// eps_u [-], total engineering strain at which a fibre parts, > f_y/E; infinity: never
    S ultimate_strain = std::numeric_limits<S>::infinity();
    std::optional<FatigueConstants<S>> fatigue = std::nullopt; ///< none: no low-cycle fatigue
};

/// Immutable value; all members are noexcept after construction.
template <std::floating_point S>
class Material {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN) or out of range.
    explicit Material(const MaterialParameters<S>& parameters)
        : density_(check::positive("Material.density", parameters.density, "kg/m^3")),
          youngs_modulus_(
              check::positive("Material.youngs_modulus", parameters.youngs_modulus, "Pa")),
          poisson_ratio_(check::between("Material.poisson_ratio", parameters.poisson_ratio, S(-1),
                                        S(0.5), "")),
          yield_stress_(checked_yield_stress(parameters)),
          ultimate_stress_(checked_ultimate_stress(parameters)),
          ultimate_strain_(checked_ultimate_strain(parameters)),
          fatigue_(parameters.fatigue) {
        if (fatigue_) checked(*fatigue_);
    }

    [[nodiscard]] S density() const noexcept { return density_; }               ///< rho [kg/m³]
    [[nodiscard]] S youngs_modulus() const noexcept { return youngs_modulus_; } ///< E [Pa]
    [[nodiscard]] S poisson_ratio() const noexcept { return poisson_ratio_; }   ///< nu [-]
    [[nodiscard]] S yield_stress() const noexcept { return yield_stress_; }     ///< f_y [Pa]

    /// f_u [Pa], where it is known.
    [[nodiscard]] const std::optional<S>& ultimate_stress() const noexcept {
        return ultimate_stress_;
    }
    [[nodiscard]] S ultimate_strain() const noexcept { return ultimate_strain_; } ///< eps_u [-]
    [[nodiscard]] S yield_strain() const noexcept { return yield_stress_ / youngs_modulus_; }

    /// Constants for low-cycle fatigue, where the material has them.
    [[nodiscard]] const std::optional<FatigueConstants<S>>& fatigue() const noexcept {
        return fatigue_;
    }

    /// G = E / (2 (1 + nu)) [Pa]
    [[nodiscard]] S shear_modulus() const noexcept {
        return youngs_modulus_ / (2 * (1 + poisson_ratio_));
    }

  private:
    /// Nothing yields at a strain of 1e-7 or beyond 1: one of both is in MPa or GPa.
    static S checked_yield_stress(const MaterialParameters<S>& parameters) {
        constexpr auto field = "Material.yield_stress";
        const S stress = check::positive(field, parameters.yield_stress, "Pa");
        const S strain = stress / parameters.youngs_modulus;
        if (strain < S(1e-7) || strain > 1) {
            check::fail(field, stress, "Pa", "from 1e-7 to 1 of youngs_modulus, both in Pa");
        }
        return stress;
    }
    static std::optional<S> checked_ultimate_stress(const MaterialParameters<S>& parameters) {
        if (!parameters.ultimate_stress) return std::nullopt;
        constexpr auto field = "Material.ultimate_stress";
        check::positive(field, *parameters.ultimate_stress, "Pa");
        if (*parameters.ultimate_stress < parameters.yield_stress) {
            check::fail(field, *parameters.ultimate_stress, "Pa", ">= yield_stress");
        }
        return parameters.ultimate_stress;
    }
    static S checked_ultimate_strain(const MaterialParameters<S>& parameters) {
        constexpr auto field = "Material.ultimate_strain";
        check::positive_or_infinite(field, parameters.ultimate_strain, "");
        if (!(parameters.ultimate_strain > parameters.yield_stress / parameters.youngs_modulus)) {
            check::fail(field, parameters.ultimate_strain, "",
                        "> yield_stress / youngs_modulus (infinity: no limit)");
        }
        return parameters.ultimate_strain;
    }

    S density_;
    S youngs_modulus_;
    S poisson_ratio_;
    S yield_stress_;
    std::optional<S> ultimate_stress_;
    S ultimate_strain_;
    std::optional<FatigueConstants<S>> fatigue_;
};

template <std::floating_point S>
Material(const MaterialParameters<S>&) -> Material<S>;

} // namespace ductile
