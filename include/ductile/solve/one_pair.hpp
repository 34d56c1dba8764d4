// SPDX-License-Identifier: MIT
//
// The short way for the smallest islands: up to six rows between one pair of bodies, or a body and
// what does not move. One dense system of the rows themselves, no order, no memory:
//
//   A x = b - w,   A = J M⁻¹ Jᵀ + C
//
// Sides as in active_set.hpp, with one row a round where several have changed over for long. Rows
// that share an ellipsoid, beside others without bounds, flow with one unknown, its multiplier:
//
//   (A + μ E) x = b,   E = diag(1/P²) of those that share it,   |x/P| = 1
//
// and |x/P|^-1 is concave and rising in μ, so that Newton from 0 never passes the root.
// No row is softened: those of one joint do not repeat each other.
//
// Sources: Murty (1974), doi:10.1016/0024-3795(74)90019-X: the lowest wrong row alone ends in
// finitely many rounds; Moré & Sorensen (1983), doi:10.1137/0904038: the equation of one unknown.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/numeric/cholesky.hpp"
#include "ductile/solve/island.hpp"
#include "ductile/solve/island_report.hpp"

namespace ductile::solve {

namespace detail {

/// Of as many rows as a joint has: loops of a length that the compiler knows.
class OnePair {
  public:
    [[nodiscard]] bool solve(Island& island, IslandReport& report) noexcept;

  private:
    static constexpr int most = 6;

    void add(const IslandBody& body, Vector6<double> IslandRow::*on, Matrix6<double>& moved);
    [[nodiscard]] bool factor_and_solve() noexcept;
    /// A_ij x_j
    [[nodiscard]] double part(int i, int j) const noexcept {
        return (j <= i ? a_(i, j) : a_(j, i)) * x_[j];
    }
    /// b - A x of a row.
    [[nodiscard]] double left(int i) const noexcept {
        double result = rows_[i].target;
        for (int j = 0; j < most; ++j) result -= part(i, j);
        return result;
    }
    [[nodiscard]] Side where(int i) const noexcept;
    [[nodiscard]] bool solve_bounded(IslandReport& report) noexcept;
    [[nodiscard]] bool solve_ellipsoid(IslandBlock& block, IslandReport& report) noexcept;

