// SPDX-License-Identifier: MIT
//
// An island: bodies, and all the rows that act between them in one step, those of joints, contacts
// and friction alike. Engine-free; what an adapter fills and island_solver.hpp solves.
//
//   w = J v + C x - b,   v = M⁻¹ Jᵀ x
//   a row alone     lower <= x <= upper,     w >= 0 at lower, <= 0 at upper, 0 between
//   an ellipsoid    |x/P| <= 1,              w = -μ x/P², μ >= 0, 0 inside
//   a surface       γ(x/P) <= 1,             w = -μ normal, the same of any curved set
//   a contact       n >= 0, |t/f| <= n,      w_n >= 0, w_n n = 0;  w_t = -κ (t/f)/(f |t/f|), 0
//   inside
//
// An ellipsoid is a yield surface that several axes share, with associated flow. A contact has a
// normal row n first, then its friction rows t with their coefficients f: Coulomb's cone, without a
// pyramid.
//
// Compliance. A row may be as stiff as it likes, not rigid: rows that repeat each other, as those
// of a beam held at both ends, would leave their forces undetermined. `softness` is the least
// compliance of a row; for a joint of known section take some 1e-6 of its elastic compliance 1/(k
// dt²): forces in a redundant structure are then those of the elastic structure, and unique.
// Without one a row is rigid: it gets `least_softness` of its own effect, by which shares are the
// same each time, and what it gives by it is taken out again (active_set.hpp), to round-off.
//
// Symbols
//   v      change of the bodies' velocities by the rows' impulses, world axes  [m/s | rad/s]
//   M      mass and inertia of the bodies, world axes                          [kg | kg m²]
//   J      Jacobian of a row on bodies a and b
//   x      impulse                                                             [N s | N m s]
//   b      velocity that the row asks for, less that of the bodies without it  [m/s | rad/s]
//   C      compliance                                                          [1/kg | 1/(kg m²)]
//   P      semi-axes of an ellipsoid                                           [N s | N m s]
//   μ      multiplier of an ellipsoid                                          [J]
//   κ      slip of a contact, |f w_t|                                          [m/s]
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "ductile/surface/any_surface.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile::solve {

inline constexpr int immovable = -1; ///< in place of the index of a body

/// Compliance that a row has at least, of its own effect J M⁻¹ Jᵀ, where nobody says better [-].
inline constexpr double least_softness = 1e-10;
/// The same of a contact, whose points on one face repeat each other: softer, so that their shares,
/// and the friction that follows from them, are steady [-].
inline constexpr double contact_softness = 1e-6;

/// A body that moves. Plain value.
struct IslandBody {
    Vector3<double> inverse_mass = Vector3<double>::Zero(); ///< of each axis, 0: locked [1/kg]
    /// Symmetric, a row and column of zeros: locked [1/(kg m²)].
    Matrix3<double> inverse_inertia = Matrix3<double>::Zero();
    Vector6<double> velocity = Vector6<double>::Zero(); ///< v, the answer
};

/// M, 1 for a locked axis.
[[nodiscard]] Matrix6<double> mass(const IslandBody& body) noexcept;
/// M⁻¹ on an impulse: the velocities that it gives.
[[nodiscard]] inline Vector6<double> moved(const IslandBody& body,
                                           const Vector6<double>& impulse) noexcept {
    return twist_of(Vector3<double>(linear(impulse).cwiseProduct(body.inverse_mass)),
                    times(body.inverse_inertia, angular(impulse)));
}

/// Symmetric whatever round-off is in `inverse_inertia`, and locked about axes of next to none.
[[nodiscard]] IslandBody island_body(const Vector3<double>& inverse_mass,
                                     const Matrix3<double>& inverse_inertia) noexcept;

/// What a row does at the answer, and where the next solve begins.
enum class Side : signed char { lower = -1, free = 0, upper = 1 };

/// One row. Plain value.
struct IslandRow {
    int a = immovable, b = immovable;               ///< bodies
    Vector6<double> on_a = Vector6<double>::Zero(); ///< J of body a: linear, angular
    Vector6<double> on_b = Vector6<double>::Zero();
    double target = 0;     ///< b
    double compliance = 0; ///< C, >= 0
    double softness = 0;   ///< least C; 0: least_softness of its own effect
    double lower = -std::numeric_limits<double>::infinity(); ///< <= upper; not read in a block
    double upper = std::numeric_limits<double>::infinity();
    double impulse = 0;     ///< x: start and answer
    Side side = Side::free; ///< start and answer; not read in a block
};

/// A row of no block that can only push, while it opens: it asks for nothing.
[[nodiscard]] inline bool opens(const IslandRow& row) noexcept {
    return row.target < 0 && row.lower == 0;
}

enum class BlockKind : unsigned char { ellipsoid, contact, surface };
enum class BlockState : unsigned char {
    inside,  ///< holds
    surface, ///< flows, slides
    apex     ///< of a contact: open, no impulse
};

/// Rows `first` ... `first + count - 1`, which act between the same two bodies. Plain value.
struct IslandBlock {
    BlockKind kind = BlockKind::ellipsoid;
    BlockState state = BlockState::inside; ///< start and answer
    int first = 0, count = 0;              ///< 1 <= count <= 6
    /// P >= 0 of an ellipsoid or a surface's axes [N s | N m s]; f > 0 of a contact's friction rows
    /// [- | m], the entry of its normal row is not read. Friction rows of a contact all get the
    /// largest f² C of them.
    std::array<double, 6> size{};
    double multiplier = 0; ///< μ or κ on the surface: start and answer; 0: not known
    const AnySurface* surface = nullptr; ///< of a surface: must live until the answer is read
};

/// Kept from step to step, so that nothing is allocated once the largest island was seen.
struct Island {
    std::vector<IslandBody> bodies;
    std::vector<IslandRow> rows;
    std::vector<IslandBlock> blocks; ///< no row in two of them
    /// By how much the answer misses a row, where that is too much for it, else 0; infinite: there
    /// is none [m/s | rad/s].
    double unsolved = 0;

    void clear() noexcept {
        bodies.clear();
        rows.clear();
        blocks.clear();
    }
};

/// Velocity of a row that a unit impulse of its own gives it, J M⁻¹ Jᵀ [1/kg | 1/(kg m²)].
[[nodiscard]] double own_effect(const Island& island, const IslandRow& row) noexcept;

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/island.ipp"
#endif
