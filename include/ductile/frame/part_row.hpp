// SPDX-License-Identifier: MIT
//
// What one part of a frame misplaced of the travel of a plastic row, told from that part alone and
// the acceleration in the one before.
//
// A part moves bodies with the mean of their velocities before and after it, so a row that is
// braked by a constant force is exact, whatever the length of the part. Off is
//
//   a row that stopped    its strength R acted for the whole part, and would have for a share of
//                         it: the mean force f says which,  s = h |f|/R,  e = |u| h (1 - |f|/R)/2;
//                         where it went along with u, as a load turned the row round, -|f| for |f|
//   one that turned round e >= |u' - u| h/8, at  s = h |u|/|u' - u|; however slow it is then, its
//                         force was that of its flow back. Where its acceleration went on all the
//                         same a hand turned it: ten times that, as it adds up from turn to turn,
//                         and s a thousandth sooner, so that the part ends before it turns
//   one that its load     lacks the speed Δ that it should go back with, in all that follows: that
//   turns round           is R Δ T, if it goes back for as much work as there was so far;
//                         Δ = |c (h - s) -+ |u'||,  s = |u|/b,  T = √(2 W/(R c)),  c = b - 2 r;  it
//                         was braked by b = -a₋, of which its own is r = (b - |u' - u|/h)/(1 -+
//                         |f|/R)
//   one that flows        with a force that changes: e = |a'| h³/12,  a' = (a - a₋)/((h + h₋)/2);
//                         three times that where the flow began within the part
//                         short of its strength by d R, as its force was foretold: + d |u + u'| h/2
//   an elastic one        e = |a'| h³/8, weighted by max(|f|/R, 0.3), as it is the nearness of its
//                         strength that makes it matter; nothing below 5 % of R, unless it stops
//                         more in the part than its spring holds at yield
//                         after a flow it swings, and where more than its own force ever moved it
//                         what its phase is off by goes on as a speed:
//                         Δ = |a'| h² ω h/12,  R/m = 2 ω² U/R,  Δ/√(R/m) = |a'| h³/12 √(R/2U),
//                         four times that, as those of a swing add up
//                         one that turned at its strength had that for all of the part:
//                         s = h |u|/|u' - u|,  e >= |u' - u| h/8,  Δ = |u'|,  c = |u' - u|/h
//
// Symbols
//   u, u'   velocity of the row at the start and end of the part     [m/s | rad/s]
//   a, a₋   (u' - u)/h in this part and in the one before            [m/s² | rad/s²]
//   f, R    mean force over the part, strength                       [N | N m]
//   h, h₋   length of the part and of the one before; h₋ = 0: a₋ = 0 [s]
//   e       travel that may be misplaced                             [m | rad]
//   s       instant within the part at which the flow ended          [s]
//   W       plastic work of all rows so far                          [J]
//   U, ω    what the spring holds at yield, its own frequency        [J, rad/s]
//
// Limit cases: constant force: e = 0. h → 0: e is of second order, and of first where a flow stops,
// until the part ends there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ductile {

/// One plastic row in one part. Plain value.
struct PartRow {
    std::size_t joint = 0; ///< whose, as its world counts joints
    int section = 0;       ///< which of a member's, whose rows come and go
    int island = -1;       ///< what hangs together has one number, from 0; -1: it is not told
    double work = 0;       ///< plastic, of its joint since it was made, told once [J]
    double start = 0;      ///< u [m/s | rad/s]
    double end = 0;        ///< u' [m/s | rad/s]
    double share = 0;      ///< |f|/R, in [0, 1]; of rows that share a surface its utilisation
    double own_share = 1;  ///< |f|/R of its axis alone: a strong one of a surface hardly flows [-]
    double force = 0;      ///< f, along its velocity [N | N m]
    double strength = 0;   ///< R; 0 where broken [N | N m]
    double below = 0;      ///< share of R by which it flows below it, where its force was foretold
    double noise = 0;      ///< speed that is as good as rest [m/s | rad/s]
    double turning = 0;    ///< speed that a row may keep that turns with its bodies and holds
                           ///< [m/s | rad/s]
    double least = 0;      ///< travel that nobody misses [m | rad]
    double too_far = 0;    ///< turn of a body that its joint could not follow, else 0 [rad]
    double carried = 0;    ///< turn of a body that is driven, with all that hangs on it [rad]
    double given = 0;      ///< that damping gave its joint in place of taking it, told once [J]
    double unfit = 0;     ///< that rigid rows of its joint took of velocities given from elsewhere,
                          ///< which they do not allow, told once [J]
    double broke = 0;     ///< how long its joint held in the part that broke it [s]
    double astray = 0;    ///< of its work then: it had a share of its strength all along [J]
    double freed = 0;     ///< that its springs held as it broke [J]
    bool alone = false;   ///< of a joint of one axis: `astray` is all of its work then
    bool snapped = false; ///< it broke before it flowed
    double run = 0;       ///< its way then, until it broke [m | rad]
    double misfit = 0;    ///< of its work, that its strength on the way would not have taken [J]
    bool elastic = false; ///< below its strength it is a spring
    double spring = 0;    ///< what that holds at yield [J]
    bool swings = false;  ///< as a spring of one axis, not at its strength all along
    bool yielded = false; ///< that, or before

