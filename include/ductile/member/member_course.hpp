// SPDX-License-Identifier: MIT
//
// A member while it is in an engine: which bodies it is now, and, after a step, whether that was
// enough. All that an adapter needs to know but how its engine makes and moves bodies:
//
//   after a step   beyond(steps, loads, dt)     sections that have to open: put the step back,
//                  open(sections, bodies)       the bodies that it is from then on; do it again
//   after a blow   struck(steps, loads, blow)   the same for one section at a time
//   it stands      close(bodies)                the bodies that it is from then on
//
// The adapter writes what open sections' joints went through into state() before it asks.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ductile/member/blow.hpp"
#include "ductile/member/redundant_forces.hpp"
#include "ductile/world/joint_report.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile {

/// What a joint of the engine's gave one of its bodies in a blow. World axes.
struct JointSide {
    ContactBody before{}; ///< as it would go without any member, zero where it stands
    ContactBody after{};
    Vector3<double> arm{0, 0, 0}; ///< from its centre of mass to where the joint holds [m]
    Vector3<double> impulse{0, 0, 0}, moment{0, 0, 0}; ///< about its centre [N s], [N m s]

    /// From the body [J].
    [[nodiscard]] double taken() const {
        return -(dot(impulse, sum(before.velocity, after.velocity)) +
                 dot(moment, sum(before.spin, after.spin))) /
               2;
    }
};

/// What struck a member. Plain value.
struct MemberStrike {
    double energy = 0; ///< that its contacts, or joints, took [J]
    double speed = 0;  ///< at which the fastest of them closed [m/s]
    int segment = 0;   ///< where that was

    void add(double taken, double closing, int at) noexcept {
        energy += taken;
        if (closing <= speed) return;
        speed = closing;
        segment = at;
    }
    /// A joint between the member, `at` this segment, and something else.
    void add(const JointSide& member, const JointSide& other, int at) {
        const double pull = norm(member.impulse);
        const Vector3<double> comes =
            difference(other.before.at(other.arm), member.before.at(member.arm));
        add(member.taken() + other.taken(), pull > 0 ? dot(member.impulse, comes) / pull : 0, at);
    }
};

class MemberCourse {
  public:
    explicit MemberCourse(Member member, const ActiveSections& rule = {})
        : member_(std::move(member)), rule_(rule), state_(straight(member_)) {
        make_pieces();
    }
    MemberCourse(const MemberCourse&) = delete;
    MemberCourse& operator=(const MemberCourse&) = delete;

    [[nodiscard]] const Member& member() const noexcept { return member_; }
    [[nodiscard]] const MemberState& state() const noexcept { return state_; }
    [[nodiscard]] SectionState& section(int i) noexcept { return state_[std::size_t(i)]; }
    [[nodiscard]] const SectionState& section(int i) const noexcept {
        return state_[std::size_t(i)];
    }
    [[nodiscard]] const std::vector<MemberPiece>& pieces() const noexcept { return pieces_; }
    [[nodiscard]] bool whole() const noexcept { return pieces_.size() == 1; }
    [[nodiscard]] int open_sections() const noexcept { return int(pieces_.size()) - 1; }
    /// The piece that has a segment.
    [[nodiscard]] std::size_t piece_of(int segment) const noexcept {
        std::size_t i = 0;
        while (i + 1 < pieces_.size() && pieces_[i].run.last < segment) ++i;
        return i;
    }
    /// Straight enough to be the body that it was at first.
    [[nodiscard]] bool is_straight() const noexcept {
        constexpr double straight_enough = 1e-7; // [rad]
        return std::all_of(state_.begin(), state_.end(), [](const SectionState& section) {
            return std::abs(section.bend) < straight_enough;
        });
    }
    /// Of closed sections: energy that they absorbed [J], plastic travel [rad].
    [[nodiscard]] double closed_work() const noexcept { return closed_work_; }
    [[nodiscard]] double closed_travel() const noexcept { return closed_travel_; }
    /// Of closed sections: impulses that add up to less than a share load none beyond [N m].
    [[nodiscard]] double least_strength() const noexcept { return least_strength_; }
    /// Strength x travel that nobody misses, of its weakest section, open too; 0: none is closed.
    [[nodiscard]] double unmissed_work() const noexcept {
        return least_strength_ == std::numeric_limits<double>::infinity() ? 0 : unmissed_work_;
    }
    /// What blows leave in vibration of an elastic member, of what its sections did.
    [[nodiscard]] const MemberVibration& vibration() const noexcept { return vibration_; }
    void restore(const MemberVibration& vibration) noexcept { vibration_ = vibration; }
    /// What it carries beside what its motion says.
    [[nodiscard]] const RedundantForces& redundant() const noexcept { return redundant_; }
    void restore(const RedundantForces& redundant) { redundant_ = redundant; }
    /// To be called where a step stands, `state` being of then; what it left in vibration [J].
    double count_vibration() noexcept {
        if (!(vibration_.ahead > 0)) return 0;
        const double work = all_work();
        const double lost =
            std::clamp(vibration_.share * (work - vibration_.counted), 0.0, vibration_.ahead);
        vibration_.counted = work;
        vibration_.lost += lost;
        vibration_.ahead = whole() ? 0 : vibration_.ahead - lost;
        return lost;
    }
    /// Between supports that hold it along, as the last look saw them: to flow there it would have
    /// to stretch. None opens: rigid pieces held at both ends stand, in the limit of short steps.
    [[nodiscard]] bool is_locked(int section) const noexcept { return locked_.holds(section); }
    /// Largest left_over of the last `beyond` [-].
    [[nodiscard]] double left_over() const noexcept { return left_over_; }
    /// What the looks since the last call of begin_step met.
    [[nodiscard]] Unmodelled unmodelled() const noexcept { return unmodelled_; }
    void begin_step() noexcept { unmodelled_ = Unmodelled::nothing; }
    void doubt(Unmodelled what) noexcept { unmodelled_ = what; }

