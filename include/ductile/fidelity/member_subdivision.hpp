// SPDX-License-Identifier: MIT
//
// Subdivision just in time: which sections of a member need a plastic hinge now. A section that
// does not yield needs no joint at all, and fewer joints are faster and better solved.
//
// A section gets its hinge where its moment reaches `activate` of the capacity, a little before it
// yields, and loses it again after the moment has stayed below `release` of the capacity for
// `hold_time`. Between the two nothing changes, so a moment that trembles by less than
// (activate - release) of the capacity moves no hinge twice. A hinge that flows carries its
// capacity and so is never lost.
//
// The moment is linear between loads, so sections belong where loads act and where the section
// changes. A welded section is rigid and takes any moment at once: where it was carried beyond the
// capacity the update counts it as `late`, and the step should be done again with its hinge.
//
// Source: idea of Nikula (2017), Handling of plasticity in physics engine, section 4.2 (object
// subdivision just in time); hysteresis ours.
//
// Symbols
//   M    bending moment of a section, either sign [N m]
//   M_p  its capacity                             [N m]
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct MemberSubdivisionParameters {
    S activate = S(0.9);   ///< |M|/M_p that makes a hinge, in (0, 1]
    S release = S(0.7);    ///< |M|/M_p below which it may go, in (0, activate)
    S hold_time = S(0.02); ///< for which it has to stay below [s], >= 0
};

/// What an update changed, in numbers of sections.
struct SubdivisionChange {
    std::size_t activated = 0;
    std::size_t released = 0;
    std::size_t late = 0; ///< of the activated ones, carried beyond their capacity while rigid

    bool operator==(const SubdivisionChange&) const = default;
};

/// One member. The arrays are the caller's: `moment` is written anew before every update,
/// `capacity` may follow hardening. Not thread-safe. After construction nothing allocates or
/// throws.
template <std::floating_point S>
class MemberSubdivision {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is out of range, a capacity is not positive
    /// or the sizes differ.
    MemberSubdivision(std::span<const S> moment, std::span<const S> capacity,
                      const MemberSubdivisionParameters<S>& parameters = {})
        : moment_(moment), capacity_(capacity), p_(parameters) {
        if (p_.activate != S(1)) {
            check::between("MemberSubdivision.activate", p_.activate, S(0), S(1), "");
        }
        check::between("MemberSubdivision.release", p_.release, S(0), p_.activate, "");
        check::non_negative("MemberSubdivision.hold_time", p_.hold_time, "s");
        if (capacity.size() != moment.size()) {
            throw std::invalid_argument(
                "MemberSubdivision.capacity.size() = " + std::to_string(capacity.size()) +
                ": must be " + std::to_string(moment.size()) + ", as moment.size()");
        }
        for (std::size_t i = 0; i < capacity.size(); ++i) {
            check::positive("MemberSubdivision.capacity[" + std::to_string(i) + "]", capacity[i],
                            "N m");
        }
        quiet_.assign(moment.size(), rigid);
    }

    [[nodiscard]] std::size_t size() const noexcept { return moment_.size(); }
    [[nodiscard]] bool has_hinge(std::size_t section) const noexcept {
        return quiet_[section] >= 0;
    }

    /// Looks at the moments of a step of `dt` > 0 [s]. O(size()).
    SubdivisionChange update(S dt) noexcept {
        SubdivisionChange change;
        for (std::size_t i = 0; i < size(); ++i) {
            const S used = std::abs(moment_[i]) / capacity_[i];
            S& quiet = quiet_[i];
            if (used >= p_.activate) {
                if (quiet < 0) {
                    ++change.activated;
                    if (used > 1) ++change.late;
                }
                quiet = 0;
            } else if (quiet >= 0) {
                quiet = used < p_.release ? quiet + dt : S(0);
                if (quiet > p_.hold_time) {
                    ++change.released;
                    quiet = rigid;
                }
            }
        }
        return change;
    }

  private:
    static constexpr S rigid = -1;

    std::span<const S> moment_;
    std::span<const S> capacity_;
    MemberSubdivisionParameters<S> p_;
    std::vector<S> quiet_; ///< time below `release` [s]; `rigid` where there is no hinge
};

} // namespace ductile
