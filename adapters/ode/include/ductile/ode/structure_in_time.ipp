// SPDX-License-Identifier: MIT
//
// Bodies of structure_in_time.hpp.
#pragma once

#include <stdexcept>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/structure_in_time.hpp"

namespace ductile::ode {

DUCTILE_INLINE StructureInTime::StructureInTime(World& world, dSpaceID space,
                                                const StructureModel& model)
    : DividedStructure(model), world_(world), gravity_(gravity_of(world.id())) {
    for (const PlanBody& body : plan().bodies) boxes_.push_back(detail::box_of(body, space));
    for (std::size_t c = 0; c < course_.clusters().size(); ++c) {
        bodies_.push_back(make_cluster(c, nullptr));
    }
    made();
    try {
        world_.add(*this);
    } catch (...) {
        for (dBodyID body : bodies_) end_body(body);
        for (dGeomID box : boxes_) {
            if (box != nullptr) dGeomDestroy(box);
        }
        throw;
    }
}

DUCTILE_INLINE StructureInTime::~StructureInTime() {
    if (!left_) world_.remove(static_cast<Divisible&>(*this));
    joints_.clear();
    for (dBodyID body : bodies_) end_body(body);
    for (dGeomID box : boxes_) {
        if (box != nullptr) dGeomDestroy(box);
    }
}

DUCTILE_INLINE std::vector<dBodyID> StructureInTime::bodies() const { return bodies_; }
DUCTILE_INLINE dBodyID StructureInTime::body_of(std::string_view member, std::size_t piece) const {
    return bodies_[course_.cluster_of(present_body(plan().body(member, piece)))];
}

// ---- its bodies

/// The frame of one that is held is the world's.
DUCTILE_INLINE dBodyID StructureInTime::make_cluster(std::size_t c, dBodyID like) {
    const Cluster& cluster = course_.clusters()[c];
    const PlacedBody& at = course_.made_at()[c];
    const dBodyID body = dBodyCreate(world_.id());
    if (like != nullptr) detail::copy_manners(like, body);
    detail::put(body, at.pose, at.motion);
    if (cluster.held) {
        dBodySetKinematic(body);
        dBodyDisable(body);
    } else {
        detail::set_mass(body, cluster.mass, cluster.inertia);
        dBodySetFiniteRotationMode(body, 1);
    }
    for (std::size_t i = 0; i < cluster.bodies.size(); ++i) {
        const std::size_t b = cluster.bodies[i];
        if (boxes_[b] == nullptr) continue;
        detail::put_on(boxes_[b], body, placed(cluster.places[i], plan().bodies[b].box));
    }
    world_.add(body);
    return body;
}

DUCTILE_INLINE void StructureInTime::end_body(dBodyID body) {
    world_.remove(body);
    dBodyDestroy(body);
}

DUCTILE_INLINE void StructureInTime::become(const StructureCourse::Change& change, bool ahead) {
    proved_.reset();
    pressed_.forget();
    end_joints(change); // before their bodies do
    std::vector<dBodyID> old = std::exchange(bodies_, {});
    const dBodyID like = old.empty() ? nullptr : old.front();
    for (std::size_t c = 0; c < change.kept.size(); ++c) {
        bodies_.push_back(change.kept[c] ? std::exchange(old[*change.kept[c]], nullptr)
                                         : make_cluster(c, like));
    }
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
        if (course_.has_body(b) || boxes_[b] == nullptr) continue;
        dGeomDestroy(boxes_[b]);
        boxes_[b] = nullptr;
    }
    hand_over();
    for (dBodyID body : old) {
        if (body != nullptr) end_body(body);
    }
    make_joints(
        [this](std::size_t j, std::size_t a, const JointFrame<double>& in_a,
               std::optional<std::size_t> b, const JointFrame<double>& in_b) {
            // one that is held has the world's frame
            const dBodyID other = b && !held(*b) ? bodies_[*b] : nullptr;
            return OpenJoint{j, std::make_unique<Joint>(world_.id(), bodies_[a], other, in_a, in_b,
                                                        plan().joints[j].joint)};
        },
        [this, ahead](OpenJoint& open) {
            world_.take_in(*open.constraint);
            if (ahead) (void)open.constraint->begin_frame();
        });
}

