// SPDX-License-Identifier: MIT
//
// Posts of plastic hinges, boxes and a ball on a floor in ODE, looked after by a ductile World.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "cpu_time.hpp"
#include "ductile/ode/members.hpp"
#include "ductile/ode/ode.hpp"

namespace bench::locality {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;

inline constexpr double frame = 1.0 / 60;

using Hinge = ode::PlasticHinge<Law>;

class Site {
  public:
    Site(double tolerance, bool ledger) {
        dWorldSetGravity(engine_.id, 0, dReal(-9.81), 0);
        dCreatePlane(engine_.space, 0, 1, 0, 0);
        world_.emplace(
            engine_.id,
            ode::WorldParameters{
                .ledger = ledger, .tolerance = tolerance, .rest_damping = 0, .warn = {}});
        world_->on_contacts({.space = engine_.space, .group = engine_.contacts},
                            [this] { dSpaceCollide(engine_.space, this, &Site::near); });
    }

    /// Of pieces of 0.4 m, at x, z.
    void post(double x, double z, int joints) {
        dBodyID below = nullptr;
        for (int i = 0; i < joints; ++i) {
            dMass mass;
            dMassSetBoxTotal(&mass, 12, dReal(0.1), dReal(0.4), dReal(0.1));
            const dBodyID piece =
                add(mass, dCreateBox(engine_.space, dReal(0.1), dReal(0.4), dReal(0.1)),
                    {x, 0.25 + 0.4 * i, z});
            hinges_.push_back(std::make_unique<Hinge>(
                engine_.id, piece, below,
                ode::HingeFrame{.anchor = {x, 0.05 + 0.4 * i, z}, .axis = {0, 0, 1}},
                Law(Perfect<double>({.strength = 4000}))));
            world_->add(*hinges_.back());
            below = piece;
        }
    }
    /// One that is clamped at the origin, of 16 segments, and one body until it is struck.
    void member() {
        constexpr int count = 16;
        constexpr double length = 2.0 / count;
        MemberParameters p;
        p.segments = lumped_segments(2, 60, count, {1e-3, 1e-3, 2e-3});
        p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
        p.sections.assign(count, UsualAxisJoint(Perfect<double>({.strength = 4000})));
        const dBodyID post = dBodyCreate(engine_.id);
        dBodySetKinematic(post);
        dQuaternion up; // its z, its y along x
        dQFromAxisAndAngle(up, 1, 1, 1, dReal(-2 * std::acos(-1.0) / 3));
        dBodySetQuaternion(post, up);
        for (int k = 0; k < count; ++k) {
            const dGeomID geom = dCreateBox(engine_.space, dReal(0.1), dReal(0.1), dReal(length));
            dGeomSetBody(geom, post);
            dGeomSetOffsetPosition(geom, 0, 0, dReal((k + 0.5) * length));
        }
        members_.push_back(std::make_unique<ode::Member>(post, Member(p), JointFrame<double>{}));
        world_->add(*members_.back());
    }
    /// Two boxes of 1 m on the floor, one on the other, with a hinge between.
    void pair(double x, double z, bool awake) {
        const dBodyID lower = box({x, 0.5, z}, awake), upper = box({x, 1.5, z}, awake);
        hinges_.push_back(std::make_unique<Hinge>(
            engine_.id, upper, lower, ode::HingeFrame{.anchor = {x, 1, z}, .axis = {0, 0, 1}},
            Law(Perfect<double>({.strength = 4000}))));
        world_->add(*hinges_.back());
    }
    /// In rows of 32, beside the post.
    void boxes(int count, bool awake) {
        for (int i = 0; i < count; ++i) {
            (void)box({4 + 1.5 * (i % 32), 0.5, 4 + 1.5 * (i / 32)}, awake);
        }
    }
    void strike() {
        dMass mass;
        dMassSetSphereTotal(&mass, 100, dReal(0.2));
        const dBodyID ball = add(mass, dCreateSphere(engine_.space, dReal(0.2)), {-0.3, 1.9, 0});
        dBodySetGravityMode(ball, 0);
        dBodySetLinearVel(ball, 5, 0, 0);
    }
    /// [s]
    double timed_step() {
        const double start = cpu_now();
        world_->step(frame);
        return cpu_now() - start;
    }
    [[nodiscard]] const ode::World& world() const { return *world_; }

  private:
    /// First made, last destroyed.
    struct Engine {
        Engine() {
            dInitODE2(0);
            id = dWorldCreate();
            space = dHashSpaceCreate(nullptr);
            contacts = dJointGroupCreate(0);
        }
        ~Engine() {
            dJointGroupDestroy(contacts);
            dSpaceDestroy(space);
            dWorldDestroy(id);
            dCloseODE();
        }
        Engine(const Engine&) = delete;
        Engine& operator=(const Engine&) = delete;

        dWorldID id = nullptr;
        dSpaceID space = nullptr;
        dJointGroupID contacts = nullptr;
    };

    static void near(void* data, dGeomID a, dGeomID b) {
        Site& site = *static_cast<Site*>(data);
        const dBodyID of_a = dGeomGetBody(a), of_b = dGeomGetBody(b);
        if (of_a != nullptr && of_b != nullptr &&
            dAreConnectedExcluding(of_a, of_b, dJointTypeContact) != 0) {
            return;
        }
        std::array<dContact, 4> found{};
        const int count = dCollide(a, b, int(found.size()), &found[0].geom, int(sizeof(dContact)));
        for (int i = 0; i < count; ++i) {
            dContact& contact = found[std::size_t(i)];
            contact.surface.mode = dContactApprox1;
            contact.surface.mu = dReal(0.5);
            const dJointID joint =
                dJointCreateContact(site.engine_.id, site.engine_.contacts, &contact);
            dJointAttach(joint, of_a, of_b);
            site.world_->add_contact(joint, contact);
        }
    }
    dBodyID box(const Vector3<double>& at, bool awake) {
        dMass mass;
        dMassSetBoxTotal(&mass, 100, 1, 1, 1);
        const dBodyID made = add(mass, dCreateBox(engine_.space, 1, 1, 1), at);
        dBodySetAutoDisableFlag(made, awake ? 0 : 1);
        return made;
    }
    dBodyID add(const dMass& mass, dGeomID geom, const Vector3<double>& at) {
        const dBodyID made = dBodyCreate(engine_.id);
        dBodySetMass(made, &mass);
        dGeomSetBody(geom, made);
        dBodySetPosition(made, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        world_->add(made);
        return made;
    }

    Engine engine_;
    std::optional<ode::World> world_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
    std::vector<std::unique_ptr<ode::Member>> members_;
};

} // namespace bench::locality
