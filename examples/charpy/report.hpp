// SPDX-License-Identifier: MIT
//
// A run's result as JSON, as a line of the history file and as a row of the printed table.
#pragma once

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "reference.hpp"
#include "simulation.hpp"

namespace charpy {

/// Units are in the keys.
[[nodiscard]] inline nlohmann::ordered_json to_json(const Result& r) {
    return {{"engine", r.engine},
            {"solver", r.solver},
            {"precision", r.precision},
            {"method", r.method},
            {"frame_s", r.frame},
            {"friction", r.friction},
            {"restitution", r.restitution},
            {"solves", r.solves},
            {"wall_s", r.wall},
            {"hammer_loss_J", r.hammer_loss},
            {"plastic_work_J", r.plastic_work},
            {"stored_J", r.stored},
            {"plastic_rotation_rad", r.plastic_rotation},
            {"rotation_rad", r.rotation},
            {"specimen_kinetic_J", r.specimen_kinetic},
            {"friction_work_J", r.friction_work},
            {"contact_work_J", r.contact_work},
            {"joints_work_J", r.joints_work},
            {"integration_J", r.integration},
            {"unexplained_J", r.unexplained},
            {"broken", r.broken},
            {"believed", r.believed},
            {"left_J", r.left}};
}

/// History columns: time after the strike, step, energy lost by the hammer since, plastic work,
/// specimen energy, unexplained, nose speed, rotation.
[[nodiscard]] inline nlohmann::json history_to_json(const Result& r) {
    auto rows = nlohmann::json::array();
    for (const Sample& s : r.history) {
        rows.push_back({s.time, s.dt, s.hammer_loss, s.plastic_work, s.specimen_kinetic,
                        s.unexplained, s.nose_speed, s.rotation});
    }
    return rows;
}
inline constexpr std::string_view history_header =
    "engine,solver,precision,method,frame_s,friction,time_after_strike_s,step_s,"
    "hammer_loss_J,plastic_work_J,specimen_kinetic_J,unexplained_J,nose_speed_m_per_s,rotation_rad";

/// One or two words on what a run shows, measured against the mechanics.
[[nodiscard]] inline std::string verdict(const nlohmann::ordered_json& r, const Reference& expected) {
    const auto number = [&r](const char* key) {
        return r.at(key).is_number() ? r.at(key).get<double>() : NAN;
    };
    const double loss = number("hammer_loss_J");
    const double work = number("plastic_work_J");
    const double kinetic = number("specimen_kinetic_J");
    const std::string method = r.at("method");
    if (!std::isfinite(loss) || std::abs(number("unexplained_J")) > 1) return "unstable";
    if (method == "rigid") {
        const bool right = std::abs(loss - expected.rebound_loss) <= 0.02 * expected.strike_energy;
        return fmt::format("{} the hammer, {}",
                           r.at("restitution").get<double>() > 0 ? "bounces" : "stops",
                           right ? "as it must"
                                 : fmt::format("off ({:.1f} J expected)", expected.rebound_loss));
    }
    if (r.at("broken").get<bool>() && work < 0.05 * expected.plastic_work) return "breaks brittle";
    if (method.starts_with("spring")) {
        const char* gives = work < -0.01 * expected.plastic_work ? "; joint adds energy" : "";
        return fmt::format("springs back, halves fly off{}", gives);
    }
    if (kinetic > 0.1 * expected.plastic_work) return "unstable";
    const double error = work / expected.plastic_work - 1;
    std::string text = std::abs(error) <= 0.01 ? fmt::format("right ({:+.2f} %)", 100 * error)
                                               : fmt::format("off ({:+.1f} %)", 100 * error);
    return r.at("believed").get<bool>() ? text : text + ", not believed";
}

inline constexpr std::string_view table_rule =
    "------------------------------------------------------------------------------------------------"
    "---------------------------------------------------";

[[nodiscard]] inline std::string table_header() {
    return fmt::format("{:<7}{:<8}{:<8}{:<18}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>12}{:>7}{:>9}  {}\n{}\n",
                       "engine", "solver", "scalar", "method", "hammer", "plastic", "rotation",
                       "halves", "friction", "contact", "unexplained", "solves", "time", "verdict",
                       table_rule) +
           fmt::format("{:<41}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>12}{:>7}{:>9}\n", "", "loss J",
                       "work J", "rad", "J", "J", "J", "J", "", "ms");
}

[[nodiscard]] inline std::string table_row(const nlohmann::ordered_json& r,
                                           const Reference& expected) {
    const auto number = [&r](const char* key) {
        return r.at(key).is_number() ? r.at(key).get<double>() : NAN;
    };
    return fmt::format(
        "{:<7}{:<8}{:<8}{:<18}{:>9.2f}{:>9.2f}{:>9.4f}{:>9.3f}{:>9.2f}{:>9.2f}{:>12.1e}{:>7}{:>9.1f}  "
        "{}\n",
        r.at("engine").get<std::string>(), r.at("solver").get<std::string>(),
        r.at("precision").get<std::string>(), r.at("method").get<std::string>(),
        number("hammer_loss_J"), number("plastic_work_J"), number("plastic_rotation_rad"),
        number("specimen_kinetic_J"), number("friction_work_J"), number("contact_work_J"),
        number("unexplained_J"), r.at("solves").get<long>(), 1e3 * number("wall_s"),
        verdict(r, expected));
}

} // namespace charpy