/// Pieces that hang together do, and those that meet at a node; where a joint broke they meet.
DUCTILE_INLINE bool StructureInTime::hangs_together(dBodyID a, dBodyID b) const {
    const auto between = [&](std::size_t first, std::size_t second) {
        const dBodyID one = bodies_[course_.cluster_of(first)],
                      other = bodies_[course_.cluster_of(second)];
        return (one == a && other == b) || (one == b && other == a);
    };
    for (const auto& [first, second] : plan().neighbours) {
        if (has_body(first) && has_body(second) && between(first, second)) return true;
    }
    return std::any_of(joints_.begin(), joints_.end(), [&](const OpenJoint& open) {
        const PlanJoint& joint = plan().joints[open.joint];
        return !stands_on_ground(open.joint) && !open.constraint->broken() &&
               between(joint.a, joint.b.index);
    });
}

// ---- what holds on to it

DUCTILE_INLINE void StructureInTime::attach(const Point& point, dJointID joint) {
    const StructureHold hold = hold_at(point);
    if (joint == nullptr) {
        throw std::invalid_argument("StructureInTime.attach.joint = null: must be a joint");
    }
    std::erase_if(told_, [joint](const auto& told) { return told.first == joint; });
    std::erase_if(holds_, [joint](const Hold& known) { return known.joint == joint; });
    told_.emplace_back(joint, hold);
}

/// Of a joint that is new, on the body of a cluster.
DUCTILE_INLINE StructureHold StructureInTime::hold_of(dJointID joint, std::size_t c) const {
    const auto anchor = anchor_of(joint, bodies_[c], "StructureInTime.attach.joint");
    for (const auto& [told, hold] : told_) {
        if (told != joint) continue;
        if (course_.has_body(hold.body) && course_.cluster_of(hold.body) == c) return hold;
        throw std::invalid_argument(
            "StructureInTime.attach.joint: must be on the body that has the place where it holds");
    }
    if (!anchor) {
        throw std::invalid_argument(
            "StructureInTime.attach.joint: a fixed joint of its body must be told where it holds");
    }
    return hold_near(c, *anchor);
}

/// It holds where it did.
DUCTILE_INLINE bool StructureInTime::is_there(const Hold& hold) const {
    constexpr double drift = 1e-3; // more than of a joint that is solved [m]
    const bool told = std::any_of(told_.begin(), told_.end(),
                                  [&](const auto& each) { return each.first == hold.joint; });
    if (told) return true;
    const auto anchor = anchor_of(hold.joint, hold.body, "StructureInTime.attach.joint");
    return anchor && norm(difference(*anchor, point_of(hold.at))) < drift;
}

DUCTILE_INLINE void StructureInTime::find_holds() {
    std::vector<Hold> found;
    for (std::size_t c = 0; c < bodies_.size(); ++c) {
        for (int i = 0, count = dBodyGetNumJoints(bodies_[c]); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(bodies_[c], i);
            const bool own = std::any_of(
                joints_.begin(), joints_.end(),
                [joint](const OpenJoint& open) { return open.constraint->id() == joint; });
            if (own || dJointGetType(joint) == dJointTypeContact) continue;
            const bool acts = dJointIsEnabled(joint) != 0;
            const auto known = std::find_if(holds_.begin(), holds_.end(), [&](const Hold& hold) {
                return hold.joint == joint && hold.body == bodies_[c] && is_there(hold);
            });
            found.push_back(known != holds_.end()
                                ? *known
                                : Hold{{joint, bodies_[c], acts}, hold_of(joint, c)});
            found.back().acts = acts;
            if (cluster_on(found.back().other()) == bodies_.size()) continue;
            throw std::invalid_argument(
                "StructureInTime.attach.joint: must hold another body, not two of the structure's");
        }
    }
    holds_ = std::move(found);
}

/// To the bodies that there are now.
DUCTILE_INLINE void StructureInTime::hand_over() {
    std::erase_if(holds_, [this](const Hold& hold) {
        if (course_.has_body(hold.at.body)) return false;
        dJointAttach(hold.joint, nullptr, nullptr);
        return true;
    });
    for (Hold& hold : holds_) {
        hold.go_to(bodies_[course_.cluster_of(hold.at.body)]);
        ode::wake(hold.joint);
    }
}

