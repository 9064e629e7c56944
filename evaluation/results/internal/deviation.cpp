#include "evaluation/results/internal/deviation.h"

#include <algorithm>
#include <utility>

#include "core/phrase.h"
#include "core/units.h"

namespace rondure::evaluation {
namespace {

using record::Reference;

template <class Fit>
Deviation certified_deviation(double value_mm, const Fit& fit) {
  Deviation out;
  out.value_mm = value_mm;
  out.certified = fit.certificate.kind != fit::Certificate::Kind::kNone;
  return out;
}

Deviation least_squares_deviation(double value_mm) {
  Deviation out;
  out.value_mm = value_mm;
  return out;
}

template <class Fit>
core::Result<Deviation> one_sided_deviation(const core::Result<Fit>& fit) {
  if (!fit) return core::fail(fit.error());
  return certified_deviation(fit->deviation_mm, *fit);
}

double unseen_in(const FeatureResult& result, const LayerResult& layer) {
  std::vector<double> angles_rad;
  for (const std::size_t row : layer.rows) {
    if (row < result.cloud.size()) angles_rad.push_back(result.cloud[row].angle_rad);
  }
  const std::size_t count = angles_rad.size();
  return unseen_rad(std::move(angles_rad), count);
}

/// The same for all points together, projected along the axis.
double unseen_in(const FeatureResult& result) {
  std::vector<double> angles_rad;
  for (const CloudPoint& point : result.cloud) angles_rad.push_back(point.angle_rad);
  std::size_t a_turn = result.layers.empty() ? result.cloud.size() : 1;
  for (const LayerResult& layer : result.layers) a_turn = std::max(a_turn, layer.rows.size());
  return unseen_rad(std::move(angles_rad), a_turn);
}

core::Result<Deviation> deviation_about(const FeatureResult& result, Reference reference) {
  if (!result.mz_cylinder || !result.ls_cylinder) return not_fitted();
  switch (reference) {
    case Reference::kLeastSquares:
      return least_squares_deviation(result.ls_cylinder->deviation_mm);
    case Reference::kMinimumZone:
      return certified_deviation(result.mz_cylinder->width_mm(), *result.mz_cylinder);
    case Reference::kMinimumCircumscribed:
      return one_sided_deviation(result.mc_cylinder);
    case Reference::kMaximumInscribed:
      return one_sided_deviation(result.mi_cylinder);
  }
  return not_fitted();
}

}  // namespace

core::Result<Deviation> section_deviation(const LayerResult& layer, Reference reference) {
  if (!layer.mz) return core::fail(layer.mz.error());
  if (!layer.ls) return core::fail(layer.ls.error());
  switch (reference) {
    case Reference::kLeastSquares:
      return least_squares_deviation(layer.ls->deviation_mm);
    case Reference::kMinimumZone:
      return certified_deviation(layer.mz->width_mm(), *layer.mz);
    case Reference::kMinimumCircumscribed:
      return one_sided_deviation(layer.mc);
    case Reference::kMaximumInscribed: {
      auto out = one_sided_deviation(layer.mi);
      if (out) out->range = layer.mi->range;
      return out;
    }
  }
  return not_fitted();
}

double unseen_rad(std::vector<double> angles_rad, std::size_t a_turn) {
  if (angles_rad.size() < 3) return 0.0;
  std::sort(angles_rad.begin(), angles_rad.end());
  double gap = angles_rad.front() + core::kTwoPi - angles_rad.back();
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    gap = std::max(gap, angles_rad[i] - angles_rad[i - 1]);
  }
  const double allowed =
      std::max(0.25 * core::kTwoPi, 1.5 * core::kTwoPi / static_cast<double>(a_turn));
  return gap > allowed * (1.0 + 1e-6) ? gap : 0.0;
}

core::Phrase unseen_words(double unseen_rad) {
  return core::phrase(
      "the points leave {:.0f} deg of the turn unseen: what is there can only add to the "
      "deviation; measure the whole turn",
      core::degrees(unseen_rad));
}

core::Result<Deviation> cylinder_deviation(const FeatureResult& result, Reference reference) {
  auto out = deviation_about(result, reference);
  if (out) out->unseen_rad = unseen_in(result);
  return out;
}

core::Result<Deviation> worst_section(const FeatureResult& result, Reference reference) {
  if (result.layers.empty()) {
    return core::fail(core::Code::kNoPoints,
                      result.feature.layers == 1
                          ? core::phrase("all points lie in one layer, and an axis needs 2: "
                                         "measure more layers, or make the feature a circle")
                          : core::phrase("this feature has no sections"));
  }
  Deviation out;
  fit::DeviationRange worst;
  bool unique = true;
  for (const LayerResult& layer : result.layers) {
    const auto section = section_deviation(layer, reference);
    if (!section) {
      return core::fail(section.error().code,
                        core::phrase("layer {}: {}", layer.layer + 1, section.error().said()));
    }
    if (out.layer == nullptr || section->value_mm > out.value_mm) {
      out.value_mm = section->value_mm;
      out.layer = &layer;
    }
    if (layer.mz->exact_fit) out.exact_fit = true;
    out.unseen_rad = std::max(out.unseen_rad, unseen_in(result, layer));
    if (!section->certified) out.certified = false;
    const auto range =
        section->range.value_or(fit::DeviationRange{section->value_mm, section->value_mm});
    worst.low_mm = std::max(worst.low_mm, range.low_mm);
    worst.high_mm = std::max(worst.high_mm, range.high_mm);
    unique = unique && !section->range;
  }
  if (!unique && worst.high_mm > worst.low_mm) out.range = worst;
  return out;
}

double deciding_mm(const fit::DeviationRange& range, const std::optional<double>& limit_mm) {
  return limit_mm && range.low_mm > *limit_mm ? range.low_mm : range.high_mm;
}

std::optional<core::Phrase> undecided_range(const fit::DeviationRange& range,
                                            const std::optional<double>& limit_mm) {
  if (!limit_mm || range.low_mm > *limit_mm || range.high_mm <= *limit_mm) return std::nullopt;
  return core::phrase(
      "the reference circle is not unique: RONt is anything from {:.3f} to {:.3f} um, and the "
      "limit of {:g} um lies between",
      range.low_mm / core::kMicrometre, range.high_mm / core::kMicrometre,
      *limit_mm / core::kMicrometre);
}

}  // namespace rondure::evaluation
