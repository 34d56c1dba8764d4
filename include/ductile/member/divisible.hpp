// SPDX-License-Identifier: MIT
//
// What is fewer bodies than it may come to be, as a world sees it in any engine: a member, a
// structure. An adapter's Divisible adds how its engine tells of a step.
//
// Not thread-safe.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ductile/member/active_sections.hpp"

namespace ductile {

/// `Joint`: the engine's plastic joints; `Hold`: joints of the user's that hold on to it. Sections:
/// of a member; of a structure the joints of its plan.
template <class Joint, class Hold>
class Divisible {
  public:
    using VisitHold = std::function<void(Hold&)>;

    Divisible() = default;
    Divisible(const Divisible&) = delete;
    Divisible& operator=(const Divisible&) = delete;
    virtual ~Divisible() = default;

    [[nodiscard]] virtual bool whole() const = 0;
    /// Of a joint of its own; no_section: it is not.
    [[nodiscard]] virtual int section_of(const Joint& joint) const = 0;
    /// Under which a section is reported.
    [[nodiscard]] virtual const void* key_of(int section) const = 0;
    /// Of sections that are closed [J]; that of a least travel, 0: of none.
    [[nodiscard]] virtual double closed_work() const = 0;
    [[nodiscard]] virtual double unmissed_work() const = 0;
    /// It is in the world no more.
    virtual void leave() = 0;
    virtual void over_holds(const VisitHold& visit) = 0;

    // ---- a step

    /// Forces that were applied to it act in the coming solve, too; they do not any more.
    virtual void apply_forces() = 0;
    virtual void drop_forces() = 0;
    /// In the coming solve a driven body passes through what does not move of it.
    virtual void driven_through() = 0;
    /// Joints of the user's count in it that take more than `noticed` [J].
    virtual void begin_blow(double noticed) = 0;
    virtual void open(std::span<const int> sections, bool ahead) = 0;
    /// A step stands: what it left in vibration, of what its sections took [J].
    virtual double count_vibration() = 0;
    /// The same, or a blow comes: closes what held, and says which sections that were.
    virtual std::vector<int> close_held(Closing when, bool ahead) = 0;
};

} // namespace ductile
