// SPDX-License-Identifier: MIT
//
// Runs one method on one build of one engine and prints the result and its history as JSON. The
// front, charpy, starts it: Bullet's float and double libraries share their symbols, so each engine
// build has a program of its own.
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "options.hpp"
#include "report.hpp"

int main(int argc, char** argv) try {
    charpy::Options options;
    CLI::App app("Charpy impact test, one method on one engine (started by charpy)");
    charpy::declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "%s\n", charpy::one_line(error).c_str());
        return 2;
    }
    charpy::finish(options);
    for (const auto& [method, name] : charpy::method_names) {
        if (options.method != name) continue;
        const charpy::Result result = charpy::run(options.scenario, method, options.solver);
        const nlohmann::ordered_json document{{"result", charpy::to_json(result)},
                                              {"history", charpy::history_to_json(result)}};
        std::puts(document.dump().c_str());
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
