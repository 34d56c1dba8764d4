// SPDX-License-Identifier: MIT
//
// An ODE contact as rows of an island (solve/island.hpp), with the numbers that ODE would give it:
// ERP and CFM of the world or its own, surface layer, largest correcting velocity, bounce, motion,
// slip.
#pragma once

#include <ode/ode.h>

#include <array>

#include "ductile/solve/island.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/island_joint.hpp"

namespace ductile::ode {

/// A contact joint and what it was made of.
struct NamedContact {
    dJointID joint;
    dContact contact;
    Vector3<double> force = Vector3<double>::Zero(); ///< on A, to begin the solve with [N]
    bool by_law = false; ///< its normal asks for surface.motionN, whatever it overlaps

    /// Whether it is no more than a normal and sliding friction.
    [[nodiscard]] bool slides_only() const { return (contact.surface.mode & dContactRolling) == 0; }
    /// Its own, or else that of the world [s/kg].
    [[nodiscard]] double cfm(dWorldID world) const {
        const dSurfaceParameters& own = contact.surface;
        return double((own.mode & dContactSoftCFM) != 0 ? own.soft_cfm : dWorldGetCFM(world));
    }
};

/// What ODE, built with its assertions, would end the process by, and what no island can be solved
/// with.
/// @throws std::invalid_argument where the joint is no contact, or it was made of numbers that are
/// not finite or a normal that is not of unit length.
void require_contact(dJointID joint, const dContact& contact);

namespace detail {
/// ODE's two friction directions. `normal`: on A.
[[nodiscard]] std::array<Vector3<double>, 2> friction_directions(const dContact& contact,
                                                                 const Vector3<double>& normal);
} // namespace detail

class ContactRows {
  public:
    /// Adds the rows for a step of `dt` [s].
    ContactRows(const NamedContact& named, solve::Island& island, const IslandSeat& a,
                const IslandSeat& b, double dt);
    /// The island is solved: the impulses become forces on the bodies, and the joint's feedback.
    void close(const solve::Island& island, double dt) const;

  private:
    void add_row(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                 const Vector3<double>& along, double target, double cfm, double dt);

    dJointID joint_;
    Vector3<double> arm_a_, arm_b_ = Vector3<double>::Zero(); ///< world [m]
    Vector3<double> begins_;                                  ///< on A, the first guess [N]
    std::array<Vector3<double>, 3> along_;                    ///< of each row, force on A, world
    int first_ = 0, count_ = 0;
    double softness_ = 0; ///< of its own effect; 0: the least there is [-]
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/contact_rows.ipp"
#endif