/// While it is whole the user's collisions leave out what a joint holds to its body; so do then all
/// bodies that hang together with it.
DUCTILE_INLINE bool StructureInTime::holds(dBodyID own, dBodyID other) const {
    return std::any_of(holds_.begin(), holds_.end(), [&](const Hold& hold) {
        return hold.acts && hold.other() == other &&
               hanging_on(course_.cluster_of(hold.at.body))[cluster_on(own)];
    });
}

DUCTILE_INLINE bool StructureInTime::switch_holds(bool on) {
    bool any = false;
    for (const Hold& hold : holds_) any = hold.switch_on(on) || any;
    return any;
}
DUCTILE_INLINE void StructureInTime::see_coming() {
    for (Hold& hold : holds_) hold.see_coming();
}

DUCTILE_INLINE void StructureInTime::wake() {
    proved_.reset();
    for (std::size_t c = 0; c < bodies_.size(); ++c) wake_cluster(c);
}

DUCTILE_INLINE void StructureInTime::set_gravity(double factor) {
    dWorldSetGravity(world_.id(), dReal(factor * gravity_.x()), dReal(factor * gravity_.y()),
                     dReal(factor * gravity_.z()));
}

// ---- a step

DUCTILE_INLINE void StructureInTime::require_possible() {
    find_holds();
    for (std::size_t c = 0; c < bodies_.size(); ++c) {
        if (held(c)) continue;
        dMass mass;
        dBodyGetMass(bodies_[c], &mass);
        require_body(course_.clusters()[c].mass, double(mass.mass),
                     dBodyIsKinematic(bodies_[c]) != 0);
    }
}
DUCTILE_INLINE void StructureInTime::apply_forces() {
    add_forces([this](std::size_t c, const Vector3<double>& force, const Vector3<double>& at) {
        add_force(bodies_[c], force, cross(arm_of(bodies_[c], at), force));
    });
}

DUCTILE_INLINE void StructureInTime::before_solve(std::vector<dJointID>& joints) {
    course_.begin_step();
    driven_through_ = false;
    for (const Hold& hold : holds_) joints.push_back(hold.joint);
    courses_.clear();
    for (dBodyID body : bodies_) courses_.emplace_back(body);
}
DUCTILE_INLINE void StructureInTime::after_solve() {
    for (std::size_t c = 0; c < courses_.size() && c < bodies_.size(); ++c) {
        if (held(c)) dBodyDisable(bodies_[c]); // ODE wakes what was touched
        courses_[c].see(bodies_[c]);
    }
    for (Hold& hold : holds_) {
        if (!hold.see()) continue;
        note(hold.at, courses_[cluster_on(hold.body)].pose, hold.wrench.force, hold.wrench.torque);
    }
}

/// Nothing acts on it but what it carried before.
DUCTILE_INLINE bool StructureInTime::rests(std::span<const Touch> touches) const {
    return forces_.empty() &&
           std::none_of(touches.begin(), touches.end(),
                        [](const Touch& touch) {
                            return detail::is_solved(touch.bodies.a) ||
                                   detail::is_solved(touch.bodies.b);
                        }) &&
           std::none_of(holds_.begin(), holds_.end(),
                        [](const Hold& hold) { return hold.acts && hold.is_solved(); });
}
DUCTILE_INLINE bool StructureInTime::may_be_beyond(std::span<const Touch> touches) const {
    if (!proved_ || *proved_ != gravity_of(world_.id()) || !rests(touches) ||
        proved_touches_ != touches.size() + acting_holds()) {
        return true;
    }
    return std::any_of(courses_.begin(), courses_.end(),
                       [](const PieceCourse& course) { return course.solved; });
}

