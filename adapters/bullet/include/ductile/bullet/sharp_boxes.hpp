// SPDX-License-Identifier: MIT
//
// How far two shapes are apart as Bullet's own contacts have it. Its closest points round the edges
// of a box by its margin r, 4 cm, and its contacts of boxes do not: an edge on a face that is
// tilted by θ would be r θ apart while it touches, 1.2 mm of a deck that hangs by 0.03 rad over
// the edge of its support.
//
//   gap of two boxes = n·x_A - n·x_B along the normal n of their closest points, x the farthest
//   point of each towards the other
//
// n is that of the sharp boxes wherever a face or two edges meet; between two corners the gap is
// too small, and grows right as they come near. All other pairs are left as they are, as Bullet
// rounds them in its contacts too: a ball that hits two boxes in a line where they meet pushes them
// apart. A small btBoxShape::setMargin makes such edges sharp.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

#include <algorithm>

namespace ductile::bullet {

/// By how much closest points may have two shapes farther apart than they are, of one of them [m].
[[nodiscard]] inline btScalar rounding(const btCollisionShape& shape) {
    constexpr btScalar of_a_corner = btScalar(0.7321); // √3 - 1
    if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) return of_a_corner * shape.getMargin();
    btScalar most = 0;
    if (shape.isCompound()) {
        const auto& parts = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < parts.getNumChildShapes(); ++i) {
            most = std::max(most, rounding(*parts.getChildShape(i)));
        }
    }
    return most;
}

/// Of closest points that a contactPairTest found; negative where they overlap [m].
[[nodiscard]] inline double distance(const btManifoldPoint& point,
                                     const btCollisionObjectWrapper& a,
                                     const btCollisionObjectWrapper& b) {
    const auto rounded = double(point.getDistance());
    const btVector3& normal = point.m_normalWorldOnB; // towards a
    const auto farthest = [&normal](const btCollisionObjectWrapper& of, btScalar side) {
        const btTransform& at = of.getWorldTransform();
        const auto& box = static_cast<const btBoxShape&>(*of.getCollisionShape());
        return normal.dot(at * box.localGetSupportingVertex((side * normal) * at.getBasis()));
    };
    if (a.getCollisionShape()->getShapeType() != BOX_SHAPE_PROXYTYPE ||
        b.getCollisionShape()->getShapeType() != BOX_SHAPE_PROXYTYPE) {
        return rounded;
    }
    // the digits of places in the world are no edge
    const auto size = [](const btCollisionObjectWrapper& of) {
        return of.getWorldTransform().getOrigin().length() +
               of.getCollisionShape()->getAngularMotionDisc();
    };
    const double sharp = farthest(a, -1) - farthest(b, 1);
    const double digits = 16 * double(SIMD_EPSILON) * double(size(a) + size(b));
    return rounded - sharp > digits ? sharp : rounded;
}

} // namespace ductile::bullet
