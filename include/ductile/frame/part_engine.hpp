// SPDX-License-Identifier: MIT
//
// What a frame asks of an engine: to go one part, to take it back, to strike without moving, and
// what it sees coming. world/ and the adapters answer it; frame_control.hpp asks.
//
// A part of h moves the bodies half a step ahead with the velocities they have, solves there, and
// moves them the other half with those they got:
//
//   x += h/2 v;   v -> v' with contacts and joints as they are at x;   x += h/2 v'
//
// A blow is impulses alone: contacts that touch are closed, all others are open, no time passes. It
// also makes velocities fit that hands gave, or joints that they made, between frames.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ductile/frame/part_row.hpp"

namespace ductile {

/// What springs and motors of the engine's own did in a part, beside plastic joints. It has the
/// mean of their forces: what is rigid, and holds that, may flow at their peak.
///
///   spring  V² = ((u + u')/2)² + (a/ω)²,  U = m V²/2,  misplaced U (ω h)³/4: F e at its peak, e =
///           |a'| h³/8, and no farther than it swings: 2 U
///   motor   F acted until it had its speed, for s = h |f|/F:  v = u less that,  U = m v²/2,
///           misplaced F |v| (h - s)/2
struct OwnForces {
    double energy = 0;          ///< Σ U [J]
    double swings = 0;          ///< misplaced by springs [J]
    double stops = 0, stop = 0; ///< by the motor that misplaces most [J], s [s]
    double peak = 0;            ///< the largest force of one over its mean [-]
    double late = 0;            ///< of a force, that was a damper's later than it should be [-]

    /// @param force mean, of the part  @param mass of the row, > 0  @param start, end u, u'
    /// @param counts of U
    void add_spring(double stiffness, double mass, double force, double start, double end, double h,
                    double counts = 1) noexcept {
        if (!(stiffness > 0)) return;
        const double frequency = std::sqrt(stiffness / mass), mean = (start + end) / 2;
        const double swing = std::max({std::hypot(mean, (end - start) / (h * frequency)),
                                       std::abs(start), std::abs(end)}); // V
        const double held = mass * swing * swing / 2;
        energy += counts * held;
        swings += held * std::min(std::pow(frequency * h, 3) / 4, 2.0);
        reach(std::abs(force) + mass * frequency * swing, std::abs(force));
    }
    /// @param speed v  @param strength F [N | N m]
    void add_motor(double strength, double mass, double force, double speed, double h) noexcept {
        constexpr double whole = 1 - 1e-6;
        const double share = std::abs(force) / strength;
        if (!(share < whole) || speed == 0) return;
        energy += mass * speed * speed / 2;
        reach(strength, std::abs(force));
        const double off = strength * std::abs(speed) * h * (1 - share) / 2;
        if (!(off > stops)) return;
        stops = off;
        stop = share * h;
    }
    /// Of another island.
    void join(const OwnForces& other) noexcept {
        energy = std::max(energy, other.energy);
        swings = std::max(swings, other.swings);
        peak = std::max(peak, other.peak);
        late = std::max(late, other.late);
        if (!(other.stops > stops)) return;
        stops = other.stops;
        stop = other.stop;
    }

