#include "reports/deviation.h"

#include <fmt/format.h>

namespace rondure::reports {
namespace {

using record::Reference;

template <class Fit>
Deviation certified_deviation(double value_mm, const Fit& fit) {
  return {value_mm, fit.certificate.kind != fit::Certificate::Kind::kNone, false};
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
      return Deviation{layer.ls->deviation_mm};
    case Reference::kMinimumZone:
      return certified_deviation(layer.mz->width_mm(), *layer.mz);
    case Reference::kMinimumCircumscribed:
      return one_sided_deviation(layer.mc);
    case Reference::kMaximumInscribed:
      return one_sided_deviation(layer.mi);
  }
  return not_fitted();
}

}  // namespace

core::Result<Deviation> cylinder_deviation(const FeatureResult& result, Reference reference) {
  if (!result.mz_cylinder || !result.ls_cylinder) return not_fitted();
  switch (reference) {
    case Reference::kLeastSquares:
      return Deviation{result.ls_cylinder->deviation_mm};
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
  }
  return out;
}

}  // namespace rondure::reports
