// SPDX-License-Identifier: MIT
//
// What a method of holding a joint offers to the scene's driver, whatever the engine. One object
// per joint; it owns what it put into the engine and takes it away again.
#pragma once

#include <optional>

namespace bench {

class Holder {
  public:
    Holder() = default;
    virtual ~Holder() = default;
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;

    /// Before the engine's step of `dt` [s].
    virtual void before_step(double /*dt*/) {}
    /// After it.
    virtual void after_step(double /*dt*/) {}
    /// Energy that the method says the joint absorbed [J]; none where it keeps no account.
    [[nodiscard]] virtual std::optional<double> absorbed() { return std::nullopt; }
    /// Largest travel of a joint that flowed one way, as its account has it [rad | m]; none where
    /// it keeps no account.
    [[nodiscard]] virtual std::optional<double> peak() { return std::nullopt; }
    /// True where the method itself says that the last step should not be believed.
    [[nodiscard]] virtual bool unreliable() { return false; }
    [[nodiscard]] virtual bool broken() { return false; }
};

} // namespace bench
