// SPDX-License-Identifier: MIT
//
// The rows of a link combined so that the impulse of one moves no other: what an iterative solver,
// which takes up one row after the other, solves in a single sweep where nothing else acts on the
// two bodies, and in fewer sweeps where something does.
//
// A rigid row may be had in any combination with other rigid rows, and a plastic row may have
// multiples of rigid rows added to it: the impulse of the plastic row stays what it was, so that
// its bounds hold as before, and the rigid rows that have to hold anyway make up for the rest.
// With the rows in the order rigid, then plastic, and K = L D Lᵀ in that order, the rows
//
//   J' = L⁻¹ J,   b' = L⁻¹ b   have   J' M⁻¹ J'ᵀ = D,
//
// where L is that of the rigid columns alone: several plastic rows stay coupled to each other.
// Whether K is that of this very instant decides how well the rows are decoupled, never whether
// they are right; any unit lower L of that shape would do.
//
// Symbols
//   J, b   Jacobian and target velocity of the rows   b in [m/s | rad/s]
//   K      inverse mass at the joint, J M⁻¹ Jᵀ        [1/kg ... 1/(kg m²)], symmetric
//
// Limit cases: without rigid rows J' = J; so too where a row would have hardly any inverse mass
// left, which engines take for a row that no body can follow.
#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/link_pose.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// A body's inverse mass and inertia about its principal axes, which are its own axes. Default: a
/// body that cannot move.
template <std::floating_point S>
struct PrincipalMass {
    S inverse_mass = 0;                              ///< [1/kg]
    Vector3<S> inverse_inertia = Vector3<S>::Zero(); ///< [1/(kg m²)]

    bool operator==(const PrincipalMass&) const = default;
};

/// A row made up of the six axes: a force and a moment at the joint, along the axes of frame B.
template <std::floating_point S>
struct CombinedRow {
    Vector3<S> force = Vector3<S>::Zero();
    Vector3<S> moment = Vector3<S>::Zero();
};
template <std::floating_point S>
using CombinedRows = std::array<CombinedRow<S>, 6>;

/// K along the axes of frame B for two bodies of which A is turned against frame B by `rotation` (R
/// or R_p) and off by `displacement` (d or q_p) [m].
template <std::floating_point S>
[[nodiscard]] Matrix6<S> inverse_mass_along_b(const LinkPose<S>& pose, const Matrix3<S>& rotation,
                                              const Vector3<S>& displacement,
                                              const PrincipalMass<S>& a,
                                              const PrincipalMass<S>& b) noexcept {
    // axes of the two bodies along those of frame B
    const Matrix3<S> axes_a = times_transposed(rotation, pose.frame_in_a().axes);
    const Matrix3<S> axes_b = transposed(pose.frame_in_b().axes);
    return inverse_mass_at_joint(
        BodyAtJoint<S>{a.inverse_mass, sandwiched(axes_a, a.inverse_inertia),
                       times(axes_a, pose.frame_in_a().origin)},
        BodyAtJoint<S>{b.inverse_mass, sandwiched(axes_b, b.inverse_inertia),
                       sum(times(axes_b, pose.frame_in_b().origin), displacement)});
}

/// The rows of `order`, each the axis that it names.
template <std::floating_point S>
[[nodiscard]] CombinedRows<S> single_rows(const std::array<std::size_t, 6>& order) noexcept {
    CombinedRows<S> rows;
    for (std::size_t i = 0; i < 6; ++i) {
        const auto axis = Eigen::Index(order[i]);
        (axis < 3 ? rows[i].force : rows[i].moment)[axis % 3] = 1;
    }
    return rows;
}

/// J' of the rows of `order`, of which the first `rigid` are rigid. `k`: K in the order of
/// JointAxis; `least`: smallest inverse mass that a row may be left with.
template <std::floating_point S>
[[nodiscard]] CombinedRows<S> decoupled_rows(const Matrix6<S>& k,
                                             const std::array<std::size_t, 6>& order, int rigid,
                                             S least) noexcept {
    std::array<std::array<S, 6>, 6> left{}; // what is left of K once the rows before are at rest
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            left[i][j] = k(Eigen::Index(order[i]), Eigen::Index(order[j]));
        }
    }
    CombinedRows<S> rows = single_rows<S>(order);
    for (std::size_t j = 0; j < std::size_t(rigid); ++j) {
        if (!(left[j][j] > least)) return single_rows<S>(order);
        for (std::size_t i = j + 1; i < 6; ++i) {
            if (left[i][j] == 0) continue;
            const S share = left[i][j] / left[j][j];
            rows[i].force = difference(rows[i].force, scaled(share, rows[j].force));
            rows[i].moment = difference(rows[i].moment, scaled(share, rows[j].moment));
            for (std::size_t m = j + 1; m <= i; ++m) left[i][m] -= share * left[m][j];
        }
    }
    for (std::size_t i = std::size_t(rigid); i < 6; ++i) {
        if (!(left[i][i] > least)) return single_rows<S>(order);
    }
    return rows;
}

} // namespace ductile
