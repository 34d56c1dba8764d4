// SPDX-License-Identifier: MIT
//
// A small ODE world for the contract suite. Same verbs as bullet_rig.hpp.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/capability.hpp"
#include "ductile/ode/energy_meter.hpp"
#include "ductile/ode/ode.hpp"

namespace ductile::test {

using V3 = Vector3<double>;
using Joint = OneAxisJoint<Perfect<double>>;

class Rig {
  public:
    using Hinge = ode::PlasticHinge<>;
    using Slider = ode::PlasticSlider<>;
    using HardeningHinge = ode::PlasticHinge<OneAxisJoint<Linear<double>>>;
    using Body = dBodyID;
    static constexpr const char* engine = "ODE";
    static constexpr bool meets_surfaces = true; ///< in the solve, not by bounds
    static constexpr bool single = sizeof(dReal) == sizeof(float);

    /// CFM of a softened world: what rows give per force [m/s/N]. ODE's default of 1e-10 lets 100
    /// kN move by 1e-5 m/s; this is just enough to regularise rows that depend on each other.
    static constexpr double softness = single ? 1e-9 : 1e-13;

    /// Solvers to run every test with.
    static std::vector<std::string> solvers() { return {"direct", "quick"}; }

    /// The World solves all of it itself.
    [[nodiscard]] static bool can(const std::string& /*solver*/, Capability /*capability*/) {
        return true;
    }

    Rig(const std::string& solver, const V3& gravity)
        : stepper_(world_, {.solver = solver == "direct" ? ode::Solver::direct : ode::Solver::quick,
                            .ledger = false,
                            .rest_damping = 0, // what swings here is to go on
                            .warn = nullptr}) {
        dRandSetSeed(0); // the iterative solver shuffles its rows
        dWorldSetGravity(world_, dReal(gravity.x()), dReal(gravity.y()), dReal(gravity.z()));
    }
    ~Rig() {
        others_.clear();
        hinges_.clear();
        sliders_.clear();
        hardening_.reset();
        dJointGroupDestroy(contacts_);
        dWorldDestroy(world_);
        dCloseODE();
    }
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    /// Lets rigid rows give by `softness` only.
    void soften() { dWorldSetCFM(world_, dReal(softness)); }

