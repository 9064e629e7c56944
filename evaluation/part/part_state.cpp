#include "evaluation/part/part_state.h"

#include <map>
#include <tuple>
#include <utility>

#include "evaluation/part/internal/families.h"

namespace rondure::evaluation {
namespace {

using Indication = record::Indication;

/// All that prepared() reads of an indication, and the feature.
auto preparation_of(std::size_t feature, const Indication& i) {
  return std::tuple(feature, i.outliers, i.from_mm, i.to_mm, i.filter, i.cutoff_upr, i.cutoff_mm);
}

/// All that datums_of() reads of a characteristic, and the feature.
auto datum_key_of(std::size_t feature, const record::Characteristic& asked, Proof proof) {
  return std::tuple(feature, asked.indication.datum, asked.indication.association,
                    needs_datum_axis(asked.form), proof);
}

}  // namespace

struct PartState::Memory {
  struct Surface {
    core::Result<PreparedSurface> prepared;
    SharedLines lines;
  };
  std::map<decltype(preparation_of(0, {})), Surface> surfaces;
  std::map<decltype(datum_key_of(0, {}, Proof::kFull)), core::Result<std::vector<DatumResult>>>
      datums;
  double pivots = 0.0;

  Surface& of(std::span<const MeasuredSurface> part, std::size_t feature,
              const Indication& indication) {
    const auto key = preparation_of(feature, indication);
    const auto known = surfaces.find(key);
    if (known != surfaces.end()) return known->second;
    Surface made{evaluation::prepared(part[feature], indication), {}};
    return surfaces.emplace(key, std::move(made)).first->second;
  }
};

PartState::PartState(std::span<const MeasuredSurface> surfaces)
    : surfaces_(surfaces), memory_(std::make_shared<Memory>()) {}

const core::Result<PreparedSurface>& PartState::prepared(std::size_t feature,
                                                         const Indication& indication) const {
  return memory_->of(surfaces_, feature, indication).prepared;
}

void PartState::add_pivots(int pivots) const { memory_->pivots += pivots; }

double PartState::pivots() const { return memory_->pivots; }

SharedLines& PartState::lines(std::size_t feature, const Indication& indication) const {
  return memory_->of(surfaces_, feature, indication).lines;
}

const core::Result<std::vector<DatumResult>>& PartState::datums(std::size_t feature,
                                                                const record::Characteristic& asked,
                                                                Proof proof) const {
  const auto key = datum_key_of(feature, asked, proof);
  const auto known = memory_->datums.find(key);
  if (known != memory_->datums.end()) return known->second;
  return memory_->datums.emplace(key, datums_of(*this, feature, asked, proof)).first->second;
}

}  // namespace rondure::evaluation
