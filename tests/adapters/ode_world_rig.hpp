// SPDX-License-Identifier: MIT
//
// An ODE world below ductile's own World, for the tests of that. Same verbs as
// bullet_world_rig.hpp.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ode_engine.hpp"
#include "ductile/ode/ode.hpp"

namespace ductile::test {

namespace engine = ductile::ode;
using V3 = Vector3<double>;
using Joint = OneAxisJoint<Perfect<double>, TravelLimit<double>>;
using SixAxes = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;

class WorldRig {
  public:
    using Hinge = ode::PlasticHinge<Joint>;
    using Six = ode::PlasticJoint<SixAxes>;
    using Body = dBodyID;
    static constexpr const char* engine = "ODE";
    static constexpr bool single = sizeof(dReal) == sizeof(float);

    explicit WorldRig(bool iterative, Warn warn = nullptr, bool ledger = true)
        : world_(id_, {.solver = iterative ? ode::Solver::quick : ode::Solver::direct,
                       .ledger = ledger,
                       .warn = std::move(warn)}) {
        prepare();
    }
    /// Steps are frames.
    WorldRig(bool iterative, double tolerance, int budget)
        : world_(id_, {.solver = iterative ? ode::Solver::quick : ode::Solver::direct,
                       .tolerance = tolerance,
                       .budget = budget,
                       .rest_damping = 0, // what swings here is to go on
                       .warn = nullptr}) {
        prepare();
    }
    /// As a user gets it who asks for 1 % alone: steps are frames.
    explicit WorldRig(Warn warn) : world_(id_, {.tolerance = 0.01, .warn = std::move(warn)}) {
        prepare();
    }
    ~WorldRig() {
        others_.clear();
        for (auto& hinge : hinges_) world_.remove(*hinge);
        for (auto& joint : sixes_) world_.remove(*joint);
    }

    [[nodiscard]] ode::World& world() { return world_; }

