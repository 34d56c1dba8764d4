// SPDX-License-Identifier: MIT
//
// One object per ODE world that steps it and the plastic constraints in it, and looks after them:
// the ledger, events with names, the worst certificate, a warning where the solver does not
// converge and what is done about it, and steps that follow the motion. ODE calls nothing back at
// the end of a step, so the step has to go through here: one call in place of dWorldStep or
// dWorldQuickStep.
//
//   ductile::ode::World world(id, {.solver = ode::Solver::quick,
//                                  .effort = {.action = OnUnconverged::direct_solver}});
//   world.add(body);                                    // every dynamic body: for the ledger
//   world.add(hinge, "lamp post");
//   world.step(dt);
//   for (const auto& event : world.events()) ...       // "lamp post" yielded, broke
//
// A step is one of ODE's, or `effort().parts` equal ones. Of a split step each part has the forces
// that were applied for the step to the bodies added here, and the same contact joints.
//
// OnUnconverged::direct_solver: ODE has no solver per island, so the whole world's step goes to
// dWorldStep while a joint is in doubt. OnUnconverged::raise_iterations is for dWorldQuickStep;
// dWorldStep has none to raise.
//
// leapfrog: steps of second order (world/leapfrog.hpp) of the bodies added here, which have to be all
// that move. Velocities are then those in the middle of the last step, and so is the joints' clock.
//
// Not thread-safe. The world and the constraints must outlive this object, or be removed from it.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ductile/ode/energy.hpp"
#include "ductile/ode/held_forces.hpp"
#include "ductile/ode/kick.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/stepped_constraint.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/world/leapfrog.hpp"
#include "ductile/world/supervisor.hpp"

namespace ductile::ode {

/// ODE's two solvers: a direct one, exact, and an iterative one.
enum class Solver { direct, quick };

struct WorldParameters {
    Solver solver = Solver::direct;
    EffortParameters effort{};  ///< what is done where the solver did not converge
    bool ledger = true;         ///< whether the energy account is kept
    bool leapfrog = false;      ///< whether positions are of second order in the step
    Warn warn = warn_on_stderr; ///< once per joint; empty: nothing is said
};

class World {
  public:
    /// @throws std::invalid_argument where the world is null or a parameter is out of range.
    World(dWorldID world, WorldParameters parameters)
        : world_(require_world(world)),
          solver_(parameters.solver),
          supervisor_(parameters.effort, std::move(parameters.warn)) {
        if (parameters.ledger) meter_.emplace(world_);
        if (parameters.leapfrog) leapfrog_.emplace();
    }
    /// Steps, collects events, and says nothing by itself; no ledger.
    explicit World(dWorldID world, Solver solver = Solver::direct)
        : World(world, WorldParameters{.solver = solver, .ledger = false, .warn = nullptr}) {}
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    [[nodiscard]] dWorldID id() const noexcept { return world_; }

    /// Steps a joint and looks after it. An empty `name`: "joint" and its number.
    /// @throws std::invalid_argument where it is here already.
    void add(PlasticConstraint& joint, std::string name = {}) {
        supervisor_.add(&joint, std::move(name), [&joint] { return joint.report(); });
        constraints_.push_back(&joint);
        plastic_.push_back(&joint);
        bodies_known_ = false;
        joint.set_kick(1);
        if (meter_) meter_->add(joint);
    }
    /// What is not here is left alone.
    void remove(PlasticConstraint& joint) {
        supervisor_.remove(&joint);
        std::erase(constraints_, &joint);
        std::erase(plastic_, &joint);
        joint.set_kick(1);
        if (meter_) meter_->remove(joint);
    }
    /// Steps what is no plastic joint.
    void add(SteppedConstraint& constraint) { constraints_.push_back(&constraint); }
    void remove(SteppedConstraint& constraint) {
        std::erase(constraints_, &constraint);
        constraint.set_kick(1);
    }

    /// Tells of a dynamic body: ODE does not say which a world has.
    /// @throws std::invalid_argument where it is null or here already.
    void add(dBodyID body) {
        if (body == nullptr) throw std::invalid_argument("World.add.body = null: must be a body");
        if (std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end()) {
            throw std::invalid_argument("World.add.body: must not be in the world already");
        }
        bodies_.push_back(body);
        if (meter_) meter_->add(body);
    }
    /// To be called before the body is destroyed.
    void remove(dBodyID body) {
        std::erase(bodies_, body);
        bodies_known_ = false;
        if (meter_) meter_->remove(body);
    }
    /// Names a contact joint of the coming step, for the ledger.
    void add_contact(dJointID joint, const dContactGeom& geometry) {
        if (meter_) contacts_.emplace_back(joint, geometry);
    }

