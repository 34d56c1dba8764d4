// SPDX-License-Identifier: MIT
//
// A link in the smallest engine there is: two bodies, solved exactly.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/state_bytes.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "ductile/surface/independent_axes.hpp"
#include "reference/pair_world.hpp"
#include "support/axes_along.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::reference::PairWorld;

namespace {

using V3 = Vector3<double>;
using M3 = Matrix3<double>;
using Body = BodyState<double>;
using Hinge = OneAxisJoint<Perfect<double>>;
using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
constexpr double infinity = std::numeric_limits<double>::infinity();

M3 turned(double angle, const V3& axis) {
    return Eigen::AngleAxis<double>(angle, axis.normalized()).toRotationMatrix();
}

Body body(double mass, double inertia, const V3& at = V3::Zero()) {
    return {.position = at, .inverse_mass = 1 / mass, .inverse_inertia = M3::Identity() / inertia};
}

Hinge hinge(double moment, double limit = infinity) {
    return Hinge(Perfect<double>({.strength = moment}), TravelLimit<double>({.limit = limit}));
}

Six six(const Vector6<double>& capacity, double limit = infinity,
        const Vector6<double>& stiffness = Vector6<double>::Constant(infinity)) {
    return Six(Ellipsoid<double, 6>({.capacity = capacity}), Perfect<double>({.strength = 1}),
               TravelLimit<double>({.limit = limit}), {.stiffness = stiffness});
}

/// Everything in the world, turned and moved.
Body moved(Body b, const M3& by, const V3& to) {
    b.position = by * b.position + to;
    b.orientation = by * b.orientation;
    b.velocity = by * b.velocity;
    b.spin = by * b.spin;
    b.inverse_inertia = by * b.inverse_inertia * by.transpose();
    return b;
}

Vector6<double> capacities() {
    Vector6<double> c;
    c << 900, 700, 1200, 40, 60, 30;
    return c;
}

} // namespace

TEST_CASE("a rotor on a link stops after the discrete travel, many turns on, about any axis",
          "[joint][link]") {
    // I = 2 kg m², M_p = 40 N m, 30 rad/s: 22.5 rad less ω₀ dt/2, 900 J
    const V3 axis = GENERATE(V3(0, 0, 1), V3(1, 2, 2), V3(-3, 1, 0.5));
    const double dt = 1.0 / 240;
    const M3 to_axis = test::axes_along(axis);
    Body rotor = body(1, 2, V3(1, 2, 3));
    rotor.spin = 30 * axis.normalized();
    const JointFrame<double> in_b{V3(1, 2, 3), to_axis};
    PairWorld world(rotor, Body{},
                    Link(hinge(40), {JointAxis::torsion}, {V3::Zero(), to_axis}, in_b));
    for (int i = 0; i < 400; ++i) world.step(dt);
    CHECK(world.link().position(JointAxis::torsion) == Approx(22.5 - 30 * dt / 2).epsilon(1e-9));
    CHECK(world.link().joint().state().plastic_work == Approx(900).epsilon(1e-9));
    CHECK(world.kinetic_energy() < 1e-12);
    CHECK(world.link().outcome() == Outcome::elastic);
}

TEST_CASE("a link breaks with the right residual speed", "[joint][link]") {
    const double dt = GENERATE(1.0 / 15, 1.0 / 60, 1.0 / 1000);
    Body rotor = body(1, 2);
    rotor.spin = V3(0, 0, 10);
    PairWorld world(rotor, Body{}, Link(hinge(40, 1.6), {JointAxis::torsion}, {}, {}));
    for (int i = 0; i < 3000 && !world.link().broken(); ++i) world.step(dt);
    CHECK(world.link().broken());
    CHECK(world.a().spin.z() == Approx(6).epsilon(1e-9));
    world.step(dt);
    CHECK(world.a().spin.z() == Approx(6).epsilon(1e-9));
    CHECK(world.link().outcome() == Outcome::broken);
}

