#include "plans/run/record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "core/result.h"
#include "core/version.h"
#include "plans/plan.h"
#include "plans/run/internal/run_head.h"
#include "plans/schema/json_text.h"
#include "plans/schema/key_spec.h"
#include "record/tasks/characteristic.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::plans {
namespace {

using record::RunRecord;
using record::Shape;
using record::Strategy;
using record::Touch;

/// The fault in words; none for a valid record.
using Fault = std::optional<std::string>;

core::Result<void> refused(const std::string& place, const std::string& fault) {
  return core::fail_with(core::Code::kJournal,
                         "the journal does not hold what its evaluation asks for: {}: {}", place,
                         fault);
}

using Settings = std::span<const record::Setting>;

std::string shown(const record::Setting& setting) {
  return setting.number ? fmt::format("{:g}", *setting.number) : in_quotes(setting.text);
}

/// Whether a setting is that of the plan. Another processor may have rounded a computed number the
/// other way.
bool alike(const record::Setting& a, const record::Setting& b) {
  if (!a.number || !b.number) return a.number == b.number && a.text == b.text;
  return std::abs(*a.number - *b.number) <= 1e-12 * std::max(1.0, std::abs(*b.number));
}

using KnownNames = std::set<std::string_view>;

KnownNames names_of(Settings settings) {
  KnownNames out;
  for (const record::Setting& setting : settings) out.insert(setting.name);
  return out;
}

/// Compares the settings that the run has taken down with those of its plan, in their order: an
/// item of a list begins where its first key recurs. Those of `later` are found out while the run
/// begins.
/// @param strict  Otherwise another version may have had more keys, or fewer.
Fault compare_settings(Settings found, Settings planned, std::span<const std::string_view> later,
                       bool strict) {
  const auto kept = [&](Settings settings, const KnownNames& known) {
    std::vector<const record::Setting*> out;
    for (const record::Setting& setting : settings) {
      const bool found_out = std::ranges::any_of(
          later, [&](std::string_view path) { return setting.name.starts_with(path); });
      if (!found_out && (strict || known.contains(setting.name))) out.push_back(&setting);
    }
    return out;
  };
  const auto here = kept(found, names_of(planned));
  const auto there = kept(planned, names_of(found));
  for (std::size_t i = 0; i < std::min(here.size(), there.size()); ++i) {
    const std::string name = in_quotes(there[i]->name);
    if (here[i]->name != there[i]->name) {
      return fmt::format("setting {} stands where its plan has {}", in_quotes(here[i]->name), name);
    }
    if (alike(*here[i], *there[i])) continue;
    return fmt::format("setting {} is {}, its plan says {}", name, shown(*here[i]),
                       shown(*there[i]));
  }
  if (here.size() > there.size()) {
    return fmt::format("setting {} is not of its plan", in_quotes(here[there.size()]->name));
  }
  if (here.size() == there.size()) return {};
  return fmt::format("setting {} of its plan is missing", in_quotes(there[here.size()]->name));
}

/// "limit is 20, its plan says 10", where they differ.
template <class Value>
Fault differ(const char* what, const Value& found, const Value& planned) {
  if (found == planned) return {};
  const auto words = [](const Value& value) {
    if constexpr (record::Worded<Value>) {
      return std::string(name_of(value));
    } else if constexpr (std::is_same_v<Value, std::string>) {
      return in_quotes(value);
    } else if constexpr (requires { value.has_value(); }) {
      return value ? fmt::format("{:g}", *value) : std::string("none");
    } else {
      return fmt::format("{}", value);
    }
  };
  return fmt::format("{} is {}, its plan says {}", what, words(found), words(planned));
}

/// The first fault.
Fault first(std::initializer_list<Fault> faults) {
  for (const Fault& fault : faults) {
    if (fault) return fault;
  }
  return {};
}

Fault compare_masks(const record::Characteristic& found, const record::Characteristic& planned) {
  const auto same = [](const record::HarmonicLimit& a, const record::HarmonicLimit& b) {
    return a.first == b.first && a.last == b.last && a.amplitude_mm == b.amplitude_mm;
  };
  if (std::ranges::equal(found.harmonic_limits, planned.harmonic_limits, same)) return {};
  return "its mask is not that of its plan";
}

Fault compare_characteristics(const record::Characteristic& found,
                              const record::Characteristic& planned, bool strict) {
  return first({differ("the form", found.form, planned.form),
                differ("the reference", found.reference, planned.reference),
                differ("the upper limit in mm", found.tolerance_mm, planned.tolerance_mm),
                differ("the lower limit in mm", found.lower_mm, planned.lower_mm),
                differ("the drawing zone", found.drawing_zone, planned.drawing_zone),
                compare_masks(found, planned),
                compare_settings(record::settings_of_task(found.indication),
                                 record::settings_of_task(planned.indication), {}, strict)});
}

Fault compare_features(const record::Feature& found, const record::Feature& planned, bool strict) {
  constexpr std::array<std::string_view, 1> kLater = {"source/read"};
  const bool of_file = planned.strategy == Strategy::kPointsFile;  // layers as the file has them
  if (auto fault =
          first({differ("the shape", found.shape, planned.shape),
                 differ("the side", found.side, planned.side),
                 differ("the nominal diameter in mm", found.nominal_diameter_mm,
                        planned.nominal_diameter_mm),
                 differ("the strategy", found.strategy, planned.strategy),
                 of_file ? Fault() : differ("the number of layers", found.layers, planned.layers),
                 of_file ? Fault()
                         : differ("the number of points of a layer", found.points_per_layer,
                                  planned.points_per_layer),
                 differ("the data file", found.points_file, planned.points_file),
                 differ("the tip radius in mm", found.tip_radius_mm, planned.tip_radius_mm),
                 compare_settings(found.settings, planned.settings, kLater, strict)})) {
    return fault;
  }
  if (found.search_steps_deg != planned.search_steps_deg) {
    return "the steps of its search are not those of its plan";
  }
  for (std::size_t i = 0; i < planned.characteristics.size(); ++i) {
    const record::Characteristic& asked = planned.characteristics[i];
    if (i == found.characteristics.size() || found.characteristics[i].id != asked.id) {
      return fmt::format("characteristic {} of its plan is missing", in_quotes(asked.id));
    }
    if (auto fault = compare_characteristics(found.characteristics[i], asked, strict)) {
      return fmt::format("characteristic {}: {}", in_quotes(asked.id), *fault);
    }
  }
  if (found.characteristics.size() == planned.characteristics.size()) return {};
  return fmt::format("characteristic {} is not of its plan",
                     in_quotes(found.characteristics[planned.characteristics.size()].id));
}

/// What the run takes down of itself, beside what its plan says.
Fault check_own_settings(Settings settings) {
  const auto has = [&](std::string_view path) {
    return std::ranges::any_of(settings,
                               [&](const record::Setting& s) { return s.name.starts_with(path); });
  };
  if (!has("fixture/")) return {};
  const auto fixture = record::task_of<record::FixtureSettings>(settings, "fixture/");
  return fixture ? Fault() : fixture.error().what;
}

/// Compares the head of a journal with that of its plan.
core::Result<void> compare_heads(const RunRecord& found, const RunRecord& planned, bool strict) {
  constexpr std::array<std::string_view, 2> kLater = {"fixture/", "head/"};
  const record::Header& head = found.header;
  const record::Header& asked = planned.header;
  const record::Artefact& ball = planned.artefact;
  if (auto fault = first(
          {differ("the digest of the plan", head.plan_sha256, asked.plan_sha256),
           differ("the name of the plan", head.plan_name, asked.plan_name),
           differ("the revision", head.plan_revision, asked.plan_revision),
           differ("the part", head.part_id, asked.part_id),
           differ("the name of the part", head.part_name, asked.part_name),
           differ("the drawing", head.drawing, asked.drawing),
           differ("the decision rule", head.decision_rule, asked.decision_rule),
           differ("the lowest temperature", head.temperature_min_degC, asked.temperature_min_degC),
           differ("the highest temperature", head.temperature_max_degC, asked.temperature_max_degC),
           differ("the radius of the reference", found.artefact.radius_mm, ball.radius_mm),
           differ("the nominal tip radius", found.artefact.nominal_tip_radius_mm,
                  ball.nominal_tip_radius_mm),
           differ("the limit of the tip radius", found.artefact.radius_tolerance_mm,
                  ball.radius_tolerance_mm),
           differ("the limit of the probing form", found.artefact.form_limit_mm,
                  ball.form_limit_mm),
           compare_settings(found.settings, planned.settings, kLater, strict),
           check_own_settings(found.settings)})) {
    return refused("the run", *fault);
  }
  for (std::size_t i = 0; i < planned.features.size(); ++i) {
    const record::Feature& feature = planned.features[i];
    if (i == found.features.size() || found.features[i].id != feature.id) {
      return refused("feature " + in_quotes(feature.id), "it is missing");
    }
    if (auto fault = compare_features(found.features[i], feature, strict)) {
      return refused("feature " + in_quotes(feature.id), *fault);
    }
  }
  if (found.features.size() == planned.features.size()) return {};
  return refused("feature " + in_quotes(found.features[planned.features.size()].id),
                 "it is not of the plan");
}

/// Columns that the evaluation of a series reads, with the name of the series.
struct WantedSeries {
  Shape shape;
  std::string_view name;  ///< For a contour, without the number of the part.
  std::array<std::string_view, 7> columns;
};
constexpr std::array<WantedSeries, 7> kWantedSeries = {
    {{Shape::kSpindle, "data", {"alpha_deg", "H1_um", "H2_um", "H3_um"}},
     {Shape::kWheel, "data", {"x", "z"}},
     {Shape::kFiveAxis, "data", {"step", "c_deg", "a_deg", "setup", "dx_um", "dy_um", "dz_um"}},
     {Shape::kContour, "axes", {"c_deg", "c_error_deg", "x_error_mm"}},
     {Shape::kContour, "pin", {"angle_deg", "deviation_um"}},
     {Shape::kContour, "main", {"angle_deg", "deviation_um"}},
     {Shape::kContour, "table", {"c_deg", "x_um"}}}};

/// The number of the part in the name of a contour's series, from 1; 0 if there is none.
std::size_t part_number(std::string_view name, std::string_view stem) {
  constexpr std::size_t kMostParts = kMaxListItems;
  for (std::size_t part = 1; part <= kMostParts; ++part) {
    if (name == fmt::format("{} {}", stem, part)) return part;
  }
  return 0;
}

Fault check_one_series(const record::Series& series, const record::Feature& feature) {
  const auto wanted =
      std::find_if(kWantedSeries.begin(), kWantedSeries.end(), [&](const WantedSeries& w) {
        if (w.shape != feature.shape) return false;
        return series.name == w.name
                   ? w.shape != Shape::kContour || series.name == "table"
                   : w.shape == Shape::kContour && part_number(series.name, w.name) > 0;
      });
  const std::string name = in_quotes(series.name);
  if (wanted == kWantedSeries.end()) {
    return fmt::format("series {} is none of a {}", name, record::name_of(feature.shape));
  }
  for (const std::string_view column : wanted->columns) {
    if (!column.empty() && !series.column(column)) {
      return fmt::format("series {} has no column {}", name, column);
    }
  }
  return {};
}

/// What every part of a contour has: traces of the axes, or else a main journal.
std::array<const char*, 2> needed_of_part(const record::Feature& feature) {
  const auto task = record::task_of<record::ContourTask>(feature.settings);
  if (!task) return {"axes", "pin"};  // the evaluation says what is wrong
  const bool traced =
      task->parts.empty()
          ? task->separation != record::ContourTask::Separation::kIndirect
          : std::ranges::any_of(task->parts, [](const auto& part) { return !part.axes.empty(); });
  return {traced ? "axes" : "main", "pin"};
}

/// Checks that the parts of a contour count from 1 and that each has what it needs.
Fault check_parts(const RunRecord& record, int index) {
  const auto all_needed = needed_of_part(record.features[static_cast<std::size_t>(index)]);
  for (const char* stem : {"axes", "pin", "main"}) {
    for (const record::Series& series : record.series) {
      if (series.feature != index || series.role != record::Series::Role::kData) continue;
      const std::size_t part = part_number(series.name, stem);
      for (std::size_t k = 1; k <= part; ++k) {
        for (const char* needed : all_needed) {
          const std::string name = fmt::format("{} {}", needed, k);
          if (record.data_of(index, name) == nullptr) {
            return fmt::format("series \"{}\" is missing, \"{}\" is there", name, series.name);
          }
        }
      }
    }
  }
  return {};
}

Fault check_series(const RunRecord& record, int index) {
  const record::Feature& feature = record.features[static_cast<std::size_t>(index)];
  std::vector<std::string_view> names;
  for (const record::Series& series : record.series) {
    if (series.feature != index || series.role != record::Series::Role::kData) continue;
    if (auto fault = check_one_series(series, feature)) return fault;
    if (std::find(names.begin(), names.end(), series.name) != names.end()) {
      return fmt::format("series {} is there twice", in_quotes(series.name));
    }
    names.emplace_back(series.name);
  }
  const bool of_series = record::is_analysis(feature.shape) && feature.shape != Shape::kRotaryAxes;
  if (of_series && names.empty() && record.ending == "finished") {
    return "the run is finished and its series are missing";
  }
  return feature.shape == Shape::kContour ? check_parts(record, index) : Fault();
}

/// Checks the layers that a points file was found to have.
Fault check_layers(const record::Feature& feature) {
  constexpr int kMostLayers = 10'000;
  constexpr int kMostPoints = 100'000;  // this times the number of layers does not overflow an int
  if (feature.layers >= 0 && feature.layers <= kMostLayers && feature.points_per_layer >= 0 &&
      feature.points_per_layer <= kMostPoints)
    return {};
  return fmt::format("{} layers of {} points are outside 0..{} and 0..{}", feature.layers,
                     feature.points_per_layer, kMostLayers, kMostPoints);
}

/// How many layers the touches of a feature may count; balls of a calibration are its layers.
std::int64_t layers_of(const record::Feature& feature) {
  if (feature.strategy == Strategy::kPointsFile) return std::numeric_limits<std::int64_t>::max();
  if (feature.strategy != Strategy::kStations) return feature.layers;
  const auto task = record::task_of<record::RotaryTask>(feature.settings);
  return task ? static_cast<std::int64_t>(task->balls.size()) : 0;
}

/// A feature by its index, and how many layers it has.
struct PoseOwner {
  int feature = 0;
  std::int64_t layers = 0;
};

Fault check_touch(const Touch& touch, const RunRecord& record,
                  const std::map<int, PoseOwner>& owner_of_pose) {
  constexpr int kGreatestIndex = 100'000'000;
  for (const int index : {touch.layer, touch.point, touch.repeat}) {
    if (index >= 0 && index <= kGreatestIndex) continue;
    return fmt::format("layer {}, point {}, repeat {} are outside 0..{}", touch.layer, touch.point,
                       touch.repeat, kGreatestIndex);
  }
  const auto pose = owner_of_pose.find(touch.pose);
  if (touch.pose != -1 && pose == owner_of_pose.end()) {
    return fmt::format("pose {} is not there", touch.pose);
  }
  constexpr double kUnit = 1e-6;  // a direction in doubles is a unit vector to some 1e-16
  const double length = touch.approach.norm();
  const bool of_file = pose != owner_of_pose.end() &&
                       record.features[static_cast<std::size_t>(pose->second.feature)].strategy ==
                           Strategy::kPointsFile;
  if (std::abs(length - 1.0) > kUnit && !(of_file && length == 0.0)) {
    return fmt::format("its direction has the length {:g}, not 1", length);
  }
  if (touch.purpose != Touch::Purpose::kMeasure) return {};
  if (pose == owner_of_pose.end()) return "it was measured in no pose";
  const std::int64_t layers = pose->second.layers;
  if (touch.layer < layers) return {};
  return fmt::format("layer {} is none of its feature, which has {}", touch.layer, layers);
}

}  // namespace

core::Result<void> check_record(const record::ReadJournal& read) {
  const RunRecord& record = read.record;
  TRY(const auto plan, recorded_plan(record.header.plan_text));
  const bool strict = record.header.version == core::kVersion;
  TRY_DO(compare_heads(record, run_head(plan, {}, record.header.seed), strict));
  for (std::size_t i = 0; i < record.features.size(); ++i) {
    const record::Feature& feature = record.features[i];
    if (auto fault = first({check_layers(feature), check_series(record, static_cast<int>(i))})) {
      return refused("feature " + in_quotes(feature.id), *fault);
    }
  }
  std::vector<std::int64_t> layers;
  for (const record::Feature& feature : record.features) layers.push_back(layers_of(feature));
  std::map<int, PoseOwner> owner_of_pose;
  for (const record::PoseVisit& pose : record.poses) {
    owner_of_pose[pose.id] = {pose.feature, layers[static_cast<std::size_t>(pose.feature)]};
  }
  for (const Touch& touch : record.touches) {
    if (auto fault = check_touch(touch, record, owner_of_pose)) {
      return refused(fmt::format("touch {}", touch.id), *fault);
    }
  }
  return {};
}

}  // namespace rondure::plans
