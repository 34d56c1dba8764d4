// SPDX-License-Identifier: MIT
//
// The same members in Bullet and in ODE: they split or not at the same speeds, and absorb the same.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "adapters/member_rig.hpp"
#include "adapters/ode_member_rig.hpp"
#include "ductile/material/named.hpp"
#include "ductile/section/rectangle.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr double alike = 0.01; ///< of what is absorbed

/// Falls by its own weight, clamped: which sections split, and what they took.
struct Fallen {
    std::vector<int> split;
    double absorbed = 0;
};
template <class World, class AnyMember>
Fallen fall(World& world, AnyMember& post, double time, double dt) {
    Fallen fallen;
    world.add(post, "post");
    for (double t = 0; t < time - dt / 2; t += dt) {
        world.step(dt);
        for (const auto& event : world.events()) {
            if (event.kind == EventKind::split) fallen.split.push_back(event.section);
        }
    }
    fallen.absorbed = post.absorbed_energy();
    return fallen;
}

} // namespace

TEST_CASE("a struck post absorbs in ODE what it does in Bullet", "[members]") {
    for (const double speed : {0.5, 1.0, 2.0}) {
        for (const double frame : {1.0 / 60, 1.0 / 240}) {
            BallOnPost bullet(heavy_post(), 100, speed);
            in_ode::BallOnPost ode(heavy_post(), 100, speed);
            bullet.go(2, frame);
            ode.go(2, frame);
            CAPTURE(speed, frame);
            CHECK(ode.post->whole() == bullet.post->whole());
            CHECK(ode.post->absorbed_energy() ==
                  Approx(bullet.post->absorbed_energy()).epsilon(alike));
        }
    }
}

TEST_CASE("a ball that strikes where two segments meet takes as much in Bullet as in ODE",
          "[members]") {
    // whose boxes have no rounded edges, between which it would sink
    for (const double mass : {2.0, 20.0}) {
        for (const double frame : {1.0 / 60, 1.0 / 240}) {
            BallOnPost bullet(heavy_post(), mass, 5, 0.01, 0.05, 0.00713, 1, false);
            in_ode::BallOnPost ode(heavy_post(), mass, 5, 0.01, 0.05, 0.00713, 1, false);
            bullet.go(0.5, frame);
            ode.go(0.5, frame);
            CAPTURE(mass, frame);
            CHECK(bullet.post->absorbed_energy() ==
                  Approx(ode.post->absorbed_energy()).epsilon(alike));
        }
    }
}

TEST_CASE("an elastic post bears in ODE the blows that it bears in Bullet", "[members]") {
    // E of the blow against U_y = M_p² l/(6 EI), which a heavy ball meets at one speed
    const Rectangle<double> section({.width = 0.064, .height = 0.01});
    const Member of = beam(section, Material<double>(s355<double>()),
                           {.length = 1, .segments = 16, .clamped = true});
    const auto absorbed = [&](bool in_bullet, double speed) {
        if (in_bullet) {
            BallOnPost scene(of, 100, speed, 0.01, 0.01, 0.003);
            scene.go(0.2, 1.0 / 240);
            return scene.post->absorbed_energy();
        }
        in_ode::BallOnPost scene(of, 100, speed, 0.01, 0.01, 0.003);
        scene.go(0.2, 1.0 / 240);
        return scene.post->absorbed_energy();
    };
    const auto speed_at_yield = [&](bool in_bullet) {
        double bears = 0.01, yields = 2;
        while (yields > 1.001 * bears) {
            const double speed = (bears + yields) / 2;
            (absorbed(in_bullet, speed) > 0 ? yields : bears) = speed;
        }
        return yields;
    };
    const double in_bullet = speed_at_yield(true);
    CHECK(in_bullet > 0.02);
    CHECK(speed_at_yield(false) == Approx(in_bullet).epsilon(alike));
    const double fast = 3 * in_bullet;
    CHECK(absorbed(false, fast) == Approx(absorbed(true, fast)).epsilon(alike));
}

TEST_CASE("a cantilever collapses in ODE as in Bullet", "[members]") {
    for (const double tolerance : {0.0, 0.01}) {
        const double dt = tolerance > 0 ? 1.0 / 60 : 1e-3;
        // M_p is half of what its own weight needs at the root
        const Member of = strip(8, true, Lumping::ends, 2 * 9.81 * 0.5 / 2);
        Rig rig({0, btScalar(-9.81), 0});
        bullet::World world(rig.engine, {.tolerance = tolerance, .warn = {}});
        bullet::Member post(rig.body(0, {0, 0, 0}, {0, 0, 0}), of, here);
        const Fallen in_bullet = fall(world, post, 0.3, dt);
        const in_ode::Rig ode_rig({0, -9.81, 0});
        ode::World ode_world(ode_rig.id, {.tolerance = tolerance, .warn = {}});
        ode::Member ode_post(ode_rig.body(0, {0, 0, 0}, {0, 0, 0}), of, in_ode::here);
        const Fallen in_ode = fall(ode_world, ode_post, 0.3, dt);
        CAPTURE(tolerance, in_bullet.absorbed, in_ode.absorbed);
        CHECK(in_bullet.absorbed > 0.5);
        CHECK(in_ode.absorbed == Approx(in_bullet.absorbed).epsilon(alike));
        CHECK(in_ode.split == in_bullet.split);
    }
}