    /// Closed sections, the worst of each piece, that carried more than they can in a step of `dt`
    /// [s]; `steps`: by piece; but for what is locked. Valid until the next call.
    const std::vector<int>& beyond(std::span<const PieceStep> steps,
                                   std::span<const MemberLoad> loads, double dt) {
        found_.clear();
        left_over_ = 0;
        find_locked(loads);
        bool beside = false, locks = false;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            internal_forces(member_, pieces_[i], steps[i], loads, forces_);
            left_over_ = std::max(left_over_, forces_.left_over());
            beside = find_unmodelled(pieces_[i].mass * steps[i].blur, dt) || beside;
            int worst = worst_section(member_, state_, forces_, dt, rule_);
            if (locked_.holds(worst)) {
                locks = true;
                worst = worst_section(member_, state_, forces_, dt, rule_, locked_);
            }
            if (worst != no_section) found_.push_back(worst);
        }
        beside_for_ = beside ? beside_for_ + dt : 0;
        if (beside && (!has_blows_ || beside_for_ >= wave_time()))
            unmodelled_ = Unmodelled::off_plane;
        if (whole()) {
            if ((locks || !found_.empty()) && is_borne(steps, loads, dt)) {
                found_.clear();
                locks = false;
            }
            is_opened_ = !found_.empty();
        } else {
            is_opened_ = is_opened_ && dt == closed_dt_;
            if (is_opened_) list_supports(member_, pieces_, steps, loads, dt, supports_);
        }
        if (locks && found_.empty()) unmodelled_ = Unmodelled::stretch;
        return found_;
    }

    /// A blow begins: the next `struck` is its first. Joints that take no more than `noticed` [J]
    /// do not count: their bodies came with what a part left of their velocities.
    void begin_blow(double noticed = 0) noexcept {
        struck_ = rough_ = yields_ = is_opened_ = false;
        has_blows_ = true;
        noticed_ = noticed;
    }
    /// The section that a blow opens now, the nearest to where it struck; no_section: it bears it.
    /// `strike`: of contacts, `by_joints`: of joints of the engine's.
    [[nodiscard]] int struck(std::span<const PieceStep> steps, std::span<const MemberLoad> loads,
                             MemberStrike strike, const MemberStrike& by_joints = {}) {
        const Striker striker = by_joints.energy > strike.energy           ? Striker::sticks
                                : is_touched_beside(loads, strike.segment) ? Striker::pushes
                                                                           : Striker::pushes_alone;
        if (by_joints.energy > noticed_) {
            strike.add(by_joints.energy, by_joints.speed, by_joints.segment);
        }
        if (!(strike.energy > 0)) return no_section;
        find_locked(loads);
        BlowProfile profile;
        int nearest = no_section, least = std::numeric_limits<int>::max();
        double utilisation = 0;
        constexpr double noticed = 1e-4; // of the blow's energy
        bool locks = false;
        const bool first = !std::exchange(struck_, true);
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            internal_forces(member_, pieces_[i], steps[i], loads, forces_);
            profile.add(member_, forces_);
            const InternalForces& elastic = elastic_forces(steps, loads);
            const auto supports = whole() ? std::span<const MemberSupport>(closed_supports_)
                                          : std::span<const MemberSupport>();
            const MemberBlow blow = member_blow(member_, state_, elastic, strike.energy,
                                                strike.speed, strike.segment, supports, striker);
            utilisation = std::max(utilisation, blow.in_all);
            if (first) rough_ = rough_ || blow.is_rough();
            yields_ = yields_ || blow.yields();
            for (const SectionForce& carried : forces_.sections) {
                if (!yields_) break;
                const double taken = opening_energy(member_, pieces_[i], carried);
                if (!(taken > noticed * strike.energy)) continue;
                const int away = std::abs(2 * carried.section + 1 - 2 * strike.segment);
                locks = locks || locked_.holds(carried.section);
                if (away >= least || locked_.holds(carried.section)) continue;
                least = away;
                nearest = carried.section;
            }
        }
        if (first && nearest != no_section) expect_vibration(strike.energy, utilisation);
        if (rough_) unmodelled_ = Unmodelled::rough_blow;
        if (profile.is_off_plane(strike.energy)) unmodelled_ = Unmodelled::off_plane;
        if (locks && nearest == no_section) unmodelled_ = Unmodelled::stretch;
        return nearest;
    }

    /// Opens sections; `bodies`: the pieces as they are. What they are then, in order.
    std::vector<PlacedPiece> open(std::span<const int> sections,
                                  std::span<const PlacedPiece> bodies) {
        for (const int i : sections) {
            section(i).open = true;
            section(i).held = 0;
            ++section(i).alarms;
        }
        return rearrange(bodies);
    }
    /// Open sections to close. After a step, which stands: it is counted. Before a blow: all that
    /// do not move, as it is to be taken as the whole member takes it, whether they were opened
    /// long before or in a part that was put back.
    [[nodiscard]] const std::vector<int>& held(Closing when) {
        found_.clear();
        const bool step = when == Closing::after_step;
        const bool all = step && std::exchange(is_opened_, false) && is_proved();
        for (int i = 0; i < member_.sections(); ++i) {
            SectionState& of = section(i);
            if (all) of.alarms = 0;
            if (!of.open) continue;
            if (all || (step ? closes(of, rule_) : rests(of))) found_.push_back(i);
        }
        return found_;
    }
    /// As it was; the bodies have to be those of `state`.
    void restore(const MemberState& state) {
        state_ = state;
        is_opened_ = false;
        beside_for_ = 0;
        make_pieces();
    }
    /// Closes sections, `bend` of their states being what they are bent by now.
    std::vector<PlacedPiece> close(std::span<const int> sections,
                                   std::span<const PlacedPiece> bodies) {
        for (const int i : sections) section(i).open = false;
        std::vector<PlacedPiece> placed = rearrange(bodies);
        if (whole()) redundant_.become(member_, pieces_.front());
        return placed;
    }

  private:
    [[nodiscard]] static bool is_touched_beside(std::span<const MemberLoad> loads, int segment) {
        return std::any_of(loads.begin(), loads.end(), [segment](const MemberLoad& load) {
            return std::abs(load.segment - segment) > 1 && norm(load.impulse) > 0;
        });
    }
    /// That a wave takes along it: what pushes for less is no load of all of a section [s]. Steps
    /// that have no blows are these too.
    [[nodiscard]] double wave_time() const noexcept {
        return member_.length() *
               std::sqrt(member_.mass_per_length() / member_.all_axes()->stiffness[2]);
    }
    /// Of a piece, whose forces in a step of `dt` [s] were just found, but for `blur` [N s];
    /// whether it bears more than it can beside bending about its x.
    [[nodiscard]] bool find_unmodelled(double blur, double dt) noexcept {
        constexpr double noticed = 1e-3, loads = 0.01; // of what acted, of the strength
        const double strength = least_strength_ * dt;
        const double left = std::max(norm(forces_.left_over_force) * member_.length(),
                                     norm(forces_.left_over_moment));
        if (forces_.left_over() > noticed && left > loads * strength + blur * member_.length()) {
            unmodelled_ = Unmodelled::forces;
        }
        return std::any_of(
            forces_.sections.begin(), forces_.sections.end(),
            [&](const SectionForce& carried) { return utilisation_beside(member_, carried) > dt; });
    }
    void find_locked(std::span<const MemberLoad> loads) noexcept {
        locked_ = {member_.clamped() ? 0 : member_.segments(), no_section};
        for (const MemberLoad& load : loads) {
            if (load.support == nullptr || !load.bears[1]) continue;
            locked_.first = std::min(locked_.first, load.segment);
            locked_.last = std::max(locked_.last, load.segment - 1);
        }
    }
    /// Of a whole member, whose forces were just found.
    [[nodiscard]] bool is_borne(std::span<const PieceStep> steps, std::span<const MemberLoad> loads,
                                double dt) {
        closed_dt_ = dt;
        find_supports(steps, loads, dt);
        if (closed_supports_.empty()) return false;
        closed_forces_ = forces_;
        return redundant_.bear(member_, state_, forces_, closed_supports_, dt, rule_);
    }
    /// Of a blow, whose forces of a piece were just found.
    [[nodiscard]] const InternalForces& elastic_forces(std::span<const PieceStep> steps,
                                                       std::span<const MemberLoad> loads) {
        if (!whole() || !(member_.bending_stiffness() < std::numeric_limits<double>::infinity())) {
            return forces_;
        }
        find_supports(steps, loads, 1);
        closed_forces_ = forces_;
        redundant_.relax(member_, closed_forces_);
        return closed_forces_;
    }
    /// Of the whole member; what those that are new bear by their kind.
    void find_supports(std::span<const PieceStep> steps, std::span<const MemberLoad> loads,
                       double dt) {
        list_supports(member_, pieces_, steps, loads, dt, closed_supports_);
        if (redundant_.knows(closed_supports_)) return;
        redundant_.learn(closed_supports_);
        redundant_.become(member_, pieces_.front());
    }
    /// Whether what supports carry now, that it is open, shows that the whole member would hold.
    [[nodiscard]] bool is_proved() {
        if (supports_.empty()) return false;
        redundant_.learn(supports_);
        redundant_.become(member_, make_piece(member_, state_, {0, member_.segments() - 1}));
        return redundant_.bear(member_, state_, closed_forces_, closed_supports_, closed_dt_,
                               rule_);
    }
    [[nodiscard]] double all_work() const noexcept {
        double sum = 0;
        for (const SectionState& section : state_) sum += section.joint.plastic_work;
        return sum;
    }
    /// Of a blow of `energy` [J] that loads it to N.
    void expect_vibration(double energy, double n) noexcept {
        const double share = 1 / (n * n);
        // what is left of the one before it fills already, whoever strikes
        const bool left = vibration_.ahead > 0;
        vibration_.share = left ? std::max(vibration_.share, share) : share;
        vibration_.ahead = std::max(vibration_.ahead, energy * share);
        vibration_.counted = all_work();
    }
    std::vector<PlacedPiece> rearrange(std::span<const PlacedPiece> bodies) {
        before_ = std::move(pieces_);
        std::vector<PlacedPiece> old(bodies.begin(), bodies.end());
        for (std::size_t i = 0; i < old.size(); ++i) old[i].piece = &before_[i];
        make_pieces();
        return rearranged(member_, state_, old, pieces_);
    }
    void make_pieces() {
        pieces_.clear();
        for (const MemberRun& run : runs(state_)) {
            pieces_.push_back(make_piece(member_, state_, run));
        }
        least_strength_ = unmissed_work_ = std::numeric_limits<double>::infinity();
        closed_work_ = closed_travel_ = 0;
        for (int i = 0; i < member_.sections(); ++i) {
            const UsualAxisJoint& as_new = member_.section(i);
            const double strength = std::min(as_new.strength(1), as_new.strength(-1));
            unmissed_work_ = std::min(unmissed_work_, strength * as_new.parameters().least_travel);
            if (section(i).open) continue;
            closed_work_ += section(i).joint.plastic_work;
            closed_travel_ += section(i).joint.plastic_travel;
            UsualAxisJoint joint = as_new;
            joint.restore(section(i).joint);
            least_strength_ = std::min({least_strength_, joint.strength(1), joint.strength(-1)});
        }
    }

    Member member_;
    ActiveSections rule_;
    MemberState state_;
    std::vector<MemberPiece> pieces_, before_;
    std::vector<int> found_;
    InternalForces forces_;
    double least_strength_ = 0, unmissed_work_ = 0, left_over_ = 0;
    double closed_work_ = 0, closed_travel_ = 0;
    MemberVibration vibration_;
    RedundantForces redundant_;
    MemberRun locked_{0, no_section};                       ///< sections
    bool is_opened_ = false;                                ///< the whole member, by the step
    InternalForces closed_forces_;                          ///< of that, solved when it was whole
    std::vector<MemberSupport> closed_supports_, supports_; ///< then, and as it stands
    double closed_dt_ = 0;
    double noticed_ = 0;
    double beside_for_ = 0; ///< steps in a row in which it bore more than it can beside bending [s]
    Unmodelled unmodelled_ = Unmodelled::nothing;
    bool has_blows_ = false; ///< beside steps: these are parts of frames
    bool struck_ = false;    ///< this blow was looked at
    bool rough_ = false;     ///< what flows of it is known roughly
    bool yields_ = false;    ///< it does, as a rigid-plastic member then
};

} // namespace ductile
