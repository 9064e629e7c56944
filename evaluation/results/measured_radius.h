#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "evaluation/results/gate.h"
#include "evaluation/uncertainty/influences.h"

namespace rondure::evaluation {

/// An independent error of a measured radius.
struct RadiusError {
  std::string_view name;  ///< Of its row in the budget of the radius: "edge-points".
  std::string_view id;    ///< Of its draws, which all share that name it: "stage.scale".
  double u_mm = 0.0;      ///< Change of the radius for one standard uncertainty, with sign.
  bool rectangular = false;
};

/// The error of a radius in a trial.
[[nodiscard]] double drawn_mm(const std::vector<RadiusError>& errors, std::uint64_t seed,
                              int trial);

/// The radius of a wheel as an earlier feature found it.
struct MeasuredRadius {
  std::string feature;  ///< Id of that feature.
  double radius_mm = 0.0;
  std::optional<double> nominal_mm;
  /// A trial of the feature that takes the radius draws as that of this one does. None: the
  /// feature declares no noise of its points, and u(R) is not known.
  std::optional<std::vector<RadiusError>> errors;

  [[nodiscard]] double u_mm() const;  ///< 0 without errors.
};

/// Takes the radius of an earlier feature and adds the gate "chain-void".
/// @return The radius; or why none can be taken, for which everything is void.
using RadiusOf = std::function<core::Result<MeasuredRadius>(const std::string& id)>;
[[nodiscard]] core::Result<MeasuredRadius> take_radius(const std::string& id,
                                                       const RadiusOf& earlier,
                                                       std::vector<Gate>& gates);

/// How the report lists u(R) among the influences: "wheel-radius".
[[nodiscard]] InfluenceStatement statement_of(const MeasuredRadius& radius);
/// Why u(R) is not known.
[[nodiscard]] core::Phrase no_radius_uncertainty(const MeasuredRadius& radius);

}  // namespace rondure::evaluation
