#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_server/controller.h"
#include "cmm/ipp_server/internal/arguments.h"

// Tools and properties.

namespace rondure::cmm::ipp {
namespace {

constexpr std::string_view kNoTool = "NoTool";
constexpr std::string_view kTool = "Tool.";
constexpr std::string_view kFoundTool = "FoundTool.";
constexpr std::string_view kSimulation = "Simulation.";
constexpr double kLargestCount = 9e15;  // a double holds every whole number up to this value

struct PropertyName {
  std::string_view name;
  std::string_view type;
};

constexpr PropertyName kProperties[] = {
    {"Tool.Name", "String"},           {"Tool.Id", "String"},
    {"Tool.AvrRadius", "Number"},      {"Tool.Alignment", "Vector"},
    {"Part.Temperature", "Number"},    {"Part.XpanCoefficient", "Number"},
    {"Simulation.Feature", "Number"},  {"Simulation.NextTouch", "Number"},
    {"Simulation.NextTurn", "Number"}, {"Simulation.Pose", "Vector"},
    {"Simulation.Time", "Number"},
};

bool is_count(double value) {
  return value >= 0.0 && value <= kLargestCount && value == std::floor(value);
}

/// All properties with their types, including the parameters of the tool.
std::vector<std::pair<std::string, std::string>> property_list(const ToolParameters& parameters) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const PropertyName& property : kProperties) out.emplace_back(property.name, property.type);
  for (const std::string& name : parameters.names()) out.emplace_back("Tool." + name, "Number");
  return out;
}

std::vector<Item> pair_of_strings(std::string_view a, std::string_view b) {
  return {string_item(a), string_item(b)};
}

/// "Tool.PtMeasPar." for the argument Tool.PtMeasPar().
std::optional<std::string> prefix_of(const Arguments& arguments) {
  if (arguments.size() != 1 || arguments[0].kind != Item::Kind::kCall) return std::nullopt;
  if (!arguments[0].arguments.empty()) return std::nullopt;
  return arguments[0].text + ".";
}

}  // namespace

Outcome Controller::enum_tools(const Arguments&) {
  Reply out;
  out.lines.push_back({string_item(kNoTool)});
  for (const std::string& tool : machine().capabilities().tools) {
    out.lines.push_back({string_item(tool)});
  }
  return out;
}

Outcome Controller::find_tool(const Arguments& arguments) {
  const auto name = arguments.size() == 1 ? string_of(arguments[0]) : std::nullopt;
  if (!name) return refusal(kIncorrectArguments, "the argument is not a name in quotes");
  const std::vector<std::string> tools = machine().capabilities().tools;
  if (*name != kNoTool && std::find(tools.begin(), tools.end(), *name) == tools.end()) {
    return refusal(kToolNotFound, fmt::format("there is no tool \"{}\"", *name));
  }
  found_tool_ = *name;
  return Reply{};
}

Outcome Controller::change_tool(const Arguments& arguments) {
  if (auto found = find_tool(arguments); !found) return found;
  if (found_tool_ == kNoTool) {
    tool_.clear();
  } else {
    if (auto selected = machine().select_tool(found_tool_); !selected) {
      return tl::unexpected(failure_of(selected.error(), "ChangeTool"));
    }
    tool_ = found_tool_;
  }
  parameters_.reset();
  if (auto set = machine().set_speeds(parameters_.speeds()); !set) {
    return tl::unexpected(failure_of(set.error(), "ChangeTool"));
  }
  user_enabled_ = false;
  return Reply{};
}

std::optional<Item> Controller::property(const std::string& name) const {
  if (!options_.profile.knows(name)) return std::nullopt;
  const auto number = [&name](double value) { return call_item(name, {value}); };
  const bool found = name.starts_with(kFoundTool);
  if (found || name.starts_with(kTool)) {
    const std::string_view rest =
        std::string_view(name).substr(found ? kFoundTool.size() : kTool.size());
    const std::string& tool = found ? found_tool_ : tool_;
    if (rest == "Id") return call_item(name, {string_item(kSimulatorId)});
    if (rest == "Name") {
      return call_item(name, {string_item(tool.empty() ? kNoTool : std::string_view(tool))});
    }
    if (rest == "AvrRadius") return number(tool.empty() ? 0.0 : options_.tip_radius_mm);
    if (rest == "Alignment") return call_item(name, {0.0, 0.0, 1.0});
    const auto value = parameters_.get(rest);
    return value ? std::optional<Item>(number(*value)) : std::nullopt;
  }
  if (name == "Part.Temperature") {
    return number(last_reading_.value_or(TouchReading())
                      .temperature_degC.value_or(options_.temperature_degC));
  }
  if (name == "Part.XpanCoefficient") return number(expansion_);
  if (name == "Simulation.NextTouch") return number(static_cast<double>(next_touch_));
  if (name == "Simulation.Feature") return number(feature_);
  if (name == "Simulation.Time") return number(backend_.machine().time_s());
  if (name == "Simulation.Pose") {
    std::vector<Item> angles;
    for (const double angle_deg : backend_.table_angles_deg()) {
      angles.push_back(number_item(angle_deg));
    }
    return call_item(name, std::move(angles));
  }
  return std::nullopt;
}

