// SPDX-License-Identifier: MIT
//
// A structure in the x-y plane of rods and plastic hinges, for the contract of an adapter. A hinge
// holds its bodies in space, so a structure held at both ends is three rows overdetermined out of
// its plane, as a user's would be. Included after the rig.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "adapters/features.hpp"

namespace ductile::test {

/// Rods in a plane, joined by plastic hinges.
class PlaneStructure {
  public:
    explicit PlaneStructure(const std::string& solver, const V3& gravity = V3::Zero())
        : rig(solver, gravity) {
        rig.soften();
    }

    /// A uniform rod from one point to another, with a point mass on its far end.
    Rig::Body rod(double mass, const V3& from, const V3& to, double end_mass = 0) {
        const double length = (to - from).norm(), all = mass + end_mass;
        const double shift = end_mass / all * length / 2;
        const double across = mass * (length * length / 12 + shift * shift) +
                              end_mass * (length / 2 - shift) * (length / 2 - shift);
        const V3 along = (to - from) / length;
        // thin, but not so thin that its spin about itself is ill conditioned
        const double thin = across / 100;
        const V3 inertia(along.x() != 0 ? thin : across, along.y() != 0 ? thin : across, across);
        bodies.push_back(
            rig.body(all, inertia, (from + to) / 2 + shift * along, V3::Zero(), V3::Zero()));
        return bodies.back();
    }
    /// A small body where members meet, or a mass that is one.
    Rig::Body node(double mass, double inertia, const V3& at) {
        bodies.push_back(rig.body(mass, V3::Constant(inertia), at, V3::Zero(), V3::Zero()));
        return bodies.back();
    }
    /// Rigid below `moment`, or elastic; null `b`: the static world.
    Rig::Hinge& hinge(Rig::Body a, Rig::Body b, const V3& at, double moment,
                      double stiffness = std::numeric_limits<double>::infinity()) {
        const Joint joint(Perfect<double>({.strength = moment}), TravelLimit<double>(),
                          {.stiffness = stiffness});
        hinges.push_back(&rig.hinge(a, b, at, V3(0, 0, 1), joint));
        return *hinges.back();
    }

    [[nodiscard]] double fastest() const {
        double most = 0;
        for (const auto body : bodies) {
            most = std::max({most, Rig::velocity(body).norm(), Rig::spin(body).norm()});
        }
        return most;
    }
    [[nodiscard]] bool unreliable() const {
        for (auto* h : hinges) {
            if (says_wrong(*h)) return true;
        }
        return false;
    }
    [[nodiscard]] double absorbed() const {
        double sum = 0;
        for (auto* h : hinges) sum += h->absorbed_energy();
        return sum;
    }

    Rig rig;
    std::vector<Rig::Body> bodies;
    std::vector<Rig::Hinge*> hinges;
};

/// Speed of a structure at rest, in units of what its `load` [N] gives its `mass` in one step:
/// round-off times the condition of a chain, N⁴, and what the rig's softness lets the moments and
/// forces move, some times the load, on arms of metres.
inline double at_rest(int segments, double mass, double dt) {
    const double chain = std::pow(segments, 4);
    return (Rig::single ? 1e-5 : 1e-12) * chain + 50 * Rig::softness * mass / dt;
}

} // namespace ductile::test
