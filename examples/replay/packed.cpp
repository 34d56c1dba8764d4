// SPDX-License-Identifier: MIT
#include "packed.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

namespace ductile::replay {

namespace {

using Json = nlohmann::json;
using Quantised = std::vector<std::uint16_t>;

constexpr double levels = 65534;
constexpr std::uint16_t no_number = 65535;
constexpr double round_off = 1e-9; ///< of a certificate: half of it is kept as 0 [m/s | rad/s]

/// To at most `off` [same unit], in as few digits as that needs.
double brief(double value, double off) {
    for (int digits = 3; digits < 17; ++digits) {
        char text[32];
        std::snprintf(text, sizeof text, "%.*g", digits, value);
        const double rounded = std::strtod(text, nullptr);
        if (std::abs(rounded - value) <= off) return rounded;
    }
    return value;
}

class Columns {
  public:
    /// Over the range of its own, in so many `steps` of `least` or more.
    template <class Values, class Value>
    void add(const Values& values, Value value, double steps = levels, double least = 0) {
        double low = 0, high = 0;
        bool any = false;
        for (const auto& sample : values) {
            const double v = double(value(sample));
            if (!std::isfinite(v)) continue;
            low = any ? std::min(low, v) : v;
            high = any ? std::max(high, v) : v;
            any = true;
        }
        const double step = std::max((high - low) / steps, least);
        add_fixed(values, value, brief(low, step / 256), brief(step, step / (256 * levels)));
    }
    template <class Values, class Value>
    void add_fixed(const Values& values, Value value, double low, double step) {
        Quantised quantised;
        quantised.reserve(values.size());
        for (const auto& sample : values) {
            const double v = double(value(sample));
            const double q = step > 0 ? std::clamp(std::round((v - low) / step), 0.0, levels) : 0;
            quantised.push_back(std::isfinite(v) ? std::uint16_t(q) : no_number);
        }
        store(quantised, low, step);
    }
    void add(const std::vector<double>& values, double steps = levels, double least = 0) {
        add(
            values, [](double v) { return v; }, steps, least);
    }

    [[nodiscard]] Json text() const {
        return {{"low", lows_}, {"step", steps_}, {"order", orders_}};
    }
    [[nodiscard]] std::string bytes() const {
        std::string result;
        result.reserve(2 * samples_.size());
        for (const std::uint16_t sample : samples_) result.push_back(char(sample & 0xff));
        for (const std::uint16_t sample : samples_) result.push_back(char(sample >> 8));
        return result;
    }

  private:
    void store(const Quantised& quantised, double low, double step) {
        if (std::adjacent_find(quantised.begin(), quantised.end(), std::not_equal_to{}) ==
            quantised.end()) { // its value alone
            const std::uint16_t value = quantised.front();
            const bool number = value != no_number;
            lows_.push_back(number ? Json(brief(low + step * value, step / 256)) : Json());
            steps_.push_back(0);
            orders_.push_back(0);
            return;
        }
        const Quantised once = differences(quantised), twice = differences(once);
        const bool second = weight(twice) < weight(once);
        const Quantised& chosen = second ? twice : once;
        samples_.insert(samples_.end(), chosen.begin(), chosen.end());
        for (auto at = samples_.end() - std::ptrdiff_t(chosen.size()); at != samples_.end(); ++at) {
            const auto d = std::int16_t(*at);
            *at = std::uint16_t((unsigned(std::uint16_t(d)) << 1) ^ unsigned(d >> 15));
        }
        lows_.push_back(low);
        steps_.push_back(step);
        orders_.push_back(second ? 2 : 1);
    }
    static Quantised differences(const Quantised& values) {
        Quantised result(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            result[i] = std::uint16_t(values[i] - (i > 0 ? values[i - 1] : 0));
        }
        return result;
    }
    static long weight(const Quantised& values) {
        long sum = 0;
        for (const std::uint16_t value : values) sum += std::abs(long(std::int16_t(value)));
        return sum;
    }

