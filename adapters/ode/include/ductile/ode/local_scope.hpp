// SPDX-License-Identifier: MIT
//
// The bodies that are put back and stepped alone within a frame, while those that have nothing to
// do with any plastic joint or member stand aside: they went through the whole frame in one part,
// as they would have gone without the rest.
//
//   in    members, what hangs together with them or a plastic joint by joints and contacts, and
//         whoever may meet that within the frame, with theirs; closed under both
//   out   all others
//
// How far a body goes in a time t is at most  (v + ω r) t + (g + |F|/m) t²,  r the farthest point
// of its geoms; one that is in may be struck and leave twice as fast as the fastest of all. Who
// gets farther than was reckoned with meets what is out before it touches it (`met`), and takes
// that in.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/held_forces.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

class LocalScope {
  public:
    /// What is in for a frame of `length` [s]: false, and nothing is, where that is half of them or
    /// more, or one is kinematic and no member's.
    [[nodiscard]] bool find(dWorldID world, std::span<const dBodyID> bodies,
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
    /// Of the bodies these are out.
    void set(std::span<const dBodyID> bodies, std::span<const dBodyID> out) {
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
    void clear() {
        numbers_.clear();
        in_.clear();
        out_.clear();
        out_boxes_.clear();
    }

    [[nodiscard]] bool has(dBodyID body) const { return numbers_.has(body); }
    [[nodiscard]] std::span<const dBodyID> in() const noexcept { return in_; }
    [[nodiscard]] std::span<const dBodyID> out() const noexcept { return out_; }
    /// To be called before a body is destroyed.
    void forget(dBodyID body) {
        std::erase(in_, body);
        const auto found = std::find(out_.begin(), out_.end(), body);
        if (found == out_.end()) return;
        out_boxes_.erase(out_boxes_.begin() + (found - out_.begin()));
        out_.erase(found);
    }

    /// What is out went through its frame: there it may have been anywhere between.
    void out_went() {
        for (std::size_t i = 0; i < out_.size(); ++i) {
            Box here = box(out_[i]);
            here.grow(pace(out_[i], here, {}).way(length_ / 2));
            out_boxes_[i].add(here);
        }
    }
    /// Who is out and may be met within `h` [s].
    [[nodiscard]] std::vector<dBodyID> met(const HeldForces& forces, double h) const {
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
    /// Some that are out, with all that hangs together with them or was near them.
    [[nodiscard]] std::vector<dBodyID> with_theirs(std::vector<dBodyID> bodies) const {
        AddressBook found, places;
        for (dBodyID body : bodies) found.enter(body);
        for (dBodyID body : out_) places.enter(body);
        for (std::size_t at = 0; at < bodies.size(); ++at) {
            const auto take = [&](dBodyID other) {
                if (places.has(other) && found.enter(other) == bodies.size()) {
                    bodies.push_back(other);
                }
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
    /// They are in.
    void take_in(std::span<const dBodyID> bodies) {
        for (dBodyID body : bodies) {
            forget(body);
            numbers_.enter(body);
            in_.push_back(body);
        }
    }
    /// ω r, of the farthest point of its geoms [m/s].
    [[nodiscard]] static double turning_speed(dBodyID body) {
        return turning_speed(body, box(body));
    }

  private:
    /// Where a body may be; empty: it has no geoms.
    struct Box {
        std::array<double, 3> low, high;
        void grow(double by) {
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] -= by;
                high[k] += by;
            }
        }
        void add(const Box& other) {
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], other.low[k]);
                high[k] = std::max(high[k], other.high[k]);
            }
        }
        [[nodiscard]] bool meets(const Box& other) const {
            for (std::size_t k = 0; k < 3; ++k) {
                if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
            }
            return true;
        }
    };
    /// How it moves.
    struct Pace {
        double speed = 0;   ///< of the centre [m/s]
        double turning = 0; ///< ω r [m/s]
        double pushed = 0;  ///< g + |F|/m [m/s²]
        [[nodiscard]] double way(double t, double struck = 0) const {
            constexpr double near = 0.02; // [m]
            return (speed + turning + struck) * t + pushed * t * t + near;
        }
    };
    [[nodiscard]] static Box box(dBodyID body) {
        constexpr double far = std::numeric_limits<double>::infinity();
        Box all{{far, far, far}, {-far, -far, -far}};
        for (dGeomID geom = dBodyGetFirstGeom(body); geom != nullptr;
             geom = dBodyGetNextGeom(geom)) {
            std::array<dReal, 6> bounds{};
            dGeomGetAABB(geom, bounds.data());
            all.add({{double(bounds[0]), double(bounds[2]), double(bounds[4])},
                     {double(bounds[1]), double(bounds[3]), double(bounds[5])}});
        }
        return all;
    }
    [[nodiscard]] static double turning_speed(dBodyID body, const Box& box) {
        const Vector3<double> at = to_core(dBodyGetPosition(body));
        double farthest = 0; // square
        for (int k = 0; k < 3; ++k) {
            const double low = box.low[std::size_t(k)] - at[k],
                         high = box.high[std::size_t(k)] - at[k];
            if (low <= high) farthest += std::max(low * low, high * high);
        }
        return norm(angular_velocity(body)) * std::sqrt(farthest);
    }
    [[nodiscard]] Pace pace(dBodyID body, const Box& box, const HeldForces& forces) const {
        if (dBodyIsEnabled(body) == 0) return {};
        return {.speed = norm(linear_velocity(body)),
                .turning = turning_speed(body, box),
                .pushed = gravity_ + norm(forces.force_on(body)) / mass(body)};
    }
    /// Where those that are in may be within `h` [s].
    [[nodiscard]] std::vector<Box> reached_in(const HeldForces& forces, double h) const {
        double fastest = 0;
        for (dBodyID body : in_) fastest = std::max(fastest, norm(linear_velocity(body)));
        std::vector<Box> result;
        for (dBodyID body : in_) {
            Box& here = result.emplace_back(box(body));
            here.grow(pace(body, here, forces).way(h, 2 * fastest));
        }
        return result;
    }
    /// Whoever is attached, or may be met, until there is none; false: they are too many.
    [[nodiscard]] bool gather(std::span<const dBodyID> bodies, const HeldForces& forces) {
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
    /// By joints and contacts, from those that are in at `from` on.
    void add_attached(std::size_t from) {
        for (std::size_t at = from; at < in_.size(); ++at) {
            const dBodyID body = in_[at];
            for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
                const dJointID joint = dBodyGetJoint(body, i);
                for (const int side : {0, 1}) {
                    const dBodyID other = dJointGetBody(joint, side);
                    if (other != nullptr && numbers_.enter(other) == in_.size()) {
                        in_.push_back(other);
                    }
                }
            }
        }
    }

    double gravity_ = 0;  ///< [m/s²]
    double length_ = 0;   ///< [s]
    AddressBook numbers_; ///< of those that are in
    std::vector<dBodyID> in_, out_;
    std::vector<Box> out_boxes_; ///< where each that is out was in the frame
};

/// Bodies that ODE does not step while this lives.
class StoodAside {
  public:
    explicit StoodAside(std::span<const dBodyID> bodies) {
        for (dBodyID body : bodies) {
            if (dBodyIsEnabled(body) == 0) continue;
            dBodyDisable(body);
            bodies_.push_back(body);
        }
    }
    ~StoodAside() {
        for (dBodyID body : bodies_) dBodyEnable(body);
    }
    StoodAside(const StoodAside&) = delete;
    StoodAside& operator=(const StoodAside&) = delete;

  private:
    std::vector<dBodyID> bodies_;
};

/// Bodies whose geoms meet nothing while this lives.
class Untouched {
  public:
    explicit Untouched(std::span<const dBodyID> bodies) {
        for (dBodyID body : bodies) {
            for (dGeomID geom = dBodyGetFirstGeom(body); geom != nullptr;
                 geom = dBodyGetNextGeom(geom)) {
                if (dGeomIsEnabled(geom) == 0) continue;
                dGeomDisable(geom);
                geoms_.push_back(geom);
            }
        }
    }
    ~Untouched() {
        for (dGeomID geom : geoms_) dGeomEnable(geom);
    }
    Untouched(const Untouched&) = delete;
    Untouched& operator=(const Untouched&) = delete;

  private:
    std::vector<dGeomID> geoms_;
};

} // namespace ductile::ode
