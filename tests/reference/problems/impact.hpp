// SPDX-License-Identifier: MIT
//
// Beams of N rigid segments that are struck or pushed and come to rest: P13 (Parkes' cantilever), P15
// (Symonds' beam). Small displacements.
//
// Source: Parkes (1955), Proc. R. Soc. A 228, 462-476; Symonds (1953), problem as in Jones (2012),
// Structural Impact, chapter 3; answers for N segments from REFERENCE-grade event-driven solutions with
// piecewise constant accelerations, quoted where they are compared.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "reference/beam.hpp"
#include "reference/order.hpp"

namespace ductile::reference {

struct BeamEnd {
    double deflection = 0, root = 0, time = 0;
    double struck_energy = 0; ///< after the impulse [J]
    double ledger = 0;        ///< struck energy + supplied - what the joints took - kinetic [J]
    double residual = 0;      ///< largest the joints saw [rad/s]
};

/// Steps until nothing moves; `load_at(t)` is sampled at mid-step. Deflection of joint `where`.
template <class LoadAt>
[[nodiscard]] BeamEnd run_to_rest(Beam<double>& beam, int joints, int where, double dt,
                                  LoadAt&& load_at, double loaded_until = 0) {
    World<double>& world = beam.world();
    BeamEnd end;
    end.struck_energy = world.kinetic_energy();
    int steps = 0;
    const auto moving = [&] {
        for (int i = 0; i <= joints; ++i) {
            if (std::abs(beam.velocity(i)) > 1e-9) return true;
        }
        return false;
    };
    do {
        world.step(dt, load_at((steps + 0.5) * dt));
        ++steps;
    } while (moving() || steps * dt < loaded_until);
    end.deflection = beam.deflection(where);
    end.root = beam.rotation(0);
    end.time = steps * dt;
    end.ledger = end.struck_energy + world.supplied() - beam.plastic_work() - beam.other_work() -
                 world.kinetic_energy();
    end.residual = beam.residual();
    return end;
}

// ---- P13 ------------------------------------------------------------------------------------------------

struct Parkes {
    double tip_mass = 1, speed = 4;
    double length = 1, mass_per_length = 2, plastic_moment = 100;
};

/// The impulse G V0 acts on the tip at t = 0.
[[nodiscard]] inline BeamEnd strike_cantilever(const Parkes& p, int segments, double dt,
                                               Kinematics kinematics = Kinematics::small) {
    Beam<double> beam({.length = p.length, .mass_per_length = p.mass_per_length,
                       .plastic_moment = p.plastic_moment, .segments = segments,
                       .left = Support::clamped, .right = Support::free,
                       .tip_mass = p.tip_mass, .kinematics = kinematics});
    Vector<double> impulse = beam.world().no_load();
    beam.add_force(impulse, p.length, p.tip_mass * p.speed);
    beam.world().strike(impulse);
    const Vector<double> none = beam.world().no_load();
    BeamEnd end = run_to_rest(beam, segments, segments, dt, [&](double) { return none; });
    if (kinematics == Kinematics::finite) end.deflection = beam.tip().y();
    return end;
}

// ---- P15 ------------------------------------------------------------------------------------------------

struct Symonds {
    double half_length = 1, mass_per_length = 2, plastic_moment = 100;
    Support ends = Support::pinned;

    /// p_c = 2 M_p/L², static collapse pressure of the pinned beam [N/m].
    [[nodiscard]] double collapse_pressure() const {
        return 2 * plastic_moment / (half_length * half_length);
    }
    [[nodiscard]] BeamParameters<double> beam(int segments_per_half) const {
        return {.length = 2 * half_length, .mass_per_length = mass_per_length,
                .plastic_moment = plastic_moment, .segments = 2 * segments_per_half,
                .left = ends, .right = ends};
    }
};

/// Every segment starts with this velocity; the supports take theirs at once.
[[nodiscard]] inline BeamEnd throw_beam(const Symonds& p, int per_half, double speed, double dt) {
    Beam<double> beam(p.beam(per_half));
    Vector<double> impulse = beam.uniform_load(p.mass_per_length * speed);
    beam.world().strike(impulse);
    const Vector<double> none = beam.world().no_load();
    return run_to_rest(beam, 2 * per_half, per_half, dt, [&](double) { return none; });
}

/// The pressure `overload` × p_c for `duration`, then nothing.
[[nodiscard]] inline BeamEnd push_beam(const Symonds& p, int per_half, double overload,
                                       double duration, double dt) {
    Beam<double> beam(p.beam(per_half));
    const Vector<double> pressure = beam.uniform_load(overload * p.collapse_pressure());
    const Vector<double> none = beam.world().no_load();
    return run_to_rest(
        beam, 2 * per_half, per_half, dt,
        [&](double time) { return time < duration ? pressure : none; }, duration);
}

} // namespace ductile::reference
