// SPDX-License-Identifier: MIT
//
// An ODE contact as rows of an island (solve/island.hpp), with the numbers that ODE would give it:
// ERP and CFM of the world or its own, surface layer, largest correcting velocity, bounce, motion,
// slip.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>

#include "ductile/ode/convert.hpp"
#include "ductile/solve/island.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/world/island_joint.hpp"

namespace ductile::ode {

/// A contact joint and what it was made of.
struct NamedContact {
    dJointID joint;
    dContact contact;
    Vector3<double> force = Vector3<double>::Zero(); ///< on A, to begin the solve with [N]
    bool by_law = false; ///< its normal asks for surface.motionN, whatever it overlaps
    bool stale = false;  ///< its joint was made of another surface

    /// Whether it is no more than a normal and sliding friction.
    [[nodiscard]] bool slides_only() const { return (contact.surface.mode & dContactRolling) == 0; }
    /// Its own, or else that of the world [s/kg].
    [[nodiscard]] double cfm(dWorldID world) const {
        const dSurfaceParameters& own = contact.surface;
        return double((own.mode & dContactSoftCFM) != 0 ? own.soft_cfm : dWorldGetCFM(world));
    }
};

namespace detail {

/// Velocity along the normal that the contact asks for [m/s]; `closing`: of the bodies now [m/s].
inline double wanted_velocity(dWorldID world, const NamedContact& named, double closing,
                              double dt) {
    const dContact& contact = named.contact;
    const dSurfaceParameters& surface = contact.surface;
    if (named.by_law) return double(surface.motionN);
    const auto has = [&surface](int flag) { return (surface.mode & flag) != 0; };
    const dReal erp = has(dContactSoftERP) ? surface.soft_erp : dWorldGetERP(world);
    const double depth =
        std::max(0.0, double(contact.geom.depth) - double(dWorldGetContactSurfaceLayer(world)));
    const double motion = has(dContactMotionN) ? double(surface.motionN) : 0;
    const double wanted = std::min(double(erp) / dt * depth + motion,
                                   double(dWorldGetContactMaxCorrectingVel(world)));
    const double impact = motion + closing;
    const bool bounces =
        has(dContactBounce) && surface.bounce_vel >= 0 && impact > double(surface.bounce_vel);
    return bounces ? std::max(wanted, double(surface.bounce) * impact + motion) : wanted;
}

/// ODE's two friction directions. `normal`: on A.
[[nodiscard]] inline std::array<Vector3<double>, 2> friction_directions(
    const dContact& contact, const Vector3<double>& normal) {
    if ((contact.surface.mode & dContactFDir1) != 0) {
        const Vector3<double> first = to_core(contact.fdir1);
        return {first, cross(normal, first)};
    }
    return plane_across(normal);
}

} // namespace detail

/// What ODE, built with its assertions, would end the process by, and what no island can be solved
/// with.
/// @throws std::invalid_argument where the joint is no contact, or it was made of numbers that are
/// not finite or a normal that is not of unit length.
inline void require_contact(dJointID joint, const dContact& contact) {
    if (joint == nullptr || dJointGetType(joint) != dJointTypeContact) {
        throw std::invalid_argument("World.add_contact.joint: must be a contact joint");
    }
    const dContactGeom& geom = contact.geom;
    const dSurfaceParameters& surface = contact.surface;
    const Vector3<double> normal = to_core(geom.normal);
    if (!(std::abs(norm(normal) - 1) < 1e-2)) {
        throw std::invalid_argument("World.add_contact.geom.normal: must be of unit length");
    }
    if (!is_finite(to_core(geom.pos))) {
        throw std::invalid_argument("World.add_contact.geom.pos: must be finite [m]");
    }
    if ((surface.mode & dContactFDir1) != 0 && !is_finite(to_core(contact.fdir1))) {
        throw std::invalid_argument("World.add_contact.fdir1: must be finite");
    }
    const auto require = [&surface](int flag, const char* name, dReal value, bool unlimited) {
        if (flag != 0 && (surface.mode & flag) == 0) return;
        if (std::isfinite(value) || (unlimited && value > 0)) return;
        check::fail(std::string("World.add_contact.") + name, value, "",
                    unlimited ? "a number (infinity: no limit)" : "finite");
    };
    require(0, "geom.depth", geom.depth, false);
    require(0, "surface.mu", surface.mu, true);
    require(dContactMu2, "surface.mu2", surface.mu2, true);
    require(dContactRolling, "surface.rho", surface.rho, true);
    require(dContactBounce, "surface.bounce", surface.bounce, false);
    require(dContactBounce, "surface.bounce_vel", surface.bounce_vel, true);
    require(dContactSoftERP, "surface.soft_erp", surface.soft_erp, false);
    require(dContactSoftCFM, "surface.soft_cfm", surface.soft_cfm, false);
    require(dContactMotion1, "surface.motion1", surface.motion1, false);
    require(dContactMotion2, "surface.motion2", surface.motion2, false);
    require(dContactMotionN, "surface.motionN", surface.motionN, false);
    require(dContactSlip1, "surface.slip1", surface.slip1, false);
    require(dContactSlip2, "surface.slip2", surface.slip2, false);
}

class ContactRows {
  public:
    /// Adds the rows for a step of `dt` [s].
    ContactRows(const NamedContact& named, solve::Island& island, const IslandSeat& a,
                const IslandSeat& b, double dt)
        : joint_(named.joint), begins_(named.force), first_(int(island.rows.size())) {
        constexpr double unlimited = std::numeric_limits<double>::infinity();
        const dContact& contact = named.contact;
        const dSurfaceParameters& surface = contact.surface;
        const auto has = [&surface](int flag) { return (surface.mode & flag) != 0; };
        const AttachedBodies bodies = attached_bodies(joint_);
        const dWorldID world = dBodyGetWorld(bodies.a);
        const Vector3<double> point = to_core(contact.geom.pos);
        const Vector3<double> normal =
            scaled(bodies.reversed ? -1 : 1, to_core(contact.geom.normal));
        arm_a_ = arm_of(bodies.a, point);
        arm_b_ = arm_of(bodies.b, point);
        const Vector3<double> closing =
            difference(velocity_at(bodies.a, point), velocity_at(bodies.b, point));
        const auto usual_cfm = double(dWorldGetCFM(world));
        // only friction needs it: of a light body before a heavy one it is a share of the whole
        // blow
        const bool rubs = surface.mu > 0 || (has(dContactMu2) && surface.mu2 > 0);
        softness_ = rubs ? solve::contact_softness : 0;
        add_row(island, a, b, normal,
                detail::wanted_velocity(world, named, -dot(normal, closing), dt), named.cfm(world),
                dt);
        solve::IslandBlock block{.kind = solve::BlockKind::contact, .first = first_, .count = 1};

        struct Friction {
            double mu, motion, cfm;
            bool of_normal; ///< mu is a share of the normal force, not a force
        };
        const auto mu = double(surface.mu);
        const std::array<Friction, 2> friction{{
            {mu, has(dContactMotion1) ? double(surface.motion1) : 0,
             has(dContactSlip1) ? double(surface.slip1) : usual_cfm, has(dContactApprox1_1)},
            {has(dContactMu2) ? double(surface.mu2) : mu,
             has(dContactMotion2) ? double(surface.motion2) : 0,
             has(dContactSlip2) ? double(surface.slip2) : usual_cfm, has(dContactApprox1_2)},
        }};
        const std::array<Vector3<double>, 2> along = detail::friction_directions(contact, normal);
        for (const bool in_block : {true, false}) { // whose rows follow the normal's
            for (std::size_t i = 0; i < 2; ++i) {
                const Friction& f = friction[i];
                if (!(f.mu > 0) || (f.of_normal && f.mu < unlimited) != in_block) continue;
                add_row(island, a, b, along[i], f.motion, f.cfm, dt);
                if (in_block) {
                    block.size[std::size_t(block.count++)] = f.mu;
                } else {
                    island.rows.back().upper = f.mu * dt;
                    island.rows.back().lower = -f.mu * dt;
                }
            }
        }
        begin_contact(island, block);
    }
    /// The island is solved: the impulses become forces on the bodies, and the joint's feedback.
    void close(const solve::Island& island, double dt) const {
        Vector3<double> force = Vector3<double>::Zero();
        for (int i = 0; i < count_; ++i) {
            const double impulse = island.rows[std::size_t(first_ + i)].impulse;
            force = sum(force, scaled(impulse / dt, along_[std::size_t(i)]));
        }
        push(joint_, force, cross(arm_a_, force), cross(force, arm_b_));
    }

  private:
    void add_row(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                 const Vector3<double>& along, double target, double cfm, double dt) {
        solve::IslandRow& row = ductile::add_row(island, a, b, arm_a_, arm_b_, along, target);
        row.impulse = dot(begins_, along) * dt;
        row.compliance = cfm / dt;
        row.softness = softness_ * solve::own_effect(island, row);
        along_[std::size_t(count_++)] = along;
    }

    dJointID joint_;
    Vector3<double> arm_a_, arm_b_ = Vector3<double>::Zero(); ///< world [m]
    Vector3<double> begins_;                                  ///< on A, the first guess [N]
    std::array<Vector3<double>, 3> along_;                    ///< of each row, force on A, world
    int first_ = 0, count_ = 0;
    double softness_ = 0; ///< of its own effect; 0: the least there is [-]
};

} // namespace ductile::ode