TEST_CASE("the answer does not depend on where the world's axes point", "[joint][link]") {
    test::prop("rotated and moved, bodies joined off their centres, six coupled axes", [] {
        const auto number = [] { return double(*rc::gen::inRange(-1000, 1000)) / 1000; };
        const auto vector = [&] { return V3(number(), number(), number()); };
        Body a = body(2, 0.3, V3(0.4, 0, 0.5)), b = body(3, 0.5, V3(0, -0.2, -0.6));
        a.velocity = 2 * vector();
        a.spin = 20 * vector();
        const V3 force = 100 * vector(), torque = 50 * vector();
        const M3 by = turned(3 * number(), vector() + V3(0, 0, 1.5));
        const V3 to = 5 * vector();
        const JointFrame<double> in_a{V3(-0.4, 0, -0.5), M3::Identity()};
        const JointFrame<double> in_b{V3(0, 0.2, 0.6), M3::Identity()};
        const auto run = [&](const M3& q, const V3& at) {
            PairWorld world(moved(a, q, at), moved(b, q, at),
                            Link(six(capacities(), 400.0), {all_joint_axes}, in_a, in_b));
            for (int i = 0; i < 60; ++i) world.step(1.0 / 240, q * force, q * torque);
            const auto& s = world.link().joint().state();
            Vector6<double> result;
            result << s.plastic_work, s.plastic_travel, world.kinetic_energy(),
                world.link().position(JointAxis::axial),
                world.link().position(JointAxis::bending_y),
                world.link().force(JointAxis::bending_x);
            return result;
        };
        const Vector6<double> here = run(M3::Identity(), V3::Zero()), there = run(by, to);
        RC_ASSERT((here - there).norm() <= 1e-8 * (1 + here.norm()));
    });
}

TEST_CASE("a hinge does not care which body is called A", "[joint][link]") {
    Body a = body(2, 0.3, V3(0.4, 0, 0)), b = body(3, 0.5, V3(-0.6, 0, 0));
    a.spin = V3(0, 0, 12);
    a.velocity = a.spin.cross(V3(0.4, 0, 0));
    const JointFrame<double> in_a{V3(-0.4, 0, 0), M3::Identity()};
    const JointFrame<double> in_b{V3(0.6, 0, 0), M3::Identity()};
    PairWorld one(a, b, Link(hinge(20, 0.3), {JointAxis::torsion}, in_a, in_b));
    PairWorld other(b, a, Link(hinge(20, 0.3), {JointAxis::torsion}, in_b, in_a));
    for (int i = 0; i < 400; ++i) {
        one.step(1e-3);
        other.step(1e-3);
    }
    CHECK(one.link().broken());
    // the joint is a point of body A: the two differ by what the pin drifts, second order
    CHECK(one.link().joint().state().plastic_work ==
          Approx(other.link().joint().state().plastic_work).epsilon(1e-9));
    CHECK(one.a().spin.z() == Approx(other.b().spin.z()).epsilon(1e-3));
    CHECK(one.link().position(JointAxis::torsion) ==
          Approx(-other.link().position(JointAxis::torsion)).epsilon(1e-3));
}

TEST_CASE("reactions of a loaded cantilever are those of statics", "[joint][link]") {
    // 2 kg at 0.8 m from the wall along x, own weight and a sideways force; frame turned about x
    const double weight = 2 * 9.81, side = 15, arm = 0.8;
    const M3 axes =
        turned(std::numbers::pi / 2, V3::UnitY()); // z of the frame along x of the world
    PairWorld world(body(2, 0.3, V3(arm, 0, 0)), Body{},
                    Link(six(Vector6<double>::Constant(1e4)), {all_joint_axes},
                         {V3(-arm, 0, 0), axes}, {V3::Zero(), axes}));
    for (int i = 0; i < 20; ++i) world.step(1.0 / 60, V3(0, side, -weight));
    const auto& link = world.link();
    const V3 force = link.axes_in_world() * link.forces().head<3>();
    const V3 moment = link.axes_in_world() * link.forces().tail<3>();
    CHECK((force - V3(0, -side, weight)).norm() < 1e-9 * weight);
    CHECK((moment + V3(arm, 0, 0).cross(V3(0, side, -weight))).norm() < 1e-9 * weight * arm);
    CHECK(link.joint().state().plastic_work == 0);
    CHECK(world.kinetic_energy() < 1e-20);
}

TEST_CASE("an elastic link settles where its springs carry the load", "[joint][link]") {
    Vector6<double> k;
    k << 2e4, 3e4, 5e4, 400, 600, 300;
    PairWorld world(
        body(2, 0.3), Body{},
        Link(six(Vector6<double>::Constant(1e6), infinity, k), {all_joint_axes}, {}, {}));
    const V3 force(10, -20, 30), torque(0.4, -0.3, 0.2);
    // long steps: implicit, the oscillation dies out
    for (int i = 0; i < 4000; ++i) world.step(1.0 / 10, force, torque);
    for (int i = 0; i < 3; ++i) {
        CHECK(world.link().position(all_joint_axes[std::size_t(i)]) ==
              Approx(force[i] / k[i]).epsilon(1e-6));
        CHECK(world.link().position(all_joint_axes[std::size_t(3 + i)]) ==
              Approx(torque[i] / k[3 + i]).epsilon(1e-3)); // rotations do not add up: e²/2
    }
}