    /// Of what it stopped in a part of h, with its mean force [J]; nothing where that goes on.
    [[nodiscard]] double stopped(double h) const noexcept {
        const double change = std::abs(end - start);
        if (!(change >= std::abs(start)) || change == 0) return 0;
        return std::min(share, own_share) * strength * h * start * start / (2 * change);
    }
    /// The force went with u: it is that of a flow the other way.
    [[nodiscard]] bool pushes() const noexcept { return force * start > 0; }
    [[nodiscard]] double speed() const noexcept { return std::max(std::abs(start), std::abs(end)); }
    /// Its force is its strength.
    [[nodiscard]] bool flows() const noexcept {
        constexpr double holds = 1 - 1e-6, least_own = 0.1;
        return share >= holds && own_share >= least_own;
    }
    /// It was at its strength, one way, for all of a part in which it went back and forth.
    [[nodiscard]] bool turned_at_strength() const noexcept {
        constexpr double nearly = 0.999;
        return std::min(share, own_share) >= nearly && start * end < 0;
    }
    /// It was at rest when the part began.
    [[nodiscard]] bool starts() const noexcept { return std::abs(start) <= noise; }
    /// Negated so that a speed that is no number moves.
    [[nodiscard]] bool moves() const noexcept {
        const double rest = flows() ? noise : std::max(noise, turning);
        return strength > 0 && !(std::abs(start) <= rest && std::abs(end) <= rest);
    }
    /// It did nothing, far below its strength.
    [[nodiscard]] bool is_calm() const noexcept {
        constexpr double near = 0.5; // of the strength
        return strength > 0 && share <= near && !moves();
    }
};

/// What a part misplaced of a row; travel is no number where the part's answer is none.
struct Misplaced {
    double travel = 0;  ///< e, weighted [m | rad]
    double stop = 0;    ///< s; 0: it did not end within the part [s]
    double lacking = 0; ///< Δ/√c, of a row that its load turns round [(m | rad)^½]
    bool ended = false; ///< noticeably: accelerations before and after have nothing to do with
                        ///< each other
};

/// What is known of a row from the part before. Where nothing is, all of its acceleration counts as
/// new.
struct PartBefore {
    double acceleration = 0; ///< a₋ [m/s² | rad/s²]
    double length = 0;       ///< h₋ [s]
    double end = 0;          ///< u' of it [m/s | rad/s]
    double force = 0;        ///< f of it [N | N m]
    double mass = 0;         ///< that it moved as a spring; 0: not known [kg | kg m²]
    bool swings = false;     ///< it moved as a spring
    bool driven = false;     ///< by more than its own force, then or before
    bool fast = false;       ///< it swings faster than a frame's parts can follow
};

/// s and Δ/√c of a row that stopped in a part with the force of one direction; nothing where it was
/// not known to be braked, or rests.
[[nodiscard]] inline Misplaced turned_round(const PartRow& row, double h,
                                            const PartBefore& before) noexcept {
    const double way = std::copysign(1.0, row.start), share = std::min(1.0, row.share);
    const double braked = -way * before.acceleration, mean = way * (row.start - row.end) / h;
    const double not_its_own = 1 - (row.pushes() ? -share : share);
    const double own = (braked - mean) / not_its_own, back = braked - 2 * own;
    const double stop = std::abs(row.start) / braked;
    if (!(own > 0 && back > 0 && not_its_own > 0 && stop > 0 && stop < h)) return {};
    return {.stop = stop, .lacking = std::abs(back * (h - stop) + way * row.end) / std::sqrt(back)};
}

