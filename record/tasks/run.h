#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "record/key_spec.h"
#include "record/points/points.h"

namespace rondure::record {

// The conditions of a run as its journal holds them, for its evaluation without the plan. The plan
// has tighter limits; these keep nonsense out of the computation.

/// Temperatures of the plan, at "environment/".
struct EnvironmentSettings {
  std::optional<std::string> declared;  ///< There when the plan states limits, also for files.
  std::optional<double> assumed_degC;   ///< Temperature of part and scales when not measured.
  double max_drift_K = 0.5;             ///< Of an analysis: greatest change at one place.
};

/// The plane in which a circle of a file is evaluated: that of its points, or that normal to z.
enum class SectionPlane { kPoints, kNominal };

RONDURE_WORDS(SectionPlane, {kPoints, "points"}, {kNominal, "nominal"});

/// The file that a feature takes its data from, at "source/".
struct SourceSettings {
  std::optional<std::string> measured_utc;  ///< When they were measured; none: not stated.
  std::optional<double> valid_for_days;     ///< How long they stand for the part.
  std::optional<SectionPlane> plane;        ///< Of a circle; none: not stated.
  std::optional<std::string> read;          ///< What the reader of points took for what.
  std::optional<RepeatedRows> repeated;     ///< Rows that it left out; none: each is there once.
};

/// Who measured for whom, at "head/": the laboratory of the plan, --order and --customer.
struct HeadSettings {
  std::optional<std::string> order;
  std::optional<std::string> customer;
  std::optional<std::string> laboratory;  ///< Its name; none: the plan names no laboratory.
  std::optional<std::string> address;
  std::optional<std::string> country;
  std::optional<std::string> contact;
  std::optional<std::string> logo;  ///< "data:image/png;base64,..." or of a JPEG.
};

/// On what the tip is qualified.
enum class ReferenceArtefact { kSphere, kColumn };
RONDURE_WORDS(ReferenceArtefact, {kSphere, "sphere"}, {kColumn, "column"});

/// How the probe is qualified, where it is not on a sphere.
struct QualificationSettings {
  ReferenceArtefact artefact = ReferenceArtefact::kSphere;
  double column_slope_deg = 30.0;  ///< Greatest slope of an approach that a column vouches for.
};

/// The fixture that carried the parts, at "fixture/".
struct FixtureSettings {
  std::string id;
  std::array<double, 3> axis_point_mm = {0.0, 0.0, 0.0};   ///< Machine frame.
  std::array<double, 3> axis_offset_mm = {0.0, 0.0, 0.0};  ///< Hoop frame.
  double min_alpha_deg = 0.0;
  double max_alpha_deg = 0.0;
  double min_beta_deg = 0.0;
  double max_beta_deg = 0.0;
  std::optional<double> resolution_deg;           ///< Of its driver; only of a calibration.
  std::optional<double> setting_uncertainty_deg;  ///< Of a fixture that is set by hand; the same.
  std::optional<double> max_age_days;             ///< Limit on its calibration.
  std::optional<double> max_residual_um;          ///< Limit on its calibration.
  std::optional<std::string> calibration;  ///< The file, whole; none: the fixture is nominal.
  /// Id of the feature that calibrates it for those after it; the run takes note of what they take.
  std::optional<std::string> calibrated_by;
  std::optional<std::string> bodies;  ///< Files of bodies that paths avoid, each with its SHA-256.
};

template <class Visitor>
void describe(Visitor& v, EnvironmentSettings& p) {
  v.text("declared", p.declared, {.meaning = "What the plan states."});
  v.number("assumed_degC", p.assumed_degC, within(1000.0, "Of part and scales."));
  v.number("max_drift_K", p.max_drift_K, range(0.0, 1000.0, "Of an analysis."));
}

template <class Visitor>
void describe(Visitor& v, QualificationSettings& p) {
  v.text("artefact", p.artefact, {.meaning = "On what the tip is qualified."});
  v.number("column_slope_deg", p.column_slope_deg, range(0.0, 90.0, "Of approaches."));
}

template <class Visitor>
void describe(Visitor& v, RepeatedRows& p) {
  constexpr double kMost = 1e12;
  v.whole("count", p.count, range(0.0, kMost, "Rows that repeat an earlier one."));
  v.whole("first", p.first, range(0.0, kMost, "The first of them, from 0."));
  v.whole("original", p.original, range(0.0, kMost, "The row that it repeats."));
}

template <class Visitor>
void describe(Visitor& v, SourceSettings& p) {
  v.text("measured_utc", p.measured_utc, {.meaning = "When the data were measured."});
  v.number("valid_for_days", p.valid_for_days, range(0.0, 36'500.0, "How long they stand."));
  v.text("plane", p.plane, {.meaning = "In which a circle is evaluated."});
  v.text("read", p.read, {.meaning = "What the reader of points took for what."});
  v.object("repeated", p.repeated, {.meaning = "Rows that it left out."});
}

template <class Visitor>
void describe(Visitor& v, HeadSettings& p) {
  v.text("order", p.order, {.meaning = "Order that the run belongs to."});
  v.text("customer", p.customer, {.meaning = "For whom the part is inspected."});
  v.text("laboratory", p.laboratory, {.meaning = "Name of the laboratory."});
  v.text("address", p.address, {.meaning = "Of the laboratory."});
  v.text("country", p.country, {.meaning = "Of the laboratory."});
  v.text("contact", p.contact, {.meaning = "Of the laboratory."});
  v.text("logo", p.logo, {.meaning = "Of the laboratory, a picture in base64."});
}

template <class Visitor>
void describe(Visitor& v, FixtureSettings& p) {
  const NumberSpec place = within(1e6, "Of the axes.");
  const NumberSpec angle = within(360.0, "End of travel.");
  v.text("id", p.id, {.meaning = "As on its label."});
  v.numbers("axis_point_mm", p.axis_point_mm, place);
  v.numbers("axis_offset_mm", p.axis_offset_mm, place);
  v.number("min_alpha_deg", p.min_alpha_deg, angle);
  v.number("max_alpha_deg", p.max_alpha_deg, angle);
  v.number("min_beta_deg", p.min_beta_deg, angle);
  v.number("max_beta_deg", p.max_beta_deg, angle);
  v.number("resolution_deg", p.resolution_deg, range(0.0, 360.0, "Of its driver."));
  v.number("setting_uncertainty_deg", p.setting_uncertainty_deg, range(0.0, 360.0, "By hand."));
  v.number("max_age_days", p.max_age_days, range(0.0, 1e6, "Of the calibration."));
  v.number("max_residual_um", p.max_residual_um, range(0.0, 1e6, "Of the calibration."));
  v.text("calibration", p.calibration, {.meaning = "Its file, whole."});
  v.text("calibrated_by", p.calibrated_by, {.meaning = "The feature of this run that does it."});
  v.text("bodies", p.bodies, {.meaning = "Files of the bodies that paths avoid: name, SHA-256."});
}

}  // namespace rondure::record
