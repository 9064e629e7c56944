#include "evaluation/prediction/internal/rehearsal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/internal/touched_surface.h"
#include "evaluation/interval/internal/form_interval.h"
#include "evaluation/part/find.h"
#include "evaluation/results/measured_cloud.h"
#include "evaluation/uncertainty/internal/error_modes.h"

namespace rondure::evaluation {
namespace {

using record::Form;
using record::Shape;

constexpr double kShareOfTolerance = 0.5;
constexpr double kTimesPointError = 10.0;  // where there is no tolerance
constexpr double kLeastForm_mm = 1e-3;     // where there is no error either
constexpr int kScalingParts = 32;
constexpr int kScalingFound = 8;   // of values that take longer
constexpr double kUnit_mm = 0.01;  // of deviations before they are scaled

/// Fits again what the trials take of a surface whose points were moved.
void fit_again(const std::vector<std::size_t>& rows, FeatureResult& surface) {
  if (surface.feature.shape != Shape::kCylinder) return;
  std::vector<Eigen::Vector3d> tips;
  for (const std::size_t row : rows) tips.push_back(surface.cloud[row].tip_mm);
  const auto fit = fit::ls_cylinder(tips, surface.part_turn.col(2));
  surface.ls_cylinder = fit ? std::optional(*fit) : std::nullopt;
}

/// A generic form: undulations whose amplitude falls with their number.
FormSpectrum common_form(const FormCloud& cloud) {
  FormSpectrum out;
  out.absolute = true;
  const bool section = cloud.kind == FormKind::kRoundness;
  if (!section) {
    out.terms = {{0, 1, 0.25 * kUnit_mm}, {0, 2, 0.25 * kUnit_mm}, {1, 2, 0.25 * kUnit_mm}};
    const auto [low, high] = std::ranges::minmax(cloud.points, {}, &FormPoint::height_mm);
    out.low_mm = low.height_mm;
    out.high_mm = high.height_mm;
  }
  for (int n = 2; n <= 15; ++n) {
    for (int degree = 0; degree <= (section ? 0 : 2); ++degree) {
      out.terms.push_back({n, degree, kUnit_mm * std::pow(0.5, degree) / n});
    }
  }
  return out;
}

/// What half of a tolerance, or ten times the errors of a point, allow.
double wanted_mm(const record::Characteristic& asked, double point_error_mm) {
  return asked.tolerance_mm ? kShareOfTolerance * *asked.tolerance_mm
                            : std::max(kLeastForm_mm, kTimesPointError * point_error_mm);
}
std::string in_words(const record::Characteristic& asked, double wanted_mm) {
  return fmt::format("{}, {:.3g} um",
                     asked.tolerance_mm ? "half the tolerance" : "ten times the errors of a point",
                     wanted_mm / core::kMicrometre);
}

/// The form of a whole surface, without a tolerance.
record::Characteristic whole_form(Shape shape) {
  record::Characteristic out;
  out.form = shape == Shape::kCylinder ? Form::kCylindricity
             : shape == Shape::kPlane  ? Form::kFlatness
                                       : Form::kRoundness;
  return out;
}

bool is_form(const record::Characteristic& asked) {
  return asked.form == Form::kCylindricity || asked.form == Form::kRoundness ||
         asked.form == Form::kStraightness || asked.form == Form::kFlatness;
}

ErrorModel errors_of(const Chart& chart, const Influences& influences) {
  return {touched_points(chart, chart.cloud.axis.point_mm), rigid_basis(chart.cloud), influences};
}

/// Standard deviation of the errors of a point, all influences together.
double point_error_mm(const RehearsedSurface& surface) {
  const ErrorModel errors = errors_of(*surface.chart, surface.declared.influences);
  const double systematic =
      errors.columns().squaredNorm() / static_cast<double>(surface.rows.size());
  return std::sqrt(systematic + errors.point_variance_mm2().mean());
}

/// Moves the points of a surface to where one inspection reads them.
core::Result<void> deviate(const RehearsedSurface& surface, const AssumedSurface& assumed,
                           const Influences& errors, std::uint64_t seed,
                           std::vector<Eigen::Vector3d>& tips_mm) {
  const Chart& chart = *surface.chart;
  Eigen::VectorXd by = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(surface.rows.size()));
  if (!assumed.form.terms.empty()) {
    TRY(by, simulated_deviations(chart.cloud, errors_of(chart, errors), assumed.form, seed));
  }
  if (assumed.place_mm > 0.0) {  // all motions but the change of size
    const Eigen::MatrixXd motions = rigid_motions(chart.cloud);
    core::KeyedNoise noise(seed, {1});
    for (Eigen::Index k = 1; k < motions.cols(); ++k)
      by += assumed.place_mm * noise.normal() * motions.col(k);
  }
  for (std::size_t i = 0; i < surface.rows.size(); ++i) {
    tips_mm[surface.rows[i]] += by[static_cast<Eigen::Index>(i)] * chart.normals[i];
  }
  return {};
}

}  // namespace

