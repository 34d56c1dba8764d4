// SPDX-License-Identifier: MIT
//
// Stops of Bullet's own constraints: where their axes are, when they come to a stop, and what a
// part asks of them. Of hinges, sliders, cones and those of six degrees of freedom, with
// springs or without; those of others are not told.
//
//   at it or not    as the part begins: an axis that is not at a stop has none in the part, which
//                   ends where it comes to one. Bullet asks in the middle of the part, and of
//                   btGeneric6DofSpring2Constraint it has rows of stops that it is far from, which
//                   brake it as a share of the gap over a tick would
//   how far beyond  as the part begins: the way to its middle is no error. That is
//                   taken back as slowly as an overlap
//   strikes         an axis at its stop that goes into it: a blow
//   ERP, CFM        set for stops of constraints of six degrees of freedom, they are a spring of
//                   the frame: a part's (frame/part_settings.hpp)
//   bias            takes a btConeTwistConstraint back from its limits by a share a tick: by as
//                   much in all its parts
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/ConstraintSolver/btConeTwistConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <array>
#include <cstddef>
#include <vector>

#include "ductile/bullet/lent.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// An axis of a constraint that has two stops [m | rad].
struct StoppedAxis {
    int number; ///< of its constraint's; 0, 1, 2: it moves, else it turns
    btScalar least, most, at;

    [[nodiscard]] bool moves() const noexcept { return number < 3; }
    /// Distance to one of the stops, < 0 beyond it [m | rad].
    [[nodiscard]] double gap(bool upper) const noexcept {
        return double(upper ? most - at : at - least);
    }
};

/// Axes of one constraint.
struct StoppedAxes {
    std::array<StoppedAxis, 6> axes{};
    std::size_t count = 0;

    void add(const StoppedAxis& axis) {
        if (axis.least < axis.most) axes[count++] = axis;
    }
    [[nodiscard]] const StoppedAxis* begin() const noexcept { return axes.data(); }
    [[nodiscard]] const StoppedAxis* end() const noexcept { return axes.data() + count; }
};

/// As its bodies would be at `a`, `b`; the constraint keeps what it calculates of that.
[[nodiscard]] DUCTILE_INLINE StoppedAxes stopped_axes(btTypedConstraint& constraint,
                                                      const btTransform& a, const btTransform& b);
/// As they are.
[[nodiscard]] DUCTILE_INLINE StoppedAxes stopped_axes(btTypedConstraint& constraint);

/// When an axis comes to its stop with more than `energy` [J] if bodies go on as they do, within
/// `h`; else infinite [s].
[[nodiscard]] DUCTILE_INLINE double time_to_stop(btTypedConstraint& constraint, double h,
                                                 double energy);

/// Whether an axis at its stop goes into it with more than `energy` [J].
[[nodiscard]] DUCTILE_INLINE bool strikes_stop(btTypedConstraint& constraint, double energy);

/// While this lives constraints have the stops of a part.
class PartStops {
  public:
    PartStops() = default;
    DUCTILE_INLINE ~PartStops();
    PartStops(const PartStops&) = delete;
    PartStops& operator=(const PartStops&) = delete;

    /// To be called with its bodies as the part begins.
    DUCTILE_INLINE void take(btTypedConstraint& constraint);
    /// For a part of `h` in a frame of `frame` [s] and a world of `erp` [-], with all bodies as it
    /// sees them.
    DUCTILE_INLINE void set(double h, double frame, double erp);
    /// They have the user's again.
    DUCTILE_INLINE void put_back();
    /// When the first of them that was open in the part came to its stop with more than `energy`
    /// [J], which was not foreseen, after `put_back`; else infinite [s].
    [[nodiscard]] DUCTILE_INLINE double met(double h, double energy) const;

  private:
    struct AsItBegan {
        btTypedConstraint* constraint;
        StoppedAxes axes;
    };

    struct Limits {
        btTypedConstraint* constraint;
        int number;
        btScalar least, most;
    };
    struct Cone { ///< the user's
        btConeTwistConstraint* constraint;
        btScalar span_1, span_2, twist, bias;
    };
    void hold(btTypedConstraint& constraint, const StoppedAxis& began, const StoppedAxis& now);
    template <class SixAxes>
    void soften_all(SixAxes& constraint, double h, double frame);

    std::vector<AsItBegan> began_;
    std::vector<Cone> cones_;
    btScalar slowly_ = 1;        ///< of the way beyond a stop
    std::vector<Limits> limits_; ///< the user's
    Lent<btScalar> lent_;        ///< the user's ERP and CFM
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/constraint_stops.ipp"
#endif