TEST_CASE("bent about one axis and then about another, a joint stays as it was bent",
          "[joint][link]") {
    PairWorld world(
        body(2, 0.3, V3(0, 0, 0.2)), Body{},
        Link(six(capacities()), {all_joint_axes}, {V3(0, 0, -0.2), M3::Identity()}, {}));
    const double dt = 1e-3;
    for (int i = 0; i < 100; ++i) world.step(dt, V3::Zero(), V3(55, 0, 0), 10);
    for (int i = 0; i < 100; ++i) world.step(dt, V3::Zero(), V3(0, 80, 0), 10);
    for (int i = 0; i < 300; ++i) world.step(dt, V3::Zero(), V3::Zero(), 10);
    const M3 bent = world.a().orientation;
    const auto& state = world.link().joint().state();
    CHECK(rotation_vector<double>(bent).norm() > 0.5);
    for (int i = 0; i < 3000; ++i) world.step(dt, V3::Zero(), V3::Zero(), 10);
    CHECK(rotation_vector<double>(bent.transpose() * world.a().orientation).norm() < 1e-6);
    // what the loads supplied was dissipated
    CHECK(state.plastic_work + state.other_work + world.kinetic_energy() ==
          Approx(world.supplied()).epsilon(1e-9));
    CHECK(std::abs(state.other_work) < 1e-3 * state.plastic_work);
}

TEST_CASE("only a surface that is an ellipsoid is handed to a solver as one", "[joint][link]") {
    using Apart = CoupledJoint<IndependentAxes<double, 6>, Perfect<double>>;
    PairWorld shared(body(2, 0.3), Body{}, Link(six(capacities()), {all_joint_axes}, {}, {}));
    shared.step(1e-3);
    CHECK((shared.link().shared_strength() - capacities()).norm() < 1e-9 * capacities().norm());
    PairWorld apart(body(2, 0.3), Body{},
                    Link(Apart(IndependentAxes<double, 6>({.capacity = capacities()}),
                               Perfect<double>({.strength = 1})),
                         {all_joint_axes}, {}, {}));
    apart.step(1e-3);
    CHECK(apart.link().shared_strength().norm() == 0);
}

TEST_CASE("a narrow row is at one bound or the other, and a shut one at both", "[joint][link]") {
    // bounds of a millionth of the joint's force, far within the tolerance of its largest row
    OpenRow<double> row{};
    row.limits = {.lower = -1e-6, .upper = 1e-6};
    row.lower = -1e-6;
    row.upper = 1e-6;
    row.tolerance = 1e-4;
    row.stiffness = infinity;
    row.start = 0.3;
    row.share = 1;
    CHECK(row.book({.force = -1e-6, .velocity = 0.2, .position = 0}, 1e-3).residual == 0);
    CHECK(row.book({.force = 1e-6, .velocity = 0.2, .position = 0}, 1e-3).residual == Approx(0.2));
    row.limits = {.lower = 0, .upper = 0};
    row.lower = row.upper = 0;
    CHECK(row.book({.force = 0, .velocity = 0.2, .position = 0}, 1e-3).residual == 0);
}

TEST_CASE("hands that move a body bend nothing", "[joint][link]") {
    const double stiffness = GENERATE(as<double>{}, 500.0, infinity);
    INFO("k = " << stiffness);
    Link<Six> link(six(capacities(), infinity, Vector6<double>::Constant(stiffness)),
                   all_joint_axes, {}, {});
    Body a = body(1, 2);
    const Body b = body(1, 2);
    link.start(a, b);
    // strained, or as a rigid-plastic joint drifts
    a.position = V3(1e-3, -2e-3, 3e-3);
    a.orientation = turned(0.05, {1, 2, -1});
    link.look(a, b);
    Vector6<double> strain, before;
    const auto strained = [&link] {
        Vector6<double> result;
        for (const JointAxis axis : all_joint_axes) {
            result[Eigen::Index(index(axis))] = link.position(axis) - link.plastic_offset(axis);
        }
        return result;
    };
    strain = strained();
    for (const JointAxis axis : all_joint_axes) {
        before[Eigen::Index(index(axis))] = link.plastic_offset(axis);
    }
    CHECK(strain.norm() > 0.01);
    link.teleport(a, b); // nobody did
    CHECK(strained() == strain);

    a.position += V3(0.4, -3, 0.1);
    a.orientation = turned(2, {0, 3, 1}) * a.orientation;
    link.teleport(a, b);
    CHECK((strained() - strain).norm() < 1e-12);
    CHECK(link.position(JointAxis::shear_x) == Approx(0.401).epsilon(1e-12));
    CHECK(link.plastic_offset(JointAxis::shear_x) - before[0] == Approx(0.4).epsilon(1e-12));
}

