// SPDX-License-Identifier: MIT
//
// Bodies of structure_in_time.hpp.
#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ductile/bullet/contact_load.hpp"
#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/structure_in_time.hpp"

namespace ductile::bullet {

DUCTILE_INLINE StructureInTime::StructureInTime(World& world, const StructureModel& model)
    : DividedStructure(model), world_(world), gravity_(world.engine().getGravity()) {
    for (const PlanBody& body : plan().bodies) {
        boxes_.push_back(std::make_unique<btBoxShape>(to_bullet(body.half_lengths)));
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
    for (Hold& hold : holds_) hold.drop(world_.engine());
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

DUCTILE_INLINE const void* StructureInTime::key_of(const PlasticConstraint& joint,
                                                   int& section) const {
    const auto index = index_of(joint);
    if (!index) return nullptr;
    section = int(*index);
    return DividedStructure::key_of(*index);
}

// ---- its bodies

DUCTILE_INLINE PlacedBody StructureInTime::cluster_now(std::size_t c) const {
    const btRigidBody& body = *pieces_[c].body;
    return {to_core(body.getCenterOfMassTransform()),
            {to_core(body.getLinearVelocity()), to_core(body.getAngularVelocity())}};
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
    end_joints(change); // before their bodies do
    const btRigidBody* like = old.empty() ? nullptr : old.front().body;
    for (std::size_t c = 0; c < change.kept.size(); ++c) {
        if (change.kept[c]) {
            pieces_.push_back(std::move(old[*change.kept[c]]));
        } else {
            pieces_.push_back(make_cluster(c, like));
        }
    }
    for (Hold& hold : holds_) { // before their bodies do
        if (!course_.has_body(hold.at.body) || hold.body != &body_of(hold.at)) {
            hold.drop(world_.engine());
        }
    }
    std::erase_if(holds_, [this](const Hold& hold) { return !course_.has_body(hold.at.body); });
    for (PieceBody& piece : old) {
        if (piece.own != nullptr) world_.engine().removeRigidBody(piece.body);
    }
    for (Hold& hold : holds_) make(hold);
    make_joints(
        [this](std::size_t j, std::size_t a, const JointFrame<double>& in_a,
               std::optional<std::size_t> b, const JointFrame<double>& in_b) {
            btRigidBody& other = b ? *pieces_[*b].body : btTypedConstraint::getFixedBody();
            return OpenJoint{j, std::make_unique<btJointFeedback>(),
                             std::make_unique<Joint>(*pieces_[a].body, other, to_bullet(in_a),
                                                     to_bullet(in_b), plan().joints[j].joint,
                                                     all_joint_axes, Meeting::as_they_are)};
        },
        [this, ahead](OpenJoint& open) {
            open.constraint->setJointFeedback(open.feedback.get());
            open.constraint->set_ahead(ahead);
            open.constraint->add_to(world_.engine(), !stands_on_ground(open.joint));
            if (ahead) open.constraint->begin_part();
            world_.look_after_rest(*open.constraint);
        });
    let_pass();
}

DUCTILE_INLINE void StructureInTime::let_pass() {
    passing_.clear();
    broken_ = broken_joints();
    for (const auto& [a, b] : plan().neighbours) {
        if (!has_body(a) || !has_body(b)) continue;
        btRigidBody &one = *pieces_[course_.cluster_of(a)].body,
                    &other = *pieces_[course_.cluster_of(b)].body;
        if (&one != &other) passing_.add(one, other);
    }
    for (const Hold& hold : holds_) {
        if (!hold.acts()) continue;
        const std::vector<bool> hangs = hanging_on(course_.cluster_of(hold.at.body));
        for (std::size_t c = 0; c < pieces_.size(); ++c) {
            // what it holds itself Bullet lets pass
            if (hangs[c] && pieces_[c].body != hold.body) {
                passing_.add(*pieces_[c].body, hold.other());
            }
        }
    }
}
DUCTILE_INLINE std::size_t StructureInTime::broken_joints() const {
    return std::size_t(std::count_if(joints_.begin(), joints_.end(), [](const OpenJoint& open) {
        return open.constraint->broken();
    }));
}

// ---- what holds on to it

DUCTILE_INLINE void StructureInTime::make(Hold& hold) {
    const btRigidBody& body = body_of(hold.at);
    hold.make("StructureInTime.attach", world_.engine(), body_of(hold.at),
              to_bullet(place_of(hold.at)));
    if (std::none_of(pieces_.begin(), pieces_.end(), [&](const PieceBody& piece) {
            return piece.body == &hold.other() && piece.body != &body;
        })) {
        return;
    }
    hold.drop(world_.engine());
    throw std::invalid_argument(
        "StructureInTime.attach.maker: must hold another body, not two of the structure's");
}
DUCTILE_INLINE void StructureInTime::attach(const Point& point, Maker maker) {
    const StructureHold at = hold_at(point);
    Hold hold{{.maker = std::move(maker)}, at};
    make(hold);
    holds_.push_back(std::move(hold));
    proved_.reset();
    let_pass();
}
DUCTILE_INLINE void StructureInTime::require_attached(const btTypedConstraint& constraint) const {
    if (std::any_of(holds_.begin(), holds_.end(),
                    [&](const Hold& hold) { return hold.constraint.get() == &constraint; })) {
        return;
    }
    throw std::invalid_argument(
        "StructureInTime.bodies: no constraint of the user's may hold them but by "
        "StructureInTime::attach, as they come and go");
}
DUCTILE_INLINE void StructureInTime::list_holds(std::vector<const btTypedConstraint*>& list) const {
    for (const Hold& hold : holds_) list.push_back(hold.constraint.get());
}
DUCTILE_INLINE bool StructureInTime::switch_holds_off() {
    bool any = false;
    for (const Hold& hold : holds_) any = hold.switch_off() || any;
    return any;
}
DUCTILE_INLINE void StructureInTime::see_coming() {
    for (Hold& hold : holds_) hold.see_coming();
}
DUCTILE_INLINE std::size_t StructureInTime::acting_holds() const {
    return std::size_t(
        std::count_if(holds_.begin(), holds_.end(), [](const Hold& hold) { return hold.acts(); }));
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

DUCTILE_INLINE void StructureInTime::require_possible() const {
    for (std::size_t c = 0; c < pieces_.size(); ++c) {
        const btRigidBody& body = *pieces_[c].body;
        if (!body.isInWorld()) {
            throw std::logic_error(
                "StructureInTime.bodies: must stay in the world: addRigidBody them, or end the "
                "structure");
        }
        const Cluster& cluster = course_.clusters()[c];
        require_body(cluster.held ? 0 : cluster.mass, double(body.getMass()),
                     body.isKinematicObject());
    }
}
DUCTILE_INLINE void StructureInTime::apply_forces() {
    add_forces([this](std::size_t c, const Vector3<double>& force, const Vector3<double>& at) {
        btRigidBody& body = *pieces_[c].body;
        body.applyForce(to_bullet(force), to_bullet(at) - body.getCenterOfMassPosition());
    });
}

/// Nothing acts on it but what it carried before.
DUCTILE_INLINE bool StructureInTime::rests() const {
    return forces_.empty() &&
           std::all_of(touches_.begin(), touches_.end(),
                       [](const ContactTouch& touch) { return touch.asleep; }) &&
           std::none_of(holds_.begin(), holds_.end(),
                        [](const Hold& hold) { return hold.is_solved(); });
}

DUCTILE_INLINE bool StructureInTime::may_be_beyond(double /*dt*/,
                                                   std::span<const BodyBefore> /*before*/,
                                                   const btVector3& gravity) const {
    if (!proved_ || *proved_ != gravity || !rests() ||
        proved_touches_ != touches_.size() + acting_holds()) {
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
    begin_read();
    struck_ = 0;
    by_joints_ = {};
    for (std::size_t c = 0; c < pieces_.size(); ++c) {
        if (course_.clusters()[c].held) continue;
        const int place = pieces_[c].body->getWorldArrayIndex();
        steps_[c].pose = to_core(before[std::size_t(place)].pose);
    }
    for (const ContactTouch& touch : touches_) read_contact(touch, before);
    for (Hold& hold : holds_) {
        if (!hold.acts()) continue;
        if (hold.see()) {
            note(hold.at, steps_[course_.cluster_of(hold.at.body)].pose, to_core(hold.force()),
                 to_core(hold.torque()));
        }
        add_load(hold.at, dt);
        const btVector3 place = to_bullet(point_of(hold.at));
        by_joints_.add(hold.side(true, place, dt), hold.side(false, place, dt), 0);
    }
    const auto add = [&](std::size_t body, const btVector3& force, const btVector3& torque) {
        add_load(body, to_core(force), to_core(torque), dt);
    };
    for (const OpenJoint& open : joints_) {
        if (!open.constraint->isEnabled()) continue;
        const PlanJoint& joint = plan().joints[open.joint];
        add(joint.a, open.feedback->m_appliedForceBodyA, open.feedback->m_appliedTorqueBodyA);
        if (stands_on_ground(open.joint)) continue;
        add(joint.b.index, open.feedback->m_appliedForceBodyB, open.feedback->m_appliedTorqueBodyB);
    }
    read_forces(dt);
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
    proved_touches_ = touches_.size() + acting_holds();
    if (rests() && joints_.empty()) proved_ = gravity;
}

DUCTILE_INLINE void StructureInTime::find_beyond(double dt, std::vector<int>& sections) {
    sections = course_.beyond(steps_, loads_, dt);
    if (!sections.empty()) proved_.reset();
}
DUCTILE_INLINE void StructureInTime::find_struck(std::vector<int>& sections) {
    sections = struck(struck_, by_joints_);
    proved_.reset();
}

DUCTILE_INLINE void StructureInTime::open(std::span<const int> sections, bool ahead,
                                          std::vector<DivisionChange>& told) {
    note_joints();
    const std::vector<int> opened(sections.begin(), sections.end());
    become(course_.open(opened, placed_clusters()), ahead);
    for (const int joint : opened)
        told.push_back({DividedStructure::key_of(std::size_t(joint)), joint});
}

DUCTILE_INLINE bool StructureInTime::close_held(Closing when, bool ahead,
                                                std::vector<DivisionChange>& told) {
    if (course_.whole() || when == Closing::before_blow) return false;
    note_joints();
    if (broken_ != broken_joints()) let_pass();
    const std::vector<int> held = course_.held();
    if (held.empty()) return false;
    become(course_.close(held, placed_clusters()), ahead);
    for (const int joint : held)
        told.push_back({DividedStructure::key_of(std::size_t(joint)), joint});
    return true;
}

} // namespace ductile::bullet
