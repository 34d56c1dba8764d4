// SPDX-License-Identifier: MIT
//
// An elastic joint that bends about two axes and twists: its moment is that of its stored energy,
// whatever it has turned by before.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "reference/pair_world.hpp"

using namespace ductile;
using ductile::reference::PairWorld;

namespace {

using V3 = Vector3<double>;
using M3 = Matrix3<double>;
using V6 = Vector6<double>;
using Body = BodyState<double>;
using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
using TwoBending = CoupledJoint<Ellipsoid<double, 2>, Perfect<double>>;

const V3 stiffness(900, 250, 400); ///< bending about x and y, torsion [N m/rad]

M3 turned(const V3& by) {
    return by.norm() > 0 ? Eigen::AngleAxis<double>(by.norm(), by.normalized()).toRotationMatrix()
                         : M3(M3::Identity());
}
Body body(double mass, double inertia, const V3& at = V3::Zero()) {
    return {.position = at, .inverse_mass = 1 / mass, .inverse_inertia = M3::Identity() / inertia};
}

/// `capacity`: of the moments [N m].
Six six(const V3& capacity) {
    V6 c, k;
    c << 1e6, 1e6, 1e6, capacity;
    k << 2e5, 3e5, 5e5, stiffness;
    return Six(Ellipsoid<double, 6>({.capacity = c}), Perfect<double>({.strength = 1}), {},
               {.stiffness = k});
}
const V3 never = V3::Constant(1e6);

/// What a step takes and gives swings too, by 4e-4 of the energy at these steps; a mean over some
/// swings leaves a share of that.
constexpr double rest_of_means = 5e-5;

template <class Joint>
V6 strain(const Link<Joint>& link) {
    V6 result;
    for (const JointAxis axis : all_joint_axes) {
        result[Eigen::Index(index(axis))] = link.position(axis) - link.plastic_offset(axis);
    }
    return result;
}
double energy(const Link<Six>& link) {
    const V6 e = strain(link);
    return e.cwiseProduct(e).dot(link.joint().parameters().stiffness) / 2;
}

/// A link of two heavy bodies, whose springs any step here resolves, held wherever one puts them.
struct Held {
    Link<Six> link{six(never), all_joint_axes, {V3::Zero(), turned({0.3, -0.5, 0.2})}, {}};
    Body a = body(1e6, 1e6), b = body(1e6, 1e6);

    /// Turned by `before` plastically, about several axes.
    explicit Held(const V3& before = V3::Zero()) {
        link.start(a, b);
        a.orientation = turned(before) * a.orientation;
        link.teleport(a, b);
    }
    /// Of the rows on A; B feels the opposite.
    [[nodiscard]] V3 moment() {
        link.prepare(a, b, 1e-3, 0);
        V3 result = V3::Zero();
        for (const JointAxis axis : all_joint_axes) {
            const LinkRow<double> row = link.row(axis);
            REQUIRE(row.limits.lower == row.limits.upper);
            if (row.turns) result += row.limits.lower * row.direction;
        }
        return result;
    }
    [[nodiscard]] double stored() {
        link.look(a, b);
        return energy(link);
    }
};

} // namespace

TEST_CASE("the moment of an elastic joint is the gradient of what it stores", "[joint][elastic]") {
    const V3 before = GENERATE(V3(0, 0, 0), V3(1.1, -0.4, 0.9));
    const V3 bent = GENERATE(V3(0.05, -0.08, 0.03), V3(0.3, 0.5, -0.4), V3(-1.2, 0.7, 1.5));
    Held held(before);
    held.b.orientation = turned({0.7, 0.2, -1.3}) * held.b.orientation;
    held.a.orientation = held.b.orientation * turned(bent) * held.a.orientation;
    const V3 moment = held.moment();
    constexpr double small = 1e-5;
    for (int i = 0; i < 3; ++i) {
        for (const bool of_a : {true, false}) {
            const auto energy_at = [&](double angle) {
                Held moved = held;
                Body& body = of_a ? moved.a : moved.b;
                body.orientation = turned(angle * V3::Unit(i)) * body.orientation;
                return moved.stored();
            };
            const double slope = (energy_at(small) - energy_at(-small)) / (2 * small);
            INFO("axis " << i << (of_a ? " of A" : " of B"));
            CHECK((of_a ? moment : -moment)[i] == Approx(-slope).margin(1e-6 * stiffness.norm()));
        }
    }
}

