// SPDX-License-Identifier: MIT
//
// A StructureModel in a Bullet world: its bodies, shapes and joints, made, owned and taken away.
//
//   ductile::bullet::World world(dynamics);
//   ductile::bullet::Structure frame(world, model);
//   world.step(dt);
//   frame.joint("column 2", MemberEnd::start).utilisation();
//   frame.sag(node);
//
// Bodies are at rest where the model has them. They collide with all but those that meet them at a
// node; two that a joint joins collide once that broke.
//
// To a node may hang a body of the user's: `own` names it, and it is jointed as a support is.
//
// Not thread-safe. World, Bullet's world and the user's bodies must outlive this.
#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "ductile/bullet/plastic_joint.hpp"
#include "ductile/bullet/world.hpp"
#include "ductile/structure/built_structure.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

using OwnBody = UsersBody<btRigidBody*>;

class Structure final
    : public JointedStructure<World, PlasticJoint<SectionJoint<double>>, btRigidBody*> {
  public:
    /// @throws std::invalid_argument as make_plan, and where a body of `own` is null.
    Structure(World& world, const StructureModel& model, const std::vector<OwnBody>& own = {});
    DUCTILE_INLINE ~Structure();

    /// A body of a member, by its number from the start.
    /// @throws std::invalid_argument as StructurePlan::body, and where it was removed.
    [[nodiscard]] btRigidBody& body(std::string_view member, std::size_t piece = 0) const;
    [[nodiscard]] btRigidBody* body(std::size_t index) const override {
        return parts_[index].body.get();
    }

  private:
    struct Part {
        std::unique_ptr<btBoxShape> box;
        std::unique_ptr<btCompoundShape> around; ///< where the box is not about the centre of mass
        std::unique_ptr<btRigidBody> body;
    };

    void make_body(const PlanBody& plan);
    void make_joint(const PlanJoint& plan);

    [[nodiscard]] DUCTILE_INLINE JointFrame<double> frame_of(const PlanSeat& seat) const override;
    DUCTILE_INLINE void push(const PlanSeat& seat, const Vector3<double>& force,
                             const Vector3<double>& at) override;
    DUCTILE_INLINE void drop_body(std::size_t body) override;
    DUCTILE_INLINE void wake() override;
    DUCTILE_INLINE void set_gravity(double factor) override;

    btVector3 gravity_;
    std::vector<Part> parts_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/structure.ipp"
#endif
