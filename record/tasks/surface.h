#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/key_spec.h"
#include "record/run_record.h"

namespace rondure::record {

// Settings of a surface beside the members of Feature, for its
// evaluation without the plan.

/// How the surface is sampled; written only where it is scanned.
struct SamplingSettings {
  SamplingMethod sampling_method = SamplingMethod::kTouch;
};

/// A part of the surface that takes no part: a keyway, an oil hole. Angles count counter-clockwise
/// about the part axis and may wrap; an end that is left out is that of the surface.
struct WindowTask {
  std::string name;
  std::optional<double> from_deg;
  std::optional<double> to_deg;
  std::optional<double> from_mm;  ///< Part z; of a plane the radius.
  std::optional<double> to_mm;
  std::optional<double> guard_mm;  ///< Added on all sides; none: 0.5 mm and the tip radius.
  /// Only the points in it that lie farther than this from the robust profile are left out.
  std::optional<double> found_beyond_um;
};

/// Side to which the material of a plane turns its surface, along part z.
enum class Faces { kUp, kDown };

/// What the evaluation needs to know of a surface beside its points.
struct SurfaceSettings {
  std::string letter;                    ///< Datum letter on the drawing; may be empty.
  std::string clamping;                  ///< Files of one name were measured in one clamping.
  std::optional<Faces> faces;            ///< Of a plane.
  std::optional<double> half_angle_deg;  ///< Of a cone, nominal; > 0: it opens along part z.
  std::optional<double> first_layer_mm;  ///< Nominal height of the lowest layer, part z.
  std::vector<double> part_axis;         ///< Without a fixture: part z, machine frame; else empty.
  std::vector<WindowTask> exclude;
};

RONDURE_WORDS(Faces, {kUp, "up"}, {kDown, "down"});

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
void describe(Visitor& v, WindowTask& p) {
  const NumberSpec angle = within(360.0,
                                  "From part x about the axis of the surface, counter-clockwise "
                                  "from first to second; both left out: the whole turn.");
  const NumberSpec height =
      within(10'000.0, "Part z, of a plane the radius; left out: to the end of the surface.");
  v.text("name", p.name, {.required = true, .empty_allowed = false, .meaning = "e.g. keyway."});
  v.number("from_deg", p.from_deg, angle);
  v.number("to_deg", p.to_deg, angle);
  v.number("from_mm", p.from_mm, height);
  v.number("to_mm", p.to_mm, height);
  v.number("guard_mm", p.guard_mm,
           range(0.0, 100.0,
                 "Widens the stated window on all sides. Left out: 0.5 mm plus the tip radius."));
  v.number("found_beyond_um", p.found_beyond_um,
           above(0.0, 10'000.0,
                 "Leaves out only points farther than this from the robust profile, for a hole "
                 "whose place is not known exactly."));
}

template <class Visitor>
void describe(Visitor& v, SurfaceSettings& p) {
  v.text("letter", p.letter, {.meaning = "Datum letter on the drawing."});
  v.text("clamping", p.clamping, {.meaning = "Files of one name were measured in one clamping."});
  v.text("faces", p.faces, {.meaning = "Side to which a plane faces, along part z."});
  v.number("half_angle_deg", p.half_angle_deg, within(89.0, "Of a cone, nominal."));
  v.number("first_layer_mm", p.first_layer_mm, within(1e6, "Nominal, part z."));
  v.numbers("part_axis", p.part_axis, within(1e6, "Without a fixture: direction of part z."));
  v.list("exclude", p.exclude, {.meaning = "Windows that are left out."});
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
