#include "evaluation/contour/internal/mask_trials.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation::contour_trials {

namespace {

/// The greatest share of its limit that one harmonic takes in any part; 0 outside the mask.
double harmonic_share(const Curves& curves, const std::vector<record::HarmonicLimit>& mask,
                      int order) {
  std::vector<record::HarmonicLimit> own;
  for (const record::HarmonicLimit& line : mask) {
    if (order >= line.first && order <= line.last) own.push_back({order, order, line.amplitude_mm});
  }
  return worst_share(curves, own).share;
}

}  // namespace

MaskShare worst_share(const Curves& curves, const std::vector<record::HarmonicLimit>& mask) {
  MaskShare out;
  for (const auto& curve : curves) {
    for (const record::HarmonicLimit& line : mask) {
      for (std::size_t j = 0; j + 1 < curve.size(); j += 2) {
        const int k = Basis::order(j);
        if (k < line.first || k > line.last) continue;
        const double share = std::hypot(curve[j], curve[j + 1]) / line.amplitude_mm;
        if (share > out.share) out = {share, line.amplitude_mm};
      }
    }
  }
  return out;
}

std::vector<Asked> mask_lines(const record::Characteristic& asked, const ContourTrials& trials) {
  const double limit_mm = worst_share(trials.total(), asked.harmonic_limits).limit_mm;
  std::vector<Asked> out;
  for (int k = 2; k <= trials.basis().highest; ++k) {
    const double share = harmonic_share(trials.total(), asked.harmonic_limits, k);
    if (share <= kBindingShare) continue;
    Asked line;
    line.value = [&mask = asked.harmonic_limits, limit_mm, k](const Curves& curves) {
      return harmonic_share(curves, mask, k) * limit_mm;
    };
    line.as_measured = share * limit_mm;
    line.has_budget = false;
    out.push_back(std::move(line));
  }
  for (Asked& line : out) line.lines = out.size();
  return out;
}

UncertaintyStatus of_mask_lines(const UncertaintyStatus& greatest,
                                std::span<const UncertaintyStatus> lines) {
  if (!greatest.result()) return greatest;
  std::vector<UncertaintyStatement> said;
  for (const UncertaintyStatus& line : lines) {
    if (!line.result()) return line;
    said.push_back(line.result()->sampled);
  }
  UncertaintyResult result = *greatest.result();
  hold_lines_together(said, result);
  return UncertaintyStatus::stated(std::move(result), greatest.coverage_1());
}

bool is_nearest(const MaskShare& worst, const core::Result<AnalysisValue>& measured) {
  constexpr double kRoundOff = 1e-6;
  return !measured || !measured->limit_mm ||
         measured->value_mm / *measured->limit_mm <= worst.share * (1.0 + kRoundOff);
}

}  // namespace rondure::evaluation::contour_trials
