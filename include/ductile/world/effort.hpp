// SPDX-License-Identifier: MIT
//
// What a world does about joints that its solver left unsolved. A step that was done is not undone:
// the effort of the next ones is raised, and lowered again when all is calm.
//
//   unreliable step   effort doubles, up to the most the user allows (or the direct solver takes
//   over) `calm_steps` reliable steps in a row   effort halves, down to one
//
// Limit case: with OnUnconverged::report the effort stays 1.
#pragma once

#include <algorithm>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

enum class OnUnconverged {
    report,           ///< say so and go on
    raise_iterations, ///< of the iterative solver
    split_step,       ///< into equal parts
    direct_solver,    ///< in place of the iterative one
};

struct EffortParameters {
    OnUnconverged action = OnUnconverged::report;
    int most_iterations = 64; ///< times the user's number of iterations, >= 1
    int most_parts = 16;      ///< of a step, >= 1
    int calm_steps = 120;     ///< reliable steps after which the effort is lowered, >= 1
};

/// What the next step is to be done with. Plain value.
struct Effort {
    int iterations = 1; ///< factor on the user's number of iterations
    int parts = 1;      ///< number of equal parts of the step
    bool direct = false;

    bool operator==(const Effort&) const = default;
};

/// Not thread-safe; O(1), noexcept after construction.
class EffortControl {
  public:
    /// @throws std::invalid_argument where a parameter is out of range.
    explicit EffortControl(const EffortParameters& parameters = {}) : p_(parameters) {
        at_least_one("Effort.most_iterations", p_.most_iterations);
        at_least_one("Effort.most_parts", p_.most_parts);
        at_least_one("Effort.calm_steps", p_.calm_steps);
    }

    [[nodiscard]] const EffortParameters& parameters() const noexcept { return p_; }
    [[nodiscard]] const Effort& effort() const noexcept { return effort_; }

    /// Effort of the next step, after one that was `reliable` or not.
    const Effort& next(bool reliable) noexcept {
        if (!reliable) {
            calm_ = 0;
            raise();
        } else if (++calm_ >= p_.calm_steps) {
            calm_ = 0;
            lower();
        }
        return effort_;
    }

  private:
    static void at_least_one(const char* field, int value) {
        if (value < 1) check::fail(field, double(value), "", ">= 1");
    }

    void raise() noexcept {
        switch (p_.action) {
            case OnUnconverged::report:
                break;
            case OnUnconverged::raise_iterations:
                effort_.iterations = std::min(2 * effort_.iterations, p_.most_iterations);
                break;
            case OnUnconverged::split_step:
                effort_.parts = std::min(2 * effort_.parts, p_.most_parts);
                break;
            case OnUnconverged::direct_solver:
                effort_.direct = true;
                break;
        }
    }
    void lower() noexcept {
        effort_.iterations = std::max(effort_.iterations / 2, 1);
        effort_.parts = std::max(effort_.parts / 2, 1);
        effort_.direct = false;
    }

    EffortParameters p_;
    Effort effort_;
    int calm_ = 0;
};

} // namespace ductile
