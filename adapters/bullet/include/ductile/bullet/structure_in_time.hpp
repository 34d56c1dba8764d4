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
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/bullet/attachment.hpp"
#include "ductile/bullet/divisible.hpp"
#include "ductile/bullet/members.hpp"
#include "ductile/bullet/passing_bodies.hpp"
#include "ductile/bullet/plastic_joint.hpp"
#include "ductile/bullet/world.hpp"
#include "ductile/structure/divided_structure.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// A joint that flows, or did.
struct OpenJoint {
    std::size_t joint;
    std::unique_ptr<btJointFeedback> feedback; ///< ends after the joint
    std::unique_ptr<PlasticJoint<SectionJoint<double>>> constraint;
};

/// What it says of its joints: structure/divided_structure.hpp. All of it: structure_snapshot.hpp.
class StructureInTime final : public DividedStructure<OpenJoint>, private Divisible {
  public:
    /// @throws std::invalid_argument as make_plan and StructureCourse, and where the world is a
    /// btMultiBodyDynamicsWorld.
    StructureInTime(World& world, const StructureModel& model);
    DUCTILE_INLINE ~StructureInTime() override;

    [[nodiscard]] bool whole() const override { return course_.whole(); }
    /// Bodies that it is now.
    [[nodiscard]] std::vector<btRigidBody*> bodies() const;
    /// The one that has a body of a member, by its number from the start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] btRigidBody& body_of(std::string_view member, std::size_t piece = 0) const;
    /// Makes a constraint between a body of the structure and another; `place`: in that body, axes
    /// that were the world's when the structure was made.
    using Maker = Attachment::Maker;
    /// A constraint at a node, or at `share` of a member's axis, of the structure as it was made,
    /// now and whenever bodies change. To be called between steps.
    /// @throws std::invalid_argument as place(), and where the node is the ground's, nothing is
    /// made, or no other body is held.
    void attach(NodeId node, Maker maker) { attach(point(node), std::move(maker)); }
    void attach(std::string_view member, double share, Maker maker) {
        attach(point(member, share), std::move(maker));
    }

  private:
    friend class StructureSnapshot;
    struct Hold : Attachment {
        StructureHold at;
    };
    using Joint = PlasticJoint<SectionJoint<double>>;
    [[nodiscard]] PieceBody make_cluster(std::size_t cluster, const btRigidBody* like);
    void attach(const Point& point, Maker maker);
    void make(Hold& hold);
    [[nodiscard]] btRigidBody& body_of(const StructureHold& hold) const {
        return *pieces_[course_.cluster_of(hold.body)].body;
    }
    void let_pass();
    [[nodiscard]] std::size_t broken_joints() const;
    [[nodiscard]] std::size_t acting_holds() const;
    [[nodiscard]] bool rests() const;
    void read_contact(const ContactTouch& touch, std::span<const BodyBefore> before);

    // ---- what DividedStructure asks
    [[nodiscard]] DUCTILE_INLINE PlacedBody cluster_now(std::size_t cluster) const override;
    void wake_cluster(std::size_t cluster) override { pieces_[cluster].body->activate(); }
    DUCTILE_INLINE void become(const StructureCourse::Change& change, bool ahead) override;
    void rearranged() override {
        if (!left_) world_.rearranged(*this);
    }
    DUCTILE_INLINE void wake() override;
    DUCTILE_INLINE void set_gravity(double factor) override;

    // ---- what the world asks
    [[nodiscard]] std::span<const PieceBody> pieces() const override { return pieces_; }
    [[nodiscard]] bool idle() const override { return false; }
    [[nodiscard]] DUCTILE_INLINE const void* key_of(const PlasticConstraint& joint,
                                                    int& section) const override;
    [[nodiscard]] double closed_work() const override { return course_.closed_work(); }
    [[nodiscard]] double unmissed_work() const override { return course_.unmissed_work(); }
    DUCTILE_INLINE void require_possible() const override;
    DUCTILE_INLINE void require_attached(const btTypedConstraint& constraint) const override;
    [[nodiscard]] bool is_held() const override { return !holds_.empty(); }
    DUCTILE_INLINE void list_holds(std::vector<const btTypedConstraint*>& list) const override;
    void leave() override { left_ = true; }
    DUCTILE_INLINE void apply_forces() override;
    void drop_forces() override { forces_.clear(); }
    void driven_through() override { driven_through_ = true; }
    void begin() override {
        course_.begin_step();
        driven_through_ = false;
        touches_.clear();
    }
    void touch(const ContactTouch& touch, double /*sum*/) override { touches_.push_back(touch); }
    void sum_up(double /*dt*/) override {}
    [[nodiscard]] bool touched() const override { return !touches_.empty() || !holds_.empty(); }
    [[nodiscard]] DUCTILE_INLINE bool may_be_beyond(double dt, std::span<const BodyBefore> before,
                                                    const btVector3& gravity) const override;
    DUCTILE_INLINE void read(double dt, std::span<const BodyBefore> before,
                             const btVector3& gravity) override;
    DUCTILE_INLINE void find_beyond(double dt, std::vector<int>& sections) override;
    void begin_blow(double noticed) override { expect_blow(noticed); }
    DUCTILE_INLINE bool switch_holds_off() override;
    DUCTILE_INLINE void see_coming() override;
    DUCTILE_INLINE void find_struck(std::vector<int>& sections) override;
    DUCTILE_INLINE void open(std::span<const int> sections, bool ahead,
                             std::vector<DivisionChange>& told) override;
    double count_vibration() override { return 0; }
    DUCTILE_INLINE bool close_held(Closing when, bool ahead,
                                   std::vector<DivisionChange>& told) override;

    World& world_;
    btVector3 gravity_;
    bool left_ = false;
    std::vector<std::unique_ptr<btBoxShape>> boxes_; ///< by body
    std::vector<PieceBody> pieces_;                  ///< by cluster
    PassingBodies passing_;                          ///< of them; ends before they do
    std::vector<Hold> holds_;
    std::size_t broken_ = 0;            ///< joints, when that was last told
    std::vector<ContactTouch> touches_; ///< of a tick
    double struck_ = 0;                 ///< energy that contacts took in it [J]
    MemberStrike by_joints_;            ///< the same of the user's joints
    /// What sleeps on it and what holds on to it, beside the gravity for which it is proved that it
    /// stays as it is.
    std::size_t proved_touches_ = 0;
    std::optional<btVector3> proved_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/structure_in_time.ipp"
#endif
