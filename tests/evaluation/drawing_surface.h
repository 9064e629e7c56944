#pragma once

// Prepared surfaces of the worked examples, and characteristics that ask something of them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/units.h"
#include "evaluation/part/surface.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/plane.h"
#include "record/run_record.h"
#include "tests/fit/drawing_cases.h"

namespace rondure::test {

/// A surface with the feature that it is of.
struct DrawnSurface {
  std::unique_ptr<evaluation::FeatureResult> of = std::make_unique<evaluation::FeatureResult>();
  evaluation::PreparedSurface surface;
};

/// A touched cylinder of some layers.
/// @param window  Row of each layer that a window "keyway" takes out.
inline DrawnSurface drawn(const Layers& layers, const fit::Material& material,
                          const std::vector<std::size_t>& window = {}) {
  DrawnSurface out;
  out.of->feature.side = material.inside ? record::Side::kInside : record::Side::kOutside;
  out.of->feature.layers = static_cast<int>(layers.size());
  out.of->feature.points_per_layer = static_cast<int>(layers.front().size());
  evaluation::PreparedSurface& surface = out.surface;
  surface.of = out.of.get();
  surface.material = material;
  surface.tip_known = true;
  for (std::size_t j = 0; j < layers.size(); ++j) {
    evaluation::SurfaceSection section;
    section.layer = static_cast<int>(j);
    for (std::size_t i = 0; i < layers[j].size(); ++i) {
      const std::size_t row = out.of->cloud.size();
      evaluation::CloudPoint point;
      point.layer = section.layer;
      point.point = static_cast<int>(i);
      point.tip_mm = layers[j][i];
      out.of->cloud.push_back(point);
      if (std::find(window.begin(), window.end(), i) != window.end()) {
        surface.left_out.push_back({row, "keyway"});
        section.gap = true;
        continue;
      }
      section.points.push_back(surface.points_mm.size());
      surface.points_mm.push_back(layers[j][i]);
      surface.rows.push_back(row);
    }
    surface.sections.push_back(std::move(section));
  }
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto cylinder = fit::ls_cylinder(surface.points_mm, up);
  surface.axis = cylinder ? cylinder->axis : fit::Axis{fit::mean_point(surface.points_mm), up};
  for (auto& section : surface.sections) {
    for (const std::size_t i : section.points) {
      section.height_mm +=
          (surface.points_mm[i] - surface.axis.point_mm).dot(surface.axis.direction) /
          static_cast<double>(section.points.size());
    }
  }
  return out;
}

/// A plane that faces up.
inline DrawnSurface drawn_plane(const std::vector<Eigen::Vector3d>& points) {
  DrawnSurface out;
  out.of->feature.shape = record::Shape::kPlane;
  out.surface.of = out.of.get();
  out.surface.tip_known = true;
  out.surface.points_mm = points;
  for (std::size_t i = 0; i < points.size(); ++i) out.surface.rows.push_back(i);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto plane = fit::ls_plane(points, up);
  if (plane) out.surface.axis = {plane->plane.point_mm, plane->plane.normal};
  return out;
}

/// A characteristic of a form about a reference.
inline record::Characteristic asked(record::Form form,
                                    record::Reference reference = record::Reference::kMinimumZone) {
  record::Characteristic out;
  out.form = form;
  out.reference = reference;
  return out;
}

/// The same layers about the z axis at equal angles: radii r(layer, angle).
template <class Radius>
Layers turned_layers(int layers, int points, const Radius& radius, double spacing_mm = 15.0,
                     double start_rad = 0.0, double stagger_rad = 0.0) {
  Layers out;
  for (int j = 0; j < layers; ++j) {
    auto& layer = out.emplace_back();
    for (int i = 0; i < points; ++i) {
      const double t = start_rad + stagger_rad * j + core::kTwoPi * i / points;
      const double r = radius(j, t);
      layer.emplace_back(r * std::cos(t), r * std::sin(t), spacing_mm * j);
    }
  }
  return out;
}

}  // namespace rondure::test
