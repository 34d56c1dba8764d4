// SPDX-License-Identifier: MIT
//
// Two boxes end to end whose faces meet and which a plastic joint holds: it stands for the material
// between them, so that contacts there have no say until it breaks. Compiled for every engine and
// precision (RIG_HEADER), whose shapes and contacts are its own; nobody leaves these out but the
// World.
#include RIG_HEADER

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "adapters/thrown_arm.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Boxes of 7800 kg/m³ along z, from z = -length to 0 and on to length; `joint`: 400 MPa, for a
/// piece as long as it is thick.
struct Beam {
    double length, thickness, mass = 7800 * thickness * thickness * length;
    double inertia = mass * (length * length + thickness * thickness) / 12; ///< of one, about x
    WorldRig rig{false, 0.01, 256};
    WorldRig::Body lower = box(-1), upper = box(1);
    decltype(auto) joint_for(double largest, bool elastic) {
        const Material<double> steel({.density = 7800,
                                      .youngs_modulus = 200e9,
                                      .poisson_ratio = 0.3,
                                      .yield_stress = 400e6});
        const Rectangle<double> section({.width = thickness, .height = thickness});
        return rig.some_of(
            lower, upper, V3::Zero(), Eigen::Matrix3d::Identity(),
            section_joint(section, steel,
                          {.length = thickness, .largest_bending = largest, .elastic = elastic}),
            all_joint_axes);
    }
    [[nodiscard]] WorldRig::Body box(double side) {
        return rig.box(mass, V3(thickness / 2, thickness / 2, length / 2),
                       V3(0, 0, side * length / 2));
    }
    /// Each turns about the joint, by `spin` against the other's.
    void bend(double spin) {
        for (const auto& [body, w] : {std::pair{lower, -spin}, std::pair{upper, spin}}) {
            WorldRig::set_spin(body, V3(w, 0, 0));
            WorldRig::set_velocity(body, V3(0, -spin * length / 2, 0));
        }
    }
    void run(double duration, double frame) {
        while (rig.world().time() < duration - 1e-9) rig.world().step(frame);
    }
    [[nodiscard]] double contact() { return rig.world().ledger().booked(Account::contact); }
};

constexpr struct Size { double length, thickness; } sizes[] = {{0.5, 0.05}, {0.5, 0.1}, {2, 0.1}};

/// Boxes in a row on hinges that fall on a floor and between walls, in all directions.
struct Jam {
    std::string words;
    WorldRig rig{true, [this](const std::string& line) { words += line; }, false};

    explicit Jam(unsigned seed) {
        std::mt19937 random(seed);
        const auto between = [&random](double from, double to) {
            return from + (to - from) * double(random()) / double(std::mt19937::max());
        };
        const auto any = [&between](double most) {
            const double x = between(-most, most), y = between(-most, most);
            return V3(x, y, between(-most, most));
        };
        rig.set_gravity(V3(0, 0, -9.81));
        const int boxes = 2 + int(between(0, 3.99));
        const double gap = between(0, 0.03);
        const auto wall = [this](const V3& half, const V3& at) {
            WorldRig::prescribe(rig.box(1, half, at));
        };
        wall(V3(boxes, 1, 0.5), V3(boxes / 2.0, 0, -0.5));
        for (const double side : {-1.0, 1.0}) {
            wall(V3(boxes, 0.5, 1), V3(boxes / 2.0, side * (0.8 + gap), 0));
        }
        std::vector<WorldRig::Body> bodies;
        for (int i = 0; i < boxes; ++i) {
            const double mass = std::pow(10, between(0, 4));
            bodies.push_back(rig.box(mass, V3(0.5, 0.3, 0.3), V3(i, 0, 0.3 + gap)));
        }
        rig.set_friction(between(1, 4));
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            WorldRig::set_velocity(bodies[i], any(3));
            WorldRig::set_spin(bodies[i], any(2));
            if (i == 0) continue;
            const Perfect<double> law({.strength = std::pow(10, between(0, 3))});
            rig.hinge(bodies[i], bodies[i - 1], V3(double(i) - 0.5, 0, 0.3 + gap),
                      Joint(law, TravelLimit<double>()), "");
        }
        for (int i = 0; i < 10; ++i) rig.world().step(1.0 / 60);
    }
};

} // namespace

