// SPDX-License-Identifier: MIT
//
// Bodies of structure_in_time.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/structure_in_time.hpp"

namespace ductile::ode {

DUCTILE_INLINE StructureInTime::StructureInTime(World& world, dSpaceID space,
                                                const StructureModel& model)
    : SteppedStructure(model), world_(world), gravity_(gravity_of(world.id())) {
    for (const PlanBody& body : plan().bodies) boxes_.push_back(detail::box_of(body, space));
    make_pieces();
    try {
        world_.add(static_cast<Divisible&>(*this));
    } catch (...) {
        end_pieces();
        end_boxes();
        throw;
    }
}

DUCTILE_INLINE StructureInTime::~StructureInTime() {
    if (!left_) world_.remove(static_cast<Divisible&>(*this));
    joints_.clear();
    end_pieces();
    end_boxes();
}

// ---- its bodies

/// The frame of one that is held is the world's.
DUCTILE_INLINE dBodyID StructureInTime::make_piece(std::size_t c, dBodyID like) {
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

DUCTILE_INLINE void StructureInTime::end_piece(dBodyID& piece) {
    world_.remove(piece);
    dBodyDestroy(piece);
}

/// Of bodies that are no more, or of all where it ends.
DUCTILE_INLINE void StructureInTime::end_boxes() {
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
        if (boxes_[b] == nullptr || (!pieces_.empty() && course_.has_body(b))) continue;
        dGeomDestroy(boxes_[b]);
        boxes_[b] = nullptr;
    }
}

DUCTILE_INLINE OpenJoint StructureInTime::make_joint(std::size_t joint, std::size_t a,
                                                     const JointFrame<double>& in_a,
                                                     std::optional<std::size_t> b,
                                                     const JointFrame<double>& in_b) {
    // one that is held has the world's frame
    return {joint, std::make_unique<PlasticJoint<SectionJoint<double>>>(
                       world_.id(), body(a), b && !held(*b) ? body(*b) : nullptr, in_a, in_b,
                       plan().joints[joint].joint)};
}
DUCTILE_INLINE void StructureInTime::enter_joint(OpenJoint& open, bool ahead) {
    world_.take_in(*open.constraint);
    if (ahead) (void)open.constraint->begin_frame();
}

/// Pieces that hang together do, and those that meet at a node; where a joint broke they meet.
DUCTILE_INLINE bool StructureInTime::hangs_together(dBodyID a, dBodyID b) const {
    bool any = false;
    const auto note = [&](dBodyID one, dBodyID other) {
        any = any || (one == a && other == b) || (one == b && other == a);
    };
    over_neighbours(note);
    for (const OpenJoint& open : joints_) {
        if (stands_on_ground(open.joint) || open.constraint->broken()) continue;
        const PlanJoint& joint = plan().joints[open.joint];
        note(body(course_.cluster_of(joint.a)), body(course_.cluster_of(joint.b.index)));
    }
    return any;
}

// ---- what holds on to it

DUCTILE_INLINE void StructureInTime::hold_on(const StructureHold& at, dJointID joint) {
    if (joint == nullptr) {
        throw std::invalid_argument("StructureInTime.attach.joint = null: must be a joint");
    }
    std::erase_if(told_, [joint](const auto& told) { return told.first == joint; });
    std::erase_if(holds_, [joint](const Hold& known) { return known.joint == joint; });
    told_.emplace_back(joint, at);
}

/// Of a joint that is new, on the body of a cluster.
DUCTILE_INLINE StructureHold StructureInTime::hold_of(dJointID joint, std::size_t c) const {
    const auto anchor = anchor_of(joint, body(c), "StructureInTime.attach.joint");
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
    for (std::size_t c = 0; c < pieces_.size(); ++c) {
        for (int i = 0, count = dBodyGetNumJoints(body(c)); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body(c), i);
            const bool own = std::any_of(
                joints_.begin(), joints_.end(),
                [joint](const OpenJoint& open) { return open.constraint->id() == joint; });
            if (own || dJointGetType(joint) == dJointTypeContact) continue;
            const bool acts = dJointIsEnabled(joint) != 0;
            const auto known = std::find_if(holds_.begin(), holds_.end(), [&](const Hold& hold) {
                return hold.joint == joint && hold.body == body(c) && is_there(hold);
            });
            found.push_back(
                known != holds_.end() ? *known : Hold{{joint, body(c), acts}, hold_of(joint, c)});
            found.back().enabled = acts;
            if (cluster_on(found.back().other()) == pieces_.size()) continue;
            throw std::invalid_argument(
                "StructureInTime.attach.joint: must hold another body, not two of the structure's");
        }
    }
    holds_ = std::move(found);
}

/// To the bodies that there are now.
DUCTILE_INLINE void StructureInTime::hand_over() {
    pressed_.forget();
    end_boxes();
    for (Hold& hold : holds_) {
        if (!course_.has_body(hold.at.body)) {
            dJointAttach(hold.joint, nullptr, nullptr);
            continue;
        }
        hold.go_to(body(hold.at));
        ode::wake(hold.joint);
    }
}

