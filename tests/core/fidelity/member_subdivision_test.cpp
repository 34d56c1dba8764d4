// SPDX-License-Identifier: MIT
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "ductile/fidelity/member_subdivision.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

TEST_CASE("a loaded cantilever gets hinges only near its root", "[subdivision]") {
    // M(x) = F (L - x), sections every L/10: those with M >= 0.9 M_p need a hinge
    constexpr double length = 2, plastic_moment = 100;
    std::vector<double> moment(10), capacity(10, plastic_moment);
    MemberSubdivision<double> member(moment, capacity);
    const auto load = [&](double force) {
        for (std::size_t i = 0; i < 10; ++i) moment[i] = -force * length * (1 - double(i) / 10);
        return member.update(0.001);
    };
    CHECK(load(0.89 * plastic_moment / length) == SubdivisionChange{});
    CHECK(load(0.95 * plastic_moment / length) == SubdivisionChange{.activated = 1});
    CHECK(member.has_hinge(0));
    CHECK(!member.has_hinge(1));
    // the root yields and passes no more on; a hardened root passes 1.05 M_p
    CHECK(load(1.05 * plastic_moment / length) == SubdivisionChange{.activated = 1});
    CHECK(member.has_hinge(1));
    CHECK(!member.has_hinge(2)); // 0.84 M_p
}

TEST_CASE("a hinge goes only after its moment has been low for the hold time", "[subdivision]") {
    std::vector<double> moment{95}, capacity{100};
    MemberSubdivision<double> member(moment, capacity,
                                     {.activate = 0.9, .release = 0.7, .hold_time = 0.0095});
    CHECK(member.update(0.001).activated == 1);
    const auto steps_low = [&](int steps) {
        std::size_t released = 0;
        for (int i = 0; i < steps; ++i) {
            moment[0] = 60;
            released += member.update(0.001).released;
        }
        return released;
    };
    CHECK(steps_low(9) == 0);
    moment[0] = -75; // between the two: not low
    CHECK(member.update(0.001) == SubdivisionChange{});
    CHECK(steps_low(9) == 0);
    CHECK(steps_low(1) == 1);
    CHECK(!member.has_hinge(0));
    moment[0] = 80; // between the two: no hinge either
    CHECK(member.update(0.001) == SubdivisionChange{});
    CHECK(!member.has_hinge(0));
}

TEST_CASE("a moment beyond the capacity of a rigid section is told as late", "[subdivision]") {
    std::vector<float> moment{50, 95, 100, 130}, capacity(4, 100);
    MemberSubdivision<float> member(moment, capacity);
    CHECK(member.update(0.001f) == SubdivisionChange{.activated = 3, .late = 1});
    moment[2] = 140; // has its hinge by now
    CHECK(member.update(0.001f) == SubdivisionChange{});
}

TEST_CASE("a trembling moment moves no hinge twice", "[subdivision]") {
    rc::prop("any mean, any noise narrower than the hysteresis", [] {
        std::vector<double> moment(1), capacity{100};
        MemberSubdivision<double> member(moment, capacity,
                                         {.activate = 0.9, .release = 0.7, .hold_time = 0});
        const double mean = *rc::gen::inRange(0, 1200) / 10.0;
        std::size_t changes = 0;
        for (int i = 0; i < 200; ++i) {
            moment[0] = mean + *rc::gen::inRange(-99, 100) / 10.0; // ± 9.9 % of the capacity
            const auto change = member.update(0.001);
            changes += change.activated + change.released;
        }
        RC_ASSERT(changes <= 1);
    });
}

TEST_CASE("a section at its capacity always has a hinge, an idle one none for long",
          "[subdivision]") {
    rc::prop("any history", [] {
        std::vector<double> moment(5), capacity{10, 20, 30, 40, 50};
        MemberSubdivision<double> member(moment, capacity, {.hold_time = 0.005});
        std::size_t hinges = 0;
        for (int n = 0; n < 50; ++n) {
            for (double& m : moment) m = *rc::gen::inRange(-60, 60);
            const auto change = member.update(0.001);
            hinges += change.activated;
            hinges -= change.released;
            std::size_t counted = 0;
            for (std::size_t i = 0; i < 5; ++i) {
                counted += member.has_hinge(i);
                if (std::abs(moment[i]) >= 0.9 * capacity[i]) RC_ASSERT(member.has_hinge(i));
            }
            RC_ASSERT(counted == hinges);
        }
        for (double& m : moment) m = 0;
        for (int n = 0; n < 7; ++n) member.update(0.001);
        for (std::size_t i = 0; i < 5; ++i) RC_ASSERT(!member.has_hinge(i));
    });
}

TEST_CASE("a subdivision refuses what makes none, by name", "[subdivision]") {
    const std::vector<double> moment(2), capacity{1, 1}, bad{1, 0}, shorter{1};
    using Parameters = MemberSubdivisionParameters<double>;
    const auto with = [&](const std::vector<double>& limit, const Parameters& parameters) {
        return message_of([&] { MemberSubdivision<double>(moment, limit, parameters); });
    };
    CHECK(with(capacity, {}) == "nothing thrown");
    CHECK(with(shorter, {}) ==
          "MemberSubdivision.capacity.size() = 1: must be 2, as moment.size()");
    CHECK(with(bad, {}) == "MemberSubdivision.capacity[1] = 0 N m: must be finite and > 0");
    CHECK(with(capacity, {.activate = 1.1}) ==
          "MemberSubdivision.activate = 1.1: must be in (0, 1)");
    CHECK(with(capacity, {.activate = 0.5}) ==
          "MemberSubdivision.release = 0.7: must be in (0, 0.5)");
    CHECK(with(capacity, {.hold_time = -1}) ==
          "MemberSubdivision.hold_time = -1 s: must be finite and >= 0");
}
