#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <Eigen/Core>

#include "core/error.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/proof/certificate.h"
#include "fit/zone/deviation_range.h"

namespace rondure::app {

/// Centre of a circle (two numbers used) or sphere, or the axis of a cylinder or line.
struct FitPlace {
  std::optional<fit::Axis> axis;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  int coordinates = 3;  ///< Of the centre: 2 for a circle.
};

/// The result of one reference, for any shape.
struct FitReference {
  FitPlace place;
  std::optional<double> radius_mm;        ///< Least squares, circumscribed, inscribed.
  std::optional<double> inner_radius_mm;  ///< Minimum zone.
  std::optional<double> outer_radius_mm;
  std::optional<double> diameter_mm;  ///< Minimum zone of a line.
  double deviation_mm = 0.0;
  std::optional<double> rms_mm;  ///< Least squares.
  std::vector<fit::Contact> outer;
  std::vector<fit::Contact> inner;
  std::optional<fit::Certificate> certificate;  ///< All but least squares.
  std::optional<fit::DeviationRange> range;     ///< For an inscribed circle that is not unique.
};

/// Results of `rondure fit` for one set of points.
struct FitOutcome {
  struct Entry {
    std::string name;                   ///< "ls", "mz", "mc", "mi".
    std::string title;                  ///< "LSCI", "MZCY", ...
    std::optional<FitReference> found;  ///< Empty: it does not exist for these data.
  };
  std::string shape;
  std::size_t points = 0;
  std::vector<Entry> references;  ///< Those requested, in the order of the names above.
  std::vector<core::Error> warnings;
};

/// A certificate as JSON, and as "certificate global, all centres, gap 1.0e-15 mm; reason". Without
/// a proof the gap is null, and missing in the text.
[[nodiscard]] nlohmann::ordered_json certificate_json(const fit::Certificate& certificate);
[[nodiscard]] std::string certificate_text(const fit::Certificate& certificate);

/// The JSON contract of DESIGN.md ("JSON of fit").
[[nodiscard]] nlohmann::ordered_json fit_json(const FitOutcome& outcome);
/// The outcome as a table.
[[nodiscard]] std::string fit_table(const FitOutcome& outcome);

}  // namespace rondure::app
