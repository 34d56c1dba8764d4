// SPDX-License-Identifier: MIT
//
// ODE with a world, a space and a group of contacts, for rigs that make contacts of shapes.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cstddef>

#include "ductile/ode/world_snapshot.hpp"

namespace ductile::test {

/// First made, last destroyed. ODE counts its users.
struct OdeEngine {
    explicit OdeEngine(bool hashed = true) {
        dInitODE2(0);
        id = dWorldCreate();
        space = hashed ? dHashSpaceCreate(nullptr) : dSimpleSpaceCreate(nullptr);
        contacts = dJointGroupCreate(0);
    }
    ~OdeEngine() {
        dJointGroupDestroy(contacts);
        dSpaceDestroy(space);
        dWorldDestroy(id);
        dCloseODE();
    }
    OdeEngine(const OdeEngine&) = delete;
    OdeEngine& operator=(const OdeEngine&) = delete;

    /// A contact of `surface` where two shapes touch, each told: named(joint, contact).
    template <class Named>
    void touch(dGeomID a, dGeomID b, const dSurfaceParameters& surface, Named&& named) const {
        std::array<dContact, 8> found{};
        const int count = dCollide(a, b, int(found.size()), &found[0].geom, int(sizeof(dContact)));
        for (int i = 0; i < count; ++i) {
            dContact& contact = found[std::size_t(i)];
            contact.surface = surface;
            const dJointID joint = dJointCreateContact(id, contacts, &contact);
            dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
            named(joint, contact);
        }
    }
    /// True of bodies with a joint between them that is no contact.
    [[nodiscard]] static bool are_joined(dGeomID a, dGeomID b) {
        const dBodyID of_a = dGeomGetBody(a), of_b = dGeomGetBody(b);
        return of_a != nullptr && of_b != nullptr &&
               dAreConnectedExcluding(of_a, of_b, dJointTypeContact) != 0;
    }

    dWorldID id = nullptr;
    dSpaceID space = nullptr;
    dJointGroupID contacts = nullptr;
};

namespace in_ode {

/// A body that no member or structure made, as it was.
struct KeptBody {
    dBodyID body;
    ode::BodySnapshot as_it_was;

    explicit KeptBody(dBodyID of) : body(of), as_it_was(of) {}
    void put_back() const { as_it_was.put_back(body); }
};

} // namespace in_ode

} // namespace ductile::test