DUCTILE_INLINE void StructureInTime::read(double dt, std::span<Touch> touches) {
    begin_read();
    const Vector3<double> fallen = scaled(dt, gravity_of(world_.id()));
    for (std::size_t c = 0; c < bodies_.size(); ++c) {
        ClusterStep& step = steps_[c];
        if (held(c)) {
            step.change.velocity = scaled(-1, fallen);
            continue;
        }
        const PieceCourse& course = courses_[c];
        step.pose = course.pose;
        if (!course.solved) continue; // what sleeps stays as it is
        const Vector3<double>& inertia = course_.clusters()[c].inertia;
        const Vector3<double> inverse{1 / inertia[0], 1 / inertia[1], 1 / inertia[2]};
        step.change = course.change(bodies_[c], fallen, along_axes(inertia, step.pose.axes),
                                    along_axes(inverse, step.pose.axes), dt, step.dt);
        step.spin = course.motion.spin;
    }
    const auto push = [&](dBodyID body, const Vector3<double>& point,
                          const Vector3<double>& force) {
        const std::size_t c = cluster_on(body);
        const std::size_t on = course_.nearest(c, steps_[c].pose, point);
        loads_.push_back({on, point, scaled(dt, force), Vector3<double>::Zero()});
        return int(on);
    };
    for (Touch& touch : touches) {
        touch.segment = push(touch.of_a ? touch.bodies.a : touch.bodies.b, touch.point,
                             wrench_of(*touch.feedback, touch.of_a).force);
    }
    for (const PressedTouches::Pressed& asleep : pressed_.asleep()) {
        push(asleep.on, asleep.point, asleep.force);
    }
    for (const Hold& hold : holds_) {
        if (hold.acts) add_load(hold.at, dt);
    }
    for (const OpenJoint& open : joints_) {
        if (!open.constraint->is_awake_member()) continue;
        const PlanJoint& joint = plan().joints[open.joint];
        const Wrench upper = wrench_of(*open.constraint, true);
        add_load(joint.a, upper.force, upper.torque, dt);
        if (stands_on_ground(open.joint)) continue;
        // one that is held on the static world says nothing of that
        if (held(course_.cluster_of(joint.b.index))) {
            BodyLoad lower = loads_.back();
            lower.body = joint.b.index;
            lower.impulse = scaled(-1, lower.impulse);
            lower.moment = scaled(-1, lower.moment);
            loads_.push_back(lower);
        } else {
            const Wrench lower = wrench_of(*open.constraint, false);
            add_load(joint.b.index, lower.force, lower.torque, dt);
        }
    }
    read_forces(dt);
}

DUCTILE_INLINE void StructureInTime::find_beyond(double dt, std::span<Touch> touches,
                                                 std::vector<int>& sections) {
    std::vector<Touch> on_held;
    for (const Touch& touch : touches) {
        if (!can_move(touch.of_a ? touch.bodies.a : touch.bodies.b)) on_held.push_back(touch);
    }
    pressed_.see(on_held);
    if (!may_be_beyond(touches)) return;
    read(dt, touches);
    proved_.reset();
    proved_touches_ = touches.size() + acting_holds();
    sections = course_.beyond(steps_, loads_, dt);
    if (sections.empty() && rests(touches) && joints_.empty()) proved_ = gravity_of(world_.id());
}

DUCTILE_INLINE void StructureInTime::find_struck(double dt, std::span<Touch> touches,
                                                 std::vector<int>& sections) {
    proved_.reset();
    if (touches.empty() && holds_.empty()) return;
    read(dt, touches);
    double energy = 0; // that contacts took
    for (const Touch& touch : touches) {
        const double pressed = dt * dot(touch.normal, to_core(touch.feedback->f1));
        energy += pressed * (touch.closing + touch.closing_speed()) / 2;
    }
    MemberStrike by_joints;
    for (const Hold& hold : holds_) {
        if (!hold.acts) continue;
        const Vector3<double> place = point_of(hold.at);
        by_joints.add(hold.side(true, place, dt), hold.side(false, place, dt), 0);
    }
    sections = struck(energy, by_joints);
}

DUCTILE_INLINE void StructureInTime::open(std::span<const int> sections, bool ahead) {
    note_joints();
    become(course_.open(sections, placed_clusters()), ahead);
}

DUCTILE_INLINE std::vector<int> StructureInTime::close_held(Closing when, bool ahead) {
    if (whole() || when == Closing::before_blow) return {};
    note_joints();
    std::vector<int> held = course_.held();
    if (!held.empty()) become(course_.close(held, placed_clusters()), ahead);
    return held;
}

} // namespace ductile::ode
