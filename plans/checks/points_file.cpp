#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sections.h"
#include "fit/least_squares/sphere.h"
#include "plans/analyses/internal/series_file.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/checks/points_file.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {

using core::Code;
using record::Shape;

namespace {

/// One more than the unknowns of the surface.
std::size_t needed_points(Shape shape) {
  switch (shape) {
    case Shape::kCylinder:
      return 6;
    case Shape::kCone:
      return 7;
    case Shape::kSphere:
      return 5;
    default:
      return 4;
  }
}

/// Refuses the characteristics of a cylinder that need layers.
void check_without_layers(const FeaturePlan& feature, std::size_t index, Findings& findings) {
  for (std::size_t k = 0; k < feature.characteristics.size(); ++k) {
    const record::Form form = feature.characteristics[k].form;
    const bool masked = form == record::Form::kHarmonicLimits;
    const std::string place = item_pointer(feature_pointer(index) + "/characteristics", k);
    if ((!masked && form != record::Form::kRoundness) || !findings.sound(place)) continue;
    findings.meaning(Code::kMeaning, place + "/form",
                     fmt::format("the file has no column layer, so a cylinder from it has no {}; "
                                 "add the column, state source.layers \"heights\"{}, or give each "
                                 "section as a \"circle\"",
                                 masked ? "harmonics" : "roundness",
                                 masked ? "" : ", ask for \"cylindricity\""));
  }
}

/// The diameter that the points of a file show, in the unit of the file; none of other shapes, and
/// where they show none, of which the evaluation tells the reason.
std::optional<double> shown_diameter(Shape shape, const record::PointTable& table) {
  constexpr std::size_t kMost = 1000;
  std::vector<Eigen::Vector3d> points;
  std::vector<int> layers;
  const std::size_t count = std::min(table.points_mm.size(), kMost);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t row = fit::spread_row(k, table.points_mm.size());
    points.push_back(table.points_mm[row]);
    layers.push_back(table.layers.empty() || shape == Shape::kCircle ? 0 : table.layers[row]);
  }
  const auto diameter = [](const auto& fit) {
    return fit ? std::optional(2.0 * fit->radius_mm) : std::nullopt;
  };
  if (shape == Shape::kSphere) return diameter(fit::ls_sphere(points));
  std::optional<Eigen::Vector3d> normal;
  if (shape == Shape::kCircle || !table.layers.empty()) normal = fit::layer_normal(points, layers);
  if (shape == Shape::kCylinder) return diameter(fit::ls_cylinder(points, normal));
  if (shape != Shape::kCircle) return std::nullopt;
  const auto across = fit::across(normal.value_or(Eigen::Vector3d::UnitZ()));
  std::vector<Eigen::Vector2d> flat;
  for (const Eigen::Vector3d& p : points) flat.emplace_back(across.transpose() * (p - points[0]));
  return diameter(fit::ls_circle(flat));
}

/// The longest side of the box about points.
double extent(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  return box.sizes().maxCoeff();
}

/// Checks that a list names the columns of x, y and, where there is one, z.
void check_columns(const SourcePlan& source, const std::string& where, Findings& findings) {
  std::string names;
  for (const ColumnPlan& column : source.columns) names += column.column;
  std::ranges::sort(names);
  if (names.empty() || names == "xy" || names == "xyz") return;
  findings.meaning(Code::kMeaning, where,
                   "name the columns of x and y, or of x, y and z, each once; in_file is the name "
                   "in the head line, or the number of the column, from 1");
}

/// How the points of a source are to be read.
record::PointsOptions points_options(const SourcePlan& source) {
  record::PointsOptions out{source.feature, {}, source.unit, source.layers};
  for (const std::string_view name : {"x", "y", "z"}) {
    for (const ColumnPlan& column : source.columns) {
      if (column.column == name) out.columns.push_back(column.in_file);
    }
  }
  return out;
}

/// Names the rows that no feature of the plan takes; empty: all are taken. Said once a file, at the
/// first feature that takes rows of it.
std::string untaken_rows(const Plan& plan, std::size_t index,
                         const std::vector<record::OtherRows>& others) {
  const auto path = [](const FeaturePlan& f) {
    return std::filesystem::path(f.source->file).lexically_normal();
  };
  const FeaturePlan& own = plan.features[index];
  constexpr std::size_t kMostNamed = 5;
  std::size_t lost = 0;
  std::string names;
  for (const record::OtherRows& rows : others) {
    bool taken = false;
    for (std::size_t k = 0; k < plan.features.size(); ++k) {
      const FeaturePlan& other = plan.features[k];
      if (!other.source || path(other) != path(own)) continue;
      if (k < index && !other.source->feature.empty()) return {};
      taken = taken || other.source->feature == rows.feature;
    }
    if (taken || ++lost > kMostNamed) continue;
    names += fmt::format("{}{} ({} rows from line {} on)", names.empty() ? "" : ", ",
                         in_quotes(rows.feature), rows.count, rows.first_line);
  }
  if (lost > kMostNamed) names += fmt::format(" and {} more", lost - kMostNamed);
  return names;
}

}  // namespace

