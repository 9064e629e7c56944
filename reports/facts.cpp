#include "reports/facts.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/utf8.h"
#include "reports/measured_cloud.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::printable;

std::vector<fit::Contact> in_rows(const std::vector<fit::Contact>& contacts,
                                  const std::vector<std::size_t>& rows) {
  std::vector<fit::Contact> result;
  for (const fit::Contact& contact : contacts) {
    if (contact.index < rows.size()) result.push_back({rows[contact.index], contact.multiplier});
  }
  return result;
}

/// Zone of a fit that has radii and contacts, whatever its shape.
template <class Fit>
Zone zone_from(const Fit& fit, const FeatureResult& feature) {
  const double offset_mm = surface_offset_mm(feature);
  Zone zone;
  zone.deviation_mm = fit.width_mm();
  zone.inner_radius_mm = fit.inner_radius_mm + offset_mm;
  zone.outer_radius_mm = fit.outer_radius_mm + offset_mm;
  zone.mean_radius_mm = 0.5 * (zone.inner_radius_mm + zone.outer_radius_mm);
  zone.of_surface = feature.tip_radius_mm.has_value();
  zone.outer = fit.outer;
  zone.inner = fit.inner;
  zone.certificate = fit.certificate;
  return zone;
}

template <class Fit>
OneSided one_sided_from(const Fit& fit, const FeatureResult& feature) {
  return {fit.deviation_mm, fit.radius_mm + surface_offset_mm(feature), fit.contacts,
          fit.certificate, std::nullopt};
}

}  // namespace

std::optional<Zone> zone_of(const FeatureResult& feature) {
  if (feature.mz_cylinder) return zone_from(*feature.mz_cylinder, feature);
  if (feature.feature.shape != record::Shape::kCircle || feature.layers.empty()) return {};
  const LayerResult& section = feature.layers.front();
  if (!section.mz) return {};
  Zone zone = zone_from(*section.mz, feature);
  zone.outer = in_rows(zone.outer, section.rows);
  zone.inner = in_rows(zone.inner, section.rows);
  return zone;
}

double surface_offset_mm(const FeatureResult& feature) {
  if (!feature.tip_radius_mm) return 0.0;
  const bool outside = feature.feature.side == record::Side::kOutside;
  return outside ? -*feature.tip_radius_mm : *feature.tip_radius_mm;
}

std::optional<LeastSquares> least_squares_of(const FeatureResult& feature) {
  const double offset_mm = surface_offset_mm(feature);
  if (feature.ls_cylinder) {
    const fit::LsCylinder& ls = *feature.ls_cylinder;
    return LeastSquares{ls.deviation_mm, ls.radius_mm + offset_mm, ls.rms_mm};
  }
  if (feature.feature.shape != record::Shape::kCircle || feature.layers.empty()) return {};
  const auto& ls = feature.layers.front().ls;
  if (!ls) return {};
  return LeastSquares{ls->deviation_mm, ls->radius_mm + offset_mm, ls->rms_mm};
}

core::Result<OneSided> one_sided_of(const FeatureResult& feature, record::Reference reference) {
  const bool outside = reference == record::Reference::kMinimumCircumscribed;
  if (!outside && reference != record::Reference::kMaximumInscribed) return not_fitted();
  if (record::is_analysis(feature.feature.shape)) return not_fitted();
  if (feature.feature.shape != record::Shape::kCircle) {
    const auto& cylinder = outside ? feature.mc_cylinder : feature.mi_cylinder;
    if (!cylinder) return core::fail(cylinder.error());
    return one_sided_from(*cylinder, feature);
  }
  if (feature.layers.empty()) return not_fitted();
  const LayerResult& section = feature.layers.front();
  const auto& circle = outside ? section.mc : section.mi;
  if (!circle) return core::fail(circle.error());
  OneSided out = one_sided_from(*circle, feature);
  out.range = circle->range;
  out.contacts = in_rows(out.contacts, section.rows);
  return out;
}

std::string words_of(record::Reference reference, record::Shape shape) {
  const bool circle = shape == record::Shape::kCircle;
  switch (reference) {
    case record::Reference::kLeastSquares:
      return circle ? tr("least-squares circle") : tr("least-squares cylinder");
    case record::Reference::kMinimumZone:
      return tr("minimum zone");
    case record::Reference::kMinimumCircumscribed:
      return circle ? tr("minimum circumscribed circle") : tr("minimum circumscribed cylinder");
    case record::Reference::kMaximumInscribed:
      return circle ? tr("maximum inscribed circle") : tr("maximum inscribed cylinder");
  }
  return {};
}

std::string_view symbol_of(record::Shape shape) {
  return shape == record::Shape::kCircle ? "RONt" : "CYLt";
}

