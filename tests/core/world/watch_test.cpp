// SPDX-License-Identifier: MIT
#include "ductile/world/watch.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "support/throws.hpp"

using namespace ductile;
using Report = JointReport<double>;

namespace {

Report broken() {
    return {.outcome = Outcome::broken, .fracture = FractureEvent<double>{.force = 7}};
}

} // namespace

TEST_CASE("a watch tells first yield, break and the first unreliable step, each once", "[world]") {
    Watch<double> watch;
    std::vector<std::string> told;
    watch.on_event([&](const JointEvent<double>& event) {
        told.push_back(event.name + " " + std::string(to_string(event.kind)));
    });
    const auto post = watch.add("post"), sign = watch.add("sign");
    watch.open(0.1);
    watch.see(post, {.outcome = Outcome::yielding, .first_yield = true});
    watch.see(sign, {.outcome = Outcome::unreliable, .residual = 0.3});
    CHECK(watch.events().size() == 2);
    CHECK(watch.events()[0].time == 0.1);
    CHECK(watch.worst().joint == sign);
    CHECK(watch.worst().residual == 0.3);
    CHECK(watch.unreliable() == 1);
    watch.open(0.2);
    watch.see(post, broken());
    watch.see(sign, {.outcome = Outcome::unreliable, .residual = 0.1});
    REQUIRE(watch.events().size() == 1);
    CHECK(watch.events()[0].report.fracture->force == 7);
    watch.open(0.3);
    watch.see(post, broken());
    watch.see(sign, {});
    CHECK(watch.events().empty());
    CHECK(watch.unreliable() == 0);
    CHECK(watch.unreliable_steps(sign) == 2);
    CHECK(watch.worst().residual == 0);
    CHECK(watch.worst_ever().residual == 0.3);
    CHECK(told == std::vector<std::string>{"post yielded", "sign unreliable", "post broke"});
}

TEST_CASE("a joint that goes on saying what it did last is told once", "[world]") {
    Watch<double> watch;
    const auto post = watch.add("post");
    watch.open(0.1);
    watch.see(post, {.first_yield = true, .plastic_travel = 0.1});
    watch.go_on(0.2); // a second part of the step
    watch.see(post, {.first_yield = true, .plastic_travel = 0.1});
    CHECK(watch.events().size() == 1);
    watch.open(0.3);
    watch.see(post, {}); // put back to before its yield
    watch.see(post, {.first_yield = true, .plastic_travel = 0.1});
    REQUIRE(watch.events().size() == 1);
    CHECK(watch.events()[0].time == 0.3);
}

TEST_CASE("a break is told for when it was, not for the end of its step", "[world]") {
    Watch<double> watch;
    const auto post = watch.add("post");
    watch.open(0.3);
    watch.see(post, {.outcome = Outcome::broken, .after_break = 0.125, .fracture = {{}}});
    REQUIRE(watch.events().size() == 1);
    CHECK(watch.events()[0].time == 0.3 - 0.125);
}

TEST_CASE("a joint restored as broken is not told as broken anew", "[world]") {
    Watch<double> watch;
    const auto post = watch.add("post", true);
    watch.open(0);
    watch.see(post, broken());
    CHECK(watch.events().empty());
}

TEST_CASE("a listener may add joints", "[world]") {
    Watch<double> watch;
    const auto post = watch.add("post");
    std::size_t added = 0;
    watch.on_event([&](const JointEvent<double>& event) {
        for (int i = 0; i < 100; ++i) added = watch.add("part of " + event.name);
    });
    watch.open(0);
    watch.see(post, {.first_yield = true});
    CHECK(watch.name(added) == "part of post");
}

TEST_CASE("a watch names a joint that it does not know", "[world]") {
    const Watch<double> watch;
    CHECK(test::message_of([&] { (void)watch.unreliable_steps(3); }) ==
          "Watch.joint = 3: must be below 0");
}