core::Result<record::PointTable> points_of(const Plan& plan, std::size_t index,
                                           std::string_view bytes) {
  const SourcePlan& source = *plan.features[index].source;
  TRY(auto out, record::read_points(bytes, source.file, points_options(source)));
  if (!source.others) return out;
  if (const std::string rows = untaken_rows(plan, index, out.others); !rows.empty()) {
    out.read += "; left out: " + rows;
  }
  return out;
}

std::optional<core::Error> doubtful_unit(Shape shape, const record::PointTable& table,
                                         std::string_view file) {
  if (table.unit_stated) return std::nullopt;
  // Up to 10 inches are less than 10; parts below 1 mm and above 1 m are none of this program.
  auto size = shown_diameter(shape, table);
  const bool other = shape == Shape::kPlane || shape == Shape::kCone;
  if (other) size = extent(table.points_mm);
  if (!size || (*size >= (other ? 1.0 : 10.0) && *size <= 1000.0)) return std::nullopt;
  const auto in_mm = [&](const char* unit, double factor) {
    const double mm = factor * *size;
    return mm < 1.0 || mm > 1000.0 ? std::string() : fmt::format(", in {} {:.6g} mm", unit, mm);
  };
  const std::string inches = in_mm("inches", 25.4);
  const std::string metres = in_mm("metres", 1000.0);
  const std::string micrometres = in_mm("micrometres", 1e-3);
  const auto option = [](const std::string& size_mm, const char* words) {
    return size_mm.empty() ? "" : words;
  };
  return core::Error{
      Code::kUnits,
      fmt::format("the points of {} show {} of {:.6g}: in mm that is {:.6g} mm{}{}{}; state the "
                  "unit: {}{}{}--unit mm, in a plan source.unit or nominal.diameter_mm",
                  in_quotes(std::string(file)), other ? "an extent" : "a diameter", *size, *size,
                  inches, metres, micrometres, option(inches, "--unit inch or "),
                  option(metres, "--unit m or "), option(micrometres, "--unit um or ")),
      {}};
}

void check_points_file(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index) + "/source/file";
  if (!feature.source || !findings.sound(feature_pointer(index) + "/source")) return;
  const std::string& file = feature.source->file;
  const auto bytes = read_data_file(plan.folder / file, file);
  if (!bytes) return findings.meaning(bytes.error().code, where, bytes.error().what);
  check_columns(*feature.source, feature_pointer(index) + "/source/columns", findings);
  const auto table = points_of(plan, index, *bytes);
  if (!table) {
    const core::Error& error = table.error();
    const bool of_line = error.where != file;
    const bool of_feature = error.code == Code::kMissingKey || !feature.source->feature.empty();
    return findings.meaning(error.code,
                            of_line      ? error.where
                            : of_feature ? feature_pointer(index) + "/source/feature"
                                         : where,
                            error.what);
  }
  if (feature.source->points == record::PointsAre::kSurface && feature.source->tip_diameter_mm) {
    findings.meaning(Code::kMeaning, feature_pointer(index) + "/source/tip_diameter_mm",
                     "has no effect: the points are those of the surface; remove it");
  }
  if (table->mesh && !feature.source->mesh) {
    findings.meaning(Code::kMeaning, feature_pointer(index) + "/source/mesh",
                     fmt::format("{} is a mesh: its vertices were computed from the points of a "
                                 "scan, filtered and thinned; measure points, or state "
                                 "\"mesh\": \"accepted\"",
                                 in_quotes(file)));
  }
  const std::string untaken = untaken_rows(plan, index, table->others);
  if (!untaken.empty() && !feature.source->others) {  // a misspelt name is a defect left out
    findings.meaning(Code::kMeaning, feature_pointer(index) + "/source/feature",
                     fmt::format("the file {} has rows that no feature of the plan takes: {}; "
                                 "correct the names, which count letter by letter, plan a feature "
                                 "for them, take them out, or say \"others\": \"left-out\"",
                                 in_quotes(file), untaken));
  }
  const bool circle = feature.type == record::Shape::kCircle;
  if (!circle && table->dimensions != 3) {
    return findings.meaning(Code::kMeaning, where,
                            fmt::format("the file {} has the columns x,y; a {} needs x,y,z",
                                        in_quotes(file), name_of(feature.type)));
  }
  if (feature.type == record::Shape::kCylinder && table->layers.empty()) {
    check_without_layers(feature, index, findings);
  }
  const std::size_t needed = needed_points(feature.type);
  if (table->points_mm.size() < needed) {
    findings.meaning(
        Code::kTooFewPoints, where,
        fmt::format("the file {} has {} points; a {} needs at least {}", in_quotes(file),
                    table->points_mm.size(), name_of(feature.type), needed));
  } else {
    if (feature.nominal.diameter_mm > 0.0) return;
    if (const auto doubt = doubtful_unit(feature.type, *table, file)) {
      findings.meaning(doubt->code, where, doubt->what);
    }
  }
}

}  // namespace rondure::plans
