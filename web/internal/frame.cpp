#include "web/internal/frame.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/encodings.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/measured_cloud.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "web/internal/sections.h"

namespace rondure::web {
namespace {

using core::well_formed;
using reports::isolated;
using reports::tr;
using reports::trf;

/// The strategy that determines f of a single pose.
record::Strategy strategy_of(const record::RunRecord& record, const record::PoseVisit& visit) {
  return record.features[static_cast<std::size_t>(visit.feature)].strategy;
}

/// Whether every target of a pose was touched; its f cannot be compared with the others until then.
bool is_whole(const record::RunRecord& record, const record::PoseVisit& visit) {
  const record::Feature& feature = record.features[static_cast<std::size_t>(visit.feature)];
  const int targets = feature.layers * feature.points_per_layer;
  return evaluation::touches_of(record, visit.id).size() >=
         static_cast<std::size_t>(std::max(targets, 1));
}

/// A feature with only its poses, for the drawings of the search.
evaluation::FeatureResult with_poses(const record::RunRecord& record,
                                     const record::PoseVisit& present,
                                     const std::map<int, evaluation::PoseValue>& values) {
  evaluation::FeatureResult out;
  out.feature = record.features[static_cast<std::size_t>(present.feature)];
  for (const record::PoseVisit& visit : record.poses) {
    const auto found = values.find(visit.id);
    if (visit.feature != present.feature || found == values.end()) continue;
    if (visit.id == present.id && !is_whole(record, visit)) continue;
    out.poses.push_back(found->second);
  }
  return out;
}

}  // namespace

std::string answer_of(const LiveFrame& frame, std::string_view session, std::uint64_t since) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::object();
  for (const LivePart& part : frame.parts) {
    // A page of another run, which has its own version numbers, receives everything.
    if (part.version > since || since > frame.version) parts[part.id] = well_formed(part.html);
  }
  const nlohmann::ordered_json out = {{"session", session},
                                      {"version", frame.version},
                                      {"ended", frame.ended},
                                      {"title", well_formed(frame.title)},
                                      {"parts", std::move(parts)}};
  return out.dump();
}

LivePainter::LivePainter(std::shared_ptr<const record::GrowingRecord> source,
                         std::vector<PredictedStage> stages, reports::Language language)
    : source_(std::move(source)), stages_(std::move(stages)), language_(language) {}

void LivePainter::put(std::string_view id, std::string html) {
  const auto found = std::find_if(frame_.parts.begin(), frame_.parts.end(),
                                  [id](const LivePart& part) { return part.id == id; });
  if (found != frame_.parts.end() && found->html == html) return;
  changed_ = true;
  const std::uint64_t version = frame_.version + 1;
  if (found == frame_.parts.end()) {
    frame_.parts.push_back({std::string(id), std::move(html), version});
  } else {
    found->html = std::move(html);
    found->version = version;
  }
}

std::shared_ptr<const LiveFrame> LivePainter::frame() {
  if (changed_) ++frame_.version;
  changed_ = false;
  return std::make_shared<const LiveFrame>(frame_);
}

void LivePainter::look_at_poses(const record::PoseVisit& present) {
  for (const record::PoseVisit& visit : record_.poses) {
    if (visit.feature != present.feature) continue;
    const bool grew = visit.id == present.id || visit.id == grew_;
    if (const auto known = poses_.find(visit.id); !grew && known != poses_.end()) {
      known->second.final_pose = evaluation::is_final(record_, visit);
      continue;
    }
    const auto value = evaluation::value_of_pose(record_, visit, strategy_of(record_, visit));
    if (value) poses_[visit.id] = *value;
  }
  grew_ = present.id;
}

