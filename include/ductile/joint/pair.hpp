// SPDX-License-Identifier: MIT
//
// Two rigid bodies seen from the point that joins them.
#pragma once

#include "ductile/joint/break_release.hpp"
#include "ductile/joint/inverse_mass.hpp"
#include "ductile/vocabulary/vector.hpp"
