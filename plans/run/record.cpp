#include "plans/run/record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/result.h"
#include "core/units.h"
#include "core/version.h"
#include "plans/checks/internal/calibration_use.h"
#include "plans/key_spec.h"
#include "plans/plan.h"
#include "plans/run/internal/run_head.h"
#include "plans/schema/json_text.h"
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

/// What was asked of the part, as a list: by name, and each a number or a text. Names with a blank
/// are those of this list, others those of settings, which versions may differ in.
using List = std::vector<record::Setting>;

void add(const char* name, const std::string& text, List& out) {
  out.push_back({name, std::nullopt, text});
}
void add(const char* name, std::optional<double> number, List& out) {
  if (number) out.push_back({name, number, {}});
}
void add(std::span<const record::Setting> settings, List& out) {
  out.insert(out.end(), settings.begin(), settings.end());
}

List asked_of(const record::Characteristic& c) {
  List out;
  add("the characteristic", c.id, out);
  add("the form", std::string(name_of(c.form)), out);
  add("the reference", std::string(name_of(c.reference)), out);
  add("the upper limit in mm", c.tolerance_mm, out);
  add("the lower limit in mm", c.lower_mm, out);
  add("the drawing zone", c.drawing_zone, out);
  for (const record::HarmonicLimit& limit : c.harmonic_limits) {
    add("the mask from order", limit.first, out);
    add("the mask to order", limit.last, out);
    add("the mask in mm", limit.amplitude_mm, out);
  }
  add(record::settings_of_task(c.indication), out);
  return out;
}

/// @param of_file  The file says how many layers there are.
List asked_of(const record::Feature& f, bool of_file) {
  List out;
  add("the feature", f.id, out);
  add("the shape", std::string(name_of(f.shape)), out);
  add("the side", std::string(name_of(f.side)), out);
  add("the nominal diameter in mm", f.nominal_diameter_mm, out);
  add("the strategy", std::string(name_of(f.strategy)), out);
  if (!of_file) add("the number of layers", f.layers, out);
  if (!of_file) add("the points of a layer", f.points_per_layer, out);
  for (const double step_deg : f.search_steps_deg) add("the search step in deg", step_deg, out);
  add("the data file", f.points_file, out);
  add("the tip radius in mm", f.tip_radius_mm, out);
  for (const record::Characteristic& c : f.characteristics) add(asked_of(c), out);
  add(f.settings, out);
  return out;
}

List asked_of_run(const RunRecord& run) {
  const record::Header& h = run.header;
  List out;
  add("the SHA-256 of the plan", h.plan_sha256, out);
  add("the name of the plan", h.plan_name, out);
  add("the revision", h.plan_revision, out);
  add("the part", h.part_id, out);
  add("the name of the part", h.part_name, out);
  add("the drawing", h.drawing, out);
  add("the decision rule", h.decision_rule, out);
  add("the lowest temperature", h.temperature_min_degC, out);
  add("the highest temperature", h.temperature_max_degC, out);
  add("the radius of the artefact in mm", run.artefact.radius_mm, out);
  add("the nominal tip radius in mm", run.artefact.nominal_tip_radius_mm, out);
  add("the limit of the tip radius in mm", run.artefact.radius_tolerance_mm, out);
  add("the limit of the probing form in mm", run.artefact.form_limit_mm, out);
  add(run.settings, out);
  return out;
}

std::string shown(const record::Setting& setting) {
  return setting.number ? fmt::format("{:g}", *setting.number) : in_quotes(setting.text);
}

/// Another processor may have rounded a computed number the other way.
bool agree(const record::Setting& a, const record::Setting& b) {
  if (!a.number || !b.number) return a.number == b.number && a.text == b.text;
  return std::abs(*a.number - *b.number) <= 1e-12 * std::max(1.0, std::abs(*b.number));
}

/// Of a list what the other one knows too.
List compared(const List& of, const List& other, bool strict) {
  std::set<std::string_view> known;
  for (const record::Setting& setting : other) known.insert(setting.name);
  List out;
  std::ranges::copy_if(of, std::back_inserter(out), [&](const record::Setting& setting) {
    const bool of_list = setting.name.find(' ') != std::string::npos;
    return strict || of_list || known.contains(setting.name);
  });
  return out;
}

