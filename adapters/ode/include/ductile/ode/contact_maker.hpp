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
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/ode/contact_rows.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::ode {

namespace detail {

/// ODE ends the process where it is asked for one by its number: those that a plane might touch,
/// which is everywhere as it lies askew.
[[nodiscard]] inline std::vector<dGeomID> geoms_of_quadtree(dSpaceID space) {
    std::vector<dGeomID> geoms;
    const dGeomID everywhere = dCreatePlane(nullptr, 1, 1, 1, 0);
    dSpaceCollide2(
        everywhere, reinterpret_cast<dGeomID>(space), &geoms, [](void* data, dGeomID a, dGeomID b) {
            const bool first = dGeomGetClass(a) != dPlaneClass || dGeomGetSpace(a) != nullptr;
            static_cast<std::vector<dGeomID>*>(data)->push_back(first ? a : b);
        });
    dGeomDestroy(everywhere);
    return geoms;
}

[[nodiscard]] inline std::vector<dGeomID> geoms_of(dSpaceID space) {
    std::vector<dGeomID> geoms;
    if (dSpaceGetClass(space) == dQuadTreeSpaceClass) return geoms_of_quadtree(space);
    const int count = dSpaceGetNumGeoms(space);
    geoms.reserve(std::size_t(count));
    for (int i = 0; i < count; ++i) geoms.push_back(dSpaceGetGeom(space, i));
    return geoms;
}
[[nodiscard]] inline dSpaceID as_space(dGeomID geom) {
    return dGeomIsSpace(geom) != 0 ? reinterpret_cast<dSpaceID>(geom) : nullptr;
}
inline void add_geoms_below(dSpaceID space, std::vector<dGeomID>& geoms) {
    for (dGeomID geom : geoms_of(space)) {
        const dSpaceID below = as_space(geom);
        below != nullptr ? add_geoms_below(below, geoms) : geoms.push_back(geom);
    }
}

} // namespace detail

struct ContactParameters {
    dSpaceID space = nullptr;
    dJointGroupID group = nullptr;                              ///< required
    double thickness = std::numeric_limits<double>::infinity(); ///< > 0 [m]
};

class ContactMaker {
  public:
    /// @throws std::invalid_argument where the group is null, `make` is empty or the thickness not
    /// positive.
    ContactMaker(const ContactParameters& parameters, std::function<void()> make)
        : parameters_(parameters), make_(std::move(make)) {
        if (parameters_.group == nullptr) {
            throw std::invalid_argument("World.on_contacts.group = null: must be a joint group");
        }
        if (!make_) throw std::invalid_argument("World.on_contacts.make: must not be empty");
        if (!(parameters_.thickness > 0)) {
            throw std::invalid_argument("World.on_contacts.thickness: must be > 0 [m]");
        }
    }

    /// The contacts of the bodies, all that move, as they are, in place of the last ones.
    void make(std::span<const dBodyID> bodies) {
        constexpr double farthest = 1e8; // ODE's hash spaces end the process from 2.7e8 m on
        for (dBodyID body : bodies) {
            const double far = norm(to_core(dBodyGetPosition(body)));
            if (!(far <= farthest)) {
                check::fail("World.step: how far away a body is", far, "m",
                            "<= 1e8, as ODE would end the process");
            }
        }
        clear();
        put_in_order(bodies);
        struct AtWork {
            bool& flag;
            ~AtWork() { flag = false; }
        } const at_work{making_};
        making_ = true;
        try {
            make_();
        } catch (...) {
            clear(); // no step begins with contacts
            throw;
        }
    }
    /// `make` is at work.
    [[nodiscard]] bool is_making() const noexcept { return making_; }
    /// There are none.
    void clear() const { dJointGroupEmpty(parameters_.group); }
    [[nodiscard]] const ContactParameters& parameters() const noexcept { return parameters_; }
    /// Its joint is made once more, as its surface says now.
    void renew(dWorldID world, NamedContact& named) const {
        const dJointID old = named.joint;
        const dBodyID a = dJointGetBody(old, 0), b = dJointGetBody(old, 1);
        named.joint = dJointCreateContact(world, parameters_.group, &named.contact);
        dJointAttach(named.joint, a, b);
        dJointSetFeedback(named.joint, dJointGetFeedback(old));
        dJointDisable(old);
        named.stale = false;
    }
    /// All geoms of the space that are no spaces, in their order.
    [[nodiscard]] std::vector<dGeomID> geoms() const {
        std::vector<dGeomID> geoms;
        if (parameters_.space != nullptr) detail::add_geoms_below(parameters_.space, geoms);
        return geoms;
    }

  private:
    /// Geoms that are clean come to the front of their spaces as they are told that they moved.
    void put_in_order(std::span<const dBodyID> bodies) const {
        if (parameters_.space == nullptr) return;
        dSpaceClean(parameters_.space);
        for (dBodyID body : bodies) {
            const dReal* at = dBodyGetPosition(body);
            dBodySetPosition(body, at[0], at[1], at[2]);
        }
    }

    ContactParameters parameters_;
    std::function<void()> make_;
    bool making_ = false;
};

} // namespace ductile::ode
