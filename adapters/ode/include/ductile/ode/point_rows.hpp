// SPDX-License-Identifier: MIT
//
// Bounded rows of force and moment between two bodies at a given point, for one step. ODE has no
// joint for that: its linear motor acts midway between the centres of mass. But the two friction
// rows of a contact joint act at the contact's point, with a bound, a target velocity and a CFM
// each, so contact joints are made for the step and taken away after it.
//
// The contact's normal row, which presses only one way, is kept out by a target velocity far below
// any motion: its force is zero, and no tie can make ODE's direct solver take it up.
//
// Moments. A contact at the distance L from the bodies along n with the row direction t = (e × n)/L
// has the moment arm L n × t = e: a couple about e, but for the force M/L. L is so long that this
// force is lost in round-off; it is reported with the others all the same.
//
// Scale. When ODE's direct solver (0.16: dLDLTRemove) takes a row out that has met its bound, it
// puts a 1 in place of the row's diagonal A = J M⁻¹ Jᵀ + CFM/dt, by way of the squares of A ± 1.
// What is left of the difference is 8/A² of a number of order one: off by ε A²/8, and nothing at
// all above A = 1e8, where the solver then divides by zero and ends the process. Moments on bodies
// of some grams and soft rows are there in SI units. A row u' + CFM f = Vel, |f| <= FMax is
// therefore made as
//   s u' + (s² CFM) (f/s) = s Vel,   |f/s| <= FMax/s,   s = 1/√A
// by a direction of length s, wherever A is above `largest_diagonal`.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/symmetric_row.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile::ode {

/// Diagonal up to which ODE's direct solver takes rows as they are: 1e-9 off [1/kg | 1/(kg m²)].
inline constexpr double largest_diagonal = 1e4;

namespace detail {

/// Any one of unit length at right angles to v.
inline Vector3<double> unit_orthogonal(const Vector3<double>& v) noexcept {
    constexpr double beside = 1e-12;
    const bool along_z =
        std::abs(v[0]) <= beside * std::abs(v[2]) && std::abs(v[1]) <= beside * std::abs(v[2]);
    const double first = along_z ? v[1] : v[0], second = along_z ? v[2] : v[1];
    const double length = std::sqrt(first * first + second * second);
    const double across = -second / length, on = first / length;
    return along_z ? Vector3<double>(0, across, on) : Vector3<double>(across, on, 0);
}

} // namespace detail

/// A row along or about a direction; its centre is not applied here.
struct PointRow {
    Vector3<double> direction{0, 0, 0}; ///< world, unit
    SymmetricRow row;
    double scale = 1; ///< s
};

/// s of a row with the diagonal A.
[[nodiscard]] inline double row_scale(double diagonal) noexcept {
    return diagonal > largest_diagonal ? 1 / std::sqrt(diagonal) : 1;
}

class PointRows {
  public:
    explicit PointRows(dWorldID world) : world_(world) {}

    /// Makes force rows on `a`, opposite on `b` (null: the static world), for the coming step.
    /// Directions at right angles to each other; rows without strength are left out.
    void make(dBodyID a, dBodyID b, const Vector3<double>& point,
              const std::array<PointRow, 3>& rows) {
        attach(a, b, rows, 2, [&point](const PointRow& first, const PointRow* second) {
            const Vector3<double> along = scaled(first.scale, first.direction);
            const Vector3<double> other =
                second != nullptr ? scaled(second->scale, second->direction)
                                  : scaled(first.scale, detail::unit_orthogonal(first.direction));
            return contact(point, along, other);
        });
    }
    /// The same with moments about the directions, which need not be at right angles.
    void make_moments(dBodyID a, dBodyID b, const std::array<PointRow, 3>& rows) {
        attach(a, b, rows, 1, [](const PointRow& row, const PointRow*) {
            const Vector3<double> normal =
                cross(row.direction, detail::unit_orthogonal(row.direction));
            const Vector3<double> along =
                scaled(row.scale / distance, cross(row.direction, normal));
            return contact(scaled(distance, normal), along,
                           scaled(row.scale / distance, row.direction));
        });
    }

