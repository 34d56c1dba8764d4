// SPDX-License-Identifier: MIT
//
// One object per ODE world that steps it and the plastic constraints in it, and looks after them:
// the ledger, events with names, the worst certificate, a warning where rows were left unsolved,
// and steps that follow the motion. ODE calls nothing back at the end of a step, so the step has to
// go through here: one call in place of dWorldStep or dWorldQuickStep.
//
//   ductile::ode::World world(id, {.solver = ode::Solver::quick});
//   world.add(body);                                    // every dynamic body: for the ledger
//   world.add(hinge, "lamp post");
//   world.step(dt);
//   for (const auto& event : world.events()) ...       // "lamp post" yielded, broke
//
// Islands of plastic joints, of contacts that were named by add_contact and of ODE's own joints are
// solved at once, before ODE's step and whichever solver does that (island_solver.hpp); all others
// are ODE's.
//
// A step throws what a constraint's check() throws, and std::invalid_argument where a body that was
// added, or has a plastic joint, is not finite in pose, velocity or force, or the gravity is not, a
// body's damping is more than its whole speed, a contact was named with what is none: ODE, built
// with its assertions, would end the process. Nothing has changed then, and contacts are to be
// named anew.
//
// on_contacts: who makes the contacts of a step, so that they need not be made before it.
//
// tolerance: a step is a frame, done in as many parts as the tolerance needs (world_parts.hpp):
//
//   ductile::ode::World world(id, {.tolerance = 0.01});
//   world.on_contacts({.space = space, .group = group},
//                     [&] { dSpaceCollide(space, &world, near); }); // near: add_contact
//   world.step(1.0 / 60);
//   if (!world.run().believed()) ...                   // frame(), run() say what was left, of whom
//
// Forces applied before the frame act in all of it. Every body that moves has to be added here, and
// contacts come of on_contacts alone: each part, and each look for gaps that close, has its own.
// Thin and fast things are not missed as long as their geoms are in that space. ODE's callbacks and
// those of contacts are called in every part, also of those that are put back. Islands fall asleep
// as a whole, told once a frame (resting_islands.hpp).
//
// Members (member.hpp) are one body until a section yields. While there are any, each step is kept
// before it is done, and done again with more sections open until none that is closed is beyond its
// strength. ODE's counters of steps and time until sleep count what was put back too.
//
// Not thread-safe. ODE's world must outlive every step; all else may end in any order.
#pragma once

#include <ode/ode.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ductile/ode/contact_maker.hpp"
#include "ductile/ode/divisibles.hpp"
#include "ductile/ode/held_forces.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/stepped_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/stepped_world.hpp"

namespace ductile::ode {

class Divisible;
class EnergyMeter;
class IslandSolver;
class Members;
class WorldParts;
class WorldSnapshot;

/// ODE's two solvers: a direct one, exact, and an iterative one.
enum class Solver { direct, quick };

struct WorldParameters {
    Solver solver = Solver::direct;
    bool ledger = true; ///< whether the energy account is kept
    /// > 0: a step is a frame, and this the share of the plastic work that may be misplaced [-];
    /// 0: a step is one of the engine's
    double tolerance = 0;
    int budget = 256; ///< solves of a frame, >= 4
    /// Elastic structures that have been quiet for a second are damped until they rest: τ of their
    /// springs for each second after that [-], >= 0 (joint/swing.hpp). 0 where a structure is
    /// driven to vibrate, of which this would take for a minute.
    double rest_damping = ductile::rest_damping<double>;
    Warn warn = warn_on_stderr; ///< a line of the worst joint; empty: nothing is said
};

class World final : public SteppedWorld {
  public:
    /// @throws std::invalid_argument where the world is null or a parameter is out of range.
    World(dWorldID world, WorldParameters parameters);
    /// Steps, collects events, and says nothing by itself; no ledger.
    explicit World(dWorldID world, Solver solver = Solver::direct);
    /// Joints and members stay in ODE's world.
    DUCTILE_INLINE ~World();

    [[nodiscard]] dWorldID id() const noexcept { return world_; }

    /// Steps a joint and looks after it, until it ends. An empty `name`: "joint" and its number.
    /// @throws std::invalid_argument where it is here already, or of another world, a body of it
    /// was destroyed, or another one rules that axis of a joint of ODE's.
    void add(PlasticConstraint& joint, std::string name = {});
    /// What is not here is left alone.
    void remove(PlasticConstraint& joint);
    /// Steps what is no plastic joint, until it ends.
    /// @throws std::invalid_argument where the world has a tolerance: it could not be put back.
    void add(SteppedConstraint& constraint);
    void remove(SteppedConstraint& constraint);

