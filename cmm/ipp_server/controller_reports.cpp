#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_server/controller.h"
#include "cmm/ipp_server/internal/arguments.h"
#include "core/units.h"

// Reports: positions, points, scans, temperatures.

namespace rondure::cmm::ipp {
namespace {

using Eigen::Vector3d;

constexpr std::array<std::string_view, 9> kTouchValues = {
    "X", "Y", "Z", "IJK", "ER", "Q", "Part.Temperature", "Scale.Temperature", "Time"};
constexpr std::array<std::string_view, 5> kScanValues = {"X", "Y", "Z", "ER", "Q"};

/// Sets the values of a report.
/// @param values  The names it may hold; `form` and `kind` word a refusal.
Outcome set_report(std::vector<std::string>& report, const Arguments& arguments,
                   std::span<const std::string_view> values, std::string_view form,
                   std::string_view kind, const Profile& profile) {
  const auto names = empty_calls(arguments);
  if (!names) return wrong_arguments(form);
  for (const std::string& name : *names) {
    if (!is_one_of(name, values) || !profile.knows(name)) {
      return refusal(kNotRecognized, fmt::format("{} is no {}", name, kind));
    }
  }
  report = profile.in_order(*names);
  return Reply{};
}

}  // namespace

tl::expected<std::vector<Item>, Failure> Controller::position_report(
    const std::vector<std::string>& names, const Eigen::Vector3d& tip_W_mm) const {
  const Eigen::Vector3d p_mm = X_CW_ * tip_W_mm;
  const std::vector<double> angles_deg = backend_.table_angles_deg();
  std::vector<Item> out;
  if (names.size() > kMaxNames) return refusal(kIncorrectArguments, "too many names");
  for (const std::string& name : options_.profile.in_order(names)) {
    if (name == "X" || name == "Y" || name == "Z") {
      out.push_back(call_item(name, {p_mm[name[0] - 'X']}));
    } else if (name == "R" && !angles_deg.empty()) {
      out.push_back(call_item(name, {angles_deg[0]}));
    } else {
      return refusal(kNotRecognized, fmt::format("{} is no value of the position", name));
    }
  }
  return out;
}

Outcome Controller::get_position(const Arguments& arguments) {
  const auto names = empty_calls(arguments);
  if (!names) return wrong_arguments("(X(), Y(), ...)");
  TRY(auto values, position_report(*names, machine().position_W_mm()));
  return Reply{{std::move(values)}, 0};
}

Outcome Controller::set_touch_report(const Arguments& arguments) {
  return set_report(touch_report_, arguments, kTouchValues, "(X(), Y(), Z(), IJK(), ER(), Q())",
                    "value of a touch", options_.profile);
}

Outcome Controller::set_scan_report(const Arguments& arguments) {
  return set_report(scan_report_, arguments, kScanValues, "(X(), Y(), Z(), Q())",
                    "column of a scan", options_.profile);
}

Outcome Controller::temperature_sensors(const Arguments&) {
  return Reply{{{string_item("Part")}, {string_item("Scale")}}, 0};
}

Outcome Controller::read_temperature(const Arguments& arguments) {
  const auto sensor = arguments.size() == 1 ? string_of(arguments[0]) : std::nullopt;
  if (!sensor) return wrong_arguments("(\"sensor\")");
  if (*sensor != "Part" && *sensor != "Scale") {
    return refusal(kNotRecognized, fmt::format("there is no sensor \"{}\"", *sensor));
  }
  const auto value = report_values(*sensor + ".Temperature", last_reading_.value_or(TouchReading()),
                                   Vector3d::Zero());
  return one_line(call_item("ReadTemperatureSensor", {value[0]}));
}

Outcome Controller::read_all_temperatures(const Arguments&) {
  Reply out;
  for (const char* sensor : {"Part", "Scale"}) {
    auto read = read_temperature({string_item(sensor)});
    if (!read) return read;
    out.lines.push_back({call_item(sensor, read->lines[0][0].arguments)});
  }
  return out;
}

Reply Controller::align_reply(const std::vector<Alignment>& wanted,
                              const std::vector<double>& limits_deg,
                              const std::vector<Vector3d>& reached) const {
  Reply out;
  out.lines.emplace_back();
  for (std::size_t i = 0; i < reached.size() && i < wanted.size(); ++i) {
    const Vector3d& v = reached[i];
    std::vector<Item> values = call_item("", v).arguments;
    if (options_.profile.brackets_vectors) {
      values = {Item{Item::Kind::kVector, 0.0, "", std::move(values)}};
    }
    for (Item& value : values) out.lines[0].push_back(std::move(value));
    const double off_deg =
        std::atan2(v.cross(wanted[i].machine).norm(), v.dot(wanted[i].machine)) / core::kDegree;
    if (limits_deg[i] > 0.0 && off_deg > limits_deg[i]) out.report = kNotAligned;
  }
  return out;
}

std::vector<double> Controller::report_values(const std::string& name, const TouchReading& reading,
                                              const Vector3d& direction_W) const {
  if (name == "X" || name == "Y" || name == "Z") {
    return {(X_CW_ * reading.tip_W_mm)[name[0] - 'X']};
  }
  if (name == "IJK") {
    const Vector3d ijk = options_.profile.tells_tool_axis ? Vector3d(Vector3d::UnitZ())
                                                          : X_CW_.linear() * direction_W;
    return {ijk.x(), ijk.y(), ijk.z()};
  }
  if (name == "ER") {
    return {reading.tip_radius_mm > 0.0 ? reading.tip_radius_mm : options_.tip_radius_mm};
  }
  if (name == "Part.Temperature") {
    return {reading.temperature_degC.value_or(options_.temperature_degC)};
  }
  if (name == "Scale.Temperature") {
    return {reading.scale_temperature_degC.value_or(options_.temperature_degC)};
  }
  if (name == "Time") return {reading.time_s};
  return {0.0};  // Q: every simulated point is good
}

Reply Controller::touch_reply(const TouchReading& reading, const Vector3d& direction_W) const {
  Reply out;
  out.lines.emplace_back();
  for (const std::string& name : touch_report_) {
    std::vector<Item> values;
    for (const double value : report_values(name, reading, direction_W)) {
      values.push_back(number_item(value));
    }
    out.lines[0].push_back(call_item(name, std::move(values)));
  }
  return out;
}

Reply Controller::scan_reply(const std::vector<TouchReading>& readings) const {
  Reply out;
  for (const TouchReading& reading : readings) {
    if (out.lines.empty() ||
        out.lines.back().size() + scan_report_.size() > options_.profile.numbers_in_a_line) {
      out.lines.emplace_back();
    }
    for (const std::string& name : scan_report_) {
      out.lines.back().push_back(number_item(report_values(name, reading, {})[0]));
    }
  }
  return out;
}

}  // namespace rondure::cmm::ipp
