#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/rotary_axes.h"
#include "app/text/terminal.h"
#include "app/verbs/rotary_axes_command.h"
#include "app/verbs/verbs.h"
#include "core/numbers.h"
#include "core/result.h"
#include "core/units.h"
#include "fit/rotary/axes.h"
#include "record/csv/balls.h"
#include "record/files.h"

namespace rondure::app {
namespace {

/// One axis of the files.
struct NamedAxis {
  std::string name;
  fit::RotaryMeasurement measurement;
};

using core::Code;
using Eigen::Vector3d;

std::optional<Vector3d> direction_by_name(std::string_view name) {
  struct Known {
    std::string_view name;
    int axis;
  };
  constexpr std::array<Known, 11> kKnown = {{{"x", 0},
                                             {"y", 1},
                                             {"z", 2},
                                             {"A", 0},
                                             {"B", 1},
                                             {"C", 2},
                                             {"a", 0},
                                             {"b", 1},
                                             {"c", 2},
                                             {"phi_alpha", 0},
                                             {"phi_beta", 1}}};
  for (const Known& known : kKnown) {
    if (known.name == name) return Vector3d::Unit(known.axis);
  }
  return std::nullopt;
}

/// "x" or "0,0.6,0.8".
core::Result<Vector3d> direction_of(std::string_view text) {
  if (const auto known = direction_by_name(text)) return *known;
  Vector3d out;
  std::string_view rest = text;
  for (int k = 0; k < 3; ++k) {
    const std::size_t comma = k < 2 ? rest.find(',') : rest.size();
    const auto number = core::parse_number(rest.substr(0, comma));
    if (!number || comma == std::string_view::npos) {
      return core::fail(Code::kBadOption,
                        fmt::format("--axis {} is neither x, y, z nor three numbers a,b,c", text));
    }
    out(k) = *number;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  if (!(out.norm() > 1e-9)) {
    return core::fail(Code::kBadOption, fmt::format("--axis {} has no direction", text));
  }
  return Vector3d(out.normalized());
}

core::Result<fit::RotaryMeasurement> empty_axis(const std::string& name,
                                                const RotaryAxesArguments& a) {
  fit::RotaryMeasurement out;
  if (!a.axis.empty()) {
    const auto direction = direction_of(a.axis);
    if (!direction) return core::fail(direction.error());
    out.axis.direction = *direction;
  } else if (const auto known = direction_by_name(name)) {
    out.axis.direction = *known;
  } else {
    return core::fail(
        Code::kBadOption,
        fmt::format("the direction of axis {} is not known by its name; give --axis", name));
  }
  if (!a.origin_mm.empty()) {
    if (a.origin_mm.size() != 3) {
      return core::fail(Code::kBadOption, "--origin needs three numbers: X,Y,Z");
    }
    out.axis.origin_mm = {a.origin_mm[0], a.origin_mm[1], a.origin_mm[2]};
  }
  if (!a.range_deg.empty()) {
    if (a.range_deg.size() != 2) {
      return core::fail(Code::kBadOption, "--range-deg needs two numbers: LO,HI");
    }
    out.lowest_rad = a.range_deg[0] * core::kDegree;
    out.highest_rad = a.range_deg[1] * core::kDegree;
  }
  out.reference_rad = a.reference_deg * core::kDegree;
  return out;
}

fit::Approach approach_of(int direction) {
  if (direction == 0) return fit::Approach::kUnknown;
  return direction > 0 ? fit::Approach::kForward : fit::Approach::kBackward;
}

/// Where a row belongs: the pose under way, an earlier one, or a new one.
std::vector<fit::BallCentre>& place_of(const record::BallRow& row, fit::RotaryMeasurement& out) {
  if (!row.station_deg) {
    for (auto& reference : out.references) {
      const bool there =
          std::any_of(reference.begin(), reference.end(),
                      [&](const fit::BallCentre& ball) { return ball.ball == row.ball; });
      if (!there) return reference;
    }
    return out.references.emplace_back();
  }
  const double angle = *row.station_deg * core::kDegree;
  const fit::Approach approach = approach_of(row.direction);
  for (fit::RotaryPose& pose : out.stations) {
    if (pose.angle_rad == angle && pose.approach == approach) return pose.balls;
  }
  return out.stations.emplace_back(fit::RotaryPose{angle, approach, {}}).balls;
}

core::Result<void> add_row(const record::BallRow& row, const RotaryAxesArguments& arguments,
                           std::vector<NamedAxis>& axes) {
  auto at = std::find_if(axes.begin(), axes.end(),
                         [&](const NamedAxis& axis) { return axis.name == row.axis; });
  if (at == axes.end()) {
    if (!axes.empty() && !arguments.axis.empty()) {
      return core::fail(Code::kBadOption,
                        fmt::format("--axis is for one axis, the files hold {} and {}",
                                    axes.front().name, row.axis));
    }
    auto measurement = empty_axis(row.axis, arguments);
    if (!measurement) return core::fail(measurement.error());
    axes.push_back({row.axis, *std::move(measurement)});
    at = axes.end() - 1;
  }
  place_of(row, at->measurement).push_back({row.ball, row.centre_mm, row.u_um * core::kMicrometre});
  return {};
}

/// Reads the files and sorts their rows by axis and station, in the order of measurement. A ball
/// that recurs in the reference pose starts its next measurement.
/// @return The errors of parse_ball_csv(); kBadOption when the direction of an axis is unknown, is
/// not three numbers, or is given for several axes.
core::Result<std::vector<NamedAxis>> read_rotary_axes(const RotaryAxesArguments& arguments) {
  std::vector<NamedAxis> out;
  for (const std::string& file : arguments.files) {
    const auto bytes = record::read_file(file);
    if (!bytes) return core::fail(bytes.error());
    const std::string name = std::filesystem::path(file).filename().string();
    const auto rows = record::parse_ball_csv(*bytes, name);
    if (!rows) return core::fail(rows.error());
    for (const record::BallRow& row : *rows) {
      if (auto added = add_row(row, arguments, out); !added) {
        return core::fail(added.error().at(fmt::format("{}:{}", name, row.line)));
      }
    }
  }
  return out;
}

fit::RotaryOptions options_of(const RotaryAxesArguments& a) {
  fit::RotaryOptions out;
  if (a.method == "linear") out.solver = fit::RotaryOptions::Solver::kLinear;
  if (a.method == "as-published") out.solver = fit::RotaryOptions::Solver::kAsPublished;
  if (a.curve == "fourier") out.curve = fit::RotaryCurve::kFourier;
  if (a.curve == "polynomial") out.curve = fit::RotaryCurve::kPolynomial;
  out.remove_outliers = !a.keep_outliers;
  return out;
}

core::Result<std::vector<RotaryFacts>> identify(const RotaryAxesArguments& arguments) {
  if (!arguments.place_mm.empty() && arguments.place_mm.size() != 3) {
    return core::fail(Code::kBadOption, "--at needs three numbers: X,Y,Z");
  }
  const auto axes = read_rotary_axes(arguments);
  if (!axes) return core::fail(axes.error());
  std::vector<RotaryFacts> out;
  for (const NamedAxis& axis : *axes) {
    auto study = fit::identify_rotary_axis(axis.measurement, options_of(arguments));
    if (!study) return core::fail(study.error().at(fmt::format("axis {}", axis.name)));
    RotaryFacts facts;
    facts.name = axis.name;
    facts.method = arguments.method;
    facts.place_mm = axis.measurement.axis.origin_mm;
    if (!arguments.place_mm.empty()) {
      facts.place_mm = {arguments.place_mm[0], arguments.place_mm[1], arguments.place_mm[2]};
    }
    auto model = fit::RotaryModel::of(study->table);
    if (model) {
      facts.model = *std::move(model);
    } else if (model.error().code == Code::kBadOption) {
      return core::fail(model.error().at(fmt::format("axis {}", axis.name)));
    } else {
      study->warnings.push_back(model.error());
    }
    facts.study = *std::move(study);
    out.push_back(std::move(facts));
  }
  return out;
}

}  // namespace

int rotary_axes(const RotaryAxesArguments& arguments) {
  const auto facts = identify(arguments);
  if (!facts) {
    print_error(facts.error());
    return kBadInput;
  }
  return answer(rotary_axes_json(*facts), arguments.json,
                [&] { return rotary_axes_table(*facts); });
}

}  // namespace rondure::app
