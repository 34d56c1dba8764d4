// SPDX-License-Identifier: MIT
#include <rapidcheck/catch.h>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "ductile/joint/decoupled_rows.hpp"
#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/row_sweep.hpp"

using namespace ductile;

namespace {

using V3 = Vector3<double>;
using M3 = Matrix3<double>;
using V6 = Vector6<double>;
using Sweep = RowSweep<double>;
using Velocities = SweptVelocities<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

double number() { return double(*rc::gen::inRange(-1000, 1001)) / 1000; }
V3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
}
BodyAtJoint<double> body() {
    const M3 turned = turned_by<double>(3 * vector(), M3::Identity());
    const V3 inertia = V3::Constant(2) + vector();
    return {1 + number() / 2, turned * inertia.asDiagonal() * turned.transpose(), vector()};
}
SweptBody<double> swept(const BodyAtJoint<double>& body) {
    return {V3::Constant(body.inverse_mass), body.inverse_inertia, body.arm};
}
Velocities velocities() {
    Velocities result;
    result.linear_a = vector();
    result.angular_a = vector();
    result.linear_b = vector();
    result.angular_b = vector();
    return result;
}
void apply(Velocities& to, const Velocities& change) {
    to.linear_a += change.linear_a;
    to.angular_a += change.angular_a;
    to.linear_b += change.linear_b;
    to.angular_b += change.angular_b;
}
/// Of A minus B at the joint.
V6 twist(const Velocities& v, const BodyAtJoint<double>& a, const BodyAtJoint<double>& b) {
    V6 result;
    result << v.linear_a + v.angular_a.cross(a.arm) - v.linear_b - v.angular_b.cross(b.arm),
        v.angular_a - v.angular_b;
    return result;
}
double distance(const Velocities& a, const Velocities& b) {
    return (a.linear_a - b.linear_a).norm() + (a.angular_a - b.angular_a).norm() +
           (a.linear_b - b.linear_b).norm() + (a.angular_b - b.angular_b).norm();
}

} // namespace

TEST_CASE("decoupled rows are solved by a single sweep", "[joint][sweep]") {
    const std::array<std::size_t, 6> order{3, 4, 0, 1, 2, 5};
    CHECK(rc::check([&] {
        const auto a = body(), b = body();
        const Velocities start = velocities();
        V6 target;
        target << vector(), vector();
        const auto rows = decoupled_rows(inverse_mass_at_joint(a, b), order, 5, 1e-15);
        Sweep sweep;
        sweep.open(swept(a), swept(b));
        for (const CombinedRow<double>& row : rows) {
            const double bias = row.force.dot(target.head<3>()) + row.moment.dot(target.tail<3>());
            sweep.add(row.force, row.moment, {.bias = bias});
        }
        Velocities now = start;
        Sweep::Impulses impulses = Sweep::Impulses::Zero();
        double asked = 0;
        apply(now, sweep.sweep(now, impulses, asked));
        RC_ASSERT((twist(now, a, b) - target).norm() < 1e-11);
        // asked for is what the velocities of the rows were off by, and nothing is left to ask for
        RC_ASSERT(asked > 0);
        sweep.sweep(now, impulses, asked);
        RC_ASSERT(asked < 1e-11);

        // the bodies moved by what the impulses at the joint move them
        JointImpulse<double> sum;
        for (std::size_t i = 0; i < 6; ++i) {
            sum.linear += impulses[Eigen::Index(i)] * rows[i].force;
            sum.angular += impulses[Eigen::Index(i)] * rows[i].moment;
        }
        const auto of_a = velocity_change(a, sum), of_b = velocity_change(b, sum);
        const Velocities expected{start.linear_a + of_a.linear, start.angular_a + of_a.angular,
                                  start.linear_b - of_b.linear, start.angular_b - of_b.angular};
        RC_ASSERT(distance(now, expected) < 1e-11);
    }));
}

TEST_CASE("rows with bounds and compliance end where all conditions hold", "[joint][sweep]") {
    CHECK(rc::check([] {
        const auto a = body(), b = body();
        Velocities now = velocities();
        struct Wanted {
            V3 force, moment;
            RowLimits<double> limits;
        };
        std::vector<Wanted> rows;
        Sweep sweep;
        sweep.open(swept(a), swept(b));
        for (int i = 0; i < 6; ++i) {
            const V3 unit = V3::Unit(i % 3);
            const double bound = i % 2 == 0 ? 0.2 + std::abs(number()) : infinity;
            const double compliance = std::pow(10.0, 4 * number());
            rows.push_back({i < 3 ? unit : V3(V3::Zero()),
                            i < 3 ? V3(V3::Zero()) : unit,
                            {.lower = -bound,
                             .upper = bound,
                             .bias = number(),
                             .compliance = i % 3 == 0 ? compliance : 0}});
            sweep.add(rows.back().force, rows.back().moment, rows.back().limits);
        }
        Sweep::Impulses impulses = Sweep::Impulses::Zero();
        double asked = 1;
        for (int i = 0; i < 20000 && asked > 1e-13; ++i) {
            apply(now, sweep.sweep(now, impulses, asked));
        }
        const V6 u = twist(now, a, b);
        for (int i = 0; i < 6; ++i) {
            const auto& limits = rows[std::size_t(i)].limits;
            const double impulse = impulses[i];
            const double off = u[i] + limits.compliance * impulse - limits.bias;
            RC_ASSERT(impulse >= limits.lower);
            RC_ASSERT(impulse <= limits.upper);
            const double tolerance = 1e-8 * (1 + limits.compliance);
            RC_ASSERT(off < tolerance || impulse == limits.lower);
            RC_ASSERT(off > -tolerance || impulse == limits.upper);
        }
    }));
}

