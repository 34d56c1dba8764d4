// SPDX-License-Identifier: MIT
//
// What a coupled joint's step rests on, each against a closed form or the one-axis joint: strength
// over the travel, bounds lowered before a break, a cap that is met first, when it
// broke.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "ductile/fracture/any_of.hpp"
#include "ductile/fracture/brittle_force.hpp"
#include "ductile/fracture/softening_damage.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "reference/pair_world.hpp"

using namespace ductile;

namespace {

using V2 = Eigen::Matrix<double, 2, 1>;
using Ellipse = Ellipsoid<double, 2>;

double solve(const RowLimits<double>& row, double mass, double free, double dt) {
    const double wanted = (row.bias - free) / (1 / mass + row.compliance);
    return std::clamp(wanted, row.lower * dt, row.upper * dt);
}

/// Two decoupled axes of mass 2.
template <class Joint>
struct Plate {
    typename Joint::Step step(double dt, const V2& load = V2::Zero()) {
        const auto rows =
            joint.prepare({position, velocity, mass * Eigen::Matrix2d::Identity()}, dt);
        V2 force;
        for (int i = 0; i < 2; ++i) {
            const double free = velocity[i] + dt * load[i] / mass;
            const double impulse = solve(rows[std::size_t(i)], mass, free, dt);
            velocity[i] = free + impulse / mass;
            force[i] = impulse / dt;
        }
        position += velocity * dt;
        return joint.commit({force, velocity, position}, dt);
    }
    typename Joint::Step run_to_break(double dt) {
        typename Joint::Step last;
        for (int i = 0; i < 100'000 && !joint.state().broken; ++i) last = step(dt);
        REQUIRE(joint.fracture());
        return last;
    }

    Joint joint;
    V2 velocity;
    V2 position = V2::Zero();
    double mass = 2;
};
template <class Joint>
Plate(Joint, V2) -> Plate<Joint>;

} // namespace

TEST_CASE("a coupled joint that hardens stops where its law has taken all", "[coupled_joint]") {
    // R₀ p + H p²/2 = E
    const double travel = (-40 + std::sqrt(1600 + 2 * 300 * 100.0)) / 300;
    for (const double dt : {1.0 / 60, 1.0 / 240}) {
        Plate plate{CoupledJoint(Ellipse({.capacity = V2(40, 40)}),
                                 Linear<double>({.strength = 40, .hardening = 300})),
                    V2(8, 6)};
        for (double t = 0; t < 1; t += dt) plate.step(dt);
        CHECK(plate.joint.state().plastic_travel == Approx(travel).epsilon(1e-8));
    }
}

TEST_CASE("a coupled joint flows as far as its work says, whatever strength was foretold",
          "[coupled_joint]") {
    // R = 40 + 400 p, less 20 p of it by damage; a load speeds up what was foretold to slow down
    const Linear<double> law({.strength = 40, .hardening = 400});
    const SofteningDamage<double> fades({.onset = 0, .failure = 0.05});
    const auto area = [](double p) { return 40 * p - 400 * p * p / 2 - 8000 * p * p * p / 3; };
    for (const double dt : {2e-3, 1e-3, 1e-4}) {
        INFO("dt = " << dt);
        Plate plate{CoupledJoint(Ellipse({.capacity = V2(40, 40)}), law, fades), V2(0.6, 0.8)};
        for (int i = 0; i < 100'000 && !plate.joint.state().broken; ++i) {
            plate.step(dt, V2(60, 80));
            const auto& state = plate.joint.state();
            CHECK(state.plastic_work == Approx(area(state.plastic_travel)).epsilon(1e-8));
        }
        CHECK(plate.joint.state().broken);
        CHECK(plate.joint.state().plastic_travel == Approx(0.05).epsilon(1e-8));
    }
}

TEST_CASE("a coupled joint that carries less than can be solved for ends where its bodies pass",
          "[coupled_joint]") {
    const SofteningDamage<double> fades({.onset = 0, .failure = 0.1});
    CoupledJoint joint(Ellipse({.capacity = V2(40, 40)}), Perfect<double>({.strength = 40}), fades);
    auto state = joint.state();
    state.plastic_travel = state.criterion.travel = 0.1 - 1e-9;
    for (const double speed : {10.0, 0.0}) {
        joint.restore(state);
        const V2 velocity = speed * V2(0.6, 0.8);
        (void)joint.prepare({.position = V2::Zero(),
                             .velocity = velocity,
                             .mass = Eigen::Matrix2d::Identity(),
                             .ahead = true},
                            0.01);
        REQUIRE(joint.meet_surface(0.01, true));
        joint.commit({.velocity = velocity, .position = 0.01 * velocity, .on_surface = true}, 0.01);
        CHECK(joint.state().broken == (speed > 0));
    }
}

TEST_CASE("bounds lowered before a coupled break leave little to hand back", "[coupled_joint]") {
    // a step of the full strength takes up to 40 N · 10 m/s · dt, of which the travel left is a
    // part
    for (const double dt : {1.0 / 15, 1.0 / 60, 1.0 / 1000}) {
        Plate plate{
            CoupledJoint(Ellipse({.capacity = V2(40, 40)}), Perfect<double>({.strength = 40}),
                         TravelLimit<double>({.limit = 1.1})),
            V2(8, 6)};
        const auto last = plate.run_to_break(dt);
        INFO("dt = " << dt << ", to be handed back " << last.release << " J");
        CHECK(last.release < 0.01 * 40 * 10 * dt);
        CHECK(plate.velocity.squaredNorm() == Approx(100 - 44 - last.release).epsilon(1e-9));
    }
}

TEST_CASE("a cap that is met before the travel is used up bounds the force as it is",
          "[coupled_joint]") {
    // brittle at half the strength, with hardly any travel left: bounds at the cap, not at a share
    Plate plate{CoupledJoint(Ellipse({.capacity = V2(40, 40)}), Perfect<double>({.strength = 40}),
                             AnyOf(BrittleForce<double>({.limit = 20}),
                                   TravelLimit<double>({.limit = 0.03}))),
                V2(6, 8)};
    const auto rows =
        plate.joint.prepare({V2::Zero(), V2(6, 8), 2 * Eigen::Matrix2d::Identity()}, 0.01);
    CHECK(V2(rows[0].lower, rows[1].lower).norm() == Approx(20).epsilon(1e-9));
    plate.run_to_break(0.01);
    CHECK(plate.joint.fracture()->criterion == CriterionKind::brittle_force);
    CHECK(plate.joint.fracture()->absorbed_energy == 0);
}

TEST_CASE("a coupled joint of which one axis moves breaks when the one-axis joint does",
          "[coupled_joint]") {
    for (const double dt : {1.0 / 60, 1.0 / 240, 1e-3}) {
        INFO("dt = " << dt);
        const Perfect<double> forty({.strength = 40});
        const TravelLimit<double> limit({.limit = 0.03});
        Plate plate{CoupledJoint(Ellipse({.capacity = V2(40, 40)}), forty, limit), V2(8, 0)};
        plate.run_to_break(dt);
        OneAxisJoint one(forty, limit);
        double velocity = 8, position = 0;
        for (int i = 0; i < 1000 && !one.state().broken; ++i) {
            const double impulse = solve(one.prepare({position, velocity, 2}, dt), 2, velocity, dt);
            velocity += impulse / 2;
            position += velocity * dt;
            one.commit({impulse / dt, velocity, position}, dt);
        }
        REQUIRE(one.fracture());
        CHECK(plate.joint.fracture()->time == Approx(one.fracture()->time).epsilon(1e-9));
    }
}

TEST_CASE("the spring of a joint whose criterion fades holds what is left of the strength",
          "[joint]") {
    // driven at a given speed: f = R (1 - p/p_failure), and the spring holds f²/(2 k)
    for (const double stiffness : {400.0, 4e4, 4e6}) {
        const double failure = 0.5, speed = 0.2, dt = 1e-3, heavy = 1e7;
        OneAxisJoint joint(Perfect<double>({.strength = 40}),
                           SofteningDamage<double>({.onset = 0, .failure = failure}),
                           {.stiffness = stiffness});
        double position = 0, force = 0;
        while (joint.state().plastic_travel < failure / 2) {
            const double impulse =
                solve(joint.prepare({position, speed, heavy}, dt), heavy, speed, dt);
            position += speed * dt;
            force = impulse / dt;
            REQUIRE(joint.commit({force, speed, position}, dt).outcome != Outcome::unreliable);
        }
        INFO("stiffness " << stiffness);
        CHECK(-force == Approx(20).epsilon(1e-2));
        CHECK(joint.state().stored == Approx(force * force / (2 * stiffness)).epsilon(1e-2));
    }
}

TEST_CASE("a link that the engine left out of a step knows of no motion before it",
          "[joint][link]") {
    using Hinge = OneAxisJoint<Perfect<double>>;
    Link<Hinge> link(Hinge(Perfect<double>({.strength = 40})), {JointAxis::torsion}, {}, {});
    BodyState<double> wheel, ground;
    wheel.inverse_mass = 1;
    wheel.inverse_inertia.setIdentity();
    wheel.spin = {0, 0, 3};
    link.start(wheel, ground);
    link.prepare(wheel, ground, 0.01, 20);
    wheel.spin.z() -= 0.4;
    Vector6<double> forces = Vector6<double>::Zero();
    forces[5] = -40;
    link.commit_rows(wheel, ground, forces, 0.01);
    REQUIRE(link.joint().state().velocity == Approx(2.6));
    REQUIRE(link.joint().state().flowing);
    const double work = link.totals().plastic_work;
    link.pause();
    CHECK(link.joint().state().velocity == 0);
    CHECK(link.joint().state().start_velocity == 0);
    CHECK_FALSE(link.joint().state().flowing);
    CHECK(link.last().plastic_work == 0);
    CHECK(link.totals().plastic_work == work);
}

TEST_CASE("a spring met on its surface breaks with the work of its largest travel at any step",
          "[coupled][break]") {
    // 320 kg m² from 8 rad/s, M_p = 19.64 kN m, resolved springs: 0.3 rad are 5892 J
    using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
    using V6 = Six::Vector;
    constexpr double strength = 19'640, largest = 0.3, inertia = 320, speed = 8;
    constexpr double stiffness = 2.5e6; // yields at 7.9 mrad, which is 1 to 8 of these steps
    CoupledParameters<double, 6> parameters;
    parameters.stiffness = V6::Constant(stiffness);
    parameters.largest_travel[3] = largest;
    for (const double dt : {4e-3, 2e-3, 1.3e-3, 1.2e-3, 1.1e-3, 1e-3, 9e-4, 5e-4, 2e-4}) {
        BodyState<double> rotor{.inverse_mass = 1.0 / 60,
                                .inverse_inertia = Matrix3<double>::Identity() / inertia};
        rotor.spin = {speed, 0, 0};
        reference::PairWorld world(
            rotor, BodyState<double>{},
            Link(Six(Ellipsoid<double, 6>({.capacity = V6::Constant(strength)}),
                     Perfect<double>({.strength = 1}), TravelLimit<double>(), parameters),
                 all_joint_axes, JointFrame<double>{}, JointFrame<double>{}));
        world.meet_surfaces();
        for (int i = 0; i * dt < 0.1; ++i) world.step(dt);
        INFO("dt " << dt);
        const auto& state = world.link().joint().state();
        CHECK(state.broken);
        CHECK(state.plastic_work == Approx(strength * largest).epsilon(3e-4));
    }
}

TEST_CASE("a rigid joint of a known section stands at its strength: what strains it is no flow",
          "[coupled_joint]") {
    constexpr double strength = 100, k = 1e6, h = 1e-3;
    const bool on_surface = GENERATE(false, true);
    CAPTURE(on_surface);
    CoupledJoint joint(Ellipse({.capacity = V2(strength, strength)}),
                       Perfect<double>({.strength = strength}), TravelLimit<double>(),
                       {.section_stiffness = V2::Constant(k)});
    double position = 0, speed = 0;
    // what a solver leaves of the row, which carries the strength
    const auto row = [&](double dt) {
        auto rows =
            joint.prepare({V2(position, 0), V2(speed, 0), 2 * Eigen::Matrix2d::Identity()}, dt);
        if (on_surface) rows = *joint.meet_surface(dt);
        return rows[0];
    };
    const auto commit = [&](double dt) {
        position += speed * dt;
        return joint.commit({V2(-strength, 0), V2(speed, 0), V2(position, 0), on_surface}, dt);
    };
    for (const double dt : {h, 10 * h, h / 20}) { // other steps hold the same
        for (int i = 0; i < 2000; ++i) {
            const RowLimits<double> limits = row(dt);
            REQUIRE(limits.softness > 0);
            speed = limits.bias + limits.softness * strength * dt;
            REQUIRE(commit(dt).outcome == Outcome::elastic);
        }
        CAPTURE(dt);
        CHECK(joint.state().plastic_work == 0);
        CHECK_FALSE(joint.state().flowing);
        CHECK(std::abs(speed) < 1e-3 * strength / k);
        CHECK(position == Approx(strength / (rigid_stiffness<double> * k)).epsilon(1e-3));
    }
    // then it flows, by all that it moves
    const double stood = position;
    for (const double u : {0.2, 0.4, 0.4}) {
        row(h);
        speed = u;
        CHECK(commit(h).outcome == Outcome::yielding);
    }
    const double travel = position - stood - 0.2 * h; // of the mean velocities
    CHECK(joint.state().plastic_work == Approx(strength * travel).epsilon(1e-9));
    CHECK(joint.state().plastic_offset[0] == Approx(position - stood).epsilon(1e-9));
}
