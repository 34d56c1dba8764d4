// SPDX-License-Identifier: MIT
//
// Samples a World at a rate, whatever its engine:
//
//   replay::Recorder recorder({.name = "gate", .engine = "bullet", .rate = 60});
//   replay::add_body(recorder, car, "car");        // of_bullet.hpp, of_ode.hpp
//   replay::add_joint(recorder, foot, "foot");
//   while (world.time() < 4) {
//       world.step(1.0 / 60);
//       recorder.look(world);
//   }
//   write_html(recorder.finish(), "gate.html");    // write_html.hpp
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "ductile/world/joint_queries.hpp"
#include "ductile/world/stepped_world.hpp"
#include "recording.hpp"

namespace ductile::replay {

struct RecorderParameters {
    std::string name;   ///< of the scene
    std::string about;  ///< a sentence or two: the problem, and what must come out
    std::string engine; ///< and what else tells runs apart
    double rate = 60;   ///< samples a second, > 0
};

/// Not thread-safe.
class Recorder {
  public:
    /// @throws Error where the rate is not positive and finite.
    explicit Recorder(RecorderParameters parameters);

    /// @param key   the engine's body
    /// @param pose  where the body is now; of one that does not move asked once. Must stay valid
    ///              until `finish` or `remove`, from when on it stays where it was.
    /// @throws Error where this body was added already
    void add(const void* key, Body body, std::function<Pose()> pose);
    /// `joint` must stay valid until `finish` or `remove`; its World must know it by this name.
    /// @param life  share of its life that is used, 1 where it breaks (joint_facts.hpp); nothing:
    ///              it is not known, or has no end
    /// @throws Error where this joint, or one of the name, was added already
    void add(Joint joint, const JointQueries& queries, std::function<double()> life = {});
    void remove(const void* body);
    void remove(const JointQueries& joint);
    /// Number of an engine's body; -1 where it is not known, as the ground is not.
    [[nodiscard]] int number(const void* body) const;

    /// To be called after each step: samples where the time for it has come, takes the events.
    void look(const SteppedWorld& world);
    /// What was seen so far. @throws Error where nothing was.
    [[nodiscard]] Recording finish() const;

  private:
    /// Of one axis of a joint, while it is not known whether it is shown.
    struct Axis {
        std::string name;
        bool turns = true;
        std::vector<double> force, position;
        double flowed = 0;  ///< force × plastic travel so far [J]
        double largest = 0; ///< force so far [N | N m]
        // of the last step
        double last_force = 0, last_position = 0, plastic = 0; ///< [N | N m], [m | rad]
        void book(double now_force, double now_position, double offset);
    };
    struct SeenJoint {
        const JointQueries* queries;
        std::function<double()> life;
        std::vector<Axis> axes;
    };

    void book_axes(SeenJoint& seen);
    void sample(const SteppedWorld& world);
    void sample_bodies();
    void sample_joint(std::size_t number);
    void sample_energies(const SteppedWorld& world);
    [[nodiscard]] static std::vector<Curve> curves(const SeenJoint& joint);

    RecorderParameters parameters_;
    Recording recording_;
    std::vector<std::function<Pose()>> sources_;
    std::vector<SeenJoint> joints_;
    std::map<std::string, int> by_name_; ///< joints
    std::map<const void*, int> by_body_;
    double next_ = 0;
};

} // namespace ductile::replay
