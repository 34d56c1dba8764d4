// SPDX-License-Identifier: MIT
//
// One object per Bullet world that steps it and looks after its plastic joints: the ledger, events
// with names, the worst certificate, a warning where the solver does not converge and what is done
// about it, and steps that follow the motion.
//
//   ductile::bullet::World world(dynamics, {.effort = {.action = OnUnconverged::direct_solver}});
//   world.add(hinge, "lamp post");
//   world.step(dt);
//   for (const auto& event : world.events()) ...       // "lamp post" yielded, broke
//
// The joints need nothing of this: without a World they are as exact. Step through `step` and
// `advance` alone, else ledger and clock miss something.
//
// A part of a step is one internal tick. Of a split step each part has the forces that were applied
// for the step; a kinematic body moved by hand makes its whole motion in the first part. A step
// throws std::invalid_argument where it, or its part, is shorter than Bullet steps.
//
// OnUnconverged::direct_solver: the group of islands with a joint suspect goes to Dantzig's method
// (suspect_solver.hpp) until all is calm. The user's solver is in place again when this object ends.
// Not for btMultiBodyDynamicsWorld, whose solver has to be direct from the start
// (multibody_solver.hpp); a btDiscreteDynamicsWorldMt with a solver for large islands of its own
// gives those to that.
//
// Of a world with multibodies no ledger is kept, and forces on them are not split: what their
// solve does to energies that depend on their pose cannot be told from outside.
//
// leapfrog: steps of second order (world/leapfrog.hpp). Velocities are then those in the middle of
// the last step, and so is the joints' own clock. Not for btMultiBodyDynamicsWorld.
//
// Not thread-safe; Bullet's world for threads may be below.
#pragma once

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <concepts>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/bullet/suspect_solver.hpp"
#include "ductile/bullet/energy.hpp"
#include "ductile/bullet/held_forces.hpp"
#include "ductile/bullet/force_share.hpp"
#include "ductile/bullet/multibody_constraint.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/world/stepped_world.hpp"

namespace ductile::bullet {

struct WorldParameters {
    EffortParameters effort{};  ///< what is done where the solver did not converge
    bool ledger = true;         ///< whether the energy account is kept; not with multibodies
    bool leapfrog = false;      ///< whether positions are of second order in the step
    Warn warn = warn_on_stderr; ///< once per joint; empty: nothing is said
};

class World final : public SteppedWorld {
  public:
    /// `world` must outlive this.
    /// @throws std::invalid_argument where a parameter is out of range or the solver of this world
    /// cannot be exchanged.
    explicit World(btDiscreteDynamicsWorld& world, WorldParameters parameters = {})
        : SteppedWorld(parameters.effort, std::move(parameters.warn)), world_(world) {
        if (parameters.effort.action == OnUnconverged::direct_solver) {
            require_exchangeable_solver();
            suspect_solver_ = std::make_unique<SuspectSolver>(*world_.getConstraintSolver());
            world_.setConstraintSolver(suspect_solver_.get());
        }
        if (parameters.ledger) meter_.emplace(world_);
        if (parameters.leapfrog) {
            require_leapfrog();
            start_leapfrog();
        }
    }
    /// Joints stay in Bullet's world.
    ~World() {
        if (leapfrogs()) share_forces(world_, {});
        if (suspect_solver_ != nullptr && world_.getConstraintSolver() == suspect_solver_.get()) {
            world_.setConstraintSolver(&suspect_solver_->usual());
        }
    }

    [[nodiscard]] btDiscreteDynamicsWorld& engine() const noexcept { return world_; }

    /// Looks after a joint, and puts it into Bullet's world where it is in none yet. It has to be
    /// removed before it is destroyed. An empty `name`: "joint" and its number.
    /// @throws std::invalid_argument where it is here already.
    template <class Joint>
    requires(std::derived_from<Joint, PlasticConstraint> ||
             std::derived_from<Joint, MultiBodyPlasticConstraint>) void add(Joint& joint,
                                                                            std::string name = {}) {
        supervisor().add(address(joint), std::move(name), [&joint] { return joint.report(); });
        told_ = -1;
        if (joint.in_world()) return;
        try {
            joint.add_to(engine_of(joint));
        } catch (...) {
            supervisor().remove(address(joint));
            throw;
        }
    }
    /// Takes a joint out of Bullet's world too. What is not here is left alone.
    template <class Joint>
    void remove(Joint& joint) {
        if (!supervisor().knows(address(joint))) return;
        supervisor().remove(address(joint));
        if (suspect_solver_ != nullptr) suspect_solver_->trust(address(joint));
        if constexpr (std::derived_from<Joint, PlasticConstraint>) {
            if (meter_) meter_->forget(joint);
            joint.set_force_share({});
        }
        if (joint.in_world()) joint.remove_from(engine_of(joint));
    }

