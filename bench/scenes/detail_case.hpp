// SPDX-License-Identifier: MIT
//
// The scenes as the choice of detail sees them: every joint has a section, a material and a length,
// and so a stiffness beside its strength; what the core is told of the event; the models that could
// be built; and the answer they are all held against, which knows the elastic part.
//
// The answer is a closed form where there is one for the elastic-plastic joint, else the most
// detailed model at a step of `fine`.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/ductile.hpp"
#include "scenes/all.hpp"
#include "scenes/loaded_bar.hpp"
#include "scenes/still_cantilever.hpp"

namespace bench {

/// One way to build a scene.
struct Model {
    std::string detail; ///< rigid, rigid-plastic, elastic-plastic; rods: see struck_case
    std::string method; ///< of bench/methods
    int joints = 1;
    Scene scene;
};

/// What the core chose for a tolerance.
struct Chosen {
    std::string detail;
    int joints = 1;
    double dt = 0;
    std::string reason;
};

struct DetailCase {
    std::string name;
    std::vector<Model> models;
    std::optional<double>
        answer;         ///< of the scenes' first quantity; none: the last model's at `fine`
    double fine = 1e-5; ///< [s]
    std::function<Chosen(double tolerance)> choose;
};

/// A game's step: longer ones are not asked for [s].
inline constexpr double longest_step = 1.0 / 60;

namespace detail_case {

using Capacity = ductile::JointCapacity<double>;
using Event = ductile::AxisEvent<double>;
/// Axes in the order of JointCapacity.
inline constexpr std::size_t axial = 2, bending = 3;

[[nodiscard]] inline ductile::Material<double> steel(double yield_stress) {
    return ductile::Material<double>({.density = 7800,
                                      .youngs_modulus = 200e9,
                                      .poisson_ratio = 0.3,
                                      .yield_stress = yield_stress});
}
/// Width × height, bent about the axis along the width [m].
[[nodiscard]] inline Capacity bar(double width, double height, double length,
                                  double yield_stress = 250e6) {
    return ductile::joint_capacity(ductile::Rectangle<double>({.width = width, .height = height}),
                                   steel(yield_stress), {.length = length});
}

/// One joint of which one axis has anything to do.
struct Question {
    Capacity capacity;
    std::size_t axis;
    double mass;
    Event event;
    double limit = infinity;

