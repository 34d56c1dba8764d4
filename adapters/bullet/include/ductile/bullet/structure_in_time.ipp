// SPDX-License-Identifier: MIT
//
// Bodies of structure_in_time.hpp.
#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include <algorithm>
#include <stdexcept>

#include "ductile/bullet/contact_load.hpp"
#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/structure_in_time.hpp"

namespace ductile::bullet {

DUCTILE_INLINE StructureInTime::StructureInTime(World& world, const StructureModel& model)
    : SteppedStructure(model), world_(world), gravity_(world.engine().getGravity()) {
    for (const PlanBody& body : plan().bodies) {
        boxes_.push_back(std::make_unique<btBoxShape>(to_bullet(body.half_lengths)));
    }
    make_pieces();
    try {
        world_.add(*this, reports_);
    } catch (...) {
        end_pieces();
        throw;
    }
}

DUCTILE_INLINE StructureInTime::~StructureInTime() {
    if (!left_) world_.remove(*this, reports_);
    joints_.clear();
    for (Hold& hold : holds_) hold.drop(world_.engine());
    passing_.clear();
    end_pieces();
}

DUCTILE_INLINE std::vector<btRigidBody*> StructureInTime::bodies() const {
    std::vector<btRigidBody*> all;
    for (const PieceBody& piece : pieces_) all.push_back(piece.body);
    return all;
}

// ---- its bodies

DUCTILE_INLINE PlacedBody StructureInTime::cluster_now(std::size_t c) const {
    return {to_core(body(c)->getCenterOfMassTransform()),
            {to_core(body(c)->getLinearVelocity()), to_core(body(c)->getAngularVelocity())}};
}

DUCTILE_INLINE PieceBody StructureInTime::make_piece(std::size_t c, btRigidBody* like) {
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

DUCTILE_INLINE OpenJoint StructureInTime::make_joint(std::size_t joint, std::size_t a,
                                                     const JointFrame<double>& in_a,
                                                     std::optional<std::size_t> b,
                                                     const JointFrame<double>& in_b) {
    btRigidBody& other = b ? *body(*b) : btTypedConstraint::getFixedBody();
    return {joint, std::make_unique<btJointFeedback>(),
            std::make_unique<PlasticJoint<SectionJoint<double>>>(
                *body(a), other, to_bullet(in_a), to_bullet(in_b), plan().joints[joint].joint,
                all_joint_axes, Meeting::as_they_are)};
}
DUCTILE_INLINE void StructureInTime::enter_joint(OpenJoint& open, bool ahead) {
    open.constraint->setJointFeedback(open.feedback.get());
    open.constraint->set_ahead(ahead);
    open.constraint->add_to(world_.engine(), !stands_on_ground(open.joint));
    if (ahead) open.constraint->begin_part();
    world_.look_after_rest(*open.constraint);
}

DUCTILE_INLINE void StructureInTime::let_pass() {
    passing_.clear();
    over_neighbours([this](btRigidBody* one, btRigidBody* other) {
        if (one != other) passing_.add(*one, *other);
    });
    for (const Hold& hold : holds_) {
        if (!hold.acts()) continue;
        const std::vector<bool> hangs = hanging_on(course_.cluster_of(hold.at.body));
        for (std::size_t c = 0; c < pieces_.size(); ++c) {
            // what it holds itself Bullet lets pass
            if (hangs[c] && body(c) != hold.body) passing_.add(*body(c), hold.other());
        }
    }
}

// ---- what holds on to it

DUCTILE_INLINE void StructureInTime::make(Hold& hold) {
    btRigidBody& on = *body(hold.at);
    hold.make("StructureInTime.attach", world_.engine(), on, to_bullet(place_of(hold.at)));
    const std::size_t other = cluster_on(&hold.other());
    if (other == pieces_.size() || body(other) == &on) return;
    hold.drop(world_.engine());
    throw std::invalid_argument(
        "StructureInTime.attach.maker: must hold another body, not two of the structure's");
}
DUCTILE_INLINE void StructureInTime::hold_on(const StructureHold& at, Maker maker) {
    Hold hold{{.maker = std::move(maker)}, at};
    make(hold);
    holds_.push_back(std::move(hold));
    proved_.reset();
    let_pass();
}
DUCTILE_INLINE void StructureInTime::hand_over() {
    passing_.clear();
    for (Hold& hold : holds_) {
        if (!course_.has_body(hold.at.body) || hold.body != body(hold.at)) {
            hold.drop(world_.engine());
        }
    }
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
DUCTILE_INLINE void StructureInTime::add_force(std::size_t c, const Vector3<double>& force,
                                               const Vector3<double>& at) {
    body(c)->applyForce(to_bullet(force), to_bullet(at) - body(c)->getCenterOfMassPosition());
}

DUCTILE_INLINE ClusterStep StructureInTime::step_of(std::size_t c, const Vector3<double>& /*g*/,
                                                    double dt) const {
    const btRigidBody& of = *body(c);
    const BodyBefore& before = before_[std::size_t(of.getWorldArrayIndex())];
    ClusterStep step{.pose = to_core(before.pose)};
    if (!of.isActive()) { // it was not solved: it stays as it is
        step.change.velocity = scaled(-dt, to_core(of.getGravity()));
        return step;
    }
    const BodyChange went = body_change(of, before, dt);
    step.change = went.of(course_.clusters()[c].inertia, step.pose.axes);
    step.spin = went.spin;
    step.dt = went.dt;
    return step;
}

DUCTILE_INLINE double StructureInTime::read_touches(double /*dt*/) {
    double energy = 0;
    for (const ContactTouch& touch : touches_) {
        const btPersistentManifold& manifold = *touch.manifold;
        const std::size_t c = cluster_on(touch.of_a ? manifold.getBody0() : manifold.getBody1());
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            const ContactLoad contact =
                contact_load(manifold, manifold.getContactPoint(k), touch.of_a, before_);
            if (contact.impulse.isZero()) continue;
            BodyLoad& load = loads_.emplace_back();
            load.point = to_core(contact.at);
            load.body = course_.nearest(c, steps_[c].pose, load.point);
            load.impulse = scaled(touch.share, to_core(contact.impulse));
            energy += contact.energy;
        }
    }
    for (Hold& hold : holds_) {
        if (!hold.see()) continue;
        note(hold.at, steps_[course_.cluster_of(hold.at.body)].pose, hold.given());
    }
    return energy;
}

DUCTILE_INLINE std::optional<Wrench> StructureInTime::given(const OpenJoint& open,
                                                            bool to_a) const {
    const btJointFeedback& told = *open.feedback;
    return to_a ? Wrench{to_core(told.m_appliedForceBodyA), to_core(told.m_appliedTorqueBodyA)}
                : Wrench{to_core(told.m_appliedForceBodyB), to_core(told.m_appliedTorqueBodyB)};
}

DUCTILE_INLINE double StructureInTime::most_share(double /*dt*/,
                                                  std::span<const BodyBefore> /*before*/,
                                                  const btVector3& gravity) const {
    return is_unproved(to_core(gravity)) ? std::numeric_limits<double>::infinity() : 1;
}
DUCTILE_INLINE void StructureInTime::find_beyond(double dt, std::span<const BodyBefore> before,
                                                 const btVector3& gravity,
                                                 std::vector<int>& sections) {
    before_ = before;
    look(dt, to_core(gravity), sections);
}
DUCTILE_INLINE void StructureInTime::find_struck(double dt, std::span<const BodyBefore> before,
                                                 const btVector3& gravity,
                                                 std::vector<int>& sections) {
    before_ = before;
    look_blow(dt, to_core(gravity), sections);
}

} // namespace ductile::bullet