TEST_CASE("Joints whose own rows are met are unreliable where a contact is left unsolved",
          "[world]") {
    // one in ten such worlds, heavy and rough, jams beyond what the solver can do
    bool told = false;
    for (unsigned seed = 1; seed <= 100 && !told; ++seed) {
        told = Jam(seed).words.find("hangs together with contacts") != std::string::npos;
    }
    CHECK(told);
}

TEST_CASE("Frames: boxes whose faces meet bend as their joint has it", "[frame]") {
    for (const Size& size : sizes) {
        for (const double speed : {5.0, 20.0}) {
            CAPTURE(size.length, size.thickness, speed);
            const double spin = speed / size.length;
            Beam beam{size.length, size.thickness};
            const auto& joint = beam.joint_for(unlimited, false);
            beam.bend(spin);
            beam.run(0.3, 1.0 / 60);
            CHECK(joint.absorbed_energy() == Approx(beam.inertia * spin * spin).epsilon(0.01));
            CHECK(beam.contact() == 0);
            CHECK(beam.rig.world().run().believed());
        }
    }
}

TEST_CASE("Frames: boxes whose faces meet are thrown as their joint has it", "[frame]") {
    for (const Size& size : sizes) {
        for (const double speed : {2.0, 10.0}) {
            CAPTURE(size.length, size.thickness, speed);
            Beam beam{size.length, size.thickness};
            const auto& joint = beam.joint_for(unlimited, false);
            WorldRig::set_velocity(beam.upper, V3(0, speed, 0));
            beam.run(0.3, 1.0 / 60);
            // both go on as one: half the speed, and what they have about their common centre
            const double both = 2 * beam.inertia + beam.mass * size.length * size.length / 2;
            const double angular = beam.mass * speed * size.length / 2;
            const double after = beam.mass * speed * speed / 4 + angular * angular / (2 * both);
            CHECK(joint.absorbed_energy() ==
                  Approx(beam.mass * speed * speed / 2 - after).epsilon(0.01));
            CHECK(beam.contact() == 0);
            CHECK(beam.rig.world().run().believed());
        }
    }
}

TEST_CASE("Frames: elastic boxes whose faces meet do not touch either", "[frame]") {
    for (const Size& size : sizes) {
        CAPTURE(size.length, size.thickness);
        Beam beam{size.length, size.thickness};
        const auto& joint = beam.joint_for(unlimited, true);
        beam.bend(20 / size.length);
        beam.run(0.3, 1.0 / 60);
        CHECK(beam.contact() == 0);
        CHECK(joint.absorbed_energy() > 0);
        CHECK(std::isfinite(beam.rig.world().ledger().held().total()));
    }
}

TEST_CASE("Frames: halves that overlap as their joint breaks collide, and win next to nothing",
          "[frame]") {
    // bent by 0.3 rad about their middle, they lie 1.5 cm in each other
    constexpr double largest = 0.3, length = 0.5, thickness = 0.1;
    const double moment = 400e6 * std::pow(thickness, 3) / 4;
    for (const double more : {1.001, 1.1}) {
        CAPTURE(more);
        Beam beam{length, thickness};
        const auto& joint = beam.joint_for(largest, false);
        const double energy = moment * largest * more;
        beam.bend(std::sqrt(energy / beam.inertia));
        beam.run(1, 1.0 / 60);
        REQUIRE(joint.broken());
        CHECK(joint.absorbed_energy() == Approx(moment * largest).epsilon(0.01));
        const double left = energy - joint.absorbed_energy();
        CHECK(beam.contact() > -5e-3 * energy); // of ODE; Bullet -1e-5
        CHECK(beam.contact() < std::max(left, 1e-3 * energy));
        if (more > 1.05) CHECK(beam.contact() > left / 50); // they go on closing
        CHECK(beam.rig.world().run().believed());
    }
}

