// SPDX-License-Identifier: MIT
//
// The course of a step, with an engine that only writes down what it is asked for.
#include "ductile/world/stepped_world.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

/// Its one joint is left unsolved for as long as `unsolved` says so.
struct Scribe final : SteppedWorld {
    explicit Scribe(const EffortParameters& effort = {}, bool leapfrog = false, bool ledger = false)
        : SteppedWorld(effort, nullptr), ledger_kept(ledger) {
        supervisor().add(this, "joint", [this] {
            JointReport<double> report;
            if (unsolved) report.outcome = Outcome::unreliable;
            return report;
        });
        if (leapfrog) start_leapfrog();
    }

    std::vector<std::string> said() { return std::exchange(lines, {}); }

    void require_possible(double dt) override {
        if (dt < shortest) throw std::invalid_argument("too short");
    }
    void do_part(double dt, const ForceShare& share, const Effort& effort) override {
        if (fails) throw std::runtime_error("engine");
        lines.push_back("part " + std::to_string(int(dt * 1000 + 0.5)) + " ms, share " +
                        std::to_string(int(share.value * 100 + 0.5)) + " %" +
                        (share.midway ? ", midway" : "") + (effort.direct ? ", direct" : "") +
                        ", " + std::to_string(iterations_now) + " iterations");
    }
    void hold_forces() override { lines.emplace_back("hold"); }
    void apply_held_forces() override { lines.emplace_back("apply"); }
    [[nodiscard]] int iterations() const override { return iterations_now; }
    void set_iterations(int n) override { iterations_now = n; }
    void suspect(const void* joint) override {
        lines.emplace_back(joint == this ? "suspect" : "?");
    }
    void finish(const Effort& effort) override {
        lines.push_back("finish, next " + std::to_string(effort.parts) + " parts");
    }
    [[nodiscard]] bool has_body(const void*) const override { return false; }
    [[nodiscard]] const Ledger<double>* kept_ledger() const noexcept override {
        return ledger_kept ? &book : nullptr;
    }

    std::vector<std::string> lines;
    Ledger<double> book;
    int iterations_now = 10;
    double shortest = 0;
    bool unsolved = false, fails = false, ledger_kept;
};

using Lines = std::vector<std::string>;

} // namespace

TEST_CASE("a step is one part and moves the clock", "[world]") {
    Scribe world;
    world.step(0.01);
    CHECK(world.said() == Lines{"part 10 ms, share 100 %, 10 iterations", "finish, next 1 parts"});
    CHECK(world.time() == 0.01);
    CHECK(world.last_step() == 0); // it does not leapfrog
}

TEST_CASE("a split step applies its forces again for each further part", "[world]") {
    Scribe world({.action = OnUnconverged::split_step, .most_parts = 2});
    world.unsolved = true;
    world.step(0.01);
    CHECK(world.said() ==
          Lines{"part 10 ms, share 100 %, 10 iterations", "suspect", "finish, next 2 parts"});
    CHECK(world.events().size() == 1);
    world.step(0.01);
    CHECK(world.said() == Lines{"hold", "part 5 ms, share 100 %, 10 iterations", "suspect", "apply",
                                "part 5 ms, share 100 %, 10 iterations", "suspect",
                                "finish, next 2 parts"});
    CHECK(world.time() == 0.02);
}

TEST_CASE("iterations are raised for the step alone, also where it throws", "[world]") {
    Scribe world({.action = OnUnconverged::raise_iterations});
    world.unsolved = true;
    world.step(0.01);
    world.said();
    world.unsolved = false;
    world.step(0.01);
    CHECK(world.said() == Lines{"part 10 ms, share 100 %, 20 iterations", "finish, next 1 parts"});
    CHECK(world.iterations_now == 10);
    world.fails = true;
    CHECK_THROWS_AS(world.step(0.01), std::runtime_error);
    CHECK(world.iterations_now == 10);
}

TEST_CASE("a direct solver is asked for by name", "[world]") {
    Scribe world({.action = OnUnconverged::direct_solver});
    world.unsolved = true;
    world.step(0.01);
    world.said();
    world.step(0.01);
    CHECK(world.said().front() == "part 10 ms, share 100 %, direct, 10 iterations");
}

TEST_CASE("each part of a step that leapfrogs has its share", "[world]") {
    Scribe world({}, true);
    world.step(0.01);
    world.step(0.02);
    CHECK(world.last_step() == 0.02);
    world.step(0.02);
    world.restart();
    CHECK(world.last_step() == 0);
    world.step(0.02);
    world.resume(0.01);
    world.step(0.01);
    Lines shares;
    for (const std::string& line : world.said()) {
        if (line.starts_with("part")) shares.push_back(line.substr(line.find("share")));
    }
    CHECK(shares == Lines{"share 50 %, midway, 10 iterations", "share 75 %, midway, 10 iterations",
                          "share 100 %, midway, 10 iterations", "share 50 %, midway, 10 iterations",
                          "share 100 %, midway, 10 iterations"});
}

TEST_CASE("a step that cannot be is refused and nothing has moved", "[world]") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Scribe world({}, true);
    for (const double dt : {0.0, -1.0, infinity, std::nan("")}) {
        CHECK_THROWS_AS(world.step(dt), std::invalid_argument);
    }
    CHECK(message_of([&] { world.step(-1); }) == "World.step.dt = -1 s: must be finite and > 0");
    world.shortest = 0.1;
    CHECK_THROWS_AS(world.step(0.01), std::invalid_argument);
    CHECK_THROWS_AS(world.resume(-1), std::invalid_argument);
    CHECK(world.said().empty());
    CHECK(world.time() == 0);
    CHECK(world.last_step() == 0);
}

TEST_CASE("a ledger that is not kept cannot be read", "[world]") {
    CHECK_THROWS_AS(Scribe().ledger(), std::logic_error);
    Scribe kept({}, false, true);
    CHECK(&kept.ledger() == &kept.book);
}
