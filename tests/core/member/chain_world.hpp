// SPDX-License-Identifier: MIT
//
// A world of one member without an engine: its pieces, its open sections, and a mass that is fixed
// to its end. Symplectic Euler steps, solved at once.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "ductile/joint/link.hpp"
#include "ductile/member/active_sections.hpp"
#include "ductile/solve/island_solver.hpp"
#include "ductile/world/island_joint.hpp"

namespace ductile::test {

struct Striker {
    double mass = 0;
    Vector3<double> velocity = Vector3<double>::Zero();
    int segment = 0; ///< at whose end it is fixed
};

class ChainWorld {
  public:
    enum class Sections { always_open, just_in_time };
    ChainWorld(const Member& member, Sections sections, const Striker& striker = {},
               const Vector3<double>& gravity = Vector3<double>::Zero())
        : member_(member),
          sections_(sections),
          gravity_(gravity),
          striker_mass_(striker.mass),
          striker_segment_(striker.segment),
          state_(straight(member)) {
        for (SectionState& section : state_) section.open = sections == Sections::always_open;
        MemberState whole = straight(member);
        const MemberPiece piece = make_piece(member, whole, {0, member.segments() - 1});
        const PlacedPiece start{
            &piece, frame_around({}, placed(piece.section(member, 0, false), {})), {}};
        rebuild({start});
        if (striker.mass > 0) {
            striker_.velocity = striker.velocity;
            striker_.position = end_of(striker.segment);
        }
    }

    void step(double dt);

    [[nodiscard]] const MemberState& state() const { return state_; }
    [[nodiscard]] double plastic_work() const {
        double work = 0;
        for (const SectionState& section : state_) work += section.joint.plastic_work;
        return work;
    }
    /// How far a section is bent now.
    [[nodiscard]] double bend(int section) const {
        const SectionState& of = state_[std::size_t(section)];
        if (!of.open) return of.bend;
        return link(section).position(JointAxis::bending_x);
    }
    [[nodiscard]] int open() const {
        int count = 0;
        for (const SectionState& section : state_) count += section.open;
        return count;
    }
    [[nodiscard]] Vector3<double> end_of(int segment) const {
        const Body& body = body_of(segment);
        return placed(body.pose, body.piece->section(member_, segment, true)).origin;
    }
    void strike(const Vector3<double>& velocity) { striker_.velocity = velocity; }
    void push(const Vector3<double>& impulse) { push_ = impulse; } ///< at the member's end
    [[nodiscard]] Vector3<double> striker_velocity() const { return striker_.velocity; }
    [[nodiscard]] double kinetic_energy() const;
    [[nodiscard]] Vector6<double> momentum() const; ///< about the origin
    [[nodiscard]] int changes() const { return changes_; }
    [[nodiscard]] double left_over() const { return left_over_; } ///< largest of all accepted steps
    [[nodiscard]] bool solved() const { return solved_; }

  private:
    struct Body {
        std::unique_ptr<MemberPiece> piece;
        JointFrame<double> pose;
        BodyMotion motion;
        int number = solve::immovable;
    };
    struct Joint {
        int section;
        std::unique_ptr<Link<UsualAxisJoint>> link;
        int first = 0;
    };

    [[nodiscard]] const Body& body_of(int segment) const {
        for (const Body& body : bodies_) {
            if (body.piece->run.holds(segment)) return body;
        }
        return bodies_.front();
    }
    [[nodiscard]] const Link<UsualAxisJoint>& link(int section) const {
        for (const Joint& joint : joints_) {
            if (joint.section == section) return *joint.link;
        }
        throw std::logic_error("closed");
    }
    [[nodiscard]] static BodyState<double> seen(const Body& body) {
        return {.position = body.pose.origin,
                .orientation = body.pose.axes,
                .velocity = body.motion.velocity,
                .spin = body.motion.spin,
                .inverse_mass = body.piece->held ? 0 : 1 / body.piece->mass,
                .inverse_inertia = body.piece->inverse_inertia_in_world(body.pose.axes)};
    }
    /// Rate of the spin of a body that nothing acts on.
    [[nodiscard]] static Vector3<double> gyroscopic(const Body& body) {
        const Vector3<double> about =
            times(body.piece->inertia_in_world(body.pose.axes), body.motion.spin);
        return times(body.piece->inverse_inertia_in_world(body.pose.axes),
                     cross(about, body.motion.spin));
    }
    void rebuild(const std::vector<PlacedPiece>& old);
    void solve(double dt);
    [[nodiscard]] bool open_beyond(double dt);
    void open(int section);
    void move(double dt);

