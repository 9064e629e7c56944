#include "evaluation/harmonic_mask.h"

#include <algorithm>
#include <map>

namespace rondure::evaluation {
namespace {

/// The highest harmonic that every section resolves; 0 when a section resolves none.
int highest_of_all(const FeatureResult& feature) {
  int highest = 0;
  bool first = true;
  for (const LayerResult& layer : feature.layers) {
    const int here = layer.filtered && !layer.filtered->harmonics.harmonics.empty()
                         ? layer.filtered->harmonics.harmonics.back().number
                         : 0;
    highest = first ? here : std::min(highest, here);
    first = false;
  }
  return highest;
}

}  // namespace

std::vector<SectionHarmonic> worst_harmonics(const FeatureResult& feature) {
  std::map<int, SectionHarmonic> worst;
  for (const LayerResult& layer : feature.layers) {
    if (!layer.filtered) continue;
    for (const fit::Harmonic& h : layer.filtered->harmonics.harmonics) {
      const auto [found, fresh] =
          worst.try_emplace(h.number, SectionHarmonic{h.number, layer.layer, h.amplitude_mm});
      if (!fresh && h.amplitude_mm > found->second.amplitude_mm) {
        found->second = {h.number, layer.layer, h.amplitude_mm};
      }
    }
  }
  std::vector<SectionHarmonic> out;
  for (const auto& [number, harmonic] : worst) out.push_back(harmonic);
  return out;
}

std::vector<MaskedHarmonic> against_mask(const FeatureResult& feature,
                                         const record::Characteristic& asked) {
  std::vector<MaskedHarmonic> out;
  for (const SectionHarmonic& harmonic : worst_harmonics(feature)) {
    std::optional<double> limit_mm;
    for (const record::HarmonicLimit& line : asked.harmonic_limits) {
      if (harmonic.number < line.first || harmonic.number > line.last) continue;
      limit_mm = std::min(limit_mm.value_or(line.amplitude_mm), line.amplitude_mm);
    }
    if (limit_mm) out.push_back({harmonic, *limit_mm});
  }
  return out;
}

core::Result<MaskedHarmonic> nearest_to_mask(const FeatureResult& feature,
                                             const record::Characteristic& asked) {
  const int highest = highest_of_all(feature);
  for (const record::HarmonicLimit& line : asked.harmonic_limits) {
    if (line.last <= highest) continue;
    return core::fail(core::Code::kSampling,
                      core::phrase("the mask reaches to harmonic {}, the points of the sections "
                                   "carry {}; harmonics need full sections of at least 350 points",
                                   line.last, highest));
  }
  const std::vector<MaskedHarmonic> all = against_mask(feature, asked);
  const auto nearest = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.harmonic.amplitude_mm / a.limit_mm < b.harmonic.amplitude_mm / b.limit_mm;
  });
  if (nearest == all.end()) {
    return core::fail(core::Code::kSampling, core::phrase("the mask names no harmonic"));
  }
  return *nearest;
}

}  // namespace rondure::evaluation
