// SPDX-License-Identifier: MIT
#include "recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "ductile/world/axis_queries.hpp"
#include "ductile/world/link_queries.hpp"

namespace ductile::replay {

namespace {

constexpr double unlimited = std::numeric_limits<double>::quiet_NaN();

/// FNV-1a of the bytes of a number.
void add_to_hash(std::uint32_t& hash, double value) {
    std::array<unsigned char, sizeof(double)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 16777619u;
}

/// The same turn, on the side of the last one: q and -q are one turn.
void stay_on_side(Pose& pose, const Pose& last) {
    double dot = 0;
    for (std::size_t k = 0; k < 4; ++k) dot += pose.turn[k] * last.turn[k];
    if (dot < 0) {
        for (double& value : pose.turn) value = -value;
    }
}

} // namespace

Recorder::Recorder(RecorderParameters parameters) : parameters_(std::move(parameters)) {
    if (!(parameters_.rate > 0) || !std::isfinite(parameters_.rate)) {
        throw Error("Recorder.rate = " + std::to_string(parameters_.rate) +
                    " 1/s: must be positive and finite");
    }
    recording_.name = parameters_.name;
    recording_.about = parameters_.about;
    recording_.engine = parameters_.engine;
}

void Recorder::add(const void* key, Body body, std::function<Pose()> pose) {
    if (!by_body_.emplace(key, int(sources_.size())).second) {
        throw Error("Recorder.add: body \"" + body.name + "\" was added already");
    }
    // one that comes late was where it is now
    recording_.poses.emplace_back(body.moves ? recording_.times.size() : 1, pose());
    recording_.bodies.push_back(std::move(body));
    sources_.push_back(std::move(pose));
}

void Recorder::remove(const void* body) {
    const auto known = by_body_.find(body);
    if (known == by_body_.end()) return;
    sources_[std::size_t(known->second)] = nullptr;
    by_body_.erase(known); // another may come to the same address
}

int Recorder::number(const void* body) const {
    const auto known = by_body_.find(body);
    return known == by_body_.end() ? -1 : known->second;
}

void Recorder::add(Joint joint, const JointQueries& queries, std::function<double()> life) {
    const auto same = [&](const SeenJoint& seen) { return seen.queries == &queries; };
    if (std::any_of(joints_.begin(), joints_.end(), same) ||
        !by_name_.emplace(joint.name, int(joints_.size())).second) {
        throw Error("Recorder.add: joint \"" + joint.name + "\" was added already");
    }
    SeenJoint& seen = joints_.emplace_back(SeenJoint{&queries, std::move(life), {}});
    const std::size_t frames = recording_.times.size();
    const auto axis = [&](std::string name, bool turning) {
        seen.axes.push_back({.name = std::move(name),
                             .turns = turning,
                             .force = std::vector<double>(frames, 0),
                             .position = std::vector<double>(frames, 0)});
    };
    if (const auto* link = dynamic_cast<const LinkQueries*>(&queries)) {
        // rigid axes bear what they must: a slider's moments say nothing of its strength
        for (const JointAxis each : link->plastic_axes()) {
            axis(std::string(to_string(each)), turns(each));
        }
    } else {
        axis("axis", joint.turns);
    }
    JointSamples& samples = recording_.samples.emplace_back();
    for (auto* column :
         {&samples.utilisation, &samples.plastic_travel, &samples.absorbed, &samples.residual}) {
        column->assign(frames, 0);
    }
    samples.state.assign(frames, holds);
    samples.life.assign(frames, seen.life ? 0 : unlimited);
    recording_.joints.push_back(std::move(joint));
}

void Recorder::remove(const JointQueries& joint) {
    for (SeenJoint& seen : joints_) {
        if (seen.queries == &joint) seen.queries = nullptr;
    }
}

void Recorder::look(const SteppedWorld& world) {
    for (const JointEvent<double>& event : world.events()) {
        const auto known = by_name_.find(event.name);
        recording_.events.push_back({.time = event.time,
                                     .kind = std::string(to_string(event.kind)),
                                     .joint = known == by_name_.end() ? -1 : known->second,
                                     .name = event.name,
                                     .energy = event.report.absorbed_energy});
    }
    for (SeenJoint& seen : joints_) book_axes(seen);
    constexpr double round_off = 1e-9;
    if (world.time() < next_ - round_off) return;
    next_ = (std::floor(world.time() * parameters_.rate + 1e-6) + 1) / parameters_.rate;
    sample(world);
}

void Recorder::sample(const SteppedWorld& world) {
    recording_.times.push_back(world.time());
    sample_bodies();
    for (std::size_t i = 0; i < joints_.size(); ++i) sample_joint(i);
    sample_energies(world);
}

void Recorder::sample_bodies() {
    std::uint32_t hash = 2166136261u;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        std::vector<Pose>& poses = recording_.poses[i];
        if (!recording_.bodies[i].moves) continue;
        Pose pose = sources_[i] ? sources_[i]() : poses.empty() ? Pose{} : poses.back();
        for (const double value : pose.position) add_to_hash(hash, value);
        for (const double value : pose.turn) add_to_hash(hash, value);
        if (!poses.empty()) stay_on_side(pose, poses.back());
        poses.push_back(pose);
    }
    recording_.hashes.push_back(hash);
}

