#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "fit/profiles/profile_filter.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/path/sampling.h"
#include "plans/schema/json_text.h"
#include "record/tasks/form_facts.h"

namespace rondure::plans {
namespace {

using core::Code;
using record::Form;
using record::Indication;
using record::Shape;

constexpr int kNeededLayers = 2;

/// Heights of the layers of a touched feature; empty where they cannot be placed.
std::vector<double> placed_heights(const FeaturePlan& feature) {
  return layer_heights_mm(feature).value_or(std::vector<double>());
}

void check_window(const record::WindowTask& window, const std::string& where, Findings& findings) {
  const auto refuse = [&](const char* key, std::string what) {
    findings.meaning(Code::kMeaning, where + key, std::move(what));
  };
  if (window.from_deg.has_value() != window.to_deg.has_value()) {
    refuse(window.from_deg ? "/from_deg" : "/to_deg",
           "a window goes from one angle to another; give from_deg and to_deg, or neither");
  } else if (window.from_deg && std::remainder(*window.from_deg - *window.to_deg, 360.0) == 0.0) {
    refuse("/from_deg",
           fmt::format("from {} to {} deg, an empty window or a whole turn? Correct one of them, "
                       "or leave both out for the whole turn",
                       plain(*window.from_deg), plain(*window.to_deg)));
  }
  if (window.from_mm && window.to_mm && *window.from_mm >= *window.to_mm) {
    refuse("/from_mm", fmt::format("from_mm {} is not below to_mm {}; exchange or correct them",
                                   plain(*window.from_mm), plain(*window.to_mm)));
  }
  if (!window.from_deg && !window.to_deg && !window.from_mm && !window.to_mm &&
      !window.found_beyond_um) {
    refuse("", "the window is the whole surface; give its angles, its heights, or found_beyond_um");
  }
}

/// Whether a window takes all points of a layer.
bool takes_layer(const record::WindowTask& window, double z_mm, double tip_radius_mm) {
  constexpr double kGuard_mm = 0.5;
  if (window.from_deg || window.found_beyond_um) return false;
  const double guard_mm = window.guard_mm.value_or(kGuard_mm + tip_radius_mm);
  return (!window.from_mm || z_mm > *window.from_mm - guard_mm) &&
         (!window.to_mm || z_mm < *window.to_mm + guard_mm);
}

/// A touched feature with the numbers that the checks of its sampling need.
struct Sampled {
  const FeaturePlan& feature;
  const record::Characteristic& asked;
  std::string where;
  Findings& findings;

