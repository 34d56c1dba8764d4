// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace ductile::test {

/// Message of the std::invalid_argument that `action` throws; "nothing thrown" where it does not.
template <class Action>
std::string message_of(Action&& action) {
    try {
        action();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "nothing thrown";
}

} // namespace ductile::test
