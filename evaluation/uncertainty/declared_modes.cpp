#include <cmath>
#include <functional>
#include <set>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "core/units.h"
#include "evaluation/uncertainty/internal/error_modes.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRangeOf25Normals = 3.931;  // mean range of 25 normal values, in sigma

/// Collects the effect of each influence on each point.
class ModeCollector {
 public:
  explicit ModeCollector(std::span<const TouchedPoint> points) : points_(points) {
    for (const TouchedPoint& point : points) {
      middle_ += point.position_mm / static_cast<double>(points.size());
    }
  }

  void begin(std::string_view name) { found.names.emplace_back(name); }

  void add(Distribution distribution, const std::function<double(std::size_t)>& first,
           const std::function<double(std::size_t)>& second = {}) {
    found.modes.push_back(
        {found.names.size() - 1, distribution, static_cast<Index>(found.columns.size())});
    found.columns.push_back(column(first));
    if (second) found.columns.push_back(column(second));
  }

  void add_each(Distribution distribution, const std::function<double(std::size_t)>& sigma) {
    found.point_errors.push_back({found.names.size() - 1, distribution, column(sigma)});
  }

  /// A displacement of the points, in the machine frame.
  void add_motion(Distribution distribution, const std::function<Vector3d(std::size_t)>& motion) {
    add(distribution, [&](std::size_t i) { return points_[i].normal.dot(motion(i)); });
  }

  void probe(const ProbeInfluences& probe);
  void machine(const MachineInfluences& machine);
  void thermal(const ThermalInfluences& thermal);
  void fixture(const FixtureInfluences& fixture);
  void calibration(const CalibrationInfluences& used);

  DeclaredModes found;

 private:
  [[nodiscard]] VectorXd column(const std::function<double(std::size_t)>& value) const {
    VectorXd out(static_cast<Index>(points_.size()));
    for (std::size_t i = 0; i < points_.size(); ++i) out[static_cast<Index>(i)] = value(i);
    return out;
  }
  [[nodiscard]] double time(std::size_t i) const { return points_[i].time_1; }
  void curve(const cmm::GeometricErrors& frame, std::size_t axis, std::size_t component,
             bool rotation);
  void geometry(const cmm::GeometricErrors& terms);
  void length_limit(double constant_mm, double slope);

  std::span<const TouchedPoint> points_;
  Vector3d middle_ = Vector3d::Zero();
};

void ModeCollector::probe(const ProbeInfluences& probe) {
  begin("probe-repeatability");
  if (probe.repeatability_mm > 0.0) {
    add_each(Distribution::kNormal, [&](std::size_t i) {
      return probe.repeatability_mm / std::sqrt(static_cast<double>(points_[i].repeats));
    });
    PointError& error = found.point_errors.back();
    error.degrees_of_freedom = probe.degrees_of_freedom;
    if (probe.correlation_length_mm > 0.0) {
      error.likeness_1 = column([&](std::size_t i) {
        if (i == 0) return 0.0;
        const double way_mm = (points_[i].position_mm - points_[i - 1].position_mm).norm();
        return std::exp(-way_mm / probe.correlation_length_mm);
      });
    }
  }
  begin("probe-lobing");
  for (const cmm::PretravelLobe& lobe : probe.lobes) {
    if (lobe.amplitude_mm == 0.0) continue;
    // Pre-travel shifts the reading along the approach; only its component across the stylus
    // counts.
    const auto wave = [&](std::size_t i, double shift) {
      const Vector3d& n = points_[i].approach;
      const double azimuth = std::atan2(n.y(), n.x());
      return lobe.amplitude_mm / std::sqrt(2.0) * std::hypot(n.x(), n.y()) *
             std::cos(lobe.order * azimuth + shift);
    };
    add(
        Distribution::kPhase, [&](std::size_t i) { return wave(i, 0.0); },
        [&](std::size_t i) { return wave(i, 0.25 * core::kTwoPi); });
  }
  begin("probing-form-limit");
  if (probe.form_limit_mm > 0.0) {
    add_each(Distribution::kNormal,
             [&](std::size_t) { return probe.form_limit_mm / kRangeOf25Normals; });
  }
  begin("tip-qualification");
  if (probe.tip_radius_mm > 0.0) {
    add(Distribution::kNormal, [&](std::size_t) { return probe.tip_radius_mm; });
  }
}

