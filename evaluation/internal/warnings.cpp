#include "evaluation/internal/warnings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/measured_cloud.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

constexpr double kGapLimit =
    120.0 * core::kDegree;              // beyond it the certificate of a section needs care
constexpr std::size_t kFewPoints = 21;  // 3 layers of 7
constexpr double kTold = 1e-6;          // differences below this do not show in any report [mm]

void add_warning(FeatureResult& result, core::Code code, core::Phrase said) {
  result.warnings.push_back(core::error_of(code, std::move(said)));
}

/// Largest angle about the axis without a point.
double largest_gap(const std::vector<CloudPoint>& cloud) {
  std::vector<double> angles;
  for (const CloudPoint& point : cloud) angles.push_back(point.angle_rad);
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + core::kTwoPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return gap;
}

/// Whether further points of the surface can only enlarge the value.
bool is_of_extremes(const record::Characteristic& asked) {
  using record::Form;
  switch (asked.form) {
    case Form::kCylindricity:
    case Form::kRoundness:
    case Form::kFlatness:
    case Form::kRunOut:
    case Form::kTotalRunOut:
      return true;
    case Form::kStraightness:
      return asked.indication.of != record::Indication::Of::kMedianLine;
    default:
      return false;
  }
}

void warn_sampling(FeatureResult& result) {
  const record::Feature& feature = result.feature;
  const bool cylinder = feature.shape == record::Shape::kCylinder;
  const bool sparse = feature.layers > 0
                          ? feature.points_per_layer < 7 || (cylinder && feature.layers < 3)
                          : result.cloud.size() < (cylinder ? kFewPoints : kFewPoints / 3);
  for (const record::Characteristic& asked : feature.characteristics) {
    if (!sparse || !is_of_extremes(asked)) continue;
    add_warning(
        result, core::Code::kSparse,
        core::phrase(
            "{} points see only part of the form; the deviation of the whole surface is larger",
            result.cloud.size()));
    result.warnings.back().where = asked.id;
  }
  const double gap = largest_gap(result.cloud);
  if (gap > kGapLimit && feature.shape != record::Shape::kPlane) {
    add_warning(
        result, core::Code::kNotFullSection,
        core::phrase(
            "a gap of {:.0f} deg about the axis holds no point: the deviation is that of an arc, "
            "and its axis is weakly determined",
            gap / core::kDegree));
  }
}

/// Settings that cannot be read are a gate of their own.
void warn_repeated(FeatureResult& result) {
  const auto source = record::task_of<record::SourceSettings>(result.feature.settings, "source/");
  if (source && source->repeated) result.warnings.push_back(repeated_rows(*source->repeated));
}

/// The value of a circle that leans, in its plane and about z.
void warn_lean(FeatureResult& result) {
  if (!result.about_nominal || result.layers.empty()) return;
  const auto& here = result.layers.front().mz;
  const auto& about_z = result.about_nominal->layers.front().mz;
  if (!here || !about_z) return;
  add_warning(
      result, core::Code::kInconsistent,
      core::phrase("the points lie in a plane that leans {:.2f} deg from z: the minimum zone is "
                   "{:.3f} um in it and {:.3f} um about z",
                   std::acos(std::min(result.section_axis.direction.z(), 1.0)) / core::kDegree,
                   here->width_mm() / core::kMicrometre, about_z->width_mm() / core::kMicrometre));
}

void warn_exact_fit(FeatureResult& result) {
  for (const LayerResult& layer : result.layers) {
    if (!layer.mz || !layer.mz->exact_fit) continue;
    add_warning(
        result, core::Code::kExactFit,
        core::phrase(
            "layer {} has three different points, which lie on a circle exactly: its roundness "
            "of 0 says nothing about the part",
            layer.layer + 1));
    return;
  }
}

/// Warns of references that do not exist for the points: of the feature, or of single sections of a
/// cylinder that has one.
void warn_absent(FeatureResult& result) {
  using record::Reference;
  const record::Shape shape = result.feature.shape;
  if (shape != record::Shape::kCylinder && shape != record::Shape::kCircle) return;
  for (const Reference reference :
       {Reference::kMinimumCircumscribed, Reference::kMaximumInscribed}) {
    const auto found = one_sided_of(result, reference);
    if (!found) {
      add_warning(result, found.error().code,
                  core::phrase("no {}: {}", core::Phrase(words_of(reference, shape)),
                               found.error().said()));
      continue;
    }
    for (const LayerResult& layer : result.layers) {
      const auto& circle = reference == Reference::kMinimumCircumscribed ? layer.mc : layer.mi;
      if (circle) continue;
      add_warning(result, circle.error().code,
                  core::phrase("layer {} has no {}: {}", layer.layer + 1,
                               core::Phrase(words_of(reference, record::Shape::kCircle)),
                               circle.error().said()));
      break;
    }
  }
}

