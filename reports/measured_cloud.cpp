#include "reports/measured_cloud.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "fit/center_search.h"

namespace rondure::reports {

std::vector<const record::Touch*> touches_of(const record::RunRecord& record, int pose) {
  std::vector<const record::Touch*> out;
  for (const record::Touch& touch : record.touches) {
    if (touch.purpose == record::Touch::Purpose::kMeasure && touch.pose == pose)
      out.push_back(&touch);
  }
  return out;
}

std::vector<CloudPoint> averaged(const std::vector<const record::Touch*>& touches) {
  std::map<std::pair<int, int>, CloudPoint> targets;
  for (const record::Touch* touch : touches) {
    auto [found, fresh] = targets.try_emplace({touch->layer, touch->point});
    CloudPoint& point = found->second;
    point.layer = touch->layer;
    point.point = touch->point;
    point.repeats = fresh ? 1 : point.repeats + 1;
    // Running mean: keeps the digits of coordinates far from the origin.
    point.tip_mm += (touch->tip_mm - point.tip_mm) / point.repeats;
  }
  std::vector<CloudPoint> out;
  out.reserve(targets.size());
  for (const auto& [key, point] : targets) out.push_back(point);
  return out;
}

std::vector<Eigen::Vector3d> tips_of(const std::vector<CloudPoint>& cloud) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(cloud.size());
  for (const CloudPoint& point : cloud) out.push_back(point.tip_mm);
  return out;
}

std::vector<Eigen::Vector2d> projected(const std::vector<Eigen::Vector3d>& points,
                                       const Eigen::Matrix3d& turn) {
  std::vector<Eigen::Vector2d> out;
  out.reserve(points.size());
  for (const Eigen::Vector3d& p : points) out.emplace_back((turn * p).head<2>());
  return out;
}

Eigen::Matrix3d rotation(const core::Pose& pose) {
  return (Eigen::AngleAxisd(pose.alpha_rad, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(pose.beta_rad, Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

PoseValue pose_value(const std::vector<Eigen::Vector2d>& section, record::Strategy strategy) {
  PoseValue out;
  const auto search = strategy == record::Strategy::kAsPublished
                          ? fit::center_search_as_published(section)
                          : fit::center_search(section);
  if (!search) {
    out.ending = search.error().what;
    return out;
  }
  out.f_mm = search->width_mm();
  out.ending = std::string(fit::name_of(search->ending));
  out.valid = true;
  return out;
}

bool is_final(const record::RunRecord& record, const record::PoseVisit& visit) {
  if (!visit.final_cloud) return false;
  const auto strategy = record.features[static_cast<std::size_t>(visit.feature)].strategy;
  if (strategy == record::Strategy::kMerged) return true;
  return std::none_of(
      record.poses.begin(), record.poses.end(), [&](const record::PoseVisit& other) {
        return other.final_cloud && other.feature == visit.feature && other.id > visit.id;
      });
}

std::optional<PoseValue> value_of_pose(const record::RunRecord& record,
                                       const record::PoseVisit& visit, record::Strategy strategy) {
  const auto cloud = averaged(touches_of(record, visit.id));
  if (cloud.empty()) return std::nullopt;
  PoseValue value = pose_value(projected(tips_of(cloud), Eigen::Matrix3d::Identity()), strategy);
  value.pose = visit.reached;
  value.final_pose = is_final(record, visit);
  return value;
}

}  // namespace rondure::reports
