#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "plans/plan.h"

// Requirements of the features of a plan.

namespace rondure::plans {

/// Whether a feature is a surface touched by a machine: neither points from a file nor an analysis.
[[nodiscard]] bool is_touched(const FeaturePlan& feature);
/// Whether anything of a plan is simulated.
[[nodiscard]] bool simulates_anything(const Plan& plan);
/// Whether the series of a feature are simulated, which is also possible with a real machine.
[[nodiscard]] bool simulates_analysis(const Plan& plan);
/// Whether a feature needs the machine: a touched surface, or balls.
[[nodiscard]] bool needs_machine(const FeaturePlan& feature);
/// Whether the part of a plan stands still on the table: there is no fixture with axes.
[[nodiscard]] bool is_fixed(const Plan& plan);
/// Whether the balls of one feature and the part change places before the other is measured.
[[nodiscard]] inline bool clamped_alike(const FeaturePlan& a, const FeaturePlan& b) {
  return a.rotary_axes.has_value() == b.rotary_axes.has_value();
}
/// Index of the feature that calibrates the fixture for those after it; the number of features when
/// there is none.
[[nodiscard]] std::size_t calibrating_feature(const Plan& plan);
/// Index of the feature with this id; the number of features when there is none.
[[nodiscard]] std::size_t feature_index(const Plan& plan, std::string_view id);
/// Whether a plan needs a machine.
[[nodiscard]] bool touches_anything(const Plan& plan);

/// The characteristics of a feature with the defaults of feature and plan, as the journal keeps
/// them.
[[nodiscard]] std::vector<record::Characteristic> characteristics_of(const Plan& plan,
                                                                     const FeaturePlan& feature);
/// Name of the clamping in which the points of a feature were measured: as it names it, else as the
/// other features of its file name it, where they agree; else the file where several features share
/// it, else empty.
[[nodiscard]] std::string clamping_of(const Plan& plan, const FeaturePlan& feature);

}  // namespace rondure::plans
