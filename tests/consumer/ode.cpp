// SPDX-License-Identifier: MIT
//
// Includes little, as it is built by every way; examples/first has all of the adapter.
#include <ode/ode.h>

#include <cstdio>
#include <ductile/law/perfect.hpp>
#include <ductile/ode/precision_check.hpp>

int main() {
    ductile::ode::require_matching_precision();
    dMass mass;
    dMassSetBoxTotal(&mass, 1, 1, 1, 1);
    const ductile::Perfect<double> law({.strength = 64});
    std::printf("holds %.1f N m\n", law.value(0) * double(mass.mass));
}