    // ---- stepping

    /// One step of `dt` > 0 [s].
    /// `scene`: what moves beside the joints, as far as known, such as a gap that closes; with it the
    /// world says where the step is too long for a contact.
    /// @throws std::invalid_argument where the step is not finite or not positive, or this leapfrogs
    /// and a joint's body was not added, and what a constraint's check() throws. The world stays as
    /// it was.
    void step(double dt, const SceneMotion<double>& scene = {}) {
        check::positive("World.step.dt", dt, "s");
        supervisor_.open();
        supervisor_.look_ahead(scene, dt);
        do_step(dt, time() + dt);
    }

    /// Steps for `duration` [s], to its end exactly, as `control` finds from the joints' motion and
    /// from what `scene` says before each step, such as a gap that closes; `scene` may also apply
    /// the forces and make the contacts of the step.
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
    static dWorldID require_world(dWorldID world) {
        if (world == nullptr) throw std::invalid_argument("World.world = null: must be a world");
        return world;
    }

    /// ODE's number of iterations, raised while this lives.
    class RaisedIterations {
      public:
        RaisedIterations(dWorldID world, int factor)
            : world_(world), usual_(dWorldGetQuickStepNumIterations(world)) {
            dWorldSetQuickStepNumIterations(world_, usual_ * factor);
        }
        ~RaisedIterations() { dWorldSetQuickStepNumIterations(world_, usual_); }
        RaisedIterations(const RaisedIterations&) = delete;
        RaisedIterations& operator=(const RaisedIterations&) = delete;

      private:
        dWorldID world_;
        int usual_;
    };

    void do_step(double dt, double end) {
        const Effort effort = supervisor_.effort();
        const double start = time(), part = dt / effort.parts;
        const RaisedIterations raised(world_, effort.iterations);
        if (effort.parts > 1) forces_.hold(bodies_);
        for (int i = 1; i <= effort.parts; ++i) {
            for (const SteppedConstraint* constraint : constraints_) constraint->check();
            if (leapfrog_ && !bodies_known_) require_bodies();
            if (i > 1) forces_.apply();
            do_part(part, effort.direct || solver_ == Solver::direct);
            supervisor_.look(i < effort.parts ? start + i * part : end, [](const void*) {});
        }
        contacts_.clear();
        supervisor_.close();
    }

    /// Gravity on a body that is not known would not leapfrog.
    void require_bodies() {
        std::vector<dBodyID> known = bodies_;
        std::sort(known.begin(), known.end());
        for (const PlasticConstraint* joint : plastic_) {
            for (const int side : {0, 1}) {
                const dBodyID body = dJointGetBody(joint->id(), side);
                if (body == nullptr || dBodyIsKinematic(body)) continue;
                if (std::binary_search(known.begin(), known.end(), body)) continue;
                throw std::invalid_argument(
                    "World.leapfrog = true: the bodies of every joint must have been added");
            }
        }
        bodies_known_ = true;
    }

    void do_part(double dt, bool direct) {
        if (meter_) {
            for (const auto& [joint, geometry] : contacts_) meter_->add_contact(joint, geometry);
            meter_->before_step();
        }
        const double share = leapfrog_ ? leapfrog_->share(dt) : 1;
        if (leapfrog_) kick(bodies_, constraints_, share);
        for (SteppedConstraint* constraint : constraints_) constraint->prepare(dt);
        if (direct) {
            dWorldStep(world_, dReal(dt));
        } else {
            dWorldQuickStep(world_, dReal(dt));
        }
        for (SteppedConstraint* constraint : constraints_) constraint->commit(dt);
        if (meter_) meter_->after_step(dt, share);
    }

    dWorldID world_;
    Solver solver_;
    Supervisor supervisor_;
    std::optional<EnergyMeter> meter_;
    HeldForces forces_;
    std::optional<Leapfrog> leapfrog_;
    std::vector<SteppedConstraint*> constraints_;
    std::vector<const PlasticConstraint*> plastic_;
    std::vector<dBodyID> bodies_;
    bool bodies_known_ = false; ///< all those of joints
    std::vector<std::pair<dJointID, dContactGeom>> contacts_; ///< of the coming step
};

} // namespace ductile::ode
