// Scans: the part of inspection.h that measures whole circles.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cmm/grid.h"
#include "cmm/scan_path.h"
#include "cmm/touch_check.h"
#include "core/units.h"
#include "plans/run/internal/inspection.h"

namespace rondure::plans {
namespace {

/// The rows of a scan: the index of each point, and the direction of approach to the read position.
std::vector<record::Touch> rows_of(const ScanStep& step, const std::vector<Eigen::Vector3d>& tips) {
  const cmm::ScanCircleCommand command = cmm::on_grid(step.command);
  std::vector<record::Touch> rows(tips.size(), step.row);
  for (std::size_t i = 0; i < tips.size(); ++i) {
    // Real machines give approximately the requested number of points, and not at even angles.
    const auto index = static_cast<int>(i);
    const cmm::TouchCommand point =
        cmm::scan_point_at(command, cmm::scan_angle(command, tips[i]), index);
    rows[i].id = point.id;
    rows[i].point = index;
    rows[i].approach = point.direction_W;
  }
  return rows;
}

template <class Point>
std::vector<Eigen::Vector3d> tips_of(const std::vector<Point>& points,
                                     Eigen::Vector3d Point::*tip) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(points.size());
  for (const Point& point : points) out.push_back(point.*tip);
  return out;
}
/// Largest distance at which a recorded point of a scan counts as its start.
constexpr double kAtStart_mm = 0.01;

/// Path from the pre-touch point at the start of a scan to the one at an angle, around the surface.
Polyline arc_to(const cmm::ScanCircleCommand& scan, double angle_rad) {
  constexpr double kPiece_rad = 2.0 * core::kDegree;  // its chord is 0.02 % of the radius closer
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / kPiece_rad)));
  Polyline out;
  for (int i = 0; i <= pieces; ++i) {
    out.push_back(cmm::start_of(cmm::scan_point_at(scan, angle_rad * i / pieces, 0)));
  }
  return out;
}

bool of_one_scan(const record::Touch& a, const record::Touch& b) {
  return a.purpose == b.purpose && a.pose == b.pose && a.layer == b.layer && a.repeat == b.repeat;
}

}  // namespace

core::Result<std::vector<record::Touch>> RunContext::scan(ScanStep step) {
  step.command.first_id = next_touch;
  if (recorded.touch(next_touch) != nullptr) return replay_scan(std::move(step));
  TRY_DO(check_stop());
  const NextMove next = {NextMove::Kind::kTouch, doing + ": scan", cell->machine().position_W_mm(),
                         step.command.start_tip_W_mm};
  TRY_DO(ask(next));
  TRY(const auto readings, cell->machine().scan_circle(step.command));
  std::vector<record::Touch> rows = rows_of(step, tips_of(readings, &cmm::TouchReading::tip_W_mm));
  for (std::size_t i = 0; i < rows.size(); ++i) take_reading(readings[i], rows[i]);
  TRY_DO(journal.add(rows));
  note_truth(rows);
  next_touch += static_cast<std::int64_t>(rows.size());
  progress.touches = static_cast<std::size_t>(next_touch);
  if (!rows.empty()) progress.time_s = rows.back().time_s;
  show();
  return rows;
}

