#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "core/error.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/plane.h"
#include "fit/proof/certificate.h"
#include "fit/sizes/sizes.h"
#include "fit/zone/deviation_range.h"

namespace rondure::app {

/// Centre of a circle (two numbers used) or sphere, the axis of a cylinder, cone or line, or a
/// plane.
struct FitPlace {
  std::optional<fit::Axis> axis;
  std::optional<fit::Plane> plane;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  int coordinates = 3;  ///< Coordinates of the centre: 2 for a circle of points x,y.
  std::optional<Eigen::Vector3d> normal = {};  ///< Of a circle of points x,y,z.
};

/// The result of one reference, for any shape.
struct FitReference {
  FitPlace place;
  std::optional<double> radius_mm;        ///< For least squares, circumscribed, inscribed.
  std::optional<double> inner_radius_mm;  ///< For the minimum zone.
  std::optional<double> outer_radius_mm;
  std::optional<double> full_angle_deg;  ///< For a cone; > 0 if it opens along the axis.
  /// For the minimum zone of a line; for a cone at the point of the axis.
  std::optional<double> diameter_mm;
  double deviation_mm = 0.0;
  std::optional<double> peak_mm;  ///< For the least-squares plane, with the valley.
  std::optional<double> valley_mm;
  std::optional<double> rms_mm;  ///< For least squares.
  bool two_sided = false;        ///< For the minimum zone between two surfaces.
  std::vector<fit::Contact> outer;
  std::vector<fit::Contact> inner;
  std::optional<fit::Certificate> certificate;  ///< For all but least squares.
  std::optional<fit::DeviationRange> range;     ///< For an inscribed circle that is not unique.
};

/// Sizes of a feature (ISO 14405-1).
struct FitSizes {
  struct Global {
    std::string name;                ///< "GG", "GN", "GX", "GC".
    std::optional<double> value_mm;  ///< Empty if it does not exist for these data.
    bool felt = true;                ///< Depends on the tip, which bridges narrow valleys.
  };
  fit::Material material;
  std::vector<Global> global;  ///< Those requested.
  bool local_wanted = false;
  std::optional<fit::RankSizes> local;  ///< Of LP, if requested and there.
};

/// Results of `rondure fit` for one set of points.
struct FitOutcome {
  struct Entry {
    std::string name;                   ///< "ls", "mz", "mc", "mi".
    std::string title;                  ///< "LSCI", "MZCY", ...
    std::optional<FitReference> found;  ///< Empty if it does not exist for these data.
  };
  std::string shape;
  std::string feature;  ///< Empty: the file has one.
  std::size_t points = 0;
  std::string read;               ///< What the reader took for what.
  std::vector<Entry> references;  ///< Those requested, in the order of the names above.
  std::optional<FitSizes> sizes;
  std::vector<core::Error> warnings;
};

/// The outcome as JSON, and as a table.
[[nodiscard]] nlohmann::ordered_json fit_json(const FitOutcome& outcome);
[[nodiscard]] std::string fit_table(const FitOutcome& outcome);

}  // namespace rondure::app