    /// What the rows did in the step, about the centres of mass; takes them away.
    [[nodiscard]] OutsideForce collect() {
        OutsideForce result;
        if (made_ == nullptr) return result;
        for (const dJointFeedback& f : made_->feedback) {
            result.force = sum(result.force, to_core(f.f1));
            result.torque_a = sum(result.torque_a, to_core(f.t1));
            result.torque_b = sum(result.torque_b, to_core(f.t2));
        }
        clear();
        return result;
    }
    /// Takes the rows away.
    void clear() {
        if (made_ == nullptr || made_->contacts == 0) return;
        dJointGroupEmpty(made_->group);
        made_->feedback = {};
        made_->contacts = 0;
    }

  private:
    static constexpr double never = -1e15;   ///< [m/s]
    static constexpr double distance = 1e12; ///< L [m]

    /// Two rows along directions at right angles.
    static dContact contact(const Vector3<double>& point, const Vector3<double>& first,
                            const Vector3<double>& second) {
        // ODE's second friction direction is normal × first
        const Vector3<double> normal = scaled(1 / dot(first, first), cross(first, second));
        dContact result{};
        result.surface.mode = dContactAxisDep | dContactFDir1 | dContactMotionN | dContactMotion1 |
                              dContactMotion2 | dContactSlip1 | dContactSlip2;
        for (int i = 0; i < 3; ++i) {
            result.geom.pos[i] = dReal(point[i]);
            result.geom.normal[i] = dReal(normal[i]);
            result.fdir1[i] = dReal(first[i]);
        }
        result.surface.motionN = dReal(never);
        return result;
    }

    /// One contact for each `together` rows, of which `contact_of` gets the first and the second
    /// (null: there is none).
    template <class ContactOf>
    void attach(dBodyID a, dBodyID b, const std::array<PointRow, 3>& rows, std::size_t together,
                const ContactOf& contact_of) {
        std::array<const PointRow*, 3> acting{};
        std::size_t count = 0;
        for (const PointRow& row : rows) {
            if (row.row.strength > 0) acting[count++] = &row;
        }
        if (made_ == nullptr) made_ = std::make_unique<Made>();
        for (std::size_t i = 0; i < count; i += together) {
            const PointRow& first = *acting[i];
            const PointRow* second = together > 1 && i + 1 < count ? acting[i + 1] : nullptr;
            dContact contact = contact_of(first, second);
            dSurfaceParameters& surface = contact.surface;
            surface.mu = dReal(first.row.strength / first.scale);
            surface.motion1 = dReal(first.row.velocity * first.scale);
            surface.slip1 = dReal(first.row.cfm * first.scale * first.scale);
            if (second != nullptr) {
                surface.mu2 = dReal(second->row.strength / second->scale);
                surface.motion2 = dReal(second->row.velocity * second->scale);
                surface.slip2 = dReal(second->row.cfm * second->scale * second->scale);
            }
            const dJointID joint = dJointCreateContact(world_, made_->group, &contact);
            dJointAttach(joint, a, b);
            dJointSetFeedback(joint, &made_->feedback[made_->contacts++]);
        }
    }

    struct Made {
        Made() = default;
        ~Made() { dJointGroupDestroy(group); }
        Made(const Made&) = delete;
        Made& operator=(const Made&) = delete;

        dJointGroupID group = dJointGroupCreate(0);
        std::array<dJointFeedback, 5> feedback{}; ///< two of forces, three of moments
        std::size_t contacts = 0;                 ///< made for this step
    };

    dWorldID world_;
    std::unique_ptr<Made> made_; ///< where ODE ever had rows to solve
};

} // namespace ductile::ode
