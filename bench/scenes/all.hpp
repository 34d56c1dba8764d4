// SPDX-License-Identifier: MIT
//
// Every scene with its default numbers.
#pragma once

#include <vector>

#include "scenes/breaking_hinge.hpp"
#include "scenes/charpy.hpp"
#include "scenes/dropped_mass.hpp"
#include "scenes/lamp_post.hpp"
#include "scenes/oscillator.hpp"
#include "scenes/rotors_in_series.hpp"
#include "scenes/struck_cantilever.hpp"

namespace bench {

[[nodiscard]] inline std::vector<Scene> all_scenes() {
    return {breaking_hinge(), rotors_in_series(), oscillator(), struck_cantilever(),
            dropped_mass(),   lamp_post(),        charpy_blow()};
}

} // namespace bench