    Body body(double mass, const V3& inertia, const V3& at, const V3& velocity, const V3& spin) {
        Body b = dBodyCreate(world_);
        dMass m;
        dMassSetParameters(&m, dReal(mass), 0, 0, 0, dReal(inertia.x()), dReal(inertia.y()),
                           dReal(inertia.z()), 0, 0, 0);
        dBodySetMass(b, &m);
        dBodySetPosition(b, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dBodySetFiniteRotationMode(b, 1);
        set_velocity(b, velocity);
        dBodySetAngularVel(b, dReal(spin.x()), dReal(spin.y()), dReal(spin.z()));
        meter_.add(b);
        meter_.open();
        return b;
    }

    /// Null `b`: the static world.
    Hinge& hinge(Body a, Body b, const V3& anchor, const V3& axis, Joint joint) {
        hinges_.push_back(std::make_unique<Hinge>(
            world_, a, b, ode::HingeFrame{.anchor = anchor, .axis = axis}, joint));
        return added(*hinges_.back());
    }
    /// To the static world, R = strength + hardening p.
    auto& hardening_hinge(Body a, const V3& anchor, const V3& axis, double strength,
                          double hardening) {
        hardening_ = std::make_unique<HardeningHinge>(
            world_, a, nullptr, ode::HingeFrame{.anchor = anchor, .axis = axis},
            OneAxisJoint(Linear<double>({.strength = strength, .hardening = hardening})));
        return added(*hardening_);
    }
    Slider& slider(Body a, Body b, const V3& axis, Joint joint) {
        sliders_.push_back(std::make_unique<Slider>(world_, a, b, axis, joint));
        return added(*sliders_.back());
    }

    /// The engine's own hinge, free about `axis`; null `b`: the static world.
    void pin(Body a, Body b, const V3& anchor, const V3& axis) {
        dJointID hinge = dJointCreateHinge(world_, nullptr);
        dJointAttach(hinge, a, b);
        dJointSetHingeAnchor(hinge, dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
        dJointSetHingeAxis(hinge, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
    }
    /// The engine's own slider: `a` may only move along `axis`.
    void guide(Body a, const V3& axis) {
        dJointID slider = dJointCreateSlider(world_, nullptr);
        dJointAttach(slider, a, nullptr);
        dJointSetSliderAxis(slider, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
    }

    /// All that hangs together with a body: by a joint without a row of which ODE does not tell.
    void leave_to_ode(Body a) { dJointAttach(dJointCreateLMotor(world_, nullptr), a, nullptr); }

    /// Hinge and slider with any law.
    template <class Law>
    auto& hinge_of(Body a, Body b, const V3& anchor, const V3& axis, OneAxisJoint<Law> law) {
        return own(std::make_unique<ode::PlasticHinge<OneAxisJoint<Law>>>(
            world_, a, b, ode::HingeFrame{.anchor = anchor, .axis = axis}, std::move(law)));
    }
    template <class Law>
    auto& slider_of(Body a, Body b, const V3& axis, OneAxisJoint<Law> law) {
        return own(std::make_unique<ode::PlasticSlider<OneAxisJoint<Law>>>(world_, a, b, axis,
                                                                           std::move(law)));
    }
    /// Makes a motor of one of the world's own joints plastic.
    ode::PlasticMotor<>& motor(const ode::MotorAxis& axis, Joint joint,
                               ode::AtBreak at_break = ode::AtBreak::disable_joint) {
        return own(std::make_unique<ode::PlasticMotor<>>(axis, std::move(joint), at_break));
    }
    /// A joint of six axes, its frame given in the world; null `b`: the static world. `axes`: the
    /// plastic ones, where they are not all.
    template <class Law, class... Axes>
    auto& six_axis(Body a, Body b, const JointFrame<double>& frame, Law joint,
                   const Axes&... axes) {
        return own(std::make_unique<ode::PlasticJoint<Law>>(world_, a, b, frame, std::move(joint),
                                                            axes...));
    }
    /// Takes a constraint out of the world and ends it.
    void remove(ode::PlasticConstraint& constraint) {
        stepper_.remove(constraint);
        meter_.remove(constraint);
        std::erase_if(others_, [&](const auto& other) { return other.get() == &constraint; });
    }
    /// Takes a body out of the world while joints still hold it.
    void destroy(Body b) {
        meter_.remove(b);
        dBodyDestroy(b);
    }
    [[nodiscard]] dWorldID world() const { return world_; }
    /// Of an iterative solver.
    void set_iterations(int count) { dWorldSetQuickStepNumIterations(world_, count); }

    /// One inelastic contact between two bodies above each other, that touch where their centres
    /// are `distance` apart along y.
    void stack(Body lower, Body upper, double distance) {
        lower_ = lower;
        upper_ = upper;
        contact_distance_ = distance;
    }

    void step(double dt) {
        if (upper_ != nullptr) touch(dt);
        meter_.before_step();
        stepper_.step(dt);
        meter_.after_step(dt);
        dJointGroupEmpty(contacts_);
    }

    static void apply_force(Body b, const V3& force) {
        dBodyAddForce(b, dReal(force.x()), dReal(force.y()), dReal(force.z()));
    }
    static void apply_force(Body b, const V3& force, const V3& at) {
        dBodyAddForceAtPos(b, dReal(force.x()), dReal(force.y()), dReal(force.z()), dReal(at.x()),
                           dReal(at.y()), dReal(at.z()));
    }
    static void apply_torque(Body b, const V3& torque) {
        dBodyAddTorque(b, dReal(torque.x()), dReal(torque.y()), dReal(torque.z()));
    }
    static V3 position(Body b) { return ode::to_core(dBodyGetPosition(b)); }
    static V3 velocity(Body b) { return ode::linear_velocity(b); }
    static V3 spin(Body b) { return ode::angular_velocity(b); }
    /// Rotation from the start, less than π [rad].
    static V3 turn(Body b) {
        return rotation_vector<double>(ode::matrix_to_core(dBodyGetRotation(b)));
    }
    static void set_spin(Body b, const V3& w) {
        dBodySetAngularVel(b, dReal(w.x()), dReal(w.y()), dReal(w.z()));
    }
    static void set_velocity(Body b, const V3& v) {
        dBodySetLinearVel(b, dReal(v.x()), dReal(v.y()), dReal(v.z()));
    }
    [[nodiscard]] const Ledger<double>& ledger() const { return meter_.ledger(); }
    void open_ledger() { meter_.open(); }

    /// Where a body is and how it moves, to the bit.
    struct Motion {
        std::array<dReal, 3> at{}, velocity{}, spin{};
        std::array<dReal, 4> turned{};
        bool operator==(const Motion&) const = default;
    };
    static Motion motion(Body b) {
        Motion m;
        std::copy_n(dBodyGetPosition(b), 3, m.at.begin());
        std::copy_n(dBodyGetQuaternion(b), 4, m.turned.begin());
        std::copy_n(dBodyGetLinearVel(b), 3, m.velocity.begin());
        std::copy_n(dBodyGetAngularVel(b), 3, m.spin.begin());
        return m;
    }
    /// ODE normalises the quaternion that it is given, which may change its last bit.
    void put_back(Body b, const Motion& m) const {
        dBodySetPosition(b, m.at[0], m.at[1], m.at[2]);
        const dQuaternion q{m.turned[0], m.turned[1], m.turned[2], m.turned[3]};
        dBodySetQuaternion(b, q);
        dBodySetLinearVel(b, m.velocity[0], m.velocity[1], m.velocity[2]);
        dBodySetAngularVel(b, m.spin[0], m.spin[1], m.spin[2]);
        dRandSetSeed(0); // the iterative solver shuffles its rows
    }
    /// What a joint remembers; of a motor also its position, that ODE does not count over turns.
    template <class Constraint>
    struct Memory {
        typename Constraint::State state;
        double position = 0;
        bool operator==(const Memory&) const = default;
    };
    template <class Constraint>
    static Memory<Constraint> memory(const Constraint& joint) {
        if constexpr (requires { joint.position(); }) {
            return {joint.joint().state(), joint.position()};
        } else {
            return {joint.state()};
        }
    }
    template <class Constraint>
    static void put_back(Constraint& joint, const Memory<Constraint>& memory) {
        if constexpr (requires { joint.position(); }) {
            joint.restore(memory.state, memory.position);
        } else {
            joint.restore(memory.state);
        }
    }

  private:
    template <class Constraint>
    Constraint& own(std::unique_ptr<Constraint> constraint) {
        Constraint& result = *constraint;
        others_.push_back(std::move(constraint));
        return added(result);
    }

    template <class Constraint>
    Constraint& added(Constraint& constraint) {
        constraint.add_to(stepper_);
        meter_.add(constraint);
        return constraint;
    }

    void touch(double dt) {
        const double gap = position(upper_).y() - position(lower_).y() - contact_distance_;
        if (gap > 0.5) return;
        dContact contact{};
        contact.surface.mode = dContactMotionN;
        contact.surface.mu = 0;
        contact.surface.motionN = dReal(-std::max(gap, 0.0) / dt);
        contact.geom.depth = dReal(std::max(-gap, 0.0));
        const V3 at = position(lower_) + V3(0, contact_distance_ / 2, 0);
        for (int i = 0; i < 3; ++i) contact.geom.pos[i] = dReal(at[i]);
        contact.geom.normal[1] = 1; // into the first body, the upper one
        dJointID joint = dJointCreateContact(world_, contacts_, &contact);
        dJointAttach(joint, upper_, lower_);
        meter_.add_contact(joint, contact.geom);
    }

    /// ODE counts its users: initialised once per rig, before the world.
    struct Library {
        Library() { dInitODE2(0); }
    };
    Library library_;
    dWorldID world_ = dWorldCreate();
    dJointGroupID contacts_ = dJointGroupCreate(0);
    ode::World stepper_;
    ode::EnergyMeter meter_{world_};
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::vector<std::unique_ptr<Slider>> sliders_;
    std::unique_ptr<HardeningHinge> hardening_;
    std::vector<std::unique_ptr<ode::PlasticConstraint>> others_;
    Body lower_ = nullptr;
    Body upper_ = nullptr;
    double contact_distance_ = 0;
};

} // namespace ductile::test
