// SPDX-License-Identifier: MIT
//
// Includes little, as it is built by every way; run.sh has all of the core read once.
#include <cstdio>
#include <ductile/material.hpp>
#include <ductile/section/capacity.hpp>
#include <ductile/section/rectangle.hpp>

int main() {
    using namespace ductile;
    const Material<double> steel(
        {.density = 7800, .youngs_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = 400e6});
    const Rectangle<double> bar({.width = 0.01, .height = 0.008});
    std::printf("holds %.1f N m\n", plastic_moment(bar, steel)); // 400 MPa × 0.01 × 0.008²/4 m³
}
