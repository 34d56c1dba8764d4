// SPDX-License-Identifier: MIT
//
// The contract of an adapter, continued: reactions in the joint's frame, and what must make no
// difference, a run that is saved and restored and the order of the two bodies. Compiled for every
// engine and precision (RIG_HEADER), run with every solver.
#include RIG_HEADER

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <utility>
#include <vector>

#include "adapters/features.hpp"
#include "adapters/six_axis.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("an arm on a turning hub reports the forces of circular motion",
          "[contract][reactions]") {
    // a hub that goes on at 2 rad/s about z; 3 kg with its centre 0.5 m out and 0.2 m up
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double dt = GENERATE(1e-4, 1.0 / 240);
    if (Rig::single && dt < 1e-3) return; // leaves three digits of the force in float
    INFO(solver << ", dt = " << dt);
    const double rate = 2, mass = 3, heavy = 1e9;
    const V3 arm(0.5, 0, 0.2);
    Rig rig(solver, none);
    rig.set_iterations(100);
    auto hub = rig.body(heavy, sphere(heavy), none, none, {0, 0, rate});
    auto body = rig.body(mass, sphere(0.2), arm, V3(0, 0, rate).cross(arm), {0, 0, rate});
    auto& joint = rig.six_axis(body, hub, Frame{}, six(V6::Constant(1e4)));
    for (double t = 0; t < 0.2; t += dt) rig.step(dt);
    // once its lag is corrected at the world's rate the arm moves on chords of a circle: the force
    // turns the velocity from one to the next, along the arm as the step begins
    const double pull = mass * rate * rate * arm.x();
    const V3 force = V3(-pull, 0, 0);
    V6 expected, reported;
    expected << force, arm.cross(force);
    for (const JointAxis axis : all_joint_axes) {
        reported[Eigen::Index(index(axis))] = joint.force(axis);
    }
    INFO(reported.transpose() << " for " << expected.transpose());
    Shown shown(solver, "reactions: turning arm");
    // in float the velocity of a step changes by rate · dt, of which a float's digits are a share
    const double digits = Rig::single ? 4e-7 / (rate * dt) : 0;
    // the lag that asks for the correction: r (ω dt)²/2 a step, of which a fifth goes in each
    const double lag = std::pow(rate * dt, 2) / (2 * 0.2);
    shown.small((reported - expected).norm() / pull, 1e-4 + lag + digits);
    CHECK(joint.absorbed_energy() == 0);
}

namespace {

/// Two bodies that turn about a hinge between them, one joined to the world by six plastic axes.
struct Scene {
    Scene(const std::string& solver, double stiffness)
        : rig(solver, {0, 0, -9.81}),
          a(rig.body(2, sphere(0.3), {0, 0, 0.2}, none, {20, 15, 5})),
          b(rig.body(3, {0.2, 0.5, 0.4}, {0.6, 0, 0.2}, none, {-3, 4, 10})),
          root(&rig.six_axis(a, nullptr, Frame{},
                             six(capacities(), infinity, V6::Constant(stiffness)))),
          hinge(&rig.hinge_of(b, a, {0.3, 0, 0.2}, {0, 0, 1}, one(15, infinity, stiffness))) {}

    void run(int steps) {
        for (int i = 0; i < steps; ++i) rig.step(1e-3);
    }
    auto save() {
        return std::tuple(Rig::motion(a), Rig::motion(b), Rig::memory(*root), Rig::memory(*hinge));
    }
    template <class Saved>
    void put_back(const Saved& saved) {
        rig.put_back(a, std::get<0>(saved));
        rig.put_back(b, std::get<1>(saved));
        Rig::put_back(*root, std::get<2>(saved));
        Rig::put_back(*hinge, std::get<3>(saved));
    }

    using Root = std::remove_reference_t<decltype(std::declval<Rig&>().six_axis(
        Rig::Body(), Rig::Body(), Frame{}, std::declval<Six>()))>;
    using Hinge = std::remove_reference_t<decltype(std::declval<Rig&>().hinge_of(
        Rig::Body(), Rig::Body(), V3(), V3(), std::declval<Joint>()))>;

    Rig rig;
    Rig::Body a, b;
    Root* root;
    Hinge* hinge;
};

} // namespace

TEST_CASE("a saved and restored run is the uninterrupted one bit for bit", "[contract][state]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double stiffness = GENERATE(as<double>{}, infinity, 2e4);
    INFO(solver << ", k = " << stiffness);
    Shown shown(solver, "saved and restored run");
    Scene whole(solver, stiffness);
    whole.run(20);
    const auto saved = whole.save();
    // what an engine normalises when it is given a position, it does in both runs
    whole.put_back(saved);
    whole.run(60);
    const auto end = whole.save();
    CHECK(whole.root->absorbed_energy() > 1);
    CHECK(whole.hinge->absorbed_energy() > 0.1);

    SECTION("in a new world") {
        Scene resumed(solver, stiffness);
        resumed.put_back(saved);
        resumed.run(60);
        const bool same = resumed.save() == end;
        CHECK(same);
        shown.small(same ? 0 : 1, 0);
    }
    SECTION("in the same world") {
        whole.put_back(saved);
        whole.run(60);
        const bool same = whole.save() == end;
        CHECK(same);
        shown.small(same ? 0 : 1, 0);
    }
}

TEST_CASE("a joint does not care which body is called A", "[contract][swap]") {
    // about an axis through both centres of mass: there the pin does not drift
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const bool six_axes = GENERATE(false, true);
    const bool breaks = GENERATE(false, true);
    INFO(solver << ", six axes " << six_axes << ", breaks " << breaks);
    struct End {
        V3 spin_a, spin_b;
        double turned, absorbed;
        bool broken;
    };
    const auto run = [&](bool swapped) {
        Rig rig(solver, none);
        auto a = rig.body(2, sphere(2), {0, 0, 0.4}, none, {0, 0, 10});
        auto b = rig.body(3, sphere(3), {0, 0, -0.6}, none, none);
        auto first = swapped ? b : a, second = swapped ? a : b;
        const double sign = swapped ? -1 : 1;
        const auto go = [&](auto& joint, auto&& position) {
            for (int i = 0; i < 400; ++i) rig.step(1e-3);
            return End{Rig::spin(a), Rig::spin(b), sign * position(), joint.absorbed_energy(),
                       joint.broken()};
        };
        if (six_axes) {
            V6 capacity = capacities();
            capacity[5] = 12;
            auto& joint =
                rig.six_axis(first, second, Frame{}, six(capacity, breaks ? 20 : infinity));
            return go(joint, [&] { return joint.position(JointAxis::torsion); });
        }
        auto& joint =
            rig.hinge_of(first, second, none, {0, 0, 1}, one(12, breaks ? 20.0 / 12 : infinity));
        return go(joint, [&] { return joint.rotation(); });
    };
    const End here = run(false), there = run(true);
    Shown shown(solver, "bodies swapped");
    shown.small((here.spin_a - there.spin_a).norm() / 10, exact);
    shown.small((here.spin_b - there.spin_b).norm() / 10, exact);
    shown.close(here.turned, there.turned);
    shown.close(here.absorbed, there.absorbed);
    CHECK(here.broken == breaks);
    CHECK(there.broken == breaks);
}
