// SPDX-License-Identifier: MIT
//
// Memory for a batch, for callers that have no arrays of their own yet. An engine that keeps its
// velocities and reactions in arrays hands those in instead and nothing is copied.
//
//   BatchStorage<float> memory(1000);
//   OneAxisBatch batch(batch_law(Perfect<float>({.strength = 40})), memory.arrays());
#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

#include "ductile/batch/arrays.hpp"
#include "ductile/batch/status.hpp"

namespace ductile {

/// Owns all arrays of `joints` joints, zero at first. Its arrays stay where they are for as long as
/// it lives, also when it is moved; a copy has arrays of its own.
template <std::floating_point S>
struct BatchStorage {
    explicit BatchStorage(std::size_t joints)
        : position(joints),
          velocity(joints),
          lower(joints),
          upper(joints),
          bias(joints),
          force(joints),
          velocity_after(joints),
          position_after(joints),
          plastic_offset(joints),
          plastic_travel(joints),
          plastic_work(joints),
          other_work(joints),
          start_velocity(joints),
          last_velocity(joints),
          residual_max(joints),
          release(joints),
          residual(joints),
          status(joints) {}

    [[nodiscard]] std::size_t size() const noexcept { return position.size(); }

    [[nodiscard]] BatchArrays<S> arrays() noexcept {
        return {.motion = {position, velocity},
                .rows = {lower, upper, bias},
                .reaction = {force, velocity_after, position_after},
                .state = {plastic_offset, plastic_travel, plastic_work, other_work, start_velocity,
                          last_velocity, residual_max, status},
                .step = {release, residual}};
    }

    std::vector<S> position, velocity;                    ///< BatchMotion
    std::vector<S> lower, upper, bias;                    ///< BatchRows
    std::vector<S> force, velocity_after, position_after; ///< BatchReaction
    std::vector<S> plastic_offset, plastic_travel, plastic_work, other_work, start_velocity,
        last_velocity, residual_max;  ///< BatchState
    std::vector<S> release, residual; ///< BatchStep
    std::vector<BatchStatus> status;  ///< BatchState
};

} // namespace ductile
