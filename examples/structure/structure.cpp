// SPDX-License-Identifier: MIT
//
// A frame of three storeys loses a column: columns HEB 200, beams IPE 300 of S355, 6 × 5 m, storeys
// of 3.5 m, 3 t on every beam. Each member is one rigid body, with joints of six axes at its ends;
// the hinges are 0.2 and 0.3 m long, about as long as the sections are high.
//
// Source: reference problem P29 (tests/reference/README.md), which is solved there by other means.
//
// Expected:
//
//   intact: 0.0380 of its strength used, most at column 00 start
//   without a column: 0.5089, most at beam 13 start; absorbed 0.0 J
#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <ductile/bullet/bullet.hpp>
#include <ductile/bullet/structure.hpp>
#include <ductile/material/named.hpp>
#include <string>

int main() {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld dynamics(&dispatcher, &broadphase, &solver, &configuration);
    dynamics.setGravity({0, 0, -9.81});

    using namespace ductile;
    const Material<double> steel(s355<double>());
    const ISection<double> heb200(
        {.width = 0.2, .height = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015});
    const ISection<double> ipe300(
        {.width = 0.15, .height = 0.3, .web_thickness = 0.0071, .flange_thickness = 0.0107});

    StructureModel model;
    NodeId at[4][4];
    for (int k = 0; k < 4; ++k) {
        at[k][0] = model.node({0, 0, 3.5 * k});
        at[k][1] = model.node({6, 0, 3.5 * k});
        at[k][2] = model.node({6, 5, 3.5 * k});
        at[k][3] = model.node({0, 5, 3.5 * k});
    }
    for (const NodeId foot : at[0]) model.support(foot);
    for (int i = 0; i < 12; ++i) {
        const int k = i / 4, c = i % 4;
        const std::string number = std::to_string(k) + std::to_string(c);
        model.member("column " + number, at[k][c], at[k + 1][c], heb200, steel,
                     {.joint_length = 0.2, .mass_per_length = 61.3});
        model.member("beam " + number, at[k + 1][c], at[k + 1][(c + 1) % 4], ipe300, steel,
                     {.joint_length = 0.3,
                      .setback = 0.1,
                      .offset = {0, 0, -0.16},
                      .mass_per_length = 42.2,
                      .carried_mass = 3000});
    }

    bullet::World world(dynamics);
    bullet::Structure frame(world, model);
    for (int i = 0; i < 60; ++i) world.step(1.0 / 60);
    std::printf("intact: %.4f of its strength used, most at %s\n", frame.utilisation(),
                frame.most_used().c_str());
    frame.remove("column 00");
    for (std::size_t i = 0; i < frame.plan().bodies.size(); ++i) {
        if (!frame.has_body(i)) continue;
        frame.body(i)->setDamping(0.865, 0.865);                 // e^-2 a second: it comes to rest,
        frame.body(i)->setActivationState(DISABLE_DEACTIVATION); // and not by falling asleep
    }
    for (int i = 0; i < 2400; ++i) world.step(1.0 / 60);
    std::printf("without a column: %.4f, most at %s; absorbed %.1f J\n", frame.utilisation(),
                frame.most_used().c_str(), frame.absorbed_energy());
}