    const Member& member_;
    Sections sections_;
    Vector3<double> gravity_;
    double striker_mass_;
    int striker_segment_;
    MemberState state_;
    std::vector<Body> bodies_;
    std::vector<Joint> joints_;
    BodyState<double> striker_;
    Vector3<double> push_ = Vector3<double>::Zero();
    int changes_ = 0;
    double left_over_ = 0;
    bool solved_ = true;
    solve::Island island_;
    solve::IslandSolver solver_;
    InternalForces forces_;
};

/// Bodies of the runs of `state_` from those of before, and joints between them.
inline void ChainWorld::rebuild(const std::vector<PlacedPiece>& old) {
    std::vector<MemberPiece> pieces;
    for (const MemberRun& run : runs(state_)) pieces.push_back(make_piece(member_, state_, run));
    std::vector<Body> bodies;
    for (const PlacedPiece& placed_piece : rearranged(member_, state_, old, pieces)) {
        bodies.push_back({std::make_unique<MemberPiece>(*placed_piece.piece), placed_piece.pose,
                          placed_piece.motion, solve::immovable});
    }
    bodies_ = std::move(bodies);
    joints_.clear();
    for (std::size_t i = 0; i + 1 < bodies_.size(); ++i) {
        const int section = bodies_[i].piece->run.last;
        const MemberPiece &lower = *bodies_[i].piece, &upper = *bodies_[i + 1].piece;
        Joint joint{
            section,
            std::make_unique<Link<UsualAxisJoint>>(
                member_.section(section), std::array{JointAxis::bending_x},
                upper.section(member_, section + 1, false), lower.section(member_, section, true)),
            0};
        joint.link->start(seen(bodies_[i + 1]), seen(bodies_[i]));
        const double bend = joint.link->position(JointAxis::bending_x);
        auto state = joint.link->state();
        const SectionState& kept = state_[std::size_t(section)];
        state.joint = kept.joint;
        state.joint.plastic_offset = bend;
        joint.link->restore(state);
        joints_.push_back(std::move(joint));
    }
}

inline void ChainWorld::solve(double dt) {
    island_.clear();
    const auto seat = [&](const Body& body) {
        IslandSeat of{body.number, body.motion.velocity, body.motion.spin};
        if (body.number < 0) return of;
        of.velocity = sum(of.velocity, scaled(dt, gravity_));
        of.spin = sum(of.spin, scaled(dt, gyroscopic(body)));
        return of;
    };
    for (Body& body : bodies_) {
        body.number = body.piece->held ? solve::immovable : int(island_.bodies.size());
        if (body.piece->held) continue;
        const double inverse = 1 / body.piece->mass;
        island_.bodies.push_back(solve::island_body(
            {inverse, inverse, inverse}, body.piece->inverse_inertia_in_world(body.pose.axes)));
    }
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        Joint& joint = joints_[i];
        const Body &lower = bodies_[i], &upper = bodies_[i + 1];
        joint.link->prepare(seen(upper), seen(lower), dt, 0.2 / dt);
        joint.first = add_rows(island_, *joint.link, seat(upper), seat(lower), dt);
    }
    if (striker_mass_ > 0) {
        const int number = int(island_.bodies.size());
        const double inverse = 1 / striker_mass_;
        island_.bodies.push_back(
            solve::island_body({inverse, inverse, inverse}, Matrix3<double>::Identity()));
        const Body& body = body_of(striker_segment_);
        const Vector3<double> none = Vector3<double>::Zero(), at = end_of(striker_segment_);
        for (int i = 0; i < 3; ++i) {
            Vector3<double> along = none;
            along[i] = 1;
            const double off = at[i] - striker_.position[i];
            add_row(island_, {number, striker_.velocity, none}, seat(body), none,
                    difference(at, body.pose.origin), along, 0.2 * off / dt);
        }
    }
    if (!is_zero(push_)) {
        const Body& body = body_of(member_.segments() - 1);
        const Vector3<double> none = Vector3<double>::Zero();
        for (int i = 0; i < 3; ++i) {
            Vector3<double> along = none;
            along[i] = 1;
            solve::IslandRow& row = add_row(
                island_, seat(body), {},
                difference(end_of(member_.segments() - 1), body.pose.origin), none, along, 0);
            row.lower = row.upper = push_[i];
            row.side = solve::Side::lower;
        }
    }
    solved_ = solver_.solve(island_).solved && solved_;
}

