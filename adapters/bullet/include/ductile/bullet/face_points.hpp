// SPDX-License-Identifier: MIT
//
// Where corners of a convex shape meet a flat face. Of two convex shapes Bullet tells one point a
// tick, by an iteration (GJK) that in single precision is up to 10 µm and 0.1 mrad off, other ones
// for the same pose. So a bar that lies down has a contact at one end of its edge, or in the
// middle of it, and what a blow closes is not what was seen to close. On a plane, the face of a box
// or a hull and the end of a cylinder all corners are known:
//
//   height of a corner x, a rounding r:   n·x - r - level,   n the normal of the face
//
// A box has six faces; that over which the lowest corner is highest tells how far the two are
// apart, if what is near it is within its edges. Of a hull it is the face that is nearest to square
// to Bullet's normal (hull_face.hpp). Else they meet at an edge of the face, and what Bullet tells
// is left as it is.
//
//   corners   hulls and other polyhedra: all; capsules: both centres; cylinders: of each rim the
//             lowest, and of the lower one what is a quarter of a turn from it, too; boxes: all.
//             Rounded by their margin, as Bullet does it, but boxes, which are sharp.
//
// Two boxes are Bullet's own matter (sharp_boxes.hpp), as are spheres, which have one point, and
// triangles of a mesh, which go on in others.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ductile/bullet/hull_face.hpp"
#include "ductile/bullet/sharp_boxes.hpp"

namespace ductile::bullet {

namespace detail {

/// A shape and where it is.
struct Placed {
    const btCollisionShape* shape;
    btTransform at;
};

/// Of one of two bodies.
struct Corner {
    btVector3 at; ///< from the centre of the body, of the world's axes [m]
    btScalar away;
};

[[nodiscard]] inline btVector3 along_axis(int axis, bool forwards) {
    btVector3 unit(0, 0, 0);
    unit[axis] = btScalar(forwards ? 1 : -1);
    return unit;
}

/// Calls `visit(corner)` with all that may be farthest `towards`, in the shape's axes, without
/// their rounding, which is returned; negative: a shape of another kind [m].
template <class Visit>
btScalar visit_corners(const btCollisionShape& shape, const btVector3& towards,
                       const Visit& visit) {
    const int type = shape.getShapeType();
    if (type == CAPSULE_SHAPE_PROXYTYPE) {
        const auto& capsule = static_cast<const btCapsuleShape&>(shape);
        btVector3 centre(0, 0, 0);
        for (const btScalar side : {btScalar(-1), btScalar(1)}) {
            centre[capsule.getUpAxis()] = side * capsule.getHalfHeight();
            visit(centre);
        }
        return capsule.getRadius();
    }
    if (type == CYLINDER_SHAPE_PROXYTYPE) {
        const auto& cylinder = static_cast<const btCylinderShape&>(shape);
        const int up = cylinder.getUpAxis();
        const btVector3& half = cylinder.getHalfExtentsWithoutMargin();
        const btScalar radius = half[up == 0 ? 1 : 0];
        const btVector3 axis = along_axis(up, !(towards[up] < 0));
        btVector3 lowest = towards - axis * towards.dot(axis);
        constexpr btScalar upright = btScalar(1e-6);
        if (lowest.length2() > upright * upright) {
            lowest.normalize();
        } else {
            lowest = along_axis(up == 0 ? 1 : 0, true);
        }
        const btVector3 level = axis.cross(lowest);
        for (const btVector3& out : {lowest, level, -level, -lowest}) {
            visit(axis * half[up] + out * radius);
        }
        visit(-axis * half[up] + lowest * radius);
        return cylinder.getMargin();
    }
    if (type == BOX_SHAPE_PROXYTYPE) {
        const btVector3 half = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
        for (int i = 0; i < 8; ++i) {
            visit(half * btVector3(btScalar((i & 1) != 0 ? 1 : -1), btScalar((i & 2) != 0 ? 1 : -1),
                                   btScalar((i & 4) != 0 ? 1 : -1)));
        }
        return 0;
    }
    if (!shape.isPolyhedral()) return -1;
    const auto& hull = static_cast<const btPolyhedralConvexShape&>(shape);
    if (hull.getNumVertices() == 0) return -1;
    for (int i = 0; i < hull.getNumVertices(); ++i) {
        btVector3 corner;
        hull.getVertex(i, corner);
        visit(corner);
    }
    return hull.getMargin();
}

/// Corners of `other` over a face; the nearest first. None: what is within `near` [m] of it is not
/// all within its edges, or they are of another kind.
class FaceView {
  public:
    /// `towards` the other, and not deeper in it than `deepest`, as Bullet has it.
    FaceView(const Placed& owner, const Placed& other, const btVector3& towards, btScalar deepest,
             btScalar near)
        : owner_(owner), other_(other), near_(near), nearest_(deepest) {
        const int type = owner.shape->getShapeType();
        if (type == STATIC_PLANE_PROXYTYPE) {
            const auto& shape = static_cast<const btStaticPlaneShape&>(*owner.shape);
            look(shape.getPlaneNormal(), shape.getPlaneConstant(),
                 [](const btVector3&) { return false; });
        } else if (type == BOX_SHAPE_PROXYTYPE) {
            const btVector3 half =
                static_cast<const btBoxShape&>(*owner.shape).getHalfExtentsWithMargin();
            for (int i = 0; i < 6; ++i) {
                look(along_axis(i / 2, i % 2 == 0), half[i / 2], [&half, i](const btVector3& at) {
                    const int j = (i / 2 + 1) % 3, k = (i / 2 + 2) % 3;
                    return btFabs(at[j]) > half[j] || btFabs(at[k]) > half[k];
                });
            }
        } else if (type == CYLINDER_SHAPE_PROXYTYPE) {
            const auto& shape = static_cast<const btCylinderShape&>(*owner.shape);
            const int up = shape.getUpAxis();
            const btScalar height = shape.getHalfExtentsWithMargin()[up],
                           radius = shape.getRadius();
            for (const bool top : {true, false}) {
                look(along_axis(up, top), height, [up, radius](btVector3 at) {
                    at[up] = 0;
                    return at.length2() > radius * radius;
                });
            }
        } else if (owner.shape->isPolyhedral()) {
            const auto& hull = static_cast<const btPolyhedralConvexShape&>(*owner.shape);
            if (hull.getNumVertices() > 0) {
                const HullFace face(hull, towards * owner.at.getBasis());
                look(face.normal(), face.level(),
                     [&face](const btVector3& at) { return face.is_beyond(at); });
            }
        }
        if (!inside_) corners_.clear();
        std::sort(corners_.begin(), corners_.end(),
                  [](const Corner& x, const Corner& y) { return x.away < y.away; });
    }
    [[nodiscard]] const btVector3& normal() const noexcept { return normal_; }
    [[nodiscard]] std::span<const Corner> corners() const noexcept { return corners_; }