/// What a spring moves, Δf/Δa from part to part whatever rests on it; 0 where too little changes to
/// tell.
[[nodiscard]] inline double swung_mass(const PartRow& row, double h,
                                       const PartBefore& before) noexcept {
    constexpr double noticed = 1e-3;
    const double change = row.force - before.force;
    const double faster = (row.end - row.start) / h - before.acceleration;
    const bool tells = row.swings && before.swings && before.length > 0 &&
                       std::abs(change) > noticed * row.strength && faster * change > 0;
    return tells ? change / faster : 0;
}

/// Whether more than its own force moved a row: a load m a - f, or what gave it another speed while
/// it swung, a blow (h = 0) or a hand before the part. It may flow again, then.
[[nodiscard]] inline bool is_driven(const PartRow& row, double h,
                                    const PartBefore& before) noexcept {
    constexpr double much = 0.05, another = 0.3;
    if (!row.swings || !before.swings) return before.driven;
    const double load = before.mass * (row.end - row.start) / h - row.force;
    const bool loaded = h > 0 && before.mass > 0 && std::abs(load) > much * row.strength;
    const double given = h > 0 ? row.start : row.end;
    const double fastest = std::max(std::abs(given), std::abs(before.end));
    const bool struck = std::abs(given - before.end) > another * fastest;
    return before.driven || loaded || struck;
}

/// Of a spring; `changed`: |a'|, `below`: travel by which it flows below its strength.
[[nodiscard]] inline Misplaced misplaced_by_spring(const PartRow& row, double h,
                                                   const PartBefore& before, double changed,
                                                   double below) noexcept {
    constexpr double idle = 0.02, least_weight = 0.3, parts_of_a_swing = 8;
    Misplaced result;
    if (row.share <= idle && !(row.stopped(h) > row.spring)) return result;
    const double share = std::min(1.0, row.share), cube = h * h * h;
    const bool driven = is_driven(row, h, before);
    if (!(row.swings && before.swings && before.fast) || driven) {
        result.travel = changed * cube / 8 * std::max(share, least_weight) + below;
    }
    if (row.swings && row.yielded && driven) {
        const double eased = std::sqrt(row.strength / (2 * row.spring)); // ω/√(R/m)
        result.lacking = parts_of_a_swing * changed * cube / 12 * eased;
    }
    if (row.turned_at_strength()) {
        const double change = std::abs(row.end - row.start);
        result.travel = std::max(result.travel, change * h / 8);
        result.lacking = std::abs(row.end) * std::sqrt(h / change);
        result.stop = h * std::abs(row.start) / change;
    }
    return result;
}

/// It was turned round at its strength, and its acceleration went on, whatever its force.
[[nodiscard]] inline bool turned_by_hand(const PartRow& row, double h,
                                         const PartBefore& before) noexcept {
    constexpr double whole = 1 - 1e-6, alike = 0.1;
    const double acceleration = (row.end - row.start) / h;
    return row.start * row.end < 0 && row.pushes() && row.share >= whole &&
           std::abs(acceleration - before.acceleration) < alike * std::abs(acceleration);
}