Rehearsal::Rehearsal(const record::RunRecord& expected)
    : record_(expected), probe_(evaluate_probe(expected)) {
  for (std::size_t f = 0; f < expected.features.size(); ++f) {
    RehearsedSurface& made = surfaces_.emplace_back();
    FeatureResult& nominal = nominal_.emplace_back();
    nominal.feature = expected.features[f];
    nominal.failure = made.chart.error();
    const record::Strategy strategy = nominal.feature.strategy;
    if (record::is_analysis(nominal.feature.shape) || strategy == record::Strategy::kMerged ||
        strategy == record::Strategy::kPointsFile) {
      continue;
    }
    nominal = touched_surface(expected, static_cast<int>(f), probe_);
    if (nominal.failure) continue;
    double first_s = nominal.cloud.front().time_s;
    double last_s = first_s;
    for (std::size_t row = 0; row < nominal.cloud.size(); ++row) {
      const CloudPoint& place = nominal.cloud[row];
      if (!place.left_out) made.rows.push_back(row);
      nominal.repeat_freedom += place.repeats - 1;
      first_s = std::min(first_s, place.time_s);
      last_s = std::max(last_s, place.time_s);
    }
    made.repeatability = assume_repeatability(nominal);
    fit_again(made.rows, nominal);
    made.chart = chart_of(nominal, made.rows, tips_of(nominal.cloud));
    if (!made.chart) continue;
    made.declared = declared_for(expected, nominal, std::nullopt).value_or(Declared());
    for (std::size_t i = 0; last_s > first_s && i < made.rows.size(); ++i) {
      made.chart->cloud.points[i].time_1 =
          (nominal.cloud[made.rows[i]].time_s - first_s) / (last_s - first_s);
    }
  }
  part_ = surfaces_of(nominal_);
  assume_probe();
}

/// The repeatability that the run would determine itself; also describes the assumption in words.
std::string Rehearsal::assume_repeatability(FeatureResult& nominal) const {
  const auto declared = declared_for(record_, nominal, std::nullopt);
  if (!declared || !declared->influences.probe) return {};
  const ProbeInfluences& said = *declared->influences.probe;
  if (said.form_limit_mm > 0.0 && said.repeatability_mm == 0.0)
    return "within the declared probing form";
  if (said.repeatability_known || nominal.repeat_freedom == 0) return {};
  nominal.repeat_sigma_mm = record_.artefact.form_limit_mm / kRangeOf25Touches;
  return fmt::format("{:.2g} um, the most that the qualification lets pass",
                     *nominal.repeat_sigma_mm / core::kMicrometre);
}

/// The scatter of the touches of the reference artefact: noise, and lobes that its fit leaves over.
void Rehearsal::assume_probe() {
  const auto known = std::ranges::find_if(surfaces_, [](const RehearsedSurface& surface) {
    return surface.declared.influences.probe.has_value();
  });
  if (!probe_ || known == surfaces_.end()) return;
  const ProbeInfluences& said = *known->declared.influences.probe;
  double variance_mm2 =
      std::pow(said.repeatability_mm, 2) + std::pow(said.form_limit_mm / kRangeOf25Touches, 2);
  for (const cmm::PretravelLobe& lobe : said.lobes) {
    variance_mm2 += 0.5 * lobe.amplitude_mm * lobe.amplitude_mm;
  }
  probe_->radius_sigma_mm = probe_->radius_per_touch * std::sqrt(variance_mm2);
}

