// SPDX-License-Identifier: MIT
//
// Output that is either complete or not there.
#pragma once

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace charpy {

/// Error in what the user asked for; its text is the one line shown.
struct BadInput : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file that appears complete or not at all. Opened when the program starts, so that a file that
/// cannot be written is known before the work is done.
class OutputFile {
  public:
    OutputFile(const std::string& option, const std::string& path) : path_(path) {
        if (path_.empty()) return;
        temporary_ = path_ + ".part";
        const auto there = std::filesystem::status(path_);
        // renamed onto a device, the file would take its place
        if (exists(there) && !is_regular_file(there)) fail(option, "is no regular file");
        stream_.open(temporary_);
        if (!stream_) fail(option, "cannot be written");
    }
    ~OutputFile() {
        if (path_.empty() || done_) return;
        std::error_code ignored;
        stream_.close();
        std::filesystem::remove(temporary_, ignored);
    }
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    explicit operator bool() const { return !path_.empty(); }
    std::ofstream& stream() { return stream_; }
    void finish() {
        if (path_.empty()) return;
        stream_.close();
        if (!stream_) throw BadInput(path_ + ": cannot be written");
        std::filesystem::rename(temporary_, path_);
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

} // namespace charpy
