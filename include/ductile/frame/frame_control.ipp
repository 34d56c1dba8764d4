// SPDX-License-Identifier: MIT
//
// Bodies of frame_control.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ductile/frame/frame_control.hpp"
#include "ductile/frame/frame_judgement.ipp" // IWYU pragma: keep
#include "ductile/frame/frame_rules.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

DUCTILE_INLINE void FrameParameters::validate(const char* owner) const {
    const std::string name(owner);
    check::positive(name + ".tolerance", tolerance, "");
    if (budget < 4) check::fail(name + ".budget", double(budget), "solves", "at least 4");
}

DUCTILE_INLINE FrameControl::FrameControl(const FrameParameters& parameters)
    : parameters_(parameters) {
    parameters_.validate();
    run_.tolerance = parameters_.tolerance;
}

DUCTILE_INLINE void FrameControl::forget() noexcept {
    past_.clear();
    kicked_.clear();
    fresh_ = fitted_ = false;
    next_ = spin_ = start_ = 0;
}

/// Of the work of a part, that may be misplaced in it [-].
DUCTILE_INLINE double FrameControl::tolerated_share() const noexcept {
    return detail::part_share * parameters_.tolerance;
}

DUCTILE_INLINE const FrameReport& FrameControl::frame(PartEngine& engine, double length) {
    check::positive("FrameControl.frame.length", length, "s");
    report_ = {};
    const bool misread = engine.was_misread();
    if (misread) report_.left.energy += last_work_;
    begin_kicks(misread);
    const double before = work_;
    length_ = length;
    solves_ = 0;
    stop_failed_ = false;
    if (!at_stake(length)) next_ = spin_ = 0;
    double left = length;
    while (left > detail::nothing_left * length) {
        const double gap = strike(engine, first_length(left));
        left -= attempt(engine, first_length(left), gap, left);
    }
    last_work_ = work_ - before;
    run_.add(report_, work_);
    return report_;
}

DUCTILE_INLINE void FrameControl::sleep() {
    report_ = {};
    last_work_ = 0;
    run_.add(report_, work_);
}

/// As long as the last part suggests, not past the first stop of a row.
DUCTILE_INLINE double FrameControl::first_length(double left) noexcept {
    starts_ = false;
    if (spent()) return left;
    double h = followed(left);
    if (next_ > 0 && next_ < left) h = std::min({h, next_, left / 2});
    if (!fresh_) return first_stop(h);
    starts_ = at_stake(h);
    return starts_ ? std::min(std::max(detail::start_share * h, start_), h) : h;
}

/// Whether the rows could misplace more than what is allowed.
DUCTILE_INLINE bool FrameControl::at_stake(double h) const noexcept {
    double work = 0;
    for (const Past& past : past_) work += past.row.strength * std::abs(past.row.end) * h;
    return !(work <= allowed_);
}

/// The longest of equal parts of `h` in which what is pushed turns no farther than it may.
DUCTILE_INLINE double FrameControl::followed(double h) const noexcept {
    constexpr double most = detail::of_turns * detail::followed_turn;
    const double turn = spin_ * h;
    return turn > most ? h / std::ceil(turn / most) : h;
}

/// When the first row stops that would then misplace more than what is allowed; else `h`.
DUCTILE_INLINE double FrameControl::first_stop(double h) const noexcept {
    double stop = h;
    for (const auto& [row, acceleration, mass, driven, fast] : past_) {
        const double speed = std::abs(row.end);
        if (!(acceleration * row.end < 0) || !(row.strength > 0) || speed <= row.noise) continue;
        constexpr double nothing = 1e-3;
        const double time = speed / std::abs(acceleration);
        const double missed = row.strength * speed * (h - time) / 2;
        if (time < stop && time > nothing * h && missed > allowed_) stop = time;
    }
    return std::min((1 + 1e-7) * stop, h); // past it
}

/// Gives a blow to contacts that touch and close; returns when the next gap closes [s].
DUCTILE_INLINE double FrameControl::strike(PartEngine& engine, double h) {
    constexpr int most_in_an_instant = 3;
    constexpr double noticed = 1e-7; // of the kinetic energy
    for (int i = 0; !spent(); ++i) {
        const double least = noticed * engine.kinetic_energy();
        const ClosingContacts seen =
            engine.closing(h, std::max(0.1 * allowed_, least), std::max(allowed_, least));
        if (!seen.strikes || i == most_in_an_instant) return seen.time;
        remember(engine.blow(), 0);
        engine.accept(0);
        ++solves_;
        ++report_.blows;
        fresh_ = true;
        fitted_ = false;
        next_ = spin_ = start_ = 0;
    }
    return std::numeric_limits<double>::infinity();
}

