// SPDX-License-Identifier: MIT
//
// The way of a driven body over a frame that is done in parts. Who drives it says where it is at
// the end of each frame; gone there with one velocity it would be kicked at the start of each, and
// a joint that could follow its acceleration flows. So its velocity goes on from frame to frame:
//
//   V      mean velocity over this frame, of length L                       [m/s | rad/s]
//   a, a₋  its change since the last frame by the time between their middles, and that of the last
//   v(0)   what the last frame ended with
//   v(L) = V + a L/2 + (a - a₋) L/4
//
// linear between, where V goes on as it did (driven_velocity.hpp); else v = V, as of what is set
// into motion at once. A joint counts the travel of v. That of a frame is off by (v(0) + v(L))/2 -
// V = -(Δa - Δa₋) L/8, Δa = a - a₋: over many frames by what Δa has changed in all, however long
// they are. Were v(L) without its last term it would be off by -Δa L/4 in each, a share of (ω L)²/4
// of what goes to and fro as sin ωt. The body itself goes from end to end of its frames.
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
        velocity_.begin(mean.velocity, length);
        spin_.begin(mean.spin, length);
        length_ = length;
    }

    /// `time` [s] after the frame's begin, as all that follows.
    [[nodiscard]] Vector3<double> velocity(double time) const noexcept {
        return velocity_.at(time / length_);
    }
    [[nodiscard]] Vector3<double> spin(double time) const noexcept {
        return spin_.at(time / length_);
    }
    /// The change of its place with time, whose mean over the frame is V.
    [[nodiscard]] Vector3<double> going(double time) const noexcept {
        return sum(velocity(time), velocity_.missing());
    }
    [[nodiscard]] Vector3<double> turning(double time) const noexcept {
        return sum(spin(time), spin_.missing());
    }
    /// From where the frame began [m].
    [[nodiscard]] Vector3<double> way(double time) const noexcept {
        return scaled(time, going(time / 2));
    }
    /// The same, as a rotation vector [rad].
    [[nodiscard]] Vector3<double> turn(double time) const noexcept {
        return scaled(time, turning(time / 2));
    }

  private:
    /// Linear or angular.
    class Velocity {
      public:
        void begin(const Vector3<double>& mean, double length) noexcept {
            past_.book(mean, length);
            start_ = past_.smooth > 0 ? end_ : mean;
            end_ = mean;
            if (past_.smooth > 0) end_ = sum(end_, scaled(length / 2, past_.slope));
            if (past_.smooth > 1) end_ = sum(end_, scaled(length / 4, past_.change));
        }
        [[nodiscard]] Vector3<double> at(double share) const noexcept {
            return sum(start_, scaled(share, difference(end_, start_)));
        }
        [[nodiscard]] Vector3<double> missing() const noexcept {
            return difference(past_.value, at(0.5));
        }

      private:
        DrivenPast past_;
        Vector3<double> start_ = Vector3<double>::Zero(), end_ = Vector3<double>::Zero();
    };

    Velocity velocity_, spin_;
    double length_ = 1; ///< L [s]
};

} // namespace ductile
