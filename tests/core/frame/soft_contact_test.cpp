// SPDX-License-Identifier: MIT
//
// Contacts that give way, as a part of a frame has them.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "ductile/frame/soft_contact.hpp"

namespace {

using ductile::OwnForces;
using ductile::SoftContact;

constexpr double pi = std::numbers::pi;

/// Speed at which a mass leaves that comes at 1 m/s, in parts of `h` [s].
double rebound(const SoftContact& contact, double h) {
    double at = 0, speed = -1; // [m], [m/s]
    do {
        at += h / 2 * speed;
        const ductile::LawRow row = contact.row(-at, speed, h);
        // u' + C λ = b, u' = u + λ/m
        const double impulse =
            std::max(0.0, (row.target - speed) / (row.compliance + 1 / contact.mass));
        speed += impulse / contact.mass;
        at += h / 2 * speed;
    } while (at < 0);
    return speed;
}

} // namespace

TEST_CASE("SoftContact: a spring sends back what it takes, a damper what it leaves of it",
          "[frame]") {
    constexpr double mass = 5, stiffness = 1e5;
    const double frequency = std::sqrt(stiffness / mass);
    for (const double share : {0.0, 0.1, 0.5}) { // of critical damping
        const SoftContact contact(stiffness, 2 * share * mass * frequency, 1 / mass, 0);
        // it pushes until k x + d x' = 0, at the angle of 2 ζ √(1 - ζ²) over 2 ζ² - 1
        const double damped = std::sqrt(1 - share * share);
        const double angle = std::atan2(2 * share * damped, 2 * share * share - 1);
        const double end = share > 0 ? std::exp(-share / damped * angle) : 1;
        CAPTURE(share);
        CHECK(rebound(contact, 0.01 / frequency) == Approx(end).epsilon(0.01));
    }
}

TEST_CASE("SoftContact: what is too fast for a part gains no energy in it", "[frame]") {
    for (const double stiffness : {1e5, 1e7, 1e9}) {
        for (const double overlap : {0.0, 1e-4, 1e-2}) {
            constexpr double mass = 5, h = 1.0 / 60;
            const SoftContact contact(stiffness, 0, 1 / mass, 0);
            const ductile::LawRow row = contact.row(overlap, 0, h);
            const double speed = row.target / (1 + mass * row.compliance);
            CAPTURE(stiffness, overlap);
            CHECK(mass * speed * speed / 2 <= stiffness * overlap * overlap / 2 + 1e-12);
            CHECK(speed * h / 2 <= overlap + 1e-12);
        }
    }
}

TEST_CASE("SoftContact: hard is what stops all at once and sends nothing back", "[frame]") {
    constexpr double frame = 1.0 / 60, mass = 10;
    const auto is_hard = [](double stiffness, double damping) {
        return SoftContact(stiffness, damping, 1 / mass, 0).is_hard(frame);
    };
    CHECK(is_hard(1e3, 1e8));
    CHECK(!is_hard(1e3, 1e5)); // it takes a tenth of a millisecond
    CHECK(!is_hard(1e8, 1e2)); // it sends all back, in a millisecond
    CHECK(is_hard(1e10, 1e2)); // no step of the frame would
    // what the light one hangs on may hold it
    CHECK(!SoftContact(1e7, 5e3, 1, 0.1).is_hard(frame));
}

TEST_CASE("SoftContact: what is hard in a frame of 1/30 s is hard in shorter ones", "[frame]") {
    for (const double mass : {1e2, 1e5}) { // by ODE's own settings it stops in 10 us at most
        for (const double frame : {1.0 / 30, 1.0 / 240, 1.0 / 4000}) {
            CAPTURE(mass, frame);
            CHECK(SoftContact::of({.erp = 0.2, .compliance = 1e-10}, 1 / mass, 0, frame)
                      .is_hard(frame));
        }
    }
}

TEST_CASE("SoftContact: it tells the swing that it is in, and nothing where it is open",
          "[frame]") {
    constexpr double mass = 5, stiffness = 1e5, h = 1e-4;
    const SoftContact contact(stiffness, 0, 1 / mass, 0);
    const double frequency = std::sqrt(stiffness / mass);
    OwnForces open, swings;
    contact.tell(open, 0, 1, 1, h);
    CHECK(open.energy == 0);
    CHECK(open.peak == 0);
    // a sixth of a swing after it met it at 2 m/s
    const double start = -2 * std::cos(pi / 6), end = -2 * std::cos(pi / 6 + frequency * h);
    const double force = mass * (end - start) / h;
    contact.tell(swings, force, start, end, h);
    CHECK(swings.peak == Approx(1 + 1 / std::sin(pi / 6)).epsilon(0.03));
    CHECK(swings.swings ==
          Approx(mass * 2.0 * 2.0 / 2 * std::pow(frequency * h, 3) / 4).epsilon(0.03));
}

TEST_CASE("OwnForces: a spring far too fast for its part misplaces no more than its swing",
          "[frame]") {
    constexpr double mass = 3, start = -0.4;
    OwnForces forces;
    forces.add_spring(1e15, mass, 1e3, start, 0, 1e-3);
    CHECK(forces.swings == Approx(2 * forces.energy));
    CHECK(forces.energy == Approx(mass * start * start / 2));
}