TEST_CASE("a link goes on from saved state bit for bit", "[joint][link]") {
    const auto make = [] {
        Body a = body(2, 0.3, V3(0, 0, 0.2));
        a.spin = V3(20, 15, 5);
        return PairWorld(
            a, Body{},
            Link(six(capacities()), {all_joint_axes}, {V3(0, 0, -0.2), M3::Identity()}, {}));
    };
    auto whole = make();
    for (int i = 0; i < 40; ++i) whole.step(1e-3);
    auto later = make();
    for (int i = 0; i < 20; ++i) later.step(1e-3);
    auto resumed = make();
    resumed.a() = later.a();
    resumed.link().restore(later.link().state());
    for (int i = 0; i < 20; ++i) resumed.step(1e-3);
    CHECK(resumed.link().state() == whole.link().state());
    CHECK(resumed.a().spin == whole.a().spin);
}

TEST_CASE("the bytes of a link's state are the state", "[joint][link]") {
    Body a = body(2, 0.3, V3(0, 0, 0.2));
    a.spin = V3(20, 15, 5);
    PairWorld world(
        a, Body{}, Link(six(capacities()), {all_joint_axes}, {V3(0, 0, -0.2), M3::Identity()}, {}));
    for (int i = 0; i < 40; ++i) world.step(1e-3);
    const auto state = world.link().state();
    using State = std::remove_cv_t<decltype(state)>;
    const auto bytes = to_bytes(state);
    CHECK(from_bytes<State>(bytes) == state);
    auto other = bytes;
    other[0] ^= std::byte(1);
    CHECK(!(from_bytes<State>(other) == state));
    CHECK(ductile::test::message_of([&] { (void)from_bytes<State>(std::span(bytes).first(3)); }) ==
          "state: 3 bytes, expected " + std::to_string(sizeof(State)));
}

TEST_CASE("what a break hands back is one impulse at the joint", "[joint][link]") {
    Body a = body(2, 0.3, V3(0.4, 0, 0)), b = body(3, 0.5, V3(-0.6, 0, 0));
    a.spin = V3(0, 0, 12);
    a.velocity = a.spin.cross(V3(0.4, 0, 0));
    Link link(hinge(20, 0.01), {JointAxis::torsion}, {V3(-0.4, 0, 0), M3::Identity()},
              {V3(0.6, 0, 0), M3::Identity()});
    link.start(a, b);
    link.prepare(a, b, 1.0 / 60, 0);
    link.commit(a, b, {V3::Zero(), V3(0, 0, link.limits()[5].lower)}, 1.0 / 60);
    REQUIRE(link.broken());
    const auto release = link.release(a, b);
    const auto impulse = link.release_impulse(a, b);
    REQUIRE(release.energy > 0);
    CHECK((release.a.linear - a.inverse_mass * impulse.linear).norm() < 1e-12);
    CHECK((release.b.linear + b.inverse_mass * impulse.linear).norm() < 1e-12);
    const V3 angular = a.inverse_inertia * (V3(-0.4, 0, 0).cross(impulse.linear) + impulse.angular);
    CHECK((release.a.angular - angular).norm() < 1e-12);
}

TEST_CASE("a rigid row that the engine left unsolved makes the link unreliable", "[joint][link]") {
    Body a = body(2, 0.3);
    Link link(hinge(40), {JointAxis::torsion}, {}, {});
    link.start(a, Body{});
    link.prepare(a, Body{}, 0.01, 0);
    a.velocity = V3(0.5, 0, 0);
    link.commit(a, Body{}, {}, 0.01);
    CHECK(link.outcome() == Outcome::unreliable);
    CHECK(link.rigid_residual() == Approx(0.5));
    CHECK(link.last().outcome == Outcome::elastic);
}

