// SPDX-License-Identifier: MIT
//
// The linear system behind every step of a solve, in body form: one unknown a body and axis,
// whatever the number of rows.
//
//   K dv = Jᵀ (D g + e),   K = M + Jᵀ D J,   dx = D (g - J dv) + e
//
// D is the tangent of the rows' answer to a change of their velocity: diagonal, W = 1/C for a row
// that is free and 0 for one at its bound, and up to two more ranks for a block,
//
//   D = W + Σ c t tᵀ + c₀ t₁ e₀ᵀ,   two terms at most; the last where friction follows a normal.
//
// A redundant structure makes K no worse than its softness (island.hpp), and contacts add no
// unknown.
//
// Derivation. Rows: C dx + J dv = g where free; bodies: M dv = Jᵀ dx; dx from the first put into
// the second. Without c₀ K is positive definite as D is semidefinite.
//
// Source: the form of implicit plasticity in structural mechanics, K = Σ Jᵀ D J with consistent
// tangents (Simo & Taylor 1985, doi:10.1016/0045-7825(85)90070-2), here with mass in place of the
// supports.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "ductile/numeric/block_ldlt.hpp"
#include "ductile/solve/island.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// Not thread-safe. Allocates where an island is larger than those before, or of another topology.
class IslandSystem {
  public:
    /// Of a row.
    struct Row {
        double own = 0;        ///< its effect on itself, J M⁻¹ Jᵀ; 0: no body can follow
        double compliance = 0; ///< C with softness
        bool rigid = false;    ///< C is least_softness, for the factors' sake
        double kept = 0;       ///< x' of a rigid row: impulse at which it gives nothing
        double metric = 0;     ///< own + C
        double share = 0;      ///< own/metric: of the velocity that it lacks, what bodies follow by
        double shift = 0;      ///< taken from b: the slip of a contact, see contact_form.hpp
        double residual = 0;   ///< b - shift - J v - C (x - x')
        double weight = 0;     ///< W
        double factored = 0;   ///< that of the last factors
        double right = 0;      ///< g
        double extra = 0;      ///< e
        double rest = 0;       ///< g - J dv
        double change = 0;     ///< dx
    };
    /// Of a block.
    struct Block {
        struct Term {
            double coefficient = 0;                              ///< c
            Vector6<double> direction = Vector6<double>::Zero(); ///< t
        };
        std::array<Term, 2> terms;
        double coupling = 0;  ///< c₀
        double gap = 0;       ///< of a contact, at the last right side [N s]
        bool coulomb = false; ///< of a contact: coulomb_form.hpp
        std::size_t run = 0;
    };

    /// Takes up an island; it must stay where it is until the answer is read.
    void open(Island& island);

    [[nodiscard]] Island& island() const noexcept { return *island_; }
    [[nodiscard]] std::vector<Row>& rows() noexcept { return rows_; }
    [[nodiscard]] const std::vector<Row>& rows() const noexcept { return rows_; }
    [[nodiscard]] std::vector<Block>& blocks() noexcept { return blocks_; }
    /// True of rows that belong to no block.
    [[nodiscard]] bool alone(std::size_t row) const noexcept { return block_of_[row] < 0; }
    /// Largest velocity that a row gives its bodies by itself: a spring asks for q/h, and gives
    /// next to nothing of that in a short step [m/s | rad/s]; NaN where the input is not finite.
    [[nodiscard]] double scale() const noexcept { return scale_; }
    /// So many times the round-off of the last residuals, which is what the largest impulse makes
    /// of its bodies in the digits of a double; at most a thousandth of the scale [m/s | rad/s].
    [[nodiscard]] double round_off(double times) const noexcept {
        return std::min(times * noise_, 1e-3 * scale_);
    }
    [[nodiscard]] int factorisations() const noexcept { return factorisations_; }

    /// v = M⁻¹ Jᵀ x.
    void update_velocities() noexcept;
    /// r = b - J v - C (x - x').
    void update_residuals() noexcept;
    /// Largest velocity by which a rigid row gives [m/s | rad/s].
    [[nodiscard]] double given() const noexcept;
    /// x' and x of the rigid rows, times the root of their compliance [√J].
    void read_rigid(std::vector<double>& kept, std::vector<double>& impulses) const;
    /// Sets x' of the rigid rows, as long and scaled as `read_rigid` has it.
    void keep(const std::vector<double>& kept) noexcept;
    /// K from the weights, and its factors, those of before where it is the same. False where it is
    /// not positive definite.
    [[nodiscard]] bool factor() noexcept;
    /// dx from `right` and `extra`, with the last factors.
    void step() noexcept;

    /// 1/2 vᵀ M v + 1/2 xᵀ C x - bᵀ x with the residuals of now [J]: never more than 0 at the
    /// answer. The bodies' kinetic energy changes by no more than this.
    [[nodiscard]] double energy() const noexcept;

  private:
    /// Consecutive rows between the same two bodies.
    struct Run {
        std::size_t first = 0, end = 0;
        int a = immovable, b = immovable;
        numeric::BlockLdlt::Place place{};
        numeric::BlockLdlt::Block on_a, on_b, across; ///< Jᵀ D J of its rows, where `known`
        bool known = false;
        bool ranks = false; ///< terms of a block are in it

        void add(double weight, const Vector6<double>& of_a, const Vector6<double>& of_b) noexcept;
    };
    using Pair = std::pair<Vector6<double>, Vector6<double>>; ///< on bodies a and b
    [[nodiscard]] Pair along(std::size_t block, const Block::Term& term) const noexcept;
    void couple() noexcept;
    bool update(Run& run) noexcept;
    void make_isotropic(const IslandBlock& block) noexcept;
    void find_runs();
    void find_pattern();

    Island* island_ = nullptr;
    std::vector<Row> rows_;
    std::vector<Block> blocks_;
    std::vector<int> block_of_;
    std::vector<Run> runs_;
    std::vector<numeric::BlockLdlt::Edge> edges_, pattern_;
    numeric::BlockLdlt factors_;
    std::vector<Matrix6<double>> masses_; ///< M
    std::vector<Vector6<double>> change_; ///< dv
    double scale_ = 0, noise_ = 0;
    int factorisations_ = 0;
    bool current_ = false; ///< the factors are those of the rows' weights alone
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/island_system.ipp"
#endif
