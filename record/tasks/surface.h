#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "record/run_record.h"
#include "record/tasks/key_spec.h"

namespace rondure::record {

// Settings of a touched cylinder or circle beside the members of Feature, for its
// evaluation without the plan.

/// How the surface is sampled; written only where it is scanned.
struct SamplingSettings {
  SamplingMethod sampling_method = SamplingMethod::kTouch;
};

/// How the clouds of Strategy::kMerged come together; written only there.
struct MergedPosesSettings {
  Merge merge = Merge::kJoint;
  int merged_poses = 2;                                    ///< That the plan asks for.
  std::array<double, 3> axis_point_mm = {0.0, 0.0, 0.0};   ///< Axis of the fixture, machine frame.
  std::array<double, 3> axis_offset_mm = {0.0, 0.0, 0.0};  ///< Offset of the fixture, hoop frame.
};

/// How the surface is brought to 20 degC; without an expansion it stays as measured.
struct ExpansionSettings {
  std::optional<double> part_expansion_per_K;
  std::optional<double> part_expansion_uncertainty_per_K;
  std::optional<double> scale_expansion_per_K;
  std::optional<double> scale_expansion_uncertainty_per_K;
  std::optional<double> temperature_uncertainty_K;
};

template <class Visitor>
void describe(Visitor& v, SamplingSettings& p) {
  v.text("sampling_method", p.sampling_method, {.meaning = "Touches or scanned circles."});
}

template <class Visitor>
void describe(Visitor& v, MergedPosesSettings& p) {
  const NumberSpec place = within(1e6, "Of the axes of the fixture.");
  v.text("merge", p.merge, {.meaning = "How the clouds come together."});
  v.whole("merged_poses", p.merged_poses, range(1.0, 1000.0, "Poses of the plan."));
  v.numbers("axis_point_mm", p.axis_point_mm, place);
  v.numbers("axis_offset_mm", p.axis_offset_mm, place);
}

template <class Visitor>
void describe(Visitor& v, ExpansionSettings& p) {
  const NumberSpec expansion = within(1.0, "Thermal expansion, or its standard uncertainty.");
  v.number("part_expansion_per_K", p.part_expansion_per_K, expansion);
  v.number("part_expansion_uncertainty_per_K", p.part_expansion_uncertainty_per_K, expansion);
  v.number("scale_expansion_per_K", p.scale_expansion_per_K, expansion);
  v.number("scale_expansion_uncertainty_per_K", p.scale_expansion_uncertainty_per_K, expansion);
  v.number("temperature_uncertainty_K", p.temperature_uncertainty_K,
           range(0.0, 1000.0, "Standard, of a temperature."));
}

}  // namespace rondure::record