/// `h` = 0: a blow.
DUCTILE_INLINE void FrameControl::remember(const PartMotion& motion, double h) {
    if (past_.size() != motion.rows.size()) kicked_.assign(motion.rows.size(), {});
    past_.resize(motion.rows.size());
    for (std::size_t i = 0; i < motion.rows.size(); ++i) {
        const PartRow& row = motion.rows[i];
        const PartBefore known = before(i, motion);
        Past now{row, past_[i].acceleration, known.mass, is_driven(row, h, known), false};
        if (h > 0) {
            now.acceleration = (row.end - row.start) / h;
            const double mass = swung_mass(row, h, known);
            if (mass > 0) now.mass = mass;
        }
        now.fast = known.fast && row.moves() && !now.driven;
        past_[i] = now;
    }
    if (h > 0) before_ = h;
}

DUCTILE_INLINE void FrameControl::forget_accelerations() noexcept {
    for (Past& past : past_) past.acceleration = 0;
    before_ = 0;
}

/// Does a part of `h` or less, not past `gap`, of the frame's `left`; returns its length [s].
DUCTILE_INLINE double FrameControl::attempt(PartEngine& engine, double h, double gap, double left) {
    const double shortest = engine.shortest_part();
    const bool at_gap = gap < h;
    if (at_gap) h = std::max(gap, detail::hair * shortest);
    if (left - h < shortest) h = left;
    const bool saved = engine.may_be_put_back();
    if (saved) engine.save();
    double first_error = std::numeric_limits<double>::infinity();
    const double first = h;
    bool jump = false, at_event = at_gap, at_stop = false;
    for (int tries = 0;; ++tries) {
        ++solves_;
        const bool last = jump || !saved || spent() || tries >= detail::tries_at_gaps;
        engine.set_early_share(last ? std::numeric_limits<double>::infinity() : tolerated_share());
        const PartMotion& motion = engine.part(h);
        Judgement judged = judge(motion, h, shortest);
        const double early = judged.closed;
        if (tries >= detail::tries_at_gaps) judged.closed = 0;
        allowed_ = judged.allowed * judged.of_island;
        run_.least = std::max(run_.least, judged.least); // of what sleeps too
        run_.of_one = std::max(run_.of_one, judged.of_one);
        const double error = detail::likely_error(judged, judged.most);
        // of one that turned too far, or through a gap, it says nothing, and such a part is no way
        // out
        if (tries == 0 && !(judged.turned > 0) && !(early > 0)) first_error = error;
        const bool good =
            judged.error <= judged.allowed && judged.closed == 0 && judged.turned == 0;
        jump = jump || (!good && tries == 0 && is_noise(engine, judged));
        const bool done = jump || !saved || spent() || tries > detail::most_tries ||
                          (h <= shortest && judged.closed == 0);
        if (good || done) {
            // what a contact pushed before it touched moved rows for as long
            if (spent()) judged.error += judged.power * early;
            // so does one whose way was not followed
            if (const double turn = detail::turn_of(motion); turn > detail::followed_turn) {
                judged.error += judged.power * h * turn / 2;
            }
            stand(engine, motion, judged, h, at_event, jump);
            return h;
        }
        engine.put_back();
        ++report_.rejected;
        stop_failed_ = stop_failed_ || at_stop;
        constexpr double of_length = 0.1, of_error = 0.7;
        if (tries >= 3 && h < of_length * first && error > of_error * first_error) {
            // velocities that do not fit, as hands gave them between frames, are struck
            const bool unfit =
                report_.parts == 0 && !fitted_ && judged.struck > of_error * judged.error;
            jump = !unfit;
            at_event = at_gap && jump;
            h = jump ? first : shortest;
        } else {
            // nothing is known of what was before: a short part first
            const bool unknown = past_.empty() && !motion.rows.empty();
            const bool start = tries == 0 && unknown && judged.closed == 0;
            const Shorter next = start ? Shorter{detail::start_share * h, false}
                                       : shorter(judged, motion, h, !stop_failed_);
            fresh_ = fresh_ || start;
            starts_ = starts_ || start;
            at_event = next.at_event;
            at_stop = at_event && judged.closed == 0;
            h = std::max(next.length, (judged.closed > 0 ? detail::hair : 1) * shortest);
        }
    }
}

/// `may_stop`: it may be ended where a flow stops.
DUCTILE_INLINE auto FrameControl::shorter(const Judgement& judged, const PartMotion& motion,
                                          double h, bool may_stop) -> Shorter {
    constexpr double past_it = 1 + 1e-9;
    if (judged.closed > 0) return {judged.closed, true};
    // equal parts, as those of other lengths turn otherwise
    if (judged.turned > 0) return {h / std::max(std::ceil(judged.turned), 2.0), false};
    if (judged.stop > 0 && !motion.contact_lost && may_stop) {
        return {judged.stop * past_it, true};
    }
    return {h * detail::growth(judged.allowed, judged.error, 2, 0.1, 0.7), false};
}

