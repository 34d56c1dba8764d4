// SPDX-License-Identifier: MIT
//
// Bodies of local_scope.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/local_scope.hpp"

namespace ductile::ode {

DUCTILE_INLINE void LocalScope::Box::grow(double by) {
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] -= by;
        high[k] += by;
    }
}
DUCTILE_INLINE void LocalScope::Box::add(const Box& other) {
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], other.low[k]);
        high[k] = std::max(high[k], other.high[k]);
    }
}
DUCTILE_INLINE bool LocalScope::Box::meets(const Box& other) const {
    for (std::size_t k = 0; k < 3; ++k) {
        if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
    }
    return true;
}

DUCTILE_INLINE LocalScope::Box LocalScope::box(dBodyID body) {
    constexpr double far = std::numeric_limits<double>::infinity();
    Box all{{far, far, far}, {-far, -far, -far}};
    for (dGeomID geom = dBodyGetFirstGeom(body); geom != nullptr; geom = dBodyGetNextGeom(geom)) {
        std::array<dReal, 6> bounds{};
        dGeomGetAABB(geom, bounds.data());
        all.add({{double(bounds[0]), double(bounds[2]), double(bounds[4])},
                 {double(bounds[1]), double(bounds[3]), double(bounds[5])}});
    }
    return all;
}

DUCTILE_INLINE auto LocalScope::pace(dBodyID body, const Box& box, const HeldForces& forces) const
    -> Pace {
    if (dBodyIsEnabled(body) == 0) return {};
    return {.speed = norm(linear_velocity(body)),
            .turning = turning_speed(body, box),
            .pushed = gravity_ + norm(forces.force_on(body)) / mass(body)};
}
DUCTILE_INLINE double LocalScope::turning_speed(dBodyID body, const Box& box) {
    const Vector3<double> at = to_core(dBodyGetPosition(body));
    double farthest = 0; // square
    for (int k = 0; k < 3; ++k) {
        const double low = box.low[std::size_t(k)] - at[k], high = box.high[std::size_t(k)] - at[k];
        if (low <= high) farthest += std::max(low * low, high * high);
    }
    return norm(angular_velocity(body)) * std::sqrt(farthest);
}

/// By joints and contacts, from those that are in at `from` on.
DUCTILE_INLINE void LocalScope::add_attached(std::size_t from) {
    for (std::size_t at = from; at < in_.size(); ++at) {
        const dBodyID body = in_[at];
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            for (const int side : {0, 1}) {
                const dBodyID other = dJointGetBody(joint, side);
                if (other != nullptr && numbers_.enter(other) == in_.size()) in_.push_back(other);
            }
        }
    }
}

DUCTILE_INLINE bool LocalScope::find(dWorldID world, std::span<const dBodyID> bodies,
                                     std::span<PlasticConstraint* const> joints,
                                     std::span<const dBodyID> members, const HeldForces& forces,
                                     double length) {
    clear();
    length_ = length;
    gravity_ = norm(gravity_of(world));
    const auto add = [this](dBodyID body) {
        if (body != nullptr && numbers_.enter(body) == in_.size()) in_.push_back(body);
    };
    for (dBodyID body : members) add(body);
    const auto stands = [this](dBodyID body) { return !can_move(body) && !has(body); };
    const bool driven = std::any_of(bodies.begin(), bodies.end(), stands);
    for (const PlasticConstraint* joint : joints) {
        for (dBodyID body : {joint->bodies().a, joint->bodies().b}) add(body);
    }
    if (in_.empty() || driven || !gather(bodies, forces)) {
        clear();
        return false;
    }
    in_.clear();
    for (dBodyID body : bodies) (has(body) ? in_ : out_).push_back(body);
    for (dBodyID body : out_) {
        Box& here = out_boxes_.emplace_back(box(body));
        here.grow(pace(body, here, forces).way(length / 2));
    }
    return true;
}

