// SPDX-License-Identifier: MIT
#include "write_index.hpp"

#include <fmt/core.h>

#include <system_error>

#include "files.hpp"

namespace ductile::scenes {

namespace {

constexpr const char* head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>ductile: scenes</title><style>
body { font: 16px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 60em; padding: 0 1em;
       color-scheme: light dark; }
table { border-collapse: collapse; margin: .5em 0 1em; }
td, th { padding: .15em .8em .15em 0; text-align: left; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
.wrong { color: #c00; font-weight: bold; }
</style></head><body><h1>Scenes</h1>
<p>A replay opens by a click, from disk: space plays, n goes to the next event.</p>
)";

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '<') {
            result += "&lt;";
        } else if (c == '&') {
            result += "&amp;";
        } else {
            result += c;
        }
    }
    return result;
}

} // namespace

void write_index(const std::vector<Shown>& all, const std::filesystem::path& folder) {
    std::string page = head;
    for (const Shown& shown : all) {
        page += fmt::format("<h2 id=\"{0}-{1}\">{0} <small>in {1}</small></h2>\n<p>{2}</p>\n<p>",
                            shown.run.scene(), shown.engine, escaped(shown.about));
        for (const std::string& file : shown.run.replays()) {
            page += fmt::format("<a href=\"{}\">{}</a> ", file, file);
        }
        page += "</p>\n<table><tr><th></th><th>came out</th><th>must come out</th></tr>\n";
        for (const Finding& f : shown.run.findings()) {
            page += fmt::format(
                "<tr><td>{}</td><td class=\"n{}\">{:.6g} {}</td><td class=n>{}</td></tr>\n",
                escaped(f.what), f.right() ? "" : " wrong", f.came_out, f.unit,
                f.expected ? fmt::format("{:.6g}", *f.expected) : "");
        }
        page += "</table>\n";
    }
    page += "</body></html>\n";
    std::error_code none; // the file says whether it is there
    std::filesystem::create_directories(folder, none);
    replay::write_file(folder / "index.html", page);
}

} // namespace ductile::scenes
