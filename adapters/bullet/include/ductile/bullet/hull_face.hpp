// SPDX-License-Identifier: MIT
//
// A face of a hull, of which Bullet keeps vertices alone. A plane that is beyond all of them and
// touches one is turned about that by as little as has it touch a second, and about both until it
// touches a third: no vertex is then beyond it. What lies as far as these within a millionth of
// the hull's size is the face.
#pragma once

#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ductile::bullet::detail {

/// In the axes of its hull. All is beyond it of one that is flat, a line or a point.
class HullFace {
  public:
    /// That which is nearest to square to `towards`.
    HullFace(const btPolyhedralConvexShape& hull, const btVector3& towards)
        : normal_(towards), even_(btScalar(1e-6) * hull.getAngularMotionDisc()) {
        std::vector<btVector3> corners(std::size_t(hull.getNumVertices()));
        for (int i = 0; i < hull.getNumVertices(); ++i) hull.getVertex(i, corners[std::size_t(i)]);
        const btVector3 first = *std::max_element(
            corners.begin(), corners.end(),
            [this](const auto& x, const auto& y) { return normal_.dot(x) < normal_.dot(y); });
        // of those that are as good as level the farthest tells best
        const auto next = [&](const auto& distance) {
            const auto turn = [&](const btVector3& at) {
                return (even_ + normal_.dot(first - at)) / distance(at - first);
            };
            return *std::min_element(corners.begin(), corners.end(), [&](auto& x, auto& y) {
                return turn(x) < turn(y);
            }) - first;
        };
        const btVector3 edge = next([](const btVector3& way) { return way.length(); });
        normal_ -= edge * (normal_.dot(edge) / edge.length2());
        const btVector3 across = edge.cross(normal_).normalized();
        const btVector3 other =
            next([&across](const btVector3& way) { return btFabs(across.dot(way)); });
        const btVector3 square = edge.cross(other);
        normal_ = square * (square.dot(normal_) < 0 ? -1 : 1) / square.length();
        level_ = normal_.dot(first) + hull.getMargin();
        std::erase_if(corners, [&](const auto& at) { return normal_.dot(first - at) > even_; });
        go_round(corners);
    }
    [[nodiscard]] const btVector3& normal() const noexcept { return normal_; }
    [[nodiscard]] btScalar level() const noexcept { return level_; } ///< rounding and all [m]
    /// Beside it, whatever the height.
    [[nodiscard]] bool is_beyond(const btVector3& at) const {
        for (std::size_t i = 0; i < outline_.size(); ++i) {
            const btVector3 edge = outline_[(i + 1) % outline_.size()] - outline_[i];
            if (edge.cross(normal_).dot(at - outline_[i]) > even_ * edge.length()) return true;
        }
        return outline_.size() < 3;
    }

  private:
    /// From an outermost one always to that which has all others on its left.
    void go_round(const std::vector<btVector3>& corners) {
        if (corners.empty()) return;
        btVector3 at = *std::max_element(
            corners.begin(), corners.end(), [&corners](const btVector3& x, const btVector3& y) {
                return x.distance2(corners[0]) < y.distance2(corners[0]);
            });
        while (outline_.size() < corners.size()) {
            outline_.push_back(at);
            btVector3 way(0, 0, 0);
            for (const btVector3& corner : corners) {
                const btVector3 there = corner - outline_.back();
                const btScalar left = normal_.dot(way.cross(there)), even = even_ * way.length();
                if (left < -even || (left <= even && there.length2() > way.length2())) way = there;
            }
            at += way;
            if (at.distance(outline_.front()) <= even_) break;
        }
    }

    btVector3 normal_;
    btScalar even_, level_ = 0;      ///< [m]
    std::vector<btVector3> outline_; ///< against the clock as seen from outside
};

} // namespace ductile::bullet::detail
