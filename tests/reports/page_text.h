#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports::testing {

/// Whether the page holds "nan" as a word, not as a part of one ("Provenance").
inline bool shows_nan(std::string_view page) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  for (std::size_t at = page.find("nan"); at != std::string_view::npos;
       at = page.find("nan", at + 1)) {
    if (at > 0 && at + 3 < page.size() && !letter(page[at - 1]) && !letter(page[at + 3]))
      return true;
  }
  return false;
}

inline bool is_void_element(std::string_view name) { return name == "br" || name == "!DOCTYPE"; }

/// The first tag that closes no element, or is not closed; empty for a balanced page. Quoted
/// attribute values may hold anything but quotes; the contents of a script are not markup.
inline std::string first_unbalanced_tag(std::string_view page) {
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string_view::npos; at = page.find('<', at)) {
    const bool closes = page[at + 1] == '/';
    const std::size_t from = at + (closes ? 2 : 1);
    const std::size_t end_of_name = page.find_first_of(" />\n", from);
    const std::string name(page.substr(from, end_of_name - from));
    bool quoted = false;
    for (at = end_of_name; at < page.size() && (quoted || page[at] != '>'); ++at) {
      if (page[at] == '"') quoted = !quoted;
      if (page[at] == '<') return "< inside " + name;
    }
    if (at >= page.size()) return "unended " + name;
    if (closes) {
      if (open.empty() || open.back() != name) return "/" + name;
      open.pop_back();
    } else if (page[at - 1] != '/' && !is_void_element(name)) {
      open.push_back(name);
      if (name == "script") at = std::min(page.find("</script>", at), page.size());
    }
  }
  return open.empty() ? std::string() : open.back();
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Joins the lines of a terminal: every run of blanks and line ends becomes one blank.
inline std::string one_line(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n';
    if (!blank || (!out.empty() && out.back() != ' ')) out += blank ? ' ' : c;
  }
  return out;
}

}  // namespace rondure::reports::testing
