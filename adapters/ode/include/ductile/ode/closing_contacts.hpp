// SPDX-License-Identifier: MIT
//
// Which contacts on islands with plastic joints close, from those that the user's collisions make
// (contact_maker.hpp). ODE tells of a contact only once shapes overlap, by a depth d; it closes at v
// with the energy v²/(2 K), K = 1/effective mass of the point, both bodies free. So
//
//   a contact that is there now and closes strikes
//   a gap closed at  t - d/v,  where the bodies overlap at t
//
// Looked at are the middle of a part, where v is that before it, and its end, where v is that after
// it; what overlapped before the start, or before the middle, is not new. Before a part in which
// bodies pass each other by more than half of the thinner of their geoms they are moved along, as
// they would go without any force, and looked at after every such length.
//
// A gap is aimed at a hair beyond its closing, so that ODE knows the contact from then on; that much
// overlap is left alone (dWorldSetContactSurfaceLayer), so that it stays known.
//
// An island is what hangs together with a plastic joint by joints and contacts, as they are.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <limits>
#include <span>
#include <vector>

#include "ductile/frame/part_engine.hpp"
#include "ductile/ode/contact_maker.hpp"
#include "ductile/ode/contact_rows.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/world_snapshot.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// Overlap of a contact that is left alone in a part; half of it is the hair [m].
inline constexpr double left_overlap = sizeof(dReal) == sizeof(double) ? 1e-6 : 2e-5;

class ClosingContactsFinder {
  public:
    /// The contacts of the bodies as they are, of islands of these joints.
    /// @throws std::logic_error where one has a contact that was not named.
    void look(std::span<const NamedContact> contacts, std::span<PlasticConstraint* const> joints);
    /// Among those looked at.
    [[nodiscard]] bool strikes(double touching) const;
    /// When the first gap closed, of those that close with more energy than `apart` [J], in a part
    /// that began `past` [s] ago or, where less, `since` [s] ago; infinite: none did.
    [[nodiscard]] double closed(double past, double since, double apart) const;
    /// Whether a body is in one of these islands.
    [[nodiscard]] bool is_plastic(dBodyID body) const;
    [[nodiscard]] bool any_plastic() const noexcept { return !island_.empty(); }

    /// Into how many lengths `h` [s] has to be divided so that nothing passes an island unseen, not
    /// rounded; >= 1.
    [[nodiscard]] double lengths(const ContactMaker& maker, std::span<const dBodyID> bodies,
                                 double h) const;

  private:
    /// A point that touches.
    struct Touch {
        double depth;  ///< d [m]
        double speed;  ///< v [m/s]
        double energy; ///< v²/(2 K) [J]
    };
    void find_islands(std::span<const NamedContact> contacts,
                      std::span<PlasticConstraint* const> joints);

    std::vector<dBodyID> island_; ///< bodies that can move, of all of them, sorted
    std::vector<Touch> touches_;  ///< that close
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/closing_contacts.ipp"
#endif
