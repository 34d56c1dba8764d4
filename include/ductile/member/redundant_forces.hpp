// SPDX-License-Identifier: MIT
//
// What a whole member that is held more than once carries. How what holds it shares the loads is
// not in the motion of a rigid body: an engine's rows choose some shares (a static body's none),
// and with these a section may be beyond its strength that would hold. By the static theorem of
// limit analysis any shares in equilibrium that no section is too weak for prove that it holds:
//
//   |M(s) + Σ_i x_i m_i(s)| <= M_p(s) at all sections,   Σ_i x_i w_i = 0 where it is free to move,
//   w_i + x_i of the sign that was seen
//
// Found by projections on what is violated the most (Agmon, Motzkin), from the x of the step
// before; the loads may be others than then. Where none is found the member opens, which is right
// whether there is one or not.
//
// What a support can carry at all its kind says where an adapter knows that; else it is seen in the
// step that opens the member: solved with its sections as joints, a pin has no moment there, and a
// stop pushes to one side. Counted are joints with what cannot move, whatever pushes it: what
// stands on the ground by its weight may let go.
//
// Blow. Of all shares an elastic member takes those of the least strain energy, whatever the rows
// of its rigid body chose: min_x ∫ (M̂ + Σ x_i m_i)²/(2 EI) ds (Castigliano).
//
// Sources: static theorem: Jirasek & Bazant (2002), Inelastic Analysis of Structures, ch. 4;
// projections: Motzkin & Schoenberg (1954), Canadian Journal of Mathematics 6, 393.
//
// Symbols
//   M        moments of the whole member as its step has it                      [N m]
//   x_i, w_i  of a support's force across and along, moment over the length: beside what the step
//            says of it, and that                                                [N]
//   m_i      moments where x_i is one                                            [m]
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "ductile/member/active_sections.hpp"

namespace ductile {

/// What holds a member, in a step. Plain value.
struct MemberSupport {
    const void* joint = nullptr;
    int segment = 0;
    Vector3<double> at = Vector3<double>::Zero();      ///< in the segment [m]
    Vector3<double> carries = Vector3<double>::Zero(); ///< w there [N]
    std::array<bool, 3> bears{};                       ///< either way, as its kind says

    [[nodiscard]] bool is(const MemberSupport& other) const noexcept {
        return joint == other.joint && segment == other.segment;
    }
    /// From the start of the member.
    [[nodiscard]] bool operator<(const MemberSupport& other) const noexcept {
        if (segment != other.segment) return segment < other.segment;
        if (at[2] != other.at[2]) return at[2] < other.at[2];
        return std::less<>()(joint, other.joint);
    }
};

/// Along it, whatever order an engine has them in.
inline void list_supports(const Member& member, std::span<const MemberPiece> pieces,
                          std::span<const PieceStep> steps, std::span<const MemberLoad> loads,
                          double dt, std::vector<MemberSupport>& supports) {
    supports.clear();
    for (const MemberLoad& load : loads) {
        if (load.support == nullptr) continue;
        std::size_t i = 0;
        while (!pieces[i].run.holds(load.segment)) ++i;
        const JointFrame<double> at = placed(placed(steps[i].pose, pieces[i].segment(load.segment)),
                                             {.origin = load.held_at});
        const Vector3<double> moment =
            sum(load.moment, cross(difference(load.point, at.origin), load.impulse));
        const Vector3<double> w{dot(column(at.axes, 1), load.impulse),
                                dot(column(at.axes, 2), load.impulse),
                                dot(column(at.axes, 0), moment) / member.length()};
        supports.push_back(
            {load.support, load.segment, load.held_at, scaled(1 / dt, w), load.bears});
    }
    std::sort(supports.begin(), supports.end());
}

/// Of a whole member. Plain value.
class RedundantForces {
  public:
    [[nodiscard]] bool knows(std::span<const MemberSupport> supports) const noexcept {
        return std::equal(supports.begin(), supports.end(), supports_.begin(), supports_.end(),
                          [](const MemberSupport& a, const MemberSupport& b) { return a.is(b); });
    }
    /// Supports carry this in a step.
    void learn(std::span<const MemberSupport> supports) {
        constexpr double noticed = 1e-5; // of the largest
        if (!knows(supports)) {
            *this = {};
            supports_.assign(supports.begin(), supports.end());
            least_.assign(count(), 0);
            most_ = beside_ = least_;
        }
        double largest = 0;
        for (const MemberSupport& support : supports) {
            largest = std::max(largest, norm(support.carries));
        }
        for (std::size_t i = 0; i < count(); ++i) {
            const double w = supports[i / 3].carries[int(i % 3)];
            const bool both = supports[i / 3].bears[i % 3];
            if (both || w > noticed * largest) most_[i] = std::numeric_limits<double>::infinity();
            if (both || w < -noticed * largest) {
                least_[i] = -std::numeric_limits<double>::infinity();
            }
        }
    }
    /// It is this one from now on.
    void become(const Member& member, const MemberPiece& whole) {
        if (count() > 0) find_moments(member, whole);
    }

