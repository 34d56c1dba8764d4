// SPDX-License-Identifier: MIT
#include "ductile/world/supervisor.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

/// A joint that says what it is told to say.
struct Puppet {
    JointReport<double> says;
    Supervisor::Ask ask() {
        return [this] { return says; };
    }
};

} // namespace

TEST_CASE("a supervisor warns once, by name", "[world]") {
    std::vector<std::string> lines;
    Supervisor supervisor([&lines](const std::string& line) { lines.push_back(line); });
    Puppet post, sign;
    supervisor.add(&post, "post", post.ask());
    supervisor.add(&sign, "", sign.ask());
    sign.says = {.outcome = Outcome::unreliable, .residual = 0.25};
    supervisor.open();
    supervisor.look(0.5);
    supervisor.close();
    supervisor.open();
    supervisor.look(0.75);
    supervisor.look(1);
    supervisor.close();
    CHECK(lines == std::vector<std::string>{
                       "ductile: joint \"joint 1\" was left unsolved by the solver at t = 0.5 s "
                       "(off by 0.25 m/s or rad/s); take shorter steps, or let the World do so "
                       "(tolerance); where neither helps, look for joints that hold the same "
                       "bodies against each other"});
    CHECK(supervisor.watch().unreliable() == 2);
    CHECK(supervisor.time() == 1);
}

TEST_CASE("a supervisor says why a joint is unreliable", "[world]") {
    std::vector<std::string> lines;
    Supervisor supervisor([&lines](const std::string& line) { lines.push_back(line); });
    Puppet post;
    supervisor.add(&post, "post", post.ask());
    post.says = {.outcome = Outcome::unreliable, .unseen_turn = 6.5};
    supervisor.open();
    supervisor.look(0.5);
    supervisor.close();
    CHECK(lines ==
          std::vector<std::string>{
              "ductile: joint \"post\" turned by 6.5 rad in the step that ended at t = 0.5 "
              "s, which its engine or its angle cannot follow; take shorter steps, or let "
              "the World do so (tolerance)"});
}

TEST_CASE("a supervisor says where a joint's island is unsolved, and which is the worst",
          "[world]") {
    std::vector<std::string> lines;
    Supervisor supervisor([&lines](const std::string& line) { lines.push_back(line); });
    Puppet post, beam;
    supervisor.add(&post, "post", post.ask());
    supervisor.add(&beam, "beam", beam.ask());
    post.says = {.outcome = Outcome::unreliable, .residual = 0.125};
    beam.says = {.outcome = Outcome::unreliable, .residual = 1e-9, .island_unsolved = 0.25};
    supervisor.open();
    supervisor.look(0.5);
    supervisor.close();
    CHECK(lines == std::vector<std::string>{
                       "ductile: joint \"beam\" hangs together with contacts or joints that were "
                       "left unsolved by the solver at t = 0.5 s (off by 0.25 m/s or rad/s), and 1 "
                       "other; take shorter steps, or let the World do so (tolerance); where "
                       "neither helps, look for bodies that are jammed"});
}

TEST_CASE("a supervisor has one line for all joints of a step, and another when they have doubled",
          "[world]") {
    std::vector<std::string> lines;
    Supervisor supervisor([&lines](const std::string& line) { lines.push_back(line); });
    std::vector<Puppet> joints(30);
    for (std::size_t i = 0; i < joints.size(); ++i) {
        supervisor.add(&joints[i], "joint " + std::to_string(i), joints[i].ask());
    }
    std::size_t told = 0;
    supervisor.on_event([&told](const JointEvent<double>&) { ++told; });
    const auto step = [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            joints[i].says = {.outcome = Outcome::unreliable,
                              .residual = 0.25 * double(1 + i * 7 % 30)};
        }
        supervisor.open();
        supervisor.look(supervisor.time() + 0.5);
        supervisor.close();
    };
    step(0, 10);
    REQUIRE(lines.size() == 1);
    CHECK(
        lines[0] ==
        "ductile: joint \"joint 4\" was left unsolved by the solver at t = 0.5 s (off by 7.25 m/s "
        "or rad/s), and 9 others; take shorter steps, or let the World do so (tolerance); where "
        "neither helps, look for joints that hold the same bodies against each other");
    step(10, 15);
    CHECK(lines.size() == 1);
    step(15, 20);
    REQUIRE(lines.size() == 2);
    CHECK(lines[1].find("joint \"joint 17\"") != std::string::npos);
    CHECK(lines[1].find(", and 19 others;") != std::string::npos);
    step(20, 30);
    CHECK(lines.size() == 2);
    CHECK(told == 30);
}