/// A one-sided reference is the optimum nearest to the least-squares one. Where the optimum near
/// the minimum zone is better, there are several, and a gauge may settle in another.
/// @param layer  0-based; none: of the whole cylinder.
template <class Zone, class OneSided>
void warn_better(const Zone& mz, const core::Result<OneSided>& mc, const core::Result<OneSided>& mi,
                 record::Shape shape, std::optional<int> layer, FeatureResult& result) {
  using record::Reference;
  const auto say = [&](Reference reference, double radius_mm, double better_mm) {
    core::Phrase said = core::phrase(
        "the {} next to the least-squares one has a radius of {:.7f} mm, about the place of the "
        "minimum zone {:.3g} um better: a gauge may settle in either",
        core::Phrase(words_of(reference, shape)), radius_mm + surface_offset_mm(result),
        better_mm / core::kMicrometre);
    if (layer) said = core::phrase("layer {}: {}", *layer + 1, said);
    add_warning(result, core::Code::kSeveralOptima, std::move(said));
  };
  if (mc && mc->radius_mm > mz.outer_radius_mm + kTold)
    say(Reference::kMinimumCircumscribed, mc->radius_mm, mc->radius_mm - mz.outer_radius_mm);
  if (mi && mi->radius_mm < mz.inner_radius_mm - kTold)
    say(Reference::kMaximumInscribed, mi->radius_mm, mz.inner_radius_mm - mi->radius_mm);
}

/// Other circles as large as the maximum inscribed one, with a different deviation.
void warn_range(const LayerResult& layer, FeatureResult& result) {
  if (!layer.mi || !layer.mi->range) return;
  add_warning(
      result, core::Code::kSeveralOptima,
      core::phrase("layer {}: the maximum inscribed circle is not unique: about circles whose "
                   "radius agrees to 1 nm RONt is anything from {:.3f} to {:.3f} um",
                   layer.layer + 1, layer.mi->range->low_mm / core::kMicrometre,
                   layer.mi->range->high_mm / core::kMicrometre));
}

/// A better cylinder that is not the reference: lying across a disc, or out of reach of the search.
void warn_other(FeatureResult& result) {
  using record::Reference;
  const auto say = [&](Reference reference, const core::Result<fit::OneSidedCylinder>& fit) {
    if (!fit || !fit->other) return;
    add_warning(
        result, core::Code::kSeveralOptima,
        core::phrase(
            "another {} is {:.3g} um better: its axis leans by {:.3g} deg and lies {:.3g} mm "
            "off that of the reference, which is the one next to the least-squares axis",
            core::Phrase(words_of(reference, record::Shape::kCylinder)),
            std::abs(fit->radius_mm - fit->other->radius_mm) / core::kMicrometre,
            fit->other->lean_rad / core::kDegree, fit->other->apart_mm));
  };
  say(Reference::kMinimumCircumscribed, result.mc_cylinder);
  say(Reference::kMaximumInscribed, result.mi_cylinder);
}

void warn_several(FeatureResult& result) {
  warn_other(result);
  if (result.mz_cylinder) {
    warn_better(*result.mz_cylinder, result.mc_cylinder, result.mi_cylinder,
                record::Shape::kCylinder, std::nullopt, result);
  }
  for (const LayerResult& layer : result.layers) {
    if (!layer.mz) continue;
    warn_better(*layer.mz, layer.mc, layer.mi, record::Shape::kCircle, layer.layer, result);
    warn_range(layer, result);
  }
}

void warn_level(FeatureResult& result) {
  if (!result.mz_cylinder) return;
  const double zone = result.mz_cylinder->width_mm();
  for (const PoseValue& value : result.poses) {
    if (!value.final_pose || !value.valid || !(value.f_mm > 2.0 * zone)) continue;
    add_warning(
        result, core::Code::kNotLevel,
        core::phrase(
            "f = {:.3f} um in the final pose is more than twice the zone of {:.3f} um: it "
            "measures the tilt of the part, not its form; the minimum zone below is free of it",
            value.f_mm / core::kMicrometre, zone / core::kMicrometre));
    return;
  }
}

}  // namespace

void warn(FeatureResult& result) {
  warn_repeated(result);
  warn_sampling(result);
  warn_lean(result);
  warn_exact_fit(result);
  warn_absent(result);
  warn_several(result);
  if (result.mz_cylinder && result.mz_cylinder->certificate.kind == fit::Certificate::Kind::kNone) {
    add_warning(result, core::Code::kNoCertificate, result.mz_cylinder->certificate.reason);
  }
  warn_level(result);
}

}  // namespace rondure::evaluation
