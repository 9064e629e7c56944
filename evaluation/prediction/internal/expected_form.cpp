#include "evaluation/prediction/internal/expected_form.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "evaluation/interval/internal/form_interval.h"
#include "evaluation/results/internal/deviation.h"
#include "evaluation/results/measured_cloud.h"
#include "evaluation/uncertainty/internal/error_modes.h"
#include "evaluation/uncertainty/internal/form_value.h"

namespace rondure::evaluation {
namespace {

constexpr double kShareOfTolerance = 0.5;
constexpr double kTimesPointError = 10.0;  // where there is no tolerance
constexpr double kLeastForm_mm = 1e-3;     // where there is no error either
constexpr int kScalingParts = 32;

/// The places of the final cloud of a feature, with their repeats, by layer and point as in the
/// evaluation.
std::vector<CloudPoint> places_of(const record::RunRecord& record, int feature) {
  std::map<std::pair<int, int>, CloudPoint> places;
  for (const record::Touch& touch : record.touches) {
    if (touch.pose < 0) continue;
    const auto& pose = record.poses[static_cast<std::size_t>(touch.pose)];
    if (pose.feature != feature || !pose.final_cloud) continue;
    auto [found, fresh] = places.try_emplace({touch.layer, touch.point});
    CloudPoint& place = found->second;
    place.layer = touch.layer;
    place.point = touch.point;
    place.repeats = fresh ? 1 : place.repeats + 1;
    place.tip_mm = touch.tip_mm;
    place.time_s += (touch.time_s - place.time_s) / place.repeats;
  }
  std::vector<CloudPoint> out;
  for (const auto& [key, place] : places) out.push_back(place);
  return out;
}

/// The sections of a simulated cloud about the requested reference.
std::vector<LayerResult> layers_of(const FormCloud& cloud, const std::vector<CloudPoint>& points,
                                   record::Reference reference) {
  std::map<int, std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < points.size(); ++i) rows[points[i].layer].push_back(i);
  std::vector<LayerResult> out;
  for (auto& [layer, of_layer] : rows) {
    std::vector<Eigen::Vector2d> section;
    for (const std::size_t i : of_layer) {
      const FormPoint& p = cloud.points[i];
      section.push_back((cloud.radius_mm + p.deviation_mm) *
                        Eigen::Vector2d(std::cos(p.angle_rad), std::sin(p.angle_rad)));
    }
    LayerResult result{layer, 0.0, std::move(of_layer), fit::min_zone_circle(section),
                       fit::ls_circle(section)};
    using record::Reference;
    if (reference == Reference::kMinimumCircumscribed) {
      result.mc = fit::min_circumscribed_circle(section);
    }
    if (reference == Reference::kMaximumInscribed)
      result.mi = fit::max_inscribed_circle(section, {.global = false, .search = {}});
    result.points_mm = std::move(section);
    out.push_back(std::move(result));
  }
  return out;
}

/// Form value about the reference of the cloud.
double form_mm(const FormCloud& cloud) {
  Eigen::VectorXd deviations(static_cast<Eigen::Index>(cloud.points.size()));
  for (Eigen::Index i = 0; i < deviations.size(); ++i) {
    deviations[i] = cloud.points[static_cast<std::size_t>(i)].deviation_mm;
  }
  return FormValue(cloud, cloud.points).of(deviations);
}

/// A generic form: undulations whose amplitude falls with their number.
FormSpectrum common_form(const FormCloud& cloud) {
  FormSpectrum out;
  out.absolute = true;
  const bool section = cloud.kind == FormKind::kRoundness;
  if (!section) {
    out.terms = {{0, 1, 0.25}, {0, 2, 0.25}, {1, 2, 0.25}};
    out.low_mm = out.high_mm = cloud.points.front().height_mm;
    for (const FormPoint& p : cloud.points) {
      out.low_mm = std::min(out.low_mm, p.height_mm);
      out.high_mm = std::max(out.high_mm, p.height_mm);
    }
  }
  for (int n = 2; n <= 15; ++n) {
    for (int degree = 0; degree <= (section ? 0 : 2); ++degree) {
      out.terms.push_back({n, degree, std::pow(0.5, degree) / n});
    }
  }
  return out;
}

void scale(FormSpectrum& spectrum, double factor) {
  for (FormTerm& term : spectrum.terms) term.amplitude_mm *= factor;
}

/// Mean value of error-free inspections of parts with a given form.
core::Result<double> mean_value_mm(const TrialInspection& rehearsal, const FormSpectrum& form,
                                   const record::Characteristic& asked) {
  double sum = 0.0;
  for (int k = 1; k <= kScalingParts; ++k) {
    TRY(const auto part,
        simulated_cloud(rehearsal.nominal(), Influences{}, form, static_cast<std::uint64_t>(k)));
    sum += rehearsal.value_mm(part, asked);
  }
  if (!(sum > 0.0 && std::isfinite(sum))) {
    return core::fail(core::Code::kReferenceAbsent,
                      "simulated parts of the expected form do not all have this reference");
  }
  return sum / kScalingParts;
}

/// Standard deviation of the errors of a point, all influences together.
double point_error_mm(const FormCloud& cloud, const Influences& influences) {
  const ErrorModel errors(cloud, influences);
  const double systematic =
      errors.columns().squaredNorm() / static_cast<double>(cloud.points.size());
  return std::sqrt(systematic + errors.point_variance_mm2().mean());
}

}  // namespace

