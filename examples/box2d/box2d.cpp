// SPDX-License-Identifier: MIT
//
// An engine that nobody here wrote: Box2D 2.4, through a port of one page (plastic_hinge.hpp).
//
// A rotor of I = 2 kg m² spins at 10 rad/s on a pin whose hinge carries M_p = 64 N m and breaks
// after 1.5 rad. It takes 64 × 1.5 = 96 of the rotor's 100 J and leaves √(2 × 4 J / 2 kg m²) = 2
// rad/s (problem P02 of tests/reference with other numbers), at every step.
//
// Round-off. The work of the break is counted in double and is 96 J to the last digit. The motion
// is Box2D's: each step rounds the speed to float, by up to 2⁻²⁴ of it, and so the rotor's energy
// by up to 2⁻²⁴ × 2 × 100 J = 1.2e-5 J. That adds up over the steps until the break and is all that
// the last column shows, the 100 J less what the hinge took and the rotor kept. Expected output:
//
//   dt [s]     took [J]   over [rad]   then [rad/s]   round-off [J]
//   exact       96.0000     1.500000       2.000000
//   1/15        96.0000     1.500000       2.000002        -7.6e-06
//   1/30        96.0000     1.500000       2.000003        -1.0e-05
//   1/60        96.0000     1.500000       1.999996         1.5e-05
//   1/120       96.0000     1.500000       1.999999         2.4e-06
//   1/240       96.0000     1.500000       2.000019        -7.5e-05
//   1/1000      96.0000     1.500000       2.000086        -3.4e-04
//
// Ends with 1 where a figure is not that.
#include <box2d/box2d.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "plastic_hinge.hpp"

int main() {
    using namespace ductile;
    constexpr float inertia = 2, spin = 10;               // kg m², rad/s
    constexpr double strength = 64, limit = 1.5;          // N m, rad
    constexpr double start = inertia * spin * spin / 2.0; // J
    const double left = std::sqrt(2 * (start - strength * limit) / inertia);
    std::printf("dt [s]     took [J]   over [rad]   then [rad/s]   round-off [J]\n");
    std::printf("%-8s %10.4f %12.6f %14.6f\n", "exact", strength * limit, limit, left);

    bool right = true;
    for (const int rate : {15, 30, 60, 120, 240, 1000}) {
        const float dt = 1.0f / float(rate);
        b2World world({0, 0});
        b2BodyDef fixed, free;
        free.type = b2_dynamicBody;
        b2Body* ground = world.CreateBody(&fixed);
        b2Body* rotor = world.CreateBody(&free);
        const b2MassData mass{1, {0, 0}, inertia};
        rotor->SetMassData(&mass);
        rotor->SetAngularVelocity(spin);
        b2RevoluteJointDef definition;
        definition.Initialize(ground, rotor, {0, 0});
        auto& pin = *static_cast<b2RevoluteJoint*>(world.CreateJoint(&definition));

        PlasticHinge hinge(pin, OneAxisJoint(Perfect<double>({.strength = strength}),
                                             TravelLimit<double>({.limit = limit})));
        int steps = 0;
        for (; steps < rate && !hinge.broken(); ++steps) {
            hinge.prepare(dt);
            world.Step(dt, 8, 3);
            hinge.commit(dt);
        }
        const auto& state = hinge.joint().state();
        const double end = rotor->GetAngularVelocity();
        const double round_off = start - state.plastic_work - inertia * end * end / 2;
        std::printf("%-8s %10.4f %12.6f %14.6f %15.1e\n", ("1/" + std::to_string(rate)).c_str(),
                    state.plastic_work, state.plastic_travel, end, round_off);

        right = right && hinge.broken() && std::abs(state.plastic_work - strength * limit) < 1e-9 &&
                std::abs(round_off) < (steps + 1) * 0x1p-24 * 2 * start;
    }
    return right ? 0 : 1;
}