  [[nodiscard]] int layers() const { return feature.sampling.layers; }
  [[nodiscard]] int points() const { return feature.sampling.points_per_layer; }
  [[nodiscard]] bool scanned() const {
    return feature.sampling.method == record::SamplingMethod::kScan;
  }
  [[nodiscard]] const Indication& indication() const { return asked.indication; }
  void refuse(const char* key, std::string what, Code code = Code::kSampling) const {
    findings.meaning(code, where + key, std::move(what));
  }
};

bool is_filtered(const Indication& indication) {
  return indication.filter.value_or(Indication::Filter::kNone) != Indication::Filter::kNone;
}

/// Checks that sections carry the cut-off round them: the sentence is that of the filter.
void check_cutoff_upr(const Sampled& s) {
  if (!is_filtered(s.indication()) || !s.indication().cutoff_upr) return;
  fit::FilterOptions options;
  options.cutoff_upr = *s.indication().cutoff_upr;
  const auto carried = fit::check_sampling(static_cast<std::size_t>(s.points()), options);
  if (carried) return;
  const std::string& what = carried.error().what;
  const std::string sentence = what.substr(0, what.find("; the check can be"));
  s.refuse("/filter", sentence + "; scan, or plan filter \"none\"");
}

/// Checks that the layers carry the cut-off along the axis.
void check_cutoff_mm(const Sampled& s) {
  if (!is_filtered(s.indication()) || !s.indication().cutoff_mm) return;
  constexpr double kPerWave = 7.0;
  const double cutoff_mm = *s.indication().cutoff_mm;
  const std::vector<double> heights = placed_heights(s.feature);
  if (heights.size() < 2) return;
  const double length_mm = heights.back() - heights.front();
  const double apart_mm = length_mm / (static_cast<double>(heights.size()) - 1.0);
  if (apart_mm <= cutoff_mm / kPerWave && length_mm >= 2.0 * cutoff_mm) return;
  s.refuse("/filter",
           fmt::format("layers {:.4g} mm apart do not carry a cut-off of {} mm along the axis: at "
                       "most {:.4g} mm apart and at least {} mm long; leave cutoff_mm out, or plan "
                       "filter \"none\"",
                       apart_mm, plain(cutoff_mm), cutoff_mm / kPerWave, plain(2.0 * cutoff_mm)));
}

void check_sizes(const Sampled& s) {
  using Size = Indication::Size;
  const Indication& i = s.indication();
  if (i.size == Size::kLP && s.points() % 2 == 1 && !s.scanned()) {
    s.refuse("/form", fmt::format("{} points a layer have no opposite ones; plan an even number, "
                                  "or a scan",
                                  s.points()));
  }
  if (i.size != Size::kCC && i.size != Size::kCA && i.size != Size::kCV) return;
  constexpr double kUsualCutoff_upr = 50.0;
  constexpr double kPerUndulation = 7.0;
  const double cutoff_upr = i.cutoff_upr.value_or(kUsualCutoff_upr);
  const double needed = std::ceil(kPerUndulation * cutoff_upr);
  if (s.points() < needed) {
    s.refuse("/size", fmt::format("size {} needs a dense section: {} points a layer are there, {} "
                                  "are needed for {} UPR; scan, or ask for size \"GG\"",
                                  name_of(i.size), s.points(), plain(needed), plain(cutoff_upr)));
  }
}

/// Checks that points of different layers lie at one angle.
void check_generatrices(const Sampled& s) {
  constexpr int kOnALine = 3;
  const bool aligned = s.scanned() || s.feature.sampling.stagger == 0.0;
  const bool opposite = s.asked.form != Form::kStraightness;
  const bool paired = s.scanned() || s.points() % 2 == 0;
  if (s.layers() >= kOnALine && aligned && (!opposite || paired)) return;
  s.refuse("/form",
           fmt::format("no angle holds 3 points of different layers{}; plan sampling.stagger 0 "
                       "{}and at least 3 layers, or a scan",
                       opposite ? " with points opposite each other" : "",
                       opposite ? "with an even number of points a layer " : ""));
}

void check_layout(const Sampled& s) {
  const Form form = s.asked.form;
  const int layers = s.layers();
  if (form == Form::kDiameter) return check_sizes(s);
  if (form == Form::kStraightness && s.indication().of == Indication::Of::kMedianLine) {
    if (layers >= 3) return;
    return s.refuse("/form",
                    fmt::format("{} sections; a median line of 2 is straight whatever the part: "
                                "plan at least 3 layers",
                                layers),
                    Code::kRank);
  }
  if (form == Form::kStraightness || form == Form::kTaper || form == Form::kGeneratrixParallelism) {
    return check_generatrices(s);
  }
  if (form == Form::kRoundness && s.feature.type == Shape::kCylinder && s.points() < 4) {
    s.refuse("/form", fmt::format("{} points a layer lie on a circle exactly, whatever the part; "
                                  "roundness needs at least 4",
                                  s.points()));
  }
}

/// Checks that touched sections have enough points for harmonics: as many as reports filter, 7 per
/// undulation at 50 undulations.
void check_dense(const Sampled& s) {
  constexpr int kDense = 350;
  constexpr int kHighest = 50;
  for (std::size_t i = 0; i < s.asked.harmonic_limits.size(); ++i) {
    if (s.asked.harmonic_limits[i].last <= kHighest) continue;
    s.findings.meaning(Code::kMeaning, item_pointer(s.where + "/harmonic_limits", i),
                       fmt::format("to {} is above {}, the highest harmonic of a touched section",
                                   s.asked.harmonic_limits[i].last, kHighest));
  }
  if (s.feature.source || s.points() >= kDense) return;
  s.refuse("/form", fmt::format("{} points a layer are too few: harmonics need at least {}",
                                s.points(), kDense));
}

void check_portion_of(const Sampled& s) {
  const Indication& i = s.indication();
  const std::vector<double> heights = placed_heights(s.feature);
  if ((!i.from_mm && !i.to_mm) || s.feature.type != Shape::kCylinder) return;
  const auto inside = std::count_if(heights.begin(), heights.end(), [&](double z_mm) {
    return z_mm >= i.from_mm.value_or(z_mm) && z_mm <= i.to_mm.value_or(z_mm);
  });
  if (inside >= kNeededLayers || heights.empty()) return;
  s.refuse(i.from_mm ? "/from_mm" : "/to_mm",
           fmt::format("the portion holds {} of {} layers; {} are needed", inside, heights.size(),
                       kNeededLayers),
           Code::kRank);
}

}  // namespace

void check_windows(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index) + "/exclude";
  if (!findings.sound(where)) return;
  for (std::size_t k = 0; k < feature.exclude.size(); ++k) {
    check_window(feature.exclude[k], item_pointer(where, k), findings);
  }
  if (feature.type != Shape::kCylinder || !is_touched(plan, index, findings) ||
      !findings.sound(feature_pointer(index)) || !plan.probe) {
    return;
  }
  const std::vector<double> heights = placed_heights(feature);
  const double tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  const auto left = std::count_if(heights.begin(), heights.end(), [&](double z_mm) {
    return std::none_of(
        feature.exclude.begin(), feature.exclude.end(),
        [&](const record::WindowTask& window) { return takes_layer(window, z_mm, tip_radius_mm); });
  });
  if (heights.empty() || left >= std::min<std::ptrdiff_t>(kNeededLayers, feature.sampling.layers)) {
    return;
  }
  findings.meaning(Code::kRank, where,
                   fmt::format("the windows leave {} of {} layers; {} are needed", left,
                               heights.size(), kNeededLayers));
}

void check_sampling_of(const FeaturePlan& feature, const record::Characteristic& resolved,
                       const std::string& where, Findings& findings) {
  const Sampled sampled = {feature, resolved, where, findings};
  if (resolved.form == Form::kHarmonicLimits) return check_dense(sampled);
  if (feature.source) return;
  check_layout(sampled);
  check_cutoff_upr(sampled);
  check_cutoff_mm(sampled);
  check_portion_of(sampled);
}

}  // namespace rondure::plans
