// SPDX-License-Identifier: MIT
//
// How a frame left the bodies, and what joins them: whom hands threw, or joined, since then. A body
// that was not there is taken to have been at rest, and joined to nothing while it is.
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "ductile/vocabulary/address_book.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile {

class LeftMotions {
  public:
    /// A frame is over: they are as follow.
    void clear() noexcept { left_.clear(); }
    /// `joints`: the sum of joint_mark over what is joined to it.
    void leave(const void* body, const ContactBody& motion, std::size_t joints) {
        left_[body] = {motion, joints, true};
    }
    /// To be called before it is destroyed.
    void forget(const void* body) {
        if (Left* left = left_.find(body)) *left = {};
    }
    /// It moves, and is joined, as it was left.
    [[nodiscard]] bool is_left(const void* body, const ContactBody& motion,
                               std::size_t joints) const {
        const Left* found = left_.find(body);
        const Left was = found != nullptr ? *found : Left{};
        return was.motion.velocity == motion.velocity && was.motion.spin == motion.spin &&
               (!was.known || was.joints == joints);
    }

  private:
    struct Left {
        ContactBody motion;
        std::size_t joints = 0;
        bool known = false; ///< else new since
    };
    AddressMap<Left> left_;
};

/// Of a joint that acts between two bodies: another one almost certainly has another mark.
[[nodiscard]] inline std::size_t joint_mark(const void* joint, const void* a,
                                            const void* b) noexcept {
    std::uint64_t mark = 0;
    for (const void* each : {joint, a, b}) {
        mark = (mark ^ std::uint64_t(std::hash<const void*>()(each))) * 0x9e3779b97f4a7c15u;
        mark ^= mark >> 29u;
    }
    return std::size_t(mark);
}

} // namespace ductile
