#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/verbs/verbs.h"
#include "cmm/ipp/grammar.h"
#include "cmm/ipp_client/survey.h"
#include "core/numbers.h"
#include "wire/tcp_line.h"

namespace rondure::app {
namespace {

/// Address of a server.
struct ServerPlace {
  std::string host;
  std::uint16_t port = 0;
};

using Json = nlohmann::ordered_json;
using cmm::ipp::client::Survey;

constexpr std::size_t kWidth = 80;
constexpr std::size_t kIndent = 20;  // indentation of text beside a name
constexpr double kUsualDistance_mm = 3.0;
// Commands that every run needs.
constexpr auto kNeeded = std::to_array<std::string_view>(
    {"IsHomed", "Home", "Get", "GoTo", "PtMeas", "GetProp", "SetProp", "SetCoordSystem",
     "ClearAllErrors", "OnPtMeasReport"});

struct Lack {
  std::string what;
  std::string meaning;
};

bool reports(const Survey& survey, std::string_view name) {
  return std::find(survey.point_values.begin(), survey.point_values.end(), name) !=
         survey.point_values.end();
}

bool turns_the_part(const Survey& survey) {
  return survey.has_rotary_table() && survey.may_know("AlignPart");
}

bool can_scan(const Survey& survey) {
  return survey.scans && survey.may_know("ScanOnCircle") &&
         survey.parameter("Tool.ScanPar.Speed") != nullptr;
}

bool returns_to_approach(const Survey& survey) {
  const auto* retract = survey.parameter("Tool.PtMeasPar.Retract");
  return retract != nullptr && retract->least.value_or(-1.0) < 0.0;
}

void add_lacks_of_commands(const Survey& survey, std::vector<Lack>& out) {
  for (const std::string_view command : kNeeded) {
    if (survey.may_know(command)) continue;
    out.push_back({std::string(command), "a run needs this command: no run with this server"});
  }
  if (!survey.homed && survey.may_know("IsHomed")) {
    out.push_back({"IsHomed", "a run needs this command: no run with this server"});
  }
  if (!survey.tells_state) {
    out.push_back({"GetErrStatusE", "an error state shows at the first motion only"});
  }
  if (!survey.may_know("AbortE")) {
    out.push_back({"AbortE", "a stop waits for the end of the motion: \"abort\": \"broken\""});
  }
}

void add_lacks_of_tool(const Survey& survey, std::vector<Lack>& out) {
  if (survey.tool.empty()) {
    out.push_back({"tool in the head", "name one of the tools: \"tool\""});
  } else if (survey.tip_radius_mm.value_or(0.0) == 0.0) {
    out.push_back({"radius of the tool",
                   "not compared with probe.tip_diameter_mm at the start; the qualification of "
                   "the run finds it"});
  }
  if (!returns_to_approach(survey)) {
    out.push_back(
        {"negative Retract", "the tip goes back by itself: \"retract\": \"by-distance\""});
  }
}

void add_lacks_of_reports(const Survey& survey, std::vector<Lack>& out) {
  if (!reports(survey, "X")) {
    out.push_back({"points with X, Y, Z", "no run with this server"});
  }
  const bool warm = reports(survey, "Part.Temperature");
  if (!warm && !survey.part_degC) {
    out.push_back(
        {"part temperature", "results are void unless the plan says environment.assumed_degC"});
  } else if (!warm) {
    out.push_back({"temperature a point", "the part temperature is asked for once"});
  }
  if (!reports(survey, "Time")) {
    out.push_back({"time of a point", "touches carry the time of this computer"});
  }
  if (!can_scan(survey)) {
    out.push_back(
        {"circle scans", "a plan with sampling.method \"scan\" is refused; touch points"});
  }
}

std::vector<Lack> lacks_of(const Survey& survey) {
  std::vector<Lack> out;
  if (survey.version.empty()) {
    out.push_back({"GetDMEVersion", "taken for a server before 1.4; nothing follows for a plan"});
  } else if (!survey.version.starts_with("1.") && !survey.version.starts_with("2.")) {
    out.push_back({"version 1.x or 2.x", "no run with this server"});
  }
  add_lacks_of_commands(survey, out);
  if (!turns_the_part(survey)) {
    out.push_back({"rotary axes",
                   "the fixture of the plan needs a driver of its own, or is \"fixed\" "
                   "(fixture.driver, docs/fixtures.md), not \"ippdme\""});
  }
  add_lacks_of_tool(survey, out);
  add_lacks_of_reports(survey, out);
  return out;
}

/// A usual value within the limits of the server.
double within(const Survey::Parameter* limits, double usual) {
  if (limits == nullptr) return usual;
  const double least = limits->least.value_or(0.0);
  const double greatest = limits->greatest.value_or(std::numeric_limits<double>::infinity());
  return least <= greatest ? std::clamp(usual, least, greatest) : usual;
}

/// Adds only a number that a plan can hold: positive, finite.
void add_key(Json& keys, const char* name, double value) {
  if (std::isfinite(value) && value > 0.0) keys[name] = value;
}

Json keys_of(const Survey& survey, const ServerPlace& place) {
  Json out = {{"driver", "ippdme"}, {"host", place.host}, {"port", place.port}};
  const std::string tool =
      survey.tool.empty() && !survey.tools.empty() ? survey.tools.front() : survey.tool;
  if (!tool.empty()) out["tool"] = tool;
  add_key(out, "approach_mm",
          within(survey.parameter("Tool.PtMeasPar.Approach"), kUsualDistance_mm));
  add_key(out, "search_mm", within(survey.parameter("Tool.PtMeasPar.Search"), kUsualDistance_mm));
  add_key(out, "travel_speed_mm_s", within(survey.parameter("Tool.GoToPar.Speed"), 100.0));
  add_key(out, "touch_speed_mm_s", within(survey.parameter("Tool.PtMeasPar.Speed"), 5.0));
  if (can_scan(survey)) {
    add_key(out, "scan_speed_mm_s", within(survey.parameter("Tool.ScanPar.Speed"), 10.0));
  }
  if (!survey.may_know("AbortE")) out["abort"] = "broken";
  if (!returns_to_approach(survey)) out["retract"] = "by-distance";
  return out;
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json parameters_of(const Survey& survey) {
  Json out = Json::array();
  for (const Survey::Parameter& p : survey.parameters) {
    out.push_back({{"name", p.name},
                   {"value", or_null(p.value)},
                   {"min", or_null(p.least)},
                   {"max", or_null(p.greatest)}});
  }
  return out;
}

/// A paragraph beside a name, broken between words.
std::string beside(std::string_view name, std::string_view text) {
  return wrapped(text, fmt::format("{:<{}} ", name, kIndent - 1), std::string(kIndent, ' '),
                 kWidth);
}

std::string joined(const Json& list, std::string_view none) {
  std::string out;
  for (const Json& one : list) out += (out.empty() ? "" : ", ") + one.get<std::string>();
  return out.empty() ? std::string(none) : out;
}

std::string number_text(const Json& value, const char* unit) {
  return value.is_null() ? "unknown" : fmt::format("{:.7g}{}", value.get<double>(), unit);
}

std::string place_text(const Json& found) {
  const Json& tip = found["tip_mm"];
  std::string out = "unknown";
  if (!tip.is_null()) {
    out = fmt::format("X {:.7g}, Y {:.7g}, Z {:.7g} mm", tip[0].get<double>(), tip[1].get<double>(),
                      tip[2].get<double>());
  }
  const std::string frame = found["frame"];
  if (!frame.empty()) out += " in " + frame;
  if (!found["table_deg"].is_null()) out += ", R " + number_text(found["table_deg"], " deg");
  return out;
}

std::string parameter_text(const Json& p) {
  const std::string name = p["name"];
  const char* unit = name.ends_with("Speed") ? " mm/s" : " mm";
  return beside(name.substr(name.find('.') + 1),
                fmt::format("{}, limits {} to {}", number_text(p["value"], unit),
                            number_text(p["min"], ""), number_text(p["max"], "")));
}

Json survey_json(const Survey& survey, const ServerPlace& place) {
  Json lacks = Json::array();
  Json refused = Json::array();
  if (survey.fault.empty()) {
    for (const Lack& lack : lacks_of(survey)) {
      lacks.push_back({{"what", lack.what}, {"meaning", lack.meaning}});
    }
  }
  for (const Survey::Refused& one : survey.refused) {
    refused.push_back({{"command", one.command}, {"why", one.why}});
  }
  Json out = {{"server", survey.peer},
              {"version", survey.version},
              {"machine_class", survey.machine_class},
              {"simulated", survey.simulated},
              {"fault", survey.fault},
              {"homed", or_null(survey.homed)},
              {"tools", survey.tools},
              {"tool", survey.tool},
              {"tip_radius_mm", or_null(survey.tip_radius_mm)},
              {"frame", survey.frame},
              {"tip_mm", nullptr},
              {"table_deg", or_null(survey.table_deg)},
              {"rotary_axes", turns_the_part(survey)},
              {"part_degC", or_null(survey.part_degC)},
              {"sensors", survey.sensors},
              {"point_values", survey.point_values},
              {"scans", can_scan(survey)},
              {"parameters", parameters_of(survey)},
              {"commands", survey.commands},
              {"refused", std::move(refused)},
              {"lacks", std::move(lacks)}};
  if (survey.tip_mm) out["tip_mm"] = {survey.tip_mm->x(), survey.tip_mm->y(), survey.tip_mm->z()};
  if (survey.fault.empty()) out["machine"] = keys_of(survey, place);
  return out;
}

std::string survey_text(const Json& found) {
  const auto text = [&found](const char* key) { return found[key].get<std::string>(); };
  const std::string version = text("version");
  const std::string kind = text("machine_class");
  std::string out = fmt::format("{}: I++ DME {}, {}{}\n", text("server"),
                                version.empty() ? "of unknown version" : version,
                                kind.empty() ? "machine of unknown class" : kind,
                                found["simulated"].get<bool>() ? " (rondure simulate-cmm)" : "");
  if (const std::string fault = text("fault"); !fault.empty()) {
    return out + beside("fault", fault) +
           beside("", "Nothing else was asked. Put that right at the machine, then ask again.");
  }
  const Json& homed = found["homed"];
  out += beside("homed", homed.is_null()     ? "unknown"
                         : homed.get<bool>() ? "yes"
                                             : "no: a run homes it, everything out of its way");
  const std::string tool = text("tool");
  out += beside("tool in the head", tool.empty() ? "none" : tool);
  if (!tool.empty()) out += beside("effective radius", number_text(found["tip_radius_mm"], " mm"));
  out += beside("tools", joined(found["tools"], "none"));
  out += beside("tip", place_text(found));
  out += beside("rotary axes", found["rotary_axes"].get<bool>() ? "yes (AlignPart)" : "no");
  out += beside("circle scans", found["scans"].get<bool>() ? "yes" : "no");
  out += beside("part temperature", number_text(found["part_degC"], " degC"));
  out += beside("sensors", joined(found["sensors"], "none"));
  out += beside("a touch reports", joined(found["point_values"], "nothing"));
  for (const Json& p : found["parameters"]) out += parameter_text(p);
  out += "\nWhat it lacks, and what that means for a plan\n";
  for (const Json& lack : found["lacks"]) {
    out += beside(lack["what"].get<std::string>(), lack["meaning"].get<std::string>());
  }
  if (found["lacks"].empty()) out += "nothing that a run needs\n";
  if (!found["refused"].empty()) out += "\nWhat it refused to answer\n";
  for (const Json& one : found["refused"]) {
    out += beside("", one["command"].get<std::string>() + ": " + one["why"].get<std::string>());
  }
  out +=
      "\nNot asked, because something would have to move: whether PtMeas takes the\n"
      "surface point or the centre of the tip (\"point\"; a run finds out at its first\n"
      "touch), whether AbortE stops a motion, which way the rotary axes turn. Begin\n"
      "with rondure run PLAN --step.\n";
  return out + fmt::format("\nFor the plan:\n\"machine\": {}\n", found["machine"].dump(2));
}

/// Parses HOST, HOST:PORT or [ADDRESS]:PORT; a bare IPv6 address has more than one colon.
std::optional<ServerPlace> server_place(std::string_view text) {
  std::string_view port;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    port = text.substr(end + 1);
    text = text.substr(1, end - 1);
  } else if (const std::size_t colon = text.find(':'); colon == text.rfind(':')) {
    port = text.substr(std::min(colon, text.size()));
    text = text.substr(0, colon);
  }
  if (text.empty()) return std::nullopt;
  if (port.empty()) return ServerPlace{std::string(text), cmm::ipp::kDefaultPort};
  const auto number = core::parse_number(port.substr(1));
  const bool whole =
      number && *number >= 1.0 && *number <= 65535.0 && *number == std::floor(*number);
  if (port.front() != ':' || !whole) return std::nullopt;
  return ServerPlace{std::string(text), static_cast<std::uint16_t>(*number)};
}

}  // namespace

int server_device(const ServerDeviceArguments& arguments) {
  const auto place = server_place(arguments.place);
  if (!place) {
    return refuse({core::Code::kMeaning,
                   fmt::format("{} is no HOST:PORT with a port from 1 to 65535, as 127.0.0.1:1294",
                               arguments.place),
                   {}});
  }
  const std::chrono::milliseconds limit(std::llround(1000.0 * arguments.limit_s));
  wire::TcpOptions tcp;
  tcp.connect_limit = tcp.write_limit = limit;
  auto line = wire::connect_tcp(place->host, place->port, tcp);
  if (!line) return refuse(line.error());
  const auto found = cmm::ipp::client::survey(std::move(*line), limit);
  if (!found) return refuse(found.error());
  const nlohmann::ordered_json document = survey_json(*found, *place);
  return answer(document, arguments.json, [&] { return survey_text(document); });
}

}  // namespace rondure::app
