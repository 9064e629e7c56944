#include "evaluation/results/measured_cloud.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "core/shortest_turn.h"
#include "core/units.h"
#include "evaluation/results/internal/fixture_use.h"
#include "fit/zone/center_search.h"
#include "fixture/error_model.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {

std::vector<const record::Touch*> touches_of(const record::RunRecord& record, int pose) {
  std::vector<const record::Touch*> out;
  for (const record::Touch& touch : record.touches) {
    if (touch.purpose == record::Touch::Purpose::kMeasure && touch.pose == pose)
      out.push_back(&touch);
  }
  return out;
}

namespace {

/// Largest distance of touches of one place, across the approach: controllers hold the line to a
/// few micrometres. A mean over touches so far apart is off a surface of 2 mm radius by 6e-6 mm
/// (square over 8 radii).
constexpr double kOnePlace_mm = 10e-3;
/// Largest distance of two points of different passes that still shows the noise, in steps of a
/// pass.
constexpr double kClose = 0.125;
constexpr double kOneStep = 1.5;  // a longer step has lost a point

using PassPlace = std::tuple<int, int, int>;  // layer, pass, point

/// Whether the touches of each target are at one place.
bool at_one_place(const std::vector<const record::Touch*>& touches) {
  std::map<std::pair<int, int>, const record::Touch*> first;
  for (const record::Touch* touch : touches) {
    const record::Touch& known =
        *first.try_emplace({touch->layer, touch->point}, touch).first->second;
    const Eigen::Vector3d apart = touch->tip_mm - known.tip_mm;
    // Points of a file have no approach and no repeats.
    if ((apart - apart.dot(known.approach) * known.approach).norm() > kOnePlace_mm) return false;
  }
  return true;
}

/// One section of one pass, by angle.
using PassSection = std::vector<const CloudPoint*>;

double ahead(const CloudPoint& from, const CloudPoint& to) {
  return std::remainder(to.angle_rad - from.angle_rad, core::kTwoPi);
}

/// Adds the pairs of points of two passes that lie close to each other. A pair shows the difference
/// of two errors plus the slope of the form between the points; the slope is taken from the
/// neighbours of one of them.
void add_close_pairs(const std::vector<PassSection>& passes, double& squares, int& freedom) {
  struct Placed {
    const PassSection* section;
    std::size_t at;
    const CloudPoint& point() const { return *(*section)[at]; }
  };
  std::vector<Placed> all;
  std::size_t most = 0;
  for (const PassSection& section : passes) {
    most = std::max(most, section.size());
    for (std::size_t i = 0; i < section.size(); ++i) all.push_back({&section, i});
  }
  if (most < 3) return;
  const double step_rad = core::kTwoPi / static_cast<double>(most);
  std::stable_sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) {
    return a.point().angle_rad < b.point().angle_rad;
  });
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Placed& a = all[i];
    const Placed& b = all[i + 1];
    const double apart_rad = ahead(a.point(), b.point());
    if (a.section == b.section || apart_rad > kClose * step_rad) continue;
    const PassSection& near = *a.section;
    const CloudPoint& before = *near[(a.at + near.size() - 1) % near.size()];
    const CloudPoint& after = *near[(a.at + 1) % near.size()];
    const double base_rad = ahead(before, a.point()) + ahead(a.point(), after);
    if (!(base_rad > 0.0) || base_rad > 2.0 * kOneStep * step_rad) continue;
    const double share = apart_rad / base_rad;
    const double rest = b.point().deviation_mm - a.point().deviation_mm -
                        share * (after.deviation_mm - before.deviation_mm);
    squares += rest * rest / (2.0 + 2.0 * share * share);
    ++freedom;
    ++i;  // use each point in one pair only
  }
}

RepeatNoise noise_of_passes(const std::vector<CloudPoint>& cloud) {
  std::map<int, std::map<int, PassSection>> layers;
  for (const CloudPoint& point : cloud) layers[point.layer][*point.pass].push_back(&point);
  double squares = 0.0;
  RepeatNoise out;
  for (auto& [layer, sections] : layers) {
    std::vector<PassSection> passes;
    for (auto& [pass, section] : sections) {
      std::stable_sort(section.begin(), section.end(),
                       [](const auto* a, const auto* b) { return a->angle_rad < b->angle_rad; });
      passes.push_back(std::move(section));
    }
    add_close_pairs(passes, squares, out.freedom);
  }
  if (out.freedom > 0) out.sigma_mm = std::sqrt(squares / out.freedom);
  return out;
}

}  // namespace

std::vector<CloudPoint> measured_cloud(const std::vector<const record::Touch*>& touches) {
  const bool average = at_one_place(touches);
  std::map<PassPlace, CloudPoint> places;
  for (const record::Touch* touch : touches) {
    const int pass = average ? 0 : touch->repeat;
    auto [found, fresh] = places.try_emplace({touch->layer, pass, touch->point});
    CloudPoint& point = found->second;
    point.layer = touch->layer;
    point.point = touch->point;
    if (!average) point.pass = pass;
    point.repeats = fresh ? 1 : point.repeats + 1;
    // A running mean keeps the digits of coordinates far from the origin.
    point.tip_mm += (touch->tip_mm - point.tip_mm) / point.repeats;
    point.time_s += (touch->time_s - point.time_s) / point.repeats;
  }
  std::vector<CloudPoint> out;
  out.reserve(places.size());
  for (const auto& [key, point] : places) out.push_back(point);
  return out;
}

