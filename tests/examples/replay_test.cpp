// SPDX-License-Identifier: MIT
//
// The recorder and its files: a rotor of 2 kg m² at 10 rad/s whose bar of 64 N m breaks at 1.5 rad,
// after 96 J. What it writes into the working directory, the page's own tests read
// (examples/replay/page/test).
#include <ode/ode.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "ductile/fracture/travel_limit.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/ode.hpp"
#include "files.hpp"
#include "joint_facts.hpp"
#include "of_ode.hpp"
#include "packed.hpp"
#include "recorder.hpp"
#include "write_glb.hpp"
#include "write_html.hpp"

using namespace ductile;

namespace {

using BreakingHinge = ode::PlasticHinge<OneAxisJoint<Perfect<double>, TravelLimit<double>>>;

struct Rotor {
    Rotor() {
        dMass mass;
        dMassSetParameters(&mass, 24, 0, 0, 0, 1.6, 1.6, 2, 0, 0, 0);
        dBodySetMass(body, &mass);
        dBodySetAngularVel(body, 0, 0, 10);
        dGeomSetBody(box, body);
        bar.emplace(
            engine, body, nullptr, ode::HingeFrame{.axis = {0, 0, 1}},
            OneAxisJoint(Perfect<double>({.strength = 64}), TravelLimit<double>({.limit = 1.5})));
        world.add(body);
        world.add(*bar, "bar");
    }
    ~Rotor() {
        bar.reset();
        dSpaceDestroy(space);
        dWorldDestroy(engine);
    }
    Rotor(const Rotor&) = delete;
    Rotor& operator=(const Rotor&) = delete;

    struct Library {
        Library() { dInitODE(); }
        ~Library() { dCloseODE(); }
    } library;
    dWorldID engine = dWorldCreate();
    dSpaceID space = dSimpleSpaceCreate(nullptr);
    dBodyID body = dBodyCreate(engine);
    dGeomID box = dCreateBox(space, 1, 0.2, 0.1), floor = dCreatePlane(space, 0, 0, 1, -0.5);
    ode::World world{engine, ode::WorldParameters{}};
    std::optional<BreakingHinge> bar;
};

replay::Recording record(Rotor& rotor, double rate, double seconds) {
    replay::Recorder recorder({.name = "rotor",
                               .about = "A bar of 64 N m breaks at 1.5 rad, after 96 J.",
                               .engine = "ode",
                               .rate = rate});
    replay::add_body(recorder, rotor.body, "rotor");
    replay::add_ground(recorder, rotor.floor, "floor");
    replay::add_joint(recorder, *rotor.bar, "bar", {0, 0, 0},
                      replay::facts_of(rotor.bar->joint(), true, {{"strength", "64 N m"}}),
                      replay::life_used(*rotor.bar));
    while (rotor.world.time() < seconds - 1e-9) {
        rotor.world.step(1.0 / 240);
        recorder.look(rotor.world);
    }
    return recorder.finish();
}

} // namespace

TEST_CASE("replay: what is recorded is what happened", "[replay]") {
    Rotor rotor;
    const replay::Recording seen = record(rotor, 60, 0.5);
    REQUIRE(seen.times.size() == 31); // the first step, and one each 1/60 s
    CHECK(seen.times.front() == Approx(1.0 / 240));
    CHECK(seen.times.back() == Approx(0.5));
    REQUIRE(seen.joints.size() == 1);
    const replay::JointSamples& bar = seen.samples[0];
    CHECK(bar.absorbed.back() == Approx(96).epsilon(1e-9));
    CHECK(bar.plastic_travel.back() == Approx(1.5).epsilon(1e-9));
    CHECK(bar.state.back() == (replay::flowed | replay::broken));
    CHECK(std::abs(bar.curves.at(0).force[1]) == Approx(64));
    CHECK(bar.curves.at(0).turns);
    REQUIRE(bar.life.size() == seen.times.size());
    CHECK(bar.life.back() == 1);
    CHECK(bar.life[3] == Approx(bar.plastic_travel[3] / 1.5));
    const std::vector<replay::Fact> facts{
        {"strength", "64 N m"}, {"capacity", "64 N m"}, {"breaks at", "1.5 rad"}};
    CHECK(seen.joints[0].facts == facts);
    REQUIRE(seen.events.size() == 2);
    CHECK(seen.events[0].kind == "yielded");
    CHECK(seen.events[1].kind == "broke");
    CHECK(seen.events[1].joint == 0);
    CHECK(seen.events[1].energy == Approx(96).epsilon(1e-9));
    double total = 0;
    for (const auto& [name, column] : seen.energies) {
        if (name == "kinetic" || name == "plastic") total += column.back();
    }
    CHECK(total == Approx(100).epsilon(1e-6));
    CHECK(seen.poses[0].size() == seen.times.size());
    CHECK(seen.poses[1].size() == 1);

    // for the page's tests
    replay::write_html(seen, "replay_rotor.html");
    replay::write_glb(seen, "replay_rotor.glb");
    nlohmann::json expected{{"times", seen.times},
                            {"absorbed", bar.absorbed},
                            {"force", bar.curves.at(0).force},
                            {"position", bar.curves.at(0).position},
                            {"broke", seen.events[1].time},
                            {"energies", nlohmann::json::object()},
                            {"turn", nlohmann::json::array()}};
    for (const auto& [name, column] : seen.energies) expected["energies"][name] = column;
    for (const replay::Pose& pose : seen.poses[0]) expected["turn"].push_back(pose.turn);
    std::ofstream("replay_rotor.json") << expected;
    CHECK(std::filesystem::file_size("replay_rotor.html") < 2'000'000);
}

