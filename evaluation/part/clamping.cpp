#include "evaluation/part/internal/families.h"

#include <algorithm>
#include <string>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/results/measured_cloud.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

/// How often the part had been located again, or clamped anew, before a cloud: each time it stood
/// elsewhere.
int located_before(const record::RunRecord& record, int pose) {
  const auto touches = touches_of(record, pose);
  if (touches.empty()) return 0;
  const auto first = static_cast<double>(touches.front()->id);
  return static_cast<int>(std::ranges::count_if(record.decisions, [&](const auto& decision) {
    const core::MessageCode code = decision.message.code;
    const bool moved =
        code == core::MessageCode::kPartLocatedAgain || code == core::MessageCode::kClampingChanged;
    return moved && decision.message.number(0) <= first;
  }));
}

double grown(const ThermalCorrection& c) {
  return 1.0 + c.part_expansion_1_K * (c.part_degC - 20.0);
}

/// Why two clouds stand in different frames; empty for one clamping.
core::Phrase why_apart(const FeatureResult& datum, const FeatureResult& to) {
  const Clamping& a = *datum.clamping;
  const Clamping& b = *to.clamping;
  const std::string& first = datum.feature.id;
  const std::string& second = to.feature.id;
  if (a.file.has_value() != b.file.has_value()) {
    return core::phrase(
        "{} was touched and {} comes from a points file: touch both, or give both from one file",
        a.file ? second : first, a.file ? first : second);
  }
  if (a.file) {
    if (!a.name.empty() && !b.name.empty()) {
      if (a.name == b.name) return {};
      return core::phrase(
          "{} was measured in clamping \"{}\" and {} in \"{}\": measure both in one clamping, and "
          "give both the same source.clamping",
          first, a.name, second, b.name);
    }
    if (a.file == b.file && !a.file->empty()) return {};
    return core::phrase(
        "{} and {} come from different points files: put both into one file with a column "
        "\"feature\", or give both the same source.clamping if the part was not moved in between",
        first, second);
  }
  if (a.merged || b.merged) {
    return core::phrase(
        "the cloud of {} is made of several poses, in a frame of its own: measure {} and {} in "
        "one pose, e.g. with pose_search.strategy \"start-pose\"",
        a.merged ? first : second, first, second);
  }
  if (a.located_again != b.located_again) {
    return core::phrase(
        "the part moved between the measurements of {} and {} and was located again: measure both "
        "in one run without such an interruption",
        first, second);
  }
  if (a.reached == b.reached) return {};
  return core::phrase(
      "{} was measured in pose ({:g}, {:g}) deg and {} in ({:g}, {:g}) deg: measure both in one "
      "pose, e.g. with pose_search.strategy \"start-pose\"",
      first, core::degrees(a.reached.alpha_rad), core::degrees(a.reached.beta_rad), second,
      core::degrees(b.reached.alpha_rad), core::degrees(b.reached.beta_rad));
}

}  // namespace

Clamping clamping_of(const record::RunRecord& record, int feature) {
  const record::Feature& of = record.features[static_cast<std::size_t>(feature)];
  Clamping out;
  out.merged = of.strategy == record::Strategy::kMerged;
  if (of.strategy == record::Strategy::kPointsFile) {
    out.file = of.points_sha256;
    const auto settings = record::task_of<record::SurfaceSettings>(of.settings);
    if (settings) out.name = settings->clamping;
    return out;
  }
  const auto last = std::ranges::find_if(record.poses, [&](const record::PoseVisit& visit) {
    return visit.feature == feature && is_final(record, visit);
  });
  if (last == record.poses.end()) return out;
  out.reached = last->reached;
  out.located_again = located_before(record, last->id);
  return out;
}

core::Result<double> related(const FeatureResult& datum, const FeatureResult& to) {
  if (!datum.clamping || !to.clamping) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("{} and {} have no points to relate to each other",
                                   datum.feature.id, to.feature.id));
  }
  if (const core::Phrase why = why_apart(datum, to); !why.empty()) {
    return core::fail(core::Code::kMeaning, why);
  }
  if (datum.thermal.has_value() != to.thermal.has_value()) {
    const bool first = datum.thermal.has_value();
    return core::fail(
        core::Code::kMeaning,
        core::phrase("{} is corrected to 20 degC and {} is as measured: plan the same for both",
                     first ? datum.feature.id : to.feature.id,
                     first ? to.feature.id : datum.feature.id));
  }
  if (!datum.thermal) return 1.0;
  return grown(*datum.thermal) / grown(*to.thermal);
}

}  // namespace rondure::evaluation
