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

struct Scribe final : SteppedWorld {
    explicit Scribe(bool ledger = false)
        : SteppedWorld([this](const std::string& line) { warned.push_back(line); }),
          ledger_kept(ledger) {
        supervisor().add(this, "joint", [] { return JointReport<double>{}; });
    }

    std::vector<std::string> said() { return std::exchange(lines, {}); }

    void require_possible(double dt) override {
        if (dt < shortest) throw std::invalid_argument("too short");
    }
    void do_step(double dt) override {
        lines.push_back("step " + std::to_string(int(dt * 1000 + 0.5)) + " ms");
    }
    [[nodiscard]] bool has_body(const void*) const override { return false; }
    [[nodiscard]] const Ledger<double>* kept_ledger() const noexcept override {
        return ledger_kept ? &book : nullptr;
    }

    std::vector<std::string> lines, warned;
    Ledger<double> book;
    double shortest = 0;
    bool ledger_kept;
};

using Lines = std::vector<std::string>;

} // namespace

TEST_CASE("a step moves the clock", "[world]") {
    Scribe world;
    world.step(0.01);
    CHECK(world.said() == Lines{"step 10 ms"});
    CHECK(world.time() == 0.01);
}

TEST_CASE("a step that cannot be is refused and nothing has moved", "[world]") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Scribe world;
    for (const double dt : {0.0, -1.0, infinity, std::nan("")}) {
        CHECK_THROWS_AS(world.step(dt), std::invalid_argument);
    }
    CHECK(message_of([&] { world.step(-1); }) == "World.step.dt = -1 s: must be finite and > 0");
    world.shortest = 0.1;
    CHECK_THROWS_AS(world.step(0.01), std::invalid_argument);
    CHECK(world.said().empty());
    CHECK(world.time() == 0);
}

TEST_CASE("a ledger that is not kept cannot be read", "[world]") {
    CHECK_THROWS_AS(Scribe().ledger(), std::logic_error);
    Scribe kept(true);
    CHECK(&kept.ledger() == &kept.book);
}

TEST_CASE("a ledger that is no number is told, once", "[world]") {
    Scribe world(true);
    world.step(0.01);
    CHECK(world.warned.empty());
    world.book.supply(std::nan(""));
    for (int i = 0; i < 3; ++i) world.step(0.01);
    REQUIRE(world.warned.size() == 1);
    CHECK(world.warned[0].find("is no number from t = 0.02 s on") != std::string::npos);
}
