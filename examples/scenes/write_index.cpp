// SPDX-License-Identifier: MIT
#include "write_index.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "files.hpp"

namespace ductile::scenes {

namespace {

namespace fs = std::filesystem;

constexpr const char* head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>ductile: scenes</title><style>
body { font: 16px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 60em; padding: 0 1em;
       color-scheme: light dark; }
table { border-collapse: collapse; margin: .5em 0 1em; }
td, th { padding: .15em .8em .15em 0; text-align: left; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
.wrong { color: #c00; font-weight: bold; }
section { clear: both; } section > a > img { float: right; width: 22em; margin: 0 0 1em 1em; }
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

/// Of a scene in an engine, or of what else is shown; its id and what is between its tags.
using Section = std::pair<std::string, std::string>;
constexpr std::string_view opening = "<section id=\"", closing = "</section>\n";

/// Of an index as it was written before.
std::vector<Section> sections_of(const std::string& page) {
    std::vector<Section> found;
    for (std::size_t at = page.find(opening); at != std::string::npos;
         at = page.find(opening, at)) {
        at += opening.size();
        const std::size_t name = page.find("\">", at), end = page.find(closing, at);
        if (name > end || end == std::string::npos) break;
        found.emplace_back(page.substr(at, name - at), page.substr(name + 2, end - name - 2));
    }
    return found;
}

void put(std::vector<Section>& sections, Section section) {
    const auto same = [&](const Section& each) { return each.first == section.first; };
    const auto known = std::find_if(sections.begin(), sections.end(), same);
    if (known == sections.end())
        sections.push_back(std::move(section));
    else
        *known = std::move(section);
}

/// What the Charpy test left where run.sh has it put it; nothing where it is not there.
std::string charpy(const fs::path& folder) {
    const fs::path left = "../../charpy/out";
    if (!fs::exists(folder / left / "table.txt")) return {};
    std::string text = "<h2>Charpy test</h2>\n<pre>" +
                       escaped(replay::read_file(folder / left / "table.txt")) + "</pre>\n";
    for (const char* picture : {"energy.png", "rotation.png", "speed.png"}) {
        const fs::path file = left / picture;
        if (!fs::exists(folder / file)) continue;
        text +=
            fmt::format("<img src=\"{}\" alt=\"\" style=\"width:32%\">\n", file.generic_string());
    }
    return text;
}

std::string text_of(const Shown& shown, const fs::path& folder) {
    const Run& run = shown.run;
    std::string text = fmt::format("<h2>{} <small>in {}</small></h2>\n", run.scene(), shown.engine);
    const std::string picture = run.scene() + ".jpg";
    std::error_code failed; // then it is shown without
    fs::copy_file(fs::path(DUCTILE_GALLERY) / picture, folder / picture,
                  fs::copy_options::overwrite_existing, failed);
    if (!failed && !run.replays().empty()) {
        text += fmt::format("<a href=\"{}\"><img src=\"{}\" alt=\"{}\"></a>\n",
                            run.replays().front(), picture, run.scene());
    }
    text += "<p>" + escaped(shown.about) + "</p>\n<p>";
    for (const std::string& file : run.replays()) {
        text += fmt::format("<a href=\"{}\">{}</a> ", file, file);
    }
    text += "</p>\n";
    for (const std::string& take : run.doubted()) {
        text += "<p class=wrong>" + escaped(take) + ": its World does not vouch for it</p>\n";
    }
    text += "<table><tr><th></th><th>came out</th><th>must come out</th></tr>\n";
    for (const Finding& f : run.findings()) {
        text +=
            fmt::format("<tr><td>{}</td><td class=\"n{}\">{:.6g} {}</td><td class=n>{}</td></tr>\n",
                        escaped(f.what), f.right() ? "" : " wrong", f.came_out, f.unit,
                        f.expected ? fmt::format("{:.6g}", *f.expected) : "");
    }
    return text + "</table>\n";
}

} // namespace

void write_index(const std::vector<Shown>& all, const fs::path& folder) {
    std::error_code none; // the file says whether it is there
    fs::create_directories(folder, none);
    const fs::path file = folder / "index.html";
    std::vector<Section> sections;
    if (fs::exists(file, none)) sections = sections_of(replay::read_file(file));
    if (std::string text = charpy(folder); !text.empty())
        put(sections, {"charpy", std::move(text)});
    for (const Shown& shown : all) {
        put(sections, {shown.run.scene() + '-' + shown.engine, text_of(shown, folder)});
    }
    std::string page = head;
    for (const auto& [name, text] : sections) {
        page += fmt::format("{}{}\">{}{}", opening, name, text, closing);
    }
    replay::write_file(file, page + "</body></html>\n");
    if (sections.empty()) fs::remove(file, none); // it can be written: no more was to be known
}

} // namespace ductile::scenes
