// SPDX-License-Identifier: MIT
//
// What holds for every yield surface, in one scalar: a file per scalar, as all surfaces times all
// properties are the slowest to compile of all tests.
#pragma once

#include <catch2/catch.hpp>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <type_traits>

#include "core/surface/cases.hpp"
#include "ductile/numeric/ldlt.hpp"
#include "ductile/surface/closest_point.hpp"
#include "support/property.hpp"

namespace ductile::test {

/// A few evaluations of order one, each with a few operations.
template <class S>
constexpr S round_off = 64 * std::numeric_limits<S>::epsilon();

template <class S>
void check_all() {
    const std::string scalar = std::is_same_v<S, float> ? " (float): " : ": ";
    for_every_surface<S>([&](const std::string& surface_name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        using Matrix = typename T::Matrix;
        const auto name = [&](const char* property) { return surface_name + scalar + property; };
        constexpr S tolerance = round_off<S>;

        test::prop(name("the value is a gauge"), [&] {
            const auto f = any_direction<Vector>();
            const auto g = any_vector<Vector>();
            const S s = any_number(S(0.01), S(100));
            const S value = surface.value(f);
            RC_ASSERT(value > 0);
            RC_ASSERT(std::abs(surface.value(s * f) - s * value) <= tolerance * s * value);
            RC_ASSERT(std::abs(surface.value(-f) - value) <= tolerance * value);
            const S sum = value + surface.value(g); // convex: a point between is no farther out
            RC_ASSERT(surface.value(f + g) <= sum * (1 + tolerance));
        });

        test::prop(name("a sign of one force does not matter"), [&] {
            const auto f = any_vector<Vector>();
            Vector mirrored = f;
            const int axis = *rc::gen::inRange(0, T::dimension);
            mirrored[axis] = -mirrored[axis];
            RC_ASSERT(std::abs(surface.value(mirrored) - surface.value(f)) <= tolerance);
        });

        test::prop(name("flow dissipates, at the rate of the gauge"), [&] {
            const auto f = any_direction<Vector>();
            const S value = surface.value(f);
            const Vector normal = surface.normal(f);
            RC_ASSERT(normal.allFinite());
            RC_ASSERT(std::abs(normal.dot(f) - value) <= tolerance * value);
            const Vector outside = surface.normal(3 * f); // the same along the ray
            RC_ASSERT((outside - normal).norm() <= 4 * tolerance * normal.norm());
        });

        test::prop(name("the normal supports the surface"), [&] {
            const auto f = any_direction<Vector>();
            const auto g = any_vector<Vector>();
            RC_ASSERT(surface.normal(f).dot(g) <= surface.value(g) + tolerance);
        });

        test::prop(name("the support of a flow dissipates most"), [&] {
            const auto flow = any_direction<Vector>();
            const auto g = any_direction<Vector>();
            const Vector force = surface.support(flow);
            // an axis without flow may carry any force, and a box then chooses none
            RC_ASSERT(std::abs(surface.value(force) - 1) <= tolerance);
            const S dissipated = force.dot(flow);
            RC_ASSERT(dissipated > 0);
            RC_ASSERT(g.dot(flow) / surface.value(g) <= dissipated * (1 + tolerance));
        });

        test::prop(name("a force inside stays"), [&] {
            const auto ray = any_direction<Vector>();
            const Vector f = ray * (any_number(S(0), S(1)) / surface.value(ray));
            const auto stiffness = any_stiffness<Matrix>();
            RC_ASSERT(surface.project(f, stiffness) == f);
            RC_ASSERT(project_radially(surface, f) == f);
        });

        test::prop(name("projection lands on the surface, and stays"), [&] {
            const auto ray = any_direction<Vector>();
            const S beyond = std::pow(S(10), any_number(S(-3), S(3)));
            const Vector f = ray * ((1 + beyond) / surface.value(ray));
            const auto stiffness = any_stiffness<Matrix>();
            const Vector on = surface.project(f, stiffness);
            RC_ASSERT(std::abs(surface.value(on) - 1) <= on_surface<S>);
            RC_ASSERT(surface.project(on, stiffness) == on);
            const Vector drawn = project_radially(surface, f);
            RC_ASSERT(std::abs(surface.value(drawn) - 1) <= on_surface<S>);
            RC_ASSERT(project_radially(surface, drawn) == drawn);
        });

        test::prop(name("projection finds the closest force, so that flow is associated"), [&] {
            const auto ray = any_direction<Vector>();
            const S beyond = std::pow(S(10), any_number(S(-1), S(2)));
            const Vector f = ray * ((1 + beyond) / surface.value(ray));
            const auto stiffness = any_stiffness<Matrix>();
            const Vector on = surface.project(f, stiffness);
            const Vector flow = numeric::solve_semidefinite(stiffness, Vector(f - on));
            // in the normal cone: no admissible force dissipates more in this flow. The flow itself
            // carries the round-off of f - on through a stiffness of the condition 100
            const S noise = 100 * tolerance * flow.norm() * (1 + beyond);
            RC_ASSERT(surface.support(flow).dot(flow) <= on.dot(flow) + noise);
        });
    });
}

} // namespace ductile::test
