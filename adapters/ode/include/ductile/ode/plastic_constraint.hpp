// SPDX-License-Identifier: MIT
//
// A plastic constraint of any kind as a world and an energy account see it.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cstddef>
#include <vector>

#include "ductile/frame/part_row.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/island_rows.hpp"
#include "ductile/ode/stepped_constraint.hpp"
#include "ductile/vocabulary/on_demand.hpp"
#include "ductile/vocabulary/vector.hpp"
#include "ductile/world/driven_velocity.hpp"
#include "ductile/world/joint_queries.hpp"
#include "ductile/world/share_work.hpp"

namespace ductile::ode {

/// What a constraint applied for a step beside its joint, about the centres of mass, world axes.
struct OutsideForce {
    Vector3<double> force{0, 0, 0};    ///< on A; the opposite on B [N]
    Vector3<double> torque_a{0, 0, 0}; ///< [N m]
    Vector3<double> torque_b{0, 0, 0};
};

/// The two bodies of a constraint with the velocities that count for the start of a step: ODE moves
/// a kinematic body after the solve, as all others, but its velocity is changed before.
class DrivenPair {
  public:
    [[nodiscard]] BodyState<double> at_start(int side, dBodyID body, const BodyState<double>& now,
                                             double dt) const {
        const Courses* courses = courses_.get();
        if (!is_driven(body) || courses == nullptr) return now;
        const Part& part = courses->part[std::size_t(side)];
        if (!part.known) return courses->velocity[std::size_t(side)].at_start(now, dt);
        BodyState<double> start = now;
        start.velocity = part.velocity;
        start.spin = part.spin;
        return start;
    }
    /// It has these velocities where the coming part of a frame begins.
    void begins_part(int side, const Vector3<double>& velocity, const Vector3<double>& spin) {
        courses_.made().part[std::size_t(side)] = {true, velocity, spin};
    }
    void booked(int side, dBodyID body, double dt) {
        if (!is_driven(body)) return;
        courses_.made().velocity[std::size_t(side)].booked(body_motion(body), dt);
    }
    void forget() {
        Courses* courses = courses_.get();
        if (courses == nullptr) return;
        for (DrivenVelocity& velocity : courses->velocity) velocity.forget();
        courses->part = {};
    }
    [[nodiscard]] static bool is_driven(dBodyID body) {
        return body != nullptr && dBodyIsKinematic(body) != 0;
    }

  private:
    struct Part {
        bool known = false;
        Vector3<double> velocity{0, 0, 0}, spin{0, 0, 0};
    };

    struct Courses {
        std::array<DrivenVelocity, 2> velocity;
        std::array<Part, 2> part{};
    };

    OnDemand<Courses> courses_; ///< where a body is driven
};

class PlasticConstraint : public SteppedConstraint, public SharesWork {
  public:
    ~PlasticConstraint() override { leave_keepers(); }

    [[nodiscard]] virtual const PairQueries& queries() const noexcept = 0;
    /// Of the last step.
    [[nodiscard]] virtual const OutsideForce& outside_force() const = 0;
    [[nodiscard]] virtual dJointID id() const = 0;
    /// Also once it is broken and its joint attached to nothing.
    [[nodiscard]] virtual AttachedBodies bodies() const = 0;
    /// Which motor of ODE's joint it rules; -1: that joint is its own.
    [[nodiscard]] virtual int motor() const noexcept { return -1; }
    /// Null: its rows are a joint's of ODE.
    [[nodiscard]] virtual IslandRows* island_rows() noexcept { return nullptr; }

    /// A World that stepped it does so no more: ODE's joint is as without it.
    virtual void left_world() = 0;

    // ---- parts of a frame (world_parts.hpp)

    /// A frame begins: what hands did to the bodies is seen now, before they are half a step ahead.
    /// True where they put a saved state into it.
    virtual bool begin_frame() = 0;
    /// A kinematic body has these velocities where the coming part begins.
    virtual void driven_begins(dBodyID /*body*/, const Vector3<double>& /*velocity*/,
                               const Vector3<double>& /*spin*/) {}
    /// Keeps all that a part may change, for one put_all_back or more.
    virtual void keep_all() = 0;
    /// Everything is as it was at the last `keep_all`, bit for bit; the bodies are already.
    virtual void put_all_back() = 0;
    /// Adds what the last part did along the plastic axes; `joint`: its number.
    virtual void list_part_rows(std::size_t joint, std::vector<PartRow>& rows) const = 0;
};

} // namespace ductile::ode