/// Mean value of error-free inspections of parts with given deviations of one surface.
core::Result<double> Rehearsal::mean_value_mm(std::size_t feature, const AssumedSurface& assumed,
                                              const record::Characteristic& asked) const {
  std::vector<MeasuredSurface> part = part_;
  const int parts = is_found(nominal_[feature].feature, asked) ? kScalingFound : kScalingParts;
  double sum = 0.0;
  for (int k = 1; k <= parts; ++k) {
    part[feature].tips_mm = part_[feature].tips_mm;
    TRY_DO(deviate(surfaces_[feature], assumed, Influences{}, static_cast<std::uint64_t>(k),
                   part[feature].tips_mm));
    TRY(const auto found, find(part, feature, asked, Proof::kNone));
    sum += found.judged.front().value_mm;
  }
  if (!(sum > 0.0 && std::isfinite(sum))) {
    return core::fail(core::Code::kReferenceAbsent,
                      "simulated parts of the expected form do not all have this reference");
  }
  return sum / parts;
}

core::Result<AssumedSurface> Rehearsal::assumed(std::size_t feature,
                                                const record::Characteristic& asked) const {
  const RehearsedSurface& surface = surfaces_[feature];
  const FormCloud& cloud = surface.chart->cloud;
  AssumedSurface out;
  if (surface.declared.spectrum && !surface.declared.spectrum->terms.empty()) {
    TRY(auto stated, spectrum_on(cloud, surface.declared));
    if (stated) {
      out.form = *std::move(stated);
      out.form.source = core::Phrase(
          out.form.absolute ? "form_spectrum of the plan"
                            : "form_spectrum of the plan, its amplitudes taken as they are");
      out.form.absolute = true;
      return out;
    }
  }
  out.form = common_form(cloud);
  TRY(const double unit, mean_value_mm(feature, out, asked));
  const double wanted = wanted_mm(asked, point_error_mm(surface));
  for (FormTerm& term : out.form.terms) term.amplitude_mm *= wanted / unit;
  out.form.source =
      core::Phrase("assumed, 2..15 undulations that fall as 1/n, of " + in_words(asked, wanted));
  return out;
}

std::vector<std::optional<AssumedSurface>> Rehearsal::assumed_part() const {
  std::vector<std::optional<AssumedSurface>> out(surfaces_.size());
  for (std::size_t f = 0; f < surfaces_.size(); ++f) {
    if (!surfaces_[f].chart) continue;
    const record::Feature& feature = nominal_[f].feature;
    const record::Characteristic* place = nullptr;
    for (const record::Characteristic& asked : feature.characteristics) {
      if (!asked.tolerance_mm) continue;
      if (!asked.indication.datum.empty()) {
        if (place == nullptr || *asked.tolerance_mm < *place->tolerance_mm) place = &asked;
      } else if (is_form(asked)) {
        const auto form = assumed(f, asked);
        const auto size = [](const AssumedSurface& of) {
          return of.form.terms.front().amplitude_mm;
        };
        if (form && (!out[f] || size(*form) < size(*out[f]))) out[f] = *form;
      }
    }
    if (!out[f]) {
      if (auto form = assumed(f, whole_form(feature.shape))) out[f] = *std::move(form);
    }
    if (!out[f] || place == nullptr) continue;
    const auto unit = mean_value_mm(f, {{}, kUnit_mm}, *place);
    if (!unit) continue;
    const double wanted = wanted_mm(*place, 0.0);
    out[f]->place_mm = wanted * kUnit_mm / *unit;
    out[f]->form.source = core::Phrase(fmt::format(
        "{}; displaced by {}", out[f]->form.source.english(), in_words(*place, wanted)));
  }
  return out;
}

core::Result<std::vector<FeatureResult>> Rehearsal::inspected(
    std::span<const std::optional<AssumedSurface>> part, std::uint64_t seed) const {
  std::vector<FeatureResult> out = nominal_;
  for (std::size_t f = 0; f < out.size(); ++f) {
    if (!part[f]) continue;
    // Another seed for each feature; the first keeps that of a part of one surface.
    std::vector<Eigen::Vector3d> tips_mm = part_[f].tips_mm;
    TRY_DO(deviate(surfaces_[f], *part[f], surfaces_[f].declared.influences,
                   seed + (std::uint64_t{f} << 32U), tips_mm));
    for (std::size_t row = 0; row < tips_mm.size(); ++row) out[f].cloud[row].tip_mm = tips_mm[row];
    fit_again(surfaces_[f].rows, out[f]);
  }
  return out;
}

}  // namespace rondure::evaluation
