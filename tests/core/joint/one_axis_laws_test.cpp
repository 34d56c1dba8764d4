// SPDX-License-Identifier: MIT
//
// The one-axis joint with every kind of law, elastic part and fracture criterion, on a single mass whose
// row is solved exactly.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ductile/fracture/any_of.hpp"
#include "ductile/fracture/brittle_force.hpp"
#include "ductile/fracture/coffin_manson.hpp"
#include "ductile/fracture/energy_limit.hpp"
#include "ductile/fracture/hinge_strain.hpp"
#include "ductile/fracture/low_cycle_fatigue.hpp"
#include "ductile/fracture/softening_damage.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/multilinear.hpp"
#include "ductile/law/softening.hpp"
#include "ductile/law/voce.hpp"

using namespace ductile;

namespace {

/// A mass on one row, stepped by symplectic Euler.
template <class Joint>
struct Mass {
    using S = typename Joint::Scalar;

    Mass(Joint j, S m) : joint(std::move(j)), mass(m) {}

    Step<S> step(S dt, S load = 0) {
        const S start = velocity;
        const RowLimits<S> row = joint.prepare({position, velocity, mass}, dt);
        const S free = velocity + dt * load / mass;
        const S wanted = (row.bias - free) / (1 / mass + row.compliance);
        const S impulse = std::clamp(wanted, row.lower * dt, row.upper * dt);
        velocity = free + impulse / mass;
        position += velocity * dt;
        taken += -impulse * (start + velocity) / 2;
        const Step<S> step = joint.commit({impulse / dt, velocity, position}, dt);
        velocity = std::copysign(std::sqrt(velocity * velocity + 2 * step.release / mass), velocity);
        taken -= step.release;
        return step;
    }

