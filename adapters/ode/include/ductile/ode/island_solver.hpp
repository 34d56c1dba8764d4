// SPDX-License-Identifier: MIT
//
// Stands before ODE's step: an island whose rows are all known is solved at once
// (solve/island_solver.hpp), and ODE gets the answer as forces on the bodies. World calls it.
//
//   known      plastic joints, which state their rows themselves, contacts that were named with
//              what they were made of, sliding friction, no rolling, and most of ODE's own joints,
//              also a PlasticMotor's (own_joint.hpp)
//   not known  the others, those that hold members, and contacts that nobody named: the island is
//              ODE's then, whichever solver steps it
//
// In the step the plastic joints have no row in ODE, and contacts and ODE's own joints are
// disabled; bodies of the island that sleep are woken, as ODE would.
//
// Friction. dContactApprox1 is Coulomb's cone here, where ODE has a pyramid; without it mu is a
// force, as in ODE. A contact joint's feedback is what this solver found.
//
// Sleep. ODE puts bodies to sleep one by one within its step, where they lose their velocity
// although a neighbour wakes them again. An island that is solved here falls asleep as a whole,
// once all its bodies have been slower than their thresholds for their steps and times (of the last
// velocity: no average over samples).
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/ode/contact_rows.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/own_joint.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/solve/island_solver.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

class IslandSolver {
  public:
    void add(PlasticConstraint& joint);
    void remove(PlasticConstraint& joint);

    /// Between the constraints' `prepare` and ODE's step of `dt` [s]. `may_sleep`: islands may fall
    /// asleep in it. Islands of `others`, which can move, are solved here too, joints or none;
    /// those of user's joints `of_members`, which change their bodies, are not.
    void before_step(const std::vector<NamedContact>& contacts, double dt, bool may_sleep = true,
                     std::span<const dBodyID> others = {},
                     std::span<const dJointID> of_members = {});
    void after_step();

  private:
    struct Member {
        PlasticConstraint* joint;
        IslandRows* rows;     ///< null: a motor of one of ODE's own joints
        std::size_t seen = 0; ///< number of the step
        [[nodiscard]] bool acts() const {
            return rows != nullptr
                       ? rows->acts()
                       : !joint->queries().broken() && dJointIsEnabled(joint->id()) != 0;
        }
    };
    /// All its bodies at once.
    struct Idle {
        int steps = 0;
        double time = 0; ///< [s]
    };
    /// By the island's first joint.
    struct Kept {
        solve::IslandSolver solver; ///< keeps the topology
        Idle idle;
        std::size_t used = 0; ///< number of the step
    };

    struct Own {
        OwnJoint joint;
        std::size_t number;   ///< in the order in which they were seen first
        std::size_t seen = 0; ///< number of the step
    };

    void index_members();
    /// Null: its rows are not known.
    [[nodiscard]] Own* own_of(dJointID joint);
    [[nodiscard]] bool gather(dBodyID first);
    [[nodiscard]] bool falls_asleep(Kept& kept, double dt) const;
    void solve(solve::IslandSolver& solver, const std::vector<NamedContact>& contacts, double dt);
    [[nodiscard]] bool turns(double dt);
    void take_seat(dBodyID body, double dt);
    [[nodiscard]] IslandSeat seat(dBodyID body) const;
    void set_aside(const std::vector<NamedContact>& contacts);
    [[nodiscard]] Kept& kept_of(const PlasticConstraint& first);

    std::size_t step_ = 0;
    std::vector<Member> members_;       ///< in the order in which they were added
    AddressMap<std::size_t> member_of_; ///< by joint
    bool indexed_ = true;
    AddressMap<std::size_t> contact_of_; ///< by joint
    std::unordered_map<const PlasticConstraint*, Kept> kept_;
    std::unordered_map<dJointID, Own> owns_; ///< ODE's own joints
    std::size_t owns_seen_ = 0;              ///< ever

    // ---- of the island at hand
    std::vector<std::size_t> joints_, touches_; ///< among members and contacts
    std::vector<Own*> owned_;
    std::span<const dJointID> of_members_;
    std::vector<dBodyID> bodies_;         ///< that can move
    AddressMap<int> number_;              ///< of bodies, of all islands of the step
    std::vector<BodyState<double>> free_; ///< by number: as the step leaves them without rows
    solve::Island island_;
    std::vector<ContactRows> contact_rows_;
    bool awake_ = false;
    bool ahead_ = false;

    // ---- until the end of the step
    std::vector<dJointID> disabled_; ///< contacts, ODE's own joints
    /// Bodies that would put themselves to sleep, and from how many samples they would tell.
    std::vector<std::pair<dBodyID, int>> kept_awake_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/island_solver.ipp"
#endif
