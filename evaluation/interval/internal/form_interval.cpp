#include "evaluation/interval/internal/form_interval.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "evaluation/results/internal/deviation.h"
#include "evaluation/results/measured_cloud.h"
#include "record/tasks/uncertainty.h"

namespace rondure::evaluation {
namespace {

/// Rows of the cloud that a characteristic is evaluated from.
struct Rows {
  FormKind kind = FormKind::kCylindricity;
  std::vector<std::size_t> rows;
  std::vector<std::size_t> counts = {};  ///< Of kSections: rows of each section.
};

/// Of many or dense sections those that read most take part: the others hardly ever hold the
/// greatest value, and all sections together would take as long as the whole surface.
constexpr std::size_t kMostSections = 32;
constexpr std::size_t kMostInSections = 2000;

/// The sections that may hold the greatest value. It is that of the surface, whichever section
/// noise lets read most: an interval of that section alone would be too high.
Rows rows_of_sections(const FeatureResult& result, record::Reference reference) {
  std::vector<std::pair<double, const LayerResult*>> read;
  for (const LayerResult& layer : result.layers) {
    const auto section = section_deviation(layer, reference);
    if (!section) return {FormKind::kRoundness, {}};
    read.emplace_back(section->value_mm, &layer);
  }
  std::stable_sort(read.begin(), read.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::size_t points = 0;
  std::size_t kept = 0;
  for (; kept < std::min(read.size(), kMostSections); ++kept) {
    points += read[kept].second->rows.size();
    if (kept > 0 && points > kMostInSections) break;
  }
  read.resize(kept);
  std::sort(read.begin(), read.end(),
            [](const auto& a, const auto& b) { return a.second < b.second; });
  Rows out{kept > 1 ? FormKind::kSections : FormKind::kRoundness, {}};
  for (const auto& [value_mm, layer] : read) {
    out.rows.insert(out.rows.end(), layer->rows.begin(), layer->rows.end());
    out.counts.push_back(layer->rows.size());
  }
  return out;
}

Rows rows_of(const FeatureResult& result, const record::Characteristic& asked) {
  Rows out;
  if (asked.form == record::Form::kRoundness) {
    return rows_of_sections(result, asked.reference);
  }
  for (std::size_t i = 0; i < result.cloud.size(); ++i) out.rows.push_back(i);
  return out;
}

/// Hands on in which pose each point was touched, and where the part then was.
void take_poses(const FeatureResult& result, const Rows& rows, FormCloud& cloud) {
  cloud.frames = result.merged->frames;
  std::map<int, std::pair<std::size_t, std::set<int>>> layers;  // points and targets of each
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    const CloudPoint& point = result.cloud[rows.rows[i]];
    cloud.points[i].pose = point.pose;
    auto& [points, targets] = layers[point.layer];
    ++points;
    targets.insert(point.point);
  }
  // A target that several poses reach is one place of the form.
  for (const auto& [layer, found] : layers) {
    const auto targets = found.second.size();
    cloud.passes = std::max(cloud.passes, static_cast<int>((found.first + targets - 1) / targets));
  }
}

core::Result<FormCloud> cloud_of(const FeatureResult& result, const Rows& rows) {
  std::vector<Eigen::Vector3d> tips;
  for (const std::size_t row : rows.rows) tips.push_back(result.cloud[row].tip_mm);
  std::optional<Eigen::Vector3d> direction;
  if (result.ls_cylinder) direction = result.ls_cylinder->axis.direction;
  if (result.mz_cylinder) direction = result.mz_cylinder->axis.direction;
  if (result.feature.shape == record::Shape::kCircle) direction = result.section_axis.direction;
  auto cloud = core::Result<FormCloud>();
  if (rows.kind == FormKind::kSections) {
    std::vector<std::vector<Eigen::Vector3d>> sections;
    for (auto tip = tips.begin(); const std::size_t count : rows.counts) {
      const auto end = tip + static_cast<std::ptrdiff_t>(count);
      sections.emplace_back(tip, end);
      tip = end;
    }
    cloud = sections_cloud(sections, direction.value_or(Eigen::Vector3d::UnitZ()));
  } else {
    cloud = form_cloud(rows.kind, tips, direction);
  }
  if (!cloud) return cloud;
  cloud->outside = result.feature.side == record::Side::kOutside;
  cloud->passes = passes_of(result.cloud);
  if (result.merged) take_poses(result, rows, *cloud);
  const bool touched = result.feature.strategy != record::Strategy::kPointsFile;
  const auto [first, last] = std::minmax_element(
      result.cloud.begin(), result.cloud.end(),
      [](const CloudPoint& a, const CloudPoint& b) { return a.time_s < b.time_s; });
  const double span_s = last->time_s - first->time_s;
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    const CloudPoint& point = result.cloud[rows.rows[i]];
    cloud->points[i].repeats = point.repeats;
    if (!touched) continue;
    cloud->points[i].time_1 = span_s > 0.0 ? (point.time_s - first->time_s) / span_s : 0.0;
  }
  return cloud;
}

/// Why the plan of a run lets nothing be stated; nothing where it declares influences.
std::optional<core::Phrase> why_undeclared(const record::RunRecord& record) {
  const auto recorded = record::recorded_uncertainty(record.settings);
  if (!recorded) return recorded.error().said();
  if (!*recorded) return core::phrase("the plan declares no uncertainty");
  return std::nullopt;
}

/// Why the poses of a merged cloud allow no interval; nothing where their errors can be drawn.
std::optional<core::Phrase> why_no_poses(const MergedPoses& merged, const Influences& declared) {
  if (merged.joint) {
    return core::phrase(
        "the cloud is merged from several poses whose errors were solved for: no interval is "
        "computed; what the fixture leaves in the value is told beside it");
  }
  if (declared.fixture || declared.calibration) return std::nullopt;
  return core::phrase(
      "the cloud is merged from several poses and nothing is known of their errors: use a "
      "calibration of the fixture (fixture.calibration) or declare uncertainty.fixture");
}

}  // namespace

