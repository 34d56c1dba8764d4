#include <cstdio>
#include <ductile/ductile.hpp>
#ifdef WITH_BULLET
#include <ductile/bullet/bullet.hpp>
#endif
#ifdef WITH_ODE
#include <ductile/ode/ode.hpp>
#endif

int main() {
#ifdef WITH_BULLET
    ductile::bullet::require_matching_precision();
#endif
#ifdef WITH_ODE
    ductile::ode::require_matching_precision();
#endif
    const ductile::Perfect<double> law({.strength = 64});
    std::printf("holds %.1f N m\n", law.value(0));
}
