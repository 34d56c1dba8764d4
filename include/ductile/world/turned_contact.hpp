// SPDX-License-Identifier: MIT
//
// How fast a contact closes only because it turned. In a part of a frame (frame/README.md) contacts
// are solved as they are in its middle. Asked to close no more there, a contact that turns with its
// bodies takes F h (J' v)/2 of energy in each part, of the order of h over all of them. So it is
// asked to be where it should at the end: it comes to the solve at w and leaves it at -w, as rows
// of joints do (joint/any_link.hpp). w is the difference between two geometries, of the same
// velocities:
//
//   c(g) = -n_g·(v_A + ω_A × r_A,g - v_B - ω_B × r_B,g),   w = (c(now) - c(then)) h/(2 t)
//
//   n, r   normal, on A, and arms of the contact: as it is (now), as it was seen last (then)
//   t      time between the two; h/2 where it was seen at the start of the part        [s]
//
// Of no use where the contact is another one by now: its normal turned faster than its bodies do,
// or it moved farther than they and that turn carry it round the larger of them. It then does not
// count. h -> 0, no turning, a sphere that rolls on what stands: w = 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ductile/frame/part_engine.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// World axes.
struct SeenContact {
    Vector3<double> point{0, 0, 0};                 ///< [m]
    Vector3<double> normal{0, 0, 0};                ///< on A, unit
    Vector3<double> arm_a{0, 0, 0}, arm_b{0, 0, 0}; ///< from the centres of mass [m]
};

/// Of a body; zero where it cannot move.
struct ContactBody {
    Vector3<double> velocity{0, 0, 0}; ///< [m/s]
    Vector3<double> spin{0, 0, 0};     ///< [rad/s]

    [[nodiscard]] Vector3<double> at(const Vector3<double>& arm) const {
        return sum(velocity, cross(spin, arm));
    }
};

/// By who touches: in the order that `nearest` needs.
template <class Bodies, class Seen>
void sort_by_bodies(std::vector<std::pair<Bodies, Seen>>& seen) {
    std::stable_sort(seen.begin(), seen.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
}
/// Of the same bodies, what has the nearest `point`; null: there is nothing.
template <class Bodies, class Seen>
[[nodiscard]] const Seen* nearest(const std::vector<std::pair<Bodies, Seen>>& seen,
                                  const Bodies& bodies, const Vector3<double>& point) {
    const Seen* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    auto each =
        std::lower_bound(seen.begin(), seen.end(), bodies,
                         [](const auto& one, const Bodies& key) { return one.first < key; });
    for (; each != seen.end() && each->first == bodies; ++each) {
        const double distance = norm(difference(each->second.point, point));
        if (!(distance < least)) continue;
        least = distance;
        nearest = &each->second;
    }
    return nearest;
}

/// w [m/s]; `time`: t > 0, `half`: h/2 [s].
[[nodiscard]] inline double turned_contact(const SeenContact& now, const SeenContact& then,
                                           const ContactBody& a, const ContactBody& b, double time,
                                           double half) {
    constexpr double most = 1.5; // times what the bodies do
    const double speed = std::max(norm(a.at(now.arm_a)), norm(b.at(now.arm_b)));
    const double turn = norm(difference(now.normal, then.normal));
    const double round = turn * std::max(norm(now.arm_a), norm(now.arm_b));
    if (!(norm(difference(now.point, then.point)) <= most * speed * time + round) ||
        !(turn <= most * (norm(a.spin) + norm(b.spin)) * time)) {
        return 0;
    }
    const auto closing = [&](const SeenContact& seen) {
        return -dot(seen.normal, difference(a.at(seen.arm_a), b.at(seen.arm_b)));
    };
    return (closing(now) - closing(then)) * half / time;
}

/// How fast the speed of A's arm over B's grows only because both turn [m/s²]. Friction that holds
/// is asked for no speed at the end of a part, too: times h/2 and along it, this is what it leaves
/// the solve short of. Else what lies on a turntable walks outwards by (ω h)²/2 of its radius in
/// each. Of a wheel that rolls it points along the normal, and nothing of it is along the ground.
[[nodiscard]] inline Vector3<double> turning_arms(const ContactBody& a,
                                                  const Vector3<double>& arm_a,
                                                  const ContactBody& b,
                                                  const Vector3<double>& arm_b) {
    return difference(cross(a.spin, cross(a.spin, arm_a)), cross(b.spin, cross(b.spin, arm_b)));
}

/// What a pin is asked for, A over B, so that it holds at the end of a part that its bodies leave
/// so; half: h/2 [s] [m/s].
[[nodiscard]] inline Vector3<double> turned_pin(const ContactBody& a, const Vector3<double>& arm_a,
                                                const ContactBody& b, const Vector3<double>& arm_b,
                                                double half) {
    return scaled(-half, turning_arms(a, arm_a, b, arm_b));
}
/// By how much B's end of it was off A's as the part began, where it is `error` off in the middle,
/// A's moves by `moves` over B's, and turns as `turned`, what it is asked for, says [m].
[[nodiscard]] inline Vector3<double> pin_as_began(const Vector3<double>& error,
                                                  const Vector3<double>& moves,
                                                  const Vector3<double>& turned, double half) {
    return sum(error, scaled(half, sum(moves, scaled(0.5, turned))));
}

/// When a gap of `way` [m] is closed that closes at `speed` [m/s] and gains `gain` [m/s²] on that;
/// infinite: never [s].
[[nodiscard]] inline double time_to_close(double way, double speed, double gain) {
    const double both = speed + std::sqrt(std::max(speed * speed + 2 * gain * way, 0.0));
    return both > 0 ? 2 * way / both : std::numeric_limits<double>::infinity();
}

/// Whether what a contact does to the flows of a part of `h` [s] could matter beside `least` [J].
[[nodiscard]] inline bool may_misplace(const PartMotion& motion, double h, double least) {
    constexpr double noticed = 0.1;
    double work = 0;
    for (const PartRow& row : motion.rows) {
        if (row.moves()) work += row.strength * std::abs(row.start + row.end) / 4 * h;
    }
    return work > noticed * least;
}

} // namespace ductile
