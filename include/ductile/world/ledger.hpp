// SPDX-License-Identifier: MIT
//
// The ledger of a world: what energy it holds, where energy went, and what is left unexplained.
//
//   held(now) = kinetic + potential + elastic
//   unexplained = held(at open) + supplied - held(now) - Σ booked
//
// Every booked entry is energy that left the world's bodies [J], positive when they lost it. With
// the work of a row taken as impulse × mean of the velocities before and after, the entries add up
// to the change of kinetic energy exactly, so `unexplained` is round-off unless an entry is
// missing.
//
// Thread-safety: one ledger per thread.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>

namespace ductile {

/// Energy held by the bodies of a world [J].
template <std::floating_point S>
struct HeldEnergy {
    S kinetic = 0;
    S potential = 0;
    S elastic = 0;

    [[nodiscard]] S total() const noexcept { return kinetic + potential + elastic; }
};

/// Where energy goes.
enum class Account : std::size_t {
    plastic,     ///< flow of plastic joints
    friction,    ///< tangential contact forces
    contact,     ///< normal contact forces: inelastic impact, push-out by velocity
    joints,      ///< rigid rows and the engine's own joints: impact inside a joint, drift removal
    damping,     ///< the material's, of plastic joints below their strength
    sleep,       ///< motion that ends because the engine puts a body to sleep
    integration, ///< the engine's own drift: potential over a step against the work of gravity,
                 ///< kinetic energy changed by turning an inertia tensor or by damping
    members,     ///< bodies of members that were split or made one: motion of pieces against each
                 ///< other, and what pieces of a static body brought or took with their weight
    vibration,   ///< elastic energy of members that a blow yielded, which rings down
    count
};

[[nodiscard]] constexpr std::string_view to_string(Account account) noexcept {
    constexpr std::array<std::string_view, std::size_t(Account::count)> names{
        "plastic", "friction",    "contact", "joints",   "damping",
        "sleep",   "integration", "members", "vibration"};
    return account < Account::count ? names[std::size_t(account)] : "unknown";
}

template <std::floating_point S>
class Ledger {
  public:
    /// Starts a new account with what the world holds now; forgets all entries.
    void open(const HeldEnergy<S>& held) noexcept {
        opened_ = now_ = held;
        supplied_ = brought_in_ = 0;
        booked_.fill(0);
    }

    /// Books energy that left the bodies; negative where they gained it [J].
    void book(Account account, S energy) noexcept { booked_[std::size_t(account)] += energy; }
    /// Books energy brought in from outside, as by a motor or an applied force [J].
    void supply(S energy) noexcept { supplied_ += energy; }
    /// Tells what the world holds now.
    void update(const HeldEnergy<S>& held) noexcept { now_ = held; }

    [[nodiscard]] const HeldEnergy<S>& opened() const noexcept { return opened_; }
    [[nodiscard]] const HeldEnergy<S>& held() const noexcept { return now_; }
    [[nodiscard]] S supplied() const noexcept { return supplied_; }
    [[nodiscard]] S booked(Account account) const noexcept { return booked_[std::size_t(account)]; }

    /// By contacts, pair by pair, and joints of the engine's that nobody drives, beyond what they
    /// took; a part of Account::contact and Account::joints [J].
    void set_brought_in(S energy) noexcept { brought_in_ = energy; }
    [[nodiscard]] S brought_in() const noexcept { return brought_in_; }

    /// Energy that no entry names [J]; round-off in a complete ledger.
    [[nodiscard]] S unexplained() const noexcept {
        S left = opened_.total() + supplied_ - now_.total();
        for (const S entry : booked_) left -= entry;
        return left;
    }

  private:
    HeldEnergy<S> opened_;
    HeldEnergy<S> now_;
    S supplied_ = 0, brought_in_ = 0;
    std::array<S, std::size_t(Account::count)> booked_{};
};

} // namespace ductile
