#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// The minimum zone of a feature as every report states it: that of the cylinder, or of the one
/// section of a circle.
struct Zone {
  double deviation_mm = 0.0;
  /// Radius of the surface when the tip is known, otherwise of the points.
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  double mean_radius_mm = 0.0;      ///< Middle of the zone; of the surface or the points, as above.
  bool of_surface = false;          ///< The radii are corrected for the tip radius.
  std::vector<fit::Contact> outer;  ///< `index` is the row of FeatureResult::cloud.
  std::vector<fit::Contact> inner;
  fit::Certificate certificate;
};

/// The zone of a feature, or nothing when it has none.
[[nodiscard]] std::optional<Zone> zone_of(const FeatureResult& feature);

/// Offset from a radius through tip centres to the radius of the surface: minus rho on an outside
/// feature, plus rho on an inside one, 0 when the tip is unknown [mm].
[[nodiscard]] double surface_offset_mm(const FeatureResult& feature);

/// Least-squares deviation of the feature (peak to valley about the least-squares axis or centre),
/// its rms, and its radius (of the surface or the points, as for the zone).
struct LeastSquares {
  double deviation_mm = 0.0;
  double radius_mm = 0.0;
  double rms_mm = 0.0;
};
[[nodiscard]] std::optional<LeastSquares> least_squares_of(const FeatureResult& feature);

/// The minimum circumscribed or maximum inscribed reference of a feature: that of the cylinder, or
/// of the one section of a circle.
struct OneSided {
  double deviation_mm = 0.0;
  double radius_mm = 0.0;              ///< Radius of the surface or the points, as for the zone.
  std::vector<fit::Contact> contacts;  ///< `index` is the row of FeatureResult::cloud.
  fit::Certificate certificate;
  std::optional<fit::DeviationRange> range;  ///< Only for a circle that is not unique.
};
/// @return The reference, or why it does not exist. Other kinds of reference never exist here.
[[nodiscard]] core::Result<OneSided> one_sided_of(const FeatureResult& feature,
                                                  record::Reference reference);

/// "minimum circumscribed cylinder", "maximum inscribed circle", ...
[[nodiscard]] const char* words_of(record::Reference reference, record::Shape shape);

/// "CYLt", "RONq ACS", "d GN", "d LP SX ACS", "d E" (envelope), "STRt median line", "Run-out
/// axial".
[[nodiscard]] std::string symbol_of(const record::Characteristic& characteristic);
/// Symbol of the zone of a feature: "CYLt", or "RONt" for a circle.
[[nodiscard]] std::string_view symbol_of(record::Shape shape);
/// "MZCY", "LSCY", "MCCY", "MICY", "MZCI", ...; of a straightness "MZLI", "LSLI", of a flatness
/// "MZPL", "LSPL"; empty where no reference is chosen.
[[nodiscard]] std::string reference_of(const record::Characteristic& characteristic);
[[nodiscard]] std::string reference_of(record::Reference reference, record::Shape shape);
/// Unit in which value and limits of a characteristic are written: mm of a size, urad of
/// an angle, um of all else.
[[nodiscard]] core::ValueUnit unit_of(const record::Characteristic& characteristic);

/// The feature without the points in its windows, as a report draws it; nothing where all points
/// take part. Its fits are the same: they never saw those points.
[[nodiscard]] std::optional<FeatureResult> outside_windows(const FeatureResult& feature);

/// The final pose, or nothing when no pose is marked.
[[nodiscard]] const PoseValue* final_pose_of(const FeatureResult& feature);

}  // namespace rondure::evaluation
