#pragma once

// A part of surfaces given by their points, for the characteristics of a drawing.

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "evaluation/part/find.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"
#include "record/run_record.h"

namespace rondure::test {

using Layers = std::vector<std::vector<Eigen::Vector3d>>;

inline record::Setting number_setting(const std::string& name, double value) {
  return {name, value, {}};
}
inline record::Setting text_setting(const std::string& name, const std::string& text) {
  return {name, std::nullopt, text};
}

/// Features of one points file.
struct DrawnPart {
  std::vector<evaluation::FeatureResult> features;

  evaluation::FeatureResult& add(const std::string& id, record::Shape shape, const Layers& layers,
                                 record::Side side = record::Side::kOutside) {
    evaluation::FeatureResult out;
    out.feature.id = id;
    out.feature.shape = shape;
    out.feature.side = side;
    out.feature.strategy = record::Strategy::kPointsFile;
    out.feature.layers = static_cast<int>(layers.size());
    out.clamping = evaluation::Clamping{.file = "shaft", .name = {}, .reached = {}};
    for (std::size_t layer = 0; layer < layers.size(); ++layer) {
      for (std::size_t i = 0; i < layers[layer].size(); ++i) {
        evaluation::CloudPoint point;
        point.layer = static_cast<int>(layer);
        point.point = static_cast<int>(i);
        point.tip_mm = layers[layer][i];
        out.cloud.push_back(point);
      }
    }
    features.push_back(std::move(out));
    return features.back();
  }
  evaluation::FeatureResult& cylinder(const std::string& id, const Layers& layers,
                                      record::Side side = record::Side::kOutside) {
    return add(id, record::Shape::kCylinder, layers, side);
  }
  evaluation::FeatureResult& plane(const std::string& id, const Layers& circles) {
    auto& out = add(id, record::Shape::kPlane, circles);
    out.feature.settings = {text_setting("faces", "up")};
    return out;
  }

  /// The last feature that was added is the toleranced one.
  [[nodiscard]] core::Result<evaluation::Finding> last(const record::Characteristic& asked) const {
    return evaluation::find(evaluation::surfaces_of(features), features.size() - 1, asked);
  }
  /// The value of the last feature; a failure of the test without one.
  [[nodiscard]] double value(const record::Characteristic& asked) const {
    const auto found = last(asked);
    EXPECT_TRUE(found.has_value()) << found.error().what;
    return found ? found->judged.front().value_mm : std::nan("");
  }
};

/// A characteristic about datums.
inline record::Characteristic about(
    record::Form form, std::vector<std::string> datum,
    record::Indication::Association association = record::Indication::Association::kLs) {
  record::Characteristic out;
  out.form = form;
  out.indication.datum = std::move(datum);
  out.indication.association = association;
  return out;
}

inline record::Characteristic along(record::Characteristic asked,
                                    record::Indication::Direction direction) {
  asked.indication.direction = direction;
  return asked;
}

/// Why there is no value of the last surface.
inline core::Error why_refused(const DrawnPart& part, const record::Characteristic& asked) {
  const auto found = part.last(asked);
  EXPECT_FALSE(found.has_value()) << "there is a value: " << found->judged.front().value_mm;
  return found ? core::Error{} : found.error();
}

/// Sections of a cylinder along z with the given radius as a function of angle and height.
inline Layers turned_surface(const std::vector<double>& heights, int count,
                             const std::function<Eigen::Vector2d(double, double)>& at) {
  Layers out;
  for (const double z : heights) {
    out.emplace_back();
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d p = at(core::kTwoPi * i / count, z);
      out.back().emplace_back(p.x(), p.y(), z);
    }
  }
  return out;
}

inline Layers round_journal(
    double radius, const std::vector<double>& heights, int count,
    const std::function<Eigen::Vector2d(double)>& center = [](double) {
      return Eigen::Vector2d(0.0, 0.0);
    }) {
  return turned_surface(heights, count, [&](double t, double z) {
    return Eigen::Vector2d(center(z) + radius * Eigen::Vector2d(std::cos(t), std::sin(t)));
  });
}

}  // namespace rondure::test
