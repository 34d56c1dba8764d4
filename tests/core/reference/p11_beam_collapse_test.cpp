// SPDX-License-Identifier: MIT
//
// P11. Limit loads of single-span beams cut into N rigid segments: still just below, moving just
// above. A closed energy ledger proves nothing here; only a converged solve keeps a beam of many
// hinges still.
//
// Closed forms: at joint z = x/L the yield conditions of the three beams under a load w per length
// give
//   pinned   w L²/M_p = 2/(z (1 - z))
//   propped  w L²/M_p = 2 (1 + z)/(z (1 - z)),   z from the pin
//   fixed    w L²/M_p = 4/(z (1 - z))
// and the least over the joints governs. Under a point load at a from the left, b from the right:
// P = M_p (1 + c_l b/L + c_r a/L) L/(a b), c = 1 at a clamped end, 0 at a pinned one.
//
// Source: Neal (1977), The Plastic Methods of Structural Analysis; loads of N segments derived
// here.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "reference/beam.hpp"

using namespace ductile;
using namespace ductile::reference;

namespace {

constexpr double L = 4, Mp = 50e3, mass = 400, dt = 1e-3;

struct Ends {
    const char* name;
    Support left, right;

    double clamped_left() const { return left == Support::clamped ? 1 : 0; }
    double clamped_right() const { return right == Support::clamped ? 1 : 0; }
};
constexpr Ends pinned{"pinned", Support::pinned, Support::pinned};
constexpr Ends propped{"propped", Support::pinned, Support::clamped};
constexpr Ends propped_left{"propped, clamped on the left", Support::clamped, Support::pinned};
constexpr Ends fixed_fixed{"fixed-fixed", Support::clamped, Support::clamped};

template <class S = double>
BeamParameters<S> beam(const Ends& ends, int segments) {
    return {.length = S(L),
            .mass_per_length = S(mass / L),
            .plastic_moment = S(Mp),
            .segments = segments,
            .left = ends.left,
            .right = ends.right};
}

/// w L²/M_p of N segments; clamped ends carry c z M_p and c (1 - z) M_p at z from the left.
double uniform_coefficient(const Ends& ends, int segments) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 1; i < segments; ++i) {
        const double z = double(i) / segments;
        const double moment = 1 + ends.clamped_left() * (1 - z) + ends.clamped_right() * z;
        least = std::min(least, 2 * moment / (z * (1 - z)));
    }
    return least;
}

double point_load(const Ends& ends, double a) {
    const double b = L - a;
    const double moment = 1 + ends.clamped_left() * b / L + ends.clamped_right() * a / L;
    return Mp * moment * L / (a * b);
}

/// Largest joint speed after `steps` steps from rest under this load [m/s].
template <class S, class Load>
S speed_after(const BeamParameters<S>& parameters, int steps, Load&& load) {
    Beam<S> beam(parameters);
    const Vector<S> forces = load(beam);
    for (int i = 0; i < steps; ++i) beam.world().step(S(dt), forces);
    S most = 0;
    for (int i = 0; i <= parameters.segments; ++i)
        most = std::max(most, std::abs(beam.velocity(i)));
    CHECK(double(beam.residual()) <= 1e-3);
    return most;
}

/// Still at 0.999 of `collapse` for 50 steps, moving at 1.001 at once. Below, all velocities are
/// round-off of what the load would give the beam in one step (times N⁴, the condition of a chain);
/// above, 0.1 % of the load moves the whole beam, 3/2 of that at the hinge.
template <class S = double, class Load>
void check_collapse(const BeamParameters<S>& parameters, double collapse, Load&& load) {
    const double kick = collapse * dt / mass;
    const double round_off = std::is_same_v<S, float> ? 3e-5 : 1e-10;
    const auto scaled = [&](double factor) {
        return [&load, factor](Beam<S>& beam) -> Vector<S> { return load(beam) * S(factor); };
    };
    CHECK(speed_after(parameters, 50, scaled(0.999)) < round_off * kick);
    CHECK(speed_after(parameters, 1, scaled(1.001)) > 5e-4 * kick);
}

} // namespace