TEST_CASE("Frames: bodies that overlap come apart, in short frames no faster", "[frame]") {
    const auto apart = [](double depth, bool jointed, double frame) {
        WorldRig rig{false, 0.01, 256};
        const V3 half(0.5, 0.5, 0.5);
        const WorldRig::Body lower = rig.box(8000, half, V3(0, 0, 0));
        const WorldRig::Body upper = rig.box(8000, half, V3(0, 0, 1 - depth));
        if (jointed) {
            const WorldRig::Body on = rig.body(80, V3(8, 8, 8), V3(0, 0, 3));
            const Perfect<double> strong({.strength = 1e9});
            rig.hinge(on, upper, V3(0, 0, 2), Joint(strong, TravelLimit<double>()), "on");
        }
        while (rig.world().time() < 2) rig.world().step(frame);
        CHECK(std::abs(rig.world().ledger().booked(Account::joints)) < 1);
        CHECK((WorldRig::position(upper) - WorldRig::position(lower)).z() > 0.995);
        return (WorldRig::velocity(upper) - WorldRig::velocity(lower)).z();
    };
    for (const double depth : {0.02, 0.2}) { // beyond 0.04 Bullet alone pushes without a velocity
        CAPTURE(depth);
        const double usual = apart(depth, true, 1.0 / 60);
        CHECK(apart(depth, true, 1.0 / 240) <= 1.25 * usual + 1e-6);
        CHECK(apart(depth, true, 1.0 / 1000) <= 1.25 * usual + 1e-6);
        (void)apart(depth, false, 1.0 / 60); // without a joint the engine's own, but half ahead
    }
}

TEST_CASE("Frames: a box that flies by the edge of a post strikes what it meets of it", "[frame]") {
    // by 25 mm of a side, as wide as both shapes are rounded in Bullet's closest points
    constexpr double half = 0.091, of_box = 0.164, overlap = 0.025, ahead = 0.0033;
    const V3 velocity(4.03, 9.4, 0);
    const auto work = [&](double frame) {
        WorldRig rig(false, 0.01, 256);
        const auto post = rig.box(60, V3(half, half, 1.47), V3(0, 0, 1.5));
        Eigen::Matrix<double, 6, 1> capacity;
        capacity << 4e5, 4e5, 7e5, 2e4, 2e4, 1.6e4;
        const auto& joint = rig.six_axes(post, V3::Zero(),
                                         SixAxes(Ellipsoid<double, 6>({.capacity = capacity}),
                                                 Perfect<double>({.strength = 2e4})));
        const double apart = half + of_box;
        const auto box = rig.box(
            39, V3(of_box, of_box, of_box),
            V3(-apart - velocity.x() * ahead, -apart + overlap - velocity.y() * ahead, 1.618));
        WorldRig::set_velocity(box, velocity);
        while (rig.world().time() < 1.0 / 15 - 1e-9) rig.world().step(frame);
        return joint.absorbed_energy();
    };
    const double fine = work(1.0 / 960);
    CHECK(fine > 100);
    for (const double frame : {1.0 / 240, 1.0 / 60, 1.0 / 30}) {
        CAPTURE(frame);
        CHECK(work(frame) == Approx(fine).epsilon(0.03));
    }
}

