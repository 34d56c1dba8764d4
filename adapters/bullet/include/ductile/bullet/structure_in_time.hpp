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
// as one body it has the shape without load. Bodies of the user's are not joined to it.
//
// Not thread-safe. World and Bullet's world must outlive this.
#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "ductile/bullet/divisible.hpp"
#include "ductile/bullet/passing_bodies.hpp"
#include "ductile/bullet/plastic_joint.hpp"
#include "ductile/bullet/world.hpp"
#include "ductile/structure/built_structure.hpp"
#include "ductile/structure/structure_course.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class StructureInTime final : public BuiltStructure, private Divisible {
  public:
    /// @throws std::invalid_argument as make_plan and StructureCourse, and where the world is a
    /// btMultiBodyDynamicsWorld.
    StructureInTime(World& world, const StructureModel& model);
    DUCTILE_INLINE ~StructureInTime() override;

    [[nodiscard]] DUCTILE_INLINE bool whole() const override { return course_.whole(); }
    [[nodiscard]] int open_joints() const noexcept { return course_.open_joints(); }
    /// Bodies that it is now.
    [[nodiscard]] std::vector<btRigidBody*> bodies() const;
    /// The one that has a body of a member, by its number from the start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] btRigidBody& body_of(std::string_view member, std::size_t piece = 0) const;
    /// What a joint carried in the last step that was looked at, on its body A [N | N m]: of open
    /// ones what the solve gave, of closed ones forces in equilibrium, of which a closed frame has
    /// many.
    /// @throws std::invalid_argument as StructurePlan::joint, and where it was removed.
    [[nodiscard]] Vector6<double> force(std::string_view member, MemberEnd end) const;
    [[nodiscard]] double plastic_travel(std::string_view member, MemberEnd end) const {
        return report(present_joint(plan().joint(member, end))).plastic_travel;
    }
    [[nodiscard]] bool is_open(std::string_view member, MemberEnd end) const {
        return course_.joint(present_joint(plan().joint(member, end))).open;
    }
    /// Share of the loads of a moving body that no forces in it carry, in the last look.
    [[nodiscard]] double left_over() const noexcept { return course_.left_over(); }

  private:
    using Joint = PlasticJoint<SectionJoint<double>>;
    struct OpenJoint {
        std::size_t joint;
        std::unique_ptr<btJointFeedback> feedback;
        std::unique_ptr<Joint> constraint;
    };
    [[nodiscard]] static Vector6<double> forces_of(const Joint& joint) {
        Vector6<double> six;
        for (const JointAxis axis : all_joint_axes)
            six[Eigen::Index(index(axis))] = joint.force(axis);
        return six;
    }
    struct Force {
        std::size_t body;
        Vector3<double> force, in_body;
    };

    [[nodiscard]] std::vector<PlacedBody> placed_clusters() const;
    [[nodiscard]] const OpenJoint* open_joint(std::size_t joint) const;
    void note_joints();
    void become(const StructureCourse::Change& change, bool ahead);
    [[nodiscard]] PieceBody make_cluster(std::size_t cluster, const btRigidBody* like);
    void make_joints(bool ahead);
    void let_neighbours_pass();
    [[nodiscard]] JointReport<double> report(std::size_t joint) const;
    [[nodiscard]] bool rests() const;
    void read_contact(const ContactTouch& touch, std::span<const BodyBefore> before);

    // ---- what BuiltStructure asks
    [[nodiscard]] DUCTILE_INLINE JointFrame<double> frame_of(const PlanSeat& seat) const override;
    [[nodiscard]] DUCTILE_INLINE const PairQueries& queries(std::size_t joint) const override {
        return *open_joint(joint)->constraint;
    }
    [[nodiscard]] DUCTILE_INLINE double utilisation_of(std::size_t joint) const override;
    [[nodiscard]] double absorbed_by(std::size_t joint) const override {
        return report(joint).absorbed_energy;
    }
    [[nodiscard]] double stored_by(std::size_t joint) const override {
        return open_joint(joint) != nullptr ? queries(joint).stored_energy()
                                            : course_.stored_by(joint);
    }
    DUCTILE_INLINE void push(const PlanSeat& seat, const Vector3<double>& force,
                             const Vector3<double>& at) override;
    DUCTILE_INLINE void drop_joint(std::size_t joint) override;
    DUCTILE_INLINE void drop_body(std::size_t body) override;
    DUCTILE_INLINE void wake() override;
    DUCTILE_INLINE void set_gravity(double factor) override;

    // ---- what the world asks
    [[nodiscard]] DUCTILE_INLINE std::span<const PieceBody> pieces() const override {
        return pieces_;
    }
    [[nodiscard]] DUCTILE_INLINE bool idle() const override { return false; }
    [[nodiscard]] DUCTILE_INLINE const void* key_of(const PlasticConstraint& joint,
                                                    int& section) const override;
    [[nodiscard]] DUCTILE_INLINE double closed_work() const override {
        return course_.closed_work();
    }
    [[nodiscard]] DUCTILE_INLINE double unmissed_work() const override {
        return course_.unmissed_work();
    }
    DUCTILE_INLINE void require_possible() const override {}
    DUCTILE_INLINE void leave() override { left_ = true; }
    DUCTILE_INLINE void apply_forces() override;
    DUCTILE_INLINE void drop_forces() override { forces_.clear(); }
    DUCTILE_INLINE void begin() override;
    DUCTILE_INLINE void touch(const ContactTouch& touch, double /*sum*/) override {
        touches_.push_back(touch);
    }
    DUCTILE_INLINE void sum_up(double /*dt*/) override {}
    [[nodiscard]] DUCTILE_INLINE bool touched() const override { return !touches_.empty(); }
    [[nodiscard]] DUCTILE_INLINE bool may_be_beyond(double dt, std::span<const BodyBefore> before,
                                                    const btVector3& gravity) const override;
    DUCTILE_INLINE void read(double dt, std::span<const BodyBefore> before,
                             const btVector3& gravity) override;
    DUCTILE_INLINE void find_beyond(double dt, std::vector<int>& sections) override;
    DUCTILE_INLINE void begin_blow() override {}
    DUCTILE_INLINE void find_struck(std::vector<int>& sections) override;
    DUCTILE_INLINE void open(std::span<const int> sections, bool ahead,
                             std::vector<DivisionChange>& told) override;
    double count_vibration() override { return 0; }
    DUCTILE_INLINE bool close_held(Closing when, bool ahead,
                                   std::vector<DivisionChange>& told) override;

    World& world_;
    btVector3 gravity_;
    StructureCourse course_;
    bool left_ = false;
    std::vector<DivisionReport> reports_;            ///< by joint
    std::vector<std::unique_ptr<btBoxShape>> boxes_; ///< by body
    std::vector<PieceBody> pieces_;                  ///< by cluster
    PassingBodies passing_;                          ///< of them; ends before they do
    std::vector<OpenJoint> joints_;
    std::vector<Force> forces_;
    // a tick
    std::vector<ClusterStep> steps_; ///< by cluster
    std::vector<ContactTouch> touches_;
    std::vector<BodyLoad> loads_;
    double struck_ = 0; ///< energy that contacts took [J]
    /// What sleeps on it, beside the gravity for which it is proved that it stays as it is.
    std::size_t proved_touches_ = 0;
    std::optional<btVector3> proved_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/structure_in_time.ipp"
#endif
