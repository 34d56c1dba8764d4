// SPDX-License-Identifier: MIT
//
// A lamp post in a Bullet world that is there already: its foot bends, takes energy and breaks. The
// post is a box of 100 × 100 × 4 mm of S355, 4 m long, 60 kg; a car has hit it so that it turns
// about its foot at 8 rad/s, with 10.2 kJ. Expected: yields at once, breaks at 0.3 rad, after M_p ×
// 0.3 rad, with M_p = 355 MPa × (0.1³ - 0.092³)/4 m³ = 19.64 kN m:
//
//   lamp post yielded at 0.002 s
//   lamp post broke at 0.047 s
//   took 5899.6 J
#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <ductile/bullet/bullet.hpp>

int main() {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld dynamics_world(&dispatcher, &broadphase, &solver, &configuration);
    dynamics_world.setGravity({0, 0, 0}); // it acts little in 50 ms

    const btScalar length = 4, width = btScalar(0.1), mass = 60;
    btBoxShape shape({width / 2, width / 2, length / 2});
    btVector3 inertia;
    shape.calculateLocalInertia(mass, inertia);
    using Parameters = btRigidBody::btRigidBodyConstructionInfo;
    btRigidBody body(Parameters(mass, nullptr, &shape, inertia));
    body.getWorldTransform().setOrigin({0, 0, length / 2});
    body.setAngularVelocity({8, 0, 0});
    body.setLinearVelocity(btVector3(8, 0, 0).cross({0, 0, length / 2}));
    btEmptyShape nothing;
    btRigidBody ground(Parameters(0, nullptr, &nothing));
    dynamics_world.addRigidBody(&body, 0, 0); // what it falls on is not looked at here
    dynamics_world.addRigidBody(&ground, 0, 0);
    btTransform frame_in_body, frame_in_ground; // z along the member
    frame_in_body.setIdentity(), frame_in_ground.setIdentity();
    frame_in_body.setOrigin({0, 0, -length / 2});

    using namespace ductile;
    const auto bend = section_joint(
        Box<double>(
            {.width = 0.1, .height = 0.1, .web_thickness = 0.004, .flange_thickness = 0.004}),
        Material<double>(s355<double>()),
        {.length = 0.2, .largest_bending = 0.3, .largest_twist = 0.6, .elastic = true});
    bullet::PlasticJoint post(body, ground, frame_in_body, frame_in_ground, bend);

    bullet::World world(dynamics_world);
    world.add(post, "lamp post");
    for (int i = 0; i < 100; ++i) {
        world.step(0.001);
        for (const JointEvent<double>& event : world.events()) {
            std::printf("%s %s at %.3f s\n", event.name.c_str(), to_string(event.kind).data(),
                        event.time);
        }
    }
    std::printf("took %.1f J\n", post.absorbed_energy());

    world.remove(post);
    dynamics_world.removeRigidBody(&body);
    dynamics_world.removeRigidBody(&ground);
}
