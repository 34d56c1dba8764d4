// SPDX-License-Identifier: MIT
//
// What an engine's Charpy scene offers to the driver, and what one run leaves behind. One scene per
// engine: bullet_scene.hpp, ode_scene.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/frame/frame_report.hpp"
#include "ductile/world/ledger.hpp"
#include "scenario.hpp"
#include "step_control.hpp"

namespace charpy {

/// One engine's scene, built from (Scenario, Method, solver name). Methods the engine lacks make
/// the constructor throw std::invalid_argument.
template <class T>
concept Simulation = requires(T simulation, const T constant, double dt) {
    { T::engine } -> std::convertible_to<std::string_view>;
    { T::precision } -> std::convertible_to<std::string_view>;
    /// A frame with this library's joints, one step of the engine's with its own; returns the wall
    /// time of that alone [s].
    { simulation.step(dt) } -> std::same_as<double>;
    { simulation.motion() } -> std::same_as<BlowMotion>;
    { constant.ledger() } -> std::same_as<const ductile::Ledger<double>&>;
    /// Of frames; null where it is stepped.
    { constant.run() } -> std::same_as<const ductile::RunReport*>;
    { constant.hammer_energy() } -> std::same_as<double>;    ///< kinetic + potential [J]
    { constant.nose_speed() } -> std::same_as<double>;       ///< towards the specimen [m/s]
    { constant.nose_travel() } -> std::same_as<double>;      ///< past the front at rest [m]
    { constant.specimen_kinetic() } -> std::same_as<double>; ///< [J]
    { simulation.joint_work() } -> std::same_as<double>;     ///< taken by the specimen's joints [J]
    { simulation.stored() } -> std::same_as<double>;         ///< elastic, in the joints [J]
    { simulation.joint_travel() } -> std::same_as<double>;   ///< plastic rotation, all joints [rad]
    { constant.rotation() } -> std::same_as<double>; ///< bend of the specimen's middle [rad]
    { simulation.broken() } -> std::same_as<bool>;
    { simulation.unreliable() } -> std::same_as<bool>;
};

/// Share of a joint's position error that an engine removes in a step [-]: 0.2, the engines' own
/// default, at steps of 1 ms and more, and in proportion to the step below. A fixed share would
/// turn the drift left by a long step into a kick in a short one.
[[nodiscard]] inline double drift_correction(double dt) { return std::min(0.2, dt / 5e-3); }

/// What steps follow: the gap between nose and specimen that closes, and the bending of the
/// specimen.
/// @param gap      from the nose's tip to the struck face at the middle [m]
/// @param closing  of the two [m/s]
/// @param parts    of the specimen in order; `spin(part)` about the axis of bending [rad/s]
template <class Parts, class Spin>
[[nodiscard]] BlowMotion blow_motion(const Scenario& scenario, double gap, double closing,
                                     const Parts& parts, const Spin& spin) {
    BlowMotion motion;
    motion.height = scenario.height;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        motion.rotation_rate =
            std::max(motion.rotation_rate, std::abs(spin(parts[i + 1]) - spin(parts[i])));
    }
    if (gap > 0) {
        motion.gap = gap;
        motion.closing_speed = std::max(closing, 0.0);
    }
    return motion;
}

/// The state once, for the history [s, s, J, J, J, J, m/s, rad].
struct Sample {
    double time = 0; ///< after the strike
    double dt = 0;
    double hammer_loss = 0;
    double plastic_work = 0;
    double specimen_kinetic = 0;
    double unexplained = 0;
    double nose_speed = 0;
    double rotation = 0;
};

struct Result {
    std::string engine, solver, precision, method;
    double frame = 0; ///< 0: it was stepped [s]
    double friction = 0;
    double restitution = 0;
    long solves = 0;         ///< steps; of frames parts, those that were done again too, and blows
    double wall = 0;         ///< of the engine's steps and commits [s]
    double hammer_loss = 0;  ///< kinetic + potential [J]
    double plastic_work = 0; ///< for other methods: what the joint took from the bodies [J]
    double stored = 0;       ///< elastic, in the joints, at the end [J]
    double plastic_rotation = 0; ///< [rad]
    double rotation = 0;         ///< bend of the middle at the end [rad]
    double specimen_kinetic = 0; ///< at the end [J]
    double friction_work = 0;    ///< [J]
    double contact_work = 0;     ///< normal contact forces [J]
    double joints_work = 0;      ///< rigid rows and the hammer's pivot [J]
    double integration = 0;      ///< the engine's own drift [J]
    double unexplained = 0;      ///< [J]
    bool broken = false;
    bool believed = true; ///< false: the frames, or a joint, say that the answer is not to be
    double left = 0;      ///< that the frames could not resolve [J]
    std::vector<Sample> history;
};

/// One method by one solver of the engine that the program is linked with (engine.cpp).
[[nodiscard]] Result run(const Scenario& scenario, Method method, const std::string& solver);

} // namespace charpy