/// The part stands; `at_event`: it ends where a flow stopped or a gap closed.
DUCTILE_INLINE void FrameControl::stand(PartEngine& engine, const PartMotion& motion,
                                        const Judgement& judged, double h, bool at_event,
                                        bool jump) {
    ++report_.parts;
    report_.jumps += jump;
    work_ = motion.plastic_work;
    taken_ += motion.rigid_work;
    run_.given = taken_ > 0 ? 0.0 : 0.0 - taken_;
    run_.stored = std::max(run_.stored, motion.stored);
    // as it was, it stays an alarm
    const double error =
        detail::likely_error(judged, std::max(judged.most, 2 * parameters_.tolerance * work_));
    report_.error += error;
    if (!(judged.error <= judged.tolerated)) say_unresolved(motion, error, h);
    remember(motion, h);
    doubt_kicks(motion, h);
    // a kick, or what closes the rest of a gap: it says nothing of the forces that follow
    const double shortest = engine.shortest_part();
    const bool closes = at_event && h < shortest;
    if (closes || (h <= shortest && judged.of_rows > judged.allowed)) forget_accelerations();
    fresh_ = judged.ended || at_event;
    // a first short part says nothing of the next one's length
    const bool says = !starts_ && !jump;
    const double longer = h * detail::growth(judged.allowed, judged.error, 3, 0.2, 3);
    next_ = says ? longer : 0;
    // unless flows stop in one after the other, at the cost of the budget
    start_ = starts_ && fresh_ && !jump && used() > detail::many_starts ? longer : 0;
    spin_ = detail::turn_of(motion) / h;
    fitted_ = judged.fitted;
    engine.accept(h);
}

/// A frame begins; `misread`: as PartEngine::was_misread.
DUCTILE_INLINE void FrameControl::begin_kicks(bool misread) {
    constexpr double at_most = 0.8; // of the frame: who flows longer by it would flow anyhow
    for (std::size_t i = 0; i < kicked_.size(); ++i) {
        Kicked& kicked = kicked_[i];
        if (misread && kicked.speed > 0 && kicked.time <= at_most * length_) {
            kicked.misread = true;
            kicked.time = 0;
        }
        const PartRow& row = past_[i].row;
        if (!kicked.misread) kicked = {.rests = std::abs(row.end) <= row.noise};
    }
}

/// What flows since it was kicked, as if a motion had begun at once that did not, should perhaps
/// not: the kick v is gone after v/d where the row becomes slower by d, and has taken R v²/(2 d). d
/// is that of the whole flow, its peak by its time.
DUCTILE_INLINE void FrameControl::doubt_kicks(const PartMotion& motion, double h) {
    for (std::size_t i = 0; i < kicked_.size(); ++i) {
        const PartRow& row = motion.rows[i];
        Kicked& kicked = kicked_[i];
        if (!kicked.misread) {
            if (kicked.rests && row.moves()) {
                kicked.speed = std::max(kicked.speed, row.speed());
                kicked.time += h;
            }
            continue;
        }
        kicked.time += h;
        if (row.moves()) {
            kicked.peak = std::max(kicked.peak, row.speed());
            kicked.work += row.strength * std::abs(row.start + row.end) / 2 * h;
        } else if (kicked.time > length_) {
            kicked = {};
            continue;
        }
        if (!(kicked.peak > 0)) continue;
        const double square = kicked.speed * kicked.speed;
        const double taken =
            std::min(kicked.work, row.strength * square * kicked.time / kicked.peak);
        if (!(taken > kicked.doubted)) continue;
        const double energy = taken - std::exchange(kicked.doubted, taken);
        report_.left.energy += energy;
        add_unresolved(report_.joints, row.joint, {energy, 0, 0});
    }
}

DUCTILE_INLINE void FrameControl::say_unresolved(const PartMotion& motion, double error, double h) {
    report_.left.energy += error;
    report_.left.time += h;
    std::vector<UnresolvedJoint> joints;
    for (std::size_t i = 0; i < motion.rows.size(); ++i) {
        const PartRow& row = motion.rows[i];
        const double travel = misplaced(row, h, before(i, motion)).travel;
        if (travel == 0) continue;
        report_.left.travel += travel;
        add_unresolved(joints, row.joint, {row.strength * travel, travel, 0});
    }
    for (UnresolvedJoint& entry : joints) {
        entry.left.time = h;
        add_unresolved(report_.joints, entry.joint, entry.left);
    }
}

} // namespace ductile
