#include "plans/checks/record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/version.h"
#include "plans/schema/internal/plan_table.h"
#include "plans/schema/json_text.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::plans {
namespace {

using record::RunRecord;
using record::Shape;
using record::Strategy;
using record::Touch;

/// The fault in words; none for a valid record.
using Fault = std::optional<std::string>;

/// Permitted values of a setting.
struct SettingLimits {
  bool is_number = false;
  bool is_whole = false;
  NumberSpec range = {};
  std::vector<std::string_view> one_of = {};
  std::optional<double> otherwise = {};  ///< The default, which may lie outside the range.
};
using SettingTable = std::map<std::string, SettingLimits, std::less<>>;

/// Visitor of plan_table.h: collects every key with its limits, by the name that SettingList
/// writes.
class LimitList {
 public:
  LimitList(std::string path, SettingTable& table) : path_(std::move(path)), table_(table) {}

  template <class Text>
  void text(std::string_view key, const Text&, const TextSpec& spec) {
    add(key, {.one_of = spec.one_of});
  }
  template <record::Worded Enum>
  void text(std::string_view key, const Enum&, const TextSpec& spec) {
    add(key, {.one_of = spec_of_words<Enum>(spec).one_of});
  }
  template <record::Worded Enum>
  void text(std::string_view key, const std::optional<Enum>&, const TextSpec& spec) {
    text(key, Enum{}, spec);
  }
  void texts(std::string_view key, const std::vector<std::string>&, const TextSpec& spec) {
    add(key, {.one_of = spec.one_of});
  }
  void number(std::string_view key, double value, const NumberSpec& spec) {
    add(key, {.is_number = true, .range = spec, .otherwise = value});
  }
  void number(std::string_view key, const std::optional<double>&, const NumberSpec& spec) {
    add(key, {.is_number = true, .range = spec});
  }
  template <class Numbers>
  void numbers(std::string_view key, const Numbers&, const NumberSpec& spec) {
    add(key, {.is_number = true, .range = spec, .otherwise = 0.0});
  }
  template <class Whole>
  void whole(std::string_view key, Whole value, const NumberSpec& spec) {
    add(key, {.is_number = true,
              .is_whole = true,
              .range = spec,
              .otherwise = static_cast<double>(value)});
  }
  void passed_over(std::string_view, std::string_view) {}
  void influence(std::string_view key, const record::Influence&, const NumberSpec& spec) {
    inner<record::DeclaredInfluence>(key, spec);
  }
  template <class T>
  void object(std::string_view key, const T&, const GroupSpec&) {
    inner<T>(key);
  }
  template <class T>
  void object(std::string_view key, const std::optional<T>&, const GroupSpec&) {
    inner<T>(key);
  }
  template <class T>
  void list(std::string_view key, const std::vector<T>&, const GroupSpec&) {
    inner<T>(key);
  }

 private:
  void add(std::string_view key, SettingLimits limits) {
    table_.insert_or_assign(path_ + std::string(key), std::move(limits));
  }
  template <class T, class... Spec>
  void inner(std::string_view key, const Spec&... spec) {
    LimitList list(path_ + std::string(key) + "/", table_);
    T value{};
    describe(list, value, spec...);
  }

  std::string path_;
  SettingTable& table_;
};

template <class Section>
SettingTable table_of(const std::string& path = {}) {
  SettingTable out;
  LimitList list(path, out);
  Section section{};
  describe(list, section);
  return out;
}

/// Settings of the whole run.
SettingTable run_table() {
  SettingTable out = table_of<record::DecisionRuleTask>("decision_rule/");
  out.merge(table_of<record::UncertaintyTask>("uncertainty/"));
  out.merge(table_of<record::DeclaredUncertainty>("uncertainty/"));
  out.merge(table_of<record::EnvironmentSettings>("environment/"));
  out.merge(table_of<record::FixtureSettings>("fixture/"));
  out.merge(table_of<record::HeadSettings>("head/"));
  out.merge(table_of<record::QualificationSettings>("qualification/"));
  return out;
}

SettingTable surface_table() {
  SettingTable out = table_of<record::SamplingSettings>();
  out.merge(table_of<record::MergedPosesSettings>());
  out.merge(table_of<record::ExpansionSettings>());
  out.merge(table_of<record::SurfaceSettings>());
  out.merge(table_of<record::SourceSettings>("source/"));
  return out;
}

Fault fault_of(const record::Setting& setting, const SettingLimits& limits) {
  if (!limits.is_number) {
    if (setting.number) return fmt::format("is the number {:g}, a text is needed", *setting.number);
    const bool known =
        limits.one_of.empty() ||
        std::find(limits.one_of.begin(), limits.one_of.end(), setting.text) != limits.one_of.end();
    return known ? Fault() : fmt::format("says {}, which is not known", in_quotes(setting.text));
  }
  if (!setting.number) return "is a text, a number is needed";
  const double value = *setting.number;
  const NumberSpec& range = limits.range;
  if (limits.is_whole && value != std::floor(value)) {
    return fmt::format("is {:g}, a whole number is needed", value);
  }
  const bool high_enough = range.above ? value > range.at_least : value >= range.at_least;
  if ((high_enough && value <= range.at_most) || value == limits.otherwise) return {};
  return fmt::format("is {:g}, outside {:g}..{:g}", value, range.at_least, range.at_most);
}

/// @param strict  A setting that the table does not know is a fault.
Fault check_settings(std::span<const record::Setting> settings, const SettingTable& table,
                     bool strict) {
  for (const record::Setting& setting : settings) {
    const auto known = table.find(setting.name);
    if (known == table.end() && strict) {
      return fmt::format("setting {} is none of this run", in_quotes(setting.name));
    }
    if (known == table.end()) continue;
    if (auto fault = fault_of(setting, known->second)) {
      return fmt::format("setting {} {}", in_quotes(setting.name), *fault);
    }
  }
  return {};
}

/// Visitor of a task: the keys that a plan must give.
class RequiredKeys {
 public:
  explicit RequiredKeys(std::string path = {}) : path_(std::move(path)) {}

