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

#include <array>
#include <span>
#include <vector>

#include "ductile/ode/held_forces.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

class LocalScope {
  public:
    /// What is in for a frame of `length` [s]: false, and nothing is, where that is half of them or
    /// more, or one is kinematic and no member's.
    [[nodiscard]] bool find(dWorldID world, std::span<const dBodyID> bodies,
                            std::span<PlasticConstraint* const> joints,
                            std::span<const dBodyID> members, const HeldForces& forces,
                            double length);
    /// Of the bodies these are out.
    void set(std::span<const dBodyID> bodies, std::span<const dBodyID> out);
    void clear();

    [[nodiscard]] bool has(dBodyID body) const { return numbers_.has(body); }
    [[nodiscard]] std::span<const dBodyID> in() const noexcept { return in_; }
    [[nodiscard]] std::span<const dBodyID> out() const noexcept { return out_; }
    /// To be called before a body is destroyed.
    void forget(dBodyID body);

    /// What is out went through its frame: there it may have been anywhere between.
    void out_went();
    /// Who is out and may be met within `h` [s].
    [[nodiscard]] std::vector<dBodyID> met(const HeldForces& forces, double h) const;
    /// Some that are out, with all that hangs together with them or was near them.
    [[nodiscard]] std::vector<dBodyID> with_theirs(std::vector<dBodyID> bodies) const;
    /// They are in.
    void take_in(std::span<const dBodyID> bodies);
    /// ω r, of the farthest point of its geoms [m/s].
    [[nodiscard]] static double turning_speed(dBodyID body) {
        return turning_speed(body, box(body));
    }

  private:
    /// Where a body may be; empty: it has no geoms.
    struct Box {
        std::array<double, 3> low, high;
        void grow(double by);
        void add(const Box& other);
        [[nodiscard]] bool meets(const Box& other) const;
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
    [[nodiscard]] static Box box(dBodyID body);
    [[nodiscard]] static double turning_speed(dBodyID body, const Box& box);
    [[nodiscard]] Pace pace(dBodyID body, const Box& box, const HeldForces& forces) const;
    [[nodiscard]] std::vector<Box> reached_in(const HeldForces& forces, double h) const;
    [[nodiscard]] bool gather(std::span<const dBodyID> bodies, const HeldForces& forces);
    void add_attached(std::size_t from);

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

#ifndef DUCTILE_COMPILED
#include "ductile/ode/local_scope.ipp"
#endif
