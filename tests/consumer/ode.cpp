// SPDX-License-Identifier: MIT
#include <cstdio>
#include <ductile/ode/ode.hpp>
#include <ductile/ode/precision_check.hpp>

int main() {
    ductile::ode::require_matching_precision();
    dMass mass;
    dMassSetBoxTotal(&mass, 1, 1, 1, 1);
    const ductile::Perfect<double> law({.strength = 64});
    std::printf("holds %.1f N m\n", law.value(0) * double(mass.mass));
}
