#include "tests/evaluation/points_run.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "evaluation/evaluate.h"

namespace rondure::reports {

using namespace evaluation;

using record::Form;
using record::Reference;

std::vector<Eigen::Vector3d> rough_part(std::uint64_t seed, int layers, int points_per_layer,
                                        double arc_rad) {
  core::KeyedNoise noise(seed, {71});
  const double oval = 6e-3 * noise.uniform();
  const double taper = 1e-4 * noise.uniform();
  std::vector<Eigen::Vector3d> out;
  for (int layer = 0; layer < layers; ++layer) {
    const double z = 15.0 * layer;
    for (int i = 0; i < points_per_layer; ++i) {
      const double t = arc_rad * (i + 0.3 * layer) / points_per_layer;
      const double r = 25.0 + oval * std::cos(2.0 * t + 0.1 * z) + 2e-3 * std::cos(3.0 * t) +
                       taper * z + 1e-3 * noise.normal();
      out.emplace_back(10.0 + 0.01 * z + r * std::cos(t), -4.0 + r * std::sin(t), z);
    }
  }
  return out;
}

record::RunRecord points_run(const std::vector<Eigen::Vector3d>& points, int layers) {
  record::RunRecord out;
  out.header.run_id = "points";
  out.header.version = "0.0.7";
  out.header.processor = "the one that measured";
  out.ending = "finished";
  record::Feature feature;
  feature.id = "land";
  feature.shape = layers > 1 ? record::Shape::kCylinder : record::Shape::kCircle;
  feature.strategy = record::Strategy::kPointsFile;
  feature.tip_radius_mm = 1.5;
  feature.layers = layers;
  feature.points_per_layer = static_cast<int>(points.size()) / layers;
  for (const Form form : {Form::kCylindricity, Form::kRoundness}) {
    if (layers == 1 && form == Form::kCylindricity) continue;
    for (const Reference reference :
         {Reference::kLeastSquares, Reference::kMinimumZone, Reference::kMinimumCircumscribed,
          Reference::kMaximumInscribed}) {
      const std::string id = std::string(name_of(form)) + " " + std::string(name_of(reference));
      feature.characteristics.push_back({id, form, reference, 1.0, ""});
    }
  }
  out.features.push_back(feature);
  out.poses.push_back({0, 0, {}, {}, true, 0.0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    record::Touch touch;
    touch.id = static_cast<std::int64_t>(i);
    touch.pose = 0;
    touch.layer = static_cast<int>(i) / feature.points_per_layer;
    touch.point = static_cast<int>(i) % feature.points_per_layer;
    touch.tip_mm = points[i];
    out.touches.push_back(touch);
  }
  return out;
}

record::Feature& add_to_points_run(record::RunRecord& run, const std::string& id,
                                   record::Shape shape,
                                   const std::vector<std::vector<Eigen::Vector3d>>& layers,
                                   record::Side side) {
  run.ending = "finished";
  const int pose = static_cast<int>(run.poses.size());
  run.poses.push_back({pose, static_cast<int>(run.features.size()), {}, {}, true, 0.0});
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    for (std::size_t i = 0; i < layers[layer].size(); ++i) {
      record::Touch touch;
      touch.id = static_cast<std::int64_t>(run.touches.size());
      touch.pose = pose;
      touch.layer = static_cast<int>(layer);
      touch.point = static_cast<int>(i);
      touch.tip_mm = layers[layer][i];
      run.touches.push_back(touch);
    }
  }
  record::Feature& feature = run.features.emplace_back();
  feature.id = id;
  feature.shape = shape;
  feature.side = side;
  feature.strategy = record::Strategy::kPointsFile;
  feature.points_file = "shaft.csv";
  feature.points_sha256 = "of shaft.csv";
  feature.tip_radius_mm = 1.5;
  feature.layers = static_cast<int>(layers.size());
  feature.points_per_layer = static_cast<int>(layers.front().size());
  return feature;
}

evaluation::Evaluation evaluated(const record::RunRecord& run) {
  auto out = evaluate(run);
  EXPECT_TRUE(out) << (out ? "" : out.error().what);
  return out.value_or(evaluation::Evaluation{});
}

}  // namespace rondure::reports
