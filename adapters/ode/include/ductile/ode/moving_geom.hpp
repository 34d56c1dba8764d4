// SPDX-License-Identifier: MIT
//
// How thick an ODE geom is, how it moves and what it may reach.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ductile/ode/convert.hpp"

namespace ductile::ode::detail {

/// Smallest extent of a geom; infinite for what has no other side [m].
[[nodiscard]] inline double thickness(dGeomID geom) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (geom == nullptr) return infinity; // contacts may be made without
    dReal radius = 0, length = 0;
    switch (dGeomGetClass(geom)) {
        case dSphereClass:
            return 2 * double(dGeomSphereGetRadius(geom));
        case dBoxClass: {
            dVector3 sides;
            dGeomBoxGetLengths(geom, sides);
            return double(std::min({sides[0], sides[1], sides[2]}));
        }
        case dCapsuleClass:
            dGeomCapsuleGetParams(geom, &radius, &length);
            return 2 * double(radius);
        case dCylinderClass:
            dGeomCylinderGetParams(geom, &radius, &length);
            return std::min(2 * double(radius), double(length));
        case dPlaneClass:
        case dHeightfieldClass:
            return infinity;
        default: {
            // of ground, and of a face alone, there is no telling from the other side
            const bool mesh = dGeomGetClass(geom) == dTriMeshClass;
            if (mesh && dGeomGetBody(geom) == nullptr) return infinity;
            std::array<dReal, 6> bounds{};
            dGeomGetAABB(geom, bounds.data());
            const auto least = double(
                std::min({bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]}));
            constexpr double face = 1e-4; // [m]
            return least > face ? least : infinity;
        }
    }
}

/// How a geom moves.
struct MovingGeom {
    dGeomID geom;
    dBodyID body; ///< null: it stands
    Vector3<double> velocity{0, 0, 0};
    double turning = 0; ///< no point of it is faster than |velocity| and this [m/s]
    double thickness = 0;
    std::array<double, 6> bounds{}; ///< as ODE's

    explicit MovingGeom(dGeomID of) : geom(of), body(dGeomGetBody(of)) {
        std::array<dReal, 6> box{};
        dGeomGetAABB(of, box.data());
        std::copy(box.begin(), box.end(), bounds.begin());
        thickness = detail::thickness(of);
        if (body == nullptr || dBodyIsEnabled(body) == 0) return;
        velocity = linear_velocity(body);
        const Vector3<double> at = to_core(dBodyGetPosition(body));
        double farthest = 0; // square
        for (int k = 0; k < 3; ++k) {
            const double low = bounds[std::size_t(2 * k)] - at[k],
                         high = bounds[std::size_t(2 * k + 1)] - at[k];
            farthest += std::max(low * low, high * high);
        }
        turning = norm(angular_velocity(body)) * std::sqrt(farthest);
    }
    [[nodiscard]] double speed() const { return norm(velocity) + turning; }
    [[nodiscard]] bool may_reach(const MovingGeom& other, double way) const {
        for (std::size_t k = 0; k < 6; k += 2) {
            if (other.bounds[k] - way > bounds[k + 1] || other.bounds[k + 1] + way < bounds[k]) {
                return false;
            }
        }
        return true;
    }
    [[nodiscard]] bool may_touch(const MovingGeom& other) const {
        const bool meant = (dGeomGetCategoryBits(geom) & dGeomGetCollideBits(other.geom)) != 0 ||
                           (dGeomGetCategoryBits(other.geom) & dGeomGetCollideBits(geom)) != 0;
        if (!meant || dGeomIsEnabled(geom) == 0 || dGeomIsEnabled(other.geom) == 0) return false;
        if (body == other.body) return false;
        return body == nullptr || other.body == nullptr ||
               dAreConnectedExcluding(body, other.body, dJointTypeContact) == 0;
    }
};

} // namespace ductile::ode::detail
