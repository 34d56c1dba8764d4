// SPDX-License-Identifier: MIT
//
// Where a link is: the frames of its two bodies, the arms from their centres of mass, and the
// position of frame A in frame B. Symbols as in link.hpp.
//
// A step looks at the bodies twice, after the solve and before the next one, and mostly sees the
// same: what was worked out once is kept for as long as neither body has moved.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numbers>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/vocabulary/angle.hpp"
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
        finite_ = is_finite(axes_) && is_finite(displacement_) && is_finite(orientation_);
    }

    /// Largest turn of a body in a step of `time` [s], 0 where the joint could follow it, with the
    /// bodies as they are after the step and last looked at before it [rad]. It cannot where they
    /// turned by π or more relative to each other, as an orientation does not say by how much, and
    /// where their engine turned them otherwise than they spin.
    [[nodiscard]] S unseen_turn(const BodyState<S>& a, const BodyState<S>& b,
                                S time) const noexcept;

    // ---- as last looked at

    [[nodiscard]] bool finite() const noexcept { return finite_; } ///< both bodies were somewhere
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
            if (conjugate_) {
                moment_axes_ = times_transposed(axes_, rotation_vector_rate(elastic_rotation_));
            }
            turned_ = false;
        }
        return elastic_rotation_;
    }
    /// From now on the rows of rotation are those of ė.
    void make_conjugate() noexcept { conjugate_ = turned_ = true; }
    /// Directions of the moment rows as columns, world: those of B, or of ė about them.
    [[nodiscard]] const Matrix3<S>& moment_axes() const noexcept {
        if (!conjugate_) return axes_;
        (void)elastic_rotation();
        return moment_axes_;
    }
    [[nodiscard]] const Matrix3<S>& rest() const noexcept { return rest_; } ///< R_p
    void set_rest(const Matrix3<S>& rest) noexcept {
        rest_ = rest;
        turned_ = true;
    }

    /// Velocity of A minus that of B at the joint, and of their turning, world axes [m/s, rad/s].
    [[nodiscard]] Vector6<S> twist_in_world(const BodyState<S>& a,
                                            const BodyState<S>& b) const noexcept {
        return twist_of(relative_velocity(a, b), difference(a.spin, b.spin));
    }
    /// The same along the rows: the axes of frame B, and moment_axes [m/s, rad/s].
    [[nodiscard]] Vector6<S> twist(const BodyState<S>& a, const BodyState<S>& b) const noexcept {
        return twist_of(transposed_times(axes_, relative_velocity(a, b)),
                        transposed_times(moment_axes(), difference(a.spin, b.spin)));
    }
    /// One entry of it, along the axes of frame B.
    [[nodiscard]] S twist_along(std::size_t axis, const BodyState<S>& a,
                                const BodyState<S>& b) const noexcept {
        if (axis >= 3) {
            return dot(column(axes_, int(axis) - 3), difference(a.spin, b.spin));
        }
        return dot(column(axes_, int(axis)), relative_velocity(a, b));
    }
    /// What the turning of the bodies does to the rows in a part of `dt` [s], in the middle of
    /// which they are, while they hold A at the displacement `rest`; `slides`: they will go on
    /// moving as they do.
    [[nodiscard]] RowTurning<S> turning(const BodyState<S>& a, const BodyState<S>& b,
                                        const Vector3<S>& rest, S dt, bool slides) const noexcept;
    /// Speed of A at the joint [m/s].
    [[nodiscard]] S speed_of_a(const BodyState<S>& a) const noexcept {
        return norm(sum(a.velocity, cross(a.spin, arm_a_)));
    }
    [[nodiscard]] BodyAtJoint<S> at_joint(const BodyState<S>& body) const noexcept {
        return {body.inverse_mass, body.inverse_inertia, difference(point_, body.position)};
    }
    /// The twist in the world of which `along_rows` is that along the rows.
    [[nodiscard]] Vector6<S> in_world(const Vector6<S>& along_rows) const noexcept {
        const Vector3<S> turning = angular(along_rows);
        return twist_of(times(axes_, linear(along_rows)),
                        conjugate_ ? transposed_times(numeric::inverse(moment_axes()), turning)
                                   : times(axes_, turning));
    }
    /// Forces of the rows that together are a force and a moment at the joint, world axes.
    [[nodiscard]] Vector6<S> along_rows(const Vector3<S>& force,
                                        const Vector3<S>& moment) const noexcept {
        return twist_of(transposed_times(axes_, force),
                        conjugate_ ? times(numeric::inverse(moment_axes()), moment)
                                   : transposed_times(axes_, moment));
    }
    /// K of the rows.
    [[nodiscard]] Matrix6<S> inverse_mass(const BodyState<S>& a,
                                          const BodyState<S>& b) const noexcept {
        Matrix6<S> k = inverse_mass_of_rows(a, b, point_, axes_);
        if (!conjugate_) return k;
        const Matrix3<S> rate = rotation_vector_rate(elastic_rotation());
        const Matrix3<S> across = times_transposed(block(k, 0, 3), rate);
        set_block(k, 0, 3, across);
        set_block(k, 3, 0, transposed(across));
        set_block(k, 3, 3, sandwiched(rate, block(k, 3, 3)));
        return k;
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

    /// By how much a body was turned less than it spins, world axes [rad].
    [[nodiscard]] static Vector3<S> missed_turn(const Place& before, const BodyState<S>& after,
                                                const Vector3<S>& turn) noexcept {
        // a body that its engine moves before the solve
        if (before.orientation == after.orientation) return Vector3<S>::Zero();
        return rotation_vector<S>(
            times_transposed(turned_by(turn, before.orientation), after.orientation));
    }

    [[nodiscard]] Vector3<S> relative_velocity(const BodyState<S>& a,
                                               const BodyState<S>& b) const noexcept {
        return difference(sum(a.velocity, cross(a.spin, arm_a_)),
                          sum(b.velocity, cross(b.spin, arm_b_)));
    }

    JointFrame<S> in_a_, in_b_;
    Matrix3<S> rest_ = Matrix3<S>::Identity();
    Place seen_a_, seen_b_; ///< nowhere at first
    bool finite_ = true;
    Matrix3<S> axes_ = Matrix3<S>::Identity();
    Vector3<S> point_ = Vector3<S>::Zero();
    Vector3<S> arm_a_ = Vector3<S>::Zero();
    Vector3<S> arm_b_ = Vector3<S>::Zero();
    Vector3<S> displacement_ = Vector3<S>::Zero();
    Matrix3<S> orientation_ = Matrix3<S>::Identity(); ///< R
    mutable Vector3<S> elastic_rotation_ = Vector3<S>::Zero();
    mutable Matrix3<S> moment_axes_ = Matrix3<S>::Identity(); ///< of rows of ė
    mutable bool turned_ = true;                              ///< e is to be worked out anew
    bool conjugate_ = false;
};

