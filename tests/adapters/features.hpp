// SPDX-License-Identifier: MIT
//
// What a run of the contract showed of an engine's solver, feature by feature, for the table of
// features: one CSV per executable, written at its end to the path in the environment variable
// DUCTILE_FEATURES (no variable, no file), and joined by tests/features.py.
//
//   engine,precision,solver,feature,verdict,error
//
// A feature is shown by several runs; the table says the least of them. `error`: the largest one of
// what the runs compared, of the value or of 1 where that is larger [-]. Included after the rig.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace ductile::test {

/// From best to worst.
enum class Verdict {
    exact,    ///< the answer in discrete time to round-off
    right,    ///< within the tolerance that the test derives
    reported, ///< not solved, and the library said so: unreliable
    refused,  ///< not built, with a message by name
    wrong,    ///< off, and silent: the test fails too
};

[[nodiscard]] constexpr std::string_view to_string(Verdict verdict) {
    constexpr std::string_view names[] = {"exact", "right", "reported", "refused", "wrong"};
    return names[std::size_t(verdict)];
}

/// Collects and writes at the end of the program.
class Features {
  public:
    Features(std::string engine, bool single)
        : engine_(std::move(engine)), precision_(single ? "float" : "double") {}
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;
    ~Features() {
        const char* path = std::getenv("DUCTILE_FEATURES");
        if (path == nullptr) return;
        std::ofstream file(path);
        file << "engine,precision,solver,feature,verdict,error\n";
        for (const auto& [key, shown] : shown_) {
            file << engine_ << ',' << precision_ << ',' << key.first << ',' << key.second << ','
                 << to_string(shown.verdict) << ',' << shown.error << '\n';
        }
    }

    void note(const std::string& solver, const std::string& feature, Verdict verdict,
              double error) {
        const auto [at, first] = shown_.try_emplace({solver, feature}, Shown{verdict, error});
        if (first) return;
        at->second.verdict = std::max(at->second.verdict, verdict);
        at->second.error = std::max(at->second.error, error);
    }

  private:
    struct Shown {
        Verdict verdict;
        double error;
    };
    std::string engine_, precision_;
    std::map<std::pair<std::string, std::string>, Shown> shown_;
};

/// Of this executable.
inline Features& features() {
    static Features all(Rig::engine, Rig::single);
    return all;
}

/// True where a joint says of the step just done that it is wrong. Checks that what it says bears
/// that out: a row that is off by more than any joint here allows, or energy made from nothing.
template <class JointOfRig>
[[nodiscard]] bool says_wrong(const JointOfRig& joint) {
    constexpr double least_allowed = 1e-3; // OneAxisParameters::absolute_residual [m/s | rad/s]
    const auto report = joint.report();
    if (report.outcome != Outcome::unreliable) return false;
    CHECK(std::isfinite(report.residual));
    CHECK((report.residual > least_allowed || report.gained > 0));
    return true;
}

/// One run that shows a feature: what it compares is what the table says. A run in which nothing is
/// compared is right, not exact.
class Shown {
  public:
    Shown(std::string solver, std::string feature)
        : solver_(std::move(solver)), feature_(std::move(feature)) {}
    Shown(const Shown&) = delete;
    Shown& operator=(const Shown&) = delete;
    ~Shown() {
        const Verdict found = wrong_                           ? Verdict::wrong
                              : unsolved_                      ? Verdict::reported
                              : compared_ && error_ <= exactly ? Verdict::exact
                                                               : Verdict::right;
        features().note(solver_, feature_, found, error_);
    }

    /// Checks a value.
    void close(double value, double expected, double tolerance) {
        note(std::abs(value - expected) / std::max(1.0, std::abs(expected)), tolerance);
        CHECK(value == Approx(expected).epsilon(tolerance).margin(tolerance));
    }
    void close(double value, double expected) { close(value, expected, exactly); }
    /// Checks an error that is zero where all is exact.
    void small(double error, double tolerance) {
        note(std::abs(error), tolerance);
        CHECK(std::abs(error) <= tolerance);
    }
    /// Checks that a run is right, or that a joint of it `says_wrong`.
    void right_or_reported(bool right, bool reported) {
        unsolved_ = unsolved_ || reported;
        wrong_ = wrong_ || (!right && !reported);
        CHECK((right || reported));
    }

  private:
    static constexpr double exactly = Rig::single ? 2e-4 : 1e-9;

    void note(double error, double tolerance) {
        compared_ = true;
        error_ = std::max(error_, error);
        wrong_ = wrong_ || !(error <= tolerance * (1 + 1e-6));
    }

    std::string solver_, feature_;
    double error_ = 0;
    bool compared_ = false, unsolved_ = false, wrong_ = false;
};

} // namespace ductile::test
