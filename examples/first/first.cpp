// SPDX-License-Identifier: MIT
//
// The smallest program: a rotor of 2 kg m² that spins at 10 rad/s into a steel bar of 10 × 8 mm,
// 400 MPa, that breaks at 1.5 rad. M_p = f_y b h²/4 = 64 N m takes 64 × 1.5 = 96 of its 100 J, which
// leaves √(2 × 4 J / 2 kg m²) = 2 rad/s. Expected output:
//
//   took 96.000 J over 1.500 rad, then broke at 2.000000 rad/s
#include <ductile/ode/ode.hpp>
#include <cstdio>

int main() {
    using namespace ductile;
    const Material<double> steel({.density = 7800, .youngs_modulus = 200e9,
                                  .poisson_ratio = 0.3, .yield_stress = 400e6});
    const Rectangle<double> bar({.width = 0.01, .height = 0.008});

    dInitODE();
    dWorldID world = dWorldCreate();
    dBodyID rotor = dBodyCreate(world);
    dMass mass;
    dMassSetParameters(&mass, 1, 0, 0, 0, 2, 2, 2, 0, 0, 0);
    dBodySetMass(rotor, &mass);
    dBodySetAngularVel(rotor, 0, 0, 10);

    ode::World stepper(world);
    ode::PlasticHinge hinge(world, rotor, nullptr, {.axis = {0, 0, 1}},
                            OneAxisJoint(Perfect<double>({.strength = plastic_moment(bar, steel)}),
                                         TravelLimit<double>({.limit = 1.5})));
    hinge.add_to(stepper);
    for (int i = 0; i < 60 && !hinge.broken(); ++i) stepper.step(1.0 / 60);
    std::printf("took %.3f J over %.3f rad, then broke at %.6f rad/s\n", hinge.absorbed_energy(),
                hinge.plastic_rotation(), dBodyGetAngularVel(rotor)[2]);
}
