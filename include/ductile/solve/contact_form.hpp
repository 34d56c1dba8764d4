// SPDX-License-Identifier: MIT
//
// A contact with friction in an island. In shares of the coefficients, y = t/f, its set is the cone
//
//   |y| <= n
//
// Coulomb's law is not associated: a contact that slides does not open. The cone's own law would
// have it open at the speed κ of its slip; that speed is taken from what the normal row asks for,
// b_n - κ, with the κ of the last round, until it stays (de Saxcé's change of variables). Each
// round is then a convex problem with one answer, in which normal and friction impulses are found
// together.
//
// Newton on the cone, with ŷ = y/|y|, one compliance c of the friction rows in shares, C_n of the
// normal:
//
//   r_n = -κ,  r_y = κ ŷ,  |y| = n
//   D = a (1 - ŷ ŷᵀ) + (1; ŷ)(1; ŷ)ᵀ/(C_n + c),   a = 1/(c + κ/|y|)
//   e = φ (c; -C_n ŷ)/(C_n + c),   φ = |y| - n,   dκ = (ŷ·q_y/c - q_n/C_n + φ)/(1/c + 1/C_n), q =
//   r' - J dv
//
// Closest point in the metric (d_n, d): inside where |y| <= n; the apex where d |y| <= -d_n n; else
// n' = (d_n n + d |y|)/(d_n + d), y' = n' ŷ.
//
// Source: de Saxcé & Feng (1998), doi:10.1016/S0895-7177(98)00119-8; the convex problem inside a
// fixed point: Acary, Cadoux, Lemaréchal & Malick (2011), doi:10.1002/zamm.201000073.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/solve/block_view.hpp"

namespace ductile::solve {

struct ContactForm {
    static void guess(const BlockView& v) noexcept {
        v.block.multiplier = BlockView::known(speed(v));
    }
    /// κ, of an open contact too: |f w_t| [m/s].
    static double slip(const BlockView& v) noexcept {
        if (v.block.state == BlockState::apex) return speed(v);
        return v.on_surface() ? v.block.multiplier : 0;
    }

    static void place(const BlockView& v) noexcept {
        if (v.block.state == BlockState::apex) {
            for (int i = 0; i < v.count(); ++i) v.row[i].impulse = 0;
            return;
        }
        drop_dead(v);
        if (!v.on_surface()) return;
        const double length = shear(v);
        if (!(length > 0 && v.row[0].impulse > 0)) { // no direction to start from
            v.block.state = BlockState::inside;
            return;
        }
        for (int i = 1; i < v.count(); ++i) v.row[i].impulse *= v.row[0].impulse / length;
    }

    static void set_tangent(const BlockView& v) noexcept {
        v.clear_terms();
        const bool open = v.block.state == BlockState::apex;
        v.release(0, !open);
        for (int i = 1; i < v.count(); ++i) v.release(i, !open && v.live(i));
        if (!v.on_surface()) return;
        const double length = shear(v), c = compliance(v), normal = v.work[0].compliance;
        const double a = 1 / (c + v.block.multiplier / length);
        set_terms(v, length, a, 1 / (normal + c), 1, -a);
        v.work[0].weight = 0;
    }

    static double set_right(const BlockView& v) noexcept {
        if (!v.on_surface()) return 0;
        const double length = shear(v), c = compliance(v), normal = v.work[0].compliance;
        const double gap = length - v.row[0].impulse;
        v.tangent.gap = gap;
        v.work[0].right += v.block.multiplier;
        v.work[0].extra = gap * c / (normal + c);
        for (int i = 1; i < v.count(); ++i) {
            if (!v.live(i)) {
                v.work[i].right = 0;
                continue;
            }
            const double unit = length > 0 ? v.row[i].impulse / (v.size(i) * length) : 0; // ŷ
            v.work[i].right -= v.block.multiplier * unit / v.size(i);
            v.work[i].extra = -gap * normal / (normal + c) * unit * v.size(i);
        }
        // rows of no weight of their own are looked at here
        return std::max(std::abs(gap) * v.work[0].own, std::abs(v.work[0].right) * v.work[0].share);
    }

    static bool take(const BlockView& v) noexcept {
        if (!v.on_surface()) return true;
        const double c = compliance(v), normal = v.work[0].compliance;
        double along = 0, square = 0; // ŷ·q_y with the direction of the tangent
        for (int i = 1; i < v.count(); ++i) {
            const double unit = v.tangent.terms[1].direction[i] / v.size(i);
            if (!v.live(i)) continue;
            along += unit * v.size(i) * v.work[i].rest;
            square += unit * unit;
        }
        if (square > 0) {
            v.block.multiplier +=
                (along / c - v.work[0].rest / normal + v.tangent.gap) / (1 / c + 1 / normal);
        }
        if (v.block.multiplier > 0 && v.row[0].impulse > 0) return true;
        v.block.multiplier = BlockView::known(v.block.multiplier);
        return false;
    }

    static bool change_over(const BlockView& v, double least) noexcept {
        Aim aim = aim_of(v);
        const double slack = 1e-10 * std::abs(aim.normal) + least / v.work[0].own;
        const BlockState was = v.block.state;
        BlockState to = aim.closest();
        // what is at the edge stays where it is
        if (was == BlockState::inside && to != was && aim.length <= aim.normal + slack &&
            aim.normal >= -slack) {
            to = was;
        }
        if (was == BlockState::apex && to != was && aim.normal <= slack &&
            aim.d * aim.length + aim.d_normal * aim.normal <= slack * aim.d_normal) {
            to = was;
        }
        // else it would begin inside again, where it was before
        const bool left = was == BlockState::surface && !(v.row[0].impulse > 0);
        if (to == was && !left) return false;
        v.block.state = to;
        v.block.multiplier = 0;
        if (to == BlockState::surface) put_on_cone(v, aim);
        return true;
    }