/// Whoever is attached, or may be met, until there is none; false: they are too many.
DUCTILE_INLINE bool LocalScope::gather(std::span<const dBodyID> bodies, const HeldForces& forces) {
    struct Mover {
        Box box;
        double speed;
        bool out = true;
    };
    std::vector<Mover> movers;
    AddressBook places;
    for (dBodyID body : bodies) {
        places.enter(body);
        const Box here = box(body);
        const Pace pace = this->pace(body, here, forces);
        movers.push_back({here, pace.speed});
        movers.back().box.grow(pace.way(length_));
    }
    double fastest = 0;
    for (std::size_t from = 0, next = 0; from < in_.size(); from = next) {
        add_attached(from);
        next = in_.size();
        if (2 * next >= bodies.size()) return false;
        double now = fastest;
        for (std::size_t i = from; i < next; ++i) {
            const std::size_t place = places.find(in_[i]);
            if (place == AddressBook::unknown) return false; // of another world
            movers[place].out = false;
            now = std::max(now, movers[place].speed);
        }
        const std::size_t first = std::exchange(fastest, now) < now ? 0 : from; // all once more
        for (std::size_t i = first; i < next; ++i) {
            Box reached = movers[places.find(in_[i])].box;
            reached.grow(2 * fastest * length_);
            for (std::size_t k = 0; k < movers.size(); ++k) {
                if (!movers[k].out || !reached.meets(movers[k].box)) continue;
                movers[k].out = false;
                numbers_.enter(bodies[k]);
                in_.push_back(bodies[k]);
            }
        }
    }
    return true;
}

DUCTILE_INLINE void LocalScope::set(std::span<const dBodyID> bodies, std::span<const dBodyID> out) {
    clear();
    out_.assign(out.begin(), out.end());
    AddressBook others;
    for (dBodyID body : out) others.enter(body);
    for (dBodyID body : bodies) {
        if (others.has(body)) continue;
        numbers_.enter(body);
        in_.push_back(body);
    }
}

DUCTILE_INLINE void LocalScope::clear() {
    numbers_.clear();
    in_.clear();
    out_.clear();
    out_boxes_.clear();
}

DUCTILE_INLINE void LocalScope::forget(dBodyID body) {
    std::erase(in_, body);
    const auto found = std::find(out_.begin(), out_.end(), body);
    if (found == out_.end()) return;
    out_boxes_.erase(out_boxes_.begin() + (found - out_.begin()));
    out_.erase(found);
}

DUCTILE_INLINE void LocalScope::out_went() {
    for (std::size_t i = 0; i < out_.size(); ++i) {
        Box here = box(out_[i]);
        here.grow(pace(out_[i], here, {}).way(length_ / 2));
        out_boxes_[i].add(here);
    }
}

/// Where those that are in may be within `h` [s].
DUCTILE_INLINE auto LocalScope::reached_in(const HeldForces& forces, double h) const
    -> std::vector<Box> {
    double fastest = 0;
    for (dBodyID body : in_) fastest = std::max(fastest, norm(linear_velocity(body)));
    std::vector<Box> result;
    for (dBodyID body : in_) {
        Box& here = result.emplace_back(box(body));
        here.grow(pace(body, here, forces).way(h, 2 * fastest));
    }
    return result;
}

DUCTILE_INLINE std::vector<dBodyID> LocalScope::met(const HeldForces& forces, double h) const {
    const std::vector<Box> near = reached_in(forces, h);
    if (near.empty() || out_.empty()) return {};
    Box all = near.front();
    for (const Box& box : near) all.add(box);
    std::vector<dBodyID> result;
    for (std::size_t i = 0; i < out_.size(); ++i) {
        if (!all.meets(out_boxes_[i])) continue;
        const auto meets = [&](const Box& box) { return box.meets(out_boxes_[i]); };
        if (std::any_of(near.begin(), near.end(), meets)) result.push_back(out_[i]);
    }
    return result;
}

DUCTILE_INLINE std::vector<dBodyID> LocalScope::with_theirs(std::vector<dBodyID> bodies) const {
    AddressBook found, places;
    for (dBodyID body : bodies) found.enter(body);
    for (dBodyID body : out_) places.enter(body);
    for (std::size_t at = 0; at < bodies.size(); ++at) {
        const auto take = [&](dBodyID other) {
            if (places.has(other) && found.enter(other) == bodies.size()) bodies.push_back(other);
        };
        const Box of = out_boxes_[places.find(bodies[at])];
        for (std::size_t i = 0; i < out_.size(); ++i) {
            if (of.meets(out_boxes_[i])) take(out_[i]);
        }
        for (int i = 0, count = dBodyGetNumJoints(bodies[at]); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(bodies[at], i);
            for (const int side : {0, 1}) take(dJointGetBody(joint, side));
        }
    }
    return bodies;
}

DUCTILE_INLINE void LocalScope::take_in(std::span<const dBodyID> bodies) {
    for (dBodyID body : bodies) {
        forget(body);
        numbers_.enter(body);
        in_.push_back(body);
    }
}

} // namespace ductile::ode
