// SPDX-License-Identifier: MIT
//
// Bodies of one_pair.hpp.
#pragma once

#include <algorithm>
#include <cmath>

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
    [[nodiscard]] bool inside_blocks() const noexcept;

    Island* island_ = nullptr;
    bool blocked_ = false; ///< the rows share a block, and have no bounds
    double scale_ = 0;
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
    if (blocked_) return Side::free;
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

inline bool OnePair::inside_blocks() const noexcept {
    for (const IslandBlock& block : island_->blocks) {
        double square = 0;
        for (int i = 0; i < block.count; ++i) {
            square += std::pow(x_[block.first + i] / block.size[std::size_t(i)], 2);
        }
        if (!(square <= 1)) return false;
    }
    return true;
}

inline bool OnePair::solve(Island& island, IslandReport& report) noexcept {
    constexpr int rounds = 40, together = 6;
    const std::size_t rows = island.rows.size();
    if (rows != std::size_t(most) || island.blocks.size() > 1) return false;
    const int a = island.rows[0].a, b = island.rows[0].b;
    for (const IslandRow& row : island.rows) {
        if (row.a != a || row.b != b) return false;
    }
    for (const IslandBlock& block : island.blocks) {
        if (block.kind != BlockKind::ellipsoid || block.count != most ||
            block.state != BlockState::inside) {
            return false;
        }
    }
    island_ = &island;
    blocked_ = !island.blocks.empty();
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
        side_[i] = blocked_ ? Side::free : row.lower < row.upper ? row.side : Side::lower;
        x_[i] = side_[i] == Side::lower ? row.lower : side_[i] == Side::upper ? row.upper : 0;
    }
    if (!(finite == 0)) return false;
    report.scale = fastest;
    for (report.rounds = 1; report.rounds <= rounds; ++report.rounds) {
        ++report.factorisations;
        if (!factor_and_solve()) return false;
        int wrong = 0;
        for (int i = 0; i < most && !(wrong > 0 && report.rounds > together); ++i) {
            const Side side = where(i);
            if (side == side_[i]) continue;
            ++wrong;
            side_[i] = side;
            const IslandRow& row = island.rows[std::size_t(i)];
            if (side != Side::free) x_[i] = side == Side::lower ? row.lower : row.upper;
        }
        if (wrong > 0) continue;
        if (!inside_blocks()) return false;
        for (int i = 0; i < most; ++i) {
            double size = 0;
            const double off = std::abs(left(i, size));
            if (side_[i] == Side::free) report.residual = std::max(report.residual, off);
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
    return false;
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
