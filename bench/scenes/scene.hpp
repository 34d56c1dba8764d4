// SPDX-License-Identifier: MIT
//
// A scene with a known answer, described without any engine: bodies, the joints under test, what
// else holds or pushes the bodies, and the quantities to compare. bench/engines builds it in an
// engine and bench/methods holds its joints; pareto, frames and the tests share the
// descriptions.
//
// World axes, SI units. Contact points come from exact geometry, the same for every engine, so that
// a figure speaks of the joint and not of collision detection (examples/charpy/edge_contact.hpp).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "charpy/edge_contact.hpp"

namespace bench {

using Vector = Eigen::Vector3d;
using Rotation = Eigen::Matrix3d;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// Index of the static world where a body is asked for.
inline constexpr int ground = -1;

struct BodyState {
    Vector position = Vector::Zero(); ///< of the centre of mass [m]
    Rotation rotation = Rotation::Identity();
    Vector velocity = Vector::Zero(); ///< [m/s]
    Vector spin = Vector::Zero();     ///< [rad/s]

    [[nodiscard]] Vector point(const Vector& local) const { return position + rotation * local; }
    [[nodiscard]] Vector velocity_at(const Vector& point) const {
        return velocity + spin.cross(point - position);
    }
};

struct BodySpec {
    double mass = 1;                 ///< [kg]
    Vector inertia = Vector::Ones(); ///< principal, along the axes of the body [kg m²]
    BodyState start = {};
    bool weightless = false;
    Vector force = Vector::Zero(); ///< constant, at the centre of mass [N]
    double radius = 1; ///< of a sphere about the centre that holds all that may touch [m]
};

enum class Motion { turns, slides };

/// A joint under test: rigid but for one axis. Body a moves relative to body b.
struct JointSpec {
    int a = 0;
    int b = ground;
    Motion motion = Motion::turns;
    Vector anchor = Vector::Zero(); ///< [m]
    Vector axis = Vector::UnitZ();  ///< unit vector, along it the joint turns or slides
    double strength = 0;            ///< plastic moment or axial strength [N m | N]
    double stiffness = infinity;    ///< elastic [N m/rad | N/m]; infinite: rigid-plastic
    double limit = infinity;        ///< plastic travel at which it breaks [rad | m]
};

/// The engine's own frictionless hinge or slider between a body and the ground: not under test.
struct GuideSpec {
    int body = 0;
    Motion motion = Motion::turns;
    Vector anchor = Vector::Zero();
    Vector axis = Vector::UnitZ();
};

/// How near two parts are and how fast they close, for the choice of the step.
struct Approach {
    double gap = infinity;    ///< [m]
    double closing_speed = 0; ///< [m/s]
};

/// Frictionless, perfectly inelastic contact. `a` carries the edge or point (or is the ground), `b`
/// the face; points are on a, normals point from b to a.
struct ContactSpec {
    int a = ground;
    int b = 0;
    double thickness = 1; ///< of the thinner part, along the normal [m]
    std::function<charpy::EdgeContact(const BodyState& a, const BodyState& b, double margin)> touch;
    /// Empty for a contact of which nothing approaches.
    std::function<Approach(const BodyState& a, const BodyState& b)> approach = {};
};

/// What is known of a run at one moment.
struct Observation {
    double time = 0;
    std::vector<BodyState> bodies;
    std::vector<double> travel;      ///< of each joint, from its start, not wrapped [rad | m]
    std::vector<double> peak_travel; ///< largest |travel| so far
    std::optional<double>
        absorbed; ///< energy all joints say they absorbed; none: they keep no account [J]
};

struct Quantity {
    std::string name;
    double expected = 0;
    std::function<std::optional<double>(const Observation&)> value;
};

struct Scene {
    std::string name;
    std::string source; ///< of the expected values
    std::vector<BodySpec> bodies;
    std::vector<JointSpec> joints;
    std::vector<GuideSpec> guides = {};
    std::vector<ContactSpec> contacts = {};
    Vector gravity = Vector::Zero(); ///< [m/s²]
    double duration = 1;             ///< [s]
    /// The first is the one that the summary and the pictures show.
    std::vector<Quantity> quantities;
    /// Velocity at which contacts yield per force [m/(N s)]. More than zero where there are more
    /// contact rows than the bodies have freedoms, on which direct solvers fail; such contacts are
    /// also made slightly unlike each other, as in examples/charpy.
    double contact_compliance = 0;
};

/// The absorbed energy as a quantity: missing for methods without an account.
[[nodiscard]] inline Quantity absorbed_energy(double expected) {
    return {"absorbed_energy", expected, [](const Observation& o) { return o.absorbed; }};
}

/// Kinetic energy of a body [J].
[[nodiscard]] inline double kinetic(const BodySpec& body, const BodyState& state) {
    const Vector turning = state.rotation.transpose() * state.spin;
    return (body.mass * state.velocity.squaredNorm() +
            turning.dot(body.inertia.cwiseProduct(turning))) /
           2;
}
/// Potential energy of a body, from the origin [J].
[[nodiscard]] inline double potential(const Scene& scene, const BodySpec& body,
                                      const BodyState& state) {
    const Vector weight = body.weightless ? Vector::Zero() : Vector(body.mass * scene.gravity);
    return -(weight + body.force).dot(state.position);
}

/// 1/(J M⁻¹ Jᵀ) of a joint's row with its bodies free of all others [kg m² | kg].
[[nodiscard]] inline double effective_mass(const Scene& scene, const JointSpec& joint) {
    const auto inverse = [&](int index) {
        if (index == ground) return 0.0;
        const BodySpec& body = scene.bodies[std::size_t(index)];
        if (joint.motion == Motion::slides) return 1 / body.mass;
        const Vector axis = body.start.rotation.transpose() * joint.axis;
        return axis.dot(axis.cwiseQuotient(body.inertia));
    };
    return 1 / (inverse(joint.a) + inverse(joint.b));
}

/// Speed of a joint: body a relative to body b [rad/s | m/s].
[[nodiscard]] inline double row_speed(const JointSpec& joint, const BodyState& a,
                                      const BodyState& b) {
    const Vector axis = b.rotation * joint.axis;
    return joint.motion == Motion::turns ? axis.dot(a.spin - b.spin)
                                         : axis.dot(a.velocity - b.velocity);
}

/// Where a joint is, relative to its start; follows a turning joint through many turns as long as
/// it turns less than π between two calls.
class Travel {
  public:
    Travel(const JointSpec& joint, const BodyState& a, const BodyState& b)
        : joint_(joint), start_(raw(a, b)), relative_start_(b.rotation.transpose() * a.rotation) {}

    double update(const BodyState& a, const BodyState& b) {
        if (joint_.motion == Motion::slides) return value_ = raw(a, b) - start_;
        const Eigen::Quaterniond turn(
            Rotation(b.rotation.transpose() * a.rotation * relative_start_.transpose()));
        const double angle = 2 * std::atan2(turn.vec().dot(joint_.axis), turn.w());
        return value_ += std::remainder(angle - value_, 2 * std::acos(-1.0));
    }

  private:
    [[nodiscard]] double raw(const BodyState& a, const BodyState& b) const {
        return (b.rotation * joint_.axis).dot(a.position - b.position);
    }

    JointSpec joint_;
    double start_;
    Rotation relative_start_;
    double value_ = 0;
};

} // namespace bench
