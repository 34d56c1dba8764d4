// SPDX-License-Identifier: MIT
//
// A StructureModel in an ODE world as one rigid body: kinematic where it stands on supports. Joints
// open where they would have to carry more than they can, there and in that very step
// (structure/structure_course.hpp), and it is one body again, bent, where nothing flows.
//
//   StructureModel model({.elastic = false});
//   ...
//   ductile::ode::World world(id, {.tolerance = 0.01});
//   ductile::ode::StructureInTime frame(world, space, model);
//   world.step(dt);
//   frame.bodies();                        // one
//   frame.remove("column 00");
//   frame.open_joints();
//
// What may be asked of it and done to it is as of Structure, but for the engine's joints and
// bodies, which come and go: keep none. Events name the joint, as in Structure, with split and
// fused beside yielded and broke. Geoms stay: each goes with the body that has its member.
//
// Contacts have to be named (World::add_contact), which leaves out those of members that hang
// together or meet at a node.
//
// An elastic one opens where the elastic frame yields, and then swings as that does until it rests;
// as one body it has the shape without load.
//
// What holds on to it. The user's joints go to the body that has the member where they hold,
// anchors, axes and angle as they are: balls and hinges by their anchor, which finds the nearest
// member, or by `attach`, what has no anchor by `attach` alone; joints of other kinds are refused.
// Give them to `bodies()` or `body_of` when they are made. What they hold and what of the structure
// hangs together with it do not collide. A joint on a member that is removed holds nothing more.
//
// Not thread-safe. World, ODE's world and the space must outlive this.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/ode/divisible.hpp"
#include "ductile/ode/members.hpp"
#include "ductile/ode/piece.hpp"
#include "ductile/ode/plastic_joint.hpp"
#include "ductile/ode/user_joint.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/structure/stepped_structure.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// A joint that flows, or did.
struct OpenJoint {
    std::size_t joint;
    std::unique_ptr<PlasticJoint<SectionJoint<double>>> constraint;
};

/// As structure/stepped_structure.hpp wants it.
struct StructureParts {
    using Divisible = ode::Divisible;
    using Joint = PlasticConstraint;
    using OpenJoint = ode::OpenJoint;
    using Body = dBodyID;
    using Piece = dBodyID;
    using Hold = UserJoint;
    using Holder = dJointID;
    using Touches = std::span<Touch>;
    [[nodiscard]] static Body body(dBodyID piece) { return piece; }
    [[nodiscard]] static bool is_asleep(const Touch& touch) {
        return !detail::is_solved(touch.bodies.a) && !detail::is_solved(touch.bodies.b);
    }
};

/// What it says of its joints: structure/divided_structure.hpp. All of it: structure_snapshot.hpp.
class StructureInTime final : public SteppedStructure<StructureParts> {
  public:
    /// `space`: where the geoms go; null: there are none.
    /// @throws std::invalid_argument as make_plan and StructureCourse, and where the World's solver
    /// is Solver::quick.
    StructureInTime(World& world, dSpaceID space, const StructureModel& model);
    DUCTILE_INLINE ~StructureInTime() override;

    /// Bodies that it is now.
    [[nodiscard]] std::vector<dBodyID> bodies() const override { return pieces_; }
    /// The one that has a body of a member, by its number from the start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] dBodyID body_of(std::string_view member, std::size_t piece = 0) const {
        return body(member, piece);
    }

  private:
    friend class StructureSnapshot;
    void end_boxes();
    [[nodiscard]] StructureHold hold_of(dJointID joint, std::size_t cluster) const;
    [[nodiscard]] bool is_there(const Hold& hold) const;

    // ---- what SteppedStructure asks
    [[nodiscard]] DUCTILE_INLINE dBodyID make_piece(std::size_t cluster, dBodyID like) override;
    DUCTILE_INLINE void end_piece(dBodyID& piece) override;
    [[nodiscard]] DUCTILE_INLINE OpenJoint make_joint(std::size_t joint, std::size_t a,
                                                      const JointFrame<double>& in_a,
                                                      std::optional<std::size_t> b,
                                                      const JointFrame<double>& in_b) override;
    DUCTILE_INLINE void enter_joint(OpenJoint& open, bool ahead) override;
    DUCTILE_INLINE void hold_on(const StructureHold& at, dJointID joint) override;
    DUCTILE_INLINE void hand_over() override;
    DUCTILE_INLINE void add_force(std::size_t cluster, const Vector3<double>& force,
                                  const Vector3<double>& at) override;
    [[nodiscard]] bool was_solved(std::size_t cluster) const override {
        return courses_[cluster].solved;
    }
    [[nodiscard]] DUCTILE_INLINE ClusterStep step_of(std::size_t cluster,
                                                     const Vector3<double>& gravity,
                                                     double dt) const override;
    DUCTILE_INLINE double read_touches(double dt) override;
    [[nodiscard]] bool was_solved(const OpenJoint& open) const override {
        return open.constraint->is_awake_member();
    }
    [[nodiscard]] DUCTILE_INLINE std::optional<Wrench> given(const OpenJoint& open,
                                                             bool to_a) const override;
    [[nodiscard]] PlacedBody cluster_now(std::size_t cluster) const override {
        return {detail::frame_of(body(cluster)), detail::motion_of(body(cluster))};
    }
    void wake_cluster(std::size_t cluster) override {
        if (!held(cluster)) dBodyEnable(body(cluster));
    }
    void rearranged() override {
        if (!left_) world_.members_->rearranged();
    }
    DUCTILE_INLINE void find_holds() override;
    DUCTILE_INLINE void wake() override;
    DUCTILE_INLINE void set_gravity(double factor) override;

    // ---- what the World asks
    [[nodiscard]] std::vector<DivisionReport> reports(const std::string& /*name*/) const override {
        return reports_;
    }
    [[nodiscard]] DUCTILE_INLINE bool hangs_together(dBodyID a, dBodyID b) const override;
    [[nodiscard]] DUCTILE_INLINE bool holds(dBodyID own, dBodyID other) const override;
    DUCTILE_INLINE void require_possible() override;
    DUCTILE_INLINE void before_solve(std::vector<dJointID>& joints) override;
    DUCTILE_INLINE void after_solve() override;
    DUCTILE_INLINE void find_beyond(double dt, std::span<Touch> touches,
                                    std::vector<int>& sections) override;
    DUCTILE_INLINE void find_struck(double dt, std::span<Touch> touches,
                                    std::vector<int>& sections) override;
    [[nodiscard]] dBodyID body_of(int body) const override {
        return this->body(course_.cluster_of(std::size_t(body)));
    }

    World& world_;
    Vector3<double> gravity_;                              ///< at which it was made [m/s²]
    std::vector<dGeomID> boxes_;                           ///< by body of the plan; null: none
    std::vector<PieceCourse> courses_;                     ///< of a step
    PressedTouches pressed_;                               ///< of those that are held
    std::vector<std::pair<dJointID, StructureHold>> told_; ///< which places joints hold
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/structure_in_time.ipp"
#endif
