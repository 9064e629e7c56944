#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/escaping.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::fixed;

/// "+1.234 ± 0.100", or a dash where the kinematics are all that is known.
std::string cell(double value, double u, bool from_kinematics) {
  if (from_kinematics) return trf("(kinematics, u {})", fixed(u, 2));
  return fmt::format("{}{} ± {}", value < 0.0 ? "" : "+", fixed(value, 2), fixed(u, 2));
}

void add_pose(TableRows& rows, const evaluation::MergedPoses& merged, std::size_t k) {
  std::vector<std::string> cells = {std::to_string(k + 1), deg(merged.poses[k].alpha_rad),
                                    deg(merged.poses[k].beta_rad),
                                    std::to_string(merged.points[k])};
  if (merged.solved && k == 0) cells.push_back(tr("the others are told against this one"));
  for (const int i : {0, 1, 3, 4}) {
    if (!merged.solved || k == 0) break;
    const fit::PoseErrorFound& found = merged.solved->errors[k];
    const double unit = i < 3 ? core::kMicrometre : 1e-6;
    cells.push_back(cell(found.error(i) / unit, found.u(i) / unit,
                         found.from_kinematics[static_cast<std::size_t>(i)]));
  }
  rows.push_back(cells);
}

}  // namespace

std::string merged_section(const evaluation::MergedPoses& merged) {
  std::string html = fmt::format("<h3>{}</h3><p>{}</p>", tr("Several poses, one part"),
                                 trf("{}.", opening_sentence(share_in_words(merged))));
  std::vector<std::string> names = {tr("Pose"), "alpha / °", "beta / °", tr("Points")};
  if (merged.solved) {
    names.insert(names.end(), {tr("Shift x / µm"), tr("Shift y / µm"), tr("Tilt x / µrad"),
                               tr("Tilt y / µrad")});
  }
  TableRows rows;
  for (std::size_t k = 0; k < merged.poses.size(); ++k) add_pose(rows, merged, k);
  html += scrolling(table("short", std::string(names.size(), 'r'),
                          spoken_caption(tr("Several poses, one part")), names, rows));
  if (!merged.solved) return html;
  html += note(
      trf("Errors of the poses against the first, at the middle of the part, ± standard "
          "uncertainty; z along its axis. {} touched in several poses. Their size against what the "
          "kinematics state: chi² {} of {} degrees of freedom, limit {}.",
          count(merged.solved->shared, "target was", "targets were"), fixed(merged.solved->chi2, 1),
          merged.solved->chi2_freedom, fixed(merged.solved->chi2_limit, 1)));
  html += R"(<ul class="warnings">)";
  for (const std::string& statement : merged.solved->statements)
    html += fmt::format("<li>{}</li>", trf("{}.", opening_sentence(statement)));
  return html + "</ul>";
}

}  // namespace rondure::reports
