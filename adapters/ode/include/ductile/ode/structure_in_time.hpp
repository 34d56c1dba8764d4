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

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
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
#include "ductile/structure/divided_structure.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// A joint that flows, or did.
struct OpenJoint {
    std::size_t joint;
    std::unique_ptr<PlasticJoint<SectionJoint<double>>> constraint;
};

/// What it says of its joints: structure/divided_structure.hpp. All of it: structure_snapshot.hpp.
class StructureInTime final : public DividedStructure<OpenJoint>, private Divisible {
  public:
    /// `space`: where the geoms go; null: there are none.
    /// @throws std::invalid_argument as make_plan and StructureCourse, and where the World's solver
    /// is Solver::quick.
    StructureInTime(World& world, dSpaceID space, const StructureModel& model);
    DUCTILE_INLINE ~StructureInTime() override;

    [[nodiscard]] bool whole() const { return course_.whole(); }
    using DividedStructure::is_open;
    /// Bodies that it is now.
    [[nodiscard]] DUCTILE_INLINE std::vector<dBodyID> bodies() const override;
    /// The one that has a body of a member, by its number from the start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] dBodyID body_of(std::string_view member, std::size_t piece = 0) const;
    /// A joint of a body of it holds at a node, or at `share` of a member's axis, of the structure
    /// as it was made. To be called between steps.
    /// @throws std::invalid_argument as place(), and where the node is the ground's or the joint
    /// null.
    void attach(NodeId node, dJointID joint) { attach(point(node), joint); }
    void attach(std::string_view member, double share, dJointID joint) {
        attach(point(member, share), joint);
    }

  private:
    friend class StructureSnapshot;
    struct Hold : UserJoint {
        StructureHold at;
    };
    using Joint = PlasticJoint<SectionJoint<double>>;

    [[nodiscard]] dBodyID make_cluster(std::size_t cluster, dBodyID like);
    void end_body(dBodyID body);
    void attach(const Point& point, dJointID joint);
    [[nodiscard]] StructureHold hold_of(dJointID joint, std::size_t cluster) const;
    [[nodiscard]] bool is_there(const Hold& hold) const;
    void hand_over();
    [[nodiscard]] std::size_t cluster_on(dBodyID body) const {
        return std::size_t(std::find(bodies_.begin(), bodies_.end(), body) - bodies_.begin());
    }
    [[nodiscard]] bool held(std::size_t cluster) const { return course_.clusters()[cluster].held; }
    [[nodiscard]] bool rests(std::span<const Touch> touches) const;
    [[nodiscard]] std::size_t acting_holds() const {
        return std::size_t(std::count_if(holds_.begin(), holds_.end(),
                                         [](const Hold& hold) { return hold.acts; }));
    }
    [[nodiscard]] bool may_be_beyond(std::span<const Touch> touches) const;
    void read(double dt, std::span<Touch> touches);

    // ---- what DividedStructure asks
    [[nodiscard]] PlacedBody cluster_now(std::size_t cluster) const override {
        return {detail::frame_of(bodies_[cluster]), detail::motion_of(bodies_[cluster])};
    }
    void wake_cluster(std::size_t cluster) override {
        if (!held(cluster)) dBodyEnable(bodies_[cluster]);
    }
    DUCTILE_INLINE void become(const StructureCourse::Change& change, bool ahead) override;
    void rearranged() override {
        if (!left_) world_.members_->rearranged();
    }
    DUCTILE_INLINE void find_holds() override;
    DUCTILE_INLINE void wake() override;
    DUCTILE_INLINE void set_gravity(double factor) override;

    // ---- what the World asks
    void enter(World& /*world*/) override {}
    void leave() override { left_ = true; }
    void body_left(dBodyID /*body*/) override {}
    void body_came(dBodyID /*body*/) override {}
    [[nodiscard]] bool is_open() const override { return !whole(); }
    [[nodiscard]] std::vector<DivisionReport> reports(const std::string& /*name*/) const override {
        return reports_;
    }
    [[nodiscard]] int section_of(const PlasticConstraint& joint) const override {
        const auto index = index_of(joint);
        return index ? int(*index) : no_section;
    }
    [[nodiscard]] const void* key_of(int section) const override {
        return DividedStructure::key_of(std::size_t(section));
    }
    [[nodiscard]] DUCTILE_INLINE bool hangs_together(dBodyID a, dBodyID b) const override;
    [[nodiscard]] DUCTILE_INLINE bool holds(dBodyID own, dBodyID other) const override;
    [[nodiscard]] double closed_work() const override { return course_.closed_work(); }
    [[nodiscard]] double unmissed_work() const override { return course_.unmissed_work(); }
    DUCTILE_INLINE void require_possible() override;
    DUCTILE_INLINE void apply_forces() override;
    void drop_forces() override { forces_.clear(); }
    DUCTILE_INLINE void before_solve(std::vector<dJointID>& joints) override;
    void driven_through() override { driven_through_ = true; }
    DUCTILE_INLINE void after_solve() override;
    DUCTILE_INLINE void find_beyond(double dt, std::span<Touch> touches,
                                    std::vector<int>& sections) override;
    void begin_blow(double noticed) override { expect_blow(noticed); }
    DUCTILE_INLINE bool switch_holds(bool on) override;
    DUCTILE_INLINE void see_coming() override;
    DUCTILE_INLINE void find_struck(double dt, std::span<Touch> touches,
                                    std::vector<int>& sections) override;
    DUCTILE_INLINE void open(std::span<const int> sections, bool ahead) override;
    [[nodiscard]] dBodyID body_of(int body) const override {
        return bodies_[course_.cluster_of(std::size_t(body))];
    }
    double count_vibration() override { return 0; }
    DUCTILE_INLINE std::vector<int> close_held(Closing when, bool ahead) override;

    World& world_;
    Vector3<double> gravity_; ///< at which it was made [m/s²]
    bool left_ = false;
    std::vector<dGeomID> boxes_;       ///< by body of the plan; null: none
    std::vector<dBodyID> bodies_;      ///< by cluster
    std::vector<PieceCourse> courses_; ///< of a step
    PressedTouches pressed_;           ///< of those that are held
    std::vector<Hold> holds_;
    std::vector<std::pair<dJointID, StructureHold>> told_; ///< which places joints hold
    std::size_t proved_touches_ = 0;                       ///< with joints that held
    std::optional<Vector3<double>>
        proved_; ///< gravity at which it is proved that it stays as it is
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/structure_in_time.ipp"
#endif
