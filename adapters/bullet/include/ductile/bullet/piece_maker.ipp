// SPDX-License-Identifier: MIT
//
// Bodies of piece_maker.hpp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/piece_maker.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void PieceMaker::find_overhang() {
    const MemberPiece whole = make_piece(member_, straight(member_), {0, member_.segments() - 1});
    const JointFrame<double> start = placed(first_in_body_, whole.section(member_, 0, false));
    btVector3 low, high;
    straight_->getAabb(to_bullet(start).inverse(), low, high);
    over_ = MemberOverhang::of(member_, double(low.z()), double(high.z()));
}
DUCTILE_INLINE std::unique_ptr<btCompoundShape> PieceMaker::make_shape(const MemberPiece& piece) {
    auto shape = std::make_unique<ShapeOfBoxes>();
    if (box_.is_there()) {
        for (const StraightStretch& stretch : straight_stretches(member_, piece, over_)) {
            shape->add(to_bullet(stretch.middle),
                       {btScalar(box_.half_width), btScalar(box_.half_height),
                        btScalar(stretch.length / 2)});
        }
    }
    if (shape->getNumChildShapes() == 0) shape->recalculateLocalAabb();
    return shape;
}

DUCTILE_INLINE PieceBody PieceMaker::make(const PlacedPiece& placed) {
    const MemberPiece& of = *placed.piece;
    PieceBody piece;
    piece.run = of.run;
    if (of.held && of.run.first == of.run.last) {
        piece.body = &btTypedConstraint::getFixedBody();
        return piece;
    }
    piece.shape = make_shape(of);
    btRigidBody::btRigidBodyConstructionInfo info(
        btScalar(of.held ? 0 : of.mass), nullptr, piece.shape.get(),
        of.held ? btVector3(0, 0, 0) : to_bullet(of.inertia));
    info.m_startWorldTransform = to_bullet(placed.pose);
    piece.own = std::make_unique<btRigidBody>(info);
    piece.body = piece.own.get();
    copy_manners(user_, *piece.body);
    if (!of.held) set_motion(*piece.body, placed.motion);
    enter_world(*piece.body);
    return piece;
}

DUCTILE_INLINE void copy_manners(const btRigidBody& from, btRigidBody& body) {
    body.setFriction(from.getFriction());
    body.setRollingFriction(from.getRollingFriction());
    body.setSpinningFriction(from.getSpinningFriction());
    body.setRestitution(from.getRestitution());
    body.setDamping(from.getLinearDamping(), from.getAngularDamping());
    body.setLinearFactor(from.getLinearFactor());
    body.setAngularFactor(from.getAngularFactor());
    body.setSleepingThresholds(from.getLinearSleepingThreshold(),
                               from.getAngularSleepingThreshold());
    body.setFlags(from.getFlags());
    body.setUserPointer(from.getUserPointer());
    body.setUserIndex(from.getUserIndex());
    body.setUserIndex2(from.getUserIndex2());
    const int manners = from.getCollisionFlags() & ~(btCollisionObject::CF_STATIC_OBJECT |
                                                     btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setCollisionFlags(body.getCollisionFlags() | manners);
    if (from.getActivationState() == DISABLE_DEACTIVATION) {
        body.setActivationState(DISABLE_DEACTIVATION);
    }
}

DUCTILE_INLINE void PieceMaker::enter_world(btRigidBody& body) const {
    const bool collides = box_.is_there() || &body == &user_;
    world_->addRigidBody(&body, collides ? group_ : 0, collides ? mask_ : 0);
    if (!body.isStaticObject()) body.setGravity(gravity_);
}

DUCTILE_INLINE void PieceMaker::put_whole(const PlacedPiece& placed, bool straight) {
    const MemberPiece& whole = *placed.piece;
    if (straight) {
        if (user_.getCollisionShape() != straight_) user_.setCollisionShape(straight_);
        if (!whole.held && bent_ != nullptr) user_.setMassProps(mass_, inertia_);
        bent_.reset();
        whole_in_body_ = first_in_body_;
    } else {
        const auto before = std::exchange(bent_, make_shape(whole));
        if (bent_->getNumChildShapes() > 0) user_.setCollisionShape(bent_.get());
        // the frame of a piece is that of its centre and main axes
        whole_in_body_ = {};
        if (!whole.held) user_.setMassProps(btScalar(whole.mass), to_bullet(whole.inertia));
    }
    const btTransform pose = to_bullet(frame_around(placed.pose, whole_in_body_));
    user_.setCenterOfMassTransform(pose);
    user_.setInterpolationWorldTransform(pose);
    if (user_.getMotionState() != nullptr) user_.getMotionState()->setWorldTransform(pose);
    if (!whole.held) {
        // the moment of momentum is that of the pieces
        const btVector3 about =
            to_bullet(times(whole.inertia_in_world(placed.pose.axes), placed.motion.spin));
        set_motion(user_,
                   {placed.motion.velocity, to_core(user_.getInvInertiaTensorWorld() * about)});
        user_.clearForces();
        user_.activate(true);
    }
    enter_world(user_);
}

DUCTILE_INLINE void PieceMaker::take_out() {
    const btBroadphaseProxy& proxy = *user_.getBroadphaseHandle();
    group_ = proxy.m_collisionFilterGroup;
    mask_ = proxy.m_collisionFilterMask;
    gravity_ = user_.isStaticObject() ? world_->getGravity() : user_.getGravity();
    world_->removeRigidBody(&user_);
}

DUCTILE_INLINE void set_motion(btRigidBody& body, const BodyMotion& motion) {
    body.setLinearVelocity(to_bullet(motion.velocity));
    body.setAngularVelocity(to_bullet(motion.spin));
    body.setInterpolationLinearVelocity(body.getLinearVelocity());
    body.setInterpolationAngularVelocity(body.getAngularVelocity());
}

} // namespace ductile::bullet
