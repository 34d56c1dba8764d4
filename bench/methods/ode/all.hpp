// SPDX-License-Identifier: MIT
//
// Every method there is in ODE, by name.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "methods/ode/engine_joints.hpp"
#include "methods/ode/explicit_clamp.hpp"
#include "methods/ode/plastic.hpp"
#include "methods/ode/seed_account.hpp"

namespace bench::ode_methods {

using Make = std::unique_ptr<Holder> (*)(const OdeSite&);

template <class Any>
std::unique_ptr<Holder> one(const OdeSite& site) {
    return std::make_unique<Any>(site);
}

inline constexpr std::array<std::pair<std::string_view, Make>, 8> all{{
    {"rigid", one<Rigid>}, // a detail, not one of method_names
    {"spring", one<Spring>},
    {"hinge-motor", one<Motor>},
    {"seed-account", one<Accounted>},
    {"explicit-clamp", one<Clamped>},
    {"plastic-hinge", rigid_plastic},
    {"elastic-plastic", elastic_plastic},
    {"plastic-joint", plastic_joint},
}};

} // namespace bench::ode_methods
