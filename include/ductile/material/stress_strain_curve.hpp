// SPDX-License-Identifier: MIT
//
// Monotonic stress-strain curve as pairs, straight between them and through the origin to the first
// pair. Strain and stress are engineering values (change of length and force over the original
// length and area), as a tensile test reports them and as a section with its original area needs
// them; `engineering_from_true` and `true_from_engineering` convert up to the onset of necking.
//
// Compression mirrors tension. Beyond the last pair the stress stays at its last value: fracture is
// a criterion of its own, not a hole in the curve.
//
// Source: conversion of a uniformly stretched bar of constant volume, e.g. Dieter (1986),
// Mechanical Metallurgy, ch. 8: eps_true = ln(1 + eps), sigma_true = sigma (1 + eps).
//
// Symbols
//   eps   engineering strain               [-]
//   sigma engineering stress               [Pa]
//   E     Young's modulus, sigma_1 / eps_1 [Pa]
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ductile/material.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct StressStrainPoint {
    S strain = std::numeric_limits<S>::quiet_NaN(); ///< [-]
    S stress = std::numeric_limits<S>::quiet_NaN(); ///< [Pa]

    bool operator==(const StressStrainPoint&) const = default;
};

/// Force over actual area against the logarithm of the stretch, from engineering values.
template <std::floating_point S>
[[nodiscard]] StressStrainPoint<S> true_from_engineering(StressStrainPoint<S> point) noexcept {
    return {.strain = std::log1p(point.strain), .stress = point.stress * (1 + point.strain)};
}

/// Inverse of `true_from_engineering`.
template <std::floating_point S>
[[nodiscard]] StressStrainPoint<S> engineering_from_true(StressStrainPoint<S> point) noexcept {
    return {.strain = std::expm1(point.strain), .stress = point.stress * std::exp(-point.strain)};
}

template <std::floating_point S>
struct StressStrainCurveParameters {
    S youngs_modulus = std::numeric_limits<S>::quiet_NaN(); ///< E [Pa], > 0
    /// At least two; strain and stress > 0, strain strictly increasing, the first on E within 1 %
    /// (tables are rounded), no piece steeper than E. The stress may fall.
    std::vector<StressStrainPoint<S>> points = {};
};

/// Immutable; all members but the constructor and copies are noexcept and allocate nothing.
/// Thread-safe to read.
template <std::floating_point S>
class StressStrainCurve {
  public:
    using Scalar = S;

    /// Relative deviation of the first pair from E that is taken as rounding of a table.
    static constexpr S rounding_of_tables = S(0.01);

    /// @throws std::invalid_argument where E is missing or a pair breaks the rules above.
    explicit StressStrainCurve(StressStrainCurveParameters<S> parameters)
        : points_(std::move(parameters.points)) {
        check_points(
            check::positive("StressStrainCurve.youngs_modulus", parameters.youngs_modulus, "Pa"));
        points_.shrink_to_fit();
    }

    /// sigma(eps) [Pa], odd in eps. O(log n).
    [[nodiscard]] S stress(S strain) const noexcept {
        const S size = std::abs(strain);
        const std::size_t end = piece_end(size);
        if (end == 0) return slope(0) * strain; // without round-off at zero
        const S value = end == points_.size()
                            ? points_.back().stress
                            : points_[end].stress - slope(end) * (points_[end].strain - size);
        return std::copysign(value, strain);
    }

    /// d sigma/d eps [Pa], even in eps; at a pair that of the piece beyond it. O(log n).
    [[nodiscard]] S tangent(S strain) const noexcept {
        const std::size_t end = piece_end(std::abs(strain));
        return end == points_.size() ? S(0) : slope(end);
    }