  template <class Text>
  void text(std::string_view key, const Text&, const TextSpec& spec) {
    if (spec.required) keys_.push_back(path_ + std::string(key));
  }
  template <class Number>
  void number(std::string_view key, const Number&, const NumberSpec& spec) {
    if (spec.required) keys_.push_back(path_ + std::string(key));
  }
  template <class Numbers>
  void numbers(std::string_view key, const Numbers& values, const NumberSpec& spec) {
    number(key, values, spec);
  }
  template <class Whole>
  void whole(std::string_view key, Whole value, const NumberSpec& spec) {
    number(key, value, spec);
  }
  template <class T>
  void object(std::string_view, const T&, const GroupSpec&) {}
  template <class T>
  void list(std::string_view key, const std::vector<T>&, const GroupSpec& spec) {
    if (!spec.required) return;
    RequiredKeys inner(path_ + std::string(key) + "/");
    T item{};
    describe(inner, item);
    for (std::string& name : inner.keys_) keys_.push_back(std::move(name));
  }

  [[nodiscard]] std::vector<std::string> take() { return std::move(keys_); }

 private:
  std::string path_;
  std::vector<std::string> keys_;
};

/// Checks that the settings of a task are there: in a run of this version all keys that it writes
/// whatever the plan says, in one of another version those that a plan must give.
template <class Task>
Fault check_needed(std::span<const record::Setting> settings, bool strict,
                   const std::string& path = {}) {
  RequiredKeys required(path);
  Task task{};
  describe(required, task);
  std::vector<std::string> needed = required.take();
  if (strict) {
    for (record::Setting& setting : record::settings_of_task(Task{}, path)) {
      needed.push_back(std::move(setting.name));
    }
  }
  for (const std::string& name : needed) {
    const bool there = std::any_of(settings.begin(), settings.end(),
                                   [&](const record::Setting& s) { return s.name == name; });
    if (!there) return fmt::format("setting \"{}\" is missing", name);
  }
  return {};
}

template <class Task>
Fault check_task(const record::Feature& feature, bool strict) {
  if (auto fault = check_needed<Task>(feature.settings, strict)) return fault;
  SettingTable table = table_of<Task>();
  table.merge(table_of<record::SourceSettings>("source/"));
  return check_settings(feature.settings, table, strict);
}

Fault check_feature_settings(const record::Feature& feature, bool strict) {
  switch (feature.shape) {
    case Shape::kSpindle:
      return check_task<record::SpindleTask>(feature, strict);
    case Shape::kWheel:
      return check_task<record::WheelTask>(feature, strict);
    case Shape::kContour:
      return check_task<record::ContourTask>(feature, strict);
    case Shape::kRotaryAxes:
      return check_task<record::RotaryTask>(feature, strict);
    case Shape::kFiveAxis:
      return check_task<record::FiveAxisTask>(feature, strict);
    case Shape::kCylinder:
    case Shape::kCircle:
    case Shape::kPlane:
    case Shape::kCone:
    case Shape::kSphere:
      break;
  }
  if (feature.strategy == Strategy::kMerged) {
    auto fault = check_needed<record::MergedPosesSettings>(feature.settings, strict);
    if (fault) return fault;
  }
  return check_settings(feature.settings, surface_table(), strict);
}

/// Checks that head and settings name one decision rule.
Fault check_rule(const RunRecord& record) {
  const auto task = record::task_of<record::DecisionRuleTask>(record.settings, "decision_rule/");
  if (!task) return task.error().what;
  if (name_of(task->rule) == record.header.decision_rule) return {};
  return fmt::format("the head names the decision rule {}, the settings {}",
                     in_quotes(record.header.decision_rule), in_quotes(name_of(task->rule)));
}

/// Checks the settings of the whole run.
Fault check_run_settings(std::span<const record::Setting> settings, bool strict) {
  const auto has = [&](std::string_view path) {
    return std::any_of(settings.begin(), settings.end(),
                       [&](const record::Setting& s) { return s.name.starts_with(path); });
  };
  Fault fault;
  if (strict) fault = check_needed<record::DecisionRuleTask>(settings, strict, "decision_rule/");
  if (!fault && has("uncertainty/")) {
    fault = check_needed<record::UncertaintyTask>(settings, strict, "uncertainty/");
  }
  if (!fault && has("fixture/")) {
    fault = check_needed<record::FixtureSettings>(settings, strict, "fixture/");
  }
  return fault ? fault : check_settings(settings, run_table(), strict);
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

Fault check_feature(const RunRecord& record, int index, bool strict) {
  const record::Feature& feature = record.features[static_cast<std::size_t>(index)];
  constexpr int kMostLayers = 10'000;
  constexpr int kMostPoints = 100'000;  // this times the number of layers does not overflow an int
  if (feature.layers < 0 || feature.layers > kMostLayers || feature.points_per_layer < 0 ||
      feature.points_per_layer > kMostPoints) {
    return fmt::format("{} layers of {} points are outside 0..{} and 0..{}", feature.layers,
                       feature.points_per_layer, kMostLayers, kMostPoints);
  }
  constexpr double kLeastStep_deg = 1e-6;
  constexpr double kGreatestStep_deg = 90.0;
  for (const double step_deg : feature.search_steps_deg) {
    if (step_deg >= kLeastStep_deg && step_deg <= kGreatestStep_deg) continue;
    return fmt::format("a search step of {:g} deg is outside {:g}..{:g}", step_deg, kLeastStep_deg,
                       kGreatestStep_deg);
  }
  constexpr int kGreatestOrder = 10'000;
  for (const record::Characteristic& characteristic : feature.characteristics) {
    for (const record::HarmonicLimit& line : characteristic.harmonic_limits) {
      if (line.first >= 0 && line.first <= line.last && line.last <= kGreatestOrder) continue;
      return fmt::format("a mask goes from order {} to {}; 0..{} are allowed", line.first,
                         line.last, kGreatestOrder);
    }
    if (characteristic.form == record::Form::kHarmonicLimits &&
        characteristic.harmonic_limits.empty()) {
      return fmt::format("characteristic {} has no mask", in_quotes(characteristic.id));
    }
    if (auto fault = check_settings(record::settings_of_task(characteristic.indication),
                                    table_of<record::Indication>(), true)) {
      return fmt::format("characteristic {}: {}", in_quotes(characteristic.id), *fault);
    }
  }
  const bool analysed = record::is_analysis(feature.shape);
  const Strategy own =
      feature.shape == Shape::kRotaryAxes ? Strategy::kStations : Strategy::kSeries;
  const bool for_analyses =
      feature.strategy == Strategy::kSeries || feature.strategy == Strategy::kStations;
  if (analysed ? feature.strategy != own : for_analyses) {
    return fmt::format("a {} is not measured by the strategy {}", record::name_of(feature.shape),
                       record::name_of(feature.strategy));
  }
  if (auto fault = check_feature_settings(feature, strict)) return fault;
  return check_series(record, index);
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

core::Result<void> refused(const std::string& place, const std::string& fault) {
  return core::fail_with(core::Code::kJournal,
                         "the journal does not hold what its evaluation asks for: {}: {}", place,
                         fault);
}

}  // namespace

core::Result<void> check_record(const record::ReadJournal& read) {
  const RunRecord& record = read.record;
  // Another version of the program may have had more keys, or fewer.
  const bool strict = record.header.version == core::kVersion;
  if (auto fault = check_run_settings(record.settings, strict)) {
    return refused("the run", *fault);
  }
  if (auto fault = strict ? check_rule(record) : Fault()) return refused("the run", *fault);
  for (std::size_t i = 0; i < record.features.size(); ++i) {
    if (auto fault = check_feature(record, static_cast<int>(i), strict)) {
      return refused("feature " + in_quotes(record.features[i].id), *fault);
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
