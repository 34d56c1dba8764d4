// SPDX-License-Identifier: MIT
//
// The lamp post of bullet.cpp in an ODE world that is there already; the same answer.
#include <ode/ode.h>

#include <cstdio>
#include <ductile/ode/ode.hpp>

int main() {
    dInitODE();
    dWorldID world_id = dWorldCreate();
    const double length = 4, width = 0.1, mass = 60;
    dBodyID body = dBodyCreate(world_id);
    dMass box;
    dMassSetBoxTotal(&box, mass, width, width, length);
    dBodySetMass(body, &box);
    dBodySetFiniteRotationMode(body, 1);
    dBodySetPosition(body, 0, 0, length / 2);
    dBodySetAngularVel(body, 8, 0, 0);
    dBodySetLinearVel(body, 0, -8 * length / 2, 0);

    {
        using namespace ductile;
        const auto bend = section_joint(
            Box<double>(
                {.width = 0.1, .height = 0.1, .web_thickness = 0.004, .flange_thickness = 0.004}),
            Material<double>(s355<double>()),
            {.length = 0.2, .largest_bending = 0.3, .largest_twist = 0.6, .elastic = true});
        // the static world is null; the frame's z is along the member
        ode::PlasticJoint post(world_id, body, nullptr, {.origin = {0, 0, 0}}, bend);

        ode::World world(world_id, ode::WorldParameters{});
        world.add(body); // for the energy ledger
        world.add(post, "lamp post");
        for (int i = 0; i < 100; ++i) {
            world.step(0.001);
            for (const JointEvent<double>& event : world.events()) {
                std::printf("%s %s at %.3f s\n", event.name.c_str(), to_string(event.kind).data(),
                            event.time);
            }
        }
        std::printf("took %.1f J, %.1e J unexplained\n", post.absorbed_energy(),
                    world.ledger().unexplained());
    }
    dWorldDestroy(world_id);
    dCloseODE();
}
