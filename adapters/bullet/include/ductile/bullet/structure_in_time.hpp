// SPDX-License-Identifier: MIT
//
// A StructureModel in a Bullet world as one rigid body: static where it stands on supports. Joints
// open where they would have to carry more than they can, there and in that very step
// (structure/structure_course.hpp), and it is one body again, bent, where nothing flows.
//
//   StructureModel model({.elastic = false});
//   ...
//   ductile::bullet::World world(dynamics);
//   ductile::bullet::StructureInTime frame(world, model);
//   world.step(dt);
//   frame.bodies();                        // one
//   frame.remove("column 00");
//   frame.open_joints();
//
// What may be asked of it and done to it is as of Structure, but for the engine's joints and
// bodies, which come and go: keep none. Events name the joint, as in Structure, with split and
// fused beside yielded and broke.
//
// An elastic one opens where the elastic frame yields, and then swings as that does until it rests;
// as one body it has the shape without load.
//
// What holds on to it. Constraints cannot change their bodies in Bullet: `attach` makes them anew
// for the body that has the member where they hold; a step with others is refused. What they hold
// and what of the structure hangs together with it do not collide. A constraint on a member that is
// removed ends.
//
// Not thread-safe. World and Bullet's world must outlive this.
#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/bullet/attachment.hpp"
#include "ductile/bullet/divisible.hpp"
#include "ductile/bullet/members.hpp"
#include "ductile/bullet/passing_bodies.hpp"
#include "ductile/bullet/plastic_joint.hpp"
#include "ductile/bullet/world.hpp"
#include "ductile/structure/stepped_structure.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// A joint that flows, or did.
struct OpenJoint {
    std::size_t joint;
    std::unique_ptr<btJointFeedback> feedback; ///< ends after the joint
    std::unique_ptr<PlasticJoint<SectionJoint<double>>> constraint;
};

/// As structure/stepped_structure.hpp wants it.
struct StructureParts {
    using Divisible = bullet::Divisible;
    using Joint = PlasticConstraint;
    using OpenJoint = bullet::OpenJoint;
    using Body = btRigidBody*;
    using Piece = PieceBody;
    using Hold = Attachment;
    using Holder = Attachment::Maker;
    using Touches = std::vector<ContactTouch>;
    [[nodiscard]] static Body body(const Piece& piece) { return piece.body; }
    [[nodiscard]] static bool is_asleep(const ContactTouch& touch) { return touch.asleep; }
};

/// What it says of its joints: structure/divided_structure.hpp. All of it: structure_snapshot.hpp.
class StructureInTime final : public SteppedStructure<StructureParts> {
  public:
    /// @throws std::invalid_argument as make_plan and StructureCourse, and where the world is a
    /// btMultiBodyDynamicsWorld.
    StructureInTime(World& world, const StructureModel& model);
    DUCTILE_INLINE ~StructureInTime() override;

    /// Bodies that it is now.
    [[nodiscard]] std::vector<btRigidBody*> bodies() const;
    /// The one that has a body of a member, by its number from the start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] btRigidBody& body_of(std::string_view member, std::size_t piece = 0) const {
        return *body(member, piece);
    }
    /// What `attach` is given: makes a constraint between a body of the structure and another;
    /// `place`: in that body, axes that were the world's when the structure was made. Refused where
    /// nothing is made, or no other body is held.
    using Maker = Attachment::Maker;

  private:
    friend class StructureSnapshot;
    void make(Hold& hold);

    // ---- what SteppedStructure asks
    [[nodiscard]] DUCTILE_INLINE PieceBody make_piece(std::size_t cluster,
                                                      btRigidBody* like) override;
    void end_piece(PieceBody& piece) override { world_.engine().removeRigidBody(piece.body); }
    [[nodiscard]] DUCTILE_INLINE OpenJoint make_joint(std::size_t joint, std::size_t a,
                                                      const JointFrame<double>& in_a,
                                                      std::optional<std::size_t> b,
                                                      const JointFrame<double>& in_b) override;
    DUCTILE_INLINE void enter_joint(OpenJoint& open, bool ahead) override;
    DUCTILE_INLINE void hold_on(const StructureHold& at, Maker maker) override;
    DUCTILE_INLINE void hand_over() override;
    void hold_again() override {
        for (Hold& hold : holds_) make(hold);
    }
    DUCTILE_INLINE void let_pass() override;
    DUCTILE_INLINE void add_force(std::size_t cluster, const Vector3<double>& force,
                                  const Vector3<double>& at) override;
    [[nodiscard]] bool was_solved(std::size_t cluster) const override {
        return !body(cluster)->isStaticObject() && body(cluster)->isActive();
    }
    [[nodiscard]] DUCTILE_INLINE ClusterStep step_of(std::size_t cluster,
                                                     const Vector3<double>& gravity,
                                                     double dt) const override;
    DUCTILE_INLINE double read_touches(double dt) override;
    [[nodiscard]] bool was_solved(const OpenJoint& open) const override {
        return open.constraint->isEnabled();
    }
    [[nodiscard]] DUCTILE_INLINE std::optional<Wrench> given(const OpenJoint& open,
                                                             bool to_a) const override;
    [[nodiscard]] DUCTILE_INLINE PlacedBody cluster_now(std::size_t cluster) const override;
    void wake_cluster(std::size_t cluster) override { body(cluster)->activate(); }
    void rearranged() override {
        if (!left_) world_.rearranged(*this);
    }
    DUCTILE_INLINE void wake() override;
    DUCTILE_INLINE void set_gravity(double factor) override;

    // ---- what the world asks
    [[nodiscard]] std::span<const PieceBody> all_pieces() const override { return pieces_; }
    [[nodiscard]] bool idle() const override { return false; }
    DUCTILE_INLINE void require_possible() const override;
    DUCTILE_INLINE void require_attached(const btTypedConstraint& constraint) const override;
    [[nodiscard]] bool is_held() const override { return !holds_.empty(); }
    void begin() override {
        begin_step();
        touches_.clear();
    }
    void touch(const ContactTouch& touch, double /*sum*/) override { touches_.push_back(touch); }
    void sum_up(double /*dt*/) override {}
    [[nodiscard]] bool touched() const override { return !touches_.empty() || is_held(); }
    [[nodiscard]] DUCTILE_INLINE double most_share(double dt, std::span<const BodyBefore> before,
                                                   const btVector3& gravity) const override;
    DUCTILE_INLINE void find_beyond(double dt, std::span<const BodyBefore> before,
                                    const btVector3& gravity, std::vector<int>& sections) override;
    DUCTILE_INLINE void find_struck(double dt, std::span<const BodyBefore> before,
                                    const btVector3& gravity, std::vector<int>& sections) override;

    World& world_;
    btVector3 gravity_;
    std::vector<std::unique_ptr<btBoxShape>> boxes_; ///< by body
    PassingBodies passing_;                          ///< ends before its bodies do
    std::span<const BodyBefore> before_;             ///< of the tick that is looked at
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/structure_in_time.ipp"
#endif