std::string symbol_of(const record::Characteristic& characteristic) {
  switch (characteristic.form) {
    case record::Form::kCylindricity:
      return "CYLt";
    case record::Form::kRoundness:
      return "RONt";
    case record::Form::kRoundnessRms:
      return "RONq";
    case record::Form::kHarmonicLimits:
      return "A(k)";
    case record::Form::kMotionTotal:
      return "EM total";
    case record::Form::kMotionSynchronous:
      return "EM sync";
    case record::Form::kMotionAsynchronous:
      return "EM async";
    case record::Form::kRadius:
      return "dR";
    case record::Form::kRunOut:
      return "Run-out";
    case record::Form::kContourDeviation:
      return "Contour";
    case record::Form::kContourSpread:
      return "Spread";
    case record::Form::kFixtureResidual:
      return "Left max";
    case record::Form::kFixtureResidualRms:
      return "Left rms";
  }
  return {};
}

std::string reference_of(const record::Characteristic& characteristic) {
  if (characteristic.form == record::Form::kRoundnessRms) return "LSCI";
  if (characteristic.form != record::Form::kCylindricity &&
      characteristic.form != record::Form::kRoundness) {
    return {};
  }
  return reference_of(characteristic.reference, characteristic.form == record::Form::kCylindricity
                                                    ? record::Shape::kCylinder
                                                    : record::Shape::kCircle);
}

std::string reference_of(record::Reference reference, record::Shape shape) {
  std::string symbol;
  for (const char c : record::name_of(reference)) symbol += static_cast<char>(c - 'a' + 'A');
  return symbol + (shape == record::Shape::kCylinder ? "CY" : "CI");
}

const PoseValue* final_pose_of(const FeatureResult& feature) {
  const auto found = std::find_if(feature.poses.begin(), feature.poses.end(),
                                  [](const PoseValue& pose) { return pose.final_pose; });
  return found == feature.poses.end() ? nullptr : &*found;
}

const record::SimulationTruth* truth_of(const record::RunRecord& record, std::size_t index) {
  // A part that was located again while its final cloud was repeated has two: the later counts.
  const record::SimulationTruth* last = nullptr;
  for (const record::SimulationTruth& truth : record.truths) {
    if (truth.feature >= 0 && static_cast<std::size_t>(truth.feature) == index) last = &truth;
  }
  return last;
}

std::string pattern_of(const FeatureResult& feature) {
  const std::size_t points = feature.cloud.size();
  const auto layers = static_cast<std::size_t>(std::max(feature.feature.layers, 0));
  const auto each = static_cast<std::size_t>(std::max(feature.feature.points_per_layer, 0));
  if (layers > 0 && layers * each == points) return trf("{} x {} points", layers, each);
  return count(points, "point", "points");
}

std::string repeats_of(const FeatureResult& feature) {
  if (feature.cloud.empty() || feature.feature.strategy == record::Strategy::kPointsFile) return {};
  if (const int passes = passes_of(feature.cloud); passes > 1) {
    return trf("{} passes at places of their own, not averaged", passes);
  }
  const auto [least, most] = std::minmax_element(
      feature.cloud.begin(), feature.cloud.end(),
      [](const CloudPoint& a, const CloudPoint& b) { return a.repeats < b.repeats; });
  const auto high = static_cast<std::size_t>(most->repeats);
  const std::string text = count(high, "touch a point", "touches a point");
  return least->repeats == most->repeats ? text : trf("{} to {}", least->repeats, text);
}

std::string sentence_of(const fit::Certificate& certificate) {
  using Kind = fit::Certificate::Kind;
  switch (certificate.kind) {
    case Kind::kGlobal:
      return fmt::format("Global: no narrower zone exists; searched: {}.", certificate.scope);
    case Kind::kLocal:
      return fmt::format("Local: no narrower zone exists nearby (scope: {}).", certificate.scope);
    case Kind::kNone:
      return "None: the minimum is not proven.";
  }
  return {};
}

std::vector<std::string> missing_parts(const record::RunRecord& record,
                                       const Evaluation& evaluation) {
  std::vector<std::string> parts;
  for (const FeatureResult& feature : evaluation.features) {
    const record::Feature& asked = feature.feature;
    const long planned = static_cast<long>(asked.layers) * asked.points_per_layer;
    if (feature.failure) {
      parts.push_back(trf("Feature {} has no result.", printable(asked.id)));
    } else if (planned > static_cast<long>(feature.cloud.size())) {
      parts.push_back(trf("Feature {} has {} of {} points.", printable(asked.id),
                          feature.cloud.size(), planned));
    }
  }
  for (std::size_t i = evaluation.features.size(); i < record.features.size(); ++i) {
    parts.push_back(trf("Feature {} was not evaluated.", printable(record.features[i].id)));
  }
  if (parts.empty()) parts.emplace_back(tr("Steps after the last touch on record were not done."));
  return parts;
}

std::string rule_sentence(const Evaluation& evaluation) {
  if (!evaluation.rule) return evaluation.rule.error().what;
  const DecisionRule& rule = *evaluation.rule;
  if (!rule.needs_interval()) {
    return "simple acceptance; no measurement uncertainty taken into account";
  }
  return fmt::format("{}; the value {} decides", in_words(rule), name_of(rule.measurand));
}

std::string rule_in_words(const record::Header& header) {
  std::string words = tr(header.decision_rule.empty() ? "simple-acceptance" : header.decision_rule);
  if (language() != Language::kEnglish) return words;
  std::replace(words.begin(), words.end(), '-', ' ');
  return words;
}

}  // namespace rondure::reports