TEST_CASE("a block of rows is solved by the second sweep unless it meets a bound",
          "[joint][sweep]") {
    CHECK(rc::check([] {
        const auto a = body(), b = body();
        const bool soft = *rc::gen::inRange(0, 2) == 1;
        const bool weak = *rc::gen::inRange(0, 2) == 1;
        Velocities now = velocities();
        std::array<RowLimits<double>, 6> limits{};
        Sweep block, single;
        for (Sweep* sweep : {&block, &single}) {
            sweep->open(swept(a), swept(b));
            for (int i = 0; i < 6; ++i) {
                const double bound = weak ? 0.1 : 1e3;
                limits[std::size_t(i)] = {.lower = -bound,
                                          .upper = bound,
                                          .bias = 0.1 * i,
                                          .compliance = soft ? 0.3 * i : 0.0};
                const V3 unit = V3::Unit(i % 3), none = V3::Zero();
                sweep->add(i < 3 ? unit : none, i < 3 ? none : unit, limits[std::size_t(i)]);
            }
        }
        block.join_last(6);
        Velocities other = now;
        Sweep::Impulses impulses = Sweep::Impulses::Zero(), others = impulses;
        double asked = 0;
        apply(now, block.sweep(now, impulses, asked));
        apply(now, block.sweep(now, impulses, asked));
        if (!weak) {
            const V6 u = twist(now, a, b);
            for (int i = 0; i < 6; ++i) {
                const auto& row = limits[std::size_t(i)];
                RC_ASSERT(std::abs(u[i] + row.compliance * impulses[i] - row.bias) < 1e-10);
            }
        }
        // where they end, with bounds or without, is where single rows end
        for (int i = 0; i < 20000; ++i) {
            apply(now, block.sweep(now, impulses, asked));
            apply(other, single.sweep(other, others, asked));
        }
        RC_ASSERT(distance(now, other) < 1e-8);
    }));
}

TEST_CASE("what cannot be moved is left alone", "[joint][sweep]") {
    Sweep sweep;
    const SweptBody<double> fixed;
    const V3 none = V3::Zero();
    sweep.open(fixed, fixed);
    sweep.add(V3(1, 0, 0), none, {.bias = 1});
    sweep.add(none, V3(0, 0, 1), {.bias = 1});
    Sweep::Impulses impulses = Sweep::Impulses::Zero();
    double asked = -1;
    CHECK(sweep.sweep({}, impulses, asked).squared_norm() == 0);
    CHECK(asked == 0);
    CHECK(impulses == Sweep::Impulses::Zero());

    // a body that moves along x alone: the other takes the rest
    const SweptBody<double> rail{.inverse_mass = V3(1, 0, 0)}, free{.inverse_mass = V3(3, 3, 3)};
    sweep.open(rail, free);
    sweep.add(V3(1, 0, 0), none, {.bias = 1});
    sweep.add(V3(0, 1, 0), none, {.bias = 1});
    sweep.add(none, V3(0, 0, 1), {.bias = 1}); // neither turns
    const Velocities moved = sweep.sweep({}, impulses, asked);
    CHECK(moved.linear_a == V3(0.25, 0, 0));
    CHECK(moved.linear_b == V3(-0.75, -1, 0));
    CHECK(moved.angular_a == V3(0, 0, 0));
    CHECK(impulses[2] == 0);
}

TEST_CASE("a row gives what its bounds demand, also where nothing is amiss", "[joint][sweep]") {
    const SweptBody<double> free{.inverse_mass = V3(3, 3, 3)};
    Sweep sweep;
    sweep.open(free, SweptBody<double>{});
    sweep.add(V3(1, 0, 0), V3::Zero(), {.lower = 2, .upper = 5});
    Sweep::Impulses impulses = Sweep::Impulses::Zero();
    double asked = 0;
    const Velocities moved = sweep.sweep({}, impulses, asked);
    CHECK(impulses[0] == 2);
    CHECK(asked == 6);
    CHECK(moved.linear_a == V3(6, 0, 0));
    sweep.sweep(moved, impulses, asked);
    CHECK(impulses[0] == 2);
    CHECK(asked == 0);
}
