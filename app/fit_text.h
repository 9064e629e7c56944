#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "fit/ls_circle.h"
#include "fit/ls_cylinder.h"
#include "fit/min_zone_circle.h"
#include "fit/min_zone_cylinder.h"

namespace rondure::app {

/// What `rondure fit` found of one set of points.
struct FitOutcome {
  std::string shape;
  std::size_t points = 0;
  bool all_references = true;  ///< --reference all: mc and mi are named, as null.
  std::optional<fit::LsCircle> ls_circle;
  std::optional<fit::MinZoneCircle> mz_circle;
  std::optional<fit::LsCylinder> ls_cylinder;
  std::optional<fit::MinZoneCylinder> mz_cylinder;
  std::vector<core::Error> warnings;
};

/// The JSON contract of DESIGN.md ("JSON of fit"), one line feed at the end.
[[nodiscard]] std::string fit_json(const FitOutcome& outcome);
/// The same for a person.
[[nodiscard]] std::string fit_table(const FitOutcome& outcome);

}  // namespace rondure::app
