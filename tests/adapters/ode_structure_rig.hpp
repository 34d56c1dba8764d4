// SPDX-License-Identifier: MIT
//
// An ODE world with a floor as a user makes one, for structures: dWorldStep, a default World,
// contacts named to it. Same verbs as bullet_structure_rig.hpp.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ode_engine.hpp"
#include "ductile/joint/usual_joints.hpp"
#include "ductile/ode/ode.hpp"
#include "ductile/ode/structure.hpp"
#include "ductile/ode/structure_in_time.hpp"
#include "ductile/ode/structure_snapshot.hpp"

namespace ductile::test {

namespace engine = ductile::ode;

using in_ode::KeptBody;
using Snapshot = ode::StructureSnapshot;

/// Of the engine's: a ball, a hinge about y, a weld.
enum class OwnJoint { point, hinge, weld };

class StructureRig {
  public:
    using Body = dBodyID;
    using Joint = ode::PlasticJoint<UsualSixAxisJoint>;
    static constexpr bool single = sizeof(dReal) == sizeof(float);
    static constexpr bool in_frames = false; ///< a default World's steps
    /// How deep into the floor a body is made that is to rest on it: ODE lets contacts overlap [m].
    static constexpr double layer = 1e-3;

    explicit StructureRig(double gravity = 9.81, ode::WorldParameters parameters = {}) {
        dWorldSetGravity(id_, 0, 0, dReal(-gravity));
        dWorldSetContactSurfaceLayer(id_, dReal(layer));
        parameters.warn = [this](const std::string& line) { lines_.push_back(line); };
        world_ = std::make_unique<ode::World>(id_, parameters);
        if (parameters.tolerance > 0) {
            world_->on_contacts({.space = space_, .group = contacts_},
                                [this] { dSpaceCollide(space_, this, &StructureRig::touch); });
        }
        frames_ = parameters.tolerance > 0;
        dCreatePlane(space_, 0, 0, 1, 0);
    }
    StructureRig(const StructureRig&) = delete;
    StructureRig& operator=(const StructureRig&) = delete;

    [[nodiscard]] ode::World& world() { return *world_; }
    [[nodiscard]] dWorldID id() const { return id_; }

    /// To end before this does; one at a time.
    [[nodiscard]] std::unique_ptr<ode::Structure> build(const StructureModel& model,
                                                        const std::vector<ode::OwnBody>& own = {}) {
        auto made = std::make_unique<ode::Structure>(*world_, space_, model, own);
        built_ = made.get();
        return made;
    }
    /// The same.
    [[nodiscard]] std::unique_ptr<ode::StructureInTime> build_in_time(const StructureModel& model) {
        auto made = std::make_unique<ode::StructureInTime>(*world_, space_, model);
        in_time_ = made.get();
        return made;
    }
    /// What was built is gone.
    void forget() {
        built_ = nullptr;
        in_time_ = nullptr;
    }
    /// That touches others.
    Body box(double mass, const Vector3<double>& half, const Vector3<double>& at) {
        dBodyID body = dBodyCreate(id_);
        dMass inertia;
        dMassSetBoxTotal(&inertia, dReal(mass), dReal(2 * half.x()), dReal(2 * half.y()),
                         dReal(2 * half.z()));
        dBodySetMass(body, &inertia);
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dBodySetFiniteRotationMode(body, 1);
        dGeomID shape =
            dCreateBox(space_, dReal(2 * half.x()), dReal(2 * half.y()), dReal(2 * half.z()));
        dGeomSetBody(shape, body);
        world_->add(body);
        own_.push_back(body);
        return body;
    }
    /// Between boxes, with the axes of the world.
    Joint& connect(Body a, Body b, const Vector3<double>& at, const UsualSixAxisJoint& joint) {
        joints_.push_back(std::make_unique<Joint>(id_, a, b, Joint::Frame{.origin = at}, joint));
        world_->add(*joints_.back());
        return *joints_.back();
    }
    /// A body fixed to a member at `share` of its axis by a joint of the engine's; null: the
    /// ground.
    dJointID hang(ode::StructureInTime& frame, const std::string& member, double share, Body body,
                  OwnJoint kind) const {
        const dJointID joint = join(frame.body_of(member), body, frame.place(member, share), kind);
        if (kind == OwnJoint::weld) frame.attach(member, share, joint); // others say it
        return joint;
    }
    dJointID hang(ode::Structure& frame, const std::string& member, double share, Body body,
                  OwnJoint kind) const {
        return join(frame.body(frame.plan().body(member)), body, frame.place(member, share), kind);
    }
    static void let_go(dJointID joint, bool off = true) {
        (off ? dJointDisable : dJointEnable)(joint);
    }
    void set_gravity(const Vector3<double>& g) {
        dWorldSetGravity(id_, dReal(g.x()), dReal(g.y()), dReal(g.z()));
    }
    void set_friction(double coefficient) { friction_ = coefficient; }

