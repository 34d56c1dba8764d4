// SPDX-License-Identifier: MIT
//
// The state of a joint or a link as bytes, to be kept in a file or sent: what from_bytes gives back
// is equal to what to_bytes got. For the same type on machines of the same byte order; the number
// of bytes is checked, what they stand for is not.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace ductile {

/// A state holds its numbers in itself: nothing is freed with it, so that its bytes are all there
/// is.
template <class State>
concept PlainState = std::is_default_constructible_v<State> &&
    std::is_trivially_destructible_v<State> && std::equality_comparable<State>;

template <PlainState State>
[[nodiscard]] std::array<std::byte, sizeof(State)> to_bytes(const State& state) noexcept {
    std::array<std::byte, sizeof(State)> bytes;
    std::memcpy(bytes.data(), static_cast<const void*>(&state), sizeof(State));
    return bytes;
}

/// @throws std::invalid_argument where `bytes` are not as many as a State has.
template <PlainState State>
[[nodiscard]] State from_bytes(std::span<const std::byte> bytes) {
    if (bytes.size() != sizeof(State)) {
        throw std::invalid_argument("state: " + std::to_string(bytes.size()) + " bytes, expected " +
                                    std::to_string(sizeof(State)));
    }
    State state;
    std::memcpy(static_cast<void*>(&state), bytes.data(), sizeof(State));
    return state;
}

} // namespace ductile
