#include "evaluation/part/find.h"

#include <algorithm>

#include "evaluation/part/internal/families.h"

namespace rondure::evaluation {
namespace {

using record::Form;
using Indication = record::Indication;

/// The family of a characteristic that needs no datum.
core::Result<Finding> find_alone(const PartState& part, std::size_t feature,
                                 const record::Characteristic& asked, Proof proof) {
  const PreparedSurface& surface = *part.prepared(feature, asked.indication);
  switch (asked.form) {
    case Form::kDiameter:
      return find_size(surface, asked, proof);
    case Form::kStraightness:
    case Form::kTaper:
    case Form::kGeneratrixParallelism:
      return find_straightness(surface, asked, proof, part.lines(feature, asked.indication));
    default:
      return find_form(surface, asked, proof);
  }
}

core::Result<Finding> find_about(const PreparedSurface& surface,
                                 const record::Characteristic& asked,
                                 std::span<const DatumResult> datums) {
  const bool turns = asked.form == Form::kRunOut || asked.form == Form::kTotalRunOut;
  return turns ? find_run_out(surface, asked, datums) : find_location(surface, asked, datums);
}

/// The finding about one-sided datums, with the values about the equalised ones beside it: only
/// where both give one verdict is there one.
core::Result<Finding> find_about_both(const PreparedSurface& surface,
                                      const record::Characteristic& asked,
                                      std::vector<DatumResult> datums) {
  auto found = find_about(surface, asked, datums);
  if (!found) return found;
  const auto rocks = [](const DatumResult& datum) { return datum.equalised.has_value(); };
  if (std::any_of(datums.begin(), datums.end(), rocks)) {
    std::vector<DatumResult> equalised = datums;
    for (DatumResult& datum : equalised) datum.place = datum.equalised.value_or(datum.place);
    const auto other = find_about(surface, asked, equalised);
    if (!other) return other;
    for (const JudgedValue& value : other->judged) {
      found->about_equalised_mm.push_back(value.value_mm);
    }
  }
  found->datums = std::move(datums);
  return found;
}

/// Form beyond the cut-off is no part of the value, and few drawings mean so little of it.
void warn_of_low_cutoff(const record::Characteristic& asked, Finding& out) {
  constexpr double kLeastUsual_upr = 15.0;  // of the series 15, 50, 150, ... (ISO 12181-2)
  const auto& cutoff_upr = asked.indication.cutoff_upr;
  const bool form = asked.form == Form::kCylindricity || asked.form == Form::kRoundness;
  if (!form || !cutoff_upr || *cutoff_upr >= kLeastUsual_upr) return;
  out.warnings.push_back(core::error_of(
      core::Code::kHarmonicLoss,
      core::phrase("form above {:g} UPR is filtered away: the lowest usual cut-off is {:g} UPR; "
                   "plan cutoff_upr as the drawing says",
                   *cutoff_upr, kLeastUsual_upr)));
}

}  // namespace

bool is_found(const record::Feature& feature, const record::Characteristic& asked) {
  switch (asked.form) {
    case Form::kCylindricity:
    case Form::kRoundness: {
      const Indication& i = asked.indication;
      const bool plain =
          i.parameter == Indication::Parameter::kTotal && i.section == Indication::Section::kAll &&
          !i.from_mm && !i.to_mm &&
          i.filter.value_or(Indication::Filter::kNone) == Indication::Filter::kNone &&
          i.outliers.value_or(Indication::Outliers::kNone) == Indication::Outliers::kNone;
      const bool windows = std::any_of(
          feature.settings.begin(), feature.settings.end(),
          [](const record::Setting& setting) { return setting.name.starts_with("exclude/"); });
      return !record::is_analysis(feature.shape) && !(plain && !windows);
    }
    case Form::kDiameter:
    case Form::kStraightness:
    case Form::kGeneratrixParallelism:
    case Form::kTaper:
    case Form::kFlatness:
    case Form::kCoaxiality:
    case Form::kConcentricity:
    case Form::kParallelism:
    case Form::kPerpendicularity:
    case Form::kAngularity:
    case Form::kTotalRunOut:
      return true;
    case Form::kRunOut:
      return !record::is_analysis(feature.shape);
    case Form::kRoundnessRms:
    case Form::kHarmonicLimits:
    case Form::kMotionTotal:
    case Form::kMotionSynchronous:
    case Form::kMotionAsynchronous:
    case Form::kRadius:
    case Form::kContourDeviation:
    case Form::kContourSpread:
    case Form::kFollowingDeviation:
    case Form::kFixtureResidual:
    case Form::kFixtureResidualRms:
    case Form::kAxisError:
    case Form::kLeftRms:
    case Form::kLeftLargest:
    case Form::kLocation:
      break;
  }
  return false;
}

core::Result<Finding> find(const PartState& part, std::size_t feature,
                           const record::Characteristic& asked, Proof proof) {
  const core::Result<PreparedSurface>& surface = part.prepared(feature, asked.indication);
  if (!surface) return core::fail(surface.error());
  if (surface->no_sections && asked.form != Form::kCylindricity) {
    return core::fail(*surface->no_sections);
  }
  core::Result<Finding> found = core::fail(core::Code::kMeaning, "not evaluated");
  if (asked.indication.datum.empty()) {
    found = find_alone(part, feature, asked, proof);
  } else {
    const core::Result<std::vector<DatumResult>>& datums = part.datums(feature, asked, proof);
    if (!datums) return core::fail(datums.error());
    found = find_about_both(*surface, asked, *datums);
  }
  if (!found) return found;
  part.add_pivots(found->pivots);
  found->left_out = surface->left_out;
  found->filter = surface->filter;
  found->warnings.insert(found->warnings.begin(), surface->warnings.begin(),
                         surface->warnings.end());
  if (proof == Proof::kFull) warn_of_low_cutoff(asked, *found);
  return found;
}

core::Result<Finding> find(std::span<const MeasuredSurface> part, std::size_t feature,
                           const record::Characteristic& asked, Proof proof) {
  return find(PartState(part), feature, asked, proof);
}

}  // namespace rondure::evaluation