/// Adds the modes of one error curve: its linear and quadratic coefficients, its wave in two
/// phases.
void ModeCollector::curve(const cmm::GeometricErrors& frame, std::size_t axis,
                          std::size_t component, bool rotation) {
  const cmm::AxisErrors& errors = frame.axes[axis];
  const cmm::ErrorCurve declared = (rotation ? errors.rotation : errors.translation)[component];
  const auto motion = [&](const cmm::ErrorCurve& single) {
    cmm::GeometricErrors alone;
    alone.tip_offset_mm = frame.tip_offset_mm;
    cmm::AxisErrors& place = alone.axes[axis];
    (rotation ? place.rotation : place.translation)[component] = single;
    return [this, alone](std::size_t i) {
      return points_[i].normal.dot(cmm::geometric_error_mm(alone, points_[i].position_mm));
    };
  };
  if (declared.linear_1_mm != 0.0) {
    cmm::ErrorCurve single;
    single.linear_1_mm = declared.linear_1_mm;
    add(Distribution::kNormal, motion(single));
  }
  if (declared.quadratic_1_mm2 != 0.0) {
    cmm::ErrorCurve single;
    single.quadratic_1_mm2 = declared.quadratic_1_mm2;
    add(Distribution::kNormal, motion(single));
  }
  if (declared.wave != 0.0) {
    cmm::ErrorCurve single;
    single.wave = declared.wave / std::sqrt(2.0);
    single.period_mm = declared.period_mm;
    cmm::ErrorCurve quarter = single;
    quarter.phase_rad = 0.25 * core::kTwoPi;
    add(Distribution::kPhase, motion(single), motion(quarter));
  }
}

void ModeCollector::geometry(const cmm::GeometricErrors& terms) {
  const auto curves = [&](bool rotation, bool along) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t component = 0; component < 3; ++component) {
        if (rotation || along == (axis == component)) curve(terms, axis, component, rotation);
      }
    }
  };
  begin("machine-position");
  curves(false, true);
  begin("machine-straightness");
  curves(false, false);
  begin("machine-rotation");
  curves(true, false);
  begin("machine-squareness");
  const auto square = [&](double cmm::GeometricErrors::*member) {
    if (terms.*member == 0.0) return;
    cmm::GeometricErrors alone;
    alone.tip_offset_mm = terms.tip_offset_mm;
    alone.*member = terms.*member;
    add_motion(Distribution::kNormal, [&](std::size_t i) {
      return cmm::geometric_error_mm(alone, points_[i].position_mm);
    });
  };
  square(&cmm::GeometricErrors::squareness_xy_rad);
  square(&cmm::GeometricErrors::squareness_xz_rad);
  square(&cmm::GeometricErrors::squareness_yz_rad);
}

void ModeCollector::length_limit(double constant_mm, double slope) {
  begin("machine-length-limit");
  if (constant_mm > 0.0) {
    add_each(Distribution::kRectangular, [&](std::size_t) { return constant_mm / std::sqrt(6.0); });
  }
  if (slope == 0.0) return;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      add_motion(Distribution::kRectangular, [&](std::size_t i) {
        Vector3d e = Vector3d::Zero();
        e[row] = slope / std::sqrt(3.0) * (points_[i].position_mm - middle_)[column];
        return e;
      });
    }
  }
}

void ModeCollector::machine(const MachineInfluences& machine) {
  geometry(machine.terms);
  length_limit(machine.length_limit_mm, machine.length_limit_slope);
}

void ModeCollector::thermal(const ThermalInfluences& thermal) {
  begin("temperature");
  const double growth = std::hypot(thermal.expansion_1_K * thermal.temperature_K,
                                   thermal.from_reference_K * thermal.expansion_uncertainty_1_K);
  if (growth > 0.0) {
    add(Distribution::kNormal, [&](std::size_t i) { return growth * points_[i].distance_mm; });
  }
  begin("temperature-drift");
  const double drift = thermal.expansion_1_K * thermal.drift_K / std::sqrt(3.0);
  if (drift > 0.0) {
    add(Distribution::kRectangular,
        [&](std::size_t i) { return drift * points_[i].radius_mm * time(i); });
  }
  begin("machine-drift");
  for (int axis = 0; axis < 3; ++axis) {
    const double limit = thermal.machine_drift_mm[axis];
    if (limit == 0.0) continue;
    add(Distribution::kRectangular,
        [&](std::size_t i) { return limit / std::sqrt(3.0) * points_[i].normal[axis] * time(i); });
  }
}