    /// Looks after a member until it ends or is removed; its body is added where it was not. Needs
    /// members.hpp.
    /// @throws std::invalid_argument where it is in a world already, its body is of another one, a
    /// joint that cannot go along holds that, or this World's solver is Solver::quick.
    void add(Divisible& member, std::string name = {});
    /// One that is open is one body first, bent as it is.
    void remove(Divisible& member);

    /// Tells of a dynamic body: ODE does not say which a world has.
    /// @throws std::invalid_argument where it is null, here already, or of another world.
    void add(dBodyID body);
    /// To be called before the body is destroyed.
    void remove(dBodyID body);
    /// Applies a force to a body for the coming step, at a place, both world [N, m]: through the
    /// parts of a frame it goes along with that place, where the torque of dBodyAddForceAtPos stays
    /// as it is. Enables the body.
    /// @throws std::invalid_argument where one is not finite, or the body is null.
    void apply_force(dBodyID body, const Vector3<double>& force, const Vector3<double>& at);
    /// Names a contact joint of the coming step and what it was made of, for the ledger and so that
    /// islands with plastic joints are solved with it (island_solver.hpp). One between two bodies
    /// that a plastic joint holds together, until that breaks, or of a member that hang together,
    /// or of one and what a joint of ODE's holds to it, is disabled, as it would fight their rows;
    /// where `between_joined` that of a joint is not, as where a gap between them may close. Of a
    /// motor the hinge is the user's, and so is this. What is no contact, or not finite, the step
    /// refuses: ODE's spaces would stay locked where their callback throws.
    /// @throws std::logic_error where the world has a tolerance and it is not called by what
    /// on_contacts was given.
    void add_contact(dJointID joint, const dContact& contact, bool between_joined = false);
    /// From now on `make` is called for the contacts of each step, part, and look for gaps; it
    /// makes their joints in the group and names them by add_contact. The group is emptied around
    /// that.
    /// @throws std::invalid_argument as ContactMaker, std::logic_error where contacts are made now.
    void on_contacts(const ContactParameters& parameters, std::function<void()> make);

  private:
    // ---- what SteppedWorld asks of ODE

    DUCTILE_INLINE void require_possible(double dt) override;
    DUCTILE_INLINE void do_step(double dt) override;
    [[nodiscard]] DUCTILE_INLINE PartEngine& begin_frame(double length) override;
    [[nodiscard]] DUCTILE_INLINE bool sleep_through(double length) override;
    DUCTILE_INLINE void end_frame() override;
    [[nodiscard]] DUCTILE_INLINE bool has_body(const void* body) const override;
    [[nodiscard]] DUCTILE_INLINE const Ledger<double>* kept_ledger() const noexcept override;

    friend class Member;
    friend class MemberSnapshot;
    friend class StructureInTime;
    /// Of a member or a structure: it is not reported by itself.
    void take_in(PlasticConstraint& joint);
    void forget(PlasticConstraint& joint);
    void step_with_members(double dt);
    /// From the first one on.
    [[nodiscard]] Members& members();
    void tell_of_members();
    /// Of each plastic joint, by the first of those that hang together.
    [[nodiscard]] std::vector<std::size_t> islands() const;
    void start_frames(const WorldParameters& parameters);
    /// ODE's step, with what constraints do before it.
    void solve(double dt);
    void step_engine(double dt);
    /// What they did in it; the breaking ones still hold on.
    void book(double dt);
    /// The step stands.
    void let_go_of_broken();
    /// Whether a plastic joint, no motor, holds two bodies together.
    [[nodiscard]] bool are_joined(dBodyID a, dBodyID b) const;
    /// A body that is not known would not be put back: of joints, also ODE's own, of contacts, of
    /// geoms.
    void require_all_bodies();
    /// One is gone.
    void number_bodies();
    void require_known(dBodyID body) const;
    void require_finite();
    void require_slow() const;
    void require_contacts();

    dWorldID world_;
    Solver solver_;
    std::unique_ptr<EnergyMeter> meter_;
    bool tells_ledger_ = false;
    std::vector<SteppedConstraint*> constraints_;
    std::vector<PlasticConstraint*> plastic_;
    std::vector<dBodyID> bodies_;
    AddressBook known_;                  ///< all of these
    std::vector<NamedContact> contacts_; ///< of the coming step
    std::string refused_;                ///< why one of them is
    std::unique_ptr<IslandSolver> islands_;
    std::unique_ptr<Divisibles> members_;
    std::unique_ptr<WorldSnapshot> snapshot_; ///< of a step, while there are members
    HeldForces forces_;
    std::optional<ContactMaker> maker_;
    std::unique_ptr<WorldParts> parts_; ///< where frames have a tolerance
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/world.ipp"
#endif
