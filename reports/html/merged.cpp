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
  if (from_kinematics)
    return fmt::format(R"(<td class="n">{}</td>)", trf("(kinematics, u {})", fixed(u, 2)));
  return fmt::format(R"(<td class="n">{}{} ± {}</td>)", value < 0.0 ? "" : "+", fixed(value, 2),
                     fixed(u, 2));
}

std::string pose_row(const evaluation::MergedPoses& merged, std::size_t k) {
  std::string html = fmt::format(
      R"(<tr><td class="n">{}</td><td class="n">{}</td><td class="n">{}</td><td class="n">{}</td>)",
      k + 1, deg(merged.poses[k].alpha_rad), deg(merged.poses[k].beta_rad), merged.points[k]);
  if (!merged.solved) return html + "</tr>";
  if (k == 0) {
    return html + fmt::format(R"(<td colspan="4">{}</td></tr>)",
                              tr("the others are told against this one"));
  }
  const fit::PoseErrorFound& found = merged.solved->errors[k];
  for (const int i : {0, 1, 3, 4}) {
    const double unit = i < 3 ? core::kMicrometre : 1e-6;
    html += cell(found.error(i) / unit, found.u(i) / unit,
                 found.from_kinematics[static_cast<std::size_t>(i)]);
  }
  return html + "</tr>";
}

}  // namespace

std::string merged_section(const evaluation::MergedPoses& merged) {
  std::string html = fmt::format("<h3>{}</h3><p>{}</p>", tr("Several poses, one part"),
                                 trf("{}.", opening_sentence(share_in_words(merged))));
  html += fmt::format(
      R"(<div class="scroll"><table class="short">{}<thead><tr><th scope="col" class="n">{}</th><th scope="col" class="n">)"
      R"(alpha / °</th><th scope="col" class="n">beta / °</th><th scope="col" class="n">{}</th>)",
      spoken_caption(tr("Several poses, one part")), tr("Pose"), tr("Points"));
  if (merged.solved) {
    for (const std::string& title :
         {tr("Shift x / µm"), tr("Shift y / µm"), tr("Tilt x / µrad"), tr("Tilt y / µrad")}) {
      html += fmt::format(R"(<th scope="col" class="n">{}</th>)", title);
    }
  }
  html += "</tr></thead><tbody>";
  for (std::size_t k = 0; k < merged.poses.size(); ++k) html += pose_row(merged, k);
  html += "</tbody></table></div>";
  if (!merged.solved) return html;
  html += fmt::format(
      R"(<p class="note">{}</p>)",
      trf("Errors of the poses against the first, at the middle of the part, ± standard "
          "uncertainty; z along its axis. {} touched in several poses. Their size against what the "
          "kinematics state: chi² {} of {} degrees of freedom, limit {}.",
          count(merged.solved->shared, "target was", "targets were"), fixed(merged.solved->chi2, 1),
          merged.solved->chi2_freedom, fixed(merged.solved->chi2_limit, 1)));
  html += R"(<ul class="warnings">)";
  for (const core::Phrase& statement : merged.solved->statements)
    html += fmt::format("<li>{}</li>", trf("{}.", opening_sentence(statement)));
  return html + "</ul>";
}

}  // namespace rondure::reports
