#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::fixed;

constexpr double kPoseWidth = 680.0;
constexpr double kPoseLeft = 66.0;
constexpr double kPoseRight = 660.0;
constexpr double kPoseTop = 16.0;
constexpr double kPoseBottom = 212.0;

/// Range of f over the poses that have one, in um.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  [[nodiscard]] bool usable() const { return low > 0.0 && low <= high; }
};

Range f_range(const evaluation::FeatureResult& feature) {
  Range range;
  for (const evaluation::PoseValue& pose : feature.poses) {
    if (!pose.valid) continue;
    range.low = std::min(range.low, pose.f_mm / core::kMicrometre);
    range.high = std::max(range.high, pose.f_mm / core::kMicrometre);
  }
  return range;
}

void draw_pose(Svg& svg, double x, double y, const evaluation::PoseValue& pose, double size,
               std::string_view fill) {
  if (pose.final_pose) {
    svg.diamond(x, y, size + 4.0, "final");
  } else if (!pose.valid) {
    svg.cross(x, y, size, "no-value");
  } else if (!fill.empty()) {
    svg.circle(x, y, size, "disc", fill);
  } else {
    svg.circle(x, y, size, pose.physical ? "pose" : "pose virtual");
  }
}

void draw_f_axes(Svg& svg, const Scale& x, const Scale& y, std::size_t visits) {
  const auto ticks =
      y.decades ? core::decade_ticks(y.low, y.high) : core::round_ticks(y.low, y.high, 5);
  for (const double f : ticks) {
    svg.line(kPoseLeft, y.at(f), kPoseRight, y.at(f), "grid");
    label_beside(svg, kPoseLeft, y.at(f), tick_label(f));
  }
  svg.rect(kPoseLeft, kPoseTop, kPoseRight - kPoseLeft, kPoseBottom - kPoseTop, "frame");
  for (const double visit : core::round_ticks(1.0, static_cast<double>(visits),
                                              std::min<int>(12, static_cast<int>(visits)))) {
    if (visit != std::floor(visit)) continue;
    tick_below(svg, x.at(visit), kPoseBottom, tick_label(visit));
  }
  svg.text(0.5 * (kPoseLeft + kPoseRight), kPoseBottom + 36.0, "middle", "title", tr("visit"));
  svg.upward_text(14.0, 0.5 * (kPoseTop + kPoseBottom), "title",
                  y.decades ? tr("f / µm (logarithmic)") : "f / µm");
}

std::string search_plot(const evaluation::FeatureResult& feature,
                        const std::optional<evaluation::Zone>& zone, const Range& range) {
  const double zone_um = zone ? zone->deviation_mm / core::kMicrometre : range.low;
  const double least = zone_um > 0.0 ? std::min(range.low, zone_um) : range.low;
  const bool decades = range.high > 100.0 * least;
  const Scale y = decades ? Scale{least / 1.6, range.high * 1.4, kPoseBottom, kPoseTop, true}
                          : Scale{0.0, 1.12 * range.high, kPoseBottom, kPoseTop};
  const std::size_t visits = feature.poses.size();
  const Scale x{1.0, std::max(2.0, static_cast<double>(visits)), kPoseLeft + 16.0,
                kPoseRight - 16.0};
  Svg svg(kPoseWidth, 254.0, "wide", tr("f of the poses in the order visited"));
  draw_f_axes(svg, x, y, visits);
  if (zone) svg.line(kPoseLeft, y.at(zone_um), kPoseRight, y.at(zone_um), "reference");
  std::string d;
  for (std::size_t i = 0; i < visits; ++i) {
    const evaluation::PoseValue& pose = feature.poses[i];
    if (!pose.valid) continue;
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? 'M' : 'L', x.at(static_cast<double>(i + 1)),
                     y.at(pose.f_mm / core::kMicrometre));
  }
  svg.path(d, "trail");
  const double size = visits <= 40 ? 3.6 : 2.2;
  for (std::size_t i = 0; i < visits; ++i) {
    const evaluation::PoseValue& pose = feature.poses[i];
    const double py = pose.valid ? y.at(pose.f_mm / core::kMicrometre) : kPoseTop + 8.0;
    draw_pose(svg, x.at(static_cast<double>(i + 1)), py, pose, size, {});
  }
  return svg.str();
}

/// A range with a margin, never empty [deg].
Scale angle_scale(double low, double high, double from, double to) {
  const double air = std::max(0.08 * (high - low), 0.05);
  return {low - air, high + air, from, to};
}

struct PoseBox {
  double alpha_low = 1e9, alpha_high = -1e9, beta_low = 1e9, beta_high = -1e9;
};

PoseBox box_of(const evaluation::FeatureResult& feature) {
  PoseBox box;
  for (const evaluation::PoseValue& pose : feature.poses) {
    const double alpha = pose.pose.alpha_rad / core::kDegree;
    const double beta = pose.pose.beta_rad / core::kDegree;
    box.alpha_low = std::min(box.alpha_low, alpha);
    box.alpha_high = std::max(box.alpha_high, alpha);
    box.beta_low = std::min(box.beta_low, beta);
    box.beta_high = std::max(box.beta_high, beta);
  }
  return box;
}

