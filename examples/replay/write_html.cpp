// SPDX-License-Identifier: MIT
#include "write_html.hpp"

#include <cstddef>
#include <string>
#include <string_view>

#include "files.hpp"
#include "packed.hpp"

namespace ductile::replay {

namespace {

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) {
            return i + k < bytes.size() ? unsigned(static_cast<unsigned char>(bytes[i + k])) : 0u;
        };
        const unsigned word = at(0) << 16 | at(1) << 8 | at(2);
        for (std::size_t k = 0; k < 4; ++k) {
            const bool padding = i + k > bytes.size();
            result.push_back(padding ? '=' : digits[word >> (18 - 6 * k) & 63]);
        }
    }
    return result;
}

} // namespace

void write_html(const Recording& recording, const std::filesystem::path& file,
                const std::filesystem::path& page) {
    constexpr std::string_view place = "<!--recording-->";
    const std::filesystem::path from =
        page.empty() ? std::filesystem::path(DUCTILE_REPLAY_PAGE) : page;
    const std::string packed = base64(pack(recording));
    std::string text = read_file(from);
    const std::size_t at = text.find(place);
    if (at == std::string::npos) throw Error(from.string() + " is not the replay page");
    text.replace(at, place.size(),
                 "<script id=\"recording\" type=\"text/plain\">" + packed + "</script>");
    write_file(file, text);
}

} // namespace ductile::replay