TEST_CASE("Frames: a ball that pushes a bar which turns with it gives it all of its energy",
          "[frame]") {
    // Without friction a contact takes energy of the blow alone: m v²/2 /(1 + m d²/I). The bar lies
    // along x and turns about its end; where they touch runs round the ball, faster than both move.
    // Taken as another contact each time it cost 6 J more, of 449 J, at any frame.
    constexpr double mass = 60, radius = 2, at = 0.4, speed = 6, strength = 900, half = 0.05;
    constexpr double bar_mass = 40, length = 1;
    const double inertia = bar_mass * (length * length / 3 + half * half / 3);
    const double energy = mass * speed * speed / 2;
    const double blow = energy / (1 + mass * at * at / inertia);
    for (const double frame : {1.0 / 240, 1.0 / 60, 1.0 / 30}) {
        CAPTURE(frame);
        WorldRig rig(false, 0.01, 256);
        const auto bar = rig.box(bar_mass, V3(length / 2, half, half), V3(length / 2, 0, 0));
        const Joint law(Perfect<double>({.strength = strength}), TravelLimit<double>());
        rig.hinge(bar, nullptr, V3::Zero(), law, "hinge");
        const auto ball = rig.ball(mass, radius, V3(at, half + radius + 0.01, 0));
        WorldRig::set_velocity(ball, V3(0, -speed, 0));
        while (rig.world().time() < 0.3) rig.world().step(frame);
        const double contact = rig.world().ledger().booked(Account::contact);
        CHECK(contact == Approx(blow).margin(WorldRig::single ? 2 : 1));
        CHECK(rig.world().run().believed());
    }
}

TEST_CASE("Frames: an arm that lies on its pivot slaps the floor with its other end", "[frame]") {
    // thrown up about its lower edge, it takes R θ on its way up and as much on its way down, where
    // its weight goes on turning it; the edge touches all the time
    constexpr double mass = ThrownArm::mass, length = ThrownArm::length, half = ThrownArm::half,
                     strength = ThrownArm::strength, g = ThrownArm::g, spin = ThrownArm::spin;
    for (const double frame : {1.0 / 240, 1.0 / 60, 1.0 / 30}) {
        CAPTURE(frame);
        WorldRig rig(false, 0.01, 256);
        rig.set_gravity(V3(0, -g, 0));
        WorldRig::prescribe(rig.box(1, V3(2, 0.5, 1), V3(0, -0.5, 0)));
        const auto arm = rig.box(mass, V3(length / 2, half, half), V3(length / 2, half, 0));
        const Joint law(Perfect<double>({.strength = strength}), TravelLimit<double>());
        const auto& hinge = rig.hinge(arm, nullptr, V3::Zero(), law, "edge");
        WorldRig::set_spin(arm, V3(0, 0, spin));
        WorldRig::set_velocity(arm, V3(-half * spin, length / 2 * spin, 0));
        while (rig.world().time() < 1 - 1e-9) rig.world().step(frame);
        CHECK(hinge.absorbed_energy() == Approx(ThrownArm::work()).epsilon(0.01));
        CHECK(rig.world().run().believed());
    }
}

TEST_CASE("Frames: bars on a hinge that fall and slap a floor take the same at any frame",
          "[frame]") {
    // One lands on its end, and stands on it as it slaps with the other; what then touches in
    // between goes on doing so while the second one slaps.
    constexpr double mass = 4, length = 0.5, half = 0.05, g = 9.81, spin = 1.5;
    const auto work = [&](double strength, double frame) {
        WorldRig rig(false, 0.01, 256);
        rig.set_gravity(V3(0, -g, 0));
        WorldRig::prescribe(rig.box(1, V3(3, 0.5, 1), V3(0, -0.5, 0)));
        const auto bar = [&](double side) {
            const auto body =
                rig.box(mass, V3(length / 2, half, half), V3(side * length / 2, 0.6, 0));
            WorldRig::set_spin(body, V3(0, 0, spin));
            WorldRig::set_velocity(body, V3(0, spin * side * length / 2, 0));
            return body;
        };
        const auto left = bar(-1), right = bar(1);
        const Joint law(Perfect<double>({.strength = strength}), TravelLimit<double>());
        const auto& hinge = rig.hinge(left, right, V3(0, 0.6, 0), law, "middle");
        while (rig.world().time() < 0.6 - 1e-9) rig.world().step(frame);
        CHECK(rig.world().run().believed());
        return hinge.absorbed_energy();
    };
    for (const double strength : {20.0, 50.0, 100.0}) {
        const double fine = work(strength, 1.0 / 1000);
        for (const double frame : {1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30}) {
            CAPTURE(strength, frame);
            CHECK(work(strength, frame) == Approx(fine).epsilon(0.02));
        }
    }
}