/// While it is whole the user's collisions leave out what a joint holds to its body; so do then all
/// bodies that hang together with it.
DUCTILE_INLINE bool StructureInTime::holds(dBodyID own, dBodyID other) const {
    return std::any_of(holds_.begin(), holds_.end(), [&](const Hold& hold) {
        return hold.acts() && hold.other() == other &&
               hanging_on(course_.cluster_of(hold.at.body))[cluster_on(own)];
    });
}

DUCTILE_INLINE void StructureInTime::wake() {
    proved_.reset();
    for (std::size_t c = 0; c < pieces_.size(); ++c) wake_cluster(c);
}

DUCTILE_INLINE void StructureInTime::set_gravity(double factor) {
    dWorldSetGravity(world_.id(), dReal(factor * gravity_.x()), dReal(factor * gravity_.y()),
                     dReal(factor * gravity_.z()));
}

// ---- a step

DUCTILE_INLINE void StructureInTime::require_possible() {
    find_holds();
    for (std::size_t c = 0; c < pieces_.size(); ++c) {
        if (held(c)) continue;
        dMass mass;
        dBodyGetMass(body(c), &mass);
        require_body(course_.clusters()[c].mass, double(mass.mass), dBodyIsKinematic(body(c)) != 0);
    }
}
DUCTILE_INLINE void StructureInTime::add_force(std::size_t c, const Vector3<double>& force,
                                               const Vector3<double>& at) {
    ode::add_force(body(c), force, cross(arm_of(body(c), at), force));
}

DUCTILE_INLINE void StructureInTime::before_solve(std::vector<dJointID>& joints) {
    begin_step();
    for (const Hold& hold : holds_) joints.push_back(hold.joint);
    courses_.clear();
    for (dBodyID body : pieces_) courses_.emplace_back(body);
}
DUCTILE_INLINE void StructureInTime::after_solve() {
    for (std::size_t c = 0; c < courses_.size() && c < pieces_.size(); ++c) {
        if (held(c)) dBodyDisable(body(c)); // ODE wakes what was touched
        courses_[c].see(body(c));
    }
    for (Hold& hold : holds_) {
        if (hold.see()) note(hold.at, courses_[cluster_on(hold.body)].pose, hold.wrench);
    }
}

DUCTILE_INLINE ClusterStep StructureInTime::step_of(std::size_t c, const Vector3<double>& gravity,
                                                    double dt) const {
    const PieceCourse& course = courses_[c];
    ClusterStep step{.pose = course.pose};
    if (!course.solved) return step; // what sleeps stays as it is
    const Vector3<double>& inertia = course_.clusters()[c].inertia;
    const Vector3<double> inverse{1 / inertia[0], 1 / inertia[1], 1 / inertia[2]};
    step.change = course.change(body(c), scaled(dt, gravity), along_axes(inertia, step.pose.axes),
                                along_axes(inverse, step.pose.axes), dt, step.dt);
    step.spin = course.motion.spin;
    return step;
}

DUCTILE_INLINE double StructureInTime::read_touches(double dt) {
    const auto press = [&](dBodyID body, const Vector3<double>& point,
                           const Vector3<double>& force) {
        const std::size_t c = cluster_on(body);
        const std::size_t on = course_.nearest(c, steps_[c].pose, point);
        loads_.push_back({on, point, scaled(dt, force), Vector3<double>::Zero()});
        return int(on);
    };
    double energy = 0;
    for (Touch& touch : touches_) {
        touch.segment = press(touch.of_a ? touch.bodies.a : touch.bodies.b, touch.point,
                              wrench_of(*touch.feedback, touch.of_a).force);
        const double pressed = dt * dot(touch.normal, to_core(touch.feedback->f1));
        energy += pressed * (touch.closing + touch.closing_speed()) / 2;
    }
    for (const PressedTouches::Pressed& asleep : pressed_.asleep()) {
        press(asleep.on, asleep.point, asleep.force);
    }
    return energy;
}

/// One that is held on the static world says nothing of that.
DUCTILE_INLINE std::optional<Wrench> StructureInTime::given(const OpenJoint& open,
                                                            bool to_a) const {
    if (!to_a && held(course_.cluster_of(plan().joints[open.joint].b.index))) return std::nullopt;
    return wrench_of(*open.constraint, to_a);
}

DUCTILE_INLINE void StructureInTime::find_beyond(double dt, std::span<Touch> touches,
                                                 std::vector<int>& sections) {
    std::vector<Touch> on_held;
    for (const Touch& touch : touches) {
        if (!can_move(touch.of_a ? touch.bodies.a : touch.bodies.b)) on_held.push_back(touch);
    }
    pressed_.see(on_held);
    touches_ = touches;
    const Vector3<double> gravity = gravity_of(world_.id());
    if (is_unproved(gravity)) look(dt, gravity, sections);
}

DUCTILE_INLINE void StructureInTime::find_struck(double dt, std::span<Touch> touches,
                                                 std::vector<int>& sections) {
    proved_.reset();
    touches_ = touches;
    if (touches.empty() && holds_.empty()) return;
    look_blow(dt, gravity_of(world_.id()), sections);
}

} // namespace ductile::ode
