#include "reports/deviation.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"

namespace rondure::reports {
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

/// The deviation about one reference; without that reference, why there is none.
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

}  // namespace

core::Result<Deviation> cylinder_deviation(const FeatureResult& result, Reference reference) {
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

core::Result<Deviation> worst_section(const FeatureResult& result, Reference reference) {
  if (result.layers.empty())
    return core::fail(core::Code::kNoPoints, "this feature has no sections");
  Deviation out;
  fit::DeviationRange worst;
  bool unique = true;
  for (const LayerResult& layer : result.layers) {
    const auto section = section_deviation(layer, reference);
    if (!section) {
      return core::fail(section.error().code,
                        fmt::format("layer {}: {}", layer.layer + 1, section.error().what));
    }
    if (out.layer == nullptr || section->value_mm > out.value_mm) {
      out.value_mm = section->value_mm;
      out.layer = &layer;
    }
    if (layer.mz->exact_fit) out.exact_fit = true;
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

std::optional<std::string> undecided_range(const fit::DeviationRange& range,
                                           const std::optional<double>& limit_mm) {
  if (!limit_mm || range.low_mm > *limit_mm || range.high_mm <= *limit_mm) return std::nullopt;
  return fmt::format(
      "the reference circle is not unique: RONt is anything from {:.3f} to {:.3f} um, and the "
      "limit "
      "of {:g} um lies between",
      range.low_mm / core::kMicrometre, range.high_mm / core::kMicrometre,
      *limit_mm / core::kMicrometre);
}

}  // namespace rondure::reports
