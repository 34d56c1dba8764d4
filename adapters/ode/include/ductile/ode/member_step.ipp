// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp: what acted on it in a step, and how its pieces went through it. A part of
// member.ipp.
#pragma once

#include <cmath>

namespace ductile::ode {

DUCTILE_INLINE void Member::add_force(int segment, const Vector3<double>& force,
                                      const Vector3<double>& at) {
    const dBodyID body = body_of(segment);
    if (can_move(body)) ode::add_force(body, force, cross(arm_of(body, at), force));
}

DUCTILE_INLINE void Member::before_solve(std::vector<dJointID>& joints) {
    course_.begin_step();
    for (const Hold& hold : holds_) joints.push_back(hold.joint);
    before_.clear();
    for (const MemberBody& piece : pieces_) before_.emplace_back(piece.body);
}
DUCTILE_INLINE void Member::after_solve() {
    if (description().clamped()) dBodyDisable(user_); // ODE wakes what was touched
    for (Hold& hold : holds_) {
        if (hold.acts()) hold.support = detail::support_by(hold.other());
        (void)hold.see();
    }
    for (std::size_t i = 0; i < before_.size() && i < pieces_.size(); ++i) {
        before_[i].see(pieces_[i].body);
    }
}

// ---- after it

/// Of joints and contacts that acted on it [N s].
DUCTILE_INLINE double Member::sum_of_impulses(double dt, std::span<const Touch> touches) const {
    const double length = description().length();
    double all = 0;
    const auto add = [&](const Wrench& wrench) {
        all += dt * (norm(wrench.force) + norm(wrench.torque) / length);
    };
    for (const Touch& touch : touches) {
        all += dt * norm(wrench_of(*touch.feedback, touch.of_a).force);
    }
    for (const PressedTouches::Pressed& asleep : pressed_.asleep()) all += dt * norm(asleep.force);
    for (const Hold& hold : holds_) {
        if (hold.acts()) add(hold.wrench);
    }
    for (const OpenSection& open : joints_) {
        for (const bool of_upper : {true, false}) add(wrench_of(*open.hinge, of_upper));
    }
    for (const Force& force : forces_) all += dt * norm(force.force);
    return all;
}

/// Whatever the arms of what acted on it: those of impulses and of the masses that they move.
DUCTILE_INLINE double Member::share_by(double dt, std::span<const Touch> touches) const {
    constexpr double arms = 4; // of its length
    const double length = description().length();
    bool solved = description().clamped();
    double all = 0, moved = 0; // by whatever
    dVector3 down;
    dWorldGetGravity(dBodyGetWorld(user_), down);
    const Vector3<double> fallen = scaled(dt, to_core(down));
    if (solved) all += description().mass() * norm(fallen);
    for (std::size_t i = 0; i < before_.size(); ++i) {
        if (!before_[i].solved) continue;
        solved = true;
        const Vector3<double>& spin = before_[i].motion.spin;
        all += course_.pieces()[i].mass * dot(spin, spin) * length * dt;
        const Vector3<double> change =
            difference(linear_velocity(pieces_[i].body), before_[i].motion.velocity);
        moved += course_.pieces()[i].mass * norm(difference(change, fallen));
    }
    if (!solved) return 0;
    all += std::max(moved, sum_of_impulses(dt, touches));
    return arms * all * length / (course_.least_strength() * dt);
}

DUCTILE_INLINE void Member::add_load(const Wrench& wrench, int segment, double dt) {
    // about the body's centre, which is the origin of its frame
    const Vector3<double>& centre = before_[course_.piece_of(segment)].pose.origin;
    loads_.push_back({segment, centre, scaled(dt, wrench.force), scaled(dt, wrench.torque)});
}

DUCTILE_INLINE void Member::read(double dt, std::span<Touch> touches) {
    read_steps(dt);
    loads_.clear();
    for (Touch& touch : touches) {
        const dBodyID body = touch.of_a ? touch.bodies.a : touch.bodies.b;
        const auto piece = std::size_t(&piece_on(body) - pieces_.data());
        touch.segment = nearest_segment(description(), course_.pieces()[piece], steps_[piece].pose,
                                        touch.point);
        add_load(wrench_of(*touch.feedback, touch.of_a), touch.segment, dt);
    }
    for (const PressedTouches::Pressed& asleep : pressed_.asleep()) {
        const auto piece = std::size_t(&piece_on(user_) - pieces_.data());
        const int segment = nearest_segment(description(), course_.pieces()[piece],
                                            steps_[piece].pose, asleep.point);
        loads_.push_back({segment, asleep.point, scaled(dt, asleep.force)});
    }
    for (const Hold& hold : holds_) {
        if (!hold.acts()) continue;
        add_load(hold.wrench, hold.at.segment, dt);
        if (!hold.support.holds) continue;
        loads_.back().support = hold.joint;
        loads_.back().held_at = hold.at.in_segment;
        constexpr double round_off = 1e-6;
        const std::size_t piece = course_.piece_of(hold.at.segment);
        const JointFrame<double> at =
            placed(steps_[piece].pose, course_.pieces()[piece].segment(hold.at.segment));
        const auto bears = [&](int axis) {
            return std::abs(dot(column(at.axes, axis), hold.support.rail)) < round_off;
        };
        // a hinge may turn, or has stops
        loads_.back().bears = {bears(1), bears(2), dJointGetType(hold.joint) == dJointTypeFixed};
    }
    for (const OpenSection& open : joints_) {
        if (!open.hinge->is_awake_member()) continue;
        add_load(wrench_of(*open.hinge, true), open.section + 1, dt);
        // one that is held on the static world says nothing of that
        if (pieces_[course_.piece_of(open.section)].own) {
            add_load(wrench_of(*open.hinge, false), open.section, dt);
        } else {
            const MemberLoad upper = loads_.back();
            loads_.push_back(
                {open.section, upper.point, scaled(-1, upper.impulse), scaled(-1, upper.moment)});
        }
    }
    for (const Force& force : forces_) {
        loads_.push_back(load(force, steps_[course_.piece_of(force.at.segment)].pose, dt));
    }
}

/// How its pieces went through the step.
DUCTILE_INLINE void Member::read_steps(double dt) {
    dVector3 world_gravity;
    dWorldGetGravity(dBodyGetWorld(user_), world_gravity);
    const Vector3<double> fallen = scaled(dt, to_core(world_gravity));
    steps_.resize(pieces_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const PieceCourse& before = before_[i];
        const MemberPiece& piece = course_.pieces()[i];
        PieceStep& step = steps_[i] = {};
        step.pose = placed(before.pose, in_body(i));
        if (piece.held) {
            step.change.velocity = scaled(-1, fallen);
            continue;
        }
        if (!before.solved) continue;
        step.change = before.change(pieces_[i].body, fallen, piece.inertia_in_world(step.pose.axes),
                                    piece.inverse_inertia_in_world(step.pose.axes), dt, step.dt);
        step.spin = before.motion.spin;
    }
}

DUCTILE_INLINE void Member::find_beyond(double dt, std::span<Touch> touches,
                                        std::vector<int>& sections) {
    if (description().clamped() && whole()) {
        pressed_.see(touches);
    } else {
        pressed_.forget();
    }
    share_ = share_by(dt, touches);
    if (!(share_ > 1)) return;
    read(dt, touches);
    sections = course_.beyond(steps_, loads_, dt);
}

DUCTILE_INLINE void Member::find_struck(double dt, std::span<Touch> touches,
                                        std::vector<int>& sections) {
    if (touches.empty() && holds_.empty()) return;
    read(dt, touches);
    MemberStrike strike;
    for (const Touch& touch : touches) {
        const double pressed = dt * dot(touch.normal, to_core(touch.feedback->f1));
        strike.add(pressed * (touch.closing + touch.closing_speed()) / 2, touch.closing,
                   touch.segment);
    }
    look_blow(dt, strike, sections);
}

} // namespace ductile::ode
