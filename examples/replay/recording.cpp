// SPDX-License-Identifier: MIT
#include "recording.hpp"

#include <cmath>
#include <string>

namespace ductile::replay {

namespace {

[[noreturn]] void fail(const Recording& recording, const std::string& what) {
    throw Error("recording \"" + recording.name + "\": " + what);
}

} // namespace

void check(const Recording& recording) {
    const std::size_t frames = recording.times.size();
    if (recording.bodies.empty()) fail(recording, "there is no body in it");
    if (frames == 0) fail(recording, "nothing was sampled");
    if (!std::isfinite(recording.times.back())) fail(recording, "its time is no number");
    for (std::size_t i = 1; i < frames; ++i) {
        if (!(recording.times[i] > recording.times[i - 1])) {
            fail(recording, "time does not increase at sample " + std::to_string(i));
        }
    }
    const auto full = [&](std::size_t size, const std::string& of) {
        if (size != frames) {
            fail(recording,
                 of + " has " + std::to_string(size) + " samples of " + std::to_string(frames));
        }
    };
    const auto known = [&](int body, const std::string& of) {
        if (body < -1 || body >= int(recording.bodies.size())) {
            fail(recording, of + " names body " + std::to_string(body) + " of " +
                                std::to_string(recording.bodies.size()));
        }
    };
    if (recording.poses.size() != recording.bodies.size()) fail(recording, "poses are missing");
    for (std::size_t i = 0; i < recording.bodies.size(); ++i) {
        const std::string name = "body \"" + recording.bodies[i].name + "\"";
        if (recording.bodies[i].moves)
            full(recording.poses[i].size(), name);
        else if (recording.poses[i].size() != 1)
            fail(recording, name + " has no pose");
    }
    if (recording.samples.size() != recording.joints.size()) fail(recording, "joints are missing");
    for (std::size_t i = 0; i < recording.joints.size(); ++i) {
        const Joint& joint = recording.joints[i];
        const JointSamples& samples = recording.samples[i];
        const std::string name = "joint \"" + joint.name + "\"";
        known(joint.a, name);
        known(joint.b, name);
        for (const auto* column : {&samples.utilisation, &samples.plastic_travel, &samples.absorbed,
                                   &samples.residual, &samples.life}) {
            full(column->size(), name);
        }
        if (samples.curves.empty()) fail(recording, name + " has no curve");
        for (const Curve& curve : samples.curves) {
            full(curve.force.size(), name);
            full(curve.position.size(), name);
        }
        full(samples.state.size(), name);
    }
    for (const auto& [name, column] : recording.energies) full(column.size(), "energy " + name);
    for (const Event& event : recording.events) {
        if (event.joint < -1 || event.joint >= int(recording.joints.size())) {
            fail(recording, "event of \"" + event.name + "\" names no joint of it");
        }
    }
    full(recording.hashes.size(), "hashes");
}

} // namespace ductile::replay