void ModeCollector::fixture(const FixtureInfluences& fixture) {
  const Vector3d pivot = fixture.pivot_mm.value_or(middle_);
  const auto turned = [&](std::size_t i, int axis) -> Vector3d {
    return Vector3d::Unit(axis).cross(points_[i].position_mm - pivot);
  };
  std::set<int> poses;
  for (const TouchedPoint& point : points_) poses.insert(point.pose);
  begin("fixture-calibration");
  for (const int pose : poses) {
    const auto here = [&](std::size_t i) { return points_[i].pose == pose ? 1.0 : 0.0; };
    for (int axis = 0; axis < 3; ++axis) {
      if (fixture.angle_rad > 0.0) {
        add_motion(Distribution::kNormal, [&](std::size_t i) -> Vector3d {
          return here(i) * fixture.angle_rad * turned(i, axis);
        });
      }
      if (fixture.position_mm > 0.0) {
        add_motion(Distribution::kNormal, [&](std::size_t i) -> Vector3d {
          return here(i) * fixture.position_mm * Vector3d::Unit(axis);
        });
      }
    }
  }
  begin("fixture-creep");
  for (int axis = 0; axis < 3 && fixture.creep_rad > 0.0; ++axis) {
    add_motion(Distribution::kRectangular, [&](std::size_t i) -> Vector3d {
      return fixture.creep_rad / std::sqrt(3.0) * time(i) * turned(i, axis);
    });
  }
}

void ModeCollector::calibration(const CalibrationInfluences& used) {
  const auto displacements = [&](Distribution distribution, const Eigen::MatrixXd& draws,
                                 double scale) {
    for (Index k = 0; k < draws.cols(); ++k) {
      if (draws.col(k).isZero(0.0)) continue;
      add_motion(distribution, [&](std::size_t i) -> Vector3d {
        const Index first = 6 * static_cast<Index>(points_[i].pose);
        if (first < 0 || first + 6 > draws.rows()) return Vector3d::Zero();  // reference sphere
        const Vector3d turn = draws.block<3, 1>(first + 3, k);
        return scale * (draws.block<3, 1>(first, k) + turn.cross(points_[i].position_mm));
      });
    }
  };
  begin("calibration-stations");
  displacements(Distribution::kNormal, used.draws, 1.0);
  if (!used.growth) return;
  begin("calibration-temperature");
  displacements(Distribution::kRectangular, *used.growth, 1.0 / std::sqrt(3.0));
}

}  // namespace

std::vector<TouchedPoint> touched_points(const FormCloud& cloud) {
  std::vector<TouchedPoint> out;
  out.reserve(cloud.points.size());
  for (const FormPoint& point : cloud.points) {
    Vector3d normal = outward_normal(cloud, point);
    Vector3d position = position_mm(cloud, point);
    if (!cloud.frames.empty()) {
      const Eigen::Isometry3d& frame = cloud.frames.at(static_cast<std::size_t>(point.pose));
      normal = frame.linear() * normal;
      position = frame * position;
    }
    out.push_back({position, normal, cloud.outside ? Vector3d(-normal) : normal, cloud.radius_mm,
                   cloud.radius_mm + point.deviation_mm, point.repeats, point.pose, point.time_1});
  }
  return out;
}

DeclaredModes declared_modes(std::span<const TouchedPoint> points, const Influences& influences) {
  ModeCollector collect(points);
  if (influences.probe) collect.probe(*influences.probe);
  if (influences.machine) collect.machine(*influences.machine);
  if (influences.thermal) collect.thermal(*influences.thermal);
  if (influences.fixture) collect.fixture(*influences.fixture);
  if (influences.calibration) collect.calibration(*influences.calibration);
  return std::move(collect.found);
}

}  // namespace rondure::evaluation
