// SPDX-License-Identifier: MIT
//
// A bar that holds its length below its axial strength, stretches or shortens at it, keeps the change
// and breaks: five rigid rows and one plastic row along the z axis of frame B. See
// one_axis_constraint.hpp for signs, committing and Bullet's traps.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <LinearMath/btQuaternion.h>

#include <utility>

#include "ductile/bullet/one_axis_constraint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"

namespace ductile::bullet {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticSlider final : public OneAxisConstraint<Joint> {
    using Base = OneAxisConstraint<Joint>;
    using typename Base::Geometry;
    using Info = btTypedConstraint::btConstraintInfo2;

  public:
    /// Frames are in the bodies' centre-of-mass frames; z along the bar, parallel axes at rest. Where
    /// the bodies are now is the bar's rest position.
    PlasticSlider(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                  const btTransform& frame_in_b, Joint joint)
        : Base(a, b, frame_in_a, frame_in_b, std::move(joint)) {
        Base::start();
    }

    /// Bar between a body and the static world.
    PlasticSlider(btRigidBody& a, const btTransform& frame_in_a, Joint joint)
        : PlasticSlider(a, btTypedConstraint::getFixedBody(), frame_in_a,
                        a.getCenterOfMassTransform() * frame_in_a, std::move(joint)) {}

    /// Change of length: A's displacement along the axis relative to B [m].
    [[nodiscard]] double elongation() { return Base::position(); }
    /// Accumulated plastic elongation p, work-conjugate [m].
    [[nodiscard]] double plastic_elongation() { return Base::plastic_travel(); }
    /// Force along the axis in the last tick, positive where it pushes A along +axis [N].
    [[nodiscard]] double force() { return Base::reaction(); }

  private:
    [[nodiscard]] bool turns() const noexcept override { return false; }

    [[nodiscard]] double measure(const Geometry& geometry, double /*predicted*/) const override {
        return double(geometry.axis.dot(offset(geometry)));
    }

    void write_rigid(Info& info, const Geometry& geometry, btScalar rate) override {
        const btMatrix3x3& basis = geometry.frame_b.getBasis();
        const btVector3 turned = turn(geometry);
        for (int i = 0; i < 3; ++i) {
            const btVector3 direction = basis.getColumn(i);
            Base::write_moment_row(info, i, direction, -rate * turned.dot(direction));
        }
        for (int i = 0; i < 2; ++i) {
            const btVector3 direction = basis.getColumn(i);
            Base::write_force_row(info, 3 + i, geometry, direction,
                                  -rate * offset(geometry).dot(direction));
        }
    }

    static btVector3 offset(const Geometry& geometry) noexcept {
        return geometry.frame_a.getOrigin() - geometry.frame_b.getOrigin();
    }

    /// Rotation vector that takes frame B to frame A, world axes [rad].
    static btVector3 turn(const Geometry& geometry) noexcept {
        btQuaternion q = geometry.frame_a.getRotation() * geometry.frame_b.getRotation().inverse();
        if (q.w() < 0) q = -q;
        const btVector3 axis(q.x(), q.y(), q.z());
        const btScalar sine = axis.length();
        return sine > SIMD_EPSILON ? axis * (2 * btAtan2(sine, q.w()) / sine) : 2 * axis;
    }
};

} // namespace ductile::bullet
