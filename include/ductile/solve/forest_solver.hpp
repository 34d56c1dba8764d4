// SPDX-License-Identifier: MIT
//
// The way of islands without loops and contacts: joints of six rows each between bodies that hang
// together as chains and trees, on the ground or free. Bodies are taken out one by one from the
// leaves on. With M' what a body and all beyond it weigh together, c the body, q the one that its
// joint leads to:
//
//   S = J_c M'_c⁻¹ J_cᵀ + C                  as the joint feels what is beyond it
//   M'_q += J_qᵀ S⁻¹ J_q                     what q feels of that
//   x = S⁻¹ (b - J_c M'_c⁻¹ p - J_q v_q)     from the root back, p: impulses on c and beyond
//
// Nothing repeats a joint's rows here, so that rigid ones are not softened, and one round is exact.
// Rows at a bound push with it and hold nothing, the others hold; those that are in the wrong place
// change over, as in active_set.hpp. Joints that share an ellipsoid hold, or this is not the way.
//
// Cost: O(joints) a round.
//
// Source: Featherstone (2008), Rigid Body Dynamics Algorithms, chapter 7: the articulated-body
// inertia.
#pragma once

#include <array>
#include <vector>

#include "ductile/numeric/cholesky.hpp"
#include "ductile/solve/island.hpp"
#include "ductile/solve/island_report.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class ForestSolver {
  public:
    /// Whether to ask: by the numbers of rows and the kinds of blocks alone.
    [[nodiscard]] static bool serves(const Island& island) noexcept;
    /// False, and the island but for its velocities as it was, where this is not the way: loops,
    /// other joints, what flows on a surface or is not found in a few rounds, what is not finite or
    /// not regular. The answer is otherwise that of IslandSolver.
    [[nodiscard]] bool solve(Island& island, IslandReport& report);

  private:
    static constexpr int axes = 6;
    static constexpr int none = -1; ///< the ground, or no joint

    struct Joint {
        IslandRow* rows = nullptr;
        bool turned = false; ///< its first body is nearer to the root
        std::array<Side, axes> side{};
        Vector6<double> x;                         ///< impulses
        Vector6<double> lower, upper;              ///< without end for rows of a block
        Vector6<double> share;                     ///< own effect in that and the compliance
        Vector6<double> asked;                     ///< L⁻¹ of what is asked for
        numeric::Cholesky<double, axes> factors;   ///< of S
        std::array<Vector6<double>, axes> towards; ///< rows of L⁻¹ J_q

        /// J of row i on the body beyond it, and on the one before it.
        [[nodiscard]] const Vector6<double>& beyond(int i) const noexcept {
            return turned ? rows[i].on_b : rows[i].on_a;
        }
        [[nodiscard]] const Vector6<double>& before(int i) const noexcept {
            return turned ? rows[i].on_a : rows[i].on_b;
        }
        [[nodiscard]] bool holds(int i) const noexcept {
            return side[std::size_t(i)] == Side::free;
        }
        /// The bound of its side.
        [[nodiscard]] double bound(int i) const noexcept {
            return side[std::size_t(i)] == Side::lower ? lower[i] : upper[i];
        }
    };
    struct Node {
        int joint = none, root = none; ///< towards the root: joint, and body
        bool bears = false;            ///< others are beyond it
        bool found = false;
        int first = 0;                           ///< of its joints
        Vector6<double> push;                    ///< p
        Matrix6<double> mass;                    ///< M', where it bears, its lower triangle
        numeric::Cholesky<double, axes> factors; ///< of M'
    };

    [[nodiscard]] bool read();
    [[nodiscard]] bool find_order();
    void list_joints();
    [[nodiscard]] bool add(int body, int joint, int root);
    [[nodiscard]] bool find_sides(IslandReport& report) noexcept;
    [[nodiscard]] bool solve_once() noexcept;
    [[nodiscard]] bool take_out(int body) noexcept;
    void put_in(int body) noexcept;
    void update_velocities() noexcept;
    [[nodiscard]] double left(const IslandRow& row, double x) const noexcept;
    [[nodiscard]] int change_over() noexcept;
    [[nodiscard]] bool is_inside() const noexcept;

    Island* island_ = nullptr;
    double scale_ = 0; ///< largest velocity that a row asks for [m/s | rad/s]
    double exact_ = 0; ///< at which a row is solved [m/s | rad/s]
    std::vector<Joint> joints_;
    std::vector<Node> nodes_;    ///< by body
    std::vector<int> of_bodies_; ///< joints, body by body
    std::vector<int> order_;     ///< bodies, from the roots on
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/forest_solver.ipp"
#endif
