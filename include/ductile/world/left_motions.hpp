// SPDX-License-Identifier: MIT
//
// How a frame left the bodies, and what joins them: whom hands threw, or joined, since then. A body
// that was not there is taken to have been at rest, and joined to nothing while it is.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "ductile/world/turned_contact.hpp"

namespace ductile {

class LeftMotions {
  public:
    /// A frame is over: they are as follow.
    void clear() noexcept {
        left_.clear();
        next_ = 0;
    }
    /// `joints`: the sum of joint_mark over what is joined to it.
    void leave(const void* body, const ContactBody& motion, std::size_t joints) {
        left_.push_back({body, motion, joints});
        sorted_ = false;
    }
    /// To be called before it is destroyed.
    void forget(const void* body) {
        std::erase_if(left_, [body](const Body& left) { return left.body == body; });
    }
    /// It moves, and is joined, as it was left.
    [[nodiscard]] bool is_left(const void* body, const ContactBody& motion,
                               std::size_t joints) const {
        const Body* was = find(body);
        const ContactBody before = was != nullptr ? was->motion : ContactBody{};
        return before.velocity == motion.velocity && before.spin == motion.spin &&
               (was == nullptr || was->joints == joints);
    }

  private:
    struct Body {
        const void* body;
        ContactBody motion;
        std::size_t joints;
    };
    [[nodiscard]] static bool is_before(const Body& x, const Body& y) {
        return std::less<const void*>()(x.body, y.body);
    }
    /// Mostly they are asked for in the order in which they were left.
    [[nodiscard]] const Body* find(const void* body) const {
        if (next_ < left_.size() && left_[next_].body == body) return &left_[next_++];
        if (!std::exchange(sorted_, true)) std::sort(left_.begin(), left_.end(), is_before);
        const auto found =
            std::lower_bound(left_.begin(), left_.end(), Body{body, {}, 0}, is_before);
        if (found == left_.end() || found->body != body) return nullptr;
        next_ = std::size_t(found - left_.begin()) + 1;
        return &*found;
    }

    mutable std::vector<Body> left_;
    mutable bool sorted_ = false;
    mutable std::size_t next_ = 0; ///< place of the one that is likely asked for
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
