#include "web/internal/sections.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/evaluate.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/measured_cloud.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

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

namespace {

using core::deg;
using core::f_um;
using core::fixed;
using core::um;
using reports::entry;
using reports::isolated;
using reports::note;
using reports::tr;
using reports::trf;
using reports::with_note;

constexpr std::size_t kTouchRows = 10;

/// "3:07 min", "1:02:09 h".
std::string clock_text(double time_s) {
  const auto s = std::lround(std::max(time_s, 0.0));
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02} h", s / 3600, s / 60 % 60, s % 60);
}

/// Index of a visit among the poses of its feature, from 1.
std::size_t number_of(const record::RunRecord& record, const record::PoseVisit& visit) {
  std::size_t number = 0;
  for (const record::PoseVisit& other : record.poses) {
    if (other.feature == visit.feature) ++number;
    if (other.id == visit.id) break;
  }
  return number;
}

const std::string& id_of(const record::RunRecord& record, const record::PoseVisit& visit) {
  return record.features[static_cast<std::size_t>(visit.feature)].id;
}

bool stands_still(const record::RunRecord& record, const record::PoseVisit& visit) {
  return evaluation::stands_still(record.features[static_cast<std::size_t>(visit.feature)]);
}

std::string angles_of(const core::Pose& pose) {
  return fmt::format("alpha {}°, beta {}°", deg(pose.alpha_rad), deg(pose.beta_rad));
}

std::string touches_entry(const record::RunRecord& record, const LiveNow& now) {
  const std::size_t done = record.touches.size();
  if (now.expected == 0) return entry(tr("Touches"), std::to_string(done), "lead");
  const std::size_t all = std::max(now.expected, done);
  return entry(tr("Touches"),
               with_note(trf("{} of {}", done, all),
                         fmt::format(R"(<progress value="{}" max="{}" aria-label="{}"></progress>)",
                                     done, all, tr("Touches made"))),
               "lead");
}

std::string time_entries(const LiveNow& now) {
  const std::string left = now.left_s ? clock_text(*now.left_s) : "–";
  return entry(tr("Time left"),
               with_note(left, tr("as the plan's time model predicts, at the pace so far")),
               "lead") +
         entry(tr("Time so far"), clock_text(now.elapsed_s));
}

std::string purpose_of(const record::Touch& touch) {
  switch (touch.purpose) {
    case record::Touch::Purpose::kQualification:
      return tr("qualification");
    case record::Touch::Purpose::kLocate:
      return tr("location");
    case record::Touch::Purpose::kMeasure:
      return tr("measurement");
    case record::Touch::Purpose::kCheck:
      return tr("check");
  }
  return {};
}

std::string touch_row(const record::RunRecord& record, const record::Touch& touch) {
  const bool in_layer = touch.purpose == record::Touch::Purpose::kMeasure;
  const auto pose = std::find_if(record.poses.rbegin(), record.poses.rend(),
                                 [&](const auto& visit) { return visit.id == touch.pose; });
  return fmt::format(
      R"(<tr><td class="n">{}</td><td>{}</td><td class="n">{}</td><td class="n">{}</td>)"
      R"(<td class="n">{}</td><td class="n">{}</td><td class="n">{}</td><td class="n">{}</td></tr>)",
      touch.id, purpose_of(touch),
      pose == record.poses.rend() ? "–" : std::to_string(number_of(record, *pose)),
      in_layer ? std::to_string(touch.layer + 1) : "–",
      in_layer ? std::to_string(touch.point + 1) : "–", fixed(touch.tip_mm.x(), 5),
      fixed(touch.tip_mm.y(), 5), fixed(touch.tip_mm.z(), 5));
}

}  // namespace