TEST_CASE("a part closes what rigid rows are far off by so slowly that it throws nothing",
          "[joint][link]") {
    // arms of 0.5 m; a short part's 200/s would throw what is 10 cm off by 20 m/s
    constexpr double rate = 200, dt = 1e-4;
    const auto speed = [&](double off, double angle, double spin, bool ahead) {
        Body a = body(1, 0.1), b = body(1, 0.1, V3(0, 1, 0));
        Link link(hinge(40), {JointAxis::torsion}, {V3(0, 0.5, 0), M3::Identity()},
                  {V3(0, -0.5, 0), M3::Identity()});
        link.start(a, b);
        a.position[0] = off;
        a.orientation = turned(angle, V3(1, 0, 0));
        a.spin = V3(spin, 0, 0);
        link.teleport(a, b); // it is seen where it is
        const auto& limits = link.prepare(a, b, dt, rate, ahead);
        return -(angle != 0 ? limits[3].bias : limits[0].bias);
    };
    CHECK(speed(5e-3, 0, 0, true) == Approx(200 * 5e-3)); // as ever
    CHECK(speed(0.1, 0, 0, false) == Approx(200 * 0.1));
    CHECK(speed(0.1, 0, 0, true) == Approx(200 * 0.01).epsilon(0.02)); // a hundredth of both arms
    CHECK(speed(0.5, 0, 0, true) == Approx(10 * 0.5));
    CHECK(speed(0.1, 0, 1000, true) == Approx(0.02 * 1000 * 0.5)); // a 50th of what sweeps
    CHECK(speed(0.1, 0, 3000, true) == Approx(200 * 0.1));
    CHECK(speed(0, 5e-3, 0, true) == Approx(200 * 5e-3));
    CHECK(speed(0, 0.1, 0, true) == Approx(200 * 0.01).epsilon(0.02));
}

TEST_CASE("a turn that a link cannot follow is unreliable, and says how far it was",
          "[joint][link]") {
    const double dt = 1.0 / 60;
    const V3 axis = V3(1, -2, 3).normalized();
    const bool all = GENERATE(false, true);
    const auto seen = [&](const V3& spin_a, const V3& spin_b, double engine_turns) {
        Body a = body(1, 2), b = body(1, 2);
        const auto see = [&](auto link) {
            link.start(a, b);
            a.spin = spin_a;
            b.spin = spin_b;
            link.prepare(a, b, dt, 0);
            a.orientation = turned(spin_a.norm() * dt * engine_turns, spin_a + V3(0, 0, 1e-9));
            b.orientation = turned(spin_b.norm() * dt * engine_turns, spin_b + V3(0, 0, 1e-9));
            link.commit_rows(a, b, Vector6<double>::Zero(), dt);
            if (link.unseen_turn() > 0) CHECK(link.outcome() == Outcome::unreliable);
            return link.unseen_turn();
        };
        if (all) return see(Link(six(capacities()), all_joint_axes, {}, {}));
        const M3 along = test::axes_along(axis);
        return see(Link(hinge(40), {JointAxis::torsion}, {V3::Zero(), along}, {V3::Zero(), along}));
    };
    const V3 still = V3::Zero();
    CHECK(seen(400 * axis, still, 1) == Approx(400 * dt));
    CHECK(seen(still, 400 * axis, 1) == Approx(400 * dt));
    CHECK(seen(95 * axis, -95 * axis, 1) == Approx(95 * dt)); // 3.17 rad of each other
    CHECK(seen(180 * axis, still, 1) == 0);                   // 3 rad
    CHECK(seen(90 * axis, -90 * axis, 1) == 0);
    CHECK(seen(400 * axis, 300 * axis, 1) == 0);
    // an engine that cuts turns
    CHECK(seen(60 * axis, still, 0.9) == Approx(60 * dt));
    CHECK(seen(60 * axis, still, 0.97) == 0);
    CHECK(seen(60 * axis, 60 * axis, 0.5) == 0);
    CHECK(seen(60 * axis, -60 * axis, 0.9) == Approx(60 * dt));
    CHECK(seen(60 * axis, still, 0) == 0); // moved before the solve
    CHECK(seen(20 * axis, still, 0.5) == 0);
}

TEST_CASE("a link refuses an axis given twice", "[joint][link]") {
    CHECK(ductile::test::message_of([] {
              Link(CoupledJoint(IndependentAxes<double, 2>({.capacity = Eigen::Vector2d(1, 2)}),
                                Perfect<double>({.strength = 1})),
                   {JointAxis::axial, JointAxis::axial}, {}, {});
          }) == "Link.axes[1] = axial: must differ from the axes before it");
}
