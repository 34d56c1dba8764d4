// SPDX-License-Identifier: MIT
//
// Beams of N rigid segments that are struck or pushed and come to rest: P13 (Parkes' cantilever),
// P15 (Symonds' beam). Small displacements.
//
// Answers for N equal segments are event-driven solutions with piecewise constant accelerations,
// good to the digits given; the continuum is the limit of many segments and is approached slowly.
//
// Source: Parkes (1955), Proc. R. Soc. A 228, 462-476; Symonds (1953), as in Jones (2012),
// Structural Impact, chapter 3.
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

// ---- P13 ----------------------------------------------------------------------------------------

struct Parkes {
    double tip_mass = 1, speed = 4;
    double length = 1, mass_per_length = 2, plastic_moment = 100;
};

/// The impulse G V0 acts on the tip at t = 0.
[[nodiscard]] inline BeamEnd strike_cantilever(const Parkes& p, int segments, double dt,
                                               Kinematics kinematics = Kinematics::small) {
    Beam<double> beam({.length = p.length,
                       .mass_per_length = p.mass_per_length,
                       .plastic_moment = p.plastic_moment,
                       .segments = segments,
                       .left = Support::clamped,
                       .right = Support::free,
                       .tip_mass = p.tip_mass,
                       .kinematics = kinematics});
    Vector<double> impulse = beam.world().no_load();
    beam.add_force(impulse, p.length, p.tip_mass * p.speed);
    beam.world().strike(impulse);
    const Vector<double> none = beam.world().no_load();
    BeamEnd end = run_to_rest(beam, segments, segments, dt, [&](double) { return none; });
    if (kinematics == Kinematics::finite) end.deflection = beam.tip().y();
    return end;
}

/// One row of the tables of exact answers.
struct ParkesAnswer {
    int segments;
    double tip, root, stop, struck_energy; ///< [m], [rad], [s], [J]
};
struct ParkesCase {
    const char* name;
    Parkes parameters;
    std::vector<ParkesAnswer> answers;
};
inline const std::vector<ParkesCase> parkes_cases{
    {"a",
     {.tip_mass = 1, .speed = 4},
     {{1, 0.048, 0.048, 0.04, 4.8},
      {2, 0.0530286227, 0.0453604712, 0.0416, 6.19354839},
      {3, 0.0533768799, 0.0429069058, 0.0415704769, 6.70807453},
      {4, 0.0534942596, 0.0414763964, 0.0415524099, 6.99089727},
      {5, 0.0538005828, 0.0407743046, 0.0416446137, 7.1718616},
      {8, 0.0535874791, 0.0388522198, 0.0414861287, 7.46151177},
      {10, 0.0534009366, 0.0381141855, 0.0413852604, 7.56333089},
      {20, 0.0526932364, 0.0363373977, 0.0410403021, 7.77553951}}},
    {"b",
     {.tip_mass = 0.2, .speed = 10},
     {{1, 0.0230769231, 0.0230769231, 0.02, 2.30769231},
      {2, 0.0300469102, 0.0213346263, 0.0218867925, 4.06779661},
      {3, 0.0316046375, 0.0197093831, 0.0219488798, 5.09433962},
      {4, 0.0325943536, 0.018955462, 0.0220898421, 5.80812446},
      {5, 0.0334691545, 0.0186226252, 0.022291082, 6.33973711},
      {8, 0.0338201573, 0.0170514169, 0.0221341086, 7.3483813},
      {10, 0.0339444434, 0.0165942053, 0.0220949714, 7.75990762},
      {20, 0.0334099967, 0.0151120012, 0.0216824174, 8.73868016}}},
    {"c",
     {.tip_mass = 20, .speed = 1},
     {{1, 0.0967741935, 0.0967741935, 0.2, 9.67741935},
      {2, 0.0973153957, 0.0962024446, 0.200544959, 9.85626283},
      {3, 0.0973009119, 0.0957139986, 0.200526109, 9.90462216},
      {4, 0.0972810832, 0.0954009505, 0.200504103, 9.92834454},
      {5, 0.0973014475, 0.0952309281, 0.200524376, 9.94259618},
      {8, 0.0972463551, 0.0948326988, 0.200465728, 9.96404535},
      {10, 0.0972074611, 0.094670834, 0.200424885, 9.97121558},
      {20, 0.0970948452, 0.094299185, 0.200307039, 9.98558705}}}};

