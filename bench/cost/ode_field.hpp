// SPDX-License-Identifier: MIT
//
// A field of joints in ODE: dWorldStep, or dWorldQuickStep with its own twenty iterations. ODE has
// no spring of six axes.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "cost/field.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/ode/ode.hpp"
#include "ductile/ode/plastic_joint.hpp"
#include "ductile/surface/ellipsoid.hpp"

namespace bench::cost {

class Field {
    using Hinge = ductile::ode::PlasticHinge<>;
    using Six = ductile::CoupledJoint<ductile::Ellipsoid<double, 6>, ductile::Perfect<double>>;
    using SixAxis = ductile::ode::PlasticJoint<Six>;

  public:
    static constexpr std::string_view engine = "ode";
    static constexpr std::string_view precision =
        sizeof(dReal) == sizeof(double) ? "double" : "float";
    static constexpr bool splits_by_choice = false;

    [[nodiscard]] static std::string_view solver(const FieldSettings& s) {
        return s.direct ? "direct" : "quick";
    }
    /// ODE's own joints are opaque: their size is in the heap alone.
    [[nodiscard]] static std::size_t size_of(Joint joint) {
        switch (joint) {
            case Joint::plastic_hinge:
                return sizeof(Hinge);
            case Joint::plastic_joint:
                return sizeof(SixAxis);
            default:
                return 0;
        }
    }
    [[nodiscard]] static bool has(Joint joint) { return joint != Joint::spring2; }
    /// Contacts are the user's there.
    [[nodiscard]] static bool has(SetUp set_up) { return set_up != SetUp::floor; }

    explicit Field(const FieldSettings& settings) : Field(settings, plan_of(settings)) {}
    ~Field() {
        ours_.clear();
        dWorldDestroy(world_);
    }
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;

    void step() {
        for (const auto& [body, force] : pushed_) {
            dBodyAddForce(body, dReal(force.x()), dReal(force.y()), dReal(force.z()));
        }
        stepper_.step(dt_);
    }
    /// Heap that the joints took when they were made and added [bytes].
    [[nodiscard]] double heap() const { return heap_; }

  private:
    Field(const FieldSettings& settings, const Plan& plan)
        : settings_(settings),
          dt_(plan.dt),
          stepper_(world_, {.solver = settings.direct ? ductile::ode::Solver::direct
                                                      : ductile::ode::Solver::quick,
                            .ledger = settings.ledger,
                            .warn = nullptr}) {
        dWorldSetGravity(world_, dReal(plan.gravity.x()), dReal(plan.gravity.y()),
                         dReal(plan.gravity.z()));
        bodies_.reserve(plan.bodies.size());
        for (const Body& body : plan.bodies) add(body);
        const double before = heap_in_use();
        ours_.reserve(plan.links.size());
        for (const Link& link : plan.links) connect(link);
        heap_ = heap_in_use() - before;
    }

    void add(const Body& wanted) {
        dBodyID body = dBodyCreate(world_);
        dMass m;
        const V3 &inertia = wanted.inertia, &at = wanted.at, &v = wanted.velocity, &w = wanted.spin;
        dMassSetParameters(&m, dReal(wanted.mass), 0, 0, 0, dReal(inertia.x()), dReal(inertia.y()),
                           dReal(inertia.z()), 0, 0, 0);
        dBodySetMass(body, &m);
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dBodySetAngularVel(body, dReal(w.x()), dReal(w.y()), dReal(w.z()));
        dBodySetLinearVel(body, dReal(v.x()), dReal(v.y()), dReal(v.z()));
        bodies_.push_back(body);
        if (!wanted.push.isZero()) pushed_.emplace_back(body, wanted.push);
    }

    [[nodiscard]] dBodyID body(int i) const {
        return i == ground ? nullptr : bodies_[std::size_t(i)];
    }
    void connect(const Link& link) {
        dBodyID a = body(link.a), b = body(link.b);
        const double strength = link.strength;
        const V3 &anchor = link.at, z = V3::UnitZ();
        switch (settings_.joint) {
            case Joint::plastic_hinge: {
                auto hinge = std::make_unique<Hinge>(
                    world_, a, b, ductile::ode::HingeFrame{.anchor = anchor, .axis = z},
                    ductile::OneAxisJoint<ductile::Perfect<double>>(
                        ductile::Perfect<double>({.strength = strength})));
                hinge->add_to(stepper_);
                ours_.push_back(std::move(hinge));
                return;
            }
            case Joint::plastic_joint: {
                auto joint = std::make_unique<SixAxis>(
                    world_, a, b, ductile::JointFrame<double>{.origin = anchor},
                    Six(ductile::Ellipsoid<double, 6>(
                            {.capacity = ductile::Vector6<double>::Constant(strength)}),
                        ductile::Perfect<double>({.strength = 1})));
                joint->add_to(stepper_);
                ours_.push_back(std::move(joint));
                return;
            }
            case Joint::hinge_motor: {
                dJointID hinge = dJointCreateHinge(world_, nullptr);
                dJointAttach(hinge, a, b);
                dJointSetHingeAnchor(hinge, dReal(anchor.x()), dReal(anchor.y()),
                                     dReal(anchor.z()));
                dJointSetHingeAxis(hinge, 0, 0, 1);
                dJointSetHingeParam(hinge, dParamVel, 0);
                dJointSetHingeParam(hinge, dParamFMax, dReal(strength));
                return;
            }
            case Joint::fixed: {
                dJointID fixed = dJointCreateFixed(world_, nullptr);
                dJointAttach(fixed, a, b);
                dJointSetFixed(fixed);
                return;
            }
            case Joint::none:
            case Joint::spring2:
                return;
        }
    }

    /// Initialised once; its complaints would flood the terminal.
    struct Library {
        Library() {
            static const bool once = [] {
                dInitODE2(0);
                dSetMessageHandler([](int, const char*, va_list) {});
                return true;
            }();
            (void)once;
            dAllocateODEDataForThread(dAllocateFlagBasicData);
        }
    };

    FieldSettings settings_;
    double dt_; ///< [s]
    Library library_;
    dWorldID world_ = dWorldCreate();
    ductile::ode::World stepper_;
    std::vector<dBodyID> bodies_;
    std::vector<std::pair<dBodyID, V3>> pushed_; ///< and their forces [N]
    std::vector<std::unique_ptr<ductile::ode::PlasticConstraint>> ours_;
    double heap_ = 0;
};

} // namespace bench::cost
