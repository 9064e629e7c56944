#include "app/text/answer.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/exit_status.h"
#include "app/text/terminal.h"

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

}  // namespace

core::Result<void> check_finite(const Json& found) {
  const std::string pointer = not_finite_in(found, {});
  if (pointer.empty()) return {};
  return core::fail(core::Code::kNotFinite,
                    fmt::format("{} came out as no finite number: these data do not determine it, "
                                "and nothing of the result is given",
                                pointer));
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

int answer(const Json& found, bool as_json, const std::function<std::string()>& table) {
  if (const auto finite = check_finite(found); !finite) {
    print_error(finite.error());
    return kBadInput;
  }
  say(as_json ? found.dump(1) + "\n" : table());
  return kAllWell;
}

}  // namespace rondure::app
