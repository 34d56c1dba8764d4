// SPDX-License-Identifier: MIT
//
// Bodies of one_pair.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/numeric/cholesky.hpp"
#include "ductile/solve/one_pair.hpp"

namespace ductile::solve {

namespace detail {

/// Of as many rows as a joint has: loops of a length that the compiler knows.
class OnePair {
  public:
    [[nodiscard]] bool solve(Island& island, IslandReport& report) noexcept;

  private:
    static constexpr int most = 6;

    void add(const IslandBody& body, Vector6<double> IslandRow::*on, double (*moved)[most]);
    [[nodiscard]] bool factor_and_solve() noexcept;
    /// b - A x of a row; `size`: of what is added up for it.
    [[nodiscard]] double left(int i, double& size) const noexcept;
    [[nodiscard]] Side where(int i) const noexcept;
    [[nodiscard]] bool solve_bounded(IslandReport& report) noexcept;
    [[nodiscard]] bool solve_ellipsoid(IslandBlock& block, IslandReport& report) noexcept;

    Island* island_ = nullptr;
    double a_[most][most];                             ///< A, lower triangle by rows
    double f_[most][most];                             ///< its factors
    double x_[most];                                   ///< impulses
    double moved_a_[most][most], moved_b_[most][most]; ///< M⁻¹ Jᵀ: of row i on a body
    Side side_[most];
};

/// M⁻¹ on_k of each row, and its share of A.
inline void OnePair::add(const IslandBody& body, Vector6<double> IslandRow::*on,
                         double (*moved)[most]) {
    const Matrix6<double>& m = body.inverse_mass;
    for (int i = 0; i < most; ++i) {
        const Vector6<double>& v = island_->rows[std::size_t(i)].*on;
        for (int k = 0; k < 3; ++k) {
            moved[i][k] = m(k, k) * v[k];
            moved[i][3 + k] = m(3 + k, 3) * v[3] + m(3 + k, 4) * v[4] + m(3 + k, 5) * v[5];
        }
        for (int j = 0; j <= i; ++j) {
            const Vector6<double>& u = island_->rows[std::size_t(j)].*on;
            double sum = 0;
            for (int k = 0; k < 6; ++k) sum += moved[i][k] * u[k];
            a_[i][j] += sum;
        }
    }
}

/// x of the free rows with those that are held as they are; false where a pivot is not positive.
inline bool OnePair::factor_and_solve() noexcept {
    double z[most];
    for (int i = 0; i < most; ++i) {
        z[i] = island_->rows[std::size_t(i)].target;
        for (int j = 0; j <= i; ++j) f_[i][j] = a_[i][j];
    }
    for (int i = 0; i < most; ++i) {
        if (side_[i] == Side::free) continue;
        for (int j = 0; j < i; ++j) {
            z[j] -= a_[i][j] * x_[i];
            f_[i][j] = 0;
        }
        for (int j = i + 1; j < most; ++j) {
            z[j] -= a_[j][i] * x_[i];
            f_[j][i] = 0;
        }
        f_[i][i] = 1;
    }
    bool positive = true;
    for (int j = 0; j < most; ++j) {
        positive = positive && f_[j][j] > 0;
        const double inverse = 1 / f_[j][j];
        double l[most];
        for (int i = j + 1; i < most; ++i) l[i] = f_[i][j] * inverse;
        for (int i = j + 1; i < most; ++i) {
            for (int k = j + 1; k <= i; ++k) f_[i][k] -= l[i] * f_[k][j];
        }
        for (int i = j + 1; i < most; ++i) f_[i][j] = l[i];
        if (side_[j] != Side::free) z[j] = x_[j];
        for (int i = j + 1; i < most; ++i) z[i] -= l[i] * z[j];
        z[j] = side_[j] == Side::free ? z[j] * inverse : x_[j];
    }
    for (int j = most - 1; j >= 0; --j) {
        for (int i = j + 1; i < most; ++i) z[j] -= f_[i][j] * z[i];
        x_[j] = z[j];
    }
    return positive;
}

inline double OnePair::left(int i, double& size) const noexcept {
    double result = island_->rows[std::size_t(i)].target;
    size = std::abs(result);
    for (int j = 0; j < most; ++j) {
        const double part = (j <= i ? a_[i][j] : a_[j][i]) * x_[j];
        result -= part;
        size += std::abs(part);
    }
    return result;
}

inline Side OnePair::where(int i) const noexcept {
    const IslandRow& row = island_->rows[std::size_t(i)];
    if (!(row.lower < row.upper)) return Side::lower;
    constexpr double round_off = 1e-13;
    if (side_[i] == Side::free) {
        const double slack = round_off * std::abs(x_[i]);
        return x_[i] < row.lower - slack   ? Side::lower
               : x_[i] > row.upper + slack ? Side::upper
                                           : Side::free;
    }
    double size = 0;
    const double off = left(i, size), pulls = side_[i] == Side::lower ? off : -off;
    return pulls > round_off * size ? Side::free : side_[i];
}

inline bool OnePair::solve_bounded(IslandReport& report) noexcept {
    constexpr int rounds = 40, together = 6;
    for (int i = 0; i < most; ++i) {
        const IslandRow& row = island_->rows[std::size_t(i)];
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
            const IslandRow& row = island_->rows[std::size_t(i)];
            if (side != Side::free) x_[i] = side == Side::lower ? row.lower : row.upper;
        }
        if (wrong > 0) continue;
        for (int i = 0; i < most; ++i) {
            double size = 0;
            if (side_[i] == Side::free) {
                report.residual = std::max(report.residual, std::abs(left(i, size)));
            }
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
        const IslandRow& row = island_->rows[std::size_t(i)];
        if (!shares && (std::isfinite(row.lower) || std::isfinite(row.upper))) return false;
        unit[i] = shares ? block.size[std::size_t(k)] : 1 / std::sqrt(a_[i][i]);
        if (!(unit[i] > 0)) return false;
        shared[i] = shares ? 1 : 0;
        asked[i] = unit[i] * row.target;
        side_[i] = Side::free;
    }
    Matrix6<double> scaled;
    for (int i = 0; i < most; ++i) {
        for (int j = 0; j <= i; ++j) scaled(i, j) = unit[i] * a_[i][j] * unit[j];
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
        double size = 0;
        const double flow = multiplier * shared[i] * x_[i] / (unit[i] * unit[i]);
        report.residual = std::max(report.residual, std::abs(left(i, size) - flow));
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
    island_ = &island;
    for (auto& row : a_) std::fill(std::begin(row), std::end(row), 0.0);
    if (a >= 0) add(island.bodies[std::size_t(a)], &IslandRow::on_a, moved_a_);
    if (b >= 0) add(island.bodies[std::size_t(b)], &IslandRow::on_b, moved_b_);
    double finite = 0, fastest = 0;
    for (int i = 0; i < most; ++i) {
        const IslandRow& row = island.rows[std::size_t(i)];
        if (!(a_[i][i] > 0)) return false; // a locked axis: the general way leaves it alone
        a_[i][i] += row.compliance;
        finite += 0 * (a_[i][i] + row.target);
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
    const auto move = [&](int body, const double(*moved)[most]) {
        Vector6<double>& velocity = island.bodies[std::size_t(body)].velocity;
        velocity.setZero();
        for (int i = 0; i < most; ++i) {
            for (int k = 0; k < 6; ++k) velocity[k] += moved[i][k] * x_[i];
        }
    };
    for (IslandBody& body : island.bodies) body.velocity.setZero();
    if (a >= 0) move(a, moved_a_);
    if (b >= 0) move(b, moved_b_);
    return true;
}

} // namespace detail

DUCTILE_INLINE bool solve_one_pair(Island& island, IslandReport& report) noexcept {
    detail::OnePair pair;
    IslandReport of_pair;
    if (!pair.solve(island, of_pair)) return false;
    report = of_pair;
    return true;
}

} // namespace ductile::solve