    /// Whether a whole member bears what a step of `dt` [s] says that it and its supports carry.
    [[nodiscard]] bool bear(const Member& member, const MemberState& state,
                            const InternalForces& forces, std::span<const MemberSupport> supports,
                            double dt, const ActiveSections& rule = {}) {
        if (count() == 0 || !knows(supports)) return false;
        bounds_.clear();
        for (std::size_t i = 0; i < count(); ++i) {
            if (!can_carry(i)) continue; // but as the step says
            const double w = supports[i / 3].carries[int(i % 3)];
            add(i, 1, most_[i] - w);
            add(i, -1, w - least_[i]);
        }
        for (const SectionForce& carried : forces.sections) {
            UsualAxisJoint joint = member.section(carried.section);
            joint.restore(state[std::size_t(carried.section)].joint);
            const double moment = carried.bending / dt, room = 1 + rule.beyond;
            const std::size_t row = count() + std::size_t(carried.section);
            add(row, 1, room * joint.strength(-1) - moment);
            add(row, -1, room * joint.strength(1) + moment);
        }
        constexpr int tries = 300;
        for (int i = 0; i < tries; ++i) {
            const Bound* worst = nullptr;
            double most = 0;
            for (const Bound& bound : bounds_) {
                const double length = lengths_[bound.row];
                const double over = bound.side * dot_beside(bound.row) - bound.room;
                if (!(over > 0)) continue;
                if (length == 0) return false;
                if (over / length <= most) continue;
                most = over / length;
                worst = &bound;
            }
            if (worst == nullptr) return true;
            constexpr double over_relaxed = 1.8; // fast also where next to nothing is allowed
            const double far = over_relaxed * most * worst->side / lengths_[worst->row];
            for (std::size_t k = 0; k < count(); ++k) beside_[k] -= far * row(worst->row)[k];
        }
        return false;
    }

    /// Adds to what a whole member carries in a blow what its supports give it where it is elastic:
    /// of all shares those with the least strain energy. By conjugate gradients.
    void relax(const Member& member, InternalForces& forces) {
        const std::size_t n = count(), sections = std::size_t(member.sections());
        if (n == 0) return;
        // ∫ a b ds of moments that are linear between sections, none beyond the last ones
        const auto weighted = [&](const std::vector<double>& a) {
            std::vector<double> result(sections);
            for (std::size_t s = 0; s < sections; ++s) {
                const double before = member.segment(int(s)).length,
                             behind = member.segment(int(s) + 1).length;
                result[s] = a[s] * (before + behind) / 3;
                if (s > 0) result[s] += a[s - 1] * before / 6;
                if (s + 1 < sections) result[s] += a[s + 1] * behind / 6;
            }
            return result;
        };
        const auto along_rows = [&](const std::vector<double>& a) {
            std::vector<double> result(n);
            for (std::size_t s = 0; s < sections; ++s) {
                for (std::size_t k = 0; k < n; ++k) result[k] += row(n + s)[k] * a[s];
            }
            return result;
        };
        const auto square = [](const std::vector<double>& a) {
            return std::inner_product(a.begin(), a.end(), a.begin(), 0.0);
        };
        std::vector<double> moments(sections), change(sections);
        for (const SectionForce& carried : forces.sections) {
            moments[std::size_t(carried.section)] = carried.bending;
        }
        std::vector<double> left = along_rows(weighted(moments)), way = left;
        const double first = square(left);
        for (std::size_t i = 0; i < n && square(left) > 1e-24 * first; ++i) {
            for (std::size_t s = 0; s < sections; ++s) {
                change[s] = std::inner_product(way.begin(), way.end(), row(n + s), 0.0);
            }
            const std::vector<double> stiff = along_rows(weighted(change));
            const double most = std::inner_product(way.begin(), way.end(), stiff.begin(), 0.0);
            if (!(most > 0)) break;
            const double before = square(left), step = before / most;
            for (std::size_t s = 0; s < sections; ++s) moments[s] -= step * change[s];
            for (std::size_t k = 0; k < n; ++k) left[k] -= step * stiff[k];
            const double share = square(left) / before;
            for (std::size_t k = 0; k < n; ++k) way[k] = left[k] + share * way[k];
        }
        for (SectionForce& carried : forces.sections) {
            carried.bending = moments[std::size_t(carried.section)];
        }
    }

