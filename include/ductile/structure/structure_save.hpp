// SPDX-License-Identifier: MIT
//
// What a structure that is as few bodies as its yielding joints need was at some time: its course
// and where its bodies were. An engine's snapshot adds what holds on to it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ductile/structure/refuse.hpp"
#include "ductile/structure/structure_course.hpp"

namespace ductile {

/// Plain value.
class StructureSave {
  public:
    /// `course`: `saved` is of it; `bodies`: by cluster, of one that is held nothing.
    StructureSave(const StructureCourse& course, StructureCourse::Saved saved,
                  std::vector<PlacedBody> bodies)
        : plan_(marks(course.plan())), saved_(std::move(saved)), bodies_(std::move(bodies)) {}

    [[nodiscard]] const StructureCourse::Saved& saved() const noexcept { return saved_; }
    [[nodiscard]] const std::vector<PlacedBody>& bodies() const noexcept { return bodies_; }

    /// @throws std::invalid_argument where it was of a structure of another model, or of one that
    /// had lost other members or joints, or a body was nowhere or moved at no finite velocity.
    void require_of(const StructureCourse& course) const {
        const StructurePlan& plan = course.plan();
        if (marks(plan) != plan_) {
            throw std::invalid_argument(
                "StructureSnapshot.structure: must be the one that was saved, or one of the same "
                "model");
        }
        for (std::size_t j = 0; j < plan.joints.size(); ++j) {
            if (course.joint(j).there == saved_.state.joints[j].there) continue;
            detail::refuse("StructureSnapshot.structure", plan.joints[j].name,
                           "removed or there as when it was saved");
        }
        for (std::size_t c = 0; c < bodies_.size(); ++c) {
            const std::string field = "StructureSnapshot.bodies[" + std::to_string(c) + "].";
            require(field + "place", bodies_[c].pose.origin, "m");
            for (int i = 0; i < 3; ++i)
                require(field + "axes", column(bodies_[c].pose.axes, i), "");
            require(field + "velocity", bodies_[c].motion.velocity, "m/s");
            require(field + "spin", bodies_[c].motion.spin, "rad/s");
        }
    }

  private:
    static void require(const std::string& field, const Vector3<double>& v, const char* unit) {
        for (int i = 0; i < 3; ++i) check::finite(field, v[i], unit);
    }
    /// By which a model is known again.
    [[nodiscard]] static std::vector<double> marks(const StructurePlan& plan) {
        std::vector<double> all;
        const auto add = [&all](const auto& numbers) {
            all.insert(all.end(), numbers.begin(), numbers.end());
        };
        for (const PlanBody& body : plan.bodies) {
            all.push_back(body.mass);
            add(body.pose.origin);
        }
        for (const PlanJoint& joint : plan.joints) {
            add(joint.frame.origin);
            add(joint.joint.surface().semi_axes());
            add(joint.joint.parameters().stiffness);
        }
        return all;
    }

    std::vector<double> plan_;
    StructureCourse::Saved saved_;
    std::vector<PlacedBody> bodies_;
};

} // namespace ductile
