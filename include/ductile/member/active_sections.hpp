// SPDX-License-Identifier: MIT
//
// Which sections open and close. A step is solved with those that are open; what the others would
// have to carry is found by inverse dynamics (internal_forces.hpp), one that cannot is opened, and
// the same step is solved again, until all that are closed can. The answer is that of the member
// with all its sections open, and any order ends there.
//
//   in a step  the worst of each piece
//   in a blow  the nearest to where it was struck, if it takes more than 1e-4 of the blow: what is
//              farther in is not loaded then (member_course.hpp)
//
// Where a hinge travels the sections that it comes to carry M_p all along: only what is beyond by
// more than round-off is opened.
//
// Closed again is a section that did not move in some steps in a row, be its moment within its
// strength or, as where many distributions balance the loads, just at it. So nothing is lost but
// the drift of its joint; and opening it too early or late changes no motion, only what it costs.
// Where a member is held more than once, impulses of the closed one may be beyond a section that
// holds when it is open (redundant_forces.hpp); where it is so again and again, each such alarm
// after some doubles the steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/member/closing.hpp"
#include "ductile/member/internal_forces.hpp"

namespace ductile {

struct ActiveSections {
    double beyond = 1e-7; ///< of its strength, by which a section opens [-], >= 0
    int hold = 3;         ///< steps after which one that holds closes, >= 1
};

inline constexpr int no_section = -1;

/// What a section carries as a share of its strength [-]; the joint as `state` has it.
[[nodiscard]] inline double utilisation_of(const Member& member, const MemberState& state,
                                           const SectionForce& carried, double dt) {
    UsualAxisJoint joint = member.section(carried.section);
    joint.restore(state[std::size_t(carried.section)].joint);
    const double strength = joint.strength(carried.bending > 0 ? -1 : 1) * dt;
    return strength > 0 ? std::abs(carried.bending) / strength
                        : std::numeric_limits<double>::infinity();
}

/// What it carries beside bending about x as a share of its strength there, in a step of one
/// second; 0 where that is not known [-].
[[nodiscard]] inline double utilisation_beside(const Member& member,
                                               const SectionForce& carried) noexcept {
    if (!member.all_axes()) return 0;
    const auto& capacity = member.all_axes()->capacity;
    return std::hypot(carried.axial / capacity[2], carried.weak_bending / capacity[4],
                      carried.torsion / capacity[5]);
}

/// Strain energy of a blow's profile beside bending about x, and in all [J s²].
struct BlowProfile {
    double beside = 0, all = 0;
    double utilisation = 0; ///< largest utilisation_beside [-]

    void add(const Member& member, const InternalForces& forces) noexcept {
        if (!member.all_axes()) return;
        const auto& stiffness = member.all_axes()->stiffness;
        for (const SectionForce& carried : forces.sections) {
            const double length = member.segment(carried.section + 1).length;
            const auto energy = [&](double q, std::size_t axis) {
                return length * q * q / (2 * stiffness[axis]);
            };
            const double of_these = energy(carried.axial, 2) + energy(carried.weak_bending, 4) +
                                    energy(carried.torsion, 5);
            beside += of_these;
            all += of_these + energy(carried.bending, 3);
            utilisation = std::max(utilisation, utilisation_beside(member, carried));
        }
    }
    /// Whether a blow of `energy` [J] loads an elastic member beyond what it bears there, by what
    /// is more than a hundredth of it.
    [[nodiscard]] bool is_off_plane(double energy) const noexcept {
        constexpr double noticed = 0.01;
        return beside > noticed * all && utilisation * std::sqrt(energy / all) > 1;
    }
};

/// Half of the product of a blow's moment at a closed section and of the turn that opening it would
/// give: what the section then takes of the blow, of a piece as if it were straight [J]. Derived
/// from two bodies that share a point.
[[nodiscard]] inline double opening_energy(const Member& member, const MemberPiece& piece,
                                           const SectionForce& carried) noexcept {
    struct Half {
        double per_mass = 0, per_inertia = 0, arm = 0; ///< 1/m, 1/I, d; 0: it is held
    };
    const auto half = [&](int from, int to, int step) {
        double mass = 0, first = 0, second = 0, at = 0; // of mass about the section
        for (int k = from; k != to; k += step) {
            const MemberSegment& segment = member.segment(k);
            if (segment.held) return Half{};
            const double s = at + segment.length / 2;
            mass += segment.mass;
            first += segment.mass * s;
            second += segment.mass * s * s + segment.inertia[0];
            at += segment.length;
        }
        const double d = first / mass;
        return Half{1 / mass, 1 / (second - first * d), d};
    };
    const Half a = half(carried.section, piece.run.first - 1, -1),
               b = half(carried.section + 1, piece.run.last + 1, 1);
    // a force between them keeps their ends together
    const double along = a.arm * a.per_inertia - b.arm * b.per_inertia;
    const double across =
        a.per_mass + a.arm * a.arm * a.per_inertia + b.per_mass + b.arm * b.arm * b.per_inertia;
    const double turn = a.per_inertia + b.per_inertia - along * along / across;
    return carried.bending * carried.bending * turn / 2;
}

/// The closed section of a piece that carries the most, if that is too much, but for those
/// `beside`.
[[nodiscard]] inline int worst_section(const Member& member, const MemberState& state,
                                       const InternalForces& forces, double dt,
                                       const ActiveSections& rule = {},
                                       const MemberRun& beside = {0, no_section}) {
    int worst = no_section;
    double most = 1 + rule.beyond;
    for (const SectionForce& carried : forces.sections) {
        if (beside.holds(carried.section)) continue;
        const double used = utilisation_of(member, state, carried, dt);
        if (!(used > most)) continue;
        most = used;
        worst = carried.section;
    }
    return worst;
}

/// Of an open section, whose joint has committed the step.
[[nodiscard]] inline bool rests(const SectionState& section) noexcept {
    constexpr double still = 1e-9; // [rad/s]; a load 1e-6 beyond the limit moves it by 1e-9 in 1 µs
    return !section.joint.broken &&
           (!section.joint.flowing || std::abs(section.joint.velocity) <= still);
}

/// Counts the step that an open section's joint has committed; true where it closes.
[[nodiscard]] inline bool closes(SectionState& section, const ActiveSections& rule = {}) noexcept {
    constexpr int few_alarms = 8, most_doublings = 10;
    if (!rests(section)) {
        section.held = section.alarms = 0;
        return false;
    }
    ++section.held;
    return section.held >= rule.hold << std::clamp(section.alarms - few_alarms, 0, most_doublings);
}

} // namespace ductile
