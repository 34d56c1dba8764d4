// SPDX-License-Identifier: MIT
//
// Bodies of contact_maker.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <unordered_set>

#include "ductile/ode/contact_maker.hpp"

namespace ductile::ode {

namespace detail {

[[nodiscard]] DUCTILE_INLINE std::vector<dGeomID> geoms_of(dSpaceID space) {
    std::vector<dGeomID> geoms;
    const int count = dSpaceGetNumGeoms(space);
    geoms.reserve(std::size_t(count));
    for (int i = 0; i < count; ++i) geoms.push_back(dSpaceGetGeom(space, i));
    return geoms;
}
[[nodiscard]] DUCTILE_INLINE dSpaceID as_space(dGeomID geom) {
    return dGeomIsSpace(geom) != 0 ? reinterpret_cast<dSpaceID>(geom) : nullptr;
}
DUCTILE_INLINE void add_geoms_below(dSpaceID space, std::vector<dGeomID>& geoms) {
    for (dGeomID geom : geoms_of(space)) {
        const dSpaceID below = as_space(geom);
        below != nullptr ? add_geoms_below(below, geoms) : geoms.push_back(geom);
    }
}

} // namespace detail

DUCTILE_INLINE ContactMaker::ContactMaker(const ContactParameters& parameters,
                                          std::function<void()> make)
    : parameters_(parameters), make_(std::move(make)) {
    if (parameters_.group == nullptr) {
        throw std::invalid_argument("World.on_contacts.group = null: must be a joint group");
    }
    if (!make_) throw std::invalid_argument("World.on_contacts.make: must not be empty");
    if (!(parameters_.thickness > 0)) {
        throw std::invalid_argument("World.on_contacts.thickness: must be > 0 [m]");
    }
}

DUCTILE_INLINE void ContactMaker::make() {
    clear();
    if (parameters_.space != nullptr) put_in_order(parameters_.space);
    struct AtWork {
        bool& flag;
        ~AtWork() { flag = false; }
    } const at_work{making_};
    making_ = true;
    make_();
}

/// Those that were here, as they first were, then those that came.
DUCTILE_INLINE void ContactMaker::put_in_order(dSpaceID space) {
    const std::vector<dGeomID> here = detail::geoms_of(space);
    std::vector<dGeomID>& order = orders_[space];
    std::unordered_set<dGeomID> left(here.begin(), here.end());
    std::erase_if(order, [&left](dGeomID geom) { return left.erase(geom) == 0; });
    for (dGeomID geom : here) {
        if (left.contains(geom)) order.push_back(geom);
    }
    for (dGeomID geom : order) dSpaceRemove(space, geom);
    for (dGeomID geom : order) dSpaceAdd(space, geom);
    dSpaceClean(space);
    for (dGeomID geom : order) {
        if (const dSpaceID below = detail::as_space(geom)) put_in_order(below);
    }
}

DUCTILE_INLINE std::vector<dGeomID> ContactMaker::geoms() const {
    std::vector<dGeomID> geoms;
    if (parameters_.space != nullptr) detail::add_geoms_below(parameters_.space, geoms);
    return geoms;
}

} // namespace ductile::ode