void LivePainter::paint_cloud(const record::PoseVisit& visit) {
  const bool touched = strategy_of(record_, visit) != record::Strategy::kPointsFile;
  const auto cloud = evaluate_so_far(record_, visit);
  zone_mm_.reset();
  if (cloud) {
    if (const auto zone = zone_of(cloud->result)) zone_mm_ = zone->deviation_mm;
  }
  put("drawing", live_drawings(cloud));
  if (!touched) return;
  look_at_poses(visit);
  const evaluation::FeatureResult feature = with_poses(record_, visit, poses_);
  const std::string plots = reports::pose_plots(feature, std::nullopt);
  put("poses",
      plots.empty() ? plots : fmt::format("<h2>{}</h2>", tr("Search for the pose")) + plots);
}

std::shared_ptr<const LiveFrame> LivePainter::paint(double elapsed_s) {
  const reports::LanguageScope scope(language_);
  const bool fresh = source_->catch_up(record_);
  if (record_.header.version.empty()) {
    put("now", live_numbers(record_, {}));
    return frame();
  }
  const record::PoseVisit* present = record_.poses.empty() ? nullptr : &record_.poses.back();
  const bool cloud =
      present != nullptr &&
      !record::is_analysis(record_.features[static_cast<std::size_t>(present->feature)].shape);
  if (fresh) {
    put("head", reports::head_section(record_, tr("live view")));
    if (cloud) paint_cloud(*present);
    put("touches", live_touches(record_));
    put("decisions", reports::decisions_section(record_));
  }
  const int touches = static_cast<int>(record_.touches.size());
  if (!first_) {
    first_ = touches;
    first_s_ = elapsed_s;
  }
  LiveNow now;
  now.pose = present;
  if (present != nullptr && poses_.count(present->id) == 1) now.f = poses_[present->id];
  now.zone_mm = zone_mm_;
  now.expected = static_cast<std::size_t>(predicted_touches(stages_));
  now.elapsed_s = elapsed_s;
  if (record_.ending.empty())
    now.left_s = time_left_s(stages_, *first_, touches, elapsed_s - first_s_);
  put("now", live_numbers(record_, now));
  put("announce", live_doing(record_, now) + ".");
  frame_.title = fmt::format("{} / {} {}", touches,
                             std::max<std::size_t>(now.expected, record_.touches.size()),
                             record_.header.part_id);
  return frame();
}

std::shared_ptr<const LiveFrame> LivePainter::paint_result(const record::RunRecord& record,
                                                           const evaluation::Evaluation& evaluation,
                                                           std::string_view report) {
  const reports::LanguageScope scope(language_);
  put("head", reports::head_section(record, tr("live view"), &evaluation));
  put("now", live_over(record, report));
  put("result", reports::verdict_section(record, evaluation, reports::callouts_of(evaluation)));
  put("announce",
      fmt::format("{} {}.", tr("The run is over. Verdict:"), tr(name_of(evaluation.verdict))));
  put("touches", live_touches(record));
  put("decisions", reports::decisions_section(record));
  std::string drawings;  // below a heading that names the feature
  std::string searches;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    const auto zone = zone_of(feature);
    if (record::is_analysis(feature.feature.shape)) continue;
    const std::string heading =
        fmt::format("<h2>{}</h2>", trf("Feature {}", isolated(feature.feature.id)));
    if (zone)
      drawings +=
          heading + reports::polar_plots(feature, *zone) + reports::deviation_map(feature, *zone);
    searches += reports::pose_plots(feature, zone);
  }
  put("drawing", std::move(drawings));
  put("poses", std::move(searches));
  frame_.title = fmt::format("{}: {}", tr(name_of(evaluation.verdict)), record.header.part_id);
  frame_.ended = true;
  changed_ = true;
  return frame();
}

std::shared_ptr<const LiveFrame> LivePainter::paint_failure(std::string_view why) {
  const reports::LanguageScope scope(language_);
  put("now", fmt::format(R"(<h2 class="doing">{}</h2><div class="banner alarm">{}</div>)",
                         tr("No result"), isolated(why)));
  put("announce", fmt::format("{}: {}", tr("No result"), isolated(why)));
  frame_.title = tr("No result");
  frame_.ended = true;
  changed_ = true;
  return frame();
}

}  // namespace rondure::web
