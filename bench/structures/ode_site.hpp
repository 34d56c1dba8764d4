// SPDX-License-Identifier: MIT
//
// A structure in ODE: dWorldStep or dWorldQuickStep; ours with a World of that solver, contacts
// named to it.
#pragma once

#include <ode/ode.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/ode/ode.hpp"
#include "structures/plan.hpp"

namespace bench::structures {

class Site {
  public:
    static constexpr std::string_view engine = "ode";
    static constexpr std::string_view precision =
        sizeof(dReal) == sizeof(double) ? "double" : "float";
    static constexpr double layer = 1e-3;
    static std::vector<std::string> solvers() { return {"direct", "quick"}; }
    /// dWorldStep grows with the cube; what of ours is solved before does not need QuickStep.
    static bool sensible(const std::string& solver, Method method, std::size_t joints) {
        const bool ours = method == Method::elastic || method == Method::rigid;
        if (solver == "quick") return !ours;
        return method != Method::fixed || joints <= 110;
    }

    Site(const Plan& plan, Method method, const std::string& solver, bool awake)
        : plan_(plan), quick_(solver == "quick") {
        dWorldSetGravity(id_, 0, 0, method == Method::none ? 0 : dReal(-plan.gravity));
        dWorldSetContactSurfaceLayer(id_, dReal(plan.layer));
        dCreatePlane(space_, 0, 0, 1, 0);
        if (method == Method::elastic || method == Method::rigid) {
            world_.emplace(id_, ductile::ode::WorldParameters{
                                    .warn = [this](const std::string&) { ++warnings_; }});
        }
        for (const Part& part : plan.parts) add(part, awake);
        for (const Joint& joint : plan.joints) connect(joint, method);
    }
    ~Site() {
        ours_.clear();
        world_.reset();
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(id_);
        dCloseODE();
    }
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    void step(double dt) {
        dSpaceCollide(space_, this, &Site::touch);
        if (world_) {
            world_->step(dt);
        } else if (quick_) {
            dWorldQuickStep(id_, dReal(dt));
        } else {
            dWorldStep(id_, dReal(dt));
        }
        dJointGroupEmpty(contacts_);
    }
    void remove_column() {
        dBodyID column = bodies_[std::size_t(plan_.to_remove)];
        std::erase_if(ours_, [&](const auto& joint) {
            const bool touches = joint->bodies().a == column || joint->bodies().b == column;
            if (touches) world_->remove(*joint);
            return touches;
        });
        if (world_) world_->remove(column);
        while (dBodyGetNumJoints(column) > 0) dJointDestroy(dBodyGetJoint(column, 0));
        for (dGeomID shape = dBodyGetFirstGeom(column); shape != nullptr;
             shape = dBodyGetFirstGeom(column)) {
            dGeomDestroy(shape);
        }
        dBodySetGravityMode(column, 0);
    }
    [[nodiscard]] double absorbed() const {
        double sum = 0;
        for (const auto& joint : ours_) sum += joint->absorbed_energy();
        return sum;
    }
    [[nodiscard]] V3 position(int part) const {
        return ductile::ode::to_core(dBodyGetPosition(bodies_[std::size_t(part)]));
    }
    [[nodiscard]] int warnings() const { return warnings_; }

  private:
    using Ours = ductile::ode::PlasticJoint<Section>;

    static void touch(void* site, dGeomID a, dGeomID b) {
        static_cast<Site*>(site)->add_contacts(a, b);
    }
    void add_contacts(dGeomID a, dGeomID b) {
        dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
        if (body_a == nullptr && body_b == nullptr) return;
        if (body_a != nullptr && body_b != nullptr && dAreConnected(body_a, body_b) != 0) return;
        std::array<dContact, 8> found{};
        const int count = dCollide(a, b, int(found.size()), &found[0].geom, int(sizeof(dContact)));
        for (int i = 0; i < count; ++i) {
            dContact& contact = found[std::size_t(i)];
            contact.surface.mode = dContactApprox1;
            contact.surface.mu = dReal(friction);
            const dJointID joint = dJointCreateContact(id_, contacts_, &contact);
            dJointAttach(joint, body_a, body_b);
            if (world_) world_->add_contact(joint, contact);
        }
    }

    void add(const Part& part, bool awake) {
        dBodyID body = dBodyCreate(id_);
        dMass mass;
        const V3 side = 2 * part.half;
        dMassSetBoxTotal(&mass, dReal(part.mass), dReal(side.x()), dReal(side.y()),
                         dReal(side.z()));
        dBodySetMass(body, &mass);
        dBodySetPosition(body, dReal(part.at.x()), dReal(part.at.y()), dReal(part.at.z()));
        dBodySetLinearVel(body, dReal(part.velocity.x()), dReal(part.velocity.y()),
                          dReal(part.velocity.z()));
        dBodySetFiniteRotationMode(body, 1);
        dBodySetAutoDisableFlag(body, awake ? 0 : 1);
        if (part.collides) {
            dGeomSetBody(dCreateBox(space_, dReal(side.x()), dReal(side.y()), dReal(side.z())),
                         body);
        }
        if (world_) world_->add(body);
        bodies_.push_back(body);
    }
    void connect(const Joint& joint, Method method) {
        if (method == Method::none) return;
        dBodyID a = bodies_[std::size_t(joint.a)];
        dBodyID b = joint.b == ground ? nullptr : bodies_[std::size_t(joint.b)];
        if (method == Method::fixed) {
            const dJointID fixed = dJointCreateFixed(id_, nullptr);
            dJointAttach(fixed, a, b);
            dJointSetFixed(fixed);
            return;
        }
        ours_.push_back(std::make_unique<Ours>(id_, a, b,
                                               Ours::Frame{.origin = joint.at, .axes = joint.axes},
                                               section(joint.column, method)));
        world_->add(*ours_.back());
    }

    /// First made, last closed.
    struct Library {
        Library() { dInitODE2(0); }
    };

    Plan plan_;
    bool quick_;
    Library library_;
    dWorldID id_ = dWorldCreate();
    dSpaceID space_ = dHashSpaceCreate(nullptr);
    dJointGroupID contacts_ = dJointGroupCreate(0);
    std::vector<dBodyID> bodies_;
    int warnings_ = 0;
    std::optional<ductile::ode::World> world_;
    std::vector<std::unique_ptr<Ours>> ours_;
};

} // namespace bench::structures
