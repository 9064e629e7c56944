#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/numbers.h"
#include "reports/escaping.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::f_um;

constexpr std::size_t kMostRows = 40;
constexpr std::size_t kEndRows = 10;

/// Visits that the table shows: all, or the first and last ten, the best and the final one.
std::set<std::size_t> rows_shown(const std::vector<evaluation::PoseValue>& poses) {
  std::set<std::size_t> rows;
  const bool all = poses.size() <= kMostRows;
  std::size_t best = poses.size();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (all || i < kEndRows || i + kEndRows >= poses.size() || poses[i].final_pose) rows.insert(i);
    if (poses[i].valid && (best == poses.size() || poses[i].f_mm < poses[best].f_mm)) best = i;
  }
  if (best < poses.size()) rows.insert(best);
  return rows;
}

}  // namespace

std::string pose_table(const evaluation::FeatureResult& feature) {
  const std::vector<evaluation::PoseValue>& poses = feature.poses;
  if (poses.empty()) return {};
  const std::set<std::size_t> shown = rows_shown(poses);
  std::string html = fmt::format(
      R"(<div class="scroll"><table{}>{}<thead><tr><th scope="col" class="n">{}</th><th )"
      R"(scope="col" class="n">alpha / °</th><th scope="col" class="n">beta / °</th><th scope="col" class="n">f / µm</th>)"
      R"(<th scope="col">{}</th><th scope="col">{}</th></tr></thead><tbody>)",
      shown.size() <= 12 ? R"( class="short")" : "", spoken_caption(tr("Search for the pose")),
      tr("Visit"), tr("Search ended"), tr("Pose"));
  std::size_t expected = 0;
  for (const std::size_t i : shown) {
    if (i > expected) {
      html += fmt::format(R"(<tr><td class="n">…</td><td colspan="5">{}</td></tr>)",
                          trf("{} left out", count(i - expected, "pose", "poses")));
    }
    expected = i + 1;
    const evaluation::PoseValue& pose = poses[i];
    html +=
        fmt::format(R"(<tr><td class="n">{}</td><td class="n">{}</td><td class="n">{}</td><td )"
                    R"(class="n">{}</td><td>{}</td><td>{}{}</td></tr>)",
                    i + 1, deg(pose.pose.alpha_rad), deg(pose.pose.beta_rad),
                    pose.valid ? f_um(pose.f_mm) : tr("none"), worded(core::Phrase(pose.ending)),
                    pose.physical ? tr("physical") : tr("software"),
                    pose.final_pose ? fmt::format(", <b>{}</b>", tr("final")) : "");
  }
  html += "</tbody></table></div>";
  if (shown.size() < poses.size()) {
    html += fmt::format(R"(<p class="note">{}</p>)",
                        trf("{} of {} poses were left out here; report.json has all of them.",
                            poses.size() - shown.size(), poses.size()));
  }
  return html;
}

}  // namespace rondure::reports