    /// x(v), and D there: proximal_newton.hpp.
    static void respond(const BlockView& v) noexcept {
        const Aim aim = aim_of(v);
        v.block.state = v.work[0].own > 0 ? aim.closest() : BlockState::apex;
        v.block.multiplier = 0;
        if (v.on_surface()) {
            put_on_cone(v, aim);
        } else {
            const bool open = v.block.state == BlockState::apex;
            v.row[0].impulse = open ? 0 : aim.normal;
            for (int i = 1; i < v.count(); ++i) {
                v.row[i].impulse = open || !v.live(i) ? 0 : aim.y[i] * v.size(i);
            }
        }
        set_tangent(v);
    }

    /// Of Coulomb's law itself, without the shift.
    static double off(const BlockView& v) noexcept {
        const double real = v.work[0].residual + v.work[0].shift, d = v.work[0].metric;
        const double normal = v.row[0].impulse;
        double worst = std::abs(std::max(0.0, normal + real / d) - normal) * v.work[0].own;
        if (std::isnan(real)) return real;
        const Aim aim = aim_of(v);
        const double shrink = aim.length > normal ? normal / aim.length : 1;
        for (int i = 1; i < v.count(); ++i) {
            if (!v.live(i)) continue;
            const double to = aim.y[i] * shrink * v.size(i);
            const double o = std::abs(to - v.row[i].impulse) * v.work[i].share * v.work[i].metric;
            if (!(o <= worst)) worst = o;
        }
        return worst;
    }

    static void project(const BlockView& v) noexcept {
        drop_dead(v);
        const double length = shear(v);
        v.row[0].impulse = std::max(0.0, v.row[0].impulse);
        if (!(length > v.row[0].impulse)) return;
        for (int i = 1; i < v.count(); ++i) v.row[i].impulse *= v.row[0].impulse / length;
    }

  protected:
    struct Aim {
        double normal = 0, length = 0, d_normal = 1, d = 1;
        Vector6<double> y = Vector6<double>::Zero();

        [[nodiscard]] BlockState closest() const noexcept {
            if (length <= normal) return BlockState::inside;
            return d * length <= -d_normal * normal ? BlockState::apex : BlockState::surface;
        }
    };
    static Aim aim_of(const BlockView& v) noexcept {
        Aim aim;
        aim.d_normal = v.work[0].metric;
        aim.normal = v.row[0].impulse + v.work[0].residual / aim.d_normal;
        double square = 0;
        for (int i = 1; i < v.count(); ++i) {
            if (!v.live(i)) continue;
            aim.d = v.work[i].metric * v.size(i) * v.size(i);
            aim.y[i] = (v.row[i].impulse + v.work[i].residual / v.work[i].metric) / v.size(i);
            square += aim.y[i] * aim.y[i];
        }
        aim.length = std::sqrt(square);
        return aim;
    }
    static void put_on_cone(const BlockView& v, const Aim& aim) noexcept {
        const double normal =
            (aim.d_normal * aim.normal + aim.d * aim.length) / (aim.d_normal + aim.d);
        v.row[0].impulse = normal;
        put_friction(v, aim, normal);
        v.block.multiplier = BlockView::known(aim.d_normal * (normal - aim.normal));
    }
    /// |y| = `length`, where it is aimed.
    static void put_friction(const BlockView& v, const Aim& aim, double length) noexcept {
        for (int i = 1; i < v.count(); ++i) {
            v.row[i].impulse = v.live(i) ? aim.y[i] / aim.length * length * v.size(i) : 0;
        }
    }
    static double speed(const BlockView& v) noexcept {
        double square = 0;
        for (int i = 1; i < v.count(); ++i) {
            const double slip = v.live(i) ? v.size(i) * v.work[i].residual : 0;
            square += slip * slip;
        }
        return std::sqrt(square);
    }
    /// |y|.
    static double shear(const BlockView& v) noexcept {
        double square = 0;
        for (int i = 1; i < v.count(); ++i) {
            if (v.row[i].impulse == 0) continue;
            square += (v.row[i].impulse / v.size(i)) * (v.row[i].impulse / v.size(i));
        }
        return std::sqrt(square);
    }
    /// c, the same for all friction rows (IslandSystem::make_isotropic).
    static double compliance(const BlockView& v) noexcept {
        return v.work[1].compliance * v.size(1) * v.size(1);
    }
    static void drop_dead(const BlockView& v) noexcept {
        if (!(v.work[0].own > 0)) v.row[0].impulse = 0;
        for (int i = 1; i < v.count(); ++i) {
            if (!v.live(i)) v.row[i].impulse = 0;
        }
    }
    /// D = a on the friction rows + `both` (1; s ŷ)(1; s ŷ)ᵀ + `along` ŷ ŷᵀ, in shares.
    static void set_terms(const BlockView& v, double length, double a, double both, double s,
                          double along) noexcept {
        auto& [first, second] = v.tangent.terms;
        first.coefficient = both;
        second.coefficient = along;
        first.direction.setZero();
        second.direction.setZero();
        first.direction[0] = 1;
        for (int i = 1; i < v.count(); ++i) {
            const bool live = v.live(i);
            v.work[i].weight = live ? a * v.size(i) * v.size(i) : 0;
            const double unit = live && length > 0 ? v.row[i].impulse / (v.size(i) * length) : 0;
            first.direction[i] = s * unit * v.size(i);
            second.direction[i] = unit * v.size(i);
        }
    }
};

} // namespace ductile::solve
