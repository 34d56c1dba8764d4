// SPDX-License-Identifier: MIT
//
// The rows of a joint in an island (solve/island.hpp), whatever the engine: the link's, as its last
// `prepare` ruled them, and those of contacts.
//
// The velocity that a row asks for is its bias less that of the bodies without any row: the
// engine's velocities with the step's forces applied. Impulses are forces times the step.
//
// Where the solve begins. A row that flowed in the last step begins at its bound. That is read from
// the joint's state, so that a run which goes on from a saved state goes on bit for bit.
#pragma once

#include "ductile/joint/any_link.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/solve/island.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

/// A body of a row: its number in the island, solve::immovable for what rows cannot move, and its
/// velocities without them [m/s], [rad/s], world axes.
struct IslandSeat {
    int number = solve::immovable;
    Vector3<double> velocity = Vector3<double>::Zero();
    Vector3<double> spin = Vector3<double>::Zero();
};

/// Adds a row of a force along `along` at `arm_a`, `arm_b` from the centres of mass on A, and the
/// opposite on B; `target`: velocity of A relative to B [m/s].
solve::IslandRow& add_row(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                          const Vector3<double>& arm_a, const Vector3<double>& arm_b,
                          const Vector3<double>& along, double target);
/// The same of a moment about `about` [rad/s].
solve::IslandRow& add_moment_row(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                                 const Vector3<double>& about, double target);

/// Adds the six rows of the link's last `prepare`, in the order of JointAxis, and the surface that
/// they share; `dt`: for which their forces act [s]. Returns the first.
int add_rows(solve::Island& island, AnyLink<double>& link, const IslandSeat& a, const IslandSeat& b,
             double dt);

/// The body as it leaves the step, with the velocities that the rows of a solved island gave it.
[[nodiscard]] BodyState<double> leaving(const solve::Island& island, const IslandSeat& seat,
                                        BodyState<double> body);

/// The spin with which it does [rad/s].
[[nodiscard]] inline Vector3<double> leaving_spin(const solve::Island& island,
                                                  const IslandSeat& seat) {
    if (seat.number == solve::immovable) return seat.spin;
    return sum(seat.spin, angular(island.bodies[std::size_t(seat.number)].velocity));
}

/// The island is solved: its rigid rows are asked for what fits bodies that leave a part of `dt`
/// [s] so (AnyLink::turn_at_end). True where that is something else: it has to be solved again.
[[nodiscard]] bool turn_rows(solve::Island& island, AnyLink<double>& link, int first,
                             const BodyState<double>& a, const BodyState<double>& b, double dt);

/// The same of bodies that began the part as `motion` says of each.
template <class Body, class Motion>
[[nodiscard]] bool turn_rows(solve::Island& island, AnyLink<double>& link, int first,
                             const IslandSeat& a, const Body& body_a, const IslandSeat& b,
                             const Body& body_b, const Motion& motion, double dt) {
    if (!link.may_turn_at_end(leaving_spin(island, a), leaving_spin(island, b), dt)) return false;
    return turn_rows(island, link, first, leaving(island, a, motion(body_a)),
                     leaving(island, b, motion(body_b)), dt);
}

/// Adds six rows that give `impulse` to A at the joint where it is `pose`, and the opposite to B.
void add_given_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                    const LinkPose<double>& pose, const JointImpulse<double>& impulse);

/// The island is solved, or not: tells the link, and returns the forces along its axes from its six
/// rows, that begin with `first` [N | N m].
[[nodiscard]] Vector6<double> take_forces(const solve::Island& island, AnyLink<double>& link,
                                          int first, double dt) noexcept;

/// The last rows are a contact, a normal first; `contact`: those that its friction couples to it,
/// after it, with their coefficients. Says where the solve begins, from their impulses.
void begin_contact(solve::Island& island, solve::IslandBlock contact);

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/world/island_joint.ipp"
#endif