    Joint joint;
    S mass;
    S position = 0;
    S velocity = 0;
    S taken = 0;
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Random persistent load, for as many steps; checks the account and the arrow of time.
template <class Joint>
void shake(Joint joint, double dt, const std::string& what) {
    INFO(what << ", dt = " << dt);
    Mass body(std::move(joint), 2.0);
    unsigned seed = 3;
    double load = 0, work = 0;
    bool broken = false;
    for (int i = 0; i < 20000; ++i) {
        seed = seed * 1664525u + 1013904223u;
        load += 0.05 * (600 * (double(seed >> 8) / double(1u << 24) - 0.5) - load);
        body.step(dt, load - 0.5 * body.velocity);
        const auto& s = body.joint.state();
        REQUIRE(std::isfinite(body.velocity));
        REQUIRE(s.plastic_work >= work);
        REQUIRE((!broken || s.broken));
        work = s.plastic_work;
        broken = s.broken;
        const double named = s.plastic_work + s.stored + s.other_work + s.lost;
        REQUIRE(body.taken == Approx(named).epsilon(1e-8).margin(1e-8));
    }
    CHECK(work > 0);
}

OneAxisParameters<double> elastic(double stiffness) { return {.stiffness = stiffness}; }

} // namespace

TEST_CASE("the account of a joint closes for every law, elastic part, criterion and step",
          "[one_axis_joint]") {
    const double dt = GENERATE(1e-4, 3e-3, 2e-2);
    const double k = GENERATE(1e5, 2e3, double(infinity)); // values, no names: Catch2 keeps references
    const TravelLimit<double> never;
    const EnergyLimit<double> energy({.limit = 60});
    shake(OneAxisJoint(Perfect<double>({.strength = 20}), never, elastic(k)), dt, "perfect");
    shake(OneAxisJoint(Linear<double>({.strength = 20, .hardening = 5}), energy, elastic(k)), dt,
          "linear, energy limit");
    shake(OneAxisJoint(Voce<double>({.strength = 20, .saturation = 10, .rate = 2}), never, elastic(k)),
          dt, "Voce");
    shake(OneAxisJoint(KinematicHardening<double>(Perfect<double>({.strength = 20}),
                                                  Prager<double>({.modulus = 8})),
                       never, elastic(k)),
          dt, "kinematic");
    shake(OneAxisJoint(Perfect<double>({.strength = 20}),
                       SofteningDamage<double>({.onset = 1, .failure = 6}), elastic(k)),
          dt, "softening damage");
}

TEST_CASE("a joint that softens to nothing has dissipated the area under its law",
          "[one_axis_joint]") {
    for (const double dt : {1e-3, 1e-2, 0.1}) {
        Mass body(OneAxisJoint(Softening<double>({.strength = 20, .plateau = 0.5, .exhaustion = 2})), 2.0);
        body.velocity = 10;
        for (int i = 0; i < 5000 && !body.joint.state().broken; ++i) body.step(dt);
        INFO("dt = " << dt);
        CHECK(body.joint.state().broken);
        CHECK(body.joint.state().plastic_work == Approx(20 * 0.5 + 20 * 1.5 / 2).epsilon(1e-9));
        const double residual = std::sqrt(100 - 2 * 25 / 2.0);
        // third order per step: the midpoint strength against the integral
        CHECK(body.velocity == Approx(residual).epsilon(dt < 0.05 ? 2e-3 : 2e-2));
    }
}

TEST_CASE("a brittle joint breaks at its force and absorbs nothing", "[one_axis_joint]") {
    const BrittleForce<double> cap({.limit = 15});
    SECTION("rigid: the blow goes through as if nothing had been there") {
        for (const double dt : {1e-3, 1e-2, 0.1}) {
            Mass body(OneAxisJoint(Perfect<double>({.strength = 20}), cap), 2.0);
            body.velocity = 10;
            const Step<double> step = body.step(dt);
            CHECK(step.outcome == Outcome::broken);
            CHECK(body.velocity == Approx(10).epsilon(1e-12));
            CHECK(body.joint.state().plastic_work == 0);
            CHECK(body.joint.governing() == CriterionKind::brittle_force);
        }
    }
    SECTION("elastic: the energy stored until then is lost inside the part") {
        Mass body(OneAxisJoint(Perfect<double>({.strength = 20}), cap, elastic(500)), 2.0);
        body.velocity = 3;
        for (int i = 0; i < 10000 && !body.joint.state().broken; ++i) body.step(1e-4);
        CHECK(body.joint.state().broken);
        CHECK(body.joint.state().lost == Approx(15.0 * 15 / 1000).epsilon(0.01));
        CHECK(body.velocity == Approx(std::sqrt(9 - 15.0 * 15 / 1000)).epsilon(0.01));
        CHECK(body.joint.state().plastic_work == 0);
    }
    SECTION("a load below it is held") {
        Mass body(OneAxisJoint(Perfect<double>({.strength = 20}), cap), 2.0);
        for (int i = 0; i < 1000; ++i) body.step(0.01, 14.9);
        CHECK_FALSE(body.joint.state().broken);
        CHECK(std::abs(body.position) < 1e-12);
    }
}

TEST_CASE("a paperclip bent over and over breaks after its Coffin-Manson life", "[one_axis_joint]") {
    // eps_f' = 1, c = -0.6; 1 mm wire, 3 mm hinge, ±90 degrees: strain amplitude 0.2618, N_f = 4.667
    const auto life = CoffinManson<double>({.ductility_coefficient = 1, .ductility_exponent = -0.6});
    const LowCycleFatigue fatigue(life, {.strain_per_travel = 0.0005 / 0.003});
    OneAxisJoint joint(Perfect<double>({.strength = 0.05}), fatigue);
    const double quarter = 1.5707963267948966, dt = 0.01, rate = 2.0;
    double position = 0, direction = 1, travelled = 0;
    while (!joint.state().broken && travelled < 100) {
        (void)joint.prepare({position, direction * rate}, dt);
        double advance = rate * dt;
        position += direction * advance;
        travelled += advance;
        joint.commit({-direction * 0.05, direction * rate, position}, dt);
        if (direction * position >= quarter) direction = -direction;
    }
    CHECK(joint.governing() == CriterionKind::low_cycle_fatigue);
    // a cycle is 4 quarters; the start is a half cycle of half the range, the steps overshoot a little
    CHECK(travelled / (4 * quarter) == Approx(4.667).epsilon(0.1));
}

TEST_CASE("the first of several criteria breaks the joint and is named", "[one_axis_joint]") {
    const AnyOf any(TravelLimit<double>({.limit = 2}), EnergyLimit<double>({.limit = 12}));
    Mass body(OneAxisJoint(Perfect<double>({.strength = 20}), any), 2.0);
    body.velocity = 10;
    for (int i = 0; i < 1000 && !body.joint.state().broken; ++i) body.step(0.01);
    CHECK(body.joint.state().plastic_work == Approx(12).epsilon(1e-9));
    CHECK(body.joint.governing() == CriterionKind::absorbed_energy);
    CHECK(body.joint.damage() == 1);
}

TEST_CASE("from resolved to unresolvable steps the answer makes no jump", "[one_axis_joint]") {
    // the peak of an elastic-plastic swing over the step, around a = k dt²/m = 1/4 and 4
    const auto peak = [](double dt) {
        Mass body(OneAxisJoint(Perfect<double>({.strength = 10}), TravelLimit<double>(), elastic(200)),
                  0.5);
        body.velocity = 3;
        double highest = 0;
        for (int i = 0; i < int(0.4 / dt); ++i) {
            body.step(dt);
            highest = std::max(highest, body.position);
        }
        return highest;
    };
    for (const double a : {0.25, 4.0}) {
        const double dt = std::sqrt(a * 0.5 / 200);
        CHECK(peak(dt * (1 - 1e-4)) == Approx(peak(dt * (1 + 1e-4))).epsilon(1e-2));
    }
}
