// SPDX-License-Identifier: MIT
//
// A StructureModel in an ODE world: its bodies, geoms and joints, made, owned and taken away.
//
//   ductile::ode::World world(id, {});
//   ductile::ode::Structure frame(world, space, model);
//   world.step(dt);
//   frame.joint("column 2", MemberEnd::start).utilisation();
//   frame.sag(node);
//
// Bodies are at rest where the model has them. ODE leaves collisions to the user's callback: `meet`
// says which pairs of geoms touch each other for ever, as they are jointed or meet at a node.
//
// To a node may hang a body of the user's: `own` names it, and it is jointed as a support is.
//
// Not thread-safe. World, ODE's world, the space and the user's bodies must outlive this.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "ductile/ode/plastic_joint.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/structure/built_structure.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

using OwnBody = UsersBody<dBodyID>;

class Structure final
    : public JointedStructure<World, PlasticJoint<SectionJoint<double>>, dBodyID> {
  public:
    /// `space`: where the geoms go; null: there are none.
    /// @throws std::invalid_argument as make_plan, and where a body of `own` is null.
    Structure(World& world, dSpaceID space, const StructureModel& model,
              const std::vector<OwnBody>& own = {});
    DUCTILE_INLINE ~Structure();

    /// A body of a member, by its number from the start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] dBodyID body(std::string_view member, std::size_t piece = 0) const;
    [[nodiscard]] dBodyID body(std::size_t index) const override { return parts_[index].body; }

    /// True where two bodies (null: the static world) are jointed or meet at a node, so that their
    /// geoms are not to collide.
    [[nodiscard]] bool meet(dBodyID a, dBodyID b) const;

  private:
    struct Part {
        dBodyID body = nullptr;
        dGeomID box = nullptr;
    };

    void make_body(const PlanBody& plan, dSpaceID space);
    void make_joint(const PlanJoint& plan);

    [[nodiscard]] DUCTILE_INLINE JointFrame<double> frame_of(const PlanSeat& seat) const override;
    DUCTILE_INLINE void push(const PlanSeat& seat, const Vector3<double>& force,
                             const Vector3<double>& at) override;
    DUCTILE_INLINE void drop_body(std::size_t body) override;
    DUCTILE_INLINE void wake() override;
    DUCTILE_INLINE void set_gravity(double factor) override;

    Vector3<double> gravity_;
    std::vector<Part> parts_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/structure.ipp"
#endif
