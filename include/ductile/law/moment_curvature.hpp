// SPDX-License-Identifier: MIT
//
// Moment against curvature of a section, by integrating the stress of its fibres. Plane sections
// stay plane: a fibre at the height y has the strain ε0 + κ y, and ε0 is such that the axial force
// is the given one.
//
//   ∫ σ(ε0 + κ y) w(y) dy = N,    M(κ) = ∫ σ(ε0 + κ y) y w(y) dy
//
// Symbols
//   κ    curvature, positive: tension where y > 0           [1/m]
//   ε0   strain at the centroid                             [-]
//   w    total width of the section at the height y         [m]
//   M    moment about the centroid                          [N m]
//   N    axial force, positive: tension                     [N]
//   EI   bending stiffness E (∫ w y² - (∫ w y)²/∫ w)         [N m²]
//
// Residual curvature after unloading from κ: κ - M(κ)/EI, as long as no fibre yields in reverse
// (true of every section with a shape factor up to 2).
//
// Limit cases: κ → 0 is M = EI κ; an elastic-perfectly plastic curve and κ → ∞ is M_p.
//
// Source: any text on plastic design, e.g. Horne (1979), Plastic Theory of Structures, section 1.3;
// rectangle in closed form, M = M_p (1 - (κ_y/κ)²/3).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

#include "ductile/law/fibre_rule.hpp"
#include "ductile/law/root.hpp"
#include "ductile/law/uniaxial.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// `width_at(y)` is the total chord [m] at the height y from the centroid [m], 0 outside of
/// [lowest(), highest()].
template <class T>
concept FibreSection = requires(const T section, typename T::Scalar height) {
    { section.width_at(height) } -> std::same_as<typename T::Scalar>;
    { section.lowest() } -> std::same_as<typename T::Scalar>;
    { section.highest() } -> std::same_as<typename T::Scalar>;
};

template <std::floating_point S>
struct MomentCurvaturePoint {
    S curvature = 0;    ///< κ [1/m]
    S moment = 0;       ///< M [N m]
    S axial_strain = 0; ///< ε0 [-]
};

/// Immutable value. A call costs up to some ten integrations; meant for the construction of joints,
/// not for their steps. Allocates nothing.
template <FibreSection Section, UniaxialCurve Curve,
          class Rule = AdaptiveFibres<typename Section::Scalar>>
    requires std::same_as<typename Section::Scalar, typename Curve::Scalar> &&
             FibreRule<Rule, typename Section::Scalar>
class MomentCurvature {
  public:
    using Scalar = typename Section::Scalar;
    using Point = MomentCurvaturePoint<Scalar>;

    /// `axial_force` N [N].
    /// @throws std::invalid_argument where the section cannot carry the axial force.
    MomentCurvature(Section section, Curve curve, Rule rule = Rule{}, Scalar axial_force = 0)
        : section_(std::move(section)),
          curve_(std::move(curve)),
          rule_(std::move(rule)),
          axial_force_(axial_force),
          modulus_(initial_modulus(curve_)) {
        const Scalar area = over_height([](Scalar) { return Scalar(1); });
        const Scalar first = over_height([](Scalar y) { return y; });
        const Scalar second = over_height([](Scalar y) { return y * y; });
        axial_stiffness_ = modulus_ * area;
        bending_stiffness_ = modulus_ * (second - first * first / area);
        const Scalar carried = force_at(0, axial_strain(0));
        if (!(std::abs(carried - axial_force) <= Scalar(1e-3) * std::abs(axial_force))) {
            check::fail("MomentCurvature.axial_force", axial_force, "N",
                        "within what the section carries");
        }
    }

    [[nodiscard]] const Section& section() const noexcept { return section_; }
    [[nodiscard]] const Curve& curve() const noexcept { return curve_; }
    [[nodiscard]] Scalar bending_stiffness() const noexcept { return bending_stiffness_; } ///< EI

    /// The point at a curvature of either sign [1/m].
    [[nodiscard]] Point at(Scalar curvature) const {
        const Scalar strain = axial_strain(curvature);
        const Scalar moment =
            over_height([&](Scalar y) { return curve_.stress(strain + curvature * y) * y; });
        return {curvature, moment, strain};
    }
    [[nodiscard]] Scalar moment(Scalar curvature) const { return at(curvature).moment; } ///< [N m]

    /// Curvature left after elastic unloading from `curvature` [1/m].
    [[nodiscard]] Scalar residual_curvature(Scalar curvature) const {
        return curvature - moment(curvature) / bending_stiffness_;
    }

    /// Smallest curvature with the sign of `moment` [N m] that carries it, for a curve that does
    /// not soften [1/m]; infinity where none up to a million times the elastic one does.
    [[nodiscard]] Scalar curvature_at(Scalar moment) const {
        const Scalar sign = std::copysign(Scalar(1), moment);
        const Scalar target = std::abs(moment);
        const auto excess = [&](Scalar curvature) {
            return sign * this->moment(sign * curvature) - target;
        };
        const Scalar elastic = target / bending_stiffness_;
        Scalar high = elastic;
        while (excess(high) < 0) {
            high *= 2;
            if (high > Scalar(1e6) * elastic) return sign * std::numeric_limits<Scalar>::infinity();
        }
        return sign * bracketed_root(Scalar(0), high, Scalar(0), excess);
    }

  private:
    template <class F>
    Scalar over_height(F&& f) const {
        return rule_.integrate(section_.lowest(), section_.highest(),
                               [&](Scalar y) { return section_.width_at(y) * f(y); });
    }
    Scalar force_at(Scalar curvature, Scalar strain) const {
        return over_height([&](Scalar y) { return curve_.stress(strain + curvature * y); });
    }

    /// ε0. The axial force grows with it, and is bracketed by the strains that put every fibre into
    /// tension or compression, moved on in the direction of N.
    Scalar axial_strain(Scalar curvature) const {
        const auto excess = [&](Scalar strain) {
            return force_at(curvature, strain) - axial_force_;
        };
        const Scalar a = -curvature * section_.lowest();
        const Scalar b = -curvature * section_.highest();
        const Scalar guess = axial_force_ / axial_stiffness_;
        const Scalar scale =
            axial_stiffness_ * std::max(std::abs(a), std::abs(b)) + std::abs(axial_force_);
        constexpr Scalar balanced = 8 * std::numeric_limits<Scalar>::epsilon();
        if (std::abs(excess(guess)) <= balanced * scale) return guess;

        Scalar low = std::min(a, b);
        Scalar high = std::max(a, b);
        Scalar step = std::max(high - low, std::abs(guess));
        constexpr int most = 30; // doublings: strains far beyond any material
        for (int i = 0; i < most && excess(high) < 0; ++i) high += (step *= 2);
        step = std::max(high - low, std::abs(guess));
        for (int i = 0; i < most && excess(low) > 0; ++i) low -= (step *= 2);
        constexpr Scalar fine = 4 * std::numeric_limits<Scalar>::epsilon();
        return bracketed_root(low, high, fine * (high - low), excess);
    }

    Section section_;
    Curve curve_;
    Rule rule_;
    Scalar axial_force_;
    Scalar modulus_;
    Scalar axial_stiffness_ = 0;
    Scalar bending_stiffness_ = 0;
};

} // namespace ductile
