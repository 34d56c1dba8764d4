// SPDX-License-Identifier: MIT
//
// What is fewer bodies than it may come to be, as a World sees it: a member, a structure.
#pragma once

#include <ode/ode.h>

#include <span>
#include <string>
#include <vector>

#include "ductile/member/divisible.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/world/joint_report.hpp"

namespace ductile::ode {

class World;
struct UserJoint;

/// A contact of the coming step on something divisible, told by what it does to the first body of
/// attached_bodies.
struct Touch {
    dJointID joint;
    AttachedBodies bodies;
    bool of_a; ///< whose it is
    Vector3<double> point, normal;
    double closing = 0;                       ///< speed before the solve [m/s]
    const dJointFeedback* feedback = nullptr; ///< of the step, once it is solved
    int segment = 0;                          ///< or body of a plan, on which it acts, once read

    /// As the bodies move now [m/s].
    [[nodiscard]] double closing_speed() const {
        return dot(normal, difference(velocity_at(bodies.b, point), velocity_at(bodies.a, point)));
    }
};

/// Not thread-safe.
class Divisible : public ductile::Divisible<PlasticConstraint, UserJoint> {
  public:
    // ---- its life in a World, which calls these

    /// @throws std::invalid_argument where it cannot be in it.
    virtual void enter(World& /*world*/) {}
    /// The World does not have, or has again, a body.
    virtual void body_left(dBodyID /*body*/) {}
    virtual void body_came(dBodyID /*body*/) {}
    /// The bodies that it is now.
    [[nodiscard]] virtual std::vector<dBodyID> bodies() const = 0;
    /// Under which keys what may open is reported, as what; `name`: the user's.
    [[nodiscard]] virtual std::vector<DivisionReport> reports(const std::string& name) const = 0;
    /// Whether contacts between two bodies of it are not to be.
    [[nodiscard]] virtual bool hangs_together(dBodyID a, dBodyID b) const = 0;
    /// Whether a joint of the user's holds another body to what hangs together with one of it.
    [[nodiscard]] virtual bool holds(dBodyID own, dBodyID other) const = 0;
    /// @throws std::logic_error where it cannot be stepped; nothing has changed then.
    virtual void require_possible() = 0;

    // ---- a step

    /// The bodies are where they are solved. Joints of the user's whose feedback is to be read.
    virtual void before_solve(std::vector<dJointID>& joints) = 0;
    /// The bodies have their new velocities.
    virtual void after_solve() = 0;
    /// Sections to open after a step of `dt` [s] on which these contacts acted, or a blow.
    virtual void find_beyond(double dt, std::span<Touch> touches, std::vector<int>& sections) = 0;
    virtual void find_struck(double dt, std::span<Touch> touches, std::vector<int>& sections) = 0;
    /// Of the strength of a section that what acted in the step looked at could load it with, at
    /// most.
    [[nodiscard]] virtual double most_share() const { return 1; }
    /// Has a segment, or body of a plan, now.
    [[nodiscard]] virtual dBodyID body_of(int segment) const = 0;
};

} // namespace ductile::ode
