// SPDX-License-Identifier: MIT
//
// A yield surface of several axes in an island: f(x) = |x/P|² - 1 <= 0.
//
// Newton on the surface, with n = x/P² and r' = r - μ n:
//
//   (C + μ/P²) dx + n dμ = r' - J dv,   n·dx = (1 - |x/P|²)/2 = g
//   W = 1/(C + μ/P²),  D = W - (W n)(W n)ᵀ/(n·W n),  e = W n g/(n·W n)
//
// Source: closest-point return with its consistent tangent, Simo & Hughes (1998), section 3.6.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/solve/block_view.hpp"
#include "ductile/solve/ellipsoid_return.hpp"

namespace ductile::solve {

struct EllipsoidForm {
    static void guess(const BlockView& v) noexcept {
        double power = 0;
        for (int i = 0; i < v.count(); ++i) power += v.row[i].impulse * v.work[i].residual;
        v.block.multiplier = BlockView::known(std::abs(power));
    }

    static void place(const BlockView& v) noexcept {
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) v.row[i].impulse = 0;
        }
        if (!v.on_surface()) return;
        const double gauge = std::sqrt(square_gauge(v));
        if (!(gauge > 0)) { // no direction to start from
            v.block.state = BlockState::inside;
            return;
        }
        for (int i = 0; i < v.count(); ++i) v.row[i].impulse /= gauge;
    }

    static void set_tangent(const BlockView& v) noexcept {
        v.clear_terms();
        if (!v.on_surface()) {
            for (int i = 0; i < v.count(); ++i) v.release(i, v.size(i) > 0);
            return;
        }
        const double along = set_weights(v, v.block.multiplier);
        if (along > 0) v.tangent.terms[0].coefficient = -1 / along;
    }

    /// What is missing to the surface, beside the gauge's round-off, as a velocity of the axis that
    /// it is most of [m/s | rad/s].
    static double set_right(const BlockView& v) noexcept {
        constexpr double round_off = 4 * std::numeric_limits<double>::epsilon();
        if (!v.on_surface()) return 0;
        const auto& term = v.tangent.terms[0];
        const double gap = (1 - square_gauge(v)) / 2;
        double across = 0;
        for (int i = 0; i < v.count(); ++i) {
            v.work[i].extra = -term.coefficient * term.direction[i] * gap;
            if (!v.live(i)) {
                v.work[i].right = 0;
                continue;
            }
            v.work[i].right -= v.block.multiplier * v.row[i].impulse / (v.size(i) * v.size(i));
            across = std::max(across, v.size(i) * v.work[i].own);
        }
        return std::max(std::abs(gap) - round_off, 0.0) * across;
    }

    /// False where the multiplier left the range: the surface is not where the block belongs.
    static bool take(const BlockView& v) noexcept {
        if (!v.on_surface()) return true;
        const auto& term = v.tangent.terms[0];
        double change = 0; // n·(W (g - J dv) - dx)
        for (int i = 0; i < v.count(); ++i) {
            if (v.work[i].weight == 0) continue;
            change += term.direction[i] * (v.work[i].rest - v.work[i].change / v.work[i].weight);
        }
        v.block.multiplier -= term.coefficient * change;
        if (v.block.multiplier > 0) return true;
        v.block.multiplier = BlockView::known(0);
        return false;
    }

    static bool change_over(const BlockView& v, double least) noexcept {
        Vector6<double> aim, metric;
        aim_at(v, aim, metric);
        double square = 0, slack = 0;
        for (int i = 0; i < v.count(); ++i) {
            if (aim[i] == 0 || !v.live(i)) continue;
            square += (aim[i] / v.size(i)) * (aim[i] / v.size(i));
            slack = std::max(slack, least / (v.work[i].own * v.size(i)));
        }
        const double gauge = std::sqrt(square);
        if (v.on_surface()) {
            if (gauge > 1) return false;
            v.block.state = BlockState::inside;
            v.block.multiplier = 0;
            return true;
        }
        constexpr double round_off = 1e-10;
        if (!(gauge > 1 + round_off + slack)) return false;
        const EllipsoidReturn found =
            closest_on_ellipsoid(aim, metric, v.block.size.data(), v.count());
        for (int i = 0; i < v.count(); ++i) v.row[i].impulse = found.point[i];
        v.block.state = BlockState::surface;
        v.block.multiplier = BlockView::known(found.multiplier);
        return true;
    }

    /// x(v), and D there: proximal_newton.hpp.
    static void respond(const BlockView& v) noexcept {
        Vector6<double> aim, metric;
        aim_at(v, aim, metric);
        const EllipsoidReturn to =
            closest_on_ellipsoid(aim, metric, v.block.size.data(), v.count());
        const bool inside = to.multiplier == 0;
        v.block.state = inside ? BlockState::inside : BlockState::surface;
        v.block.multiplier = to.multiplier;
        for (int i = 0; i < v.count(); ++i) v.row[i].impulse = v.live(i) ? to.point[i] : 0;
        set_tangent(v);
    }

    static double off(const BlockView& v) noexcept {
        Vector6<double> aim, metric;
        aim_at(v, aim, metric);
        const EllipsoidReturn to =
            closest_on_ellipsoid(aim, metric, v.block.size.data(), v.count());
        double worst = 0;
        for (int i = 0; i < v.count(); ++i) {
            if (v.work[i].own == 0) continue;
            const double o = std::abs(to.point[i] - v.row[i].impulse) * v.work[i].own;
            if (!(o <= worst)) worst = o;
        }
        return worst;
    }

    /// The closest point: along the ray rows that are strong would give for those that are weak.
    static void project(const BlockView& v) noexcept {
        Vector6<double> impulse = Vector6<double>::Zero(), metric = Vector6<double>::Ones();
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) continue;
            impulse[i] = v.row[i].impulse;
            metric[i] = v.work[i].metric;
        }
        const EllipsoidReturn to =
            closest_on_ellipsoid(impulse, metric, v.block.size.data(), v.count());
        for (int i = 0; i < v.count(); ++i) v.row[i].impulse = to.point[i];
    }

    static double square_gauge(const BlockView& v) noexcept {
        double square = 0;
        for (int i = 0; i < v.count(); ++i) {
            if (v.row[i].impulse != 0) {
                square += (v.row[i].impulse / v.size(i)) * (v.row[i].impulse / v.size(i));
            }
        }
        return square;
    }
    /// W and t = W n; n·W n.
    static double set_weights(const BlockView& v, double multiplier) noexcept {
        double along = 0;
        for (int i = 0; i < v.count(); ++i) {
            const double p2 = v.size(i) * v.size(i);
            const bool live = v.live(i);
            v.work[i].weight = live ? p2 / (v.work[i].compliance * p2 + multiplier) : 0;
            const double n = live ? v.row[i].impulse / p2 : 0;
            v.tangent.terms[0].direction[i] = v.work[i].weight * n;
            along += v.work[i].weight * n * n;
        }
        return along;
    }

  private:
    /// x + r/d.
    static void aim_at(const BlockView& v, Vector6<double>& aim, Vector6<double>& metric) noexcept {
        for (int i = 0; i < v.count(); ++i) {
            const bool moves = v.work[i].own > 0;
            metric[i] = moves ? v.work[i].metric : 1;
            aim[i] = moves ? v.row[i].impulse + v.work[i].residual / metric[i] : 0;
        }
    }
};

} // namespace ductile::solve
