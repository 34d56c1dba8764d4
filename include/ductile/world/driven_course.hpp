// SPDX-License-Identifier: MIT
//
// The way of a driven body over a frame that is done in parts. Who drives it says where it is at
// the end of each frame; gone there with one velocity it would be kicked at the start of each, and
// a joint that could follow its acceleration flows. So its velocity goes on from frame to frame:
//
//   V      mean velocity over this frame, of length L                       [m/s | rad/s]
//   a, a₋  its change since the last frame by the time between their middles, and that of the last
//   v(0)   what the last frame ended with
//   v(L) = V + a L/2 + (a - a₋) L/3, as a parabola has it whose means are those of three frames
//
// in between the parabola of mean V, where V goes on as it did (driven_velocity.hpp); else v = V,
// as of what is set into motion at once. Before its first frame a body is taken to have been at
// rest. So a joint counts the very way that the body goes. Where a motion begins its first change
// is a jump, until the next frame shows that it goes on: then it was misread, as is told.
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

    /// The change of the last frame was taken for a jump, and goes on in this one.
    [[nodiscard]] bool was_misread() const noexcept {
        return velocity_.was_misread() || spin_.was_misread();
    }

    /// `time` [s] after the frame's begin, as all that follows.
    [[nodiscard]] Vector3<double> velocity(double time) const noexcept {
        return velocity_.at(time / length_);
    }
    [[nodiscard]] Vector3<double> spin(double time) const noexcept {
        return spin_.at(time / length_);
    }
    /// In the second half of a part of `h` [s] that began then, the first half of which it went
    /// with the velocity that it had.
    [[nodiscard]] Vector3<double> later_velocity(double time, double h) const noexcept {
        return later(velocity(time), way(time), way(time + h), h);
    }
    [[nodiscard]] Vector3<double> later_spin(double time, double h) const noexcept {
        return later(spin(time), turn(time), turn(time + h), h);
    }
    /// From where the frame began [m].
    [[nodiscard]] Vector3<double> way(double time) const noexcept {
        return scaled(length_, velocity_.gone(time / length_));
    }
    /// The same, as a rotation vector [rad].
    [[nodiscard]] Vector3<double> turn(double time) const noexcept {
        return scaled(length_, spin_.gone(time / length_));
    }

  private:
    [[nodiscard]] static Vector3<double> later(const Vector3<double>& before,
                                               const Vector3<double>& from,
                                               const Vector3<double>& to, double h) noexcept {
        return difference(scaled(2 / h, difference(to, from)), before);
    }

    /// Linear or angular.
    class Velocity {
      public:
        void begin(const Vector3<double>& mean, double length) noexcept {
            constexpr double noticed = 0.25, rest = 1e-6; // of that change; of its speed
            const Vector3<double> jump = past_.slope;
            const bool rested = dot(past_.value, past_.value) <= rest * rest * dot(mean, mean);
            past_.book(mean, length);
            misread_ =
                began_ && past_.smooth > 0 && dot(past_.slope, jump) > noticed * dot(jump, jump);
            began_ = rested && dot(mean, mean) > 0;
            start_ = past_.smooth > 0 ? end_ : mean;
            end_ = mean;
            if (past_.smooth > 0) end_ = sum(end_, scaled(length / 2, past_.slope));
            if (past_.smooth > 1) end_ = sum(end_, scaled(length / 3, past_.change));
        }
        [[nodiscard]] bool was_misread() const noexcept { return misread_; }
        [[nodiscard]] Vector3<double> at(double s) const noexcept {
            const Vector3<double> straight = sum(start_, scaled(s, difference(end_, start_)));
            return sum(straight, scaled(6 * s * (1 - s), bent()));
        }
        /// Integral of `at` [m/s | rad/s].
        [[nodiscard]] Vector3<double> gone(double s) const noexcept {
            const Vector3<double> change = difference(end_, start_);
            const Vector3<double> straight = sum(scaled(s, start_), scaled(s * s / 2, change));
            return sum(straight, scaled(s * s * (3 - 2 * s), bent()));
        }

      private:
        /// What its mean is more than that of its ends.
        [[nodiscard]] Vector3<double> bent() const noexcept {
            return difference(past_.value, scaled(0.5, sum(start_, end_)));
        }

        DrivenPast past_{.steps = 1}; ///< at rest, until it is known
        bool began_ = false, misread_ = false;
        Vector3<double> start_ = Vector3<double>::Zero(), end_ = Vector3<double>::Zero();
    };

    Velocity velocity_, spin_;
    double length_ = 1; ///< L [s]
};

} // namespace ductile
