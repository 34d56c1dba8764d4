// SPDX-License-Identifier: MIT
//
// Bodies of structure_in_time.hpp.
#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ductile/bullet/contact_load.hpp"
#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/structure_in_time.hpp"

namespace ductile::bullet {

DUCTILE_INLINE StructureInTime::StructureInTime(World& world, const StructureModel& model)
    : BuiltStructure(make_plan(model)),
      world_(world),
      gravity_(world.engine().getGravity()),
      course_(plan()) {
    for (const PlanBody& body : plan().bodies) {
        boxes_.push_back(std::make_unique<btBoxShape>(to_bullet(body.half_lengths)));
    }
    for (std::size_t j = 0; j < plan().joints.size(); ++j) {
        const PlanJoint* key = &plan().joints[j];
        reports_.push_back({key, key->name, [this, j] { return report(j); }});
    }
    for (std::size_t c = 0; c < course_.clusters().size(); ++c) {
        pieces_.push_back(make_cluster(c, nullptr));
    }
    made();
    try {
        world_.add(*this, reports_);
    } catch (...) {
        for (const PieceBody& piece : pieces_) world_.engine().removeRigidBody(piece.body);
        throw;
    }
}

DUCTILE_INLINE StructureInTime::~StructureInTime() {
    if (!left_) world_.remove(*this, reports_);
    joints_.clear();
    for (const PieceBody& piece : pieces_) world_.engine().removeRigidBody(piece.body);
}

// ---- what it says

DUCTILE_INLINE std::vector<btRigidBody*> StructureInTime::bodies() const {
    std::vector<btRigidBody*> all;
    for (const PieceBody& piece : pieces_) all.push_back(piece.body);
    return all;
}

DUCTILE_INLINE btRigidBody& StructureInTime::body_of(std::string_view member,
                                                     std::size_t piece) const {
    return *pieces_[course_.cluster_of(present_body(plan().body(member, piece)))].body;
}

DUCTILE_INLINE const StructureInTime::OpenJoint* StructureInTime::open_joint(
    std::size_t joint) const {
    const auto found = std::find_if(joints_.begin(), joints_.end(),
                                    [joint](const auto& open) { return open.joint == joint; });
    return found != joints_.end() ? &*found : nullptr;
}

DUCTILE_INLINE Vector6<double> StructureInTime::force(std::string_view member,
                                                      MemberEnd end) const {
    const std::size_t j = present_joint(plan().joint(member, end));
    const OpenJoint* open = open_joint(j);
    return open != nullptr ? forces_of(*open->constraint) : course_.force(j);
}

DUCTILE_INLINE JointReport<double> StructureInTime::report(std::size_t joint) const {
    if (const OpenJoint* open = open_joint(joint)) return open->constraint->report();
    JointReport<double> report;
    const auto& state = course_.joint(joint).state;
    if (!state) return report;
    report.plastic_travel = state->joint.plastic_travel;
    report.absorbed_energy = state->joint.plastic_work;
    return report;
}

DUCTILE_INLINE double StructureInTime::utilisation_of(std::size_t joint) const {
    if (open_joint(joint) != nullptr) return queries(joint).utilisation();
    return plan().joints[joint].joint.surface().value(course_.force(joint));
}
DUCTILE_INLINE const void* StructureInTime::key_of(const PlasticConstraint& joint,
                                                   int& section) const {
    for (const OpenJoint& open : joints_) {
        if (open.constraint.get() != &joint) continue;
        section = int(open.joint);
        return &plan().joints[open.joint];
    }
    return nullptr;
}

// ---- its bodies

DUCTILE_INLINE std::vector<PlacedBody> StructureInTime::placed_clusters() const {
    std::vector<PlacedBody> all;
    for (std::size_t c = 0; c < pieces_.size(); ++c) {
        const btRigidBody& body = *pieces_[c].body;
        PlacedBody& placed = all.emplace_back();
        if (course_.clusters()[c].held) continue;
        placed.pose = to_core(body.getCenterOfMassTransform());
        placed.motion = {to_core(body.getLinearVelocity()), to_core(body.getAngularVelocity())};
    }
    return all;
}

/// Into the course what open joints went through and carry.
DUCTILE_INLINE void StructureInTime::note_joints() {
    for (const OpenJoint& open : joints_) {
        auto& state = course_.joint(open.joint).state;
        state = open.constraint->state();
        if (!open.constraint->is_awake_member()) state->joint.flowing = false; // not any more
        course_.force(open.joint) = forces_of(*open.constraint);
    }
}

DUCTILE_INLINE PieceBody StructureInTime::make_cluster(std::size_t c, const btRigidBody* like) {
    const Cluster& cluster = course_.clusters()[c];
    const PlacedBody& at = course_.made_at()[c];
    PieceBody piece;
    piece.shape = std::make_unique<btCompoundShape>();
    for (std::size_t i = 0; i < cluster.bodies.size(); ++i) {
        const PlanBody& body = plan().bodies[cluster.bodies[i]];
        if (!body.collides) continue;
        piece.shape->addChildShape(to_bullet(placed(cluster.places[i], body.box)),
                                   boxes_[cluster.bodies[i]].get());
    }
    const bool collides = piece.shape->getNumChildShapes() > 0;
    if (!collides) piece.shape->recalculateLocalAabb();
    btRigidBody::btRigidBodyConstructionInfo info(
        btScalar(cluster.held ? 0 : cluster.mass), nullptr, piece.shape.get(),
        cluster.held ? btVector3(0, 0, 0) : to_bullet(cluster.inertia));
    info.m_startWorldTransform = to_bullet(at.pose);
    piece.own = std::make_unique<btRigidBody>(info);
    piece.body = piece.own.get();
    if (like != nullptr) copy_manners(*like, *piece.body);
    if (!cluster.held) set_motion(*piece.body, at.motion);
    if (collides) {
        world_.engine().addRigidBody(piece.body);
    } else {
        world_.engine().addRigidBody(piece.body, 0, 0);
    }
    return piece;
}

DUCTILE_INLINE void StructureInTime::become(const StructureCourse::Change& change, bool ahead) {
    proved_.reset();
    passing_.clear();
    std::vector<PieceBody> old = std::exchange(pieces_, {});
    std::vector<const btRigidBody*> now(change.kept.size(), nullptr);
    for (std::size_t c = 0; c < change.kept.size(); ++c) {
        if (change.kept[c]) now[c] = old[*change.kept[c]].body;
    }
    // constraints end before their bodies
    std::erase_if(joints_, [&](const OpenJoint& open) {
        const PlanJoint& joint = plan().joints[open.joint];
        const auto& course = course_.joint(open.joint);
        const bool ground = joint.b.kind == PlanSeat::Kind::ground;
        const bool stays =
            course.there && course.open &&
            now[course_.cluster_of(joint.a)] == &open.constraint->getRigidBodyA() &&
            (ground || now[course_.cluster_of(joint.b.index)] == &open.constraint->getRigidBodyB());
        return !stays;
    });
    const btRigidBody* like = old.empty() ? nullptr : old.front().body;
    for (std::size_t c = 0; c < change.kept.size(); ++c) {
        if (change.kept[c]) {
            pieces_.push_back(std::move(old[*change.kept[c]]));
        } else {
            pieces_.push_back(make_cluster(c, like));
        }
    }
    for (PieceBody& piece : old) {
        if (piece.own != nullptr) world_.engine().removeRigidBody(piece.body);
    }
    let_neighbours_pass();
    make_joints(ahead);
}

DUCTILE_INLINE void StructureInTime::let_neighbours_pass() {
    for (const auto& [a, b] : plan().neighbours) {
        if (!has_body(a) || !has_body(b)) continue;
        btRigidBody &one = *pieces_[course_.cluster_of(a)].body,
                    &other = *pieces_[course_.cluster_of(b)].body;
        if (&one != &other) passing_.add(one, other);
    }
}

DUCTILE_INLINE void StructureInTime::make_joints(bool ahead) {
    for (std::size_t j = 0; j < plan().joints.size(); ++j) {
        const PlanJoint& joint = plan().joints[j];
        if (!course_.joint(j).there || !course_.joint(j).open || open_joint(j) != nullptr) continue;
        const auto side = [&](std::size_t body, const JointFrame<double>& frame) {
            const std::size_t c = course_.cluster_of(body);
            return std::pair<btRigidBody&, btTransform>(
                *pieces_[c].body, to_bullet(placed(course_.clusters()[c].place(body), frame)));
        };
        const auto& [in_a, in_b] = course_.frames(j);
        const bool ground = joint.b.kind == PlanSeat::Kind::ground;
        const auto a = side(joint.a, in_a);
        const auto b = ground ? std::pair<btRigidBody&, btTransform>(
                                    btTypedConstraint::getFixedBody(), to_bullet(in_b))
                              : side(joint.b.index, in_b);
        if (&a.first == &b.first) continue; // what it joins hangs together by other joints, too
        OpenJoint open{j, std::make_unique<btJointFeedback>(), nullptr};
        open.constraint = std::make_unique<Joint>(a.first, b.first, a.second, b.second, joint.joint,
                                                  all_joint_axes, Meeting::as_they_are);
        if (course_.joint(j).state) open.constraint->restore(*course_.joint(j).state);
        open.constraint->setJointFeedback(open.feedback.get());
        open.constraint->set_ahead(ahead);
        open.constraint->add_to(world_.engine(), !ground);
        if (ahead) open.constraint->begin_part();
        world_.look_after_rest(*open.constraint);
        joints_.push_back(std::move(open));
    }
}

// ---- what BuiltStructure asks

DUCTILE_INLINE JointFrame<double> StructureInTime::frame_of(const PlanSeat& seat) const {
    const std::size_t c = course_.cluster_of(seat.index);
    const Cluster& cluster = course_.clusters()[c];
    const JointFrame<double> pose =
        cluster.held ? JointFrame<double>{} : to_core(pieces_[c].body->getCenterOfMassTransform());
    return placed(pose, cluster.place(seat.index));
}

DUCTILE_INLINE void StructureInTime::push(const PlanSeat& seat, const Vector3<double>& force,
                                          const Vector3<double>& at) {
    const JointFrame<double> frame = frame_of(seat);
    forces_.push_back(
        {seat.index, force, transposed_times(frame.axes, difference(at, frame.origin))});
    pieces_[course_.cluster_of(seat.index)].body->activate();
}

DUCTILE_INLINE void StructureInTime::drop_joint(std::size_t joint) {
    note_joints();
    become(course_.remove_joint(joint, placed_clusters()), {});
    if (!left_) world_.rearranged(*this);
}
DUCTILE_INLINE void StructureInTime::drop_body(std::size_t body) {
    note_joints();
    std::erase_if(forces_, [body](const Force& force) { return force.body == body; });
    become(course_.remove_body(body, placed_clusters()), {});
    if (!left_) world_.rearranged(*this);
}

DUCTILE_INLINE void StructureInTime::wake() {
    proved_.reset();
    for (const PieceBody& piece : pieces_) piece.body->activate(true);
}

DUCTILE_INLINE void StructureInTime::set_gravity(double factor) {
    btDiscreteDynamicsWorld& engine = world_.engine();
    for (int i = 0; i < engine.getNumCollisionObjects(); ++i) {
        engine.getCollisionObjectArray()[i]->activate(); // Bullet leaves out those asleep
    }
    engine.setGravity(gravity_ * btScalar(factor));
}

// ---- what the world asks

DUCTILE_INLINE void StructureInTime::apply_forces() {
    for (const Force& force : forces_) {
        btRigidBody& body = *pieces_[course_.cluster_of(force.body)].body;
        if (body.isStaticObject()) continue;
        const JointFrame<double> at = frame_of({PlanSeat::Kind::body, force.body});
        body.applyForce(to_bullet(force.force),
                        to_bullet(sum(at.origin, times(at.axes, force.in_body))) -
                            body.getCenterOfMassPosition());
    }
}

DUCTILE_INLINE void StructureInTime::begin() { touches_.clear(); }

/// Nothing acts on it but what it carried before.
DUCTILE_INLINE bool StructureInTime::rests() const {
    return forces_.empty() && std::all_of(touches_.begin(), touches_.end(),
                                          [](const ContactTouch& touch) { return touch.asleep; });
}

DUCTILE_INLINE bool StructureInTime::may_be_beyond(double /*dt*/,
                                                   std::span<const BodyBefore> /*before*/,
                                                   const btVector3& gravity) const {
    if (!proved_ || *proved_ != gravity || !rests() || proved_touches_ != touches_.size()) {
        return true;
    }
    return std::any_of(pieces_.begin(), pieces_.end(), [](const PieceBody& piece) {
        return !piece.body->isStaticObject() && piece.body->isActive();
    });
}

DUCTILE_INLINE void StructureInTime::read_contact(const ContactTouch& touch,
                                                  std::span<const BodyBefore> before) {
    const btCollisionObject* body =
        touch.of_a ? touch.manifold->getBody0() : touch.manifold->getBody1();
    std::size_t c = 0;
    while (c + 1 < pieces_.size() && pieces_[c].body != body) ++c;
    for (int k = 0; k < touch.manifold->getNumContacts(); ++k) {
        const ContactLoad contact =
            contact_load(*touch.manifold, touch.manifold->getContactPoint(k), touch.of_a, before);
        if (contact.impulse.isZero()) continue;
        BodyLoad& load = loads_.emplace_back();
        load.point = to_core(contact.at);
        load.body = course_.nearest(c, steps_[c].pose, load.point);
        load.impulse = scaled(touch.share, to_core(contact.impulse));
        struck_ += contact.energy;
    }
}

DUCTILE_INLINE void StructureInTime::read(double dt, std::span<const BodyBefore> before,
                                          const btVector3& gravity) {
    loads_.clear();
    struck_ = 0;
    steps_.assign(pieces_.size(), {});
    for (std::size_t c = 0; c < pieces_.size(); ++c) {
        if (course_.clusters()[c].held) continue;
        const int place = pieces_[c].body->getWorldArrayIndex();
        steps_[c].pose = to_core(before[std::size_t(place)].pose);
    }
    for (const ContactTouch& touch : touches_) read_contact(touch, before);
    const auto add = [&](const btVector3& force, const btVector3& torque, std::size_t body) {
        // about the centre of its cluster's body
        loads_.push_back({body, steps_[course_.cluster_of(body)].pose.origin,
                          scaled(dt, to_core(force)), scaled(dt, to_core(torque))});
    };
    for (const OpenJoint& open : joints_) {
        if (!open.constraint->isEnabled()) continue;
        const PlanJoint& joint = plan().joints[open.joint];
        add(open.feedback->m_appliedForceBodyA, open.feedback->m_appliedTorqueBodyA, joint.a);
        if (joint.b.kind != PlanSeat::Kind::body) continue;
        add(open.feedback->m_appliedForceBodyB, open.feedback->m_appliedTorqueBodyB, joint.b.index);
    }
    for (const Force& force : forces_) {
        const std::size_t c = course_.cluster_of(force.body);
        const JointFrame<double> at =
            placed(steps_[c].pose, course_.clusters()[c].place(force.body));
        loads_.push_back({force.body, sum(at.origin, times(at.axes, force.in_body)),
                          scaled(dt, force.force), Vector3<double>::Zero()});
    }
    for (std::size_t c = 0; c < pieces_.size(); ++c) {
        ClusterStep& step = steps_[c];
        const btRigidBody& body = *pieces_[c].body;
        if (course_.clusters()[c].held) {
            step.change.velocity = scaled(-dt, to_core(gravity));
            continue;
        }
        if (!body.isActive()) { // it was not solved: it stays as it is
            step.change.velocity = scaled(-dt, to_core(body.getGravity()));
            continue;
        }
        const BodyChange went =
            body_change(body, before[std::size_t(body.getWorldArrayIndex())], dt);
        step.change = went.of(course_.clusters()[c].inertia, step.pose.axes);
        step.spin = went.spin;
        step.dt = went.dt;
    }
    proved_.reset();
    proved_touches_ = touches_.size();
    if (rests() && joints_.empty()) proved_ = gravity;
}

DUCTILE_INLINE void StructureInTime::find_beyond(double dt, std::vector<int>& sections) {
    sections = course_.beyond(steps_, loads_, dt);
    if (!sections.empty()) proved_.reset();
}
DUCTILE_INLINE void StructureInTime::find_struck(std::vector<int>& sections) {
    sections = course_.struck(steps_, loads_, struck_);
    proved_.reset();
}

DUCTILE_INLINE void StructureInTime::open(std::span<const int> sections, bool ahead,
                                          std::vector<DivisionChange>& told) {
    note_joints();
    const std::vector<int> opened(sections.begin(), sections.end());
    become(course_.open(opened, placed_clusters()), ahead);
    for (const int joint : opened) told.push_back({&plan().joints[std::size_t(joint)], joint});
}

DUCTILE_INLINE bool StructureInTime::close_held(Closing when, bool ahead,
                                                std::vector<DivisionChange>& told) {
    if (course_.whole() || when == Closing::before_blow) return false;
    note_joints();
    const std::vector<int> held = course_.held();
    if (held.empty()) return false;
    become(course_.close(held, placed_clusters()), ahead);
    for (const int joint : held) told.push_back({&plan().joints[std::size_t(joint)], joint});
    return true;
}

} // namespace ductile::bullet