inline bool ChainWorld::open_beyond(double dt) {
    std::vector<MemberLoad> loads;
    const std::size_t own = 6 * joints_.size();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        const Link<UsualAxisJoint>& link = *joints_[i].link;
        for (int r = 0; r < 6; ++r) {
            const double impulse = island_.rows[std::size_t(joints_[i].first + r)].impulse;
            MemberLoad load{.segment = joints_[i].section + 1, .point = link.point()};
            (r < 3 ? load.impulse : load.moment) =
                scaled(impulse, column(link.pose().axes(), r % 3));
            loads.push_back(load);
            load.segment = joints_[i].section;
            load.impulse = scaled(-1, load.impulse);
            load.moment = scaled(-1, load.moment);
            loads.push_back(load);
        }
    }
    if (striker_mass_ > 0) {
        MemberLoad load{.segment = striker_segment_, .point = end_of(striker_segment_)};
        for (std::size_t i = 0; i < 3; ++i) load.impulse[int(i)] = -island_.rows[own + i].impulse;
        loads.push_back(load);
    }
    const int end = member_.segments() - 1;
    loads.push_back({.segment = end, .point = end_of(end), .impulse = push_});
    std::vector<int> opened;
    double left_over = 0;
    for (const Body& body : bodies_) {
        PieceStep step{.pose = body.pose, .change = {}, .spin = body.motion.spin, .dt = dt};
        if (body.number >= 0) {
            const Vector6<double>& change = island_.bodies[std::size_t(body.number)].velocity;
            step.change = {linear(change), sum(angular(change), scaled(dt, gyroscopic(body)))};
        } else {
            step.change.velocity = scaled(-dt, gravity_);
        }
        internal_forces(member_, *body.piece, step, loads, forces_);
        left_over = std::max(left_over, forces_.left_over());
        const int worst = worst_section(member_, state_, forces_, dt);
        if (worst != no_section) opened.push_back(worst);
    }
    for (const int section : opened) open(section);
    if (opened.empty()) left_over_ = std::max(left_over_, left_over);
    return !opened.empty();
}

inline void ChainWorld::open(int section) {
    ++changes_;
    std::vector<PlacedPiece> old;
    for (const Body& body : bodies_) old.push_back({body.piece.get(), body.pose, body.motion});
    for (const Joint& joint : joints_) {
        state_[std::size_t(joint.section)].joint = joint.link->joint().state();
    }
    state_[std::size_t(section)].open = true;
    state_[std::size_t(section)].held = 0;
    rebuild(old);
}

inline void ChainWorld::move(double dt) {
    for (Body& body : bodies_) {
        if (body.number < 0) continue;
        const Vector6<double>& change = island_.bodies[std::size_t(body.number)].velocity;
        body.motion.velocity = sum(body.motion.velocity, sum(linear(change), scaled(dt, gravity_)));
        body.motion.spin =
            sum(body.motion.spin, sum(angular(change), scaled(dt, gyroscopic(body))));
        body.pose.origin = sum(body.pose.origin, scaled(dt, body.motion.velocity));
        body.pose.axes = turned_by<double>(scaled(dt, body.motion.spin), body.pose.axes);
    }
    if (striker_mass_ > 0) {
        striker_.velocity = sum(striker_.velocity, linear(island_.bodies.back().velocity));
        striker_.position = sum(striker_.position, scaled(dt, striker_.velocity));
    }
}

inline void ChainWorld::step(double dt) {
    do {
        solve(dt);
    } while (sections_ == Sections::just_in_time && open_beyond(dt));
    move(dt);
    bool changed = false;
    std::vector<PlacedPiece> old;
    for (const Body& body : bodies_) old.push_back({body.piece.get(), body.pose, body.motion});
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        Joint& joint = joints_[i];
        joint.link->commit_rows(seen(bodies_[i + 1]), seen(bodies_[i]),
                                take_forces(island_, *joint.link, joint.first, dt), dt);
        SectionState& section = state_[std::size_t(joint.section)];
        section.joint = joint.link->joint().state();
        if (sections_ == Sections::always_open || !closes(section)) continue;
        section.bend = joint.link->position(JointAxis::bending_x);
        section.open = false;
        changed = true;
    }
    if (!changed) return;
    ++changes_;
    // pieces as they were, bent as they are now
    rebuild(old);
}

inline double ChainWorld::kinetic_energy() const {
    double twice = striker_mass_ * dot(striker_.velocity, striker_.velocity);
    for (const Body& body : bodies_) {
        twice += body.piece->mass * dot(body.motion.velocity, body.motion.velocity) +
                 dot(body.motion.spin,
                     times(body.piece->inertia_in_world(body.pose.axes), body.motion.spin));
    }
    return twice / 2;
}

inline Vector6<double> ChainWorld::momentum() const {
    const Vector3<double> p = scaled(striker_mass_, striker_.velocity);
    Vector6<double> all = twist_of(p, cross(striker_.position, p));
    for (const Body& body : bodies_) {
        const Vector3<double> of = scaled(body.piece->mass, body.motion.velocity);
        all += twist_of(of,
                        sum(cross(body.pose.origin, of),
                            times(body.piece->inertia_in_world(body.pose.axes), body.motion.spin)));
    }
    return all;
}

} // namespace ductile::test
