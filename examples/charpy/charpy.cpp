// SPDX-License-Identifier: MIT
//
// The Charpy impact test on every engine: a hammer on a pendulum bends a notched steel bar between two
// anvils, and what it loses is plastic moment × hinge angle. Scenario and dimensions: Nikula (2017),
// section 2.2; expected values: reference.hpp.
//
//   charpy                                           every method on every engine, table and plots
//   charpy --engine ode --method plastic-hinge       one run
//   charpy --help                                    all options with units
//
// Exit status: 0 done, 2 bad input (one line says what), 1 a run failed.
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "options.hpp"
#include "report.hpp"

extern char** environ;

namespace {

namespace fs = std::filesystem;
using charpy::Method;
using charpy::Options;
using nlohmann::ordered_json;

/// One row of the table to be.
struct Run {
    std::string engine, precision, solver, method;
};

/// Error in what the user asked for; its text is the one line shown.
struct BadInput : std::runtime_error {
    using std::runtime_error::runtime_error;
};

std::vector<Run> plan(const Options& o) {
    const std::vector<std::string> engines =
        o.engine == "all" ? std::vector<std::string>{"bullet", "ode"} : std::vector{o.engine};
    std::vector<Run> runs;
    for (const std::string& engine : engines) {
        const bool bullet = engine == "bullet";
        if (!o.solver.empty() && bullet != (o.solver == "mlcp" || o.solver == "si")) {
            if (o.engine == "all") continue; // that solver belongs to the other engine
            throw BadInput(fmt::format("--solver = {}: must be {} with --engine {}", o.solver,
                                       bullet ? "mlcp or si" : "direct or quick", engine));
        }
        const std::string solver = !o.solver.empty() ? o.solver : bullet ? "mlcp" : "direct";
        for (const auto& [method, view] : charpy::method_names) {
            const std::string name(view);
            if (o.method != "all" && o.method != name) continue;
            if (!bullet && !charpy::ode_has(method)) {
                if (o.method == name && o.engine == engine) charpy::require_in_ode(method);
                continue;
            }
            runs.push_back({engine, bullet ? o.precision : "double", solver, name});
        }
    }
    // the whole picture also shows the other scalar and the iterative solvers of our own joint
    if (o.engine == "all" && o.method == "all" && o.solver.empty()) {
        runs.push_back({"bullet", "double", "si", "plastic-hinge"});
        runs.push_back({"bullet", "float", "mlcp", "plastic-hinge"});
        runs.push_back({"bullet", "float", "si", "plastic-hinge"});
        runs.push_back({"ode", "double", "quick", "plastic-hinge"});
    }
    return runs;
}

fs::path own_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// Starts a program and returns what it prints; its last line of errors where it fails.
std::string output_of(const fs::path& program, const std::vector<std::string>& arguments) {
    std::array<int, 2> out{}, err{};
    if (pipe(out.data()) != 0 || pipe(err.data()) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    for (const int end : {out[0], err[0], out[1], err[1]}) {
        posix_spawn_file_actions_addclose(&actions, end);
    }
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    pid_t child = 0;
    const int failed =
        posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    close(err[1]);
    const auto read_all = [](int from) {
        std::string text;
        std::array<char, 65536> buffer{};
        for (ssize_t n = 0; (n = read(from, buffer.data(), buffer.size())) > 0;) {
            text.append(buffer.data(), std::size_t(n));
        }
        close(from);
        return text;
    };
    if (failed != 0) {
        close(out[0]);
        close(err[0]);
        throw std::runtime_error(program.string() + " could not be started");
    }
    const std::string text = read_all(out[0]);
    std::string errors = read_all(err[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        while (!errors.empty() && errors.back() == '\n') errors.pop_back();
        throw std::runtime_error(errors.empty() ? program.string() + " failed" : errors);
    }
    return text;
}

/// A file that appears complete or not at all. Opened when the program starts, so that a file that
/// cannot be written is known before the work is done.
class OutputFile {
  public:
    OutputFile(const std::string& option, const std::string& path) : path_(path) {
        if (path_.empty()) return;
        temporary_ = path_ + ".part";
        if (fs::is_directory(path_)) fail(option, "is a folder");
        stream_.open(temporary_);
        if (!stream_) fail(option, "cannot be written");
    }
    ~OutputFile() {
        if (path_.empty() || done_) return;
        std::error_code ignored;
        stream_.close();
        fs::remove(temporary_, ignored);
    }
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    explicit operator bool() const { return !path_.empty(); }
    std::ofstream& stream() { return stream_; }
    void finish() {
        if (path_.empty()) return;
        stream_.close();
        if (!stream_) throw BadInput(path_ + ": cannot be written");
        fs::rename(temporary_, path_);
        done_ = true;
    }

  private:
    [[noreturn]] void fail(const std::string& option, const char* why) {
        const std::string path = path_;
        path_.clear();
        throw BadInput(fmt::format("{} = {}: {}", option, path, why));
    }

    std::string path_, temporary_;
    std::ofstream stream_;
    bool done_ = false;
};

void write_history(std::ostream& csv, const ordered_json& result, const nlohmann::json& history) {
    const std::string key = fmt::format(
        "{},{},{},{},{},{},{}", result.at("engine").get<std::string>(),
        result.at("solver").get<std::string>(), result.at("precision").get<std::string>(),
        result.at("method").get<std::string>(), result.at("dt_s").get<double>(),
        int(result.at("adaptive").get<bool>()), result.at("friction").get<double>());
    for (const auto& row : history) {
        csv << key;
        for (const auto& value : row) csv << ',' << value.dump();
        csv << '\n';
    }
}

void print_expected(const charpy::Scenario& s, const charpy::Reference& expected) {
    fmt::print(
        "Charpy impact test: steel {:.0f} MPa, section {:.0f} x {:.0f} mm with a {:.0f} mm notch, "
        "plastic moment {:.1f} N m\n"
        "hammer {:.2f} kg m^2 about its pivot, {:.1f} rad drop, strikes at {:.3f} m/s; friction {:g}\n"
        "expected by mechanics (frictionless): rotation {:.4f} rad, plastic work {:.2f} J, hammer loss "
        "{:.2f} J, halves {:.3f} J\n\n",
        s.yield_stress / 1e6, 1e3 * s.width, 1e3 * s.height, 1e3 * s.notch, s.notched_moment(),
        s.hammer_inertia(), s.start_angle, expected.strike_speed, s.friction, expected.rotation,
        expected.plastic_work, expected.hammer_loss, expected.specimen_kinetic);
}

void draw(const std::string& csv, const std::string& folder) {
    fs::create_directories(folder);
    const std::string text = output_of(CHARPY_PLOT_SCRIPT, {csv, folder});
    fmt::print("{}", text);
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app("Charpy impact test on Bullet and ODE: what a hammer loses by bending a steel bar.\n"
                 "Without options: every method on every engine, a table, and plots in ./charpy-plots.");
    charpy::declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        fmt::print("{}", app.help());
        return 0;
    } catch (const CLI::ParseError& error) {
        throw BadInput(charpy::one_line(error));
    }
    charpy::finish(app, options);
    const std::vector<Run> runs = plan(options);
    if (argc == 1) options.plots = "charpy-plots";

    OutputFile json("--json", options.json);
    const bool draws = !options.plots.empty();
    const std::string csv_path =
        options.csv.empty() && draws ? (fs::path(options.plots) / "history.csv").string() : options.csv;
    if (draws) {
        std::error_code failed;
        fs::create_directories(options.plots, failed);
        if (failed) throw BadInput(fmt::format("--plots = {}: cannot be made", options.plots));
    }
    OutputFile csv("--csv", csv_path);
    if (csv) csv.stream() << charpy::history_header << '\n';

    const charpy::Reference expected = charpy::reference(options.scenario);
    print_expected(options.scenario, expected);
    auto results = ordered_json::array();
    std::string table;
    int failures = 0;
    // the user's own options, then what this run fixes; the last value of an option counts
    const std::vector<std::string> given(argv + 1, argv + argc);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run& r = runs[i];
        fmt::print(stderr, "[{:>2}/{}] {} {} {} {} ... ", i + 1, runs.size(), r.engine, r.precision,
                   r.solver, r.method);
        const auto start = std::chrono::steady_clock::now();
        const fs::path program = own_folder() / fmt::format("charpy-{}-{}", r.engine, r.precision);
        std::vector<std::string> arguments = given;
        for (const std::string& fixed : {"--engine=" + r.engine, "--precision=" + r.precision,
                                         "--solver=" + r.solver, "--method=" + r.method}) {
            arguments.push_back(fixed);
        }
        try {
            const auto document = ordered_json::parse(output_of(program, arguments));
            results.push_back(document.at("result"));
            table += charpy::table_row(document.at("result"), expected);
            if (csv) write_history(csv.stream(), document.at("result"), document.at("history"));
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
            fmt::print(stderr, "{:.2f} s\n", taken.count());
        } catch (const std::exception& error) {
            ++failures;
            fmt::print(stderr, "failed: {}\n", error.what());
        }
    }
    fmt::print("\n{}{}", charpy::table_header(), table);
    fmt::print("\nplastic work of the engines' own joints: all that the joint took from the bodies\n");
    if (json) json.stream() << results.dump(2) << '\n';
    json.finish();
    csv.finish();
    if (draws) draw(csv_path, options.plots);
    return failures == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) try {
    return run(argc, argv);
} catch (const std::exception& error) {
    fmt::print(stderr, "charpy: {}\n", error.what());
    return 2;
}
