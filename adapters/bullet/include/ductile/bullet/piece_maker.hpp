// SPDX-License-Identifier: MIT
//
// Bodies and shapes of a member's pieces, and the user's body in and out of its world.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <utility>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/member/divided_member.hpp"

namespace ductile::bullet {

using ductile::MemberBox;

/// Friction, restitution, damping, factors, flags and the user's pointers of one body for another.
inline void copy_manners(const btRigidBody& from, btRigidBody& body) {
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
inline void set_motion(btRigidBody& body, const BodyMotion& motion) {
    body.setLinearVelocity(to_bullet(motion.velocity));
    body.setAngularVelocity(to_bullet(motion.spin));
    body.setInterpolationLinearVelocity(body.getLinearVelocity());
    body.setInterpolationAngularVelocity(body.getAngularVelocity());
}

/// Its contacts are known before they touch, as those of a box alone: a compound asks a part of it
/// where its bounds meet.
class PieceBox final : public btBoxShape {
  public:
    explicit PieceBox(const btVector3& half_lengths) : btBoxShape(half_lengths) {
        constexpr auto hardly = btScalar(1e-3); // else edges are rounded by up to 4 cm [m]
        setMargin(hardly);
    }
    void getAabb(const btTransform& at, btVector3& low, btVector3& high) const override {
        constexpr auto early = btScalar(1e-3); // [m]
        btBoxShape::getAabb(at, low, high);
        low -= btVector3(early, early, early);
        high += btVector3(early, early, early);
    }
    /// As Bullet's, of which GCC warns.
    void getPlane(btVector3& normal, btVector3& support, int i) const override {
        normal.setZero();
        normal[i / 2] = i % 2 == 0 ? btScalar(1) : btScalar(-1);
        support = localGetSupportingVertex(-normal);
    }
};

/// Of boxes that are its own.
class ShapeOfBoxes final : public btCompoundShape {
  public:
    void add(const btTransform& middle, const btVector3& half_lengths) {
        boxes_.push_back(std::make_unique<PieceBox>(half_lengths));
        addChildShape(middle, boxes_.back().get());
    }

  private:
    std::vector<std::unique_ptr<PieceBox>> boxes_;
};

struct PieceBody {
    btRigidBody* body = nullptr;
    std::unique_ptr<btCompoundShape> shape; ///< ends after the body
    std::unique_ptr<btRigidBody> own;       ///< null: the user's, or the ground
    MemberRun run;
};

class PieceMaker {
  public:
    /// `whole_in_body`: the frame of the whole member in the user's body.
    PieceMaker(btRigidBody& user, const ductile::Member& member, const MemberBox& box,
               const JointFrame<double>& whole_in_body)
        : user_(user),
          member_(member),
          box_(box),
          whole_in_body_(whole_in_body),
          first_in_body_(whole_in_body),
          straight_(user.getCollisionShape()),
          mass_(user.getMass()) {
        if (box_.is_there()) find_overhang();
        const btVector3& inverse = user.getInvInertiaDiagLocal();
        for (int i = 0; i < 3; ++i) inertia_[i] = inverse[i] > 0 ? 1 / inverse[i] : btScalar(0);
    }
    /// The user's body has its own shape again.
    ~PieceMaker() {
        if (user_.getCollisionShape() == bent_.get()) user_.setCollisionShape(straight_);
    }
    PieceMaker(const PieceMaker&) = delete;
    PieceMaker& operator=(const PieceMaker&) = delete;

    void enter(btDiscreteDynamicsWorld& world) noexcept { world_ = &world; }
    [[nodiscard]] const JointFrame<double>& whole_in_body() const noexcept {
        return whole_in_body_;
    }
    /// The same of a straight member.
    [[nodiscard]] const JointFrame<double>& first_in_body() const noexcept {
        return first_in_body_;
    }

    /// The user's body leaves the world.
    void take_out() {
        const btBroadphaseProxy& proxy = *user_.getBroadphaseHandle();
        group_ = proxy.m_collisionFilterGroup;
        mask_ = proxy.m_collisionFilterMask;
        gravity_ = user_.isStaticObject() ? world_->getGravity() : user_.getGravity();
        world_->removeRigidBody(&user_);
    }
    /// It is the member again, in the world: as it was at first where that is `straight`.
    void put_whole(const PlacedPiece& placed, bool straight) {
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
    /// A piece in the world; the ground itself of a held segment alone.
    [[nodiscard]] PieceBody make(const PlacedPiece& placed) {
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

  private:
    void find_overhang() {
        const MemberPiece whole =
            make_piece(member_, straight(member_), {0, member_.segments() - 1});
        const JointFrame<double> start = placed(first_in_body_, whole.section(member_, 0, false));
        btVector3 low, high;
        straight_->getAabb(to_bullet(start).inverse(), low, high);
        over_ = MemberOverhang::of(member_, double(low.z()), double(high.z()));
    }
    [[nodiscard]] std::unique_ptr<btCompoundShape> make_shape(const MemberPiece& piece) {
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
    void enter_world(btRigidBody& body) const {
        const bool collides = box_.is_there() || &body == &user_;
        world_->addRigidBody(&body, collides ? group_ : 0, collides ? mask_ : 0);
        if (!body.isStaticObject()) body.setGravity(gravity_);
    }

    btRigidBody& user_;
    const ductile::Member& member_;
    MemberBox box_;
    JointFrame<double> whole_in_body_, first_in_body_;
    btDiscreteDynamicsWorld* world_ = nullptr;
    int group_ = 0, mask_ = 0; ///< of the user's body
    btVector3 gravity_{0, 0, 0};
    btCollisionShape* straight_; ///< the user's
    MemberOverhang over_;        ///< of that
    btScalar mass_;              ///< as the user made it
    btVector3 inertia_{0, 0, 0};
    std::unique_ptr<btCompoundShape> bent_; ///< of the user's body, once it is bent
};

} // namespace ductile::bullet
