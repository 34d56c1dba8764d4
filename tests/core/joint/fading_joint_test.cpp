// SPDX-License-Identifier: MIT
//
// Joints whose strength fades to nothing, by their law or by a damage criterion: they break where it is
// nothing, took the area under it, and let the body go on. 10 N to 0.1 m, then linearly to 0 at 1 m: 5.5 J.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ductile/fracture/softening_damage.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/multilinear.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/law/softening.hpp"
#include "ductile/surface/ellipsoid.hpp"

using namespace ductile;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

const Softening<double> softening({.strength = 10, .plateau = 0.1, .exhaustion = 1});
const Perfect<double> perfect({.strength = 10});
const SofteningDamage<double> damage({.onset = 0.1, .failure = 1});

/// 1 kg in the plane, each row solved exactly. `off`: of the energy [J] and of the speed after the break.
template <class Law, class Criterion>
void passes(Law law, Criterion criterion, double k, double across, double dt, double off) {
    INFO("k = " << k << ", dt = 1/" << 1 / dt << ", across " << across);
    CoupledParameters<double, 2> parameters;
    parameters.stiffness.setConstant(k);
    CoupledJoint joint(Ellipsoid<double, 2>({.capacity = {10, 10}}), law, criterion, parameters);
    Eigen::Vector2d position(0, 0), velocity(5, across), force;
    double released = 0;
    for (int i = 0; i < int(0.8 / dt); ++i) {
        const auto rows = joint.prepare(
            {.position = position, .velocity = velocity, .mass = Eigen::Matrix2d::Identity()}, dt);
        for (int a = 0; a < 2; ++a) {
            const auto& row = rows[std::size_t(a)];
            const double wanted = (row.bias - velocity[a]) / (1 + row.compliance);
            const double impulse = std::clamp(wanted, row.lower * dt, row.upper * dt);
            velocity[a] += impulse;
            position[a] += velocity[a] * dt;
            force[a] = impulse / dt;
        }
        const auto step =
            joint.commit({.force = force, .velocity = velocity, .position = position}, dt);
        REQUIRE(velocity.allFinite());
        REQUIRE(std::isfinite(joint.state().plastic_work));
        released += step.release;
        velocity *= std::sqrt(1 + 2 * step.release / velocity.squaredNorm());
    }
    const double begun = (25 + across * across) / 2;
    CHECK(joint.state().broken);
    CHECK(joint.state().plastic_travel == Approx(1).epsilon(1e-9));
    CHECK(joint.state().plastic_work == Approx(5.5).margin(off));
    CHECK(velocity.norm() == Approx(std::sqrt(2 * (begun - 5.5))).margin(off));
    CHECK(joint.utilisation() == 0);
}

/// 2 kg at 10 m/s on one axis: energy that the break left it less than it had [J].
template <class Joint>
double taken_from(Joint& joint, double dt) {
    double position = 0, velocity = 10;
    while (!joint.state().broken) {
        const auto row = joint.prepare({position, velocity, 2}, dt);
        const double impulse =
            std::clamp(2 * (row.bias - velocity), row.lower * dt, row.upper * dt);
        velocity += impulse / 2;
        position += velocity * dt;
        const auto step = joint.commit({impulse / dt, velocity, position}, dt);
        velocity = std::sqrt(velocity * velocity + step.release);
    }
    return 100 - velocity * velocity;
}

} // namespace

TEST_CASE("a coupled joint that fades to nothing breaks there and lets go", "[coupled_joint][break]") {
    const double dt = GENERATE(1.0 / 30, 1.0 / 60, 1.0 / 1000);
    const double k = GENERATE(2e5, 2e7, double(infinity));
    if (dt < 1e-2 && k < 1e6) return; // neither resolved nor stiff: the row's own account is off
    const double across = GENERATE(0.0, 0.5);
    const double order = 60 * dt, elastic = k < infinity ? 1e-4 : 0;
    passes(softening, TravelLimit<double>(), k, across, dt, 1e-3 * std::pow(order, 3) + elastic);
    passes(perfect, damage, k, across, dt, 5e-3 * order * order + elastic);
}

TEST_CASE("a coupled joint whose law ends names it", "[coupled_joint][break]") {
    CoupledJoint joint(Ellipsoid<double, 2>({.capacity = {10, 10}}), softening);
    Eigen::Vector2d position(0, 0), velocity(5, 0);
    for (int i = 0; i < 100 && !joint.state().broken; ++i) {
        const auto rows = joint.prepare({.position = position, .velocity = velocity}, 1e-2);
        const Eigen::Vector2d force(rows[0].lower, 0);
        position += velocity * 1e-2;
        joint.commit({.force = force, .velocity = velocity, .position = position}, 1e-2);
    }
    REQUIRE(joint.fracture());
    CHECK(joint.fracture()->criterion == CriterionKind::exhausted_strength);
}

TEST_CASE("what a fading joint books is what it took from the rotor", "[one_axis_joint][break]") {
    // 40 N m to 1 rad, then linearly to 0 at 2 rad: 60 J. Never more than was taken; less to third order
    const double rate = GENERATE(15.0, 60.0, 83.0, 240.0, 1000.0);
    const double third = std::pow(60 / rate, 3);
    INFO("dt = 1/" << rate);
    OneAxisJoint law(Softening<double>({.strength = 40, .plateau = 1, .exhaustion = 2}));
    const double by_law = taken_from(law, 1 / rate);
    CHECK(law.state().plastic_work == Approx(60).epsilon(1e-9));
    CHECK(by_law >= 60 - 1e-9);
    CHECK(by_law <= 60 + 8e-3 * third);

    const std::array<StrengthPoint<double>, 3> points{{{0, 40}, {1, 40}, {2, 0}}};
    OneAxisJoint pairs{Multilinear<double>(points)};
    CHECK(taken_from(pairs, 1 / rate) == Approx(by_law).epsilon(1e-9));

    OneAxisJoint weakened(Perfect<double>({.strength = 40}),
                          SofteningDamage<double>({.onset = 1, .failure = 2}));
    const double by_damage = taken_from(weakened, 1 / rate);
    CHECK(weakened.state().plastic_work == Approx(by_damage).epsilon(1e-9));
    CHECK(by_damage == Approx(60).margin(0.05 * (60 / rate) * (60 / rate)));
}
