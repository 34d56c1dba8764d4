// SPDX-License-Identifier: MIT
//
// The joint of six axes: what holds for every engine, with the rig's verbs (RIG_HEADER).
#include RIG_HEADER

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "adapters/features.hpp"
#include "adapters/six_axis.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("a rotor stops on a joint of six axes as on a hinge, about any axis", "[six]") {
    // P01: I = 2 kg m², M_p = 40 N m; 10 rad/s and 30 rad/s (many turns)
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const JointAxis about =
        GENERATE(JointAxis::bending_x, JointAxis::bending_y, JointAxis::torsion);
    const V3 z = GENERATE(V3(0, 0, 1), V3(1.0 / 3, 2.0 / 3, 2.0 / 3));
    const double spin = GENERATE(10.0, 30.0);
    const bool coupled = GENERATE(false, true);
    const double dt = 1.0 / 240;
    INFO(solver << ", " << to_string(about) << ", spin " << spin << ", coupled " << coupled);
    Shown shown(solver, "six axes: P01");
    const Frame frame{none, along(z)};
    Rig rig(solver, none);
    auto rotor =
        rig.body(1, sphere(2), none, none, spin * frame.axes.col(Eigen::Index(index(about) % 3)));
    rig.open_ledger();
    const auto stops = [&](auto& joint) {
        for (double t = 0; t < spin / 20 + 2 * dt; t += dt) rig.step(dt);
        shown.close(joint.position(about), discrete_travel(spin, 20, dt));
        shown.close(joint.absorbed_energy(), spin * spin);
        shown.close(Rig::spin(rotor).norm(), 0);
        CHECK(std::abs(rig.ledger().unexplained()) < exact * spin * spin);
        CHECK(joint.residual_max() < 1e-3);
        CHECK(joint.rigid_residual() < 1e-3);
    };
    if (coupled) {
        V6 capacity = capacities();
        capacity[Eigen::Index(index(about))] = 40;
        stops(rig.six_axis(rotor, nullptr, frame, six(capacity)));
    } else {
        stops(rig.six_axis(rotor, nullptr, frame, one(40), One{about}));
    }
}

TEST_CASE("a joint of six axes breaks with the right residual speed at every step", "[six]") {
    // P02
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double rate = GENERATE(15.0, 60.0, 240.0, 1000.0);
    INFO(solver << ", dt = 1/" << rate);
    Shown shown(solver, "six axes: P02");
    SECTION("one axis, 1.6 rad: 6 rad/s are left") {
        Rig rig(solver, none);
        auto rotor = rig.body(1, sphere(2), none, none, {0, 0, 10});
        auto& joint = rig.six_axis(rotor, nullptr, Frame{}, one(40, 1.6), One{JointAxis::torsion});
        rig.open_ledger();
        for (int i = 0; i < 2000 && !joint.broken(); ++i) rig.step(1 / rate);
        CHECK(joint.outcome() == Outcome::broken);
        shown.close(joint.absorbed_energy(), 64);
        shown.close(Rig::spin(rotor).z(), 6);
        CHECK(std::abs(rig.ledger().unexplained()) < exact * 100);
        for (int i = 0; i < 5; ++i) rig.step(1 / rate);
        shown.close(Rig::spin(rotor).z(), 6);
        CHECK(joint.broken());
        CHECK(joint.force(JointAxis::torsion) == 0);
        CHECK(std::abs(rig.ledger().unexplained()) < exact * 100);
    }
    SECTION("two bodies: 7.6 and 1.6 rad/s are left") {
        Rig rig(solver, none);
        auto a = rig.body(1, sphere(2), none, none, {0, 0, 10});
        auto b = rig.body(1, sphere(3), none, none, none);
        auto& joint = rig.six_axis(a, b, Frame{}, one(12, 3.2), One{JointAxis::torsion});
        for (int i = 0; i < 2000 && !joint.broken(); ++i) rig.step(1 / rate);
        shown.close(Rig::spin(a).z(), 7.6);
        shown.close(Rig::spin(b).z(), 1.6);
        shown.close(joint.absorbed_energy(), 38.4);
    }
    SECTION("six coupled axes") {
        Rig rig(solver, none);
        auto rotor = rig.body(1, sphere(2), none, none, {0, 0, 10});
        V6 capacity = capacities();
        capacity[5] = 40;
        // the law's strength is 1: travel is work in J
        auto& joint = rig.six_axis(rotor, nullptr, Frame{}, six(capacity, 64.0));
        rig.open_ledger();
        for (int i = 0; i < 2000 && !joint.broken(); ++i) rig.step(1 / rate);
        shown.close(joint.absorbed_energy(), 64);
        shown.close(Rig::spin(rotor).z(), 6);
        CHECK(std::abs(rig.ledger().unexplained()) < exact * 100);
    }
}

