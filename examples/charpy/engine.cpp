// SPDX-License-Identifier: MIT
//
// One build of one engine, as runner.cpp and the tests run it.
#include "drive.hpp"

#ifdef CHARPY_ODE
#include "ode_scene.hpp"
using Scene = charpy::OdeScene;
#else
#include "bullet_scene.hpp"
using Scene = charpy::BulletScene;
#endif

charpy::Result charpy::run(const Scenario& scenario, Method method, const std::string& solver) {
    return drive<Scene>(scenario, method, solver);
}
