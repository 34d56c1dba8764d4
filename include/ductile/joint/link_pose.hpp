// SPDX-License-Identifier: MIT
//
// Where a link is: the frames of its two bodies, the arms from their centres of mass, and the
// position of frame A in frame B. Symbols as in link.hpp.
//
// A step looks at the bodies twice, after the solve and before the next one, and mostly sees the
// same: what was worked out once is kept for as long as neither body has moved.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <limits>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// Plain value.
template <std::floating_point S>
class LinkPose {
  public:
    LinkPose(const JointFrame<S>& in_a, const JointFrame<S>& in_b) : in_a_(in_a), in_b_(in_b) {}

    [[nodiscard]] const JointFrame<S>& frame_in_a() const noexcept { return in_a_; }
    [[nodiscard]] const JointFrame<S>& frame_in_b() const noexcept { return in_b_; }

    /// True where neither body has moved since the last look, to the last bit.
    [[nodiscard]] bool is_now(const BodyState<S>& a, const BodyState<S>& b) const noexcept {
        return seen_a_.is(a) && seen_b_.is(b);
    }
    /// Looks where the bodies are now.
    void look(const BodyState<S>& a, const BodyState<S>& b) noexcept {
        if (is_now(a, b)) return;
        seen_a_ = {a.position, a.orientation};
        seen_b_ = {b.position, b.orientation};
        turned_ = true;
        axes_ = times(b.orientation, in_b_.axes);
        arm_a_ = times(a.orientation, in_a_.origin);
        point_ = sum(a.position, arm_a_);
        arm_b_ = difference(point_, b.position);
        displacement_ =
            transposed_times(axes_, difference(arm_b_, times(b.orientation, in_b_.origin)));
        orientation_ = transposed_times(axes_, times(a.orientation, in_a_.axes));
    }

    // ---- as last looked at

    [[nodiscard]] const Matrix3<S>& axes() const noexcept { return axes_; }   ///< of B, world
    [[nodiscard]] const Vector3<S>& point() const noexcept { return point_; } ///< world [m]
    [[nodiscard]] const Vector3<S>& arm_a() const noexcept { return arm_a_; } ///< world [m]
    [[nodiscard]] const Vector3<S>& arm_b() const noexcept { return arm_b_; }
    [[nodiscard]] const Vector3<S>& displacement() const noexcept { return displacement_; } ///< d
    [[nodiscard]] const Matrix3<S>& orientation() const noexcept { return orientation_; }   ///< R

    /// e = log(R R_pᵀ) [rad].
    [[nodiscard]] const Vector3<S>& elastic_rotation() const noexcept {
        if (turned_) {
            elastic_rotation_ = rotation_vector<S>(times_transposed(orientation_, rest_));
            turned_ = false;
        }
        return elastic_rotation_;
    }
    [[nodiscard]] const Matrix3<S>& rest() const noexcept { return rest_; } ///< R_p
    void set_rest(const Matrix3<S>& rest) noexcept {
        rest_ = rest;
        turned_ = true;
        ++rest_changes_;
    }
    /// How often R_p was set, as it is with every flow: who keeps what depends on the rest position
    /// need not compare.
    [[nodiscard]] unsigned rest_changes() const noexcept { return rest_changes_; }

    /// Velocity of A minus that of B at the joint, and of their turning, along the axes of frame B
    /// [m/s, rad/s].
    [[nodiscard]] Vector6<S> twist(const BodyState<S>& a, const BodyState<S>& b) const noexcept {
        return twist_of(transposed_times(axes_, relative_velocity(a, b)),
                        transposed_times(axes_, difference(a.spin, b.spin)));
    }
    /// One entry of it.
    [[nodiscard]] S twist_along(std::size_t axis, const BodyState<S>& a,
                                const BodyState<S>& b) const noexcept {
        if (axis >= 3) {
            return dot(column(axes_, int(axis) - 3), difference(a.spin, b.spin));
        }
        return dot(column(axes_, int(axis)), relative_velocity(a, b));
    }
    /// Speed of A at the joint [m/s].
    [[nodiscard]] S speed_of_a(const BodyState<S>& a) const noexcept {
        return norm(sum(a.velocity, cross(a.spin, arm_a_)));
    }
    [[nodiscard]] BodyAtJoint<S> at_joint(const BodyState<S>& body) const noexcept {
        return {body.inverse_mass, body.inverse_inertia, difference(point_, body.position)};
    }
    /// Entries along the axes of frame B, seen in the world.
    [[nodiscard]] Vector6<S> in_world(const Vector6<S>& of_frame_b) const noexcept {
        return twist_of(times(axes_, linear(of_frame_b)), times(axes_, angular(of_frame_b)));
    }

  private:
    /// A body's place when it was last looked at.
    struct Place {
        Vector3<S> position = Vector3<S>::Constant(std::numeric_limits<S>::quiet_NaN());
        Matrix3<S> orientation = Matrix3<S>::Zero();

        [[nodiscard]] bool is(const BodyState<S>& body) const noexcept {
            return std::memcmp(position.data(), body.position.data(), 3 * sizeof(S)) == 0 &&
                   std::memcmp(orientation.data(), body.orientation.data(), 9 * sizeof(S)) == 0;
        }
    };

    [[nodiscard]] Vector3<S> relative_velocity(const BodyState<S>& a,
                                               const BodyState<S>& b) const noexcept {
        return difference(sum(a.velocity, cross(a.spin, arm_a_)),
                          sum(b.velocity, cross(b.spin, arm_b_)));
    }

    JointFrame<S> in_a_, in_b_;
    Matrix3<S> rest_ = Matrix3<S>::Identity();
    unsigned rest_changes_ = 0;
    Place seen_a_, seen_b_; ///< nowhere at first
    Matrix3<S> axes_ = Matrix3<S>::Identity();
    Vector3<S> point_ = Vector3<S>::Zero();
    Vector3<S> arm_a_ = Vector3<S>::Zero();
    Vector3<S> arm_b_ = Vector3<S>::Zero();
    Vector3<S> displacement_ = Vector3<S>::Zero();
    Matrix3<S> orientation_ = Matrix3<S>::Identity(); ///< R
    mutable Vector3<S> elastic_rotation_ = Vector3<S>::Zero();
    mutable bool turned_ = true; ///< e is to be worked out anew
};

} // namespace ductile
