// SPDX-License-Identifier: MIT
//
// What a joint that holds takes of memory: its object, and what worlds and solvers keep for it. A
// field of many joints is as slow as its memory is far.
#include <catch2/catch.hpp>

#ifdef BENCH_ODE
#include "cost/ode_field.hpp"
#else
#include "cost/bullet_field.hpp"
#endif

using namespace bench::cost;

TEST_CASE("A joint that holds keeps nothing that only others need", "[cost]") {
    constexpr int count = 300, steps = 3;
    // of its parts of frames, of islands of many rows, of rows that the user's solver solves
    constexpr bool ode = Field::engine == "ode";
    constexpr double bytes = ode ? 5000 : 3700, in_steps = ode ? 1500 : 500;
    Field bodies({.joint = Joint::none, .count = count}),
        field({.joint = Joint::plastic_hinge, .count = count});
    if (heap_in_use() == 0) return; // this allocator does not tell
    CHECK(field.heap() / count < bytes);
    const auto grown = [](Field& of) {
        const double before = heap_in_use();
        for (int i = 0; i < steps; ++i) of.step();
        return (heap_in_use() - before) / count;
    };
    const double alone = grown(bodies);
    CHECK(grown(field) - alone < in_steps);
}
