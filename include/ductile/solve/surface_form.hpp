// SPDX-License-Identifier: MIT
//
// A yield surface of any curved kind in an island: γ(x/P) <= 1, given by its closest point
// (surface/any_surface.hpp). The natural residual of x = Π(x + r/d), a Newton step on it:
//
//   q = Π(x + r/d) - x,   dx = D (d q - J dv) + q - D C q
//   D = (S⁻¹ + C)⁻¹ = L Lᵀ,   S = B Bᵀ,   L = B G⁻ᵀ,   1 + Bᵀ C B = G Gᵀ
//
// with S the slope of the support at the flow that the closest point has. No multiplier, and no
// normal: in a corner, where S is zero, the force stays in the corner, whatever direction flows.
//
// Derivation. x + dx = support(e + de) to first order, e = r + d q the flow of the closest point,
// de = -J dv - C dx + (r - e).
//
// Source: closest-point return with its consistent tangent, Simo & Hughes (1998), section 3.6; the
// natural residual: Facchinei & Pang (2003), section 1.5.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/solve/block_view.hpp"

namespace ductile::solve {

struct SurfaceForm {
    static void guess(const BlockView& v) noexcept { v.block.multiplier = BlockView::known(0); }

    static void place(const BlockView& v) noexcept {
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) v.row[i].impulse = 0;
        }
    }

    static void set_tangent(const BlockView& v) noexcept {
        v.clear_terms();
        const auto to = v.on_surface() ? closest(v) : AnySurface::Closest();
        for (int i = 0; i < v.count(); ++i) v.release(i, to.inside && v.size(i) > 0);
        if (!to.inside) set_terms(v, to);
    }

    static double set_right(const BlockView& v) noexcept {
        if (!v.on_surface()) return 0;
        const auto to = closest(v);
        std::array<double, 2> along{};
        Vector6<double> q = Vector6<double>::Zero();
        double worst = 0;
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) {
                v.work[i].right = v.work[i].extra = 0;
                continue;
            }
            const IslandSystem::Row& work = v.work[i];
            q[i] = to.point[i] * v.size(i) - v.row[i].impulse;
            v.work[i].right = work.metric * q[i];
            v.work[i].extra = q[i] * (1 - work.weight * work.compliance);
            for (std::size_t k = 0; k < 2; ++k) {
                along[k] += v.tangent.terms[k].direction[i] * work.compliance * q[i];
            }
            const double off = std::abs(q[i]) * work.own;
            if (!(off <= worst)) worst = off;
        }
        for (std::size_t k = 0; k < 2; ++k) {
            const auto& term = v.tangent.terms[k];
            if (term.coefficient == 0) continue;
            for (int i = 0; i < v.count(); ++i) {
                v.work[i].extra -= term.coefficient * along[k] * term.direction[i];
            }
        }
        return worst;
    }

    static bool take(const BlockView& /*v*/) noexcept { return true; }

    /// x(v), and D there: proximal_newton.hpp.
    static void respond(const BlockView& v) noexcept {
        const auto to = closest(v);
        v.block.state = to.inside ? BlockState::inside : BlockState::surface;
        v.block.multiplier = to.inside ? 0 : BlockView::known(0);
        v.clear_terms();
        for (int i = 0; i < v.count(); ++i) {
            v.row[i].impulse = v.live(i) ? to.point[i] * v.size(i) : 0;
            v.release(i, to.inside && v.size(i) > 0);
        }
        if (!to.inside) set_terms(v, to);
    }

    static bool change_over(const BlockView& v, double least) noexcept {
        Vector6<double> aim, metric;
        aim_at(v, aim, metric);
        const double gauge = v.block.surface->value(aim);
        double slack = 0;
        for (int i = 0; i < v.count(); ++i) {
            if (v.live(i)) slack = std::max(slack, least / (v.work[i].own * v.size(i)));
        }
        constexpr double round_off = 1e-10;
        if (v.on_surface() ? gauge > 1 : !(gauge > 1 + round_off + slack)) return false;
        v.block.state = v.on_surface() ? BlockState::inside : BlockState::surface;
        v.block.multiplier = v.on_surface() ? BlockView::known(0) : 0;
        return true;
    }

    static double off(const BlockView& v) noexcept {
        const auto to = closest(v);
        double worst = 0;
        for (int i = 0; i < v.count(); ++i) {
            if (v.work[i].own == 0) continue;
            const double aim = v.live(i) ? to.point[i] * v.size(i) : 0;
            const double o = std::abs(aim - v.row[i].impulse) * v.work[i].own;
            if (!(o <= worst)) worst = o;
        }
        return worst;
    }

    /// As an ellipsoid's.
    static void project(const BlockView& v) noexcept {
        Vector6<double> share = Vector6<double>::Zero(), metric = Vector6<double>::Ones();
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) continue;
            share[i] = v.row[i].impulse / v.size(i);
            metric[i] = v.work[i].metric * v.size(i) * v.size(i);
        }
        const auto to = v.block.surface->closest(share, metric);
        for (int i = 0; i < v.count(); ++i) {
            v.row[i].impulse = v.live(i) ? to.point[i] * v.size(i) : 0;
        }
    }

  private:
    /// x + r/d in shares, and d of shares.
    static void aim_at(const BlockView& v, Vector6<double>& aim, Vector6<double>& metric) noexcept {
        aim.setZero();
        metric.setOnes();
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) continue;
            metric[i] = v.work[i].metric * v.size(i) * v.size(i);
            aim[i] = (v.row[i].impulse + v.work[i].residual / v.work[i].metric) / v.size(i);
        }
    }
    static AnySurface::Closest closest(const BlockView& v) noexcept {
        Vector6<double> aim, metric;
        aim_at(v, aim, metric);
        return v.block.surface->closest(aim, metric);
    }
    /// L.
    static void set_terms(const BlockView& v, const AnySurface::Closest& to) noexcept {
        Vector6<double> b[2];
        double c00 = 1, c01 = 0, c11 = 1; // 1 + Bᵀ C B
        for (std::size_t k = 0; k < 2; ++k) {
            b[k].setZero();
            for (int i = 0; i < v.count(); ++i) {
                if (v.live(i)) b[k][i] = to.slope[k][i] * v.size(i);
            }
        }
        for (int i = 0; i < v.count(); ++i) {
            const double c = v.work[i].compliance;
            c00 += b[0][i] * c * b[0][i];
            c01 += b[0][i] * c * b[1][i];
            c11 += b[1][i] * c * b[1][i];
        }
        const double g0 = std::sqrt(c00), g01 = c01 / g0;
        const double g1 = std::sqrt(std::max(c11 - g01 * g01, 1.0));
        auto& [first, second] = v.tangent.terms;
        first.direction = b[0] / g0;
        second.direction = (b[1] - first.direction * g01) / g1;
        first.coefficient = b[0].isZero(0) ? 0 : 1;
        second.coefficient = b[1].isZero(0) ? 0 : 1;
    }
};

} // namespace ductile::solve
