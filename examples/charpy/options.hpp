// SPDX-License-Identifier: MIT
//
// The command line, shared by the front and by the runner of each engine.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scenario.hpp"

namespace charpy {

struct Options {
    Scenario scenario;
    std::string engine = "all";
    std::string solver;               ///< empty: the engine's direct solver
    std::string precision = "double";
    std::string method = "all";
    std::string ccd;                  ///< "on", "off" or empty: not said
    std::string json, csv, plots;     ///< files and a folder; empty: none
    std::string table;                ///< a folder; empty: none
};

inline void declare(CLI::App& app, Options& o) {
    Scenario& s = o.scenario;
    std::vector<std::string> methods{"all"};
    for (const auto& [method, name] : method_names) methods.emplace_back(name);

    // the front passes on what the user gave and then fixes what it runs
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);

    const auto run = "What to run";
    app.add_option("--engine", o.engine, "physics engine; all: every method on every engine")
        ->check(CLI::IsMember({"all", "bullet", "ode"}))->capture_default_str()->group(run);
    app.add_option("--solver", o.solver,
                   "bullet: mlcp (direct, Dantzig), si or nncg (iterative), of islands "
                   "without our joints, or island: ours, of all; "
                   "ode: direct or quick (iterative)")
        ->check(CLI::IsMember({"mlcp", "island", "si", "nncg", "direct", "quick"}))
        ->group(run);
    app.add_option("--precision", o.precision, "scalar of the engine; ode is built for double")
        ->check(CLI::IsMember({"float", "double"}))->capture_default_str()->group(run);
    app.add_option("--method", o.method,
                   "joint in the specimen's middle. The engine's own: zero-limits breaks at M_p "
                   "dt, spring and spring2 are M_p per radian, hinge-motor slips at M_p. This "
                   "library's: plastic-hinge yields at M_p, rigid below; elastic-plastic: six axes, "
                   "each elastic up to its own capacity, then flowing; elastic-plastic-2: six "
                   "axes, elastic inside one surface that they share")
        ->check(CLI::IsMember(methods))->capture_default_str()->group(run);
    app.add_option("--json", o.json, "write the results to this file")->group(run);
    app.add_option("--csv", o.csv, "write the histories to this file")->group(run);
    app.add_option("--plots", o.plots,
                   "draw the plots into this folder: a point a frame, so with a short --frame")
        ->group(run);
    app.add_option("--table", o.table,
                   "run all methods on all engines and write them beside the published figures "
                   "into this folder: published.txt, .md and .csv")->group(run);

    const auto time = "Time";
    app.add_option("--frame", s.frame, "of this library's joints; the engine's own are stepped [s]")
        ->capture_default_str()->group(time);
    app.add_option("--tolerance", s.tolerance,
                   "share of the plastic work that a frame may misplace [-]")
        ->capture_default_str()->group(time);

    const auto material = "Specimen";
    app.add_option("--yield-stress", s.yield_stress, "[Pa]")->capture_default_str()->group(material);
    app.add_option("--max-plastic-rotation", s.max_plastic_rotation,
                   "the hinge breaks there [rad]; inf: never")->capture_default_str()->group(material);
    app.add_option("--parts", s.parts, "equal bodies the specimen is made of, even")
        ->capture_default_str()->group(material);
    app.add_option("--length", s.length, "[m]")->capture_default_str()->group(material);
    app.add_option("--width", s.width, "vertical [m]")->capture_default_str()->group(material);
    app.add_option("--height", s.height, "along the blow [m]")->capture_default_str()->group(material);
    app.add_option("--notch", s.notch, "depth of the notch [m]")->capture_default_str()->group(material);
    app.add_option("--density", s.density, "[kg/m^3]")->capture_default_str()->group(material);
    app.add_option("--youngs-modulus", s.youngs_modulus, "of the elastic-plastic methods [Pa]")
        ->capture_default_str()->group(material);

