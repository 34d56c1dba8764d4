// SPDX-License-Identifier: MIT
//
// A clamped cantilever as rigid rods with an elastic-perfectly-plastic spring at the root and
// between them, half a rod's mass at either end, and a mass that sticks to its tip. Small
// deflections, explicit steps of a fraction of the highest period. Knows nothing of the library but
// the numbers of the post (strips.hpp).
//
//   rotation at node i: (y_{i+1} - 2 y_i + y_{i-1})/s, stiffness EI/s; at the root y_1/s and 2 EI/s
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/member/strips.hpp"

namespace ductile::test {

struct ChainParameters {
    int segments = 20;
    double length = 0, mass = 0, stiffness = 0, strength = 0; ///< [m], [kg], EI [N m²], [N m]
    double tip_mass = 0, tip_speed = 0;                       ///< [kg], [m/s]
};

class ElasticPlasticChain {
  public:
    explicit ElasticPlasticChain(const ChainParameters& p)
        : p_(p),
          s_(p.length / p.segments),
          mass_(std::size_t(p.segments) + 1, p.mass / p.segments),
          y_(mass_.size(), 0.0),
          v_(mass_.size(), 0.0),
          force_(mass_.size(), 0.0),
          plastic_(std::size_t(p.segments), 0.0) {
        mass_.back() = mass_.back() / 2 + p.tip_mass;
        v_.back() = p.tip_mass * p.tip_speed / mass_.back();
    }
    void go(double time) {
        const double rod = p_.mass / p_.segments;
        const double dt = 0.1 / std::sqrt(p_.stiffness / (rod * s_ * s_ * s_));
        for (double t = 0; t < time; t += dt) step(dt);
    }
    [[nodiscard]] double work() const { return work_; } ///< plastic [J]

  private:
    void step(double dt) {
        std::fill(force_.begin(), force_.end(), 0.0);
        for (std::size_t i = 0; i < plastic_.size(); ++i) {
            const bool root = i == 0;
            const double turn = root ? y_[1] / s_ : (y_[i + 1] - 2 * y_[i] + y_[i - 1]) / s_;
            const double k = (root ? 2 : 1) * p_.stiffness / s_;
            double moment = k * (turn - plastic_[i]);
            if (std::abs(moment) > p_.strength) {
                const double bound = std::copysign(p_.strength, moment);
                const double flow = (moment - bound) / k;
                plastic_[i] += flow;
                work_ += bound * flow;
                moment = bound;
            }
            force_[i + 1] -= moment / s_;
            if (root) continue;
            force_[i] += 2 * moment / s_;
            force_[i - 1] -= moment / s_;
        }
        for (std::size_t i = 1; i < mass_.size(); ++i) {
            v_[i] += force_[i] / mass_[i] * dt;
            y_[i] += v_[i] * dt;
        }
    }

    ChainParameters p_;
    double s_, work_ = 0;
    std::vector<double> mass_, y_, v_, force_, plastic_;
};

/// What P39's post as a chain of `segments` absorbs of a mass that sticks to its tip [J].
[[nodiscard]] inline double work_of_post(int segments, double mass, double speed) {
    ElasticPlasticChain chain({.segments = segments,
                               .length = post_length,
                               .mass = post_mass,
                               .stiffness = post_stiffness,
                               .strength = post_strength,
                               .tip_mass = mass,
                               .tip_speed = speed});
    chain.go(0.15 + 2 * mass * speed * post_length / post_strength);
    return chain.work();
}

} // namespace ductile::test
