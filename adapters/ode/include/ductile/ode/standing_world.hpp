// SPDX-License-Identifier: MIT
//
// Whether anything can come of the next part of a frame, told before it, so that a world in which
// nothing does has its contacts made once a part and keeps nothing to be put back.
//
//   still   no contact can close with more energy than counts: v²/(2 K) of a contact is no more
//           than what its two bodies have, and what pushes takes no more of it as far as they go.
//           Nothing is driven, nothing turns by more than 0.05 rad in the frame.
//   calm    no plastic joint that is awake flowed, moved or used more than half of its strength in
//           the last part, and nobody did anything since: velocities, forces, gravity, masses and
//           what joins bodies are as they were, and no state was put back into a joint. Of joints
//           of ODE's own, which may be motors, also PlasticMotor's, there are none.
//
// Not told: loads that grow to more than double within one part by anything else. Such a part
// stands, and the frame's report says what it misplaced.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ductile/frame/part_row.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/local_scope.hpp"
#include "ductile/ode/own_settings.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

/// How bodies that are awake move.
struct Stir {
    double kinetic = 0; ///< of those that can be moved [J]
    double most = 0;    ///< of one of them; infinite where something is driven [J]
    double speed = 0;   ///< of a point of one of them, at most [m/s]
    double spin = 0;    ///< [rad/s]
    double mass = 0;    ///< of all of them [kg]

    /// `length`: of the frame [s].
    [[nodiscard]] static Stir of(std::span<const dBodyID> bodies, double length) {
        constexpr double nothing = 1e-9; // [rad]
        Stir stir;
        for (dBodyID body : bodies) {
            if (dBodyIsEnabled(body) == 0) continue;
            const Vector3<double> velocity = linear_velocity(body), spin = angular_velocity(body);
            const double turns = norm(spin);
            double speed = norm(velocity);
            if (!can_move(body)) {
                if (speed > 0 || turns > 0) stir.most = std::numeric_limits<double>::infinity();
                continue;
            }
            dMass mass;
            dBodyGetMass(body, &mass);
            double energy = double(mass.mass) * speed * speed / 2;
            if (turns > 0) {
                const Matrix3<double> turn = matrix_to_core(dBodyGetRotation(body));
                const Vector3<double> own = transposed_times(turn, spin);
                energy += dot(own, times(matrix_to_core(mass.I), own)) / 2;
            }
            if (turns * length > nothing) speed += LocalScope::turning_speed(body);
            stir.mass += double(mass.mass);
            stir.kinetic += energy;
            stir.most = std::max(stir.most, energy);
            stir.speed = std::max(stir.speed, speed);
            stir.spin = std::max(stir.spin, turns);
        }
        return stir;
    }
};

class StandingWorld {
  public:
    /// A frame begins. `as_left`: hands did nothing but what is asked for here.
    void begin(dWorldID world, std::span<const dBodyID> bodies,
               std::span<PlasticConstraint* const> joints, bool as_left) {
        const Vector3<double> gravity = std::exchange(gravity_, gravity_of(world));
        calm_ = as_left && gravity == gravity_ && rows_calm_.size() == joints.size() &&
                std::all_of(bodies.begin(), bodies.end(), [&](dBodyID body) {
                    return !can_move(body) || has_none_but(our_joints(joints).made, body);
                });
        for (std::size_t i = 0; calm_ && i < joints.size(); ++i) {
            PlasticConstraint& joint = *joints[i];
            calm_ = rows_calm_[i] || !joint.is_awake_member();
        }
    }
    /// Before a part in which bodies move so.
    [[nodiscard]] bool is_calm(const Stir& bodies) {
        return bodies.mass == std::exchange(mass_, bodies.mass) && calm_;
    }

    /// A part, or a blow, is told of anew, joint by joint.
    void forget_rows() noexcept {
        rows_calm_.clear();
        calm_ = false;
    }
    /// There are others.
    void forget_joints() noexcept {
        forget_rows();
        ours_known_ = false;
    }
    [[nodiscard]] const OurJoints& our_joints(std::span<PlasticConstraint* const> joints) {
        if (std::exchange(ours_known_, true)) return ours_;
        ours_.clear();
        for (PlasticConstraint* joint : joints) {
            if (joint->island_rows() != nullptr) ours_.made.enter(joint->id());
            if (joint->motor() >= 0) ours_.ruled.enter(joint->id());
        }
        return ours_;
    }
    void note(std::span<const PartRow> of_joint) {
        rows_calm_.push_back(std::all_of(of_joint.begin(), of_joint.end(),
                                         [](const PartRow& row) { return row.is_calm(); }));
    }

  private:
    [[nodiscard]] static bool has_none_but(const AddressBook& joints, dBodyID body) {
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            if (!joints.has(dBodyGetJoint(body, i))) return false;
        }
        return true;
    }

    OurJoints ours_;
    bool ours_known_ = false;
    Vector3<double> gravity_{0, 0, 0};
    double mass_ = 0;
    std::vector<bool> rows_calm_; ///< by joint
    bool calm_ = false;
};

} // namespace ductile::ode
