// SPDX-License-Identifier: MIT
//
// How far two shapes are apart as Bullet's own contacts have it. Its closest points round the edges
// of a box by its margin r, 4 cm, and its contacts of boxes do not: an edge on a face that is
// tilted by θ would be r θ apart while it touches, 1.2 mm of a deck that hangs by 0.03 rad over
// the edge of its support.
//
//   gap of two boxes = n·x_A - n·x_B, x the farthest point of each towards the other, along that n
//   of their faces, pairs of edges and closest points for which it is largest
//
// Two boxes are apart as long as one of these is positive, and touch along the last of them, which
// is the normal of their contact. Closest points alone do not know it where boxes meet by less than
// their margins, as one that flies by the edge of a post. Between two corners the gap is too small,
// and grows right as they come near. All other pairs are left as they are, as Bullet
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

/// How far two shapes are apart, negative where they overlap [m], along what, and where.
struct Gap {
    double away;
    btVector3 normal; ///< towards the first
    btVector3 on_a, on_b;
};

namespace detail {

[[nodiscard]] inline bool are_boxes(const btCollisionObjectWrapper& a,
                                    const btCollisionObjectWrapper& b) {
    return a.getCollisionShape()->getShapeType() == BOX_SHAPE_PROXYTYPE &&
           b.getCollisionShape()->getShapeType() == BOX_SHAPE_PROXYTYPE;
}

inline constexpr btScalar flush = btScalar(1e-4); ///< tilt of edges and faces that meet at once

/// What of a box is farthest along a normal: a corner, a point of an edge, or of a face.
struct Farthest {
    btVector3 at;
    btVector3 along; ///< of an edge
    int free = 0;    ///< axes along which all is as far
};

/// As near to `near` as may be.
[[nodiscard]] inline Farthest farthest(const btCollisionObjectWrapper& of, const btVector3& normal,
                                       const btVector3& near) {
    // a face that this tilts is no farther at one end than at the other by what counts
    constexpr btScalar level = std::max(btScalar(1e-9), 8 * SIMD_EPSILON);
    const btTransform& at = of.getWorldTransform();
    const btVector3 half =
        static_cast<const btBoxShape*>(of.getCollisionShape())->getHalfExtentsWithMargin();
    const btVector3 towards = normal * at.getBasis();
    Farthest result;
    btVector3 local = at.invXform(near);
    for (int j = 0; j < 3; ++j) {
        if (btFabs(towards[j]) > level) {
            local[j] = towards[j] > 0 ? half[j] : -half[j];
        } else {
            local[j] = std::clamp(local[j], -half[j], half[j]);
            result.along = at.getBasis().getColumn(j);
            ++result.free;
        }
    }
    result.at = at * local;
    return result;
}

/// Where two boxes meet: at the corner of one of them, where edges cross, or anywhere along what is
/// flush. Closest points of rounded edges are up to their margin off, where what turns has another
/// speed: what a blow had stopped seemed to go on closing, and was struck again until the budget
/// was spent.
inline void find_place(Gap& gap, const btCollisionObjectWrapper& a,
                       const btCollisionObjectWrapper& b) {
    const Farthest of_b = farthest(b, gap.normal, gap.on_b);
    Farthest of_a = farthest(a, -gap.normal, gap.on_a);
    const btVector3 across = of_a.along.cross(of_b.along);
    constexpr btScalar parallel = btScalar(1e-6);
    if (of_a.free == 1 && of_b.free == 1 && across.length2() > parallel) {
        of_a.at +=
            of_a.along * ((of_b.at - of_a.at).cross(of_b.along).dot(across) / across.length2());
    }
    const btVector3 between = gap.normal * btScalar(gap.away);
    gap.on_a = of_a.free <= of_b.free ? of_a.at : of_b.at + between;
    gap.on_b = gap.on_a - between;
}

} // namespace detail

