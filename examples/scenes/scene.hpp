// SPDX-License-Identifier: MIT
//
// What every scene is made of: options, parts, takes, and a table of what must come out beside what
// came out. Knows no command line, no file and no page.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recorder.hpp"
#include "stage.hpp"

namespace ductile::scenes {

/// What must come out, and what came out.
struct Finding {
    std::string what, unit;
    double came_out = 0;
    std::optional<double> expected; ///< none: it is only told
    double within = 0;              ///< of the expected value, or absolute where that is 0
    [[nodiscard]] bool right() const;
};

struct RunOptions {
    std::string engine = "bullet";
    double frame = 1.0 / 60; ///< [s]
    double tolerance = 0.01; ///< of frames, where the engine's World takes one
    int budget = 256;        ///< solves of a frame
    std::string part;        ///< of the scene; empty: all of it
    /// Gets a take's recording, and says under which name it is kept; none: nothing is recorded.
    std::function<std::string(const std::string& name, const replay::Recording&)> keep;
    /// Is told after each step of a take that is recorded.
    std::function<void(const replay::Recorder&)> grows;
};

/// Why a World with such frames does not vouch for them: of which plastic work how much it left
/// unresolved, and in how many parts joints unsolved, each counted by itself.
[[nodiscard]] std::string why_doubted(const RunReport& report);

/// A number of a scene that a user may change.
struct Option {
    std::string name, about, unit;
    double* value;
    double low, high; ///< its range, and that of a slider for it
    std::string part; ///< the only one that asks for it; empty: all do
};

class Run;

/// One start-to-end of a scene in an engine: a stage, and its replay.
class Take {
  public:
    Take(Run& run, std::string name, std::string about, StageParameters parameters);
    /// Tells the run where its World does not vouch for it.
    ~Take();
    Take(const Take&) = delete;
    Take& operator=(const Take&) = delete;

    [[nodiscard]] Stage& stage() { return *stage_; }
    [[nodiscard]] double frame() const; ///< [s]
    /// All bodies and joints are there: what follows is seen.
    void action(double samples_a_second = 30);
    /// From now on frames are so short [s], whatever the run's are: for what is over in a few.
    void slow_motion(double frame) { slow_ = frame; }
    void step() { step(frame()); }
    /// A frame of another length than the run's [s], as where something is to be read in between.
    void step(double frame);
    void run(double time);
    /// Until nothing is faster than `speed` [m/s] for a second, at most `time` [s]; false where it
    /// never was.
    bool settle(double speed, double time);
    /// Hands over what was recorded.
    void cut();

  private:
    Run& run_;
    std::string name_, about_;
    std::unique_ptr<Stage> stage_;
    std::unique_ptr<replay::Recorder> recorder_;
    double slow_ = 0;       ///< [s]; 0: frames are the run's
    bool unsolved_ = false; ///< a joint, in a plain step
};

class Run {
  public:
    Run(std::string scene, RunOptions options);

    [[nodiscard]] const RunOptions& options() const { return options_; }
    [[nodiscard]] const std::string& scene() const { return scene_; }
    [[nodiscard]] Take take(std::string name, std::string about, StageParameters parameters = {});
    void expect(std::string what, double came_out, double expected, double within,
                std::string unit = "");
    void tell(std::string what, double came_out, std::string unit = "");
    [[nodiscard]] const std::vector<Finding>& findings() const { return findings_; }
    [[nodiscard]] const std::vector<std::string>& replays() const { return replays_; }

    /// What a frame cost.
    struct Cost {
        double time = 0; ///< of the CPU [s]
        int solves = 0;
    };
    void spent(const Cost& frame) { costs_.push_back(frame); }
    [[nodiscard]] const std::vector<Cost>& costs() const { return costs_; }
    [[nodiscard]] bool right() const;
    /// Takes whose World does not vouch for them, each with the reason: more was left unresolved
    /// than the tolerance, or a joint unsolved.
    [[nodiscard]] const std::vector<std::string>& doubted() const { return doubted_; }
    void doubt(std::string take) { doubted_.push_back(std::move(take)); }
    /// Where somebody keeps recordings.
    void keep(const std::string& name, const replay::Recorder& recorder);

  private:
    std::string scene_;
    RunOptions options_;
    std::vector<Finding> findings_;
    std::vector<std::string> replays_; ///< under which names they are kept
    std::vector<std::string> doubted_;
    std::vector<Cost> costs_;
};

/// What of a scene can be played by itself: a take, or several that belong together.
struct Part {
    std::string name;
    std::function<void(Run&)> play;
    bool only_asked = false; ///< no part of the whole
};

/// A scene: its problem, its options, its course.
class Scene {
  public:
    virtual ~Scene() = default;
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual std::string about() const = 0;
    [[nodiscard]] virtual std::vector<Option> options() { return {}; }
    [[nodiscard]] virtual std::vector<Part> parts() = 0;
    /// @throws std::invalid_argument where there is no such part; empty: all
    void require_part(const std::string& name);
    /// All parts, or the one that is asked for, which is there.
    void play(Run& run);

  protected:
    Scene() = default;
};

[[nodiscard]] std::unique_ptr<Scene> frame_scene();
[[nodiscard]] std::unique_ptr<Scene> tension_scene();
[[nodiscard]] std::unique_ptr<Scene> tipping_car_scene();
[[nodiscard]] std::unique_ptr<Scene> gate_scene();
[[nodiscard]] std::unique_ptr<Scene> fence_scene();
[[nodiscard]] std::unique_ptr<Scene> lamp_post_scene();
[[nodiscard]] std::unique_ptr<Scene> paperclip_scene();
[[nodiscard]] std::unique_ptr<Scene> bridge_scene();
[[nodiscard]] std::unique_ptr<Scene> plate_scene();
[[nodiscard]] std::unique_ptr<Scene> roll_cage_scene();
[[nodiscard]] std::unique_ptr<Scene> ramp_scene();
/// Of these, in the order of the gallery.
[[nodiscard]] std::vector<std::unique_ptr<Scene>> all_scenes();

} // namespace ductile::scenes