  private:
    /// Bullet's own flag is not public.
    struct Ownership : btDiscreteDynamicsWorld {
        static bool of(btDiscreteDynamicsWorld& world) {
            return world.*(&Ownership::m_ownsConstraintSolver);
        }
    };

    void require_exchangeable_solver() const {
        if (dynamic_cast<btMultiBodyDynamicsWorld*>(&world_) != nullptr) {
            throw std::invalid_argument(
                "World.effort.action = direct_solver: must not be asked of a "
                "btMultiBodyDynamicsWorld: give it a MultiBodyMlcpSolver");
        }
        if (Ownership::of(world_)) {
            throw std::invalid_argument(
                "World.effort.action = direct_solver: must not be asked of a world that made its "
                "solver itself, as that one would be lost");
        }
    }

    void require_leapfrog() const {
        if (dynamic_cast<btMultiBodyDynamicsWorld*>(&world_) != nullptr) {
            throw std::invalid_argument(
                "World.leapfrog = true: must not be asked of a btMultiBodyDynamicsWorld");
        }
    }

    static const void* address(const PlasticConstraint& joint) {
        return static_cast<const btTypedConstraint*>(&joint);
    }
    static const void* address(const MultiBodyPlasticConstraint& joint) { return &joint; }

    [[nodiscard]] bool holds_multibodies() const noexcept {
        const auto* world = dynamic_cast<const btMultiBodyDynamicsWorld*>(&world_);
        return world != nullptr && world->getNumMultibodies() > 0;
    }

    btDynamicsWorld& engine_of(const PlasticConstraint&) const { return world_; }
    btMultiBodyDynamicsWorld& engine_of(const MultiBodyPlasticConstraint&) const {
        auto* world = dynamic_cast<btMultiBodyDynamicsWorld*>(&world_);
        if (world == nullptr) {
            throw std::invalid_argument(
                "World.world: must be a btMultiBodyDynamicsWorld for the joint of a multibody");
        }
        return *world;
    }

    // ---- what SteppedWorld asks of Bullet

    void require_possible(double dt) override {
        if (!(dt > double(SIMD_EPSILON))) {
            check::fail("World.step.dt", dt, "s", "longer than Bullet's shortest step");
        }
    }
    void do_part(double dt, const ForceShare& how, const Effort&) override {
        const bool keeps_ledger = meter_ && !holds_multibodies();
        if (keeps_ledger) meter_->before_step();
        const bool told = how.value == 1 && told_ == world_.getNumConstraints();
        if (leapfrogs() && !told) share_forces(world_, how);
        told_ = how.value == 1 ? world_.getNumConstraints() : -1;
        world_.stepSimulation(btScalar(dt), 0);
        if (keeps_ledger) meter_->after_step(double(btScalar(dt)), how.value);
    }
    void hold_forces() override { forces_.hold(world_); }
    void apply_held_forces() override { forces_.apply(); }
    [[nodiscard]] int iterations() const override { return world_.getSolverInfo().m_numIterations; }
    void set_iterations(int iterations) override {
        world_.getSolverInfo().m_numIterations = iterations;
    }
    void suspect(const void* joint) override {
        if (suspect_solver_ != nullptr) suspect_solver_->suspect(joint);
    }
    void finish(const Effort& effort) override {
        if (!effort.direct && suspect_solver_ != nullptr) suspect_solver_->trust_all();
    }
    [[nodiscard]] const Ledger<double>* kept_ledger() const noexcept override {
        return meter_ && !holds_multibodies() ? &meter_->ledger() : nullptr;
    }

    btDiscreteDynamicsWorld& world_;
    std::unique_ptr<SuspectSolver> suspect_solver_;
    std::optional<EnergyMeter> meter_;
    HeldForces forces_;
    int told_ = -1; ///< how many constraints know that forces act for the whole step
};

} // namespace ductile::bullet
