// SPDX-License-Identifier: MIT
//
// A post is struck three times, from one side, the other, and the first again. It is one static
// body until a section yields, opens where it has to, and is one static body again, bent. Box
// 100 x 100 x 4 mm of S355, 2 m, clamped at its foot; a ball of 100 kg at 6 m/s, 1800 J, far more
// than the 259 J that the elastic post can take up (M_p² L/(6 EI)).
//
//   struck_post [FILE.csv]       then plot.py FILE.csv PICTURE.png
//
// Columns: time_s, moment_N_m (about the foot, of the ball's force, mean of the frame),
// open_sections, absorbed_J, tip_m (across).
//
// Expected: of each 1800 J the first segment's blow takes x/(1 + x) = 0.6 %, x = μ s/(2 G), and
// what is left of the ball's motion along the bent post some more.
//
//   hit 1: 1549 J absorbed, tip at 0.164 m, one body
//   hit 2: 3094 J absorbed, tip at -0.001 m, one body
//   hit 3: 4640 J absorbed, tip at 0.163 m, one body
#include <btBulletDynamicsCommon.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <ductile/bullet/bullet.hpp>
#include <ductile/bullet/members.hpp>
#include <ductile/material/named.hpp>
#include <ductile/section/box.hpp>
#include <fstream>
#include <string>

static btTransform at(const btVector3& place) {
    return btTransform(btQuaternion::getIdentity(), place);
}

int main(int argc, char** argv) {
    CLI::App app("A post is struck three times");
    std::string path;
    app.add_option("FILE.csv", path, "its history; none: none is written");
    CLI11_PARSE(app, argc, argv);

    std::ofstream history(path); // without a name nothing is kept
    const auto is_lost = [&] {
        if (path.empty() || history.flush()) return false;
        std::fprintf(stderr, "%s: cannot be written\n", path.c_str());
        return true;
    };
    if (is_lost()) return 2;

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld dynamics(&dispatcher, &broadphase, &solver, &configuration);
    dynamics.setGravity({0, 0, 0});

    using namespace ductile;
    constexpr double length = 2, half = 0.05, radius = 0.1, mass = 100, speed = 6;
    constexpr double frame = 1.0 / 240;
    const Box<double> section(
        {.width = 2 * half, .height = 2 * half, .web_thickness = 0.004, .flange_thickness = 0.004});
    const Member description = beam(section, Material<double>(s355<double>()),
                                    {.length = length, .segments = 20, .clamped = true});
    btBoxShape box({half, half, length / 2});
    btRigidBody standing(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &box));
    standing.setWorldTransform(at({0, 0, length / 2}));
    dynamics.addRigidBody(&standing);

    bullet::World world(dynamics, {.tolerance = 0.01});
    bullet::Member post(standing, description, at({0, 0, -length / 2}), {half, half});
    world.add(post, "post");

    btSphereShape sphere(radius);
    btVector3 inertia;
    sphere.calculateLocalInertia(mass, inertia);
    btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(mass, nullptr, &sphere, inertia));
    ball.setFriction(0);
    ball.setActivationState(DISABLE_DEACTIVATION);

    history << "time_s,moment_N_m,open_sections,absorbed_J,tip_m\n";
    const auto tip = [&] { return post.pose(description.segments() - 1).getOrigin(); };
    for (int hit = 1; hit <= 3; ++hit) {
        const double side = hit == 2 ? -1 : 1;
        const btVector3 from(0, tip().y() - side * (half + radius + 0.08), tip().z() - 0.05);
        ball.setCenterOfMassTransform(at(from));
        ball.setLinearVelocity({0, side * speed, 0});
        ball.setAngularVelocity({0, 0, 0});
        dynamics.addRigidBody(&ball);
        for (int i = 0; i < 72; ++i) {
            const btVector3 before = ball.getLinearVelocity(), arm = ball.getCenterOfMassPosition();
            world.step(frame);
            const btVector3 force = (ball.getLinearVelocity() - before) * (-mass / frame);
            const double moment = arm.z() * force.y() - arm.y() * force.z();
            history << world.time() << ',' << moment << ',' << post.open_sections() << ','
                    << post.absorbed_energy() << ',' << tip().y() << '\n';
        }
        dynamics.removeRigidBody(&ball);
        std::printf("hit %d: %.0f J absorbed, tip at %.3f m, %s\n", hit, post.absorbed_energy(),
                    tip().y(), post.whole() ? "one body" : "open");
    }
    return is_lost() ? 2 : 0;
}