TEST_CASE("an elastic joint does no work on a closed path of rotations", "[joint][elastic]") {
    const V3 before = GENERATE(V3(0, 0, 0), V3(1.1, -0.4, 0.9));
    Held held(before);
    const M3 rest_a = held.a.orientation, rest_b = held.b.orientation;
    constexpr int steps = 4000;
    const auto put = [&](int i) {
        const double t = 2 * std::numbers::pi * i / steps;
        held.b.orientation = turned({0.4 * std::sin(t), 0, 0.9 * std::sin(2 * t)}) * rest_b;
        const V3 bent(0.25 * std::cos(t), 0.2 * std::sin(t), 0.15 * std::sin(t + 1) - 0.1);
        held.a.orientation =
            turned({0.4 * std::sin(t), 0, 0.9 * std::sin(2 * t)}) * turned(bent) * rest_a;
    };
    put(0);
    double work = 0, most = 0;
    V3 last = held.moment();
    M3 last_a = held.a.orientation, last_b = held.b.orientation;
    for (int i = 1; i <= steps; ++i) {
        put(i);
        const V3 now = held.moment();
        const V3 turn = rotation_vector<double>(held.a.orientation * last_a.transpose()) -
                        rotation_vector<double>(held.b.orientation * last_b.transpose());
        work += (last + now).dot(turn) / 2;
        last = now;
        last_a = held.a.orientation;
        last_b = held.b.orientation;
        most = std::max(most, held.stored());
    }
    REQUIRE(most > 30);
    CHECK(std::abs(work) < 1e-5 * most);
}

TEST_CASE("a free elastic swing about all axes keeps its energy", "[joint][elastic]") {
    Body a = body(2, 0.3, V3(0, 0, 0.2)), b = body(3, 0.5, V3(0, 0, -0.3));
    a.spin = V3(6, -9, 4);
    b.spin = V3(-2, 3, 5);
    PairWorld world(a, b,
                    Link(six(never), all_joint_axes, {V3(0, 0, -0.2), M3::Identity()},
                         {V3(0, 0, 0.3), M3::Identity()}));
    const double dt = 2e-5, start = world.kinetic_energy();
    double first = 0, last = 0, bent = 0; // mean of the energy over a tenth of the run
    constexpr int steps = 100000;
    for (int i = 0; i < steps; ++i) {
        world.step(dt);
        const double now = world.kinetic_energy() + energy(world.link());
        (i < steps / 10 ? first : last) +=
            i < steps / 10 || i >= steps - steps / 10 ? now / (steps / 10) : 0.0;
        bent = std::max(bent, strain(world.link()).tail<3>().norm());
    }
    CHECK(bent > 0.2);
    CHECK(std::abs(last - first) < rest_of_means * start);
    CHECK(world.link().joint().state().stored == Approx(energy(world.link())).epsilon(1e-9));
    CHECK(std::abs(world.link().joint().state().other_work) < 1e-3 * start);
}

TEST_CASE("what an elastic joint stores is its springs' after any number of turns",
          "[joint][elastic]") {
    const double dt = GENERATE(1.0 / 60, 1.0 / 240, 1.0 / 2000);
    const V3 capacity(40, 25, 30);
    PairWorld world(body(20, 6, V3(0, 0, 0.2)), Body{},
                    Link(six(capacity), all_joint_axes, {V3(0, 0, -0.2), M3::Identity()}, {}));
    double most = 0; // that the springs hold where they yield
    for (int i = 0; i < 3; ++i) {
        most = std::max(most, capacity[i] * capacity[i] / (2 * stiffness[i]));
    }
    const auto& state = world.link().joint().state();
    double least = 0, largest = 0, off = 0;
    for (int i = 0; i < int(4 / dt); ++i) {
        world.step(dt, V3::Zero(), V3(25, 12, 45));
        least = std::min(least, state.stored);
        largest = std::max(largest, state.stored);
        off = std::max(off, std::abs(state.stored - energy(world.link())));
    }
    INFO("dt = " << dt << ", turned " << world.link().position(JointAxis::torsion) << " rad");
    CHECK(std::abs(world.link().position(JointAxis::torsion)) > 10);
    CHECK(least >= 0);
    CHECK(largest < 3 * most); // of a corner of a box around the surface
    CHECK(off < 1e-9 * most);
    CHECK(state.plastic_work + state.stored + state.other_work + world.kinetic_energy() ==
          Approx(world.supplied()).epsilon(1e-9));
    CHECK(std::abs(state.other_work) < 0.02 * state.plastic_work);
}

TEST_CASE("a joint elastic in bending and rigid in torsion keeps energy as it swings",
          "[joint][elastic]") {
    const TwoBending joint(Ellipsoid<double, 2>({.capacity = Eigen::Vector2d(1e6, 1e6)}),
                           Perfect<double>({.strength = 1}), {},
                           {.stiffness = Eigen::Vector2d(900, 250)});
    Body a = body(2, 0.3);
    a.spin = V3(12, -9, 0);
    PairWorld world(a, Body{}, Link(joint, {JointAxis::bending_x, JointAxis::bending_y}, {}, {}));
    const double dt = 2e-5, start = world.kinetic_energy();
    constexpr int steps = 50000;
    double first = 0, last = 0;
    for (int i = 0; i < steps; ++i) {
        world.step(dt, V3::Zero(), V3::Zero(), 10);
        const double now = world.kinetic_energy() + world.link().joint().state().stored;
        (i < steps / 10 ? first : last) +=
            i < steps / 10 || i >= steps - steps / 10 ? now / (steps / 10) : 0.0;
    }
    CHECK(std::abs(world.link().position(JointAxis::torsion)) < 1e-3);
    CHECK(std::abs(last - first) < rest_of_means * start);
}
