// SPDX-License-Identifier: MIT
//
// What was seen of a run: bodies, joints and energies over time, and what happened. Geometry is
// kept once; what changes is a column of samples. Knows no engine and no file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ductile::replay {

/// What a recording or a file of it does not allow: one line that says where and why.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Plain value.
struct Pose {
    std::array<double, 3> position{};       ///< of the centre of mass [m]
    std::array<double, 4> turn{1, 0, 0, 0}; ///< unit quaternion w, x, y, z
};

enum class ShapeKind { box, sphere, cylinder, plane };

struct Shape {
    ShapeKind kind = ShapeKind::box;
    /// Half lengths of a box; radius of a sphere; radius and half length, along z, of a cylinder;
    /// of a plane, whose normal is z, the half lengths that are drawn [m].
    std::array<double, 3> size{};
    Pose in_body;
};

struct Body {
    std::string name;
    std::vector<Shape> shapes; ///< none: it is not drawn
    bool moves = true;
};

/// A fact of a joint that a reader wants to know: "section", "box 100 x 100 x 4 mm".
using Fact = std::pair<std::string, std::string>;

struct Joint {
    std::string name;
    int a = -1, b = -1;           ///< bodies; -1: the ground
    std::array<double, 3> in_a{}; ///< where it is, from the centre of mass of A [m]
    bool turns = true;            ///< where it has one axis: a hinge, not a slider
    std::vector<Fact> facts;
};

/// Of one axis of a joint.
struct Curve {
    std::string axis;             ///< as JointAxis names it, or "axis"
    bool turns = true;            ///< a moment over an angle
    std::vector<double> force;    ///< [N | N m]
    std::vector<double> position; ///< [m | rad]
};

enum JointState : std::uint8_t { holds = 0, flowed = 1, broken = 2, unreliable = 4 };

struct JointSamples {
    std::vector<double> utilisation;    ///< [-]
    std::vector<double> plastic_travel; ///< [m | rad]
    std::vector<double> absorbed;       ///< [J]
    std::vector<double> residual;       ///< certificate [m/s | rad/s]
    std::vector<std::uint8_t> state;    ///< JointState, added up
    std::vector<double> life;  ///< share that is used, 1: it breaks; not a number: without end [-]
    std::vector<Curve> curves; ///< of what took most plastic work first; one at least
};

struct Event {
    double time = 0; ///< [s]
    std::string kind;
    int joint = -1; ///< -1: none that is recorded
    std::string name;
    double energy = 0; ///< that the joint has absorbed by then [J]
};

/// Plain value. Every column has as many samples as there are times.
struct Recording {
    std::string name, about, engine;
    std::vector<double> times; ///< [s], increasing
    std::vector<Body> bodies;
    std::vector<std::vector<Pose>> poses; ///< by body; one sample where it does not move
    std::vector<Joint> joints;
    std::vector<JointSamples> samples;                                 ///< by joint
    std::vector<std::pair<std::string, std::vector<double>>> energies; ///< named [J]
    std::vector<Event> events;                                         ///< in order of time
    std::vector<std::uint32_t> hashes; ///< of the poses, bit for bit, of each sample
};

/// @throws Error where there is nothing in it, a column is short, or an index points nowhere.
void check(const Recording& recording);

} // namespace ductile::replay
