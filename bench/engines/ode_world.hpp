// SPDX-License-Identifier: MIT
//
// A scene in ODE. A contact that is still apart gets a target velocity that lets it close the gap
// in this step and no more; bodies do not collide otherwise.
//
// With a tolerance a step is a frame, and its contacts are those that are closed, or about to be.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engines/settings.hpp"
#include "methods/ode/all.hpp"

namespace bench {

class OdeWorld {
  public:
    static constexpr std::string_view engine = "ode";
    static constexpr std::string_view precision =
        sizeof(dReal) == sizeof(double) ? "double" : "float";
    static constexpr int default_iterations = 20;              ///< of dWorldQuickStep
    static constexpr std::string_view exact_solver = "direct"; ///< elastic rows included
    static constexpr std::array<SolverName, 2> solvers{
        {{"direct", Iterations::none}, {"quick", Iterations::solve}}};
    static constexpr bool has_frames = true;
    static constexpr std::string_view default_solver = "direct";
    static constexpr std::array<std::string_view, 2> solvers_of_peers{"direct", "quick"};

    [[nodiscard]] static bool has(std::string_view method) {
        return std::any_of(ode_methods::all.begin(), ode_methods::all.end(),
                           [&](const auto& entry) { return entry.first == method; });
    }

    /// @throws std::invalid_argument where the solver or the method is not there.
    OdeWorld(const Scene& scene, const Settings& settings)
        : scene_(scene),
          stepper_(world_, {.solver = settings.solver == "quick" ? ductile::ode::Solver::quick
                                                                 : ductile::ode::Solver::direct,
                            .ledger = false,
                            .tolerance = settings.tolerance,
                            .warn = nullptr}),
          in_frames_(settings.in_frames()) {
        if (settings.solver != "direct" && settings.solver != "quick") {
            throw std::invalid_argument("solver = " + settings.solver +
                                        ": must be direct or quick");
        }
        dRandSetSeed(0); // the iterative solver shuffles its rows
        const Vector& g = scene.gravity;
        dWorldSetGravity(world_, dReal(g.x()), dReal(g.y()), dReal(g.z()));
        if (settings.iterations > 0) dWorldSetQuickStepNumIterations(world_, settings.iterations);
        for (const BodySpec& body : scene.bodies) add_body(body);
        for (const GuideSpec& guide : scene.guides) {
            free_joint(world_, body(guide.body), nullptr, guide.motion, guide.anchor, guide.axis);
        }
        for (const JointSpec& joint : scene.joints) add_joint(joint, settings.method);
        made_.resize(scene.contacts.size());
        if (!in_frames_) return;
        double thickness = infinity;
        for (const ContactSpec& contact : scene.contacts) {
            thickness = std::min(thickness, contact.thickness);
        }
        stepper_.on_contacts({.group = contacts_, .thickness = thickness}, [this] { collide(0); });
    }
    ~OdeWorld() = default;
    OdeWorld(const OdeWorld&) = delete;
    OdeWorld& operator=(const OdeWorld&) = delete;

    void step(double dt) {
        if (!in_frames_) dWorldSetERP(world_, dReal(drift_correction(dt)));
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const Vector& f = scene_.bodies[i].force;
            if (!f.isZero()) dBodyAddForce(bodies_[i], dReal(f.x()), dReal(f.y()), dReal(f.z()));
        }
        for (auto& holder : holders_) holder->before_step(dt);
        if (!in_frames_) collide(dt);
        stepper_.step(dt);
        dJointGroupEmpty(contacts_);
        for (auto& holder : holders_) holder->after_step(dt);
    }

    [[nodiscard]] BodyState state(int index) const {
        return state_of(index == ground ? nullptr : bodies_[std::size_t(index)]);
    }
    [[nodiscard]] const std::vector<std::unique_ptr<Holder>>& holders() const { return holders_; }
    /// What frames with a tolerance say of themselves; null without one.
    [[nodiscard]] const ductile::RunReport* run() const {
        return in_frames_ ? &stepper_.run() : nullptr;
    }

  private:
    [[nodiscard]] dBodyID body(int index) const {
        return index == ground ? nullptr : bodies_[std::size_t(index)];
    }