int passes_of(const std::vector<CloudPoint>& cloud) {
  std::set<int> passes;
  for (const CloudPoint& point : cloud) passes.insert(point.pass.value_or(0));
  return std::max(1, static_cast<int>(passes.size()));
}

RepeatNoise repeat_noise(const std::vector<const record::Touch*>& touches,
                         const std::vector<CloudPoint>& cloud) {
  if (!cloud.empty() && cloud.front().pass) return noise_of_passes(cloud);
  std::map<std::pair<int, int>, const CloudPoint*> means;
  for (const CloudPoint& point : cloud) means[{point.layer, point.point}] = &point;
  double squares = 0.0;
  RepeatNoise out;
  for (const record::Touch* touch : touches) {
    // The probe scatters along its approach; across it the controller holds the line.
    const Eigen::Vector3d apart = touch->tip_mm - means.at({touch->layer, touch->point})->tip_mm;
    squares += std::pow(apart.dot(touch->approach), 2);
  }
  out.freedom = static_cast<int>(touches.size()) - static_cast<int>(cloud.size());
  if (out.freedom > 0) out.sigma_mm = std::sqrt(squares / out.freedom);
  return out;
}

core::Error repeated_rows(const record::RepeatedRows& rows) {
  return core::error_of(
      core::Code::kRepeatedRows,
      rows.count == 1
          ? core::phrase("row {} repeats row {} and takes no part (rows from 0)", rows.first,
                         rows.original)
          : core::phrase("row {} repeats row {} and takes no part; {} rows do (rows from 0)",
                         rows.first, rows.original, rows.count));
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

Eigen::Matrix<double, 3, 2> frame_of_angles(const FeatureResult& feature,
                                            const Eigen::Vector3d& direction) {
  const Eigen::Matrix3d& part = feature.part_turn;
  const bool down = direction.dot(part.col(2)) < 0.0;
  const Eigen::Vector3d z = down ? Eigen::Vector3d(-direction) : direction;
  Eigen::Vector3d x = part.col(0) - z * z.dot(part.col(0));
  if (x.norm() < 0.1) x = part.col(1) - z * z.dot(part.col(1));
  x.normalize();
  Eigen::Matrix<double, 3, 2> frame;
  frame.col(0) = x;
  frame.col(1) = z.cross(x);
  return frame;
}

Eigen::Matrix3d rotation(const core::Pose& pose) {
  return (Eigen::AngleAxisd(pose.alpha_rad, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(pose.beta_rad, Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

bool stands_still(const record::Feature& feature) {
  const auto settings = record::task_of<record::SurfaceSettings>(feature.settings);
  return settings && !settings->part_axis.empty();
}

Eigen::Matrix3d part_turn(const record::RunRecord& record, const record::PoseVisit& visit) {
  Eigen::Matrix3d out = rotation(visit.reached);
  const auto base = std::find_if(
      record.decisions.rbegin(), record.decisions.rend(), [](const record::Decision& decision) {
        return decision.message.code == core::MessageCode::kFixtureBaseFound;
      });
  if (base != record.decisions.rend()) out = fixture::base_found(base->message).linear() * out;
  const auto& feature = record.features[static_cast<std::size_t>(visit.feature)];
  const auto settings = record::task_of<record::SurfaceSettings>(feature.settings);
  if (!settings || settings->part_axis.size() != 3) return out;
  return out * core::shortest_turn(Eigen::Vector3d::UnitZ(),
                                   Eigen::Vector3d::Map(settings->part_axis.data()));
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

bool is_complete(const record::RunRecord& record, std::size_t feature) {
  const auto index = static_cast<int>(feature);
  const auto later = [&](const auto& data) { return data.feature > index; };
  // The data of an analysis come in one piece; after the last one the run still has to end.
  const auto whole = [&](const record::Series& series) {
    return series.feature == index && series.role == record::Series::Role::kData &&
           feature + 1 < record.features.size();
  };
  return record.ending == "finished" || taken_calibration(record, index) != nullptr ||
         std::ranges::any_of(record.poses, later) || std::ranges::any_of(record.series, later) ||
         std::ranges::any_of(record.series, whole);
}

std::optional<PoseValue> value_of_pose(const record::RunRecord& record,
                                       const record::PoseVisit& visit, record::Strategy strategy) {
  // f is of machine z, to which a pose turns the part.
  if (stands_still(record.features[static_cast<std::size_t>(visit.feature)])) return std::nullopt;
  const auto cloud = measured_cloud(touches_of(record, visit.id));
  if (cloud.empty()) return std::nullopt;
  PoseValue value = pose_value(projected(tips_of(cloud), Eigen::Matrix3d::Identity()), strategy);
  value.pose = visit.reached;
  value.final_pose = is_final(record, visit);
  return value;
}

}  // namespace rondure::evaluation
