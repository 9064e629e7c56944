#include "tests/reports/english_left.h"

#include <algorithm>
#include <array>
#include <regex>
#include <set>

#include "tests/reports/page_text.h"

namespace rondure::reports::testing {
namespace {

/// Words of a Chinese page, from their first small letter on: files, the program ("Rondure"), axes,
/// the key "Home", letters of formulas, units ("µrad").
const std::set<std::string, std::less<>> kAllowed = {
    "rondure", "ondure", "verify", "report", "json", "journal", "touches", "series", "csv", "alpha",
    "beta",    "phi",    "chi",    "kappa",  "deg",  "urad",    "rad",     "mdeg",   "rms", "ome"};

bool is_small(char c) { return c >= 'a' && c <= 'z'; }

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

std::string unescaped(std::string_view text) {
  std::string out(text);
  constexpr std::array<std::array<std::string_view, 2>, 5> kEntities = {
      {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}}};
  for (const auto& [entity, letter] : kEntities) replace_all(out, entity, letter);
  return out;
}

bool has_english(std::string_view html, const std::vector<std::string>& names) {
  // Keys of a plan stay as a plan spells them: `words`, and words_with_lines.
  static const std::regex kKeys("`[a-z_0-9/]+`|[a-z0-9]+(_[a-z0-9]+)+", std::regex::optimize);
  std::string text = unescaped(html);
  for (const std::string& name : names) {
    if (!name.empty()) replace_all(text, name, " ");
  }
  text = std::regex_replace(text, kKeys, " ");
  for (auto at = text.begin(); at != text.end();) {
    const auto first = std::find_if(at, text.end(), is_small);
    at = std::find_if_not(first, text.end(), is_small);
    if (at - first >= 3 && kAllowed.count(std::string(first, at)) == 0) return true;
  }
  return false;
}

std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string mark = " " + std::string(name) + "=\"";
  const std::size_t at = tag.find(mark);
  if (at == std::string_view::npos) return {};
  tag.remove_prefix(at + mark.size());
  return tag.substr(0, tag.find('"'));
}

/// Whether what stands in this element is not looked at.
bool is_apart(std::string_view name, std::string_view tag) {
  const std::string_view kind = attribute(tag, "class");
  return name == "style" || name == "script" || attribute(tag, "lang") == "en" || kind == "code" ||
         kind == "mono";
}

}  // namespace

std::string english_left(std::string_view page, std::vector<std::string> names) {
  std::sort(names.begin(), names.end(),
            [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<bool> apart = {false};
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t open = std::min(page.find('<', at), page.size());
    const std::string_view text = page.substr(at, open - at);
    if (!apart.back() && has_english(text, names)) return std::string(text);
    const std::size_t close = std::min(page.find('>', open), page.size() - 1);
    const std::string_view tag = page.substr(open, close - open);
    at = close + 1;
    if (tag.size() < 2) continue;
    if (tag[1] == '/') {
      if (apart.size() > 1) apart.pop_back();
      continue;
    }
    const std::string_view name = tag.substr(1, tag.find_first_of(" \n/>", 1) - 1);
    const bool hidden = apart.back() || is_apart(name, tag);
    for (const char* label : {"aria-label", "data-l", "title"}) {
      if (!hidden && has_english(attribute(tag, label), names)) return std::string(tag);
    }
    if (tag.back() != '/' && !is_void_element(name)) apart.push_back(hidden);
  }
  return {};
}

}  // namespace rondure::reports::testing