TEST_CASE("a supervisor warns once of steps that are too long", "[world]") {
    std::vector<std::string> lines;
    Supervisor supervisor([&lines](const std::string& line) { lines.push_back(line); });
    Puppet post;
    supervisor.add(&post, "post", post.ask());
    post.says = {.coarse = true, .plastic_travel = 1, .step_error = 0.125};
    for (const double time : {0.5, 0.75}) {
        supervisor.open();
        supervisor.look(time);
        supervisor.close();
    }
    CHECK(supervisor.watch().coarse_steps(0) == 2);
    CHECK(lines ==
          std::vector<std::string>{
              "ductile: joint \"post\" moved too much in the step that ended at t = 0.5 s: its "
              "plastic travel may be off by 12.5 %; take shorter steps, or let the World do so "
              "(tolerance)"});
}

TEST_CASE("what helps in a world with a tolerance is not to ask for one", "[world]") {
    const auto said = [](const JointReport<double>& report) {
        std::string all;
        Supervisor supervisor([&all](const std::string& line) { all += line; });
        supervisor.set_in_frames();
        Puppet post{report};
        supervisor.add(&post, "post", post.ask());
        supervisor.open();
        supervisor.look(0.5);
        supervisor.close();
        return all.substr(all.find("; ") + 2);
    };
    const std::string more = "give a frame more solves (budget), or take shorter frames";
    CHECK(said({.coarse = true, .plastic_travel = 1, .step_error = 0.125}) == more);
    CHECK(said({.outcome = Outcome::unreliable, .unseen_turn = 6.5}) == more);
    CHECK(said({.outcome = Outcome::unreliable, .gained = 1}) == more);
    CHECK(said({.outcome = Outcome::unreliable, .residual = 0.25}) ==
          "shorter frames do not help: look for joints that hold the same bodies against each "
          "other, or strengths more than 1e4 times apart");
    CHECK(said({.outcome = Outcome::unreliable, .residual = 0.1, .island_unsolved = 0.25}) ==
          "shorter frames do not help: look for bodies that are jammed, or masses more than 1e4 "
          "times apart");
    CHECK(said({.outcome = Outcome::unreliable,
                .residual = std::numeric_limits<double>::infinity()}) ==
          "look for what moved or pushed its bodies so");
}

TEST_CASE("a listener may remove any joint while all are asked", "[world]") {
    Supervisor supervisor(nullptr);
    Puppet first, second, third;
    for (Puppet* puppet : {&first, &second, &third}) {
        puppet->says = {.first_yield = true, .plastic_travel = 1};
        supervisor.add(puppet, "", puppet->ask());
    }
    std::vector<std::size_t> told;
    supervisor.on_event([&](const JointEvent<double>& event) {
        told.push_back(event.joint);
        supervisor.remove(&first);
        supervisor.remove(&second);
    });
    supervisor.open();
    supervisor.look(1);
    CHECK(told == std::vector<std::size_t>{0, 2});
    CHECK_FALSE(supervisor.knows(&first));
    CHECK(supervisor.knows(&third));
    CHECK(message_of([&] { supervisor.add(&third, "", third.ask()); }) ==
          "World.add.joint: must not be in the world already");
}

TEST_CASE("a listener that throws leaves the supervisor as good as before", "[world]") {
    Supervisor supervisor(nullptr);
    Puppet post;
    post.says = {.first_yield = true, .plastic_travel = 1};
    supervisor.add(&post, "post", post.ask());
    supervisor.on_event([](const JointEvent<double>&) { throw std::runtime_error("stop"); });
    supervisor.open();
    CHECK_THROWS_AS(supervisor.look(1), std::runtime_error);
    supervisor.remove(&post);
    CHECK_FALSE(supervisor.knows(&post));
}
