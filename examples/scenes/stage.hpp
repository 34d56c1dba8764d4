// SPDX-License-Identifier: MIT
//
// What a scene needs of an engine: bodies, a structure, joints, steps, and where things are. One
// body of code per scene, whatever the engine; bullet_stage.cpp and ode_stage.cpp are the engines.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/fracture/coffin_manson.hpp"
#include "ductile/fracture/low_cycle_fatigue.hpp"
#include "ductile/joint/usual_joints.hpp"
#include "ductile/structure/built_structure.hpp"
#include "ductile/structure/structure_model.hpp"
#include "ductile/world/link_queries.hpp"
#include "ductile/world/stepped_world.hpp"
#include "joint_facts.hpp"
#include "recorder.hpp"

namespace ductile::scenes {

/// A hinge whose life ends by strain to and fro.
using FatigueAxisJoint = OneAxisJoint<Perfect<double>, LowCycleFatigue<CoffinManson<double>>>;

/// A box with its axes along the world's, or turned.
struct BoxBody {
    std::string name;
    double mass = 0; ///< [kg]; 0: it does not move
    Vector3<double> half = Vector3<double>::Zero(), at = Vector3<double>::Zero(); ///< [m]
    Vector3<double> velocity = Vector3<double>::Zero();                           ///< [m/s]
    double friction = 0; ///< that of a pair is the product
    bool collides = true;
    bool sharp = false;  ///< what is no box meets its edges as they are, not rounded
    bool ball = false;   ///< of radius half.x
    bool driven = false; ///< moves as Stage::turn says, whatever acts on it
    Vector3<double> turned = Vector3<double>::Zero(); ///< rotation vector [rad]
};

struct StageParameters {
    double gravity = 9.81; ///< downwards, along -z [m/s²]
    /// Of frames, where the engine's World takes one; 0: steps as they are.
    double tolerance = 0;
    int budget = 256;  ///< solves of a frame
    bool floor = true; ///< at z = 0
};

class Stage {
  public:
    using BodyNumber = int;
    static constexpr BodyNumber ground = -1;

    virtual ~Stage() = default;
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    [[nodiscard]] virtual const char* engine() const = 0;
    /// False: frames are steps, whatever their length.
    [[nodiscard]] virtual bool keeps_tolerance() const = 0;

    virtual BodyNumber add(const BoxBody& box) = 0;
    /// One at a time; of its nodes those of `on` are places of the body `carrier`.
    virtual BuiltStructure& build(const StructureModel& model, BodyNumber carrier = ground,
                                  const std::vector<NodeId>& on = {}) = 0;
    /// Takes a member of it away, with its joints; the replay shows it where it was.
    void remove(std::string_view member);
    /// A plastic joint of six axes at `at`; the columns of `axes` are its x, y and z [m].
    virtual LinkQueries& connect(const std::string& name, BodyNumber a, BodyNumber b,
                                 const Vector3<double>& at, const Matrix3<double>& axes,
                                 const UsualSixAxisJoint& joint) = 0;

    /// A hinge about the unit vector `axis`; in all else the bodies are one [m].
    virtual JointQueries& hinge(const std::string& name, BodyNumber a, BodyNumber b,
                                const Vector3<double>& at, const Vector3<double>& axis,
                                const UsualAxisJoint& joint) = 0;
    virtual JointQueries& hinge(const std::string& name, BodyNumber a, BodyNumber b,
                                const Vector3<double>& at, const Vector3<double>& axis,
                                const FatigueAxisJoint& joint) = 0;
    /// Slides along the unit vector `axis`, held by `joint`; in all else the bodies are one [m].
    virtual JointQueries& slider(const std::string& name, BodyNumber a, BodyNumber b,
                                 const Vector3<double>& at, const Vector3<double>& axis,
                                 const UsualAxisJoint& joint) = 0;

    [[nodiscard]] virtual Vector3<double> place(BodyNumber body) const = 0;
    [[nodiscard]] virtual Vector3<double> velocity(BodyNumber body) const = 0;
    /// Columns: the body's axes, which were the world's [-].
    [[nodiscard]] virtual Matrix3<double> axes(BodyNumber body) const = 0;
    /// Fastest of all bodies [m/s].
    [[nodiscard]] virtual double speed() const = 0;
    virtual void set_velocity(BodyNumber body, const Vector3<double>& velocity) = 0;
    /// Turns a driven body in the coming step of `frame` [s], about z from `from` to `to` [rad].
    virtual void turn(BodyNumber body, double from, double to, double frame) = 0;
    /// At its centre of mass, for the coming step [N].
    virtual void push(BodyNumber body, const Vector3<double>& force) = 0;
    /// All bodies at rest.
    virtual void halt() = 0;
    virtual void set_gravity(double gravity) = 0;
    virtual void keep_awake() = 0;

    /// A frame; the contacts are the stage's. What is recorded is sampled.
    virtual void step(double frame) = 0;
    [[nodiscard]] virtual const SteppedWorld& world() const = 0;

    using Facts = std::vector<replay::Fact>;
    /// What is known of a joint by its name, section and material; to be said before it is
    /// recorded. Capacities follow from the joint itself.
    void describe(std::function<Facts(const std::string& joint)> words) {
        words_ = std::move(words);
    }
    /// Of all joints.
    void describe(Facts words) {
        describe([words = std::move(words)](const std::string&) { return words; });
    }
    /// From now on, all that was made so far.
    virtual void record(replay::Recorder& recorder) = 0;

  protected:
    Stage() = default;
    /// What the stage knows of a joint that it made.
    struct Known {
        Facts facts;                  ///< of capacities
        std::function<double()> life; ///< share used; empty: without end
    };
    template <class Made, class Joint>
    [[nodiscard]] static Known known_of(const Made& made, const Joint& joint, bool rotates) {
        if constexpr (std::is_same_v<Joint, UsualSixAxisJoint>) {
            return {replay::facts_of(joint), replay::life_used(made)};
        } else {
            return {replay::facts_of(joint, rotates), replay::life_used(made)};
        }
    }
    /// What is known of a joint by name, then its capacities.
    [[nodiscard]] Facts facts_of(const std::string& name, const Facts& capacities) const {
        Facts all = words_ ? words_(name) : Facts{};
        all.insert(all.end(), capacities.begin(), capacities.end());
        return all;
    }
    replay::Recorder* recorder_ = nullptr; ///< null: none

  private:
    std::function<Facts(const std::string&)> words_;
    [[nodiscard]] virtual BuiltStructure& structure() = 0;
    [[nodiscard]] virtual const void* body_of_structure(std::size_t number) const = 0;
    [[nodiscard]] virtual const JointQueries& joint_of_structure(std::size_t number) const = 0;
};

[[nodiscard]] std::unique_ptr<Stage> bullet_stage(const StageParameters& parameters);
[[nodiscard]] std::unique_ptr<Stage> ode_stage(const StageParameters& parameters);

} // namespace ductile::scenes