  private:
    void reach(double largest, double mean) noexcept {
        constexpr double most = 10;
        peak = std::max(peak, std::min(largest / mean, most));
    }
};

/// What a part did. Energies are those of the part.
struct PartMotion {
    std::vector<PartRow> rows; ///< of all plastic joints, in an order that stays
    double plastic_work = 0;   ///< of all plastic joints since they were made [J]
    double idle_work = 0;      ///< of it, of what has no part in this: whole members, islands that
                               ///< are left alone [J]
    /// Strength x travel that nobody misses, the least of what has no row as it is closed: sections
    /// of members; 0: there are none.
    double closed_work = 0;
    double closed_share = 0;   ///< of their strength, that members may have borne at most [-]
    double rigid_work = 0;     ///< that rigid rows of plastic joints took, either sign [J]
    double others_work = 0;    ///< that rigid rows of the engine's joints took there, or gave where
                               ///< that is no drift that they pull back [J]
    double stored = 0;         ///< that elastic ones hold [J]
    OwnForces own = {};        ///< of the engine's springs and motors
    double contact_work = 0;   ///< that hard contacts of islands with plastic joints took [J]
    bool contact_lost = false; ///< one that pushed at first had opened at the end
    /// The farthest that a body turned which a contact pushed; 0 where that could misplace nothing
    /// that matters [rad].
    double turned = 0;
    /// When a gap closed that was not foreseen, so that the contact pushed before it touched [s];
    /// 0: none that matters.
    double closed = 0;

    [[nodiscard]] bool flows() const noexcept {
        return std::any_of(rows.begin(), rows.end(),
                           [](const PartRow& row) { return row.moves(); });
    }
};

/// Contacts that close.
struct ClosingContacts {
    /// One that touches closes, or hands threw what the engine's own joints hold to something
    /// plastic: a blow has to come first.
    bool strikes = false;
    double time = std::numeric_limits<double>::infinity(); ///< until the next gap closes [s]
};

/// Whether a contact that touched at `closed` [s], 0: none did, pushed for so much longer in a part
/// of `h` [s] that it took `share` of the speed before [-].
[[nodiscard]] inline bool pushed_too_early(double closed, double h, double share) noexcept {
    return closed > 0 && 2 * (h - closed) > share * h;
}

class PartEngine {
  public:
    /// False where the coming part will stand, as far as can be told before it: nothing is near its
    /// strength, nothing closes, and nobody did anything. Then nothing is saved.
    [[nodiscard]] virtual bool may_be_put_back() { return true; }
    /// Keeps all that a part may change, for one put_back or more, in place of what was kept.
    virtual void save() = 0;
    /// Everything is as it was at the last `save`, bit for bit.
    virtual void put_back() = 0;
    /// Goes one part of `h` > 0 [s]. Valid until the next one.
    virtual const PartMotion& part(double h) = 0;
    /// Impulses alone; of what it tells the rows are read.
    virtual const PartMotion& blow() = 0;
    /// The last part, or blow (`h` = 0), stands [s].
    virtual void accept(double h) = 0;
    /// Looks `h` [s] ahead for contacts on islands with plastic joints. Ones that close with less
    /// energy than `touching`, and gaps that close with less than `apart`, do not count [J].
    [[nodiscard]] virtual ClosingContacts closing(double h, double touching, double apart) = 0;
    /// Of all bodies [J].
    [[nodiscard]] virtual double kinetic_energy() const = 0;
    /// What rigid rows may take in a part of `h` as positions are rounded [J]: the shorter it is
    /// the more.
    [[nodiscard]] virtual double rounding(double /*h*/) const { return 0; }
    /// A part in which contacts took such a share of the speed too early is put back whatever else
    /// it tells; infinite: it stands.
    void set_early_share(double share) noexcept { early_share_ = share; }
    /// A driven body's motion began in the last frame, which took it for a jump, and goes on.
    [[nodiscard]] virtual bool was_misread() const { return false; }
    /// Length below which a part is not cut any more [s], > 0.
    [[nodiscard]] virtual double shortest_part() const noexcept { return 1e-7; }

  protected:
    /// Where a gap closed that was not foreseen [s]; such a part need not be looked at.
    [[nodiscard]] bool is_put_back(double closed, double h) const noexcept {
        return pushed_too_early(closed, h, early_share_);
    }

    PartEngine() = default;
    PartEngine(const PartEngine&) = default;
    PartEngine& operator=(const PartEngine&) = default;
    ~PartEngine() = default;

  private:
    double early_share_ = std::numeric_limits<double>::infinity();
};

} // namespace ductile
