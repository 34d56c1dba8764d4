// SPDX-License-Identifier: MIT
//
// Bodies of world.hpp: what a step is refused for. A part of world.ipp.
#pragma once

namespace ductile::ode {

namespace detail {

[[nodiscard]] DUCTILE_INLINE bool are_finite(const dReal* values, int count) {
    double sum = 0; // of what is not finite it is not
    for (int i = 0; i < count; ++i) sum += double(values[i]) * double(values[i]);
    return std::isfinite(sum);
}

/// What of a body is not finite; null: nothing.
[[nodiscard]] DUCTILE_INLINE const char* not_finite(dBodyID body) {
    if (body == nullptr) return nullptr;
    if (!are_finite(dBodyGetPosition(body), 3)) return "position";
    if (!are_finite(dBodyGetQuaternion(body), 4)) return "orientation";
    if (!are_finite(dBodyGetLinearVel(body), 3)) return "velocity";
    if (!are_finite(dBodyGetAngularVel(body), 3)) return "spin";
    if (!are_finite(dBodyGetForce(body), 3)) return "force";
    if (!are_finite(dBodyGetTorque(body), 3)) return "torque";
    dMass mass;
    dBodyGetMass(body, &mass);
    if (!are_finite(&mass.mass, 1)) return "mass";
    for (const int row : {0, 4, 8}) {
        if (!are_finite(mass.I + row, 3)) return "inertia";
    }
    return nullptr;
}

} // namespace detail

DUCTILE_INLINE void World::require_possible(double) try {
    for (const SteppedConstraint* constraint : constraints_) constraint->check();
    members_->require_possible();
    if (parts_ != nullptr) require_all_bodies();
    require_finite();
    require_contacts();
} catch (...) {
    contacts_.clear(); // the program empties their group
    refused_.clear();
    throw;
}
DUCTILE_INLINE void World::require_finite() {
    const auto refuse = [](const std::string& owner, const char* what) {
        throw std::invalid_argument("World.step: the " + std::string(what) + " of " + owner +
                                    " must be finite, as ODE would end the process");
    };
    dVector3 gravity;
    dWorldGetGravity(world_, gravity);
    if (!detail::are_finite(gravity, 3)) refuse("the world", "gravity");
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (const char* what = detail::not_finite(bodies_[i])) {
            refuse("body " + std::to_string(i), what);
        }
        for (const dReal damping :
             {dBodyGetLinearDamping(bodies_[i]), dBodyGetAngularDamping(bodies_[i])}) {
            if (!(std::abs(damping) <= 1)) {
                check::fail("World.step: the damping of body " + std::to_string(i), damping, "",
                            "in [-1, 1]");
            }
        }
    }
    for (const PlasticConstraint* joint : plastic_) {
        for (const int side : {0, 1}) {
            if (const char* what = detail::not_finite(dJointGetBody(joint->id(), side))) {
                const std::size_t number = supervisor().number(joint);
                const bool known = number != Watch<double>::nobody; // no joint of a member
                refuse("a body of \"" + (known ? watch().name(number) : "a member") + "\"", what);
            }
        }
    }
}
/// What is pushed beyond all reason may go faster with every solve, until ODE's numbers overflow.
DUCTILE_INLINE void World::require_slow() const {
    constexpr double fastest = 1e9;
    for (dBodyID body : bodies_) {
        const double speed = std::max(norm(linear_velocity(body)), norm(angular_velocity(body)));
        if (speed <= fastest) continue;
        check::fail("World.step: how fast a body is", speed, "m/s or rad/s",
                    "<= 1e9, as ODE would end the process");
    }
}
DUCTILE_INLINE void World::require_known(dBodyID body) const {
    if (parts_ == nullptr || body == nullptr || known_.has(body)) return;
    throw std::invalid_argument(
        "World.tolerance: every body that moves must have been added, also where only a joint, a "
        "contact or a geom holds it");
}
DUCTILE_INLINE void World::number_bodies() {
    known_.clear();
    for (dBodyID body : bodies_) known_.enter(body);
}
DUCTILE_INLINE void World::require_all_bodies() {
    for (dBodyID body : bodies_) {
        for (int i = 0; i < dBodyGetNumJoints(body); ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            if (dJointGetType(joint) == dJointTypeContact) {
                throw std::logic_error(
                    "World.step: there are contacts before the step: in a world with a tolerance "
                    "they are made by what on_contacts was given");
            }
            for (const int side : {0, 1}) {
                if (const dBodyID other = dJointGetBody(joint, side); other != body) {
                    require_known(other);
                }
            }
        }
    }
    // where one of its bodies is known, the other one was looked at
    for (const PlasticConstraint* joint : plastic_) {
        require_known(attached_bodies(joint->id()).a);
    }
    if (!maker_) return;
    for (dGeomID geom : maker_->geoms()) {
        if (dGeomIsEnabled(geom) != 0) require_known(dGeomGetBody(geom));
    }
}
DUCTILE_INLINE void World::require_contacts() {
    if (!refused_.empty()) throw std::invalid_argument(std::exchange(refused_, {}));
}

} // namespace ductile::ode
