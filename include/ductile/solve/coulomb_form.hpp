// SPDX-License-Identifier: MIT
//
// A contact with friction in an island by Coulomb's law itself, of which the friction's bound
// follows the normal impulse within each step of Newton. Not associated, and so not symmetric:
//
//   n >= 0, r_n <= 0;   |y| <= n,  r_y = κ ŷ where it slides                    y = t/f
//
// Newton where it slides, one compliance c of the friction rows in shares, C_n of the normal:
//
//   dn = q_n/C_n,   dy = a (1 - ŷ ŷᵀ) q_y + ŷ (dn - φ),   dκ = ŷ·q_y - c (dn - φ)
//   a = 1/(c + κ/|y|),   φ = |y| - n,   q = r' - J dv,   r'_y = r_y - κ ŷ
//
// Where friction turns bodies hard against their normals, as in a jam, it need not settle.
//
// Source: Alart & Curnier (1991), doi:10.1016/0045-7825(91)90022-X.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/solve/contact_form.hpp"

namespace ductile::solve {

struct CoulombForm : ContactForm {
    static void set_tangent(const BlockView& v) noexcept {
        v.clear_terms();
        const bool open = v.block.state == BlockState::apex;
        v.release(0, !open);
        for (int i = 1; i < v.count(); ++i) v.release(i, !open && v.live(i));
        if (!v.on_surface()) return;
        const double length = shear(v), c = compliance(v);
        const double a = 1 / (c + v.block.multiplier / length);
        auto& term = v.tangent.terms[0];
        term.coefficient = -a;
        term.direction.setZero();
        for (int i = 1; i < v.count(); ++i) {
            if (!v.live(i)) continue;
            v.work[i].weight = a * v.size(i) * v.size(i);
            term.direction[i] = v.row[i].impulse / length; // f ŷ
        }
        v.tangent.coupling = v.work[0].weight;
    }

    static double set_right(const BlockView& v) noexcept {
        if (!v.on_surface()) return 0;
        const double length = shear(v), gap = length - v.row[0].impulse;
        v.tangent.gap = gap;
        for (int i = 1; i < v.count(); ++i) {
            if (!v.live(i)) {
                v.work[i].right = 0;
                continue;
            }
            const double unit = length > 0 ? v.row[i].impulse / (v.size(i) * length) : 0; // ŷ
            v.work[i].right -= v.block.multiplier * unit / v.size(i);
            v.work[i].extra = -gap * v.tangent.terms[0].direction[i];
        }
        return std::abs(gap) * v.work[0].own;
    }

    /// False where it left the range; against its slip it holds, to begin from where it would go.
    static bool take(const BlockView& v) noexcept {
        if (!v.on_surface()) return true;
        double along = 0; // ŷ·q_y with the direction of the tangent
        for (int i = 1; i < v.count(); ++i) {
            along += v.tangent.terms[0].direction[i] * v.work[i].rest;
        }
        const double longer = v.tangent.coupling * v.work[0].rest - v.tangent.gap;
        v.block.multiplier += along - compliance(v) * longer;
        if (v.block.multiplier > 0 && v.row[0].impulse > 0) return true;
        if (!(v.block.multiplier > 0)) {
            v.block.state = BlockState::inside;
            v.block.multiplier = 0;
        }
        return false;
    }

    static bool change_over(const BlockView& v, double least) noexcept {
        const Aim aim = aim_of(v);
        const double slack = 1e-10 * std::abs(aim.normal) + least / v.work[0].own;
        const BlockState was = v.block.state;
        const bool open = was == BlockState::apex ? aim.normal <= slack : aim.normal < -slack;
        const bool holds = aim.length <= aim.normal + (was == BlockState::inside ? slack : 0);
        const BlockState to = open    ? BlockState::apex
                              : holds ? BlockState::inside
                                      : BlockState::surface;
        if (to == was) return false;
        v.block.state = to;
        v.block.multiplier = 0;
        if (to == BlockState::surface) {
            v.row[0].impulse = std::max(aim.normal, 0.0);
            put_friction(v, aim, v.row[0].impulse);
            v.block.multiplier = BlockView::known(aim.d * (aim.length - v.row[0].impulse));
        }
        return true;
    }
};

} // namespace ductile::solve