    [[nodiscard]] ductile::AxisSystem<double> system() const {
        return {mass, capacity.stiffness[axis], capacity.capacity[axis], limit};
    }
    [[nodiscard]] ductile::ModelChoice<double> ask(double tolerance) const {
        ductile::JointDetailParameters<double> p;
        p.capacity = capacity;
        p.mass.fill(mass);
        p.event.fill(Event{});
        p.event[axis] = event;
        p.limit[axis] = limit;
        p.dt = longest_step;
        p.tolerance = tolerance;
        return ductile::choose_model(p);
    }
};

/// The most detailed joint and the shortest step of all that the questions ask for.
[[nodiscard]] inline Chosen ask_all(const std::vector<Question>& questions, double tolerance) {
    Chosen chosen{.detail = {}, .joints = int(questions.size()), .dt = longest_step, .reason = {}};
    auto detail = ductile::AxisDetail::rigid;
    for (const Question& question : questions) {
        const auto model = question.ask(tolerance);
        detail = std::max(detail, model.joint.detail());
        chosen.dt = std::min(chosen.dt, model.dt);
        const auto& axis = model.joint.axis[question.axis];
        chosen.reason += std::string(to_string(axis.detail)) + ": " + axis.reason + ". ";
    }
    chosen.detail = to_string(detail);
    return chosen;
}

/// Peak travel of a joint instead of the travel at the end: an elastic joint springs back.
[[nodiscard]] inline Scene with_peak(Scene scene, std::size_t joint) {
    scene.quantities = {
        {"peak_travel", 1, [joint](const Observation& o) { return o.peak_travel[joint]; }}};
    return scene;
}

/// A scene whose joints have the stiffnesses of the questions, in three details.
[[nodiscard]] inline DetailCase three_details(Scene scene, const std::vector<Question>& questions,
                                              std::optional<double> answer) {
    for (std::size_t i = 0; i < questions.size(); ++i) {
        scene.joints[i].strength = questions[i].capacity.capacity[questions[i].axis];
        scene.joints[i].stiffness = questions[i].capacity.stiffness[questions[i].axis];
    }
    DetailCase c{.name = scene.name, .models = {}, .answer = answer, .choose = {}};
    for (const auto& [detail, method] :
         {std::pair{"rigid", "rigid"}, std::pair{"rigid-plastic", "plastic-hinge"},
          std::pair{"elastic-plastic", "elastic-plastic"}}) {
        c.models.push_back({detail, method, int(scene.joints.size()), scene});
    }
    c.choose = [questions](double tolerance) { return ask_all(questions, tolerance); };
    return c;
}

} // namespace detail_case

/// Half a metre of 10 × 8 mm bar: stores 5 J at yield.
[[nodiscard]] inline DetailCase breaking_hinge_case() {
    using namespace detail_case;
    const BreakingHingeParameters p;
    const Question q{bar(0.01, 0.008, 0.5), bending, p.inertia, {.speed = p.spin}, p.limit};
    return three_details(breaking_hinge(p), {q}, peak_response(q.system(), q.event).speed);
}

/// Two bars of 0.1 m. The second hinge brakes the rotors' relative motion, in which the first one's
/// moment counts for I₂/(I₁ + I₂) of itself; the first then stops both.
[[nodiscard]] inline DetailCase rotors_case() {
    using namespace detail_case;
    const RotorsInSeriesParameters p;
    const double both = p.first_inertia + p.second_inertia;
    const double relative = p.first_inertia * p.second_inertia / both;
    const double push = p.second_moment - p.first_moment;
    const double lock = p.spin / (push / p.first_inertia + p.second_moment / p.second_inertia);
    const Question first{
        bar(0.005, 0.008, 0.1), bending, both, {.speed = push / p.first_inertia * lock}};
    const Question second{bar(0.0125, 0.008, 0.1),
                          bending,
                          relative,
                          {.speed = p.spin, .held = p.first_moment * p.second_inertia / both}};
    return three_details(with_peak(rotors_in_series(p), 1), {first, second}, {});
}

/// 40 m of wire of 8 mm².
[[nodiscard]] inline DetailCase oscillator_case() {
    using namespace detail_case;
    const OscillatorParameters p;
    const Question q{bar(0.002, 0.004, 40), axial, p.mass, {.load = p.load * p.strength}};
    return three_details(with_peak(oscillator(p), 0), {q},
                         peak_response(q.system(), q.event).displacement);
}

/// Four metres of bar of 1 cm².
[[nodiscard]] inline DetailCase loaded_bar_case() {
    using namespace detail_case;
    const LoadedBarParameters p;
    const Question q{
        bar(0.01, 0.01, 4, p.yield_stress), axial, p.mass, {.speed = p.speed, .load = p.load}};
    return three_details(with_peak(loaded_bar(p), 0), {q},
                         peak_response(q.system(), q.event).displacement);
}

/// A stocky column of half a metre that gives way along itself.
[[nodiscard]] inline DetailCase dropped_mass_case() {
    using namespace detail_case;
    const DroppedMassParameters p;
    const double total = p.mass + p.head;
    const Question q{bar(0.01, 0.012, 0.5),
                     axial,
                     total,
                     {.speed = std::sqrt(2 * p.gravity * p.height) * p.mass / total,
                      .load = p.mass * p.gravity,
                      .held = p.head * p.gravity,
                      .own_mass = p.head}};
    return three_details(with_peak(dropped_mass(p), 0), {q},
                         peak_response(q.system(), q.event).displacement);
}

/// A tube of 140 mm, of which the lowest 0.2 m bend; the weight's moment at its mean over the turn.
[[nodiscard]] inline DetailCase lamp_post_case() {
    using namespace detail_case;
    const LampPostParameters p;
    constexpr double outer = 0.07, yield_stress = 235e6; // M_p = 4/3 (R³ - r³) f_y
    const double inner = std::cbrt(std::pow(outer, 3) - 0.75 * p.plastic_moment / yield_stress);
    const Capacity tube = ductile::joint_capacity(
        ductile::Tube<double>({.outer_radius = outer, .inner_radius = inner}), steel(yield_stress),
        {.length = 0.2});
    const double post = p.post_mass * p.post_length * p.post_length / 3;
    const double both = p.vehicle * p.bumper * p.bumper + post;
    const double rate = p.vehicle * p.speed * p.bumper / both;
    const double turn = both * rate * rate / 2 / p.plastic_moment;
    const Question q{
        tube,
        bending,
        both,
        {.speed = rate,
         .load = p.post_mass * p.gravity * p.post_length / 2 * (1 - std::cos(turn)) / turn,
         .own_mass = post}};
    return three_details(with_peak(lamp_post(p), 0), {q}, {});
}

/// The specimen in two parts. The hammer goes on when the halves have passed; for the hinge alone
/// stands a mass that it would stop within that rotation.
[[nodiscard]] inline DetailCase charpy_case() {
    using namespace detail_case;
    CharpyParameters p;
    p.scenario.parts = 2;
    const charpy::Scenario& s = p.scenario;
    const charpy::Reference with = charpy::reference(s, charpy::Method::elastic_plastic);
    const double arm = (s.anvil_gap - s.flat()) / 2;
    const double rate = 2 * with.strike_speed / arm;
    // both halves about their anvils, per hinge angle: m l²/12 each, half of it for the pair
    const double halves = s.specimen_mass() * s.length * s.length / 4 / 12 / 4;
    const Question q{
        ductile::joint_capacity(s.notched_section(), s.steel(), {.length = s.joint_length()}),
        bending,
        2 * s.notched_moment() * with.rotation / (rate * rate),
        {.speed = rate, .own_mass = halves}};
    DetailCase c = three_details(charpy_blow(p), {q}, with.hammer_loss);
    for (const int parts : {4, 6}) {
        p.scenario.parts = parts;
        c.models.push_back({"rigid-plastic", "plastic-hinge", parts - 1, charpy_blow(p)});
    }
    return c;
}

/// Ten segments below their plastic moment: nothing moves.
[[nodiscard]] inline DetailCase still_case() {
    using namespace detail_case;
    const StillCantileverParameters p{.segments = 10};
    const double root = p.gravity * p.length * (p.mass_per_length * p.length / 2 + p.tip_mass);
    const double height = std::cbrt(4 * root / p.utilisation / 250e6); // M_p = h³ f_y/4
    const std::vector<Question> questions(
        std::size_t(p.segments),
        {bar(height, height, p.length / p.segments), bending, 1, {.held = root}});
    DetailCase c = three_details(still_cantilever(p), questions, 1);
    c.models.pop_back(); // its elastic sag is another question
    c.choose = [questions](double tolerance) { return ask_all({questions[0]}, tolerance); };
    for (Model& model : c.models) model.joints = model.detail == "rigid" ? 1 : p.segments;
    StillCantileverParameters whole = p;
    whole.segments = 1;
    c.models[0].scene = still_cantilever(whole);
    return c;
}

/// Parkes' cantilever against the continuum: chains with the mass at the joints, which the core
/// chooses from, and chains of uniform rods.
[[nodiscard]] inline DetailCase struck_case(bool quick) {
    StruckCantileverParameters p;
    const ductile::StruckCantilever<double> beam{.length = p.length,
                                                 .mass_per_length = p.mass_per_length,
                                                 .plastic_moment = p.plastic_moment,
                                                 .tip_mass = p.tip_mass,
                                                 .speed = p.speed};
    DetailCase c{.name = "struck-cantilever",
                 .models = {},
                 .answer = continuum_deflection(beam),
                 .choose = {}};
    p.segments = 1;
    c.models.push_back({"rigid", "rigid", 1, struck_cantilever(p)});
    for (const int n : {1, 2, 5, 10, 20}) {
        if (quick && n > 10) continue;
        p.segments = n;
        c.models.push_back({n == 1 ? "rigid-plastic" : "rigid-plastic rods", "plastic-hinge", n,
                            struck_cantilever(p)});
    }
    p.mass_at_ends = true;
    for (int n = 2; n <= (quick ? 12 : 20); ++n) {
        p.segments = n;
        c.models.push_back({"rigid-plastic", "plastic-hinge", n, struck_cantilever(p)});
    }
    c.choose = [beam](double tolerance) {
        const auto choice = ductile::choose_segments(
            beam, ductile::SegmentParameters<double>{.tolerance = tolerance,
                                                     .longest_step = longest_step});
        return Chosen{"rigid-plastic", choice.segments, choice.dt, choice.reason};
    };
    return c;
}

[[nodiscard]] inline std::vector<DetailCase> detail_cases(bool quick) {
    return {still_case(),        breaking_hinge_case(), rotors_case(),
            oscillator_case(),   loaded_bar_case(),     struck_case(quick),
            dropped_mass_case(), lamp_post_case(),      charpy_case()};
}

} // namespace bench
