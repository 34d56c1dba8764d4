// SPDX-License-Identifier: MIT
//
// Starts another program and takes what it prints.
#pragma once

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

extern char** environ;

namespace charpy {

/// Where this program lies.
[[nodiscard]] inline std::filesystem::path own_folder() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

/// Starts a program and returns what it prints; its last line of errors where it fails.
inline std::string output_of(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
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

} // namespace charpy