    void add_body(const BodySpec& spec) {
        dBodyID body = dBodyCreate(world_);
        dMass m;
        dMassSetParameters(&m, dReal(spec.mass), 0, 0, 0, dReal(spec.inertia.x()),
                           dReal(spec.inertia.y()), dReal(spec.inertia.z()), 0, 0, 0);
        dBodySetMass(body, &m);
        const auto& [position, rotation, velocity, spin] = spec.start;
        dBodySetPosition(body, dReal(position.x()), dReal(position.y()), dReal(position.z()));
        dMatrix3 r{};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                r[4 * row + column] = dReal(rotation(row, column));
        }
        dBodySetRotation(body, r);
        dBodySetLinearVel(body, dReal(velocity.x()), dReal(velocity.y()), dReal(velocity.z()));
        dBodySetAngularVel(body, dReal(spin.x()), dReal(spin.y()), dReal(spin.z()));
        dBodySetFiniteRotationMode(body, 1);
        if (spec.weightless) dBodySetGravityMode(body, 0);
        bodies_.push_back(body);
        stepper_.add(body);
    }

    void add_joint(const JointSpec& joint, std::string_view method) {
        const OdeSite site{world_,        stepper_, body(joint.a),
                           body(joint.b), joint,    effective_mass(scene_, joint)};
        for (const auto& [name, make] : ode_methods::all) {
            if (name == method) {
                holders_.push_back(make(site));
                return;
            }
        }
        throw std::invalid_argument("method = " + std::string(method) + ": not there in ODE");
    }

    /// Of a step of `dt` [s]; 0: of a part of a frame.
    void collide(double dt) {
        int count = 0;
        for (std::size_t i = 0; i < made_.size(); ++i) {
            const ContactSpec& spec = scene_.contacts[i];
            const BodyState a = state(spec.a), b = state(spec.b);
            const double closing = spec.approach ? spec.approach(a, b).closing_speed : 0;
            const double reach =
                in_frames_ ? 0 : charpy::reach(made_[i], spec.thickness, closing, dt);
            const charpy::EdgeContact contact = spec.touch(a, b, reach);
            made_[i] = contact.count > 0;
            for (int k = 0; k < contact.count; ++k) {
                add_contact(spec, contact.points[std::size_t(k)], dt, count++);
            }
        }
    }
    void add_contact(const ContactSpec& spec, const charpy::ContactPoint& point, double dt,
                     int count) {
        dContact contact{};
        contact.surface.mode = dContactApprox1 | dContactBounce | dContactMotionN;
        contact.surface.motionN = dReal(in_frames_ ? 0 : -std::max(point.gap, 0.0) / dt);
        if (scene_.contact_compliance > 0) {
            contact.surface.mode |= dContactSoftCFM;
            contact.surface.soft_cfm = dReal(scene_.contact_compliance);
            contact.surface.motionN -= dReal(1e-6 * (1 + 0.37 * count));
        }
        contact.geom.depth = dReal(std::max(-point.gap, 0.0));
        for (int i = 0; i < 3; ++i) {
            contact.geom.pos[i] = dReal(point.position[i]);
            contact.geom.normal[i] =
                dReal(-point.normal[i]); // into the first body, that with the face
        }
        dJointID joint = dJointCreateContact(world_, contacts_, &contact);
        dJointAttach(joint, body(spec.b), body(spec.a));
        stepper_.add_contact(joint, contact);
    }

    /// Initialised once; its complaints about an unsolved LCP would flood the terminal.
    struct Library {
        Library() {
            static const bool once = [] {
                dInitODE2(0);
                dSetMessageHandler([](int, const char*, va_list) {});
                return true;
            }();
            (void)once;
        }
    };

    /// What ODE gives and takes back, also where the scene is refused.
    struct Owned {
        Owned() = default;
        ~Owned() {
            dJointGroupDestroy(contacts);
            dWorldDestroy(world);
        }
        Owned(const Owned&) = delete;
        Owned& operator=(const Owned&) = delete;

        Library library;
        dWorldID world = dWorldCreate();
        dJointGroupID contacts = dJointGroupCreate(0);
    };

    Scene scene_;
    Owned owned_; ///< outlives what follows
    dWorldID world_ = owned_.world;
    dJointGroupID contacts_ = owned_.contacts;
    ductile::ode::World stepper_;
    bool in_frames_;
    std::vector<dBodyID> bodies_;
    std::vector<std::unique_ptr<Holder>> holders_;
    std::vector<bool> made_;
};

} // namespace bench