void draw_f_colour_bar(Svg& svg, const Range& range, double top, double bottom) {
  constexpr int kSteps = 40;
  const double height = (bottom - top) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    svg.rect(560.0, top + i * height, 14.0, height + 0.4, "swatch",
             sequential_colour(1.0 - (i + 0.5) / kSteps));
  }
  svg.rect(560.0, top, 14.0, bottom - top, "frame");
  svg.text(560.0, top - 8.0, "start", "title", "f / µm");
  svg.text(580.0, top + 8.0, "start", "label", tick_label(std::round(range.high * 100.0) / 100.0));
  svg.text(580.0, 0.5 * (top + bottom) + 4.0, "start", "label",
           tick_label(std::round(std::sqrt(range.low * range.high) * 100.0) / 100.0));
  svg.text(580.0, bottom, "start", "label", tick_label(std::round(range.low * 100.0) / 100.0));
}

std::string pose_map(const evaluation::FeatureResult& feature, const Range& range) {
  constexpr double kPoseMapBottom = 290.0;
  constexpr double kPoseMapRight = 530.0;
  const PoseBox box = box_of(feature);
  const Scale x = angle_scale(box.alpha_low, box.alpha_high, kPoseLeft, kPoseMapRight);
  const Scale y = angle_scale(box.beta_low, box.beta_high, kPoseMapBottom, kPoseTop);
  Svg svg(kPoseWidth, 334.0, "wide", tr("Poses visited, coloured by f"));
  for (const double alpha : core::round_ticks(x.low, x.high, 6)) {
    svg.line(x.at(alpha), kPoseTop, x.at(alpha), kPoseMapBottom, "grid");
    svg.text(x.at(alpha), kPoseMapBottom + 18.0, "middle", "label", tick_label(alpha));
  }
  for (const double beta : core::round_ticks(y.low, y.high, 6)) {
    svg.line(kPoseLeft, y.at(beta), kPoseMapRight, y.at(beta), "grid");
    label_beside(svg, kPoseLeft, y.at(beta), tick_label(beta));
  }
  svg.rect(kPoseLeft, kPoseTop, kPoseMapRight - kPoseLeft, kPoseMapBottom - kPoseTop, "frame");
  svg.text(0.5 * (kPoseLeft + kPoseMapRight), kPoseMapBottom + 38.0, "middle", "title",
           "alpha / °");
  svg.upward_text(14.0, 0.5 * (kPoseTop + kPoseMapBottom), "title", "beta / °");
  const double decades = std::max(std::log(range.high / range.low), 1e-9);
  const auto draw = [&](const evaluation::PoseValue& pose) {
    const double f_um = std::max(pose.f_mm / core::kMicrometre, range.low);
    draw_pose(svg, x.at(pose.pose.alpha_rad / core::kDegree),
              y.at(pose.pose.beta_rad / core::kDegree), pose,
              feature.poses.size() <= 60 ? 5.5 : 4.0,
              sequential_colour(std::log(f_um / range.low) / decades));
  };
  for (const evaluation::PoseValue& pose : feature.poses) {
    if (!pose.final_pose) draw(pose);
  }
  if (const evaluation::PoseValue* final_pose = final_pose_of(feature)) draw(*final_pose);
  draw_f_colour_bar(svg, range, kPoseTop + 24.0, 200.0);
  return svg.str();
}

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

/// "+1.234 ± 0.100", or a dash where only the kinematics give the value.
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

std::string pose_plots(const evaluation::FeatureResult& feature,
                       const std::optional<evaluation::Zone>& zone) {
  const Range range = f_range(feature);
  if (!range.usable() || feature.poses.size() < 2) return {};
  std::string html = fmt::format(
      R"(<figure><div class="scroll">{}</div><figcaption>{}</figcaption></figure>)",
      search_plot(feature, zone, range),
      tr("f against the visit. Diamond: the final pose. Open circles: poses reached in software. "
         "Crosses: no value. Dashed: the minimum zone of the final cloud."));
  if (feature.poses.size() > 5) {
    html += fmt::format(
        R"(<figure><div class="scroll">{}</div><figcaption>{}</figcaption></figure>)",
        pose_map(feature, range),
        tr("Poses visited; the darker, the smaller f (logarithmic). Diamond: the final pose."));
  }
  return html;
}

std::string pose_table(const evaluation::FeatureResult& feature) {
  const std::vector<evaluation::PoseValue>& poses = feature.poses;
  if (poses.empty()) return {};
  const std::set<std::size_t> shown = rows_shown(poses);
  TableRows rows;
  std::size_t expected = 0;
  for (const std::size_t i : shown) {
    if (i > expected) {
      rows.push_back({"…", trf("{} left out", count(i - expected, "pose", "poses"))});
    }
    expected = i + 1;
    const evaluation::PoseValue& pose = poses[i];
    rows.push_back({std::to_string(i + 1), deg(pose.pose.alpha_rad), deg(pose.pose.beta_rad),
                    pose.valid ? core::f_um(pose.f_mm) : tr("none"),
                    worded(core::Phrase(pose.ending)),
                    (pose.physical ? tr("physical") : tr("software")) +
                        (pose.final_pose ? fmt::format(", <b>{}</b>", tr("final")) : "")});
  }
  std::string html = scrolling(table(
      shown.size() <= 12 ? "short" : "", "rrrrll", spoken_caption(tr("Search for the pose")),
      {tr("Visit"), "alpha / °", "beta / °", "f / µm", tr("End of search"), tr("Pose")}, rows));
  if (shown.size() < poses.size()) {
    html += note(trf("{} of {} poses were left out here; report.json has all of them.",
                     poses.size() - shown.size(), poses.size()));
  }
  return html;
}

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
  for (const core::Phrase& statement : merged.solved->statements)
    html += fmt::format("<li>{}</li>", trf("{}.", opening_sentence(statement)));
  return html + "</ul>";
}

}  // namespace rondure::reports