[[nodiscard]] inline Misplaced misplaced(const PartRow& row, double h,
                                         const PartBefore& before) noexcept {
    Misplaced result;
    if (!row.moves()) return result;
    const double change = row.end - row.start, start = std::abs(row.start);
    if (!std::isfinite(change) || !std::isfinite(row.share)) {
        result.travel = std::numeric_limits<double>::quiet_NaN();
        return result;
    }
    const double share = std::min(1.0, row.share);
    const bool moved = start > row.noise; // at the start of the part
    const double changed = 2 * std::abs(change / h - before.acceleration) / (h + before.length);
    const double below = row.below * std::abs(row.start + row.end) * h / 2;
    if (row.elastic) {
        result = misplaced_by_spring(row, h, before, changed, below);
    } else if (moved && (row.start * row.end <= 0 || std::abs(row.end) <= row.noise)) {
        const double pushed = row.pushes() ? std::min(share, row.own_share) : 0;
        const double braked = share - 2 * pushed;
        result.travel = start * h * (1 - braked) / 2;
        double stop = braked * h;
        constexpr double whole = 1 - 1e-6, nothing = 1e-3, noticed = 1e-4;
        constexpr double adds_up = 10, before_it = 0.999;
        const bool turned = row.start * row.end < 0;
        if (turned && (std::abs(row.end) > row.noise || (row.pushes() && share >= whole))) {
            result.travel = std::max(result.travel, std::abs(change) * h / 8);
            stop = h * start / std::abs(change);
        }
        if (turned_by_hand(row, h, before)) {
            result.travel *= adds_up;
            stop *= before_it;
        } else if (const Misplaced back = turned_round(row, h, before); back.lacking > 0) {
            result.lacking = back.lacking;
            stop = back.stop;
        }
        if (stop > nothing * h && stop < whole * h) result.stop = stop;
        result.ended = result.travel > noticed * start * h;
    } else {
        result.travel = changed * h * h * h / (moved ? 12 : 4) + below;
    }
    return result;
}

/// A row of one axis that broke in a part after the way x had a share of its strength for all of
/// the part, where it would have had all for a time τ. The work is the same, and without a load so
/// is the impulse. Under one τ tells itself from the flow of the part before,
///
///   u τ + a₋ τ²/2 = x,   e = |τ |u + u'|/(2 x) - 1| of its work
///
/// Where nothing is known of that and a load made it faster, all of its work counts.
struct BrokeAlone {
    double stop;   ///< τ [s]
    double astray; ///< [J]
};
[[nodiscard]] inline BrokeAlone broke_alone(const PartRow& row, const PartBefore& before,
                                            bool flowed_before) noexcept {
    const double way = std::copysign(1.0, row.start + row.end), start = way * row.start;
    if (!flowed_before) {
        const bool driven = std::abs(row.end) > std::abs(row.start);
        return {row.broke, driven ? row.astray : 0};
    }
    const double square = start * start + 2 * way * before.acceleration * row.run;
    const double sum = start + std::sqrt(std::max(square, 0.0));
    if (!(row.run > 0 && sum > 0)) return {row.broke, 0};
    const double stop = 2 * row.run / sum, other = stop * std::abs(row.start + row.end);
    return {stop, row.astray * std::min(std::abs(other / (2 * row.run) - 1), 1.0)};
}

/// Of one that broke otherwise all counts; until it snapped a spring is off by e as any other.
[[nodiscard]] inline BrokeAlone broke_with_others(const PartRow& row, double h,
                                                  const PartBefore& before) noexcept {
    if (!row.snapped || !row.elastic) return {row.broke, row.astray};
    const double change = (row.end - row.start) / h - before.acceleration;
    const double travel = std::abs(change) / (h + before.length) * h * h * h / 4;
    return {row.broke, row.astray + std::abs(row.force) * travel};
}

/// What a row took after another joint had broken at `held` of a part of h: the rigid rows of that
/// acted on it all along, by nobody knows how much [J].
[[nodiscard]] inline double flow_after(const PartRow& row, double held, double h) noexcept {
    return row.flows() ? row.strength * std::abs(row.start + row.end) / 2 * (h - held) : 0;
}

/// What that is in energy; `work`: W [J].
[[nodiscard]] inline double misplaced_energy(const PartRow& row, const Misplaced& off,
                                             double work) noexcept {
    return row.strength * off.travel + off.lacking * std::sqrt(2 * row.strength * work);
}

/// Work that the row will still take if it goes on as in this part [J].
[[nodiscard]] inline double work_ahead(const PartRow& row, double h) noexcept {
    if (!row.moves()) return 0;
    const double start = std::abs(row.start), change = row.end - row.start;
    if (start <= row.noise) return row.strength * row.speed() * h / 2;
    const bool slows = change * row.start < 0;
    return row.strength * start * h * (slows ? start / (2 * std::abs(change)) : 1.0);
}

} // namespace ductile
