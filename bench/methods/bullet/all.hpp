// SPDX-License-Identifier: MIT
//
// Every method there is in Bullet, by name.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "methods/bullet/engine_joints.hpp"
#include "methods/bullet/explicit_clamp.hpp"
#include "methods/bullet/plastic.hpp"
#include "methods/bullet/seed_account.hpp"

namespace bench::bullet_methods {

using Make = std::unique_ptr<Holder> (*)(const BulletSite&);

/// One holder for joints that turn, another for joints that slide.
template <class Turning, class Sliding>
std::unique_ptr<Holder> either(const BulletSite& site) {
    if (site.turns()) return std::make_unique<Turning>(site);
    return std::make_unique<Sliding>(site);
}
template <class Any>
std::unique_ptr<Holder> one(const BulletSite& site) {
    return std::make_unique<Any>(site);
}
template <bool limited>
std::unique_ptr<Holder> spring2(const BulletSite& site) {
    return std::make_unique<Spring2>(site, limited);
}
inline std::unique_ptr<Holder> explicit_clamp(const BulletSite& site) {
    if (!site.turns()) {
        return std::make_unique<Clamped<btSliderConstraint>>(
            site, free_slider(site.a, site.b, site.in_a, site.in_b));
    }
    return std::make_unique<Clamped<btHingeConstraint>>(
        site, std::make_unique<btHingeConstraint>(site.a, site.b, site.in_a, site.in_b, true));
}

inline constexpr std::array<std::pair<std::string_view, Make>, 11> all{{
    {"rigid", one<Rigid>}, // a detail, not one of method_names
    {"zero-limits", one<ZeroLimits>},
    {"spring", one<Spring>},
    {"spring2", spring2<true>},
    {"spring2-unlimited", spring2<false>},
    {"hinge-motor", either<HingeMotor, SliderMotor>},
    {"seed-account", either<Accounted<HingeMotor>, Accounted<SliderMotor>>},
    {"explicit-clamp", explicit_clamp},
    {"plastic-hinge", rigid_plastic},
    {"elastic-plastic", elastic_plastic},
    {"plastic-joint", plastic_joint},
}};

} // namespace bench::bullet_methods
