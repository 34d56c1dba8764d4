// SPDX-License-Identifier: MIT
//
// Rows of cells as text for a terminal, as Markdown and as CSV.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace charpy {

struct TextTable {
    using Row = std::vector<std::string>;

    std::string title;
    Row header;
    std::vector<Row> rows; ///< each as long as the header

    [[nodiscard]] std::string text() const {
        std::vector<std::size_t> widths(header.size(), 0);
        const auto measure = [&widths](const Row& row) {
            for (std::size_t i = 0; i < row.size(); ++i) {
                widths[i] = std::max(widths[i], row[i].size());
            }
        };
        measure(header);
        for (const Row& row : rows) measure(row);
        std::string out = title + "\n";
        const auto line = [&](const Row& row) {
            for (std::size_t i = 0; i + 1 < row.size(); ++i) {
                out += fmt::format("{:<{}}  ", row[i], widths[i]);
            }
            out += row.back() + "\n";
        };
        line(header);
        for (const Row& row : rows) line(row);
        return out;
    }

    [[nodiscard]] std::string markdown() const {
        std::string out = "**" + title + "**\n\n";
        const auto line = [&out](const Row& row) {
            for (const std::string& cell : row) out += "| " + cell + " ";
            out += "|\n";
        };
        line(header);
        line(Row(header.size(), "---"));
        for (const Row& row : rows) line(row);
        return out;
    }

    /// Without the title; `with_header`: the first line names the columns.
    [[nodiscard]] std::string csv(bool with_header) const {
        std::string out;
        const auto line = [&out](const Row& row) {
            for (std::size_t i = 0; i < row.size(); ++i) {
                const bool quoted = row[i].find_first_of(",\"") != std::string::npos;
                out += (i > 0 ? "," : "") + (quoted ? "\"" + row[i] + "\"" : row[i]);
            }
            out += "\n";
        };
        if (with_header) line(header);
        for (const Row& row : rows) line(row);
        return out;
    }
};

} // namespace charpy
