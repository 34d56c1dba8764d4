// SPDX-License-Identifier: MIT
//
// A field of joints in ODE: dWorldStep, or dWorldQuickStep with its own twenty iterations. ODE has
// no spring of six axes.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <string_view>
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

    explicit Field(const FieldSettings& settings)
        : settings_(settings),
          stepper_(world_,
                   settings.direct ? ductile::ode::Solver::direct : ductile::ode::Solver::quick) {
        const int bodies = settings.chain ? settings.count + 1 : 2 * settings.count;
        bodies_.reserve(std::size_t(bodies));
        for (int i = 0; i < bodies; ++i) add_body(i);
        const double before = heap_in_use();
        ours_.reserve(std::size_t(settings.count));
        for (int i = 0; i < settings.count; ++i) add_joint(i);
        heap_ = heap_in_use() - before;
    }
    ~Field() {
        ours_.clear();
        dWorldDestroy(world_);
    }
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;

    void step() { stepper_.step(dt); }
    /// Heap that the joints took when they were made and added [bytes].
    [[nodiscard]] double heap() const { return heap_; }

  private:
    void add_body(int i) {
        dBodyID body = dBodyCreate(world_);
        dMass m;
        const auto inertia = dReal(body_inertia);
        dMassSetParameters(&m, dReal(body_mass), 0, 0, 0, inertia, inertia, inertia, 0, 0, 0);
        dBodySetMass(body, &m);
        const int side = i % 2 == 0 ? -1 : 1, row = 300, pair = i / 2; // pairs in a square field
        if (settings_.chain) {
            dBodySetPosition(body, dReal(2 * half_length * i), 0, 0);
        } else {
            dBodySetPosition(body, dReal(pair_distance * (pair % row) + side * half_length),
                             dReal(pair_distance * (pair / row)), 0);
            dBodySetAngularVel(body, 0, 0, dReal(side * pair_spin));
            dBodySetLinearVel(body, 0, dReal(pair_spin * half_length), 0);
        }
        bodies_.push_back(body);
    }

    void add_joint(int i) {
        const std::size_t first = std::size_t(settings_.chain ? i : 2 * i);
        dBodyID a = bodies_[first], b = bodies_[first + 1];
        const double strength = settings_.strength(i);
        const ductile::Vector3<double> anchor = ductile::ode::to_core(dBodyGetPosition(a)) +
                                                ductile::Vector3<double>(half_length, 0, 0);
        const ductile::Vector3<double> z = ductile::Vector3<double>::UnitZ();
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
    Library library_;
    dWorldID world_ = dWorldCreate();
    ductile::ode::World stepper_;
    std::vector<dBodyID> bodies_;
    std::vector<std::unique_ptr<ductile::ode::PlasticConstraint>> ours_;
    double heap_ = 0;
};

} // namespace bench::cost