    std::vector<Json> lows_;
    std::vector<double> steps_;
    std::vector<int> orders_;
    std::vector<std::uint16_t> samples_;
};

Json text_of(const Pose& pose) {
    Json result = Json::array();
    for (const double value : pose.position) result.push_back(value);
    for (const double value : pose.turn) result.push_back(value);
    return result;
}

Json text_of(const Body& body, const std::vector<Pose>& poses) {
    constexpr std::array kinds{"box", "sphere", "cylinder", "plane"};
    Json result{{"name", body.name}, {"moves", body.moves}, {"shapes", Json::array()}};
    for (const Shape& shape : body.shapes) {
        result["shapes"].push_back({{"kind", kinds[std::size_t(shape.kind)]},
                                    {"size", shape.size},
                                    {"pose", text_of(shape.in_body)}});
    }
    if (!body.moves) result["pose"] = text_of(poses.front());
    return result;
}

Json text_of(const Joint& joint, const JointSamples& samples) {
    Json facts = Json::array();
    for (const Fact& fact : joint.facts) facts.push_back({fact.first, fact.second});
    Json axes = Json::array();
    for (const Curve& curve : samples.curves)
        axes.push_back({{"axis", curve.axis}, {"turns", curve.turns}});
    return {{"name", joint.name},
            {"a", joint.a},
            {"b", joint.b},
            {"in_a", joint.in_a},
            {"axes", std::move(axes)},
            {"facts", std::move(facts)}};
}

Json text_of(const Event& event) {
    return {{"time", event.time},
            {"kind", event.kind},
            {"joint", event.joint},
            {"name", event.name},
            {"energy", event.energy}};
}

void add_columns(Columns& columns, const Recording& recording) {
    for (std::size_t i = 0; i < recording.bodies.size(); ++i) {
        if (!recording.bodies[i].moves) continue;
        const std::vector<Pose>& poses = recording.poses[i];
        for (std::size_t k = 0; k < 3; ++k) {
            columns.add(poses, [k](const Pose& pose) { return pose.position[k]; });
        }
        for (std::size_t k = 0; k < 4; ++k) {
            columns.add_fixed(
                poses, [k](const Pose& pose) { return std::clamp(pose.turn[k], -1.0, 1.0); }, -1,
                2 / levels);
        }
    }
    for (const JointSamples& samples : recording.samples) {
        columns.add(samples.utilisation);
        columns.add(samples.plastic_travel);
        columns.add(samples.absorbed);
        columns.add(samples.residual, 254.0, round_off);
        columns.add_fixed(
            samples.state, [](std::uint8_t state) { return state; }, 0, 1);
        columns.add_fixed(
            samples.life, [](double v) { return v; }, 0, 1 / levels);
        for (const Curve& curve : samples.curves) {
            columns.add(curve.force);
            columns.add(curve.position);
        }
    }
    for (const auto& energy : recording.energies) columns.add(energy.second);
    columns.add_fixed(
        recording.hashes, [](std::uint32_t hash) { return hash & 0x7fff; }, 0, 1);
    columns.add_fixed(
        recording.hashes, [](std::uint32_t hash) { return (hash >> 16) & 0x7fff; }, 0, 1);
}

} // namespace

std::string laid_down(const Recording& recording) {
    check(recording);
    Columns columns;
    add_columns(columns, recording);
    Json text{{"name", recording.name},    {"about", recording.about}, {"engine", recording.engine},
              {"times", recording.times},  {"bodies", Json::array()},  {"joints", Json::array()},
              {"energies", Json::array()}, {"events", Json::array()},  {"columns", columns.text()}};
    for (std::size_t i = 0; i < recording.bodies.size(); ++i) {
        text["bodies"].push_back(text_of(recording.bodies[i], recording.poses[i]));
    }
    for (std::size_t i = 0; i < recording.joints.size(); ++i) {
        text["joints"].push_back(text_of(recording.joints[i], recording.samples[i]));
    }
    for (const auto& energy : recording.energies) text["energies"].push_back(energy.first);
    for (const Event& event : recording.events) text["events"].push_back(text_of(event));
    const std::string words = text.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string bytes = "ductrec4";
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(char(words.size() >> shift & 0xff));
    return bytes + words + columns.bytes();
}

} // namespace ductile::replay
