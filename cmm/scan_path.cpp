#include "cmm/scan_path.h"

#include <cmath>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

constexpr double kMaxSweep_rad = 1000.0 * core::kTwoPi;

Vector3d radius_of(const ScanCircleCommand& command) {
  return command.start_tip_W_mm - command.center_W_mm;
}

}  // namespace

core::Result<void> check_scan(const ScanCircleCommand& command) {
  const auto refuse = [&](const std::string& why) {
    return core::machine_fault("scan from point {}: {}; no motion", command.first_id, why);
  };
  const bool finite = command.center_W_mm.allFinite() && command.axis_W.allFinite() &&
                      command.start_tip_W_mm.allFinite() && std::isfinite(command.sweep_rad) &&
                      std::isfinite(command.approach_mm) && std::isfinite(command.search_mm);
  if (!finite) return refuse("the command is not finite");
  if (std::abs(command.axis_W.norm() - 1.0) > 1e-9) {
    return refuse(fmt::format("its axis has the length {:.9g}, not 1", command.axis_W.norm()));
  }
  const double radius_mm = radius_of(command).norm();
  if (!(radius_mm > 1e-3)) {
    return refuse(fmt::format("its radius of {:.7g} mm is not above 0.001 mm", radius_mm));
  }
  const double out_of_plane_mm = radius_of(command).dot(command.axis_W);
  if (std::abs(out_of_plane_mm) > 1e-6) {
    return refuse(
        fmt::format("its start lies {:.7g} mm out of the plane of the circle", out_of_plane_mm));
  }
  if (command.sweep_rad == 0.0 || std::abs(command.sweep_rad) > kMaxSweep_rad) {
    return refuse(fmt::format("a sweep of {:.7g} deg is 0 or beyond {:.7g} deg",
                              command.sweep_rad / core::kDegree, kMaxSweep_rad / core::kDegree));
  }
  if (command.points < 3 || command.points > kMaxScanPoints) {
    return refuse(fmt::format("{} points are outside 3..{}", command.points, kMaxScanPoints));
  }
  if (command.approach_mm < 0.0 || command.approach_mm + command.search_mm < 0.0) {
    return refuse("the search of the surface ends before it starts");
  }
  return {};
}

TouchCommand scan_point(const ScanCircleCommand& command, int index) {
  return scan_point_at(command, command.sweep_rad * index / command.points, index);
}

TouchCommand scan_point_at(const ScanCircleCommand& command, double angle_rad, int index) {
  const Vector3d& n = command.axis_W;
  Vector3d radius = radius_of(command);
  radius -= n * n.dot(radius);  // the grid leaves the start slightly out of the plane
  const Vector3d turned = std::cos(angle_rad) * radius + std::sin(angle_rad) * n.cross(radius);
  TouchCommand out;
  out.id = command.first_id + index;
  out.expected_tip_W_mm = command.center_W_mm + turned;
  out.direction_W = (command.inside ? 1.0 : -1.0) * turned.normalized();
  out.approach_mm = command.approach_mm;
  out.search_mm = command.search_mm;
  return out;
}

double scan_angle(const ScanCircleCommand& command, const Vector3d& p_W_mm) {
  const Vector3d p = p_W_mm - command.center_W_mm;
  const Vector3d radius = radius_of(command);
  return std::atan2(command.axis_W.dot(radius.cross(p)), radius.dot(p));
}

double scan_length_mm(const ScanCircleCommand& command) {
  return radius_of(command).norm() * std::abs(command.sweep_rad);
}

std::string in_words(const Eigen::Vector3d& p_mm) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", p_mm.x(), p_mm.y(), p_mm.z());
}

}  // namespace rondure::cmm