TEST_CASE("a block on an axial row follows the seed's table, also joined off its centre", "[six]") {
    // P22: 6000 kg, 80 kN, g = 10, dt = 1/60; the row acts from step 2 on
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const V3 at = GENERATE(V3(0, 0, 0), V3(0.5, 0.7, -0.3));
    INFO(solver << ", joined at " << at.transpose());
    Shown shown(solver, "six axes: P22");
    const double dt = 1.0 / 60;
    // rows of a point beside the centre feel each other: an iterative solver solves them in part
    const double tolerance = !Rig::can(solver, Capability::coupled) && !at.isZero() ? 2e-2 : exact;
    Rig rig(solver, {0, -10, 0});
    auto block = rig.body(6000, sphere(1000), none, none, none);
    rig.step(dt);
    auto& bar =
        rig.six_axis(block, nullptr, Frame{at, along({0, 1, 0})}, one(80e3), One{JointAxis::axial});
    const double start = Rig::position(block).y();
    const double y[] = {-1.0 / 216, -1.0 / 180, -1.0 / 180, -1.0 / 180};
    const double v[] = {-1.0 / 9, -1.0 / 18, 0, 0};
    const double impulse[] = {4000.0 / 3, 4000.0 / 3, 4000.0 / 3, 1000};
    for (int i = 0; i < 4; ++i) {
        rig.step(dt);
        INFO("step " << i + 2);
        shown.close(Rig::position(block).y(), y[i], tolerance);
        shown.close(Rig::velocity(block).y(), v[i], tolerance);
        CHECK(bar.force(JointAxis::axial) * dt == Approx(impulse[i]).epsilon(tolerance));
    }
    shown.close(bar.position(JointAxis::axial), Rig::position(block).y() - start, tolerance);
    shown.close(bar.plastic_travel(), 1.0 / 240,
                tolerance); // work-conjugate: the continuous problem's
}

TEST_CASE("a mass crushes and breaks an axial row", "[six]") {
    // P25 from the common speed on
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Shown shown(solver, "six axes: P25");
    const double g = 9.81, v1 = 5.69471264, deceleration = 44.7354545;
    SECTION("crush") {
        const double dt = 1.0 / 240;
        Rig rig(solver, {0, -g, 0});
        auto both = rig.body(550, sphere(50), none, {0, -v1, 0}, none);
        auto& column = rig.six_axis(both, nullptr, Frame{none, along({0, 1, 0})}, one(30e3),
                                    One{JointAxis::axial});
        for (int i = 0; i < 60; ++i) rig.step(dt);
        shown.close(-column.position(JointAxis::axial), discrete_travel(v1, deceleration, dt));
        CHECK(column.absorbed_energy() ==
              Approx(10873.8424).epsilon(2 * std::pow(deceleration * dt / v1, 2)));
    }
    SECTION("break at 0.3 m") {
        const double dt = GENERATE(1.0 / 60, 1.0 / 240, 1.0 / 1000);
        Rig rig(solver, {0, -g, 0});
        auto both = rig.body(550, sphere(50), none, {0, -v1, 0}, none);
        auto& column = rig.six_axis(both, nullptr, Frame{none, along({0, 1, 0})}, one(30e3, 0.3),
                                    One{JointAxis::axial});
        for (int i = 0; i < 1000 && !column.broken(); ++i) rig.step(dt);
        CHECK(column.broken());
        shown.close(column.absorbed_energy(), 9000);
        CHECK(-Rig::velocity(both).y() == Approx(2.36399648).margin(1.01 * g * dt));
    }
}

TEST_CASE("reactions of a loaded cantilever are those of statics", "[six]") {
    // 2 kg at 0.8 m from the wall along x, own weight, a sideways force and a torque
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const bool coupled = GENERATE(false, true);
    const bool elastic = GENERATE(false, true);
    if (!coupled && elastic) return;
    INFO(solver << ", coupled " << coupled << ", elastic " << elastic);
    Shown shown(solver, "reactions: cantilever");
    const double arm = 0.8;
    const V3 load(3, 15, -2 * 9.81), torque(1, -2, 3);
    const Frame frame{none, along({1, 0, 0})};
    Rig rig(solver, {0, 0, -9.81});
    rig.set_iterations(100); // of iterative solvers: the rows of the lever feel each other
    auto beam = rig.body(2, sphere(0.3), {arm, 0, 0}, none, none);
    const auto check = [&](auto& joint, int steps, double tolerance) {
        for (int i = 0; i < steps; ++i) {
            Rig::apply_force(beam, load - V3(0, 0, -2 * 9.81));
            Rig::apply_torque(beam, torque);
            rig.step(1.0 / 60);
        }
        V3 force, moment;
        for (int i = 0; i < 3; ++i) {
            force[i] = joint.force(all_joint_axes[std::size_t(i)]);
            moment[i] = joint.force(all_joint_axes[std::size_t(3 + i)]);
        }
        const V3 expected = -frame.axes.transpose() * load;
        const V3 about = -frame.axes.transpose() * (V3(arm, 0, 0).cross(load) + torque);
        UNSCOPED_INFO("off by " << (force - expected).norm() / load.norm() << ", "
                                << (moment - about).norm() / about.norm());
        shown.small((force - expected).norm() / load.norm(), tolerance);
        shown.small((moment - about).norm() / about.norm(), tolerance);
        CHECK(joint.absorbed_energy() == 0);
        CHECK(joint.outcome() == Outcome::elastic);
    };
    const double tolerance = Rig::can(solver, Capability::coupled) ? exact : std::max(exact, 1e-4);
    if (!coupled) {
        check(rig.six_axis(beam, nullptr, frame, one(1e4), One{JointAxis::bending_x}), 300,
              tolerance);
    } else if (!elastic) {
        check(rig.six_axis(beam, nullptr, frame, six(V6::Constant(1e4))), 300, tolerance);
    } else {
        // stiff enough that the lever does not change, and every row implicit, hence damped
        check(
            rig.six_axis(beam, nullptr, frame, six(V6::Constant(1e4), infinity, V6::Constant(1e9))),
            600, std::max(tolerance, 1e-7));
    }
}
