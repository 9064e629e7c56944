#include "reports/pdf_source.h"

#include <array>
#include <cstdlib>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace rondure::reports::pdf {
namespace {

/// What stands between two marks, without them; empty when they are not there.
std::string_view between(std::string_view text, std::string_view from, std::string_view to) {
  const std::size_t start = text.find(from);
  if (start == std::string_view::npos) return {};
  text.remove_prefix(start + from.size());
  return text.substr(0, text.find(to));
}

/// Without the elements of one name, which need not be XML inside.
std::string without(std::string_view html, std::string_view name) {
  const std::string open = fmt::format("<{}", name);
  const std::string close = fmt::format("</{}>", name);
  std::string out;
  for (;;) {
    const std::size_t start = html.find(open);
    const std::size_t end = html.find(close, start);
    if (end == std::string_view::npos) break;
    out += html.substr(0, start);
    html.remove_prefix(end + close.size());
  }
  return out.append(html);
}

/// Void elements of HTML closed as XML wants them.
std::string closed(const std::string& html) {
  static constexpr std::array<std::string_view, 5> kVoid = {"br", "hr", "img", "input", "wbr"};
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::string_view name =
        std::string_view(html).substr(at + 1, html.find_first_of(" />\n", at + 1) - at - 1);
    if (std::find(kVoid.begin(), kVoid.end(), name) == kVoid.end()) continue;
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos || html[end - 1] == '/') continue;
    out.append(html, done, end - done).append("/");
    done = end;
  }
  return out.append(html, done, std::string::npos);
}

/// Rules for all media: blocks behind an @ are left out whole, however deep.
std::string plain_rules(std::string_view css) {
  std::string out;
  std::size_t at = 0;
  while (at < css.size()) {
    if (css[at] != '@') {
      out += css[at++];
      continue;
    }
    at = css.find_first_of("{;", at);
    int depth = 0;
    for (; at < css.size(); ++at) {
      depth += css[at] == '{' ? 1 : css[at] == '}' ? -1 : 0;
      if (depth == 0) break;
    }
    at = at < css.size() ? at + 1 : css.size();
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t from = text.find_first_not_of(kSpace);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kSpace) - from + 1);
}

/// The variables of the first :root, which are those of paper and of a light screen.
std::map<std::string, std::string> variables_of(const std::string& rules) {
  std::map<std::string, std::string> out;
  std::string_view rest = between(rules, ":root{", "}");
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    out[std::string(trimmed(line.substr(0, colon)))] = trimmed(line.substr(colon + 1));
  }
  return out;
}

/// var(--name) and var(--name, other) as what they stand for.
std::string without_variables(std::string_view css, const std::map<std::string, std::string>& all) {
  constexpr std::string_view kVar = "var(";
  std::string out;
  for (;;) {
    const std::size_t at = css.find(kVar);
    const std::size_t end = css.find(')', at);
    if (end == std::string_view::npos) break;
    const std::string_view inside = css.substr(at + kVar.size(), end - at - kVar.size());
    const std::size_t comma = inside.find(',');
    const auto found = all.find(std::string(trimmed(inside.substr(0, comma))));
    out += css.substr(0, at);
    if (found != all.end()) {
      out += found->second;
    } else if (comma != std::string_view::npos) {
      out += trimmed(inside.substr(comma + 1));
    }
    css.remove_prefix(end + 1);
  }
  return out.append(css);
}

}  // namespace

Colour Source::colour(const std::string& variable) const {
  const auto found = colours.find(variable);
  if (found == colours.end() || found->second.empty() || found->second.front() != '#') return {};
  const std::string digits = found->second.substr(1);
  const std::size_t each = digits.size() == 3 ? 1 : 2;
  const double most = each == 1 ? 15.0 : 255.0;
  const auto part = [&](std::size_t i) {
    if ((i + 1) * each > digits.size()) return 0.0;
    const std::string hex = digits.substr(i * each, each);
    return static_cast<double>(std::strtol(hex.c_str(), nullptr, 16)) / most;
  };
  return {part(0), part(1), part(2)};
}

core::Result<Source> read_page(std::string_view html) {
  Source page;
  const std::string rules = plain_rules(between(html, "<style>", "</style>"));
  page.colours = variables_of(rules);
  page.drawing_style = without_variables(rules, page.colours);
  page.language = between(html, "<html lang=\"", "\"");
  if (page.language.empty()) page.language = "en";
  pugi::xml_document title;
  title.load_string(fmt::format("<t>{}</t>", between(html, "<title>", "</title>")).c_str());
  page.title = title.child("t").text().get();

  const std::size_t start = html.find("<body");
  const std::size_t end = html.rfind("</body>");
  if (start == std::string_view::npos || end == std::string_view::npos) {
    return core::fail(core::Code::kInternal, "report.html has no body", "report.html");
  }
  const std::string body =
      closed(without(without(html.substr(start, end + 7 - start), "script"), "style"));
  const auto read =
      page.tree.load_buffer(body.data(), body.size(), pugi::parse_default | pugi::parse_ws_pcdata);
  if (!read) {
    const auto place = static_cast<std::size_t>(read.offset);
    const std::size_t from = place < 40 ? 0 : place - 40;
    return core::fail(core::Code::kInternal,
                      fmt::format("report.html is not well-formed: {} behind \"{}\"",
                                  read.description(), body.substr(from, place - from)),
                      "report.html");
  }
  return page;
}

bool has_class(const pugi::xml_node& node, std::string_view name) {
  std::string_view all = node.attribute("class").value();
  while (!all.empty()) {
    const std::string_view one = all.substr(0, all.find(' '));
    if (one == name) return true;
    all.remove_prefix(std::min(all.size(), one.size() + 1));
  }
  return false;
}

bool on_paper(const pugi::xml_node& node) {
  if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) return true;
  if (node.type() != pugi::node_element) return false;
  const std::string_view name = node.name();
  if (name == "script" || name == "style" || name == "canvas" || name == "template") return false;
  return !has_class(node, "screen-only") && !node.attribute("hidden");
}

}  // namespace rondure::reports::pdf