/// By how much their places in the world may have two shapes nearer each other than they are [m].
[[nodiscard]] inline double digits_of(const btCollisionObjectWrapper& a,
                                      const btCollisionObjectWrapper& b) {
    const auto size = [](const btCollisionObjectWrapper& of) {
        return of.getWorldTransform().getOrigin().length() +
               of.getCollisionShape()->getAngularMotionDisc();
    };
    return 16 * double(SIMD_EPSILON) * double(size(a) + size(b));
}

/// Of closest points that a contactPairTest found.
[[nodiscard]] inline Gap gap_at(const btManifoldPoint& point, const btCollisionObjectWrapper& a,
                                const btCollisionObjectWrapper& b) {
    Gap gap{double(point.getDistance()), point.m_normalWorldOnB, point.getPositionWorldOnA(),
            point.getPositionWorldOnB()};
    if (!detail::are_boxes(a, b)) return gap;
    const btTransform &at_a = a.getWorldTransform(), &at_b = b.getWorldTransform();
    const auto corner = [](const btCollisionObjectWrapper& of, const btVector3& towards) {
        const btTransform& at = of.getWorldTransform();
        const auto& box = static_cast<const btBoxShape&>(*of.getCollisionShape());
        return at * box.localGetSupportingVertex(towards * at.getBasis());
    };
    const auto along = [&](const btVector3& normal) {
        return double(normal.dot(corner(a, -normal)) - normal.dot(corner(b, normal)));
    };
    const double digits = digits_of(a, b); // are no edge
    const double sharp = along(gap.normal);
    if (gap.away - sharp > digits) gap.away = sharp;
    const auto see = [&](btVector3 normal) {
        if (normal.dot(at_a.getOrigin() - at_b.getOrigin()) < 0) normal = -normal;
        const double away = along(normal);
        if (away - gap.away > digits) {
            gap.away = away;
            gap.normal = normal;
        }
    };
    for (int i = 0; i < 3; ++i) {
        see(at_a.getBasis().getColumn(i));
        see(at_b.getBasis().getColumn(i));
    }
    constexpr btScalar parallel = btScalar(1e-6);
    for (int i = 0; i < 9; ++i) {
        const btVector3 across =
            at_a.getBasis().getColumn(i / 3).cross(at_b.getBasis().getColumn(i % 3));
        if (across.length2() > parallel) see(across.normalized());
    }
    detail::find_place(gap, a, b);
    return gap;
}

/// Of two that meet along `meet` after a further `turn` of `a` beside `b` [rad]; 0 where nothing
/// is flush then [m].
[[nodiscard]] inline double flush_depth(const btVector3& meet, const btCollisionObjectWrapper& a,
                                        const btCollisionObjectWrapper& b, const btVector3& turn) {
    constexpr btScalar of_a_face = btScalar(0.999);
    if (!detail::are_boxes(a, b)) return 0;
    const auto half = [](const btCollisionObjectWrapper& of) {
        return static_cast<const btBoxShape*>(of.getCollisionShape())->getHalfExtentsWithMargin();
    };
    for (const bool on_a : {false, true}) { // whose face it is
        const btCollisionObjectWrapper &face = on_a ? a : b, &other = on_a ? b : a;
        const btMatrix3x3 &axes = face.getWorldTransform().getBasis(),
                          &along = other.getWorldTransform().getBasis();
        for (int k = 0; k < 3; ++k) {
            const btVector3 normal = axes.getColumn(k);
            if (btFabs(normal.dot(meet)) < of_a_face) continue;
            const btVector3 tilt = (normal + normal.cross(on_a ? -turn : turn)) * along;
            const btVector3 room = axes.transposeTimes(along).absolute().transpose() * half(face);
            btScalar depth = 0;
            for (int j = 0; j < 3; ++j) {
                const btScalar least = std::min(half(other)[j], room[j]);
                if (btFabs(tilt[j]) < detail::flush) depth += 2 * least * btFabs(tilt[j]);
            }
            return double(depth);
        }
    }
    return 0;
}

} // namespace ductile::bullet
