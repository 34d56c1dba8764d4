// SPDX-License-Identifier: MIT
//
// The scenes and the three bars for a page (live.js, worker.js), by a C interface; compiled by
// build.sh, with Bullet alone. Texts are JSON.
#include <emscripten.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "packed.hpp"
#include "scene.hpp"

namespace ductile::scenes {

std::unique_ptr<Scene> bar_scene();

std::unique_ptr<Stage> ode_stage(const StageParameters&) {
    throw std::invalid_argument("ODE is not in this page");
}

namespace {

using Json = nlohmann::json;

/// A recording as far as it is there; `kept`: the take is over.
EM_JS(void, show, (const char* bytes, int count, bool kept),
      { Module.show(HEAPU8.slice(bytes, bytes + count), kept); });

std::vector<std::unique_ptr<Scene>> scenes() {
    std::vector<std::unique_ptr<Scene>> all = all_scenes();
    all.push_back(bar_scene());
    return all;
}

/// Since the last piece was shown.
class Pace {
  public:
    [[nodiscard]] bool due() {
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return false;
        next_ = now + std::chrono::milliseconds(400);
        return true;
    }

  private:
    std::chrono::steady_clock::time_point next_;
};

void set(Scene& scene, const std::string& name, double value) {
    for (const Option& option : scene.options()) {
        if (option.name != name) continue;
        if (!(value >= option.low && value <= option.high)) { // nan is not
            throw std::invalid_argument(name + " = " + std::to_string(value) + " " + option.unit +
                                        ": must be from " + std::to_string(option.low) + " to " +
                                        std::to_string(option.high));
        }
        *option.value = value;
        return;
    }
    throw std::invalid_argument(scene.name() + " has no option " + name);
}

Json play(const Json& wish) {
    const std::string name = wish.at("scene");
    for (const auto& scene : scenes()) {
        if (scene->name() != name) continue;
        RunOptions options;
        options.frame = wish.at("frame").get<double>();
        options.tolerance = wish.at("tolerance").get<double>();
        options.part = wish.at("part").get<std::string>();
        if (!(options.frame >= 1e-4 && options.frame <= 0.1)) {
            throw std::invalid_argument("frame = " + std::to_string(options.frame) +
                                        " s: must be from 0.0001 to 0.1");
        }
        if (!(options.tolerance >= 0 && options.tolerance <= 0.5)) {
            throw std::invalid_argument("tolerance = " + std::to_string(options.tolerance) +
                                        ": must be from 0 to 0.5");
        }
        for (const auto& [key, value] : wish.at("options").items()) set(*scene, key, value);
        Pace pace;
        options.grows = [&pace](const replay::Recorder& recorder) {
            if (!pace.due()) return;
            const std::string bytes = replay::laid_down(recorder.finish());
            show(bytes.data(), int(bytes.size()), false);
        };
        options.keep = [](const std::string& take, const replay::Recording& recording) {
            const std::string bytes = replay::laid_down(recording);
            show(bytes.data(), int(bytes.size()), true);
            return take;
        };
        Run run(name, options);
        scene->play(run);
        Json findings = Json::array();
        for (const Finding& finding : run.findings()) {
            findings.push_back({{"what", finding.what},
                                {"unit", finding.unit},
                                {"came_out", finding.came_out},
                                {"within", finding.within},
                                {"right", finding.right()},
                                {"expected", finding.expected ? Json(*finding.expected) : Json()}});
        }
        double spent = 0, dearest = 0;
        for (const auto& [each, solves] : run.costs()) {
            spent += each;
            dearest = std::max(dearest, each);
        }
        return {{"findings", std::move(findings)},
                {"doubted", run.doubted()},
                {"frames", run.costs().size()},
                {"spent", spent},
                {"dearest", dearest}};
    }
    throw std::invalid_argument("there is no scene " + name);
}

std::string answer;

} // namespace

} // namespace ductile::scenes

extern "C" {

/// What there is to choose from.
EMSCRIPTEN_KEEPALIVE const char* live_scenes() {
    using namespace ductile::scenes;
    Json all = Json::array();
    for (const auto& scene : scenes()) {
        Json parts = Json::array(), options = Json::array();
        for (const Part& part : scene->parts()) parts.push_back(part.name);
        for (const Option& option : scene->options()) {
            options.push_back({{"name", option.name},
                               {"about", option.about},
                               {"unit", option.unit},
                               {"value", *option.value},
                               {"low", option.low},
                               {"high", option.high},
                               {"part", option.part}});
        }
        all.push_back({{"name", scene->name()},
                       {"about", scene->about()},
                       {"parts", std::move(parts)},
                       {"options", std::move(options)}});
    }
    answer = all.dump();
    return answer.c_str();
}

/// {"fault": why not} where it did not go.
EMSCRIPTEN_KEEPALIVE const char* live_play(const char* wish) {
    using namespace ductile::scenes;
    try {
        answer = play(Json::parse(wish)).dump(-1, ' ', false, Json::error_handler_t::replace);
    } catch (const std::exception& error) {
        answer = Json{{"fault", error.what()}}.dump();
    }
    return answer.c_str();
}
}