  private:
    /// At a face whose normal is in the axes of its owner, and so is what `is_beyond` its edges.
    template <class Beyond>
    void look(const btVector3& normal, btScalar level, const Beyond& is_beyond) {
        const btMatrix3x3 &axes = owner_.at.getBasis(), &turned = other_.at.getBasis();
        const btVector3 out = axes * normal;
        const btVector3 between = other_.at.getOrigin() - owner_.at.getOrigin();
        seen_.clear();
        const btScalar round = visit_corners(*other_.shape, -(out * turned), [&](const auto& at) {
            const btVector3 from = turned * at;
            seen_.push_back({from, out.dot(between + from) - level});
        });
        if (round < 0 || seen_.empty()) return;
        btScalar nearest = std::numeric_limits<btScalar>::infinity();
        for (Corner& corner : seen_) {
            corner.at -= round * out;
            corner.away -= round;
            nearest = std::min(nearest, corner.away);
        }
        if (!(nearest > nearest_)) return;
        nearest_ = nearest;
        normal_ = out;
        inside_ = true;
        const auto is_beside = [&](const Corner& corner) {
            const bool beside = is_beyond((between + corner.at) * axes);
            if (beside && corner.away < nearest + near_) inside_ = false;
            return beside;
        };
        std::erase_if(seen_, is_beside);
        corners_.swap(seen_);
    }

