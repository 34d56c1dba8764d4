// SPDX-License-Identifier: MIT
//
// The joint of six axes against the same link in the smallest engine there is, solved exactly: with
// rows that the step does not resolve, which are compliant, and a surface whose bounds are not
// symmetric. With the rig's verbs (RIG_HEADER). A solver that does not solve rows that hang
// together to round-off is near, or the joint says that it is not.
#include RIG_HEADER

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "adapters/features.hpp"
#include "adapters/six_axis.hpp"
#include "reference/pair_world.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("a six-axis joint does what the same link does in an exact solver", "[six]") {
    const auto solver = GENERATE(from_range(solvers_with<Rig>(Capability::any_rows)));
    const double rate = GENERATE(30.0, 120.0, 480.0);
    const double speed = GENERATE(1.0, 6.0);
    INFO(solver << ", dt = 1/" << rate << ", speed " << speed);
    const double dt = 1 / rate;
    const V3 at_a(0.4, 0, 0.5), at_b(0, -0.2, -0.6), v = speed * V3(1, -2, 1),
                                                     w = speed * V3(2, -3, 1);
    V6 stiffness;
    stiffness << 2e4, 3e4, 5e4, 400, 600, 300;
    const Six law = six(capacities(), infinity, stiffness);

    Rig rig(solver, none);
    auto a = rig.body(2, sphere(0.3), at_a, v, w);
    auto b = rig.body(3, sphere(0.5), at_b, none, none);
    auto& joint = rig.six_axis(a, b, Frame{}, law);

    const auto body = [](double mass, double inertia, const V3& at) {
        return BodyState<double>{
            .position = at, .inverse_mass = 1 / mass, .inverse_inertia = M3::Identity() / inertia};
    };
    auto first = body(2, 0.3, at_a);
    first.velocity = v;
    first.spin = w;
    reference::PairWorld world(first, body(3, 0.5, at_b),
                               Link(law, all_joint_axes, Frame{V3(-at_a), M3::Identity()},
                                    Frame{V3(-at_b), M3::Identity()}));

    if (Rig::meets_surfaces) world.meet_surfaces();

    Shown shown(solver, "six axes: as an exact solver");
    const bool coupled = Rig::can(solver, Capability::coupled);
    // over longer times two solvers drift apart where a row just reaches its bound
    constexpr double solver_round_off = Rig::single ? 5e-4 : 1e-7;
    constexpr double certified =
        2e-2;                        // what an unsolved row may be off by and still count as solved
    const double size = 10 * speed;  // of spins; velocities are less
    const double force_scale = 1200; // the largest capacity
    bool unreliable = false;
    double off = 0;
    for (int i = 0; i < 12; ++i) {
        rig.step(dt);
        world.step(dt);
        unreliable = unreliable || says_wrong(joint);
        for (const JointAxis axis : all_joint_axes) {
            off = std::max(off, std::abs(joint.position(axis) - world.link().position(axis)));
            if (!coupled) continue;
            off =
                std::max(off, std::abs(joint.force(axis) - world.link().force(axis)) / force_scale);
        }
        off = std::max({off, (Rig::velocity(b) - world.b().velocity).norm() / size,
                        (Rig::spin(a) - world.a().spin).norm() / size});
    }
    INFO("off by " << off << (unreliable ? ", unreliable" : ""));
    const double work = world.link().joint().state().plastic_work;
    if (coupled) {
        shown.small(off, solver_round_off);
        CHECK_FALSE(unreliable);
        CHECK(joint.absorbed_energy() == Approx(work).epsilon(Rig::single ? 1e-3 : 1e-6));
        CHECK((joint.absorbed_energy() > 0.1) == (speed > 1));
    } else {
        shown.right_or_reported(off < certified, unreliable);
    }
}
