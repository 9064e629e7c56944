#include "record/archive/internal/server_url.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "record/archive/internal/postgresql.h"

namespace rondure::record {
namespace {

using Settings = std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)>;

/// The settings as parsed by libpq; null with the reason in `words`. kFile without libpq.
core::Result<Settings> parsed_by_libpq(std::string_view text, std::string& words) {
  TRY(const auto library, postgresql());
  char* reason = nullptr;
  Settings out(library.parse(std::string(text).c_str(), &reason), library.free_settings);
  const std::unique_ptr<char, decltype(&PQfreemem)> owned(reason, library.free_words);
  if (!out) words = reason == nullptr ? "the memory of this computer is not enough" : reason;
  return out;
}

std::string percent_encoded(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

void replace_all(std::string& text, std::string_view part) {
  constexpr std::string_view kInstead = "...";
  if (part.empty()) return;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + kInstead.size())) {
    text.replace(at, part.size(), kInstead);
  }
}

}  // namespace

core::Result<std::vector<ServerSetting>> parse_server_url(std::string_view url) {
  std::string words;
  TRY(const Settings settings, parsed_by_libpq(url, words));
  if (!settings) {
    // The reason continues with a quoted part of the URL, which may be a password.
    words = words.substr(0, std::min(words.find(": \""), words.find('\n')));
    return core::fail_with(core::Code::kBadOption,
                           "the URL of the archive cannot be read: {}; write / as %2F, ? as %3F "
                           "and @ as %40 in a user, a password or the name of a database",
                           words);
  }
  std::vector<ServerSetting> out;
  for (const PQconninfoOption* s = settings.get(); s->keyword != nullptr; ++s) {
    if (s->val == nullptr) continue;
    out.push_back({s->keyword, s->val, std::string_view(s->dispchar) == "*"});
  }
  return out;
}

core::Result<bool> is_connection_text(std::string_view text) {
  if (text.find('=') == std::string_view::npos) return false;  // each setting has one
  std::string ignored;
  TRY(const Settings settings, parsed_by_libpq(text, ignored));
  const PQconninfoOption* s = settings.get();
  while (s != nullptr && s->keyword != nullptr && s->val == nullptr) ++s;
  return s != nullptr && s->keyword != nullptr;
}

std::string server_url(const std::vector<ServerSetting>& settings) {
  std::string out = "postgresql://";
  char separator = '?';
  for (const ServerSetting& s : settings) {
    out += fmt::format("{}{}={}", separator, s.keyword, percent_encoded(s.value));
    separator = '&';
  }
  return out;
}

std::string shown_url(std::string_view url, const std::vector<ServerSetting>& settings) {
  const auto is_secret = [](const ServerSetting& s) { return s.secret; };
  if (std::none_of(settings.begin(), settings.end(), is_secret)) return std::string(url);
  const auto value = [&](std::string_view keyword) {
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const ServerSetting& s) { return s.keyword == keyword; });
    return found == settings.end() ? std::string() : found->value;
  };
  std::string out(url.substr(0, url.find("://") + 3));
  const std::string host = value("host");
  const bool several = host.find(',') != std::string::npos;  // their ports are a separate list
  const bool numbers = host.find(':') != std::string::npos;  // an IPv6 address
  if (!value("user").empty()) out += percent_encoded(value("user")) + "@";
  if (!several) out += numbers ? fmt::format("[{}]", host) : percent_encoded(host);
  if (!several && !value("port").empty()) out += ":" + percent_encoded(value("port"));
  if (!value("dbname").empty()) out += "/" + percent_encoded(value("dbname"));
  char separator = '?';
  for (const ServerSetting& s : settings) {
    const bool stands = s.keyword == "user" || s.keyword == "dbname" ||
                        (!several && (s.keyword == "host" || s.keyword == "port"));
    if (s.secret || stands) continue;
    out += fmt::format("{}{}={}", separator, s.keyword, percent_encoded(s.value));
    separator = '&';
  }
  return out;
}

std::string without_secrets(std::string sentence, std::string_view url) {
  replace_all(sentence, url);
  for (const ServerSetting& s : parse_server_url(url).value_or(std::vector<ServerSetting>{})) {
    if (!s.secret) continue;
    replace_all(sentence, s.value);
    replace_all(sentence, percent_encoded(s.value));
  }
  return sentence;
}

}  // namespace rondure::record
