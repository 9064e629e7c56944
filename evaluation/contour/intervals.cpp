#include "evaluation/contour/result.h"

namespace rondure::evaluation {

std::vector<UncertaintyStatus> intervals_of(
    const ContourResult& /*result*/, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& /*options*/) {
  return {characteristics.size(), UncertaintyStatus::none(core::phrase(
                                      "no influence of it is declared in the plan"))};
}

}  // namespace rondure::evaluation
