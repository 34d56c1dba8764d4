// SPDX-License-Identifier: MIT
//
// The rows that a joint adds to an island: no softer than they may be, in a step of any length.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/solve/island_solver.hpp"
#include "ductile/surface/independent_axes.hpp"
#include "ductile/world/island_joint.hpp"

using namespace ductile;

namespace {

using V6 = Vector6<double>;
using Six = CoupledJoint<IndependentAxes<double, 6>, Perfect<double>>;

/// Worst violation of a row of the joint between two bodies of 2 kg, one of which was hit; the
/// other is joined to a third one [m/s | rad/s].
double left_open(double stiffness, double damping, double dt) {
    Six joint(IndependentAxes<double, 6>({.capacity = V6::Constant(1e12)}),
              Perfect<double>({.strength = 1}), TravelLimit<double>(),
              {.stiffness = V6::Constant(stiffness),
               .section_stiffness = V6::Constant(1e5),
               .damping_time = V6::Constant(damping)});
    Link<Six> link(joint, {all_joint_axes}, {}, {});
    BodyState<double> a{.inverse_mass = 0.5, .inverse_inertia = Matrix3<double>::Identity()};
    BodyState<double> b = a;
    link.start(a, b);
    Link<Six> next(joint, {all_joint_axes}, {}, {});
    next.start(b, b);
    a.velocity = {9, 1, 2};
    a.spin = {1, 3, 2};
    link.prepare(a, b, dt, 0, true);
    next.prepare(b, b, dt, 0, true);
    solve::Island island;
    for (int i = 0; i < 3; ++i) {
        island.bodies.push_back(solve::island_body({0.5, 0.5, 0.5}, Matrix3<double>::Identity()));
    }
    const int first = add_rows(island, link, {0, a.velocity, a.spin}, {1, b.velocity, b.spin}, dt);
    add_rows(island, next, {1, b.velocity, b.spin}, {2, b.velocity, b.spin}, dt);
    solve::IslandSolver solver;
    REQUIRE(solver.solve(island).solved);
    double worst = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        const solve::IslandRow& row = island.rows[std::size_t(first) + i];
        const double u = row.on_a.dot(island.bodies[0].velocity) +
                         row.on_b.dot(island.bodies[1].velocity) - row.target;
        worst = std::max(worst, std::abs(u + link.limits()[i].compliance * row.impulse));
    }
    return worst;
}

} // namespace

TEST_CASE("rows are no softer than they are, in a step of any length", "[island_joint]") {
    constexpr double rigid = std::numeric_limits<double>::infinity();
    for (const double dt : {1.0 / 60, 1e-3, 1e-5, 1e-9}) {
        INFO("dt = " << dt << " s");
        CHECK(left_open(rigid, 0, dt) < 1e-4); // of a section as stiff as the elastic one
        for (const double damping : {0.0, 3e-6, 0.5}) {
            INFO("damping of " << damping << " s");
            CHECK(left_open(1e5, damping, dt) < 1e-4);
        }
    }
}

TEST_CASE("a joint whose own rows are met is unreliable where its island is not solved",
          "[island_joint]") {
    Six joint(IndependentAxes<double, 6>({.capacity = V6::Constant(1e12)}),
              Perfect<double>({.strength = 1}));
    Link<Six> link(joint, {all_joint_axes}, {}, {});
    const BodyState<double> at{.inverse_mass = 0.5, .inverse_inertia = Matrix3<double>::Identity()};
    link.start(at, at);
    solve::Island island;
    const auto step = [&](double unsolved) {
        link.prepare(at, at, 0.01, 0);
        const int first = add_rows(island, link, {}, {}, 0.01);
        island.unsolved = unsolved;
        link.commit_rows(at, at, take_forces(island, link, first, 0.01), 0.01);
        return link.outcome();
    };
    CHECK(step(0) == Outcome::elastic);
    link.keep();
    CHECK(step(0.25) == Outcome::unreliable);
    CHECK(link.island_unsolved() == 0.25);
    link.put_back();
    CHECK(link.outcome() == Outcome::elastic);
    step(0.25);
    link.prepare(at, at, 0.01, 0); // an engine solves this step
    link.commit_rows(at, at, V6::Zero(), 0.01);
    CHECK(link.outcome() == Outcome::elastic);
}