    const Placed &owner_, &other_;
    btScalar near_;
    std::vector<Corner> corners_, seen_;
    btVector3 normal_ = btVector3(0, 0, 0);
    btScalar nearest_;
    bool inside_ = false;
};

/// Beyond that Bullet knows no contact of the two [m].
[[nodiscard]] inline btScalar contact_reach(const btCollisionShape& a, const btCollisionShape& b) {
    return std::min(a.getContactBreakingThreshold(gContactBreakingThreshold),
                    b.getContactBreakingThreshold(gContactBreakingThreshold));
}

/// Where corners of one are over a face of the other, the nearest first, into `gaps`; none: they
/// meet otherwise. `known`: what Bullet knows of them.
inline void list_face_gaps(const Placed& a, const Placed& b, const btManifoldPoint& known,
                           std::vector<Gap>& gaps) {
    gaps.clear();
    const int of_a = a.shape->getShapeType(), of_b = b.shape->getShapeType();
    if ((of_a == BOX_SHAPE_PROXYTYPE && of_b == BOX_SHAPE_PROXYTYPE) ||
        of_a == TRIANGLE_SHAPE_PROXYTYPE || of_b == TRIANGLE_SHAPE_PROXYTYPE) {
        return;
    }
    const btScalar near = contact_reach(*a.shape, *b.shape);
    const btScalar deepest = known.getDistance() - near - rounding(*a.shape) - rounding(*b.shape);
    const btVector3& normal = known.m_normalWorldOnB;
    for (const bool on_b : {true, false}) { // whose face it is
        const Placed &owner = on_b ? b : a, &other = on_b ? a : b;
        const FaceView view(owner, other, on_b ? normal : -normal, deepest, near);
        for (const Corner& corner : view.corners()) {
            const btVector3 at = other.at.getOrigin() + corner.at,
                            below = at - corner.away * view.normal();
            gaps.push_back({double(corner.away), on_b ? view.normal() : -view.normal(),
                            on_b ? at : below, on_b ? below : at});
        }
        if (!gaps.empty()) return;
    }
}

/// The shape that a manifold's point is of; null where that is not told.
[[nodiscard]] inline Placed placed(const btCollisionObject& object, int child) {
    const btCollisionShape* shape = object.getCollisionShape();
    if (!shape->isCompound()) return {shape, object.getWorldTransform()};
    const auto& compound = static_cast<const btCompoundShape&>(*shape);
    if (child < 0 || child >= compound.getNumChildShapes()) return {nullptr, {}};
    return {compound.getChildShape(child),
            object.getWorldTransform() * compound.getChildTransform(child)};
}

/// As many as a manifold has room for, that span what all of them do; the nearest first.
inline void keep_spread(std::vector<Gap>& gaps) {
    const auto farthest = [&gaps](std::size_t from, const auto& measure) {
        const auto best = std::max_element(
            gaps.begin() + std::ptrdiff_t(from), gaps.end(),
            [&measure](const Gap& x, const Gap& y) { return measure(x) < measure(y); });
        std::iter_swap(gaps.begin() + std::ptrdiff_t(from), best);
    };
    if (gaps.size() <= MANIFOLD_CACHE_SIZE) return;
    farthest(1, [&](const Gap& gap) { return gap.on_b.distance2(gaps[0].on_b); });
    const btVector3 across = gaps[0].normal.cross(gaps[1].on_b - gaps[0].on_b);
    const auto beside = [&](const Gap& gap) { return across.dot(gap.on_b - gaps[0].on_b); };
    farthest(2, [&](const Gap& gap) { return btFabs(beside(gap)); });
    const btScalar side = beside(gaps[2]) > 0 ? btScalar(-1) : btScalar(1);
    farthest(3, [&](const Gap& gap) { return side * beside(gap); });
    gaps.resize(MANIFOLD_CACHE_SIZE);
}

} // namespace detail

/// Of closest points that a contactPairTest found, into `gaps`; the nearest first.
inline void list_gaps(const btManifoldPoint& point, const btCollisionObjectWrapper& a,
                      const btCollisionObjectWrapper& b, std::vector<Gap>& gaps) {
    detail::list_face_gaps({a.getCollisionShape(), a.getWorldTransform()},
                           {b.getCollisionShape(), b.getWorldTransform()}, point, gaps);
    if (gaps.empty()) gaps.push_back(gap_at(point, a, b));
}

/// Whether Bullet is shown all of them that are near, or knows them.
[[nodiscard]] inline bool are_all_known(const std::vector<Gap>& gaps,
                                        const btCollisionObjectWrapper& a,
                                        const btCollisionObjectWrapper& b) {
    return gaps.size() > 1 || detail::are_boxes(a, b);
}

/// Has a manifold know all corners over a face that are near it, as its bodies are now. Not where
/// the user's data is on its points.
inline void see_corners(btPersistentManifold& manifold) {
    const int count = manifold.getNumContacts();
    if (count == 0) return;
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    const detail::Placed of_a = detail::placed(a, manifold.getContactPoint(0).m_index0),
                         of_b = detail::placed(b, manifold.getContactPoint(0).m_index1);
    if (of_a.shape == nullptr || of_b.shape == nullptr) return;
    std::vector<Gap> gaps;
    detail::list_face_gaps(of_a, of_b, manifold.getContactPoint(0), gaps);
    std::erase_if(gaps, [&manifold](const Gap& gap) {
        return gap.away > double(manifold.getContactBreakingThreshold());
    });
    if (gaps.empty()) return;
    std::array<btManifoldPoint, MANIFOLD_CACHE_SIZE> known;
    for (int k = 0; k < count; ++k) {
        known[std::size_t(k)] = manifold.getContactPoint(k);
        if (known[std::size_t(k)].m_userPersistentData != nullptr) return;
    }
    detail::keep_spread(gaps);
    manifold.setNumContacts(0);
    for (const Gap& gap : gaps) {
        const auto nearest = std::min_element(
            known.begin(), known.begin() + count, [&gap](const auto& x, const auto& y) {
                return x.getPositionWorldOnB().distance2(gap.on_b) <
                       y.getPositionWorldOnB().distance2(gap.on_b);
            });
        btManifoldPoint point = *nearest; // with its material
        point.m_positionWorldOnA = gap.on_a;
        point.m_positionWorldOnB = gap.on_b;
        point.m_localPointA = a.getWorldTransform().invXform(gap.on_a);
        point.m_localPointB = b.getWorldTransform().invXform(gap.on_b);
        point.m_normalWorldOnB = gap.normal;
        point.m_distance1 = btScalar(gap.away);
        manifold.addManifoldPoint(point);
    }
}

} // namespace ductile::bullet
