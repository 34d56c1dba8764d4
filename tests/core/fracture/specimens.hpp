// SPDX-License-Identifier: MIT
//
// One specimen of every criterion, in any system of units, and the increments a row would feed it.
#pragma once

#include <cmath>
#include <type_traits>

#include "ductile/fracture/any_of.hpp"
#include "ductile/fracture/brittle_force.hpp"
#include "ductile/fracture/coffin_manson.hpp"
#include "ductile/fracture/energy_limit.hpp"
#include "ductile/fracture/fracture.hpp"
#include "ductile/fracture/low_cycle_fatigue.hpp"
#include "ductile/fracture/softening_damage.hpp"
#include "ductile/fracture/total_strain_life.hpp"
#include "ductile/fracture/travel_limit.hpp"

namespace ductile::test {

/// How many of the user's units make a metre and a newton; `toughness` multiplies every limit.
struct Units {
    double length = 1;
    double force = 1;
    double toughness = 1;
};

template <class C>
struct Specimen;

template <class S>
struct Specimen<TravelLimit<S>> {
    static auto make(Units u = {}) {
        return TravelLimit<S>({.limit = S(1.6 * u.length * u.toughness)});
    }
};
template <class S>
struct Specimen<EnergyLimit<S>> {
    static auto make(Units u = {}) {
        return EnergyLimit<S>({.limit = S(64 * u.length * u.force * u.toughness)});
    }
};
template <class S>
struct Specimen<BrittleForce<S>> {
    static auto make(Units u = {}) {
        return BrittleForce<S>({.limit = S(45 * u.force * u.toughness)});
    }
};
template <class S>
struct Specimen<SofteningDamage<S>> {
    static auto make(Units u = {}) {
        return SofteningDamage<S>(
            {.onset = S(0.5 * u.length * u.toughness), .failure = S(1.9 * u.length * u.toughness)});
    }
};
template <class S>
struct Specimen<LowCycleFatigue<CoffinManson<S>>> {
    static auto make(Units u = {}) {
        return LowCycleFatigue(
            CoffinManson<S>({.ductility_coefficient = 1, .ductility_exponent = S(-0.6)}),
            {.strain_per_travel = S(0.5 / u.length / u.toughness)});
    }
};
template <class S>
struct Specimen<LowCycleFatigue<TotalStrainLife<S>>> {
    static auto make(Units u = {}) {
        return LowCycleFatigue(TotalStrainLife<S>({.ductility_coefficient = 1,
                                                   .ductility_exponent = S(-0.6),
                                                   .strength_coefficient = S(900e6),
                                                   .strength_exponent = S(-0.09),
                                                   .youngs_modulus = S(200e9)}),
                               {.strain_per_travel = S(0.5 / u.length / u.toughness)});
    }
};
template <class... C>
struct Specimen<AnyOf<C...>> {
    static auto make(Units u = {}) { return AnyOf<C...>(Specimen<C>::make(u)...); }
};

template <class S>
using AnyOfAll = AnyOf<TravelLimit<S>, EnergyLimit<S>, BrittleForce<S>, SofteningDamage<S>,
                       LowCycleFatigue<CoffinManson<S>>>;

/// Feeds a criterion as a row would: keeps the accumulated travel, and clips the increment to what
/// remains. Flow at strength R against a force of the other sign.
template <FractureCriterion C>
struct Row {
    using S = typename C::Scalar;

    explicit Row(const C& c) : criterion(c) {}

    const C& criterion;
    typename C::State state{};
    S travel = 0;
    S work = 0;

    /// Returns false from the step on that broke.
    bool flow(S plastic, S strength, bool clip = true) {
        if (criterion.broken(state)) return false;
        if (clip) {
            const S left = criterion.remaining(state, strength, plastic);
            plastic = std::copysign(std::min(std::abs(plastic), left), plastic);
        }
        const S step = std::abs(plastic);
        travel += step;
        work += strength * step;
        criterion.update(state, {.plastic = plastic,
                                 .travel = travel,
                                 .force = -std::copysign(strength, plastic),
                                 .work = strength * step,
                                 .dt = S(0.001)});
        return !criterion.broken(state);
    }
};

} // namespace ductile::test