    Body body(double mass, const V3& inertia, const V3& at) {
        Body b = dBodyCreate(id_);
        dMass m;
        dMassSetParameters(&m, dReal(mass), 0, 0, 0, dReal(inertia.x()), dReal(inertia.y()),
                           dReal(inertia.z()), 0, 0, 0);
        dBodySetMass(b, &m);
        dBodySetPosition(b, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dBodySetFiniteRotationMode(b, 1);
        world_.add(b);
        return b;
    }

    /// That touches others.
    Body box(double mass, const V3& half, const V3& at) {
        dMass inertia;
        const auto side = [&half](int k) { return dReal(2 * half[k]); };
        dMassSetBoxTotal(&inertia, dReal(mass), side(0), side(1), side(2));
        return shaped(inertia, dCreateBox(engine_.space, side(0), side(1), side(2)), at);
    }
    /// The same, without friction.
    Body ball(double mass, double radius, const V3& at) {
        dMass inertia;
        dMassSetSphereTotal(&inertia, dReal(mass), dReal(radius));
        return shaped(inertia, dCreateSphere(engine_.space, dReal(radius)), at);
    }

    /// Its motion is prescribed from now on.
    static void prescribe(Body b) { dBodySetKinematic(b); }
    /// Turns a prescribed body by `spin` dt about z in the coming step, to `angle` in all.
    static void drive(Body b, double /*angle*/, double spin) {
        dBodySetAngularVel(b, 0, 0, dReal(spin));
    }

    /// At once, without a way there.
    static void put(Body b, const V3& at) {
        dBodySetPosition(b, dReal(at.x()), dReal(at.y()), dReal(at.z()));
    }

    /// About z; null `b`: the static world.
    Hinge& hinge(Body a, Body b, const V3& anchor, Joint joint, const std::string& name) {
        hinges_.push_back(std::make_unique<Hinge>(
            id_, a, b, ode::HingeFrame{.anchor = anchor, .axis = {0, 0, 1}}, joint));
        world_.add(*hinges_.back(), name);
        return *hinges_.back();
    }

    /// To the static world, axes along those of the world, z along the member.
    Six& six_axes(Body a, const V3& anchor, SixAxes joint) {
        sixes_.push_back(
            std::make_unique<Six>(id_, a, nullptr, Six::Frame{.origin = anchor}, std::move(joint)));
        world_.add(*sixes_.back());
        return *sixes_.back();
    }

    /// About z, any law.
    template <class Any>
    auto& hinge_of(Body a, Body b, const V3& anchor, Any joint) {
        return own(std::make_unique<ode::PlasticHinge<Any>>(
            id_, a, b, ode::HingeFrame{.anchor = anchor, .axis = {0, 0, 1}}, std::move(joint)));
    }
    /// To the static world, along `axis`.
    template <class Any>
    auto& slider(Body a, const V3& axis, Any joint) {
        return own(
            std::make_unique<ode::PlasticSlider<Any>>(id_, a, nullptr, axis, std::move(joint)));
    }
    /// Any joint of six axes, as `six_axes`.
    template <class Any>
    auto& six_of(Body a, Any joint) {
        return own(std::make_unique<ode::PlasticJoint<Any>>(id_, a, nullptr, JointFrame<double>{},
                                                            std::move(joint)));
    }
    /// A joint of some axes; null `b`: the static world. `columns`: axes of its frame.
    template <class Any, class Axes>
    auto& some_of(Body a, Body b, const V3& at, const Eigen::Matrix3d& columns, Any joint,
                  const Axes& axes) {
        return own(std::make_unique<ode::PlasticJoint<Any>>(
            id_, a, b, JointFrame<double>{at, columns}, std::move(joint), axes));
    }
    /// The engine's own hinge about z, which takes no moment.
    dJointID pin(Body a, Body b, const V3& anchor) {
        dJointID hinge = dJointCreateHinge(id_, nullptr);
        dJointAttach(hinge, a, b);
        dJointSetHingeAnchor(hinge, dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
        dJointSetHingeAxis(hinge, 0, 0, 1);
        return hinge;
    }
    /// The same, made plastic.
    auto& motor(Body a, Body b, const V3& anchor, Joint joint) {
        return own(
            std::make_unique<ode::PlasticMotor<Joint>>(ode::hinge_axis(pin(a, b, anchor)), joint));
    }
    /// The engine's own slider: `a` may only move along `axis`.
    void guide(Body a, const V3& axis) {
        dJointID slider = dJointCreateSlider(id_, nullptr);
        dJointAttach(slider, a, nullptr);
        dJointSetSliderAxis(slider, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
    }

    void set_gravity(const V3& g) {
        dWorldSetGravity(id_, dReal(g.x()), dReal(g.y()), dReal(g.z()));
    }
    /// Of all.
    void set_friction(double coefficient) { friction_ = coefficient; }
    static void apply_force(Body b, const V3& force) {
        dBodyAddForce(b, dReal(force.x()), dReal(force.y()), dReal(force.z()));
    }
    /// `arm`: from the centre of mass, at the start.
    void push(Body b, const V3& force, const V3& at) { world().apply_force(b, force, at); }
    static void apply_force_at(Body b, const V3& force, const V3& arm) {
        dBodyAddForceAtRelPos(b, dReal(force.x()), dReal(force.y()), dReal(force.z()),
                              dReal(arm.x()), dReal(arm.y()), dReal(arm.z()));
    }
    static void set_velocity(Body b, const V3& v) {
        dBodySetLinearVel(b, dReal(v.x()), dReal(v.y()), dReal(v.z()));
    }
    static void set_spin(Body b, const V3& w) {
        dBodySetAngularVel(b, dReal(w.x()), dReal(w.y()), dReal(w.z()));
    }
    /// All that a turning body and its hinge remember.
    struct Saved {
        std::array<dReal, 4> turned;
        V3 spin;
        Hinge::State hinge;
        bool operator==(const Saved&) const = default;
    };
    static Saved save(Body b, Hinge& hinge) {
        Saved saved{{}, spin(b), hinge.state()};
        std::copy_n(dBodyGetQuaternion(b), 4, saved.turned.begin());
        return saved;
    }
    static void put_back(Body b, Hinge& hinge, const Saved& saved) {
        dBodySetQuaternion(b, saved.turned.data());
        set_spin(b, saved.spin);
        hinge.restore(saved.hinge);
    }
    static V3 velocity(Body b) { return ode::linear_velocity(b); }
    static V3 spin(Body b) { return ode::angular_velocity(b); }
    /// Rotation from the start, less than π [rad].
    static V3 turn(Body b) {
        return rotation_vector<double>(ode::matrix_to_core(dBodyGetRotation(b)));
    }
    static V3 position(Body b) { return ode::to_core(dBodyGetPosition(b)); }

  private:
    void prepare() {
        dRandSetSeed(0); // the iterative solver shuffles its rows
        dWorldSetQuickStepNumIterations(id_, 10);
        dWorldSetCFM(id_, 1e-13); // ODE's 1e-10 lets 100 kN move by 1e-5 m/s
    }
    Body shaped(const dMass& inertia, dGeomID geom, const V3& at) {
        if (!collides_) {
            collides_ = true;
            world_.on_contacts({.space = engine_.space, .group = engine_.contacts},
                               [this] { dSpaceCollide(engine_.space, this, &WorldRig::touch); });
        }
        Body b = dBodyCreate(id_);
        dBodySetMass(b, &inertia);
        dBodySetPosition(b, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dGeomSetBody(geom, b);
        world_.add(b);
        return b;
    }
    static void touch(void* data, dGeomID a, dGeomID b) {
        auto& rig = *static_cast<WorldRig*>(data);
        dSurfaceParameters surface{};
        if (rig.friction_ > 0) {
            surface.mode = dContactApprox1;
            surface.mu = dReal(rig.friction_);
        }
        rig.engine_.touch(a, b, surface, [&rig](dJointID joint, const dContact& contact) {
            rig.world_.add_contact(joint, contact);
        });
    }
    template <class Constraint>
    Constraint& own(std::unique_ptr<Constraint> constraint) {
        Constraint& result = *constraint;
        others_.push_back(std::move(constraint));
        world_.add(result);
        return result;
    }

    OdeEngine engine_;
    dWorldID id_ = engine_.id;
    ode::World world_;
    bool collides_ = false;
    double friction_ = 0;
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::vector<std::unique_ptr<Six>> sixes_;
    std::vector<std::unique_ptr<ode::PlasticConstraint>> others_;
};

} // namespace ductile::test