Outcome Controller::get_properties(const Arguments& arguments) {
  Reply out;
  out.lines.emplace_back();
  if (arguments.size() > kMaxNames) return refusal(kIncorrectArguments, "too many properties");
  for (const Item& item : arguments) {
    if (item.kind != Item::Kind::kCall || !item.arguments.empty()) {
      return refusal(kIncorrectArguments, "the arguments are not properties, as Tool.Name()");
    }
    auto value = property(item.text);
    if (!value) return refusal(kBadProperty, fmt::format("there is no property {}", item.text));
    out.lines[0].push_back(std::move(*value));
  }
  if (out.lines[0].empty()) return refusal(kIncorrectArguments, "no property is named");
  return out;
}

int Controller::set_simulation(std::string_view name, double value) {
  if (!is_count(value)) return kBadArgument;
  if (name == "NextTouch") {
    next_touch_ = static_cast<std::int64_t>(value);
    return 0;
  }
  if (name == "NextTurn") {
    backend_.set_next_turn(static_cast<std::uint64_t>(value));
    return 0;
  }
  if (name != "Feature") return kBadProperty;
  if (value > 1e6 || !backend_.choose_feature(static_cast<int>(value))) return kBadArgument;
  feature_ = static_cast<int>(value);
  return 0;
}

int Controller::set_property(const std::string& name, double value) {
  if (!options_.profile.knows(name)) return kBadProperty;
  if (name.starts_with(kSimulation)) {
    return set_simulation(std::string_view(name).substr(kSimulation.size()), value);
  }
  if (name == "Part.XpanCoefficient") {
    expansion_ = value;
    return 0;
  }
  if (!name.starts_with(kTool)) return kBadProperty;
  switch (parameters_.set(std::string_view(name).substr(kTool.size()), value)) {
    case ToolParameters::Set::kNoSuch:
      return kBadProperty;
    case ToolParameters::Set::kClamped:
      return kOutOfRange;
    case ToolParameters::Set::kDone:
      break;
  }
  return 0;
}

Outcome Controller::set_properties(const Arguments& arguments) {
  Reply out;
  if (arguments.empty()) return refusal(kIncorrectArguments, "no property is named");
  for (const Item& item : arguments) {
    const auto value = item.kind == Item::Kind::kCall ? single_number(item) : std::nullopt;
    if (!value) {
      return refusal(kIncorrectArguments, "the arguments are not properties with a number");
    }
    const int number = set_property(item.text, *value);
    if (number == kOutOfRange) {
      out.report = number;
    } else if (number != 0) {
      return refusal(number, fmt::format("{} cannot be set to {}", item.text, *value));
    }
  }
  if (auto set = machine().set_speeds(parameters_.speeds()); !set) {
    return tl::unexpected(failure_of(set.error(), "SetProp"));
  }
  return out;
}

Outcome Controller::enum_all_properties(const Arguments& arguments) {
  const auto prefix = prefix_of(arguments);
  if (!prefix) return refusal(kIncorrectArguments, "the argument is not a property, as Tool()");
  Reply out;
  for (const auto& [name, type] : property_list(parameters_)) {
    if (name.starts_with(*prefix) && options_.profile.knows(name)) {
      out.lines.push_back(pair_of_strings(name.substr(prefix->size()), type));
    }
  }
  if (out.lines.empty()) return refusal(kBadProperty, "nothing is below this property");
  return out;
}

Outcome Controller::enum_properties(const Arguments& arguments) {
  auto all = enum_all_properties(arguments);
  if (!all) return all;
  Reply out;
  for (const std::vector<Item>& line : all->lines) {
    const std::string& name = line[0].text;
    const std::size_t point = name.find('.');
    auto own =
        point == std::string::npos ? line : pair_of_strings(name.substr(0, point), "Property");
    if (out.lines.empty() || out.lines.back() != own) out.lines.push_back(std::move(own));
  }
  return out;
}

}  // namespace rondure::cmm::ipp
