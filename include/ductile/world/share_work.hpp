// SPDX-License-Identifier: MIT
//
// One account of the joints that were solved together (joint/work_share.hpp), after all of them
// booked a step and before any of them lets go.
#pragma once

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include "ductile/joint/joint_totals.hpp"
#include "ductile/joint/work_share.hpp"

namespace ductile {

/// A joint in the account.
class SharesWork {
  public:
    /// Of the step just done; null where it booked none.
    [[nodiscard]] virtual const Step<double>* booked() const noexcept = 0;
    /// Books it again, for a share of its flow.
    virtual void grant(double share) noexcept = 0;

  protected:
    SharesWork() = default;
    ~SharesWork() = default;
};

/// `islands()`: of each of the `joints` a number that joints solved together have in common, any
/// number where it booked none; called where there is something to share. O(joints).
template <class Joint, class Islands>
void share_work(std::span<Joint* const> joints, const Islands& islands) {
    WorkShare<double> all;
    for (const Joint* joint : joints) {
        if (const Step<double>* step = joint->booked()) all.add(*step);
    }
    if (!(all.value() < 1)) return;
    const std::vector<std::size_t> of_joint = islands();
    std::unordered_map<std::size_t, WorkShare<double>> shares;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (const Step<double>* step = joints[i]->booked()) shares[of_joint[i]].add(*step);
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const Step<double>* step = joints[i]->booked();
        if (step == nullptr || !(step->claimed > 0)) continue;
        const double share = shares[of_joint[i]].value();
        if (share < 1) joints[i]->grant(share);
    }
}

} // namespace ductile
