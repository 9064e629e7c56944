#include "app/text/answer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/terminal.h"
#include "core/encodings.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;

/// JSON pointer of the first number that is not finite; empty when there is none.
std::string not_finite_in(const Json& value, const std::string& pointer) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) return pointer;
  if (!value.is_structured()) return {};
  for (const auto& [key, inner] : value.items()) {
    if (auto found = not_finite_in(inner, pointer + "/" + key); !found.empty()) return found;
  }
  return {};
}

/// Quotes a word as $'a\x1bb' for bash, zsh and ksh: the command names the file, and can be
/// printed.
std::string with_escapes(const std::string& word) {
  std::string out = "$'";
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte >= 0x20 && byte < 0x7F && c != '\'' && c != '\\';
    out += plain ? std::string(1, c) : fmt::format("\\{:03o}", byte);
  }
  return out + "'";
}

}  // namespace

int refuse(const core::Error& error) {
  print_error(error);
  return kBadInput;
}

int refuse(const std::vector<core::Error>& errors) {
  print_error(errors);
  return kBadInput;
}

int refuse_file(const core::Error& error, const std::string& file) {
  const bool placed = !error.where.empty();
  return refuse(placed ? error : error.at(std::filesystem::path(file).filename().string()));
}

core::Result<void> check_finite(const Json& found) {
  const std::string pointer = not_finite_in(found, {});
  if (pointer.empty()) return {};
  return core::fail_with(core::Code::kNotFinite,
                         "{} came out as no finite number: these data do not determine it, and "
                         "nothing of the result is given",
                         pointer);
}

Json warnings_json(const std::vector<core::Error>& warnings) {
  Json out = Json::array();
  for (const core::Error& w : warnings) {
    out.push_back({{"code", core::code_name(w.code)}, {"what", w.what}});
  }
  return out;
}

std::string warnings_text(const std::vector<core::Error>& warnings) {
  std::string out;
  for (const core::Error& w : warnings) {
    out += fmt::format("  warning: {} [{}]\n", w.what, core::code_name(w.code));
  }
  return out;
}

Json certificate_json(const fit::Certificate& certificate) {
  const bool proven = certificate.kind != fit::Certificate::Kind::kNone;
  return {{"kind", fit::name_of(certificate.kind)},
          {"scope", certificate.scope},
          {"gap_mm", proven ? Json(certificate.gap_mm) : Json(nullptr)},
          {"reason", certificate.reason}};
}

std::string certificate_text(const fit::Certificate& certificate) {
  std::string out = fmt::format("certificate {}, {}", fit::name_of(certificate.kind),
                                certificate.scope.english());
  if (certificate.kind != fit::Certificate::Kind::kNone) {
    out += fmt::format(", gap {:.1e} mm", certificate.gap_mm);
  }
  return certificate.reason.empty() ? out : out + "; " + certificate.reason.english();
}

std::string wrapped(std::string_view text, std::string line, const std::string& indent,
                    std::size_t columns) {
  std::string out;
  bool begun = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (begun && line.size() + 1 + word.size() > columns) {
      out += line + "\n";
      line = indent;
      begun = false;
    }
    line += fmt::format("{}{}", begun ? " " : "", word);
    begun = true;
  }
  return out + line + "\n";
}

std::string quoted(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:@%=+,";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  const bool controls =
      std::any_of(word.begin(), word.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7F; });
  if (controls && core::printable(word) != word) return with_escapes(word);
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

int answer(const Json& found, bool as_json, const std::function<std::string()>& table) {
  if (const auto finite = check_finite(found); !finite) return refuse(finite.error());
  say(as_json ? found.dump(1) + "\n" : table());
  return kAllWell;
}

}  // namespace rondure::app