[[nodiscard]] inline std::vector<Quantity> p13_cantilever(const Parkes& p,
                                                          const ParkesAnswer& exact, double dt) {
    const BeamEnd end = strike_cantilever(p, exact.segments, dt);
    return {{"tip", "m", end.deflection, exact.tip, Trend::first_order},
            {"root", "rad", end.root, exact.root, Trend::first_order},
            {"stop", "s", end.time, exact.stop, Trend::first_order},
            {"struck energy", "J", end.struck_energy, exact.struck_energy, Trend::exact},
            {"unexplained energy", "J", end.ledger, 0, Trend::exact}};
}

// ---- P15 ----------------------------------------------------------------------------------------

struct Symonds {
    double half_length = 1, mass_per_length = 2, plastic_moment = 100;
    Support ends = Support::pinned;

    /// p_c = 2 M_p/L², static collapse pressure of the pinned beam [N/m].
    [[nodiscard]] double collapse_pressure() const {
        return 2 * plastic_moment / (half_length * half_length);
    }
    [[nodiscard]] BeamParameters<double> beam(int segments_per_half) const {
        return {.length = 2 * half_length,
                .mass_per_length = mass_per_length,
                .plastic_moment = plastic_moment,
                .segments = 2 * segments_per_half,
                .left = ends,
                .right = ends};
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

/// Exact answers of the beam thrown with V0 = 4 m/s.
struct ThrowAnswer {
    int per_half;
    double pinned, pinned_stop, clamped, clamped_stop, half_energy; ///< [m], [s], [m], [s], [J]
};
inline constexpr ThrowAnswer thrown_beams[] = {
    {1, 0.12, 0.04, 0.06, 0.02, 12},
    {2, 0.120968738, 0.04105263, 0.0596883117, 0.02045455, 13.71429},
    {4, 0.116961146, 0.04108981, 0.0577600444, 0.02044003, 14.84536},
    {5, 0.115743969, 0.04102599, 0.057495075, 0.02045554, 15.07624},
    {10, 0.113346822, 0.04089982, 0.0563383146, 0.0203955, 15.53812}};

[[nodiscard]] inline std::vector<Quantity> p15_thrown(Support ends, const ThrowAnswer& exact,
                                                      double dt) {
    const BeamEnd end = throw_beam({.ends = ends}, exact.per_half, 4, dt);
    const bool pinned = ends == Support::pinned;
    return {
        {"centre", "m", end.deflection, pinned ? exact.pinned : exact.clamped, Trend::first_order},
        {"stop", "s", end.time, pinned ? exact.pinned_stop : exact.clamped_stop,
         Trend::first_order},
        {"unexplained energy", "J", end.ledger, 0, Trend::exact}};
}

/// Exact centre after 6 p_c for 4 ms.
struct PushAnswer {
    int per_half;
    double centre; ///< [m]
};
inline constexpr PushAnswer pushed_beams[] = {
    {1, 0.036}, {2, 0.0353828571}, {4, 0.0344912879}, {10, 0.0338332231}};

[[nodiscard]] inline std::vector<Quantity> p15_pushed(const PushAnswer& exact, double dt) {
    const BeamEnd end = push_beam({}, exact.per_half, 6, 0.004, dt);
    return {{"centre", "m", end.deflection, exact.centre, Trend::second_order},
            {"unexplained energy", "J", end.ledger, 0, Trend::exact}};
}

} // namespace ductile::reference
