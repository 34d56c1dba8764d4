// SPDX-License-Identifier: MIT
//
// Runs of an engine's own springs and motors beside a plastic slider, in frames with a tolerance.
//
// `Rig`: a world with `body(mass, x)`, that meets nothing; `hold(body, strength)`, by a plastic
// slider to the static world along x, of which `absorbed()` tells; `push(body, speed)`;
// `load(body, force)`, from now on; `run(duration, frame)`; `check()` of what is the user's.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace ductile::test {

inline constexpr double some_frames[] = {1.0 / 6000, 1.0 / 240, 1.0 / 60, 1.0 / 30};

/// `hang(rig, body, rest, stiffness, frame)`: a spring between the body and the static world.
template <class Rig, class Hang>
void swing_against_a_weak_slider(double accuracy, const Hang& hang) {
    // from rest at A₀: each half swing, of π/ω, ends at A - 2 R/k, and R went over both
    constexpr double mass = 4, first = 0.3, weaker = 25; // k A₀/R
    constexpr int half_swings = 6;
    for (const double frequency : {15.0, 60.0, 180.0}) { // ω [rad/s]; ω h up to 6
        for (const double wanted : some_frames) {
            CAPTURE(frequency, wanted);
            const double stiffness = mass * frequency * frequency;
            const double strength = stiffness * first / weaker;
            double path = 0, amplitude = first;
            for (int i = 0; i < half_swings; ++i) {
                path += 2 * (amplitude - strength / stiffness);
                amplitude -= 2 * strength / stiffness;
            }
            const double duration = half_swings * std::numbers::pi / frequency;
            const double frame = duration / std::max(1.0, std::round(duration / wanted));
            Rig rig;
            auto& body = rig.body(mass, 0);
            rig.hold(body, strength);
            hang(rig, body, first, stiffness, frame);
            rig.run(duration, frame);
            const double taken = strength * path;
            CHECK(rig.absorbed() == Approx(taken).epsilon(accuracy));
            CHECK(rig.world->run().believed());
            rig.check();
        }
    }
}

/// `join(rig, a, b, stiffness, frame)`: a spring between bodies, as long as they are apart.
template <class Rig, class Join>
void meet_at_the_peak(const Join& join) {
    // what Bullet's frames of 1/6000 s take [J]
    struct Case {
        double held, mass, strength, stiffness, speed, duration, work;
    };
    for (const Case& scene : {Case{2.61552, 1.02808, 278.172, 42683.3, 4.40948, 1, 9.071},
                              Case{11.5728, 3.25694, 604.727, 55084.3, 3.63024, 5.0 / 6, 17.966}}) {
        for (const double frame : some_frames) {
            CAPTURE(scene.work, frame);
            Rig rig;
            auto &a = rig.body(scene.held, 0), &b = rig.body(scene.mass, 1);
            rig.push(b, scene.speed);
            rig.hold(a, scene.strength);
            join(rig, a, b, scene.stiffness, frame);
            rig.run(scene.duration, frame);
            CHECK(rig.absorbed() == Approx(scene.work).epsilon(0.02));
            CHECK(rig.world->run().believed());
        }
    }
}

/// `join(rig, a, b, speed, force, frame)`: a motor that drives bodies apart.
template <class Rig, class Join>
void drive_apart(double accuracy, const Join& join) {
    // F drives two masses apart until they have the speed v, against R < F on one of them:
    //   t = v/(F/m₂ + (F - R)/m₁),  v₁ = (F - R) t/m₁,  W = R (v₁ t/2 + (m₁ + m₂) v₁²/(2 R))
    constexpr double m_1 = 5, m_2 = 2, strength = 40, force = 100;
    for (const double speed : {0.05, 0.4, 3.0}) {
        const double time = speed / (force / m_2 + (force - strength) / m_1);
        const double reached = (force - strength) * time / m_1;
        const double work = strength * reached * time / 2 + (m_1 + m_2) * reached * reached / 2;
        for (const double frame : some_frames) {
            CAPTURE(speed, frame);
            Rig rig;
            auto &a = rig.body(m_1, 0), &b = rig.body(m_2, 1);
            rig.hold(a, strength);
            join(rig, a, b, speed, force, frame);
            rig.run(0.2, frame);
            CHECK(rig.absorbed() == Approx(work).epsilon(accuracy));
            CHECK(rig.world->run().believed());
        }
    }
}

/// `join(rig, a, b, speed, force, frame)`: a motor that presses bodies against a stop between them.
template <class Rig, class Join>
void press_against_a_stop(double accuracy, const Join& join) {
    // less than F pulls one of them away: both go on as one, W = R (L - R)/(m₁ + m₂) t²/2
    constexpr double m_1 = 5, m_2 = 2, strength = 40, force = 100, load = 60, duration = 0.2;
    const double work = strength * (load - strength) / (m_1 + m_2) * duration * duration / 2;
    for (const double frame : some_frames) {
        CAPTURE(frame);
        Rig rig;
        auto &a = rig.body(m_1, 0), &b = rig.body(m_2, 1);
        rig.hold(a, strength);
        rig.load(b, load);
        join(rig, a, b, 3.0, force, frame);
        rig.run(duration, frame);
        CHECK(rig.absorbed() == Approx(work).epsilon(accuracy));
        CHECK(rig.world->run().believed());
    }
}

} // namespace ductile::test