  private:
    /// side (row · x) <= room
    struct Bound {
        std::size_t row;
        double side, room;
    };
    [[nodiscard]] std::size_t count() const noexcept { return 3 * supports_.size(); }
    [[nodiscard]] double* row(std::size_t i) noexcept { return rows_.data() + i * count(); }
    [[nodiscard]] double dot_beside(std::size_t i) noexcept {
        double sum = 0;
        for (std::size_t k = 0; k < count(); ++k) sum += row(i)[k] * beside_[k];
        return sum;
    }
    void add(std::size_t row, double side, double room) {
        if (room < std::numeric_limits<double>::infinity()) bounds_.push_back({row, side, room});
    }
    [[nodiscard]] bool can_carry(std::size_t i) const noexcept { return least_[i] < most_[i]; }

    /// Rows of x itself, then of the sections' moments, all within what is in balance.
    void find_moments(const Member& member, const MemberPiece& whole) {
        const std::size_t n = count();
        rows_.assign(n * (n + std::size_t(member.sections())), 0);
        std::vector<double> balance(3 * n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            if (!can_carry(i)) continue;
            row(i)[i] = 1;
            const MemberSupport& support = supports_[i / 3];
            const JointFrame<double> at =
                placed(whole.segment(support.segment), {.origin = support.at});
            MemberLoad load{.segment = support.segment, .point = at.origin};
            if (i % 3 < 2) {
                load.impulse = column(at.axes, int(i % 3) + 1);
            } else {
                load.moment = scaled(member.length(), column(at.axes, 0));
            }
            internal_forces(member, whole, {}, std::span(&load, 1), forces_);
            for (const SectionForce& carried : forces_.sections) {
                row(n + std::size_t(carried.section))[i] = carried.bending;
            }
            balance[i] = forces_.left_over_force[1];
            balance[n + i] = forces_.left_over_force[2];
            balance[2 * n + i] = forces_.left_over_moment[0] / member.length();
        }
        for (std::size_t k = 0; k < 3; ++k) {
            double* of = balance.data() + k * n;
            const double length = take_off(of, balance.data(), k);
            for (std::size_t i = 0; i < n; ++i) of[i] = length > 0 ? of[i] / length : 0;
        }
        lengths_.resize(rows_.size() / n);
        for (std::size_t i = 0; i < lengths_.size(); ++i) {
            lengths_[i] = take_off(row(i), balance.data(), 3);
            if (lengths_[i] == 0) std::fill(row(i), row(i) + n, 0.0); // no round-off to relax along
        }
        take_off(beside_.data(), balance.data(), 3);
    }
    /// `of` less its parts along `units`, of which there are `many`; how long it is then, 0 where
    /// that is round-off.
    double take_off(double* of, const double* units, std::size_t many) const noexcept {
        constexpr double round_off = 1e-9;
        const double length = norm_of(of);
        for (std::size_t k = 0; k < many; ++k) {
            const double* unit = units + k * count();
            double along = 0;
            for (std::size_t i = 0; i < count(); ++i) along += of[i] * unit[i];
            for (std::size_t i = 0; i < count(); ++i) of[i] -= along * unit[i];
        }
        const double left = norm_of(of);
        return left > round_off * length ? left : 0.0;
    }
    [[nodiscard]] double norm_of(const double* of) const noexcept {
        double sum = 0;
        for (std::size_t i = 0; i < count(); ++i) sum += of[i] * of[i];
        return std::sqrt(sum);
    }

    std::vector<MemberSupport> supports_;
    std::vector<double> least_, most_; ///< of w + x [N]
    std::vector<double> beside_;       ///< x [N]
    std::vector<double> rows_;         ///< one after the other
    std::vector<double> lengths_;      ///< their norms
    std::vector<Bound> bounds_;
    InternalForces forces_;
};

} // namespace ductile
