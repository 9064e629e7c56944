#include "record/tasks/characteristic.h"

#include "core/units.h"

namespace rondure::record {

bool is_size(const Characteristic& characteristic) {
  const auto& rank = characteristic.indication.rank;
  const bool spread = rank && (*rank == Indication::Rank::kSR || *rank == Indication::Rank::kSQ);
  return characteristic.form == Form::kDiameter && !spread;
}

Characteristic characteristic_of(const CharacteristicTask& task) {
  Characteristic out;
  out.id = task.id;
  out.form = task.form;
  out.reference = task.reference.value_or(Reference::kMinimumZone);
  if (task.tolerance_um) out.tolerance_mm = *task.tolerance_um * core::kMicrometre;
  out.drawing_zone = task.drawing_zone;
  for (const HarmonicLimitTask& line : task.harmonic_limits) {
    out.harmonic_limits.push_back({line.from, line.to, line.amplitude_um * core::kMicrometre});
  }
  return out;
}

}  // namespace rondure::record
