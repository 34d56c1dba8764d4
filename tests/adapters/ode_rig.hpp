// SPDX-License-Identifier: MIT
//
// A small ODE world for the contract suite. Same verbs as bullet_rig.hpp.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <string>
#include <vector>

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
    static constexpr bool single = sizeof(dReal) == sizeof(float);

    /// Solvers to run every test with.
    static std::vector<std::string> solvers() { return {"direct", "quick"}; }

    Rig(const std::string& solver, const V3& gravity)
        : stepper_(world_, solver == "direct" ? ode::Solver::direct : ode::Solver::quick) {
        dRandSetSeed(0); // the iterative solver shuffles its rows
        dWorldSetGravity(world_, dReal(gravity.x()), dReal(gravity.y()), dReal(gravity.z()));
    }
    ~Rig() {
        hinges_.clear();
        sliders_.clear();
        hardening_.reset();
        dJointGroupDestroy(contacts_);
        dWorldDestroy(world_);
        dCloseODE();
    }
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

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

    /// One inelastic contact between two bodies above each other, that touch where their centres are
    /// `distance` apart along y.
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
    static V3 position(Body b) { return ode::to_core(dBodyGetPosition(b)); }
    static V3 velocity(Body b) { return ode::linear_velocity(b); }
    static V3 spin(Body b) { return ode::angular_velocity(b); }
    static void set_velocity(Body b, const V3& v) {
        dBodySetLinearVel(b, dReal(v.x()), dReal(v.y()), dReal(v.z()));
    }
    [[nodiscard]] const Ledger<double>& ledger() const { return meter_.ledger(); }
    void open_ledger() { meter_.open(); }

  private:
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
    Body lower_ = nullptr;
    Body upper_ = nullptr;
    double contact_distance_ = 0;
};

} // namespace ductile::test
