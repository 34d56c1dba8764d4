// SPDX-License-Identifier: MIT
//
// Forces that were applied at points of bodies, and go along with these through the parts of a
// frame. An engine keeps of such a force what it is about the centre of mass, and so its torque as
// it was when it was applied.
//
// Not thread-safe.
#pragma once

#include <utility>
#include <vector>

#include "ductile/joint/link_types.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// @throws std::invalid_argument where one is not finite, or beyond check::reach.
inline void check_placed_force(const Vector3<double>& force, const Vector3<double>& at) {
    const auto size = [](const Vector3<double>& v) {
        return is_finite(v) ? double(v.cwiseAbs().maxCoeff()) : norm(v);
    };
    check::finite("World.apply_force.force", size(force), "N");
    check::finite("World.apply_force.at", size(at), "m");
}

/// `Body`: how the engine names one.
template <class Body>
class PlacedForces {
  public:
    /// For the coming frame a force at a place, world [N, m]; the engine has been told of it.
    /// `pose`: the body's now, origin at its centre of mass.
    void add(Body body, const JointFrame<double>& pose, const Vector3<double>& force,
             const Vector3<double>& at) {
        const Vector3<double> arm = difference(at, pose.origin);
        coming_.push_back({body, force, transposed_times(pose.axes, arm), arm});
    }
    /// The frame begins. `acts(body)`: the engine still has a force for it.
    template <class Acts>
    void begin(const Acts& acts) {
        acting_ = std::exchange(coming_, {});
        forget([&acts](Body body) { return !acts(body); });
    }
    template <class IsGone>
    void forget(const IsGone& is_gone) {
        std::erase_if(acting_, [&](const Placed& placed) { return is_gone(placed.body); });
    }
    [[nodiscard]] bool empty() const noexcept { return acting_.empty(); }
    /// Calls `add_torque(body, torque)` [N m] with what the torques came to be beyond those that
    /// the engine was told of. `axes_of(body)`: as they are now, by columns.
    template <class AxesOf, class AddTorque>
    void follow(const AxesOf& axes_of, const AddTorque& add_torque) const {
        for (const Placed& placed : acting_) {
            const Vector3<double> arm = times(axes_of(placed.body), placed.in_body);
            add_torque(placed.body, cross(difference(arm, placed.arm), placed.force));
        }
    }

  private:
    struct Placed {
        Body body;
        Vector3<double> force;   ///< world [N]
        Vector3<double> in_body; ///< from the centre of mass [m]
        Vector3<double> arm;     ///< the same in the world, when it was applied [m]
    };

    std::vector<Placed> coming_, acting_;
};

} // namespace ductile
