// SPDX-License-Identifier: MIT
//
// What is fewer bodies than it may come to be, as a World sees it: a member, a structure.
#pragma once

#include <ode/ode.h>

#include <span>
#include <string>
#include <vector>

#include "ductile/member/active_sections.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/world/joint_report.hpp"

namespace ductile::ode {

class World;

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
class Divisible {
  public:
    Divisible() = default;
    Divisible(const Divisible&) = delete;
    Divisible& operator=(const Divisible&) = delete;
    virtual ~Divisible() = default;

    // ---- its life in a World, which calls these

    /// @throws std::invalid_argument where it cannot be in it.
    virtual void enter(World& world) = 0;
    /// It is in the World no more, and one body.
    virtual void leave() = 0;
    /// The World does not have, or has again, a body.
    virtual void body_left(dBodyID body) = 0;
    virtual void body_came(dBodyID body) = 0;
    [[nodiscard]] virtual bool is_open() const = 0;
    /// The bodies that it is now.
    [[nodiscard]] virtual std::vector<dBodyID> bodies() const = 0;
    /// Under which keys what may open is reported, as what; `name`: the user's.
    [[nodiscard]] virtual std::vector<DivisionReport> reports(const std::string& name) const = 0;
    /// Of a joint of its own; no_section: it is not.
    [[nodiscard]] virtual int section_of(const PlasticConstraint& joint) const = 0;
    /// Under which a section is reported.
    [[nodiscard]] virtual const void* key_of(int /*section*/) const { return this; }
    /// Whether contacts between two bodies of it are not to be.
    [[nodiscard]] virtual bool hangs_together(dBodyID a, dBodyID b) const = 0;
    /// Whether a joint of the user's holds another body to what hangs together with one of it.
    [[nodiscard]] virtual bool holds(dBodyID /*own*/, dBodyID /*other*/) const { return false; }
    /// Of sections that are closed [J]; that of a least travel, 0: of none.
    [[nodiscard]] virtual double closed_work() const = 0;
    [[nodiscard]] virtual double unmissed_work() const = 0;
    /// @throws std::logic_error where it cannot be stepped; nothing has changed then.
    virtual void require_possible() = 0;

    // ---- a step

    /// Forces that were applied to it act in the coming solve, too; they do not any more.
    virtual void apply_forces() = 0;
    virtual void drop_forces() = 0;
    /// The bodies are where they are solved. Joints of the user's whose feedback is to be read.
    virtual void before_solve(std::vector<dJointID>& joints) = 0;
    /// In the coming solve a driven body passes through what does not move of it.
    virtual void driven_through() = 0;
    /// The bodies have their new velocities.
    virtual void after_solve() = 0;
    /// Sections to open after a step of `dt` [s] on which these contacts acted, or a blow.
    virtual void find_beyond(double dt, std::span<Touch> touches, std::vector<int>& sections) = 0;
    /// Joints of the user's count in it that take more than `noticed` [J].
    virtual void begin_blow(double noticed) = 0;
    /// Joints that hold on to it what can move are off, or on again, so that the bodies go as they
    /// would without it; false: there are none.
    virtual bool switch_holds(bool /*on*/) { return false; }
    /// So they go, until the next blow.
    virtual void see_coming() {}
    virtual void find_struck(double dt, std::span<Touch> touches, std::vector<int>& sections) = 0;
    virtual void open(std::span<const int> sections, bool ahead) = 0;
    /// Has a segment, or body of a plan, now.
    [[nodiscard]] virtual dBodyID body_of(int segment) const = 0;
    /// A step stands: what it left in vibration, of what its sections took [J].
    virtual double count_vibration() = 0;
    /// The same, or a blow comes: closes what held, and says which sections that were.
    virtual std::vector<int> close_held(Closing when, bool ahead) = 0;
};

} // namespace ductile::ode