    [[nodiscard]] S youngs_modulus() const noexcept { return slope(0); }               ///< E [Pa]
    [[nodiscard]] S yield_strain() const noexcept { return points_.front().strain; }   ///< [-]
    [[nodiscard]] S yield_stress() const noexcept { return points_.front().stress; }   ///< [Pa]
    [[nodiscard]] S ultimate_strain() const noexcept { return points_.back().strain; } ///< last [-]
    [[nodiscard]] std::span<const StressStrainPoint<S>> points() const noexcept { return points_; }

  private:
    /// Index of the first pair beyond `strain` >= 0; the number of pairs where there is none.
    [[nodiscard]] std::size_t piece_end(S strain) const noexcept {
        const auto beyond =
            std::upper_bound(points_.begin(), points_.end(), strain,
                             [](S value, const auto& point) { return value < point.strain; });
        return static_cast<std::size_t>(beyond - points_.begin());
    }

    /// Slope of the piece that ends at pair `end`.
    [[nodiscard]] S slope(std::size_t end) const noexcept {
        const StressStrainPoint<S>& to = points_[end];
        if (end == 0) return to.stress / to.strain;
        const StressStrainPoint<S>& from = points_[end - 1];
        return (to.stress - from.stress) / (to.strain - from.strain);
    }

    void check_points(S youngs_modulus) const {
        if (points_.size() < 2) {
            check::fail("StressStrainCurve.points", static_cast<S>(points_.size()), "",
                        "at least 2 pairs");
        }
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const std::string name = "StressStrainCurve.points[" + std::to_string(i) + "]";
            check::positive(name + ".strain", points_[i].strain, "");
            check::positive(name + ".stress", points_[i].stress, "Pa");
            if (i > 0 && !(points_[i].strain > points_[i - 1].strain)) {
                check::fail(name + ".strain", points_[i].strain, "", "> the strain before it");
            }
            if (i > 0 && slope(i) > youngs_modulus * (1 + rounding_of_tables)) {
                check::fail(name + ".stress", points_[i].stress, "Pa",
                            "reached with a slope <= youngs_modulus");
            }
        }
        if (std::abs(slope(0) - youngs_modulus) > rounding_of_tables * youngs_modulus) {
            check::fail("StressStrainCurve.points[0].stress", points_[0].stress, "Pa",
                        "youngs_modulus * strain within 1 %: a curve starts elastic");
        }
    }

    std::vector<StressStrainPoint<S>> points_;
};

template <std::floating_point S>
StressStrainCurve(StressStrainCurveParameters<S>) -> StressStrainCurve<S>;

/// Elastic, then perfectly plastic: up to f_y at E, then level to `last_strain` (> f_y/E).
/// @throws std::invalid_argument where a value is missing or out of range.
template <std::floating_point S>
[[nodiscard]] StressStrainCurve<S> elastic_perfectly_plastic(S youngs_modulus, S yield_stress,
                                                             S last_strain) {
    return StressStrainCurve<S>(
        {.youngs_modulus = youngs_modulus,
         .points = {{yield_stress / youngs_modulus, yield_stress}, {last_strain, yield_stress}}});
}

/// Elastic to f_y, then straight to f_u at eps_u, as EN 1992-1-1, 3.2.7(2)a has it for reinforcing
/// steel. Where eps_u is the elongation after fracture the line is below the curve of a test, which
/// has its largest stress before. Of such a curve moment_rotation makes the hardening law of a
/// hinge.
/// @throws std::invalid_argument where the material has no ultimate stress or no limit of strain.
template <std::floating_point S>
[[nodiscard]] StressStrainCurve<S> elastic_hardening(const Material<S>& material) {
    const S stress = check::positive(
        "Material.ultimate_stress",
        material.ultimate_stress().value_or(std::numeric_limits<S>::quiet_NaN()), "Pa");
    const S strain = check::positive("Material.ultimate_strain", material.ultimate_strain(), "");
    return StressStrainCurve<S>(
        {.youngs_modulus = material.youngs_modulus(),
         .points = {{material.yield_strain(), material.yield_stress()}, {strain, stress}}});
}

} // namespace ductile
