// SPDX-License-Identifier: MIT
//
// Bullet's bodies with their shapes, and plastic joints, for a recorder. A box, sphere, cylinder,
// capsule (as its cylinder and balls), plane and compounds of these are drawn as they are, another
// shape as the box around it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/bullet/bullet.hpp"
#include "recorder.hpp"

namespace ductile::replay {

[[nodiscard]] inline Pose pose_of(const btTransform& transform) {
    const btVector3& p = transform.getOrigin();
    const btQuaternion q = transform.getRotation();
    return {{double(p.x()), double(p.y()), double(p.z())},
            {double(q.w()), double(q.x()), double(q.y()), double(q.z())}};
}

namespace detail {

inline void add_shape(Body& body, const btCollisionShape& shape, const btTransform& in_body) {
    const auto add = [&](ShapeKind kind, double x, double y, double z, const btTransform& at) {
        body.shapes.push_back({kind, {x, y, z}, pose_of(at)});
    };
    const auto along = [&](const btVector3& axis) {
        const btQuaternion turn = shortestArcQuat(btVector3(0, 0, 1), axis);
        return in_body * btTransform(turn);
    };
    if (shape.isCompound()) {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i) {
            add_shape(body, *compound.getChildShape(i), in_body * compound.getChildTransform(i));
        }
        return;
    }
    btVector3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    switch (shape.getShapeType()) {
        case SPHERE_SHAPE_PROXYTYPE:
            add(ShapeKind::sphere, static_cast<const btSphereShape&>(shape).getRadius(), 0, 0,
                in_body);
            return;
        case CYLINDER_SHAPE_PROXYTYPE: {
            const auto& round = static_cast<const btCylinderShape&>(shape);
            const int axis = round.getUpAxis();
            add(ShapeKind::cylinder, round.getRadius(), round.getHalfExtentsWithMargin()[axis], 0,
                along(unit[axis]));
            return;
        }
        case CAPSULE_SHAPE_PROXYTYPE: {
            const auto& capsule = static_cast<const btCapsuleShape&>(shape);
            const btVector3& axis = unit[capsule.getUpAxis()];
            const btScalar half = capsule.getHalfHeight();
            add(ShapeKind::cylinder, capsule.getRadius(), half, 0, along(axis));
            for (const btScalar side : {btScalar(-1), btScalar(1)}) {
                btTransform end = in_body;
                end.setOrigin(in_body * (side * half * axis));
                add(ShapeKind::sphere, capsule.getRadius(), 0, 0, end);
            }
            return;
        }
        case STATIC_PLANE_PROXYTYPE: {
            const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
            constexpr double drawn = 50; // [m]
            btTransform at = along(plane.getPlaneNormal());
            at.setOrigin(in_body * (plane.getPlaneNormal() * plane.getPlaneConstant()));
            add(ShapeKind::plane, drawn, drawn, 0, at);
            return;
        }
        case EMPTY_SHAPE_PROXYTYPE:
            return;
        default:
            break;
    }
    btVector3 low, high;
    shape.getAabb(btTransform::getIdentity(), low, high);
    if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) {
        high = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
        low = -high;
    }
    const btVector3 half = (high - low) / 2;
    const btTransform at = in_body * btTransform(btQuaternion::getIdentity(), (high + low) / 2);
    add(ShapeKind::box, half.x(), half.y(), half.z(), at);
}

} // namespace detail

/// The body must live until it is removed from the recorder, or the recording is finished; one that
/// does not move stays where it is now.
inline void add_body(Recorder& recorder, const btRigidBody& body, std::string name) {
    Body drawn{.name = std::move(name), .shapes = {}, .moves = !body.isStaticObject()};
    detail::add_shape(drawn, *body.getCollisionShape(), btTransform::getIdentity());
    recorder.add(&body, std::move(drawn),
                 [&body] { return pose_of(body.getCenterOfMassTransform()); });
}

/// The joint must live as long, and be in the World by this name. Facts and life used:
/// joint_facts.hpp.
inline void add_joint(Recorder& recorder, const bullet::PlasticConstraint& joint, std::string name,
                      std::vector<Fact> facts = {}, std::function<double()> life = {}) {
    const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
    const Pose place = pose_of(a.getCenterOfMassTransform().inverse() * joint.view().frame_a);
    recorder.add({.name = std::move(name),
                  .a = recorder.number(&a),
                  .b = recorder.number(&b),
                  .in_a = place.position,
                  .facts = std::move(facts)},
                 joint.queries(), std::move(life));
}

} // namespace ductile::replay
