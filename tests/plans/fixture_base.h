#pragma once

#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>

#include "core/units.h"
#include "plans/plan.h"
#include "tests/plans/files.h"

namespace rondure::plans::testing {

inline constexpr double kSpoolTip_mm = 2.0;  ///< Tip radius of example 01.

/// The spool in a world without errors but for where the fixture stands, which `datum` tells.
inline Plan spool_on(const DatumPlan& datum, const Eigen::Vector3d& offset_mm,
                     const Eigen::Vector3d& rotation_deg) {
  auto plan = read_plan(example("01_spool_simulated.json"));
  if (!plan) throw std::runtime_error(lines_of(plan));  // fails the test
  plan->simulation->part = {};
  plan->simulation->probe = {};
  plan->simulation->fixture = {};
  plan->fixture->datum = datum;
  plan->features.front().pose_search.repeats = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    plan->simulation->fixture.base_offset_mm[i] = offset_mm(k);
    plan->simulation->fixture.base_rotation_deg[i] = rotation_deg(k);
  }
  return std::move(*plan);
}

/// The base of that fixture in the machine.
inline Eigen::Isometry3d base_at(const Eigen::Vector3d& offset_mm,
                                 const Eigen::Vector3d& rotation_deg) {
  const Eigen::Vector3d turn = rotation_deg * core::kDegree;
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translate(offset_mm);
  out.rotate(Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ()) *
             Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()) *
             Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()));
  return out;
}

/// Tip centres of the touches that find the base, one list per layer.
inline std::vector<std::vector<Eigen::Vector3d>> base_touches(const Plan& plan,
                                                              const record::RunRecord& record) {
  std::vector<std::vector<Eigen::Vector3d>> out(plan.fixture->datum->layers());
  for (const record::Touch& touch : record.touches) {
    if (touch.purpose == record::Touch::Purpose::kLocate && touch.pose < 0) {
      out[static_cast<std::size_t>(touch.layer)].push_back(touch.tip_mm);
    }
  }
  return out;
}

}  // namespace rondure::plans::testing
