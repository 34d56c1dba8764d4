// SPDX-License-Identifier: MIT
//
// The way of a driven body over a frame that is done in parts. Who drives it says where it is at
// the end of each frame; gone there with one velocity it would be kicked at the start of each, and
// a joint that could follow its acceleration flows. So its velocity goes on from frame to frame:
//
//   V, V₋   mean velocity over this frame and the last one           [m/s | rad/s]
//   v(t) = V + (V - V₋) (t/L - 1/2),   0 <= t <= L
//
// where V goes on as it did (driven_velocity.hpp); else v = V, as of what is set into motion at
// once. Both end where they should. Between two frames v jumps by (V - 2 V₋ + V₋₋)/2, O(L²).
#pragma once

#include "ductile/joint/link_types.hpp"
#include "ductile/vocabulary/vector.hpp"
#include "ductile/world/driven_velocity.hpp"

namespace ductile {

/// Of one body. Not thread-safe.
class DrivenCourse {
  public:
    /// A frame of `length` > 0 [s] with the mean velocities of `mean`.
    void begin(const BodyState<double>& mean, double length) noexcept {
        const Vector3<double> velocity = this->velocity(length_), spin = this->spin(length_);
        const BodyState<double> last = past_.at_start(mean, length);
        past_.booked(mean, length);
        velocity_ = mean.velocity;
        spin_ = mean.spin;
        change_ = difference(mean.velocity, last.velocity);
        turning_ = difference(mean.spin, last.spin);
        length_ = length;
        first_velocity_ = is_zero(change_) ? this->velocity(0) : velocity;
        first_spin_ = is_zero(turning_) ? this->spin(0) : spin;
    }

    /// `time` [s] after the frame's begin, as all that follows.
    [[nodiscard]] Vector3<double> velocity(double time) const noexcept {
        return sum(velocity_, scaled(time / length_ - 0.5, change_));
    }
    [[nodiscard]] Vector3<double> spin(double time) const noexcept {
        return sum(spin_, scaled(time / length_ - 0.5, turning_));
    }
    /// The same where a part begins that is then: what it jumps by between two frames it gains in
    /// the first part, as a jump would be a blow to its joints.
    [[nodiscard]] Vector3<double> part_velocity(double time) const noexcept {
        return time > 0 ? velocity(time) : first_velocity_;
    }
    [[nodiscard]] Vector3<double> part_spin(double time) const noexcept {
        return time > 0 ? spin(time) : first_spin_;
    }
    /// From where the frame began [m].
    [[nodiscard]] Vector3<double> way(double time) const noexcept {
        return sum(scaled(time, velocity_), scaled(bent(time), change_));
    }
    /// The same, as a rotation vector [rad].
    [[nodiscard]] Vector3<double> turn(double time) const noexcept {
        return sum(scaled(time, spin_), scaled(bent(time), turning_));
    }

  private:
    [[nodiscard]] double bent(double time) const noexcept {
        return time * (time / length_ - 1) / 2;
    }

    DrivenVelocity past_;
    Vector3<double> velocity_ = Vector3<double>::Zero(), spin_ = Vector3<double>::Zero();
    Vector3<double> change_ = Vector3<double>::Zero(), turning_ = Vector3<double>::Zero();
    Vector3<double> first_velocity_ = Vector3<double>::Zero(),
                    first_spin_ = Vector3<double>::Zero();
    double length_ = 1;
};

} // namespace ductile
