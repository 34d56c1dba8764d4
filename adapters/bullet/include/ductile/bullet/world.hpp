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
// A step is one internal tick, or `effort().parts` equal ones. Of a split step each part has the
// forces that were applied for the step; a kinematic body moved by hand makes its whole motion in
// the first part.
//
// OnUnconverged::direct_solver: the group of islands with a joint in doubt goes to Dantzig's method
// (doubt_solver.hpp) until all is calm. The user's solver is in place again when this object ends.
// Not for btMultiBodyDynamicsWorld, whose solver has to be direct from the start
// (multibody_solver.hpp); a btDiscreteDynamicsWorldMt with a solver for large islands of its own
// gives those to that.
//
// Not booked and not split: forces on, and energy of, multibodies. Keep no ledger there.
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
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/bullet/doubt_solver.hpp"
#include "ductile/bullet/energy.hpp"
#include "ductile/bullet/held_forces.hpp"
#include "ductile/bullet/kick.hpp"
#include "ductile/bullet/multibody_constraint.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/world/leapfrog.hpp"
#include "ductile/world/supervisor.hpp"

namespace ductile::bullet {

struct WorldParameters {
    EffortParameters effort{};  ///< what is done where the solver did not converge
    bool ledger = true;         ///< whether the energy account is kept
    bool leapfrog = false;      ///< whether positions are of second order in the step
    Warn warn = warn_on_stderr; ///< once per joint; empty: nothing is said
};

class World {
  public:
    /// `world` must outlive this.
    /// @throws std::invalid_argument where a parameter is out of range or the solver of this world
    /// cannot be exchanged.
    explicit World(btDiscreteDynamicsWorld& world, WorldParameters parameters = {})
        : world_(world), supervisor_(parameters.effort, std::move(parameters.warn)) {
        if (parameters.effort.action == OnUnconverged::direct_solver) {
            require_exchangeable_solver();
            doubts_ = std::make_unique<DoubtSolver>(*world_.getConstraintSolver());
            world_.setConstraintSolver(doubts_.get());
        }
        if (parameters.ledger) meter_.emplace(world_);
        if (parameters.leapfrog) start_leapfrog();
    }
    /// Joints stay in Bullet's world.
    ~World() {
        if (leapfrog_) kick(world_, 1);
        if (doubts_ != nullptr && world_.getConstraintSolver() == doubts_.get()) {
            world_.setConstraintSolver(&doubts_->usual());
        }
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    [[nodiscard]] btDiscreteDynamicsWorld& engine() const noexcept { return world_; }

    /// Looks after a joint, and puts it into Bullet's world where it is in none yet. It has to be
    /// removed before it is destroyed. An empty `name`: "joint" and its number.
    /// @throws std::invalid_argument where it is here already.
    template <class Joint>
    requires(std::derived_from<Joint, PlasticConstraint> ||
             std::derived_from<Joint, MultiBodyPlasticConstraint>) void add(Joint& joint,
                                                                            std::string name = {}) {
        supervisor_.add(address(joint), std::move(name), [&joint] { return joint.report(); });
        if (joint.in_world()) return;
        try {
            joint.add_to(engine_of(joint));
        } catch (...) {
            supervisor_.remove(address(joint));
            throw;
        }
    }
    /// Takes a joint out of Bullet's world too. What is not here is left alone.
    template <class Joint>
    void remove(Joint& joint) {
        if (!supervisor_.knows(address(joint))) return;
        supervisor_.remove(address(joint));
        if (doubts_ != nullptr) doubts_->trust(address(joint));
        if constexpr (std::derived_from<Joint, PlasticConstraint>) {
            if (meter_) meter_->forget(joint);
            joint.set_kick(1);
        }
        if (joint.in_world()) joint.remove_from(engine_of(joint));
    }

    // ---- stepping

    /// One step of `dt` [s].
    /// `scene`: what moves beside the joints, as far as known, such as a gap that closes; with it the
    /// world says where the step is too long for a contact.
    /// @throws std::invalid_argument where it is not finite, or shorter than Bullet steps.
    void step(double dt, const SceneMotion<double>& scene = {}) {
        supervisor_.open();
        supervisor_.look_ahead(scene, dt);
        do_step(dt, time() + dt);
    }

    /// Steps for `duration` [s], to its end exactly, as `control` finds from the joints' motion and
    /// from what `scene` says before each step, such as a gap that closes; `scene` may also apply
    /// the forces of the step.
    /// @throws std::invalid_argument where the duration is not positive.
    void advance(double duration, StepControl<double>& control,
                 const std::function<SceneMotion<double>()>& scene = {}) {
        supervisor_.advance(duration, control, scene,
                            [this](double dt, double end) { do_step(dt, end); });
    }

    /// Where it leapfrogs: the bodies' velocities are those of now, as at the start, somebody having
    /// given them to them.
    void restart() noexcept {
        if (leapfrog_) leapfrog_->restart();
    }

    // ---- what it tells

    /// Since this object was made [s].
    [[nodiscard]] double time() const noexcept { return supervisor_.time(); }
    /// @throws std::logic_error where none is kept.
    [[nodiscard]] const Ledger<double>& ledger() const {
        if (!meter_) throw std::logic_error("World.ledger = false: there is none");
        return meter_->ledger();
    }
    /// Of the last step() or advance(), valid until the next one.
    [[nodiscard]] std::span<const JointEvent<double>> events() const noexcept {
        return supervisor_.events();
    }
    /// Is called for every event at the end of the step, or its part; it may add and remove joints,
    /// not step.
    void on_event(Supervisor::Listener listener) { supervisor_.on_event(std::move(listener)); }
    /// Worst certificate of the last step() or advance(); watch().name() says whose.
    [[nodiscard]] const WorstCertificate<double>& worst() const noexcept { return watch().worst(); }
    [[nodiscard]] const Watch<double>& watch() const noexcept { return supervisor_.watch(); }
    /// True where parts may have passed through each other unseen in the last step().
    [[nodiscard]] bool may_miss_contact() const noexcept {
        return supervisor_.may_miss_contact();
    }
    /// With what the next step is done.
    [[nodiscard]] const Effort& effort() const noexcept { return supervisor_.effort(); }

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

    void start_leapfrog() {
        if (dynamic_cast<btMultiBodyDynamicsWorld*>(&world_) != nullptr) {
            throw std::invalid_argument(
                "World.leapfrog = true: must not be asked of a btMultiBodyDynamicsWorld");
        }
        leapfrog_.emplace();
    }

    static const void* address(const PlasticConstraint& joint) {
        return static_cast<const btTypedConstraint*>(&joint);
    }
    static const void* address(const MultiBodyPlasticConstraint& joint) { return &joint; }

    btDynamicsWorld& engine_of(const PlasticConstraint&) const { return world_; }
    btMultiBodyDynamicsWorld& engine_of(const MultiBodyPlasticConstraint&) const {
        auto* world = dynamic_cast<btMultiBodyDynamicsWorld*>(&world_);
        if (world == nullptr) {
            throw std::invalid_argument(
                "World.world: must be a btMultiBodyDynamicsWorld for the joint of a multibody");
        }
        return *world;
    }

    /// Bullet's number of iterations, raised while this lives.
    class RaisedIterations {
      public:
        RaisedIterations(btContactSolverInfo& info, int factor)
            : info_(info), usual_(info.m_numIterations) {
            info_.m_numIterations *= factor;
        }
        ~RaisedIterations() { info_.m_numIterations = usual_; }
        RaisedIterations(const RaisedIterations&) = delete;
        RaisedIterations& operator=(const RaisedIterations&) = delete;

      private:
        btContactSolverInfo& info_;
        int usual_;
    };

    void do_step(double dt, double end) {
        const Effort effort = supervisor_.effort();
        const double start = time(), part = dt / effort.parts;
        check::positive("World.step.dt", dt, "s");
        if (!(part > double(SIMD_EPSILON))) {
            check::fail("World.step.dt", part, "s", "longer than Bullet's shortest step");
        }
        const RaisedIterations raised(world_.getSolverInfo(), effort.iterations);
        if (effort.parts > 1) forces_.hold(world_);
        for (int i = 1; i <= effort.parts; ++i) {
            if (i > 1) forces_.apply();
            if (meter_) meter_->before_step();
            const double share = leapfrog_ ? leapfrog_->share(part) : 1;
            if (leapfrog_) kick(world_, share);
            world_.stepSimulation(btScalar(part), 0);
            if (meter_) meter_->after_step(double(btScalar(part)), share);
            supervisor_.look(i < effort.parts ? start + i * part : end, [this](const void* joint) {
                if (doubts_ != nullptr) doubts_->doubt(joint);
            });
        }
        if (!supervisor_.close().direct && doubts_ != nullptr) doubts_->trust_all();
    }

    btDiscreteDynamicsWorld& world_;
    Supervisor supervisor_;
    std::unique_ptr<DoubtSolver> doubts_;
    std::optional<EnergyMeter> meter_;
    HeldForces forces_;
    std::optional<Leapfrog> leapfrog_;
};

} // namespace ductile::bullet