template <std::floating_point S>
RowTurning<S> LinkPose<S>::turning(const BodyState<S>& a, const BodyState<S>& b,
                                   const Vector3<S>& rest, S dt, bool slides) const noexcept {
    // [rad]: below, nothing is noticed; beyond, a part is no picture of the motion any more, and
    // the whole of it would make rows swing
    constexpr S least = S(1e-5), largest = small_turn<S> / 2;
    const S turn_a = dot(a.spin, a.spin) * dt * dt, turn_b = dot(b.spin, b.spin) * dt * dt;
    if (!(turn_a + turn_b > least * least) || !std::isfinite(turn_a + turn_b)) return {};
    RowTurning<S> result;
    Vector3<S> across = Vector3<S>::Zero(), along = across;
    // on a circle of radius r the way through its middle is a tangent at both ends of a part:
    // w = 2 r (1/cos φ - cos φ)/dt, o = 2 r (sin φ - φ/cos φ)/dt, φ half the turn
    const auto add = [&](const Vector3<S>& spin, const Vector3<S>& arm, S turn, S sign) {
        if (!(turn > 0)) return;
        const S half = std::sqrt(turn) / 2, bounded = std::min(half, largest);
        const S sine = std::sin(bounded), cosine = std::cos(bounded);
        const Vector3<S> swept = cross(spin, arm);
        constexpr S beyond = S(1.01); // not by round-off
        if (half > beyond * largest) {
            result.turn = std::max(result.turn, 2 * half);
            result.swept = std::max(result.swept, norm(swept));
        }
        across =
            sum(across, scaled(sign * sine * sine / cosine * 2 * dt / turn, cross(spin, swept)));
        along = difference(along, scaled(sign * (sine - bounded / cosine) / half, swept));
    };
    result.driven =
        std::sqrt(std::max(a.inverse_mass > 0 ? S(0) : turn_a, b.inverse_mass > 0 ? S(0) : turn_b));
    add(a.spin, arm_a_, turn_a, 1);
    add(b.spin, sum(times(b.orientation, in_b_.origin), times(axes_, rest)), turn_b, -1);
    Vector3<S> turned = Vector3<S>::Zero();
    if (slides) {
        const Vector3<S> way = difference(relative_velocity(a, b), sum(across, along));
        if (!is_finite(way)) return {};
        // farther it would give more than there is, from part to part: 10^160 J of 10^7 J
        if (turn_b <= 4 * largest * largest) {
            across = difference(across, scaled(dt, cross(b.spin, way)));
            turned = scaled(-dt / 2, cross(b.spin, a.spin));
        }
    }
    result.across =
        twist_of(transposed_times(axes_, across), transposed_times(moment_axes(), turned));
    result.along = twist_of(transposed_times(axes_, along), Vector3<S>(Vector3<S>::Zero()));
    return result;
}

template <std::floating_point S>
S LinkPose<S>::unseen_turn(const BodyState<S>& a, const BodyState<S>& b, S time) const noexcept {
    const Vector3<S> turn_a = scaled(time, a.spin), turn_b = scaled(time, b.spin);
    const S square = std::max(dot(turn_a, turn_a), dot(turn_b, turn_b));
    if (!(square > small_turn<S> * small_turn<S>)) return 0;
    const S most = std::sqrt(square), allowed = allowed_miss<S>;
    if (norm(difference(turn_a, turn_b)) >= std::numbers::pi_v<S>) return most;
    const Vector3<S> missed_a = missed_turn(seen_a_, a, turn_a);
    const Vector3<S> missed_b = missed_turn(seen_b_, b, turn_b);
    const S gap = norm(difference(cross(missed_a, arm_a_), cross(missed_b, arm_b_)));
    const S swept = norm(cross(turn_a, arm_a_)) + norm(cross(turn_b, arm_b_));
    return norm(difference(missed_a, missed_b)) > allowed * most || gap > allowed * swept ? most
                                                                                          : S(0);
}

} // namespace ductile
