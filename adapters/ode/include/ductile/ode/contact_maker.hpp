// SPDX-License-Identifier: MIT
//
// Who makes a World's contacts, whenever it asks: in a world with a tolerance each part needs its
// own, where its bodies are in the middle of it, and a frame looks for gaps that close. `make`
// collides and names each contact by World::add_contact; the joints are in a group of their own,
// which is emptied before and after.
//
//   space      whose geoms are kept in the order of their bodies, those within its subspaces too: a
//              body that moved brings its geoms to the front of ODE's list, so that contacts would
//              come in another order after a part that was put back. Null: `make` collides without
//              geoms.
//   thickness  of the thinnest part, where there is no space to tell: bodies are not moved past
//   each
//              other by half of it unseen [m]
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

struct ContactParameters {
    dSpaceID space = nullptr;
    dJointGroupID group = nullptr;                              ///< required
    double thickness = std::numeric_limits<double>::infinity(); ///< > 0 [m]
};

class ContactMaker {
  public:
    /// @throws std::invalid_argument where the group is null, `make` is empty or the thickness not
    /// positive.
    ContactMaker(const ContactParameters& parameters, std::function<void()> make);

    /// The contacts of the bodies, all that move, as they are, in place of the last ones.
    void make(std::span<const dBodyID> bodies);
    /// `make` is at work.
    [[nodiscard]] bool is_making() const noexcept { return making_; }
    /// There are none.
    void clear() const { dJointGroupEmpty(parameters_.group); }
    [[nodiscard]] const ContactParameters& parameters() const noexcept { return parameters_; }
    /// All geoms of the space that are no spaces, in their order.
    [[nodiscard]] std::vector<dGeomID> geoms() const;

  private:
    void put_in_order(std::span<const dBodyID> bodies) const;

    ContactParameters parameters_;
    std::function<void()> make_;
    bool making_ = false;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/contact_maker.ipp"
#endif
