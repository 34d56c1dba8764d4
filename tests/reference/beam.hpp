// SPDX-License-Identifier: MIT
//
// A straight uniform beam along x as a chain of N equal rigid segments: pins hold the segments
// together, and a plastic hinge sits at every inner joint and at every clamped end. Joints carry
// rotation only. The right end is always free to slide along the beam: rigid segments could not
// turn otherwise. Deflections and loads are positive along y.
//
// Symbols
//   L    length                     [m]
//   μ    mass per length            [kg/m]
//   M_p  plastic moment             [N m]
//   G    point mass fixed to a tip  [kg]
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <deque>
#include <limits>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "reference/world.hpp"

namespace ductile::reference {

enum class Support { free, pinned, clamped };

template <std::floating_point S>
struct BeamParameters {
    S length = std::numeric_limits<S>::quiet_NaN();          ///< L [m]
    S mass_per_length = std::numeric_limits<S>::quiet_NaN(); ///< μ [kg/m]
    S plastic_moment = std::numeric_limits<S>::quiet_NaN();  ///< M_p [N m]
    int segments = 1;                                        ///< N
    Support left = Support::clamped;
    Support right = Support::free;
    S tip_mass = 0; ///< G, on the right end [kg]
    Kinematics kinematics = Kinematics::small;
    S segment_inertia = S(1) / 12; ///< about a segment's middle, over its mass × length² [-]: a rod
};

/// Not copyable: the world holds on to the joints.
template <std::floating_point S>
class Beam {
  public:
    explicit Beam(const BeamParameters<S>& p) : p_(p), world_(p.kinematics) {
        for (int i = 0; i < p_.segments; ++i)
            add_segment(i + 1 == p_.segments ? p_.tip_mass : S(0));
        support(0, p_.left);
        for (int i = 1; i < p_.segments; ++i) {
            world_.add_pin(segment(i - 1), segment(i), at(i));
            hinge(segment(i - 1), segment(i));
        }
        support(p_.segments, p_.right);
    }
    Beam(const Beam&) = delete;
    Beam& operator=(const Beam&) = delete;

    [[nodiscard]] World<S>& world() { return world_; }
    [[nodiscard]] std::size_t hinges() const { return joints_.size(); }
    /// From left to right.
    [[nodiscard]] const OneAxisJoint<Perfect<S>>& hinge(std::size_t i) const { return joints_[i]; }

    /// Adds a force across the beam at x [N]; at a joint it acts on the segment before it.
    void add_force(Vector<S>& load, S x, S force) const {
        const S lengths = x * S(p_.segments) / p_.length;
        const int i = std::clamp(int(std::ceil(lengths - S(1e-6))) - 1, 0, p_.segments - 1);
        load[segment(i).y()] += force;
        load[segment(i).angle()] += force * (x - centre_[std::size_t(i)]);
    }
    /// The whole beam under `force` per length [N/m].
    [[nodiscard]] Vector<S> uniform_load(S force) {
        Vector<S> load = world_.no_load();
        for (int i = 0; i < p_.segments; ++i) {
            add_force(load, (S(i) + S(0.5)) * spacing(), force * spacing());
        }
        return load;
    }

    /// Of joint i, 0 … N; small displacements.
    [[nodiscard]] S deflection(int i) { return across(world_.displacement(), i); }
    [[nodiscard]] S velocity(int i) { return across(world_.velocity(), i); }
    /// Rotation of segment i, 0 … N-1 [rad].
    [[nodiscard]] S rotation(int i) { return world_.displacement()[segment(i).angle()]; }
    /// Place of the right end, at any rotation [m].
    [[nodiscard]] Point<S> tip() {
        const Body last = segment(p_.segments - 1);
        const S arm = p_.length - centre_.back();
        const Vector<S>& q = world_.displacement();
        return {centre_.back() + q[last.x] + arm * std::cos(q[last.angle()]),
                q[last.y()] + arm * std::sin(q[last.angle()])};
    }

    [[nodiscard]] S plastic_work() const {
        S sum = 0;
        for (const auto& joint : joints_) sum += joint.state().plastic_work;
        return sum;
    }
    [[nodiscard]] S other_work() const {
        S sum = 0;
        for (const auto& joint : joints_) sum += joint.state().other_work;
        return sum;
    }
    /// Largest violation a joint's own certificate has seen [rad/s].
    [[nodiscard]] S residual() const {
        S most = 0;
        for (const auto& joint : joints_) most = std::max(most, joint.state().residual_max);
        return most;
    }

  private:
    [[nodiscard]] S spacing() const { return p_.length / S(p_.segments); }
    [[nodiscard]] Point<S> at(int joint) const { return {S(joint) * spacing(), S(0)}; }
    [[nodiscard]] Body segment(int i) const { return segments_[std::size_t(i)]; }

    void add_segment(S end_mass) {
        const S l = spacing();
        const S rod = p_.mass_per_length * l;
        const S shift = end_mass / (rod + end_mass) * l / 2; // of the centre, towards the mass
        const S centre = (S(segments_.size()) + S(0.5)) * l + shift;
        const S inertia = rod * (l * l * p_.segment_inertia + shift * shift) +
                          end_mass * (l / 2 - shift) * (l / 2 - shift);
        segments_.push_back(world_.add_body(rod + end_mass, inertia, {centre, S(0)}));
        centre_.push_back(centre);
    }

    void hinge(Body before, Body after) {
        joints_.emplace_back(Perfect<S>({.strength = p_.plastic_moment}));
        world_.add_hinge(before, after, joints_.back());
    }

    void support(int joint, Support kind) {
        if (kind == Support::free) return;
        const bool left = joint == 0;
        const Body body = left ? segment(0) : segment(p_.segments - 1);
        if (left) {
            world_.add_pin(ground, body, at(joint));
        } else {
            world_.add_roller(ground, body, at(joint), {S(0), S(1)});
        }
        if (kind != Support::clamped) return;
        if (left) {
            hinge(ground, body);
        } else {
            hinge(body, ground);
        }
    }

    [[nodiscard]] S across(const Vector<S>& of, int joint) const {
        const int i = joint > 0 ? joint - 1 : 0;
        return of[segment(i).y()] +
               of[segment(i).angle()] * (S(joint) * spacing() - centre_[std::size_t(i)]);
    }

    BeamParameters<S> p_;
    World<S> world_;
    std::deque<OneAxisJoint<Perfect<S>>> joints_;
    std::vector<Body> segments_;
    std::vector<S> centre_;
};

} // namespace ductile::reference