core::Result<std::vector<record::Touch>> RunContext::replay_scan(ScanStep step) {
  std::vector<record::Touch> known;
  for (std::int64_t id = next_touch;; ++id) {
    const record::Touch* row = recorded.touch(id);
    if (row == nullptr || (!known.empty() && !of_one_scan(*row, known.front()))) break;
    known.push_back(*row);
  }
  const auto planned = rows_of(step, tips_of(known, &record::Touch::tip_mm));
  for (std::size_t i = 0; i < known.size(); ++i) {
    TRY_DO(check_same_step(known[i], planned[i]));
  }
  TouchStep first;
  first.scan = step.command;
  first.scan_end = reading_of(known.back());
  // A real machine may begin a scan off its start: the touch is at the nearest recorded point.
  const cmm::ScanCircleCommand command = cmm::on_grid(step.command);
  const auto off_start = [&](const record::Touch& row) {
    return std::abs(cmm::scan_angle(command, row.tip_mm));
  };
  const record::Touch& nearest = *std::min_element(
      known.begin(), known.end(),
      [&](const record::Touch& a, const record::Touch& b) { return off_start(a) < off_start(b); });
  const double off_rad = cmm::scan_angle(command, nearest.tip_mm);
  const double radius_mm = (command.start_tip_W_mm - command.center_W_mm).norm();
  const bool at_start = std::abs(off_rad) * radius_mm <= kAtStart_mm;
  first.command = at_start ? cmm::scan_point(command, 0) : cmm::scan_point_at(command, off_rad, 0);
  if (!at_start) first.aside_W = arc_to(command, off_rad);
  first.row = nearest;
  first.entry_W = std::move(step.entry_W);
  first.way_W = std::move(step.way_W);
  TRY_DO(replay_state(first));
  note_truth(known);
  next_touch += static_cast<std::int64_t>(known.size());
  TRY_DO(keep_replayed(std::move(first)));
  return known;
}

core::Result<std::vector<Eigen::Vector3d>> FeatureSession::measure_cloud() {
  if (feature_.sampling.method == record::SamplingMethod::kScan) return scan_cloud(targets_);
  return touch_cloud(targets_, record::Touch::Purpose::kMeasure);
}

std::vector<Target> FeatureSession::reach_targets() const {
  constexpr int kAround = 24;  // every 15 deg: the shaft of the stylus is wider than this spacing
  if (feature_.sampling.method != record::SamplingMethod::kScan) return targets_;
  const int step = std::max(1, feature_.sampling.points_per_layer / kAround);
  std::vector<Target> out;
  std::copy_if(targets_.begin(), targets_.end(), std::back_inserter(out),
               [&](const Target& target) { return target.point % step == 0; });
  return out;
}

ScanStep FeatureSession::scan_of(TouchStep first, const Target& start, int points) const {
  const Eigen::Isometry3d X_WP = part_at(reached_);
  ScanStep out;
  out.command.center_W_mm = X_WP * Eigen::Vector3d(0.0, 0.0, start.z_mm);
  out.command.axis_W = X_WP.linear() * Eigen::Vector3d::UnitZ();
  out.command.start_tip_W_mm = first.command.expected_tip_W_mm;
  out.command.inside = geometry_.inside;
  out.command.sweep_rad = core::kTwoPi;
  out.command.points = points;
  out.command.approach_mm = first.command.approach_mm;
  out.command.search_mm = first.command.search_mm;
  out.row = first.row;
  out.entry_W = std::move(first.entry_W);
  out.way_W = std::move(first.way_W);
  return out;
}

core::Result<std::vector<Eigen::Vector3d>> FeatureSession::scan_cloud(
    const std::vector<Target>& targets) {
  std::vector<Target> starts;  // after a full revolution the tip ends at its start
  for (const Target& target : targets) {
    if (starts.empty() || target.layer != starts.back().layer) starts.push_back(target);
  }
  const auto points = static_cast<int>(targets.size() / starts.size());
  TRY(const auto path, lay(starts, reached_));
  std::vector<std::vector<Eigen::Vector3d>> layers(starts.size());
  const auto scan = [&](TouchStep first, std::size_t k) -> core::Result<void> {
    const Target& start = path.target(k);
    const auto rows = context_.scan(scan_of(std::move(first), start, points));
    if (!rows) {
      const bool known = context_.lost_place || context_.relocation_due;
      return known ? core::fail(rows.error()) : fault_at(start, rows.error());
    }
    for (const record::Touch& row : *rows) layers[path.order()[k]].push_back(row.tip_mm);
    return {};
  };
  TRY_DO(visit(path, record::Touch::Purpose::kMeasure, true, scan));
  std::vector<Eigen::Vector3d> tips;
  for (const auto& layer : layers) tips.insert(tips.end(), layer.begin(), layer.end());
  return tips;
}

}  // namespace rondure::plans