    void step(double dt) {
        if (damping_ != 0) each([this](dBodyID body) { apply_damping(body); });
        if (!frames_) dSpaceCollide(space_, this, &StructureRig::touch);
        world_->step(dt);
        if (!frames_) dJointGroupEmpty(contacts_);
        events_ += world_->events().size();
    }
    void run(double time, double dt) {
        for (int i = 0, n = int(time / dt + 0.5); i < n; ++i) step(dt);
    }
    /// By forces in proportion to mass and velocity [1/s].
    void damp(double rate) { damping_ = rate; }
    void keep_awake() { set_sleep(false); }
    void let_sleep() { set_sleep(true); }
    [[nodiscard]] bool asleep() {
        bool all = true;
        each([&](dBodyID body) { all = all && dBodyIsEnabled(body) == 0; });
        return all;
    }
    [[nodiscard]] double speed() {
        double most = 0;
        each([&](dBodyID body) { most = std::max(most, norm(ode::linear_velocity(body))); });
        return most;
    }
    [[nodiscard]] static double mass(Body body) { return ode::mass(body); }
    [[nodiscard]] static Vector3<double> place(Body body) {
        return ode::to_core(dBodyGetPosition(body));
    }
    [[nodiscard]] static bool moves(Body body) { return ode::can_move(body); }
    [[nodiscard]] static bool asleep(Body body) { return dBodyIsEnabled(body) == 0; }
    [[nodiscard]] static BodyMotion motion(Body body) {
        return {ode::linear_velocity(body), ode::angular_velocity(body)};
    }
    [[nodiscard]] static Matrix3<double> inertia(Body body) { return ode::inertia(body); }
    static void set_mass(Body body, double mass) {
        dMass now;
        dBodyGetMass(body, &now);
        dMassAdjust(&now, dReal(mass));
        dBodySetMass(body, &now);
    }
    static void apply_force(Body body, const Vector3<double>& force, const Vector3<double>& at) {
        dBodyAddForceAtPos(body, dReal(force.x()), dReal(force.y()), dReal(force.z()),
                           dReal(at.x()), dReal(at.y()), dReal(at.z()));
    }
    static void set_velocity(Body body, const Vector3<double>& v,
                             const Vector3<double>& spin = {0, 0, 0}) {
        dBodySetLinearVel(body, dReal(v.x()), dReal(v.y()), dReal(v.z()));
        dBodySetAngularVel(body, dReal(spin.x()), dReal(spin.y()), dReal(spin.z()));
    }

    [[nodiscard]] std::size_t events() const { return events_; }
    /// Warnings.
    [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }
    /// All that move: those of the structure built last, and the user's.
    template <class Visit>
    void each(const Visit& visit) {
        for (dBodyID body : own_) visit(body);
        if (in_time_ != nullptr) {
            for (dBodyID body : in_time_->bodies()) {
                if (moves(body)) visit(body);
            }
        }
        if (built_ == nullptr) return;
        for (std::size_t i = 0; i < built_->plan().bodies.size(); ++i) {
            if (built_->has_body(i)) visit(built_->body(i));
        }
    }

  private:
    [[nodiscard]] dJointID join(Body a, Body b, const Vector3<double>& at, OwnJoint kind) const {
        const auto x = dReal(at.x()), y = dReal(at.y()), z = dReal(at.z());
        const dJointID joint = kind == OwnJoint::point   ? dJointCreateBall(id_, nullptr)
                               : kind == OwnJoint::hinge ? dJointCreateHinge(id_, nullptr)
                                                         : dJointCreateFixed(id_, nullptr);
        dJointAttach(joint, a, b);
        if (kind == OwnJoint::point) dJointSetBallAnchor(joint, x, y, z);
        if (kind == OwnJoint::hinge) {
            dJointSetHingeAnchor(joint, x, y, z);
            dJointSetHingeAxis(joint, 0, 1, 0);
        }
        if (kind == OwnJoint::weld) dJointSetFixed(joint);
        return joint;
    }
    static void touch(void* rig, dGeomID a, dGeomID b) {
        static_cast<StructureRig*>(rig)->add_contacts(a, b);
    }
    void add_contacts(dGeomID a, dGeomID b) {
        dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
        if (body_a == nullptr && body_b == nullptr) return;
        if (built_ != nullptr && built_->meet(body_a, body_b)) return;
        if (OdeEngine::are_joined(a, b)) return;
        dSurfaceParameters surface{};
        surface.mode = dContactApprox1;
        surface.mu = dReal(friction_);
        engine_.touch(a, b, surface, [this](dJointID joint, const dContact& contact) {
            world_->add_contact(joint, contact);
        });
    }
    void apply_damping(dBodyID body) {
        ode::add_force(body, scaled(-damping_ * ode::mass(body), ode::linear_velocity(body)),
                       scaled(-damping_, times(ode::inertia(body), ode::angular_velocity(body))));
    }
    void set_sleep(bool yes) {
        each([&](dBodyID body) { dBodySetAutoDisableFlag(body, yes ? 1 : 0); });
    }

    OdeEngine engine_;
    dWorldID id_ = engine_.id;
    dSpaceID space_ = engine_.space;
    dJointGroupID contacts_ = engine_.contacts;
    std::vector<dBodyID> own_;
    std::vector<std::string> lines_;
    std::unique_ptr<ode::World> world_;
    std::vector<std::unique_ptr<Joint>> joints_;
    const ode::Structure* built_ = nullptr;
    const ode::StructureInTime* in_time_ = nullptr;
    bool frames_ = false;
    double damping_ = 0, friction_ = 0.6;
    std::size_t events_ = 0;
};

} // namespace ductile::test
