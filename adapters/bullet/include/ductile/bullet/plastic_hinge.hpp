// SPDX-License-Identifier: MIT
//
// A hinge that holds rigidly below its plastic moment, turns at it, keeps the turn and breaks.
//
//   ductile::bullet::PlasticHinge hinge(left, right, frame_in_left, frame_in_right,
//                                       ductile::OneAxisJoint(ductile::Perfect<double>({.strength = 64})));
//   hinge.add_to(world);
//
// Five rigid rows and one plastic row about the z axis of frame B; see one_axis_constraint.hpp for
// signs, committing and Bullet's traps. Angles are not wrapped: the hinge may turn many times, as
// long as it turns less than π in one step.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <LinearMath/btTransformUtil.h>

#include <cmath>
#include <utility>

#include "ductile/bullet/one_axis_constraint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/vocabulary/angle.hpp"

namespace ductile::bullet {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticHinge final : public OneAxisConstraint<Joint> {
    using Base = OneAxisConstraint<Joint>;
    using typename Base::Geometry;
    using Info = btTypedConstraint::btConstraintInfo2;

  public:
    /// Frames are in the bodies' centre-of-mass frames, as for btHingeConstraint: origin at the
    /// pivot, z along the hinge. Where the bodies are now is the hinge's rest position.
    PlasticHinge(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                 const btTransform& frame_in_b, Joint joint)
        : Base(a, b, frame_in_a, frame_in_b, std::move(joint)) {
        Base::start();
    }

    /// Hinge between a body and the static world.
    PlasticHinge(btRigidBody& a, const btTransform& frame_in_a, Joint joint)
        : PlasticHinge(a, btTypedConstraint::getFixedBody(), frame_in_a,
                       a.getCenterOfMassTransform() * frame_in_a, std::move(joint)) {}

    /// Angle of A relative to B about the axis, not wrapped [rad].
    [[nodiscard]] double rotation() { return Base::position(); }
    /// Accumulated plastic rotation p, work-conjugate [rad].
    [[nodiscard]] double plastic_rotation() { return Base::plastic_travel(); }
    /// Moment about the axis in the last tick, positive where it turns A about +axis [N m].
    [[nodiscard]] double moment() { return Base::reaction(); }

  private:
    [[nodiscard]] bool turns() const noexcept override { return true; }

    [[nodiscard]] double measure(const Geometry& geometry, double predicted) const override {
        const btMatrix3x3 relative = geometry.frame_b.getBasis().transposeTimes(
            geometry.frame_a.getBasis());
        return unwrap(std::atan2(double(relative[1][0]), double(relative[0][0])), predicted);
    }

    void write_rigid(Info& info, const Geometry& geometry, btScalar rate) override {
        const btVector3 gap = geometry.frame_b.getOrigin() - geometry.frame_a.getOrigin();
        const btMatrix3x3& basis = geometry.frame_b.getBasis();
        const btVector3 tilt = geometry.frame_a.getBasis().getColumn(2).cross(geometry.axis);
        for (int i = 0; i < 3; ++i) {
            const btVector3 direction = basis.getColumn(i);
            Base::write_force_row(info, i, geometry, direction, rate * gap.dot(direction));
        }
        for (int i = 0; i < 2; ++i) {
            const btVector3 direction = basis.getColumn(i);
            Base::write_moment_row(info, 3 + i, direction, rate * tilt.dot(direction));
        }
    }
};

} // namespace ductile::bullet