TEST_CASE("replay: two runs have the same hashes, another has not", "[replay]") {
    Rotor first, second, other;
    dBodySetAngularVel(other.body, 0, 0, std::nextafter(10.0, 11.0));
    const auto a = record(first, 60, 0.1), b = record(second, 60, 0.1), c = record(other, 60, 0.1);
    CHECK(a.hashes == b.hashes);
    CHECK(a.hashes != c.hashes);
    CHECK(replay::pack(a) == replay::pack(b));
}

TEST_CASE("replay: a minute of 200 bodies takes less than half a megabyte", "[replay]") {
    // thrown, they bounce, roll, and rest after 10 to 20 s: z = h |cos ωt| exp(-t/τ)
    constexpr std::size_t bodies = 200, rate = 30, seconds = 60;
    replay::Recording thrown;
    for (std::size_t k = 0; k < rate * seconds; ++k) thrown.times.push_back(double(k) / rate);
    thrown.hashes.resize(thrown.times.size());
    for (std::size_t i = 0; i < bodies; ++i) {
        const double decay = 2 + 0.01 * double(i), height = 1 + 0.05 * double(i);
        thrown.bodies.emplace_back().name = "box " + std::to_string(i);
        std::vector<replay::Pose>& poses = thrown.poses.emplace_back();
        for (std::size_t k = 0; k < thrown.times.size(); ++k) {
            const double time = thrown.times[k], left = std::exp(-time / decay);
            const double turn = 3 * (1 - left), lively = left > 1e-4 ? left : 0;
            poses.push_back(
                {.position = {double(i) + 5 * turn, turn,
                              height * std::abs(std::cos(5 * time)) * lively},
                 .turn = {std::cos(turn), 0.6 * std::sin(turn), 0, 0.8 * std::sin(turn)}});
            thrown.hashes[k] = std::uint32_t(k * 2654435761u);
        }
    }
    const std::size_t size = replay::pack(thrown).size();
    CAPTURE(size);
    CHECK(size < 500'000);
    CHECK(size > 50'000); // they move
}

TEST_CASE("replay: a minute of 200 jointed bodies takes less than half a megabyte", "[replay]") {
    // 20 posts of ten rods, hit every 2 s: they yield, swing at 1 Hz and more, and come to rest;
    // their certificates are round-off
    constexpr std::size_t bodies = 200, rate = 30, seconds = 60;
    replay::Recording posts;
    for (std::size_t k = 0; k < rate * seconds; ++k) posts.times.push_back(double(k) / rate);
    for (std::size_t k = 0; k < rate * seconds; ++k) {
        posts.hashes.push_back(std::uint32_t(k * 2654435761u));
    }
    posts.energies.emplace_back("kinetic", std::vector<double>(rate * seconds));
    std::uint32_t any = 1;
    for (std::size_t i = 0; i < bodies; ++i) {
        const double hit = 2 * double(i / 10), up = double(i % 10 + 1) / 10;
        posts.bodies.emplace_back().name = "rod " + std::to_string(i);
        posts.joints.push_back({.name = "joint " + std::to_string(i),
                                .a = int(i),
                                .b = i % 10 == 0 ? -1 : int(i) - 1,
                                .in_a = {0, 0, -0.2 - 1e-9 * double(i)},
                                .facts = {{"capacity", "19.6 kN m"}}});
        std::vector<replay::Pose>& poses = posts.poses.emplace_back();
        replay::JointSamples& joint = posts.samples.emplace_back();
        replay::Curve curve;
        curve.axis = "bending x";
        for (const double time : posts.times) {
            const double since = std::max(time - hit, 0.0), bent = 0.1 * std::min(since, 0.3);
            const double swing = std::exp(-since) * std::sin(7 * since + 2 * std::sin(18 * since));
            const double turn = up * (bent + 0.02 * swing);
            poses.push_back(
                {.position = {double(i / 10) + 2 * up * turn, 0, 4 * up * std::cos(turn)},
                 .turn = {std::cos(turn / 2), 0, std::sin(turn / 2), 0}});
            const double force = 19e3 * (1 - up) * swing;
            any = any * 1664525u + 1013904223u;
            joint.utilisation.push_back(std::abs(force) / 19.6e3);
            joint.plastic_travel.push_back(i % 10 == 0 ? bent : 0);
            joint.absorbed.push_back(19.6e3 * joint.plastic_travel.back());
            joint.residual.push_back(1e-19 * any);
            joint.state.push_back(joint.plastic_travel.back() > 0 ? replay::flowed : replay::holds);
            joint.life.push_back(std::numeric_limits<double>::quiet_NaN());
            curve.force.push_back(force);
            curve.position.push_back(force / 1e6 + joint.plastic_travel.back());
        }
        joint.curves.push_back(curve);
    }
    const std::size_t size = replay::pack(posts).size();
    CAPTURE(size);
    CHECK(size < 500'000);
    CHECK(size > 50'000); // they move
}

TEST_CASE("replay: bodies and joints that come late or go are kept", "[replay]") {
    Rotor rotor;
    replay::Recorder recorder({.name = "late", .about = "", .engine = "ode", .rate = 240});
    replay::add_body(recorder, rotor.body, "rotor");
    const auto step = [&] {
        rotor.world.step(1.0 / 240);
        recorder.look(rotor.world);
    };
    step();
    replay::add_joint(recorder, *rotor.bar, "bar", {0, 0, 0});
    step();
    recorder.remove(rotor.bar->queries());
    recorder.remove(rotor.body);
    step();
    const replay::Recording seen = recorder.finish();
    REQUIRE(seen.times.size() == 3);
    CHECK(seen.samples[0].utilisation[0] == 0);
    CHECK(seen.samples[0].utilisation[1] == Approx(1));
    CHECK(seen.samples[0].utilisation[2] == 0);
    CHECK(seen.poses[0][2].turn == seen.poses[0][1].turn);
}

TEST_CASE("replay: bad input is one clear line, and nothing is half-written", "[replay]") {
    using Catch::Contains;
    CHECK_THROWS_WITH(replay::Recorder({.name = "x", .about = "", .engine = "", .rate = 0}),
                      Contains("Recorder.rate") && Contains("positive"));
    const replay::Recorder empty({.name = "x", .about = "", .engine = "", .rate = 60});
    CHECK_THROWS_WITH(empty.finish(), Contains("no body"));
    Rotor rotor;
    replay::Recorder twice({.name = "x", .about = "", .engine = "", .rate = 60});
    replay::add_body(twice, rotor.body, "rotor");
    CHECK_THROWS_WITH(replay::add_body(twice, rotor.body, "rotor"), Contains("already"));
    CHECK_THROWS_WITH(twice.finish(), Contains("nothing was sampled"));

    replay::Recording seen = record(rotor, 60, 0.1);
    CHECK_THROWS_WITH(replay::write_html(seen, "no/such/folder/x.html"), Contains("cannot write"));
    CHECK_THROWS_WITH(replay::write_glb(seen, "no/such/folder/x.glb"), Contains("cannot write"));
    CHECK_THROWS_WITH(replay::write_html(seen, "x.html", "replay_rotor.json"), Contains("page"));
    CHECK_FALSE(std::filesystem::exists("x.html"));
    // a body that is lost to infinity is recorded as such
    seen.poses[0].back().position[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK_NOTHROW(replay::pack(seen));
    replay::write_glb(seen, "replay_lost.glb"); // valid glTF all the same
    for (const auto column : {&replay::JointSamples::absorbed, &replay::JointSamples::life}) {
        replay::Recording cut = seen;
        (cut.samples[0].*column).pop_back();
        CHECK_THROWS_WITH(replay::pack(cut), Contains("\"bar\""));
    }
    seen.bodies[0].name = "\xff"; // replaced in the page
    CHECK_NOTHROW(replay::pack(seen));
    CHECK_THROWS_AS(replay::write_glb(seen, "x.glb"), replay::Error);
    CHECK_FALSE(std::filesystem::exists("x.glb"));
    // a folder where the file should be
    std::filesystem::create_directory("replay_folder.html");
    const replay::Recording more = record(rotor, 60, 0.2);
    CHECK_THROWS_WITH(replay::write_html(more, "replay_folder.html"),
                      Contains("cannot write replay_folder.html"));
    CHECK_FALSE(std::filesystem::exists("replay_folder.html.part"));
    // a pipe, or a device: what is renamed onto it takes its place
    REQUIRE(mkfifo("replay_pipe.glb", 0600) == 0);
    CHECK_THROWS_WITH(replay::write_glb(more, "replay_pipe.glb"),
                      Contains("cannot write replay_pipe.glb"));
    CHECK(std::filesystem::is_fifo("replay_pipe.glb"));
    std::filesystem::remove("replay_pipe.glb");
}