core::Result<TrialInspection> TrialInspection::of(const record::RunRecord& expected, int feature) {
  TrialInspection out;
  out.result_.feature = expected.features[static_cast<std::size_t>(feature)];
  out.result_.cloud = places_of(expected, feature);
  if (out.result_.cloud.empty()) {
    return core::fail(core::Code::kNoPoints, "the feature is not touched");
  }
  for (const CloudPoint& place : out.result_.cloud) out.result_.repeat_freedom += place.repeats - 1;
  for (const record::PoseVisit& pose : expected.poses) {
    if (pose.feature != feature || !pose.final_cloud) continue;
    out.result_.part_turn = part_turn(expected, pose);
    break;
  }
  const Eigen::Vector3d direction = out.result_.part_turn.col(2);
  out.result_.section_axis.direction = direction;
  out.result_.mz_cylinder.emplace();
  out.result_.mz_cylinder->axis.direction = direction;
  TRY(out.nominal_, surface_cloud(out.result_));
  return out;
}

FeatureResult TrialInspection::result_of(const FormCloud& simulated,
                                         const record::Characteristic& asked) const {
  FeatureResult out = result_;
  for (std::size_t i = 0; i < out.cloud.size(); ++i) {
    out.cloud[i].tip_mm = position_mm(simulated, simulated.points[i]);
  }
  if (asked.form == record::Form::kRoundness) {
    out.layers = layers_of(simulated, out.cloud, asked.reference);
  }
  return out;
}

double TrialInspection::value_mm(const FormCloud& simulated,
                                 const record::Characteristic& asked) const {
  if (asked.form != record::Form::kRoundness) {
    FormCloud about = simulated;
    about.reference = asked.reference;
    return form_mm(about);
  }
  const FeatureResult inspected = result_of(simulated, asked);
  const auto worst = worst_section(inspected, asked.reference);
  return worst ? worst->value_mm : 0.0;
}

core::Result<FormSpectrum> expected_form(const TrialInspection& rehearsal, const Declared& declared,
                                         const record::Characteristic& asked) {
  const FormCloud& cloud = rehearsal.nominal();
  if (declared.spectrum && !declared.spectrum->terms.empty()) {
    TRY(auto stated, spectrum_on(cloud, declared));
    if (stated) {
      FormSpectrum out = *stated;
      if (!out.absolute) {
        out.absolute = true;
        out.source = core::Phrase("form_spectrum of the plan, its amplitudes taken as they are");
      } else {
        out.source = core::Phrase("form_spectrum of the plan");
      }
      return out;
    }
  }
  FormSpectrum out = common_form(cloud);
  TRY(const auto unit, mean_value_mm(rehearsal, out, asked));
  double wanted_mm =
      std::max(kLeastForm_mm, kTimesPointError * point_error_mm(cloud, declared.influences));
  std::string size =
      fmt::format("ten times the errors of a point, {:.3g} um", wanted_mm / core::kMicrometre);
  if (asked.tolerance_mm) {
    wanted_mm = kShareOfTolerance * *asked.tolerance_mm;
    size = fmt::format("half the tolerance, {:.3g} um", wanted_mm / core::kMicrometre);
  }
  scale(out, wanted_mm / unit);
  out.source = core::Phrase("assumed, 2..15 undulations that fall as 1/n, of " + size);
  return out;
}

}  // namespace rondure::evaluation
