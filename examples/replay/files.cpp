// SPDX-License-Identifier: MIT
#include "files.hpp"

#include <fstream>
#include <iterator>
#include <system_error>

#include "recording.hpp"

namespace ductile::replay {

std::string read_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error("cannot read " + file.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_file(const std::filesystem::path& file, std::string_view bytes) {
    const auto there = std::filesystem::status(file);
    if (exists(there) && !is_regular_file(there)) { // a device would be replaced
        throw Error("cannot write " + file.string() + ": is no regular file");
    }
    std::filesystem::path part = file;
    part += ".part";
    std::error_code ignored;
    {
        std::ofstream out(part, std::ios::binary);
        out.write(bytes.data(), std::streamsize(bytes.size()));
        out.close();
        if (!out) {
            std::filesystem::remove(part, ignored);
            throw Error("cannot write " + file.string());
        }
    }
    std::error_code failed;
    std::filesystem::rename(part, file, failed);
    if (failed) {
        std::filesystem::remove(part, ignored);
        throw Error("cannot write " + file.string() + ": " + failed.message());
    }
}

} // namespace ductile::replay