void Recorder::sample_joint(std::size_t number) {
    SeenJoint& seen = joints_[number];
    JointSamples& samples = recording_.samples[number];
    if (seen.queries == nullptr) {
        // it was taken away: it is what it was, and bears nothing
        const auto repeat = [](auto& column) {
            column.push_back(column.empty() ? typename std::decay_t<decltype(column)>::value_type{}
                                            : column.back());
        };
        repeat(samples.plastic_travel);
        repeat(samples.absorbed);
        repeat(samples.state);
        repeat(samples.life);
        samples.utilisation.push_back(0);
        samples.residual.push_back(0);
        for (Axis& axis : seen.axes) {
            axis.force.push_back(0);
            repeat(axis.position);
        }
        return;
    }
    const JointQueries& queries = *seen.queries;
    samples.utilisation.push_back(queries.utilisation());
    samples.plastic_travel.push_back(queries.plastic_travel());
    samples.absorbed.push_back(queries.absorbed_energy());
    samples.residual.push_back(std::max(queries.residual(), queries.rigid_residual()));
    samples.life.push_back(seen.life ? seen.life() : unlimited);
    const bool flows = queries.plastic_travel() > 0;
    samples.state.push_back(
        std::uint8_t((flows ? flowed : holds) | (queries.broken() ? broken : holds) |
                     (queries.outcome() == Outcome::unreliable ? unreliable : holds)));
    for (Axis& axis : seen.axes) {
        axis.force.push_back(axis.last_force);
        axis.position.push_back(axis.last_position);
    }
}

/// What broke in this step bears nothing any more: the force before it counts too.
void Recorder::Axis::book(double now_force, double now_position, double offset) {
    flowed += std::max(std::abs(now_force), std::abs(last_force)) * std::abs(offset - plastic);
    largest = std::max(largest, std::abs(now_force));
    last_force = now_force;
    last_position = now_position;
    plastic = offset;
}

/// In each step: a joint may flow and break between two samples.
void Recorder::book_axes(SeenJoint& seen) {
    if (seen.queries == nullptr) return;
    const JointQueries& queries = *seen.queries;
    if (const auto* link = dynamic_cast<const LinkQueries*>(&queries)) {
        std::size_t at = 0;
        for (const JointAxis axis : link->plastic_axes()) {
            seen.axes[at++].book(link->force(axis), link->position(axis),
                                 link->plastic_offset(axis));
        }
    } else if (const auto* axis = dynamic_cast<const AxisQueries*>(&queries)) {
        seen.axes[0].book(axis->reaction(), axis->position(), axis->plastic_offset());
    } else {
        seen.axes[0].book(0, queries.plastic_travel(), queries.plastic_travel());
    }
}

void Recorder::sample_energies(const SteppedWorld& world) {
    if (!world.keeps_ledger()) return;
    const Ledger<double>& ledger = world.ledger();
    std::size_t at = 0;
    const auto book = [&](std::string name, double energy) {
        if (at == recording_.energies.size()) recording_.energies.push_back({std::move(name), {}});
        recording_.energies[at++].second.push_back(energy);
    };
    book("kinetic", ledger.held().kinetic);
    book("potential", ledger.held().potential);
    book("elastic", ledger.held().elastic);
    for (std::size_t k = 0; k < std::size_t(Account::count); ++k) {
        book(std::string(to_string(Account(k))), ledger.booked(Account(k)));
    }
    book("supplied", ledger.supplied());
    book("unexplained", ledger.unexplained());
}

/// What flowed most, and what flowed a hundredth of that at least; where nothing did, the largest
/// force. Among them a moment, the largest, where there are any.
std::vector<Curve> Recorder::curves(const SeenJoint& joint) {
    std::vector<const Axis*> order;
    for (const Axis& axis : joint.axes) order.push_back(&axis);
    std::stable_sort(order.begin(), order.end(), [](const Axis* a, const Axis* b) {
        const auto rank = [](const Axis& axis) {
            return std::tuple(axis.flowed, axis.turns && axis.largest > 0, axis.largest);
        };
        return rank(*a) > rank(*b);
    });
    std::vector<Curve> result;
    bool moment = false;
    for (const Axis* axis : order) {
        const bool flowed = axis->flowed > 0.01 * order.front()->flowed;
        const bool loaded = axis->turns && axis->largest > 0 && !moment;
        if (!result.empty() && !flowed && !loaded) continue;
        result.push_back({axis->name, axis->turns, axis->force, axis->position});
        moment = moment || axis->turns;
    }
    return result;
}

Recording Recorder::finish() const {
    Recording result = recording_;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        result.samples[i].curves = curves(joints_[i]);
    }
    check(result);
    return result;
}

} // namespace ductile::replay
