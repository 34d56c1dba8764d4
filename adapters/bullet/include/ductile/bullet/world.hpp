// SPDX-License-Identifier: MIT
//
// One object per Bullet world that steps it and looks after its plastic joints: the ledger, events
// with names, the worst certificate, a warning where rows were left unsolved, and frames as right
// as a tolerance says.
//
//   ductile::bullet::World world(dynamics);
//   world.add(hinge, "lamp post");
//   world.step(1.0 / 60);
//   for (const auto& event : world.events()) ...       // "lamp post" yielded, broke
//   if (!world.run().believed()) ...                   // more was left than the tolerance
//
// The joints need nothing of this: without a World they are as exact. Step through `step` alone,
// else ledger and clock miss something.
//
// Islands with a plastic joint are solved at once, contacts and friction too (front_solver.hpp),
// whatever the user's solver is, which gets all others and is in place again when this object ends.
// Not in a btMultiBodyDynamicsWorld, whose solver has to be direct from the start
// (multibody_solver.hpp); a btDiscreteDynamicsWorldMt with a solver for large islands of its own
// gives those to that.
//
// Of a world with multibodies no ledger is kept: what their solve does to energies that depend on
// their pose cannot be told from outside.
//
// A step is a frame, done in as many parts as the tolerance needs (world_parts.hpp); frame() and
// run() say what it took and what was left, of whom. Forces applied before the frame act in all of
// it. Motion states are told once, at its end; tick callbacks and actions are called in every part,
// also of those that are put back. Joints have to be added here or by add_to. Bullet then sorts its
// pairs (m_deterministicOverlappingPairs), so that a frame that was done again is bit for bit what
// it would have been. Not where the world has bodies that cannot be put back, multibodies or soft
// ones; there, and with tolerance = 0, a step is one internal tick.
//
// Not thread-safe; Bullet's world for threads may be below.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ductile/bullet/divisibles.hpp"
#include "ductile/bullet/multibody_constraint.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/joint_report.hpp"
#include "ductile/world/stepped_world.hpp"

namespace ductile::bullet {

class Divisible;
class EnergyMeter;
class FrontHold;
class Member;
class Members;
class WorldParts;
class WorldSnapshot;

struct WorldParameters {
    bool ledger = true; ///< whether the energy account is kept; not with multibodies
    /// Share of the plastic work that a step may misplace [-]: it is done in as many parts as that
    /// needs (frame/frame_control.hpp). 0: in one, as long as it is. Not said: 0.01, and 0 where
    /// the world has bodies that cannot be put back, multibodies or soft ones.
    std::optional<double> tolerance{};
    int budget = 256; ///< solves of a frame where `tolerance` > 0, >= 4
    /// Elastic structures that have been quiet for a second are damped until they rest: τ of their
    /// springs for each second after that [-], >= 0 (joint/swing.hpp). 0 where a structure is
    /// driven to vibrate, of which this would take for a minute.
    double rest_damping = ductile::rest_damping<double>;
    /// Whether in frames islands with springs of btGeneric6DofSpring2Constraint are solved at once,
    /// too, and have all of their stiffness, where Bullet limits it by the length of a frame
    /// (softened_springs.hpp). Else one that comes to a plastic joint so is said, once.
    bool springs = false;
    Warn warn = warn_on_stderr; ///< a line of the worst joint; empty: nothing is said
};

class World final : public SteppedWorld {
  public:
    /// `world` must outlive this, but for one that holds no constraint any more and whose solver
    /// was not exchanged.
    /// @throws std::invalid_argument where a parameter is out of range, the solver of this world
    /// cannot be exchanged, or it has another World.
    explicit World(btDiscreteDynamicsWorld& world, WorldParameters parameters = {});
    /// Joints stay in Bullet's world.
    DUCTILE_INLINE ~World();

    [[nodiscard]] btDiscreteDynamicsWorld& engine() const noexcept { return world_; }

    /// Looks after a joint until that ends, and puts it into Bullet's world where it is in none
    /// yet: its bodies do not collide with each other until it breaks. Where they are to, call its
    /// add_to(engine(), false) before. An empty `name`: "joint" and its number.
    /// @throws std::invalid_argument where it is here already.
    void add(PlasticConstraint& joint, std::string name = {});
    void add(MultiBodyPlasticConstraint& joint, std::string name = {});
    /// Looks after a member (member.hpp) until it ends or is removed. Its body is in Bullet's world
    /// already. What concerns members and structures needs members.hpp.
    /// @throws std::invalid_argument where it is in a world already, a constraint that it did not
    /// make holds its body, or this world is a btMultiBodyDynamicsWorld.
    void add(Member& member, std::string name = {});
    /// One that is open is one body first, bent as it is.
    void remove(Member& member);
    /// Looks after a structure that opens its joints (structure_in_time.hpp, which calls this).
    /// @throws as add of a member.
    void add(Divisible& structure, const std::vector<DivisionReport>& reports);
    void remove(Divisible& structure, const std::vector<DivisionReport>& reports);
    /// Its bodies are others than they were, and not by a step.
    void rearranged(const Divisible& structure);
    /// A joint of it that is open swings until it rests, as those that were added do.
    void look_after_rest(PlasticConstraint& joint) {
        keep(joint, [] {});
    }
    /// Applies a force to a body for the coming step, at a place, both world [N, m]: through the
    /// parts of a frame it goes along with that place, where the torque of Bullet's own applyForce
    /// stays as it is. Wakes the body.
    /// @throws std::invalid_argument where one is not finite.
    void apply_force(btRigidBody& body, const Vector3<double>& force, const Vector3<double>& at);
    /// Takes a joint out of Bullet's world too. What is not here is left alone.
    void remove(PlasticConstraint& joint);
    void remove(MultiBodyPlasticConstraint& joint);

  private:
    void forget(PlasticConstraint& joint);
    /// Of Bullet's world all plastic joints are told, not those alone that were added here.
    void tell_ahead();
    /// From the first one on.
    [[nodiscard]] Members& members();
    void step_with_members(double dt);
    void tell_of_springs();
    void tell_of_members();
    void tell_idle(bool after);
    void start_frames(double tolerance, int budget);
    [[nodiscard]] bool can_put_back() const noexcept;
    [[nodiscard]] bool holds_multibodies() const noexcept;
    [[nodiscard]] btMultiBodyDynamicsWorld& world_of_multibodies() const;

    // ---- what SteppedWorld asks of Bullet

    DUCTILE_INLINE void require_possible(double dt) override;
    DUCTILE_INLINE void do_step(double dt) override;
    [[nodiscard]] DUCTILE_INLINE PartEngine& begin_frame(double length) override;
    DUCTILE_INLINE void end_frame() override;
    [[nodiscard]] DUCTILE_INLINE bool has_body(const void* body) const override;
    [[nodiscard]] DUCTILE_INLINE const Ledger<double>* kept_ledger() const noexcept override;

    btDiscreteDynamicsWorld& world_;
    std::unique_ptr<FrontHold> front_; ///< not in a world of multibodies
    std::unique_ptr<EnergyMeter> meter_;
    bool tells_ledger_ = false, told_of_springs_ = false;
    std::unique_ptr<Divisibles> members_;
    std::vector<std::pair<const void*, bool>> idle_; ///< of members, from the next step on
    std::unique_ptr<WorldSnapshot> snapshot_;        ///< of a step, while there are members
    std::unique_ptr<WorldParts> parts_;              ///< where frames have a tolerance
    std::vector<const PlasticConstraint*> joints_;
    std::unordered_set<PlasticConstraint*> told_ahead_; ///< whose parts are this World's
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/world.ipp"
#endif