TEST_CASE("P11 the formulas give the tabulated coefficients", "[reference][P11]") {
    CHECK(uniform_coefficient(propped, 5) == Approx(11.666667).epsilon(1e-7));
    CHECK(uniform_coefficient(propped, 8) == Approx(11.733333).epsilon(1e-7));
    CHECK(uniform_coefficient(propped, 12) == Approx(11.6571429).epsilon(1e-8));
    CHECK(uniform_coefficient(propped, 16) == Approx(11.6825397).epsilon(1e-8));
    CHECK(uniform_coefficient(propped, 40) == Approx(11.6624041).epsilon(1e-8));
    CHECK(uniform_coefficient(fixed_fixed, 5) == Approx(16.666667).epsilon(1e-7));
    CHECK(point_load(fixed_fixed, L / 4) == Approx(133333.33).epsilon(1e-7));
    CHECK(point_load(propped_left, L / 4) == Approx(116666.67).epsilon(1e-7));
    CHECK(point_load(propped, L / 4) == Approx(83333.333).epsilon(1e-7));
}

TEST_CASE("P11 a beam under a uniform load is still below its collapse load and moves above",
          "[reference][P11]") {
    for (const Ends& ends : {pinned, propped, propped_left, fixed_fixed}) {
        for (const int segments : {2, 4, 5, 8, 10, 12, 16, 40}) {
            INFO(ends.name << ", N = " << segments);
            const double w = uniform_coefficient(ends, segments) * Mp / (L * L);
            check_collapse(beam(ends, segments), w * L,
                           [&](Beam<double>& b) { return b.uniform_load(w); });
        }
    }
}

TEST_CASE("P11 a beam under a point load is still below its collapse load and moves above",
          "[reference][P11]") {
    for (const Ends& ends : {pinned, propped, propped_left, fixed_fixed}) {
        for (const int segments : {4, 8, 12, 16, 20}) {
            for (const double a : {L / 4, L / 2}) {
                INFO(ends.name << ", N = " << segments << ", load at " << a);
                const double load = point_load(ends, a);
                check_collapse(beam(ends, segments), load, [&](Beam<double>& b) {
                    Vector<double> forces = b.world().no_load();
                    b.add_force(forces, a, load);
                    return forces;
                });
            }
        }
    }
}

TEST_CASE("P11 the same holds in single precision", "[reference][P11]") {
    for (const Ends& ends : {pinned, propped, fixed_fixed}) {
        INFO(ends.name);
        const float w = float(uniform_coefficient(ends, 8) * Mp / (L * L));
        check_collapse(beam<float>(ends, 8), double(w) * L,
                       [&](Beam<float>& b) { return b.uniform_load(w); });
    }
}

TEST_CASE("P11 a fixed-fixed beam starts with the acceleration of its mechanism",
          "[reference][P11]") {
    // 1.1 of collapse, 400 kg: 3 (P - P_c)/m = 75 m/s² in the middle, also 3/2 (w - w_c) L/m
    for (int segments = 2; segments <= 16; segments += 2) {
        for (const bool uniform : {false, true}) {
            INFO("N = " << segments << (uniform ? ", uniform" : ", central"));
            Beam<double> b(beam(fixed_fixed, segments));
            Vector<double> load = b.world().no_load();
            if (uniform) {
                load = b.uniform_load(1.1 * 16 * Mp / (L * L));
            } else {
                b.add_force(load, L / 2, 1.1 * 8 * Mp / L);
            }
            b.world().step(dt, load);
            CHECK(b.velocity(segments / 2) / dt == Approx(75).epsilon(1e-9));
            CHECK(b.residual() < 1e-9);
        }
    }
}
