// SPDX-License-Identifier: MIT
//
// ODE with a world, a space and a group of contacts, for as long as this lives.
#pragma once

#include <ode/ode.h>

namespace ductile::scenes {

struct OdeEngine {
    OdeEngine() {
        dInitODE2(0);
        id = dWorldCreate();
        space = dHashSpaceCreate(nullptr);
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

    dWorldID id = nullptr;
    dSpaceID space = nullptr;
    dJointGroupID contacts = nullptr;
};

} // namespace ductile::scenes