/// Compares two lists, in their order: an item of a list begins where its first key recurs.
/// @param strict  Otherwise another version may have had more keys, or fewer.
Fault compare(const List& found, const List& planned, bool strict) {
  const List here = compared(found, planned, strict);
  const List there = compared(planned, found, strict);
  for (std::size_t i = 0; i < std::min(here.size(), there.size()); ++i) {
    const std::string name = in_quotes(there[i].name);
    if (here[i].name != there[i].name) {
      return fmt::format("{} stands where its plan has {}", in_quotes(here[i].name), name);
    }
    if (agree(here[i], there[i])) continue;
    return fmt::format("{} is {}, its plan says {}", name, shown(here[i]), shown(there[i]));
  }
  if (here.size() == there.size()) return {};
  return here.size() > there.size()
             ? fmt::format("{} is not of its plan", in_quotes(here[there.size()].name))
             : fmt::format("{} of its plan is missing", in_quotes(there[here.size()].name));
}

/// Adds to the head of a plan what a run finds out while it begins: the bytes of a calibration and
/// of bodies, the resolution of a driver, the laboratory, how a file was read.
/// @return kMeaning names a setting that is none of these.
core::Result<void> add_found(const RunRecord& found, const Plan& plan, RunRecord& planned) {
  TRY(const auto fixture, record::task_of<record::FixtureSettings>(found.settings, "fixture/"));
  std::optional<UsedCalibration> calibration;
  const bool of_file = plan.fixture && plan.fixture->calibration &&
                       plan.fixture->calibration->feature.empty();  // else a feature finds it
  if (of_file && fixture.calibration) calibration.emplace().text = *fixture.calibration;
  std::optional<double> resolution_rad;
  if (fixture.resolution_deg) resolution_rad = *fixture.resolution_deg * core::kDegree;
  for (record::Setting& setting : fixture_settings(plan, calibration, resolution_rad)) {
    if (setting.name == "fixture/bodies") setting.text = fixture.bodies.value_or("");
    planned.settings.push_back(std::move(setting));
  }
  TRY(auto head, record::task_of<record::HeadSettings>(found.settings, "head/"));
  add(record::settings_of_task(std::move(head), "head/"), planned.settings);
  for (std::size_t i = 0; i < std::min(found.features.size(), planned.features.size()); ++i) {
    TRY(auto source,
        record::task_of<record::SourceSettings>(found.features[i].settings, "source/"));
    record::SourceSettings read;
    read.read = std::move(source.read);
    read.repeated = source.repeated;
    add(record::settings_of_task(std::move(read), "source/"), planned.features[i].settings);
  }
  return {};
}

/// A plan with the poses that a run read of their files.
core::Result<Plan> with_found_poses(const RunRecord& found, Plan plan) {
  for (std::size_t i = 0; i < std::min(found.features.size(), plan.features.size()); ++i) {
    auto& head = plan.features[i].five_axis;
    if (!head || head->poses.empty()) continue;
    TRY(const auto read, record::task_of<record::FiveAxisTask>(found.features[i].settings));
    head->c_stations_deg = read.c_stations_deg;
    head->a_stations_deg = read.a_stations_deg;
    head->verification = read.verification;
  }
  return plan;
}

/// Compares the head of a journal with that of its plan.
core::Result<void> compare_heads(const RunRecord& found, const Plan& asked, bool strict) {
  const auto completed = with_found_poses(found, asked);
  if (!completed) return refused("the run", completed.error().what);
  const Plan& plan = *completed;
  RunRecord planned = run_head(plan, {}, found.header.seed);
  if (const auto known = add_found(found, plan, planned); !known) {
    return refused("the run", known.error().what);
  }
  if (auto fault = compare(asked_of_run(found), asked_of_run(planned), strict)) {
    return refused("the run", *fault);
  }
  if (found.features.size() != planned.features.size()) {
    return refused("the run", fmt::format("it has {} features, its plan {}", found.features.size(),
                                          planned.features.size()));
  }
  for (std::size_t i = 0; i < planned.features.size(); ++i) {
    const bool of_file = planned.features[i].strategy == Strategy::kPointsFile;
    if (auto fault = compare(asked_of(found.features[i], of_file),
                             asked_of(planned.features[i], of_file), strict)) {
      return refused("feature " + in_quotes(found.features[i].id), *fault);
    }
  }
  return {};
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
  TRY_DO(compare_heads(record, plan, strict));
  for (std::size_t i = 0; i < record.features.size(); ++i) {
    const record::Feature& feature = record.features[i];
    auto fault = check_layers(feature);
    if (!fault) fault = check_series(record, static_cast<int>(i));
    if (fault) return refused("feature " + in_quotes(feature.id), *fault);
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