    const auto machine = "Anvils and hammer";
    app.add_option("--anvil-gap", s.anvil_gap, "open space between the anvils [m]")
        ->capture_default_str()->group(machine);
    app.add_option("--hammer-mass", s.hammer_mass, "[kg]")->capture_default_str()->group(machine);
    app.add_option("--hammer-width", s.hammer_width, "along the blow [m]")
        ->capture_default_str()->group(machine);
    app.add_option("--hammer-height", s.hammer_height, "[m]")->capture_default_str()->group(machine);
    app.add_option("--hammer-thickness", s.hammer_thickness,
                   "along the specimen; its edges strike where the draft is short [m]")
        ->capture_default_str()->group(machine);
    app.add_option("--draft,--nose-length", s.nose_length,
                   "length over which the hammer tapers to its nose; 0: the whole thickness strikes "
                   "[m]")->capture_default_str()->group(machine);
    app.add_option("--nose-width", s.nose_width,
                   "flat of the nose, along the specimen; without draft there is none [m]")
        ->capture_default_str()->group(machine);
    app.add_option("--arm-mass", s.arm_mass, "[kg]")->capture_default_str()->group(machine);
    app.add_option("--arm-length", s.arm_length, "[m]")->capture_default_str()->group(machine);
    app.add_option("--arm-width", s.arm_width, "[m]")->capture_default_str()->group(machine);
    app.add_option("--start-angle", s.start_angle, "of the pendulum from its lowest position [rad]")
        ->capture_default_str()->group(machine);

    const auto world = "World";
    app.add_option("--friction", s.friction, "Coulomb coefficient of every contact [-]")
        ->capture_default_str()->group(world);
    app.add_option("--restitution", s.restitution,
                   "of every contact, Newton's, in [0, 1]; none below 0.2 m/s [-]")
        ->capture_default_str()->group(world);
    app.add_option("--gravity", s.gravity, "[m/s^2]")->capture_default_str()->group(world);
    app.add_option("--iterations", s.iterations,
                   "of the iterative solvers, and of what a direct one of Bullet's falls back to")
        ->capture_default_str()->group(world);
    app.add_option("--ccd", o.ccd,
                   "on or off: accepted and without effect, since contacts come from exact geometry "
                   "before surfaces meet and nothing can tunnel")
        ->check(CLI::IsMember({"on", "off"}))->group(world);
}

/// Refuses what could not act on anything that was asked for.
/// @throws std::invalid_argument naming the option and what it acts on.
inline void require_effect(const CLI::App& app, const Options& o) {
    const auto refuse = [](const std::string& option, const std::string& acts_on) {
        throw std::invalid_argument(option + ": must be left out here, it acts on " + acts_on +
                                    " only");
    };
    for (const auto& [method, name] : method_names) {
        if (o.method != name) continue;
        for (const char* option : {"--max-plastic-rotation", "--frame", "--tolerance"}) {
            if (app.count(option) > 0 && !is_plastic(method)) {
                refuse(option, "plastic-hinge, elastic-plastic and elastic-plastic-2");
            }
        }
        if (app.count("--youngs-modulus") > 0 && !is_elastic(method)) {
            refuse("--youngs-modulus", "elastic-plastic and elastic-plastic-2");
        }
        if (app.count("--parts") > 0 && method == Method::rigid) {
            refuse("--parts", "methods with joints");
        }
    }
    const bool exact = o.engine == "ode" && (o.solver.empty() || o.solver == "direct");
    if (app.count("--iterations") > 0 && exact) {
        refuse("--iterations", "iterative solvers (with --engine ode: --solver quick)");
    }
    if (app.count("--nose-width") > 0 && o.scenario.nose_length == 0) {
        refuse("--nose-width", "a hammer with draft");
    }
    if (o.table.empty()) return;
    for (const char* fixed : {"--engine", "--solver", "--precision", "--method", "--frame", "--tolerance",
                              "--max-plastic-rotation", "--json", "--csv", "--plots"}) {
        if (app.count(fixed) > 0) refuse(fixed, "runs without --table");
    }
}

/// To be called after parsing. @throws std::invalid_argument where an option does not make sense.
inline void finish(Options& o) {
    if (o.engine == "ode" && o.precision == "float") {
        throw std::invalid_argument("--precision = float: must be double with --engine ode");
    }
    o.scenario.check();
}

/// What went wrong as one line.
inline std::string one_line(const CLI::ParseError& error) {
    std::string text = error.what();
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    return text;
}

} // namespace charpy