std::string live_doing(const record::RunRecord& record, const LiveNow& now) {
  if (!record.ending.empty()) return tr("All touches are made; evaluating");
  if (record.header.version.empty()) return tr("Starting");
  if (now.pose == nullptr) return tr("Qualifying the probe");
  const bool locating = !record.touches.empty() && record.touches.back().pose == now.pose->id &&
                        record.touches.back().purpose == record::Touch::Purpose::kLocate;
  const std::string feature = isolated(id_of(record, *now.pose));
  if (stands_still(record, *now.pose)) {
    return locating ? trf("Locating {}", feature) : trf("Measuring {}", feature);
  }
  const std::size_t number = number_of(record, *now.pose);
  return locating ? trf("Locating {}, pose {}", feature, number)
                  : trf("Measuring {}, pose {}", feature, number);
}

std::string live_numbers(const record::RunRecord& record, const LiveNow& now) {
  std::string html;
  if (record.header.simulated) {
    html += fmt::format(R"(<div class="banner"><b>{}</b> {}</div>)", tr("Simulated:"),
                        tr("no real part is measured."));
  }
  html += fmt::format(R"(<h2 class="doing">{}</h2><dl class="keys">)", live_doing(record, now));
  html += touches_entry(record, now) + time_entries(now);
  if (now.pose != nullptr && !stands_still(record, *now.pose)) {
    html += entry(tr("Pose"), with_note(std::to_string(number_of(record, *now.pose)),
                                        angles_of(now.pose->reached)));
  }
  if (now.f) {
    html += entry(tr("f of this pose"),
                  now.f->valid ? with_note(f_um(now.f->f_mm) + " µm", tr("of the touches so far"))
                               : with_note("–", isolated(now.f->ending)));
  }
  if (now.zone_mm)
    html +=
        entry(tr("Minimum zone"), with_note(um(*now.zone_mm) + " µm", tr("of the touches so far")));
  return html + "</dl>";
}

std::string live_drawings(const core::Result<LiveCloud>& cloud) {
  if (!cloud) {
    return note(tr("The drawings begin when the touches of this pose define the feature."));
  }
  const auto zone = zone_of(cloud->result);
  if (!zone) return {};
  std::string html = fmt::format("<h2>{}</h2>", tr("The present cloud"));
  html += reports::polar_plots(cloud->result, *zone) + reports::deviation_map(cloud->result, *zone);
  if (cloud->every > 1) {
    html +=
        note(trf("Every {}th point is drawn while the run is at work; the report "
                 "has all of them.",
                 cloud->every));
  }
  return html;
}

std::string live_touches(const record::RunRecord& record) {
  if (record.touches.empty()) return {};
  std::string html = fmt::format(
      R"(<h2>{}</h2><div class="scroll" tabindex="0" role="region" aria-label="{}"><table>)"
      R"(<thead><tr><th class="n">{}</th><th>{}</th><th class="n">{}</th><th class="n">{}</th>)"
      R"(<th class="n">{}</th><th class="n">x / mm</th><th class="n">y / mm</th>)"
      R"(<th class="n">z / mm</th></tr></thead><tbody>)",
      tr("Last touches"), tr("Last touches"), tr("Touch"), tr("Purpose"), tr("Pose"), tr("Layer"),
      tr("Point"));
  const std::size_t rows = std::min(kTouchRows, record.touches.size());
  for (std::size_t i = 0; i < rows; ++i) {
    html += touch_row(record, record.touches[record.touches.size() - 1 - i]);
  }
  return html +
         fmt::format(R"(</tbody></table></div><p class="note">{}</p>)",
                     tr("Centres of the tip in the machine frame, the newest first. Each is on "
                        "disk before the next is made."));
}

std::string live_over(const record::RunRecord& record, std::string_view report) {
  std::string html = fmt::format(R"(<h2 class="doing">{}</h2>)",
                                 record.ending == "finished" ? tr("Run finished")
                                 : record.ending == "stopped"
                                     ? tr("Run stopped; it can go on with rondure run --resume")
                                     : tr("Run ended by a fault"));
  if (!report.empty()) {
    html += fmt::format(R"(<p>{} <span class="mono">{}</span></p>)", tr("The report is in"),
                        isolated(report));
  }
  return html + note(tr("The program has ended; this page stays as it is."));
}

}  // namespace rondure::web
