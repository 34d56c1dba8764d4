// SPDX-License-Identifier: MIT
//
// Bodies and shapes of a member's pieces, and the user's body in and out of its world.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <vector>

#include "ductile/member/divided_member.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

using ductile::MemberBox;

/// Friction, restitution, damping, factors, flags and the user's pointers of one body for another.
void copy_manners(const btRigidBody& from, btRigidBody& body);
void set_motion(btRigidBody& body, const BodyMotion& motion);

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
    void take_out();
    /// It is the member again, in the world: as it was at first where that is `straight`.
    void put_whole(const PlacedPiece& placed, bool straight);
    /// A piece in the world; the ground itself of a held segment alone.
    [[nodiscard]] PieceBody make(const PlacedPiece& placed);

  private:
    void find_overhang();
    [[nodiscard]] std::unique_ptr<btCompoundShape> make_shape(const MemberPiece& piece);
    void enter_world(btRigidBody& body) const;

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

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/piece_maker.ipp"
#endif