core::Result<std::optional<FormSpectrum>> spectrum_on(const FormCloud& cloud,
                                                      const Declared& declared) {
  if (!declared.spectrum) return std::optional<FormSpectrum>();
  FormSpectrum out = *declared.spectrum;
  if (out.terms.empty()) return std::optional<FormSpectrum>(std::move(out));
  if (cloud.kind == FormKind::kRoundness) {
    std::erase_if(out.terms, [](const FormTerm& term) { return term.degree > 0; });
    if (out.terms.empty()) return std::optional<FormSpectrum>();
    return std::optional<FormSpectrum>(std::move(out));
  }
  const auto [low, high] = std::minmax_element(
      cloud.points.begin(), cloud.points.end(),
      [](const FormPoint& a, const FormPoint& b) { return a.height_mm < b.height_mm; });
  out.low_mm = low->height_mm;
  out.high_mm = high->height_mm;
  return std::optional<FormSpectrum>(std::move(out));
}

std::optional<core::Phrase> why_no_interval(const record::RunRecord& record,
                                            const record::Feature& feature) {
  if (auto why = why_undeclared(record)) return why;
  // The trials of a part move points in the machine frame; a merged cloud stands in that of the
  // part.
  if (feature.strategy == record::Strategy::kMerged) {
    return core::phrase(
        "of a cloud merged from several poses only the run states an interval, and only of "
        "unfiltered cylindricity and roundness");
  }
  return std::nullopt;
}

std::optional<core::Phrase> too_many_points(std::size_t points) {
  constexpr std::size_t kMostPoints = 20'000;  // about 10 s of trials; verify repeats them
  if (points <= kMostPoints) return std::nullopt;
  return core::phrase("{} points are more than {}, the limit of the trials; give every n-th point",
                      points, kMostPoints);
}

tl::expected<UncertaintyQuestion, core::Phrase> uncertainty_question(
    const record::RunRecord& record, const FeatureResult& result,
    const std::optional<fit::ProbeTip>& probe, const record::Characteristic& asked) {
  const auto none = [](core::Phrase why) { return tl::unexpected(std::move(why)); };
  if (auto why = why_undeclared(record)) return none(*std::move(why));
  const auto declared = declared_for(record, result, probe);
  if (result.merged) {
    if (auto why = why_no_poses(*result.merged, declared->influences)) return none(*std::move(why));
  }
  const Rows rows = rows_of(result, asked);
  if (auto why = too_many_points(rows.rows.size())) return none(*std::move(why));
  auto cloud = cloud_of(result, rows);
  if (!cloud) return none(cloud.error().said());
  cloud->reference = asked.reference;
  auto spectrum = spectrum_on(*cloud, *declared);
  if (!spectrum) return none(spectrum.error().said());
  return UncertaintyQuestion{*std::move(cloud), declared->influences, *std::move(spectrum),
                             declared->options};
}

UncertaintyStatus uncertainty_of(const record::RunRecord& record, const FeatureResult& result,
                                 const std::optional<fit::ProbeTip>& probe,
                                 const record::Characteristic& asked) {
  const auto question = uncertainty_question(record, result, probe, asked);
  if (!question) return UncertaintyStatus::none(question.error());
  auto found = measurement_uncertainty(question->cloud, question->influences, question->spectrum,
                                       question->options);
  if (!found) return UncertaintyStatus::none(found.error().said());
  return UncertaintyStatus::stated(*std::move(found), question->options.coverage);
}

}  // namespace rondure::evaluation
