// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>

namespace ductile::scenes {

bool Finding::right() const {
    if (!expected) return true;
    const double scale = *expected == 0 ? 1 : std::abs(*expected);
    return std::abs(came_out - *expected) <= within * scale; // false for NaN
}

void Stage::remove(std::string_view member) {
    const StructurePlan& plan = structure().plan();
    const PlanMember& of = plan.members[plan.member(member)];
    const auto goes = [&of](std::size_t body) {
        return body >= of.first_body && body < of.first_body + of.bodies;
    };
    for (std::size_t i = 0; recorder_ != nullptr && i < plan.joints.size(); ++i) {
        const PlanSeat& b = plan.joints[i].b;
        const bool on_it = b.kind == PlanSeat::Kind::body && goes(b.index);
        if (structure().has_joint(i) && (on_it || goes(plan.joints[i].a))) {
            recorder_->remove(joint_of_structure(i));
        }
    }
    for (std::size_t i = 0; recorder_ != nullptr && i < plan.bodies.size(); ++i) {
        if (goes(i) && structure().has_body(i)) recorder_->remove(body_of_structure(i));
    }
    structure().remove(member);
}

std::string why_doubted(const RunReport& report) {
    const double work = report.plastic_work;
    std::string why = replay::quantity(report.left.energy, "J") + " of " +
                      replay::quantity(work, "J") + " unresolved";
    if (report.given > 0) {
        why += ", " + replay::quantity(report.given, "J") + " given by joints";
    }
    if (report.brought_in > 0) {
        why += ", " + replay::quantity(report.brought_in, "J") + " brought in by contacts";
    }
    if (report.unreliable > 0) {
        why += ", joints unsolved in " + std::to_string(report.unreliable) + " parts of frames";
    }
    return why;
}

Take::Take(Run& run, std::string name, std::string about, StageParameters parameters)
    : run_(run), name_(std::move(name)), about_(std::move(about)) {
    parameters.tolerance = run.options().tolerance;
    parameters.budget = run.options().budget;
    const std::string& engine = run.options().engine;
    if (engine != "bullet" && engine != "ode") {
        throw std::invalid_argument("engine = " + engine + ": must be bullet or ode");
    }
    stage_ = engine == "bullet" ? bullet_stage(parameters) : ode_stage(parameters);
}

Take::~Take() {
    if (!stage_->keeps_tolerance()) {
        if (unsolved_) run_.doubt(name_ + " (a joint was left unsolved)");
    } else if (const RunReport& report = stage_->world().run(); !report.believed()) {
        run_.doubt(name_ + " (" + why_doubted(report) + ")");
    }
}

double Take::frame() const { return slow_ > 0 ? slow_ : run_.options().frame; }

void Take::action(double samples_a_second) {
    if (!run_.options().keep) return;
    recorder_ = std::make_unique<replay::Recorder>(
        replay::RecorderParameters{.name = run_.scene() + ": " + name_,
                                   .about = about_,
                                   .engine = stage_->engine(),
                                   .rate = samples_a_second});
    stage_->record(*recorder_);
}

void Take::step(double frame) {
    const std::clock_t start = std::clock();
    stage_->step(frame);
    if (!(slow_ > 0)) {
        const int solves = stage_->keeps_tolerance() ? stage_->world().frame().solves() : 1;
        run_.spent({double(std::clock() - start) / CLOCKS_PER_SEC, solves});
    }
    for (const JointEvent<double>& event : stage_->world().events()) {
        unsolved_ = unsolved_ || event.kind == EventKind::unreliable;
    }
    if (recorder_ && run_.options().grows) run_.options().grows(*recorder_);
}

void Take::run(double time) {
    const int steps = int(std::lround(time / frame()));
    for (int i = 0; i < steps; ++i) step();
}

bool Take::settle(double speed, double time) {
    double calm = 0;
    for (double t = 0; t < time && calm < 1; t += frame()) {
        step();
        calm = stage_->speed() < speed ? calm + frame() : 0;
    }
    return calm >= 1;
}

void Take::cut() {
    if (recorder_) run_.keep(name_, *recorder_);
}

Run::Run(std::string scene, RunOptions options)
    : scene_(std::move(scene)), options_(std::move(options)) {}

Take Run::take(std::string name, std::string about, StageParameters parameters) {
    return {*this, std::move(name), std::move(about), parameters};
}

void Run::expect(std::string what, double came_out, double expected, double within,
                 std::string unit) {
    findings_.push_back({std::move(what), std::move(unit), came_out, expected, within});
}

bool Run::right() const {
    return std::all_of(findings_.begin(), findings_.end(),
                       [](const Finding& finding) { return finding.right(); });
}

void Run::tell(std::string what, double came_out, std::string unit) {
    findings_.push_back({std::move(what), std::move(unit), came_out, std::nullopt, 0});
}

void Run::keep(const std::string& name, const replay::Recorder& recorder) {
    if (options_.keep) replays_.push_back(options_.keep(name, recorder.finish()));
}

void Scene::require_part(const std::string& wanted) {
    std::string known;
    for (const Part& part : parts()) {
        if (wanted.empty() || wanted == part.name) return;
        known += (known.empty() ? "" : ", ") + part.name;
    }
    throw std::invalid_argument("part = " + wanted + ": " + name() + " has " + known);
}

void Scene::play(Run& run) {
    const std::string& wanted = run.options().part;
    for (const Part& part : parts()) {
        if (wanted.empty() ? !part.only_asked : wanted == part.name) part.play(run);
    }
}

std::vector<std::unique_ptr<Scene>> all_scenes() {
    std::vector<std::unique_ptr<Scene>> all;
    for (const auto make :
         {frame_scene, tension_scene, tipping_car_scene, gate_scene, fence_scene, lamp_post_scene,
          paperclip_scene, bridge_scene, plate_scene, roll_cage_scene, ramp_scene}) {
        all.push_back(make());
    }
    return all;
}

} // namespace ductile::scenes
