// SPDX-License-Identifier: MIT
//
// Runs a scene in an engine's world: once observed after every step, for what is right and wrong
// with it, and as often as wanted unobserved, for what it costs. Both runs are the same simulation.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "cpu_time.hpp"
#include "ductile/frame/frame_report.hpp"
#include "engines/settings.hpp"
#include "methods/holder.hpp"
#include "methods/names.hpp"
#include "scenes/scene.hpp"
#include "scenes/still_cantilever.hpp"

namespace bench {

struct RunResult {
    Observation end;
    long steps = 0;
    long unreliable_steps = 0; ///< that the method itself said not to believe
    double energy_start = 0;   ///< kinetic + potential of all bodies [J]
    double energy_highest = 0; ///< [J]
    bool finite = true;        ///< false: stopped where a number was no longer one
    ductile::RunReport frames; ///< of a world with a tolerance
};

/// The step of every run: fixed, but for the first one where that is another; the last frame of a
/// world with a tolerance ends with the scene.
class Stepping {
  public:
    Stepping(const Scene& scene, const Settings& settings)
        : fixed_(settings.dt),
          first_(settings.first),
          left_(settings.in_frames() ? scene.duration : infinity) {}

    /// True once the scene is over, of frames.
    [[nodiscard]] bool over() const { return left_ < 1e-9 * fixed_; }
    double next() {
        const double first = std::exchange(first_, 0);
        const double dt = std::min(first > 0 ? first : fixed_, left_);
        left_ -= dt;
        return dt;
    }

  private:
    double fixed_, first_, left_;
};

/// Kinetic and potential energy of all bodies [J].
template <class World>
double energy(const Scene& scene, const World& world) {
    double sum = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyState state = world.state(int(i));
        sum += kinetic(scene.bodies[i], state) + potential(scene, scene.bodies[i], state);
    }
    return sum;
}

/// Observed run; `watch(world, observation)` after every step.
template <class World, class Watch>
RunResult observe(const Scene& scene, const Settings& settings, Watch watch) {
    World world(scene, settings);
    Stepping stepping(scene, settings);
    RunResult r;
    Observation& o = r.end;
    std::vector<Travel> travels;
    for (const JointSpec& joint : scene.joints) {
        travels.emplace_back(joint, world.state(joint.a), world.state(joint.b));
    }
    o.travel.assign(travels.size(), 0);
    o.peak_travel = o.travel;
    o.bodies.resize(scene.bodies.size());
    r.energy_start = r.energy_highest = energy(scene, world);
    // half a step less: round-off of the sum must not add a step
    const double end = scene.duration - (settings.in_frames() ? 0 : settings.dt / 2);
    do {
        const double dt = stepping.next();
        bool unreliable = false;
        world.step(dt);
        o.time += dt;
        ++r.steps;
        for (std::size_t i = 0; i < o.bodies.size(); ++i) o.bodies[i] = world.state(int(i));
        for (std::size_t i = 0; i < travels.size(); ++i) {
            const JointSpec& joint = scene.joints[i];
            o.travel[i] = travels[i].update(world.state(joint.a), world.state(joint.b));
            o.peak_travel[i] = std::max(o.peak_travel[i], std::abs(o.travel[i]));
            const auto peak = world.holders()[i]->peak();
            if (settings.in_frames() && peak) o.peak_travel[i] = *peak;
        }
        const double now = energy(scene, world);
        r.finite = std::isfinite(now);
        r.energy_highest = std::max(r.energy_highest, now);
        o.absorbed = 0;
        for (const auto& holder : world.holders()) {
            unreliable = unreliable || holder->unreliable();
            const auto absorbed = holder->absorbed();
            if (!absorbed) o.absorbed.reset();
            if (o.absorbed) *o.absorbed += *absorbed;
        }
        r.unreliable_steps += unreliable;
        watch(world, o);
    } while (r.finite && o.time < end && !stepping.over());
    if (const ductile::RunReport* run = world.run()) r.frames = *run;
    return r;
}
template <class World>
RunResult observe(const Scene& scene, const Settings& settings) {
    return observe<World>(scene, settings, [](const World&, const Observation&) {});
}

/// |value - expected| / |expected|; infinite where the run did not stay finite; none where the
/// method has no such quantity.
[[nodiscard]] inline std::optional<double> relative_error(const Quantity& quantity,
                                                          const RunResult& run) {
    const auto value = quantity.value(run.end);
    if (!value) return std::nullopt;
    const double error = std::abs(*value / quantity.expected - 1);
    return run.finite && std::isfinite(error) ? error : infinity;
}

/// The steps alone, to be counted or timed. Not inlined: instructions are collected by its name.
template <class World>
[[gnu::noinline]] void bench_steps(World& world, Stepping& stepping, long steps) {
    for (long i = 0; i < steps; ++i) world.step(stepping.next());
}

/// The machine's pace: CPU time of a step of five bodies on the engine's own hinge motors, which
/// never changes. A machine that others use as well is slower at times by a third and more.
template <class World>
class Yardstick {
  public:
    /// CPU time of one step now [s], the mean over `duration` [s].
    double measure(double duration) {
        constexpr int together = 8; // steps; reading the clock costs as well
        long steps = 0;
        const double start = cpu_now();
        double now = start;
        do {
            for (int i = 0; i < together; ++i) world_.step(1e-3);
            steps += together;
            now = cpu_now();
        } while (now - start < duration);
        return (now - start) / double(steps);
    }

  private:
    World world_{
        still_cantilever({.utilisation = 0.01}),
        Settings{.solver = std::string(World::solvers.front().name), .method = "hinge-motor"}};
};

/// What a run costs beside what the yardstick cost just before and after it.
struct Cost {
    double cpu = 0;       ///< CPU time [s]
    double yardstick = 0; ///< of the yardstick's step meanwhile [s]

    /// Comparable with that of other runs, whenever they were [yardsticks].
    [[nodiscard]] double steps() const { return cpu / yardstick; }
};

/// Cost of `steps` steps from the start: the median, by what it is in yardsticks, of at least
/// `repeats` runs and of as many as take `at_least` seconds together. An absurdly long run is not
/// repeated.
template <class World>
Cost cost_of(const Scene& scene, const Settings& settings, long steps, int repeats,
             double at_least) {
    static Yardstick<World> yardstick;
    constexpr double shortest = 1e-4, share = 0.1; // of the yardstick's runs, of a run's length
    std::vector<double> costs, paces;
    double sum = 0, pace = yardstick.measure(shortest);
    std::minstd_rand random;
    while (int(costs.size()) < repeats || sum < at_least) {
        // where the world happens to lie in memory must not decide
        const std::vector<char> padding(1 + random() % 8192);
        World world(scene, settings);
        Stepping stepping(scene, settings);
        const double start = cpu_now();
        bench_steps(world, stepping, steps);
        const double cpu = cpu_now() - start;
        const double before =
            std::exchange(pace, yardstick.measure(std::max(shortest, share * cpu)));
        paces.push_back((before + pace) / 2);
        costs.push_back(cpu / paces.back());
        sum += cpu;
        if (sum > 20 * std::max(at_least, 0.01)) break;
    }
    const double typical = median(std::move(paces));
    return {.cpu = median(std::move(costs)) * typical, .yardstick = typical};
}

} // namespace bench
