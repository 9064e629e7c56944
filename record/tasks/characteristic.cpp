#include "record/tasks/characteristic.h"

#include "core/units.h"
#include "record/tasks/form_facts.h"

namespace rondure::record {
namespace {

using Levels = std::span<const CharacteristicLevel>;

/// The value of a key: from the characteristic, else from the nearest level that gives it; none
/// where the form does not take the key.
template <class Value, class Member>
std::optional<Value> resolved(const CharacteristicTask& task, std::string_view key,
                              const std::optional<Value>& own, Levels levels, Member inherited) {
  if (!takes(task.form, key)) return std::nullopt;
  std::optional<Value> out = own;
  for (const CharacteristicLevel& level : levels) {
    if (!out) out = level.defaults.*inherited;
  }
  return out;
}

Reference reference_of(const CharacteristicTask& task, Levels levels) {
  if (task.reference) return *task.reference;
  if (task.indication.parameter != Indication::Parameter::kTotal) return Reference::kLeastSquares;
  const auto inherited =
      resolved(task, "reference", task.reference, levels, &DefaultsTask::reference);
  const bool any = facts_of(task.form).about.has_value();  // others have no mc and no mi
  const bool usable = any || inherited == Reference::kLeastSquares;
  return inherited && usable ? *inherited : Reference::kMinimumZone;
}

Indication indication_of(const CharacteristicTask& task, Levels levels) {
  using I = Indication;
  const I& own = task.indication;
  I out = own;
  const auto optional = [&](std::string_view key, const auto& value, auto member) {
    return resolved(task, key, value, levels, member);
  };
  out.association = optional("association", own.association, &DefaultsTask::association);
  out.filter = optional("filter", own.filter, &DefaultsTask::filter);
  out.cutoff_upr = optional("cutoff_upr", own.cutoff_upr, &DefaultsTask::cutoff_upr);
  out.cutoff_mm = optional("cutoff_mm", own.cutoff_mm, &DefaultsTask::cutoff_mm);
  out.outliers = optional("outliers", own.outliers, &DefaultsTask::outliers);
  if (takes(task.form, "association") && !out.association) {
    out.association = I::Association::kOneSided;
  }
  if (takes(task.form, "filter") && !out.filter) out.filter = I::Filter::kNone;
  if (takes(task.form, "outliers") && !out.outliers) out.outliers = I::Outliers::kNone;
  if (out.filter.value_or(I::Filter::kNone) == I::Filter::kNone) {
    out.cutoff_upr.reset();
    out.cutoff_mm.reset();
  }
  for (const CharacteristicLevel& level : levels) {
    if (!out.decision_rule) out.decision_rule = level.decision_rule;
  }
  return out;
}

std::optional<double> in_mm(const std::optional<double>& limit_um, double from_mm) {
  if (!limit_um) return std::nullopt;
  return from_mm + *limit_um * core::kMicrometre;
}

}  // namespace

Characteristic characteristic_of(const CharacteristicTask& task, double nominal_diameter_mm,
                                 Levels levels) {
  Characteristic out;
  out.id = task.id;
  out.form = task.form;
  out.reference = reference_of(task, levels);
  const LimitKind limits = limits_of(task.form, task.indication.rank);
  // A urad is to the mrad of an angle what a um is to the mm of a length.
  const bool angle = is_angle(task.form, task.indication);
  const auto& tolerance = angle ? task.tolerance_urad : task.tolerance_um;
  const auto& lower = angle ? task.lower_urad : task.lower_um;
  const auto& upper = angle ? task.upper_urad : task.upper_um;
  const auto& symmetric = angle ? task.symmetric_urad : task.symmetric_um;
  if (limits == LimitKind::kSize) {
    out.lower_mm = in_mm(lower, nominal_diameter_mm);
    out.tolerance_mm = in_mm(upper, nominal_diameter_mm);
  } else if (tolerance) {
    out.tolerance_mm = *tolerance * core::kMicrometre;
  } else if (limits == LimitKind::kSigned && symmetric) {
    out.lower_mm = -*symmetric * core::kMicrometre;
    out.tolerance_mm = *symmetric * core::kMicrometre;
  } else if (limits == LimitKind::kSigned) {
    out.lower_mm = in_mm(lower, 0.0);
    out.tolerance_mm = in_mm(upper, 0.0);
  }
  out.drawing_zone = task.drawing_zone;
  for (const HarmonicLimitTask& line : task.harmonic_limits) {
    out.harmonic_limits.push_back({line.from, line.to, line.amplitude_um * core::kMicrometre});
  }
  out.indication = indication_of(task, levels);
  return out;
}

}  // namespace rondure::record
