#include "reports/invariants.h"

#include <fmt/format.h>

#include "fit/certificate_check.h"

namespace rondure::reports {
namespace {

/// Round-off allowed where one reported value must not exceed another [mm].
constexpr double kInvariantSlack = 1e-9;

/// The certificate of the cylinder, checked by hand. Without a certificate there is nothing to
/// check.
core::Result<void> check_witnesses(const FeatureResult& result) {
  if (!result.mz_cylinder) return {};
  const fit::MinZoneCylinder& zone = *result.mz_cylinder;
  if (zone.certificate.kind == fit::Certificate::Kind::kNone) return {};
  std::vector<Eigen::Vector3d> points;
  for (const CloudPoint& point : result.cloud) points.push_back(point.tip_mm);
  const auto checked = fit::check_zone(
      points, zone.axis, {zone.inner_radius_mm, zone.outer_radius_mm, zone.outer, zone.inner},
      kInvariantSlack);
  if (checked.fault.empty()) return {};
  return core::fail(
      core::Code::kInternal,
      fmt::format("the certificate of the minimum zone of {} points does not hold: {}; "
                  "please report this with the run's journal.db",
                  result.cloud.size(), checked.fault),
      result.feature.id);
}

}  // namespace

core::Result<void> check_invariants(const FeatureResult& result) {
  const auto broken = [&](const char* rule, double left, double right) {
    return core::fail(
        core::Code::kInternal,
        fmt::format("invariant {} does not hold for {} points: {:.17g} mm > {:.17g} mm; "
                    "please report this with the run's journal.db",
                    rule, result.cloud.size(), left, right),
        result.feature.id);
  };
  if (auto checked = check_witnesses(result); !checked) return checked;
  if (result.mz_cylinder) {
    const double mz = result.mz_cylinder->width_mm();
    if (!(mz <= result.ls_cylinder->deviation_mm + kInvariantSlack)) {
      return broken("MZ <= LS", mz, result.ls_cylinder->deviation_mm);
    }
  }
  for (const LayerResult& layer : result.layers) {
    if (!layer.mz || !layer.ls) continue;
    if (!(layer.mz->width_mm() <= layer.ls->deviation_mm + kInvariantSlack)) {
      return broken("MZ <= LS of a section", layer.mz->width_mm(), layer.ls->deviation_mm);
    }
    if (result.mz_cylinder &&
        !(layer.mz->width_mm() <= result.mz_cylinder->width_mm() + kInvariantSlack)) {
      return broken("RONt <= CYLt", layer.mz->width_mm(), result.mz_cylinder->width_mm());
    }
  }
  return {};
}

}  // namespace rondure::reports
