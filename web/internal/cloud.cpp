#include "web/internal/cloud.h"

#include <algorithm>
#include <set>
#include <utility>

#include "evaluation/evaluate.h"

namespace rondure::web {
namespace {

using record::RunRecord;
using record::Touch;

/// The feature for the cloud of one pose: without characteristics and without a software search.
record::Feature seen_in_one_pose(const record::Feature& asked) {
  record::Feature out = asked;
  out.characteristics.clear();
  const bool single =
      asked.strategy == record::Strategy::kVirtual || asked.strategy == record::Strategy::kMerged;
  if (single) out.strategy = record::Strategy::kGuided;
  return out;
}

std::size_t touches_in(const RunRecord& record, int pose) {
  return static_cast<std::size_t>(
      std::count_if(record.touches.begin(), record.touches.end(), [pose](const Touch& touch) {
        return touch.purpose == Touch::Purpose::kMeasure && touch.pose == pose;
      }));
}

/// The record as if the run had one feature, measured in this pose only.
RunRecord of_one_pose(const RunRecord& record, const record::PoseVisit& visit, std::size_t every) {
  RunRecord out;
  out.header = record.header;
  out.header.plan_text.clear();
  out.artefact = record.artefact;
  out.settings = record.settings;
  out.features = {seen_in_one_pose(record.features[static_cast<std::size_t>(visit.feature)])};
  for (const record::Decision& decision : record.decisions) {
    if (decision.feature < 0) out.decisions.push_back(decision);  // of the place of the part
  }
  std::set<int> poses;
  for (const record::PoseVisit& other : record.poses) {
    if (other.feature != visit.feature) continue;
    poses.insert(other.id);
    out.poses.push_back(other);
    out.poses.back().feature = 0;
    out.poses.back().final_cloud = other.id == visit.id;
  }
  for (const Touch& touch : record.touches) {
    const bool measured = touch.purpose == Touch::Purpose::kMeasure && touch.pose == visit.id &&
                          static_cast<std::size_t>(touch.point) % every == 0;
    const bool located = touch.purpose == Touch::Purpose::kLocate && poses.count(touch.pose) == 1;
    if (measured || located || touch.purpose == Touch::Purpose::kQualification)
      out.touches.push_back(touch);
  }
  return out;
}

}  // namespace

core::Result<LiveCloud> evaluate_so_far(const RunRecord& record, const record::PoseVisit& visit) {
  const record::Feature& feature = record.features[static_cast<std::size_t>(visit.feature)];
  if (record::is_analysis(feature.shape))
    return core::fail(core::Code::kBadOption, "an analysis has no cloud", feature.id);
  const std::size_t touches = touches_in(record, visit.id);
  if (touches == 0) return core::fail(core::Code::kNoPoints, "no touch in this pose yet");
  const std::size_t every = (touches + kMostLiveTouches - 1) / kMostLiveTouches;
  auto evaluation = evaluation::evaluate(of_one_pose(record, visit, every));
  if (!evaluation) return core::fail(evaluation.error());
  evaluation::FeatureResult& result = evaluation->features.front();
  if (result.failure) return core::fail(*result.failure);
  return LiveCloud{std::move(result), every};
}

}  // namespace rondure::web