    IslandRow* rows_ = nullptr;
    Matrix6<double> a_;                 ///< A, its lower triangle
    Vector6<double> x_;                 ///< impulses
    Matrix6<double> moved_a_, moved_b_; ///< M⁻¹ Jᵀ: of row i on a body
    Side side_[most];
};

/// M⁻¹ on_k of each row, and its share of A.
inline void OnePair::add(const IslandBody& body, Vector6<double> IslandRow::*on,
                         Matrix6<double>& moved) {
    for (int i = 0; i < most; ++i) {
        const Vector6<double> velocity = solve::moved(body, rows_[i].*on);
        for (int k = 0; k < 6; ++k) moved(i, k) = velocity[k];
    }
#pragma GCC unroll 6
    for (int j = 0; j < most; ++j) {
        const Vector6<double>& force = rows_[j].*on;
        Vector6<double> effect;
#pragma GCC unroll 6
        for (int i = j; i < most; ++i) effect[i] = moved(i, 0) * force[0];
#pragma GCC unroll 6
        for (int k = 1; k < 6; ++k) {
#pragma GCC unroll 6
            for (int i = j; i < most; ++i) effect[i] += moved(i, k) * force[k];
        }
#pragma GCC unroll 6
        for (int i = j; i < most; ++i) a_(i, j) += effect[i];
    }
}

/// x of the free rows with those that are held as they are; false where a pivot is not positive.
inline bool OnePair::factor_and_solve() noexcept {
    Matrix6<double> of_free = a_;
    Vector6<double> right;
    for (int i = 0; i < most; ++i) right[i] = rows_[i].target;
    for (int i = 0; i < most; ++i) {
        if (side_[i] == Side::free) continue;
        for (int j = 0; j < most; ++j) {
            right[j] -= (i <= j ? a_(j, i) : a_(i, j)) * x_[i];
            of_free(std::max(i, j), std::min(i, j)) = 0;
        }
        of_free(i, i) = 1;
    }
    for (int i = 0; i < most; ++i) {
        if (side_[i] != Side::free) right[i] = x_[i];
    }
    const numeric::Cholesky<double, most> factors(of_free);
    x_ = factors.solve(right);
    return factors.succeeded();
}

inline Side OnePair::where(int i) const noexcept {
    const IslandRow& row = rows_[i];
    if (!(row.lower < row.upper)) return Side::lower;
    constexpr double round_off = 1e-13;
    if (side_[i] == Side::free) {
        const double slack = round_off * std::abs(x_[i]);
        return x_[i] < row.lower - slack   ? Side::lower
               : x_[i] > row.upper + slack ? Side::upper
                                           : Side::free;
    }
    double size = std::abs(row.target);
    for (int j = 0; j < most; ++j) size += std::abs(part(i, j));
    const double off = left(i), pulls = side_[i] == Side::lower ? off : -off;
    return pulls > round_off * size ? Side::free : side_[i];
}

inline bool OnePair::solve_bounded(IslandReport& report) noexcept {
    constexpr int rounds = 40, together = 6;
    for (int i = 0; i < most; ++i) {
        const IslandRow& row = rows_[i];
        side_[i] = row.lower < row.upper ? row.side : Side::lower;
        x_[i] = side_[i] == Side::lower ? row.lower : side_[i] == Side::upper ? row.upper : 0;
    }
    for (report.rounds = 1; report.rounds <= rounds; ++report.rounds) {
        ++report.factorisations;
        if (!factor_and_solve()) return false;
        int wrong = 0;
        for (int i = 0; i < most && !(wrong > 0 && report.rounds > together); ++i) {
            const Side side = where(i);
            if (side == side_[i]) continue;
            ++wrong;
            side_[i] = side;
            const IslandRow& row = rows_[i];
            if (side != Side::free) x_[i] = side == Side::lower ? row.lower : row.upper;
        }
        if (wrong > 0) continue;
        for (int i = 0; i < most; ++i) {
            if (side_[i] != Side::free) continue;
            report.residual = std::max(report.residual, std::abs(left(i)));
        }
        return true;
    }
    return false;
}

/// Impulses in shares of the semi-axes, those of other rows of 1/sqrt(A_ii): so scaled the
/// multiplier's terms are those of 1, whatever the units.
inline bool OnePair::solve_ellipsoid(IslandBlock& block, IslandReport& report) noexcept {
    constexpr int rounds = 60;
    constexpr double exact = 4e-15, allowed = 1e-9;
    Vector6<double> unit, shared, asked;
    for (int i = 0; i < most; ++i) {
        const int k = i - block.first;
        const bool shares = k >= 0 && k < block.count;
        const IslandRow& row = rows_[i];
        if (!shares && (std::isfinite(row.lower) || std::isfinite(row.upper))) return false;
        unit[i] = shares ? block.size[std::size_t(k)] : 1 / std::sqrt(a_(i, i));
        if (!(unit[i] > 0)) return false;
        shared[i] = shares ? 1 : 0;
        asked[i] = unit[i] * row.target;
        side_[i] = Side::free;
    }
    Matrix6<double> scaled;
    for (int i = 0; i < most; ++i) {
        for (int j = 0; j <= i; ++j) scaled(i, j) = unit[i] * a_(i, j) * unit[j];
    }
    double multiplier = 0, gauge = 0;
    Vector6<double> share;
    for (report.rounds = 1; report.rounds <= rounds; ++report.rounds) {
        ++report.factorisations;
        Matrix6<double> system = scaled;
        for (int i = 0; i < most; ++i) system(i, i) += multiplier * shared[i];
        const numeric::Cholesky<double, most> factors(system);
        if (!factors.succeeded()) return false;
        share = factors.solve(asked);
        const Vector6<double> on = share.cwiseProduct(shared);
        gauge = std::sqrt(dot(on, on));
        if (multiplier == 0 && gauge <= 1) break;
        const double ahead = (gauge - 1) * gauge * gauge / dot(on, factors.solve(on));
        if (!(gauge - 1 > exact) || !(ahead > 1e-16 * multiplier)) break;
        multiplier += ahead;
    }
    const bool outside = multiplier > 0;
    for (int i = 0; i < most; ++i) {
        x_[i] = unit[i] * share[i] / (outside && shared[i] > 0 ? gauge : 1);
    }
    for (int i = 0; i < most; ++i) {
        const double flow = multiplier * shared[i] * x_[i] / (unit[i] * unit[i]);
        report.residual = std::max(report.residual, std::abs(left(i) - flow));
    }
    if (!(report.residual <= allowed * report.scale)) return false;
    block.state = outside ? BlockState::surface : BlockState::inside;
    block.multiplier = multiplier;
    return true;
}

inline bool OnePair::solve(Island& island, IslandReport& report) noexcept {
    const std::size_t rows = island.rows.size();
    if (rows != std::size_t(most) || island.blocks.size() > 1) return false;
    const int a = island.rows[0].a, b = island.rows[0].b;
    for (const IslandRow& row : island.rows) {
        if (row.a != a || row.b != b) return false;
    }
    if (!island.blocks.empty() && island.blocks[0].kind != BlockKind::ellipsoid) return false;
    rows_ = island.rows.data();
    a_.setZero();
    if (a >= 0) add(island.bodies[std::size_t(a)], &IslandRow::on_a, moved_a_);
    if (b >= 0) add(island.bodies[std::size_t(b)], &IslandRow::on_b, moved_b_);
    double finite = 0, fastest = 0;
    for (int i = 0; i < most; ++i) {
        const IslandRow& row = island.rows[std::size_t(i)];
        if (!(a_(i, i) > 0)) return false; // a locked axis: the general way leaves it alone
        a_(i, i) += row.compliance;
        finite += 0 * (a_(i, i) + row.target);
        fastest = std::max(fastest, std::abs(row.target));
    }
    if (!(finite == 0)) return false;
    report.scale = fastest;
    const bool solved =
        island.blocks.empty() ? solve_bounded(report) : solve_ellipsoid(island.blocks[0], report);
    if (!solved) return false;
    for (int i = 0; i < most; ++i) {
        island.rows[std::size_t(i)].impulse = x_[i];
        island.rows[std::size_t(i)].side = side_[i];
    }
    const auto move = [&](int body, const Matrix6<double>& moved) {
        Vector6<double>& velocity = island.bodies[std::size_t(body)].velocity;
        for (int k = 0; k < 6; ++k) {
            for (int i = 0; i < most; ++i) velocity[k] += moved(i, k) * x_[i];
        }
    };
    for (IslandBody& body : island.bodies) body.velocity.setZero();
    if (a >= 0) move(a, moved_a_);
    if (b >= 0) move(b, moved_b_);
    return true;
}

} // namespace detail

/// False, and the island as it was, where this is not the way: other rows, another surface, what
/// is not finite or not regular. The answer is otherwise that of IslandSolver.
[[nodiscard]] inline bool solve_one_pair(Island& island, IslandReport& report) noexcept {
    detail::OnePair pair;
    IslandReport of_pair;
    if (!pair.solve(island, of_pair)) return false;
    report = of_pair;
    return true;
}

} // namespace ductile::solve
