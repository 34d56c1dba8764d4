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
//
// Faces that are as good as flush, within 0.1 mrad, meet at once in reality, and in a sequence of
// blows on one corner after the other in rigid bodies, so that the last digit tells how a box goes
// on. Bullet knows corners that overlap alone: `flush_depth` is how deep the first has to for the
// others to do so.
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

/// Of closest points that a contactPairTest found, as they meet after a further `turn` of `a`
/// beside `b` [rad]; 0 where nothing is flush then [m].
[[nodiscard]] inline double flush_depth(const btManifoldPoint& point,
                                        const btCollisionObjectWrapper& a,
                                        const btCollisionObjectWrapper& b, const btVector3& turn) {
    constexpr btScalar flush = btScalar(1e-4), of_a_face = btScalar(0.999);
    if (a.getCollisionShape()->getShapeType() != BOX_SHAPE_PROXYTYPE ||
        b.getCollisionShape()->getShapeType() != BOX_SHAPE_PROXYTYPE) {
        return 0;
    }
    const auto half = [](const btCollisionObjectWrapper& of) {
        return static_cast<const btBoxShape*>(of.getCollisionShape())->getHalfExtentsWithMargin();
    };
    for (const bool on_a : {false, true}) { // whose face it is
        const btCollisionObjectWrapper &face = on_a ? a : b, &other = on_a ? b : a;
        const btMatrix3x3 &axes = face.getWorldTransform().getBasis(),
                          &along = other.getWorldTransform().getBasis();
        for (int k = 0; k < 3; ++k) {
            const btVector3 normal = axes.getColumn(k);
            if (btFabs(normal.dot(point.m_normalWorldOnB)) < of_a_face) continue;
            const btVector3 tilt = (normal + normal.cross(on_a ? -turn : turn)) * along;
            const btVector3 room = axes.transposeTimes(along).absolute().transpose() * half(face);
            btScalar depth = 0;
            for (int j = 0; j < 3; ++j) {
                const btScalar least = std::min(half(other)[j], room[j]);
                if (btFabs(tilt[j]) < flush) depth += 2 * least * btFabs(tilt[j]);
            }
            return double(depth);
        }
    }
    return 0;
}

} // namespace ductile::bullet
