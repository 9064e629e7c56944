#include "reports/data/internal/json_parts.h"

#include "evaluation/results/feature_values.h"

namespace rondure::reports {

Json optional_um(const std::optional<double>& length_mm) {
  return length_mm ? Json(in_um(*length_mm)) : Json(nullptr);
}

Json error_json(const core::Error& error) {
  return {{"code", core::code_name(error.code)}, {"what", error.what}, {"where", error.where}};
}

Json characteristic_json(const evaluation::CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  return {{"id", asked.id},
          {"form", record::name_of(asked.form)},
          {"symbol", evaluation::symbol_of(asked)},
          {"reference", evaluation::reference_of(asked)},
          {"value_um", optional_um(result.value_mm())},
          {"quoted_um", result.value ? Json(in_um(result.value->quoted_mm())) : Json(nullptr)},
          {"tolerance_um", optional_um(asked.tolerance_mm)},
          {"verdict", name_of(result.verdict)},
          {"reason", result.reason},
          {"operator", result.value ? Json(result.value->operator_text()) : Json(nullptr)},
          {"drawing_zone", asked.drawing_zone},
          {"stated", result.value ? Json(result.value->sentence()) : Json(nullptr)},
          {"uncertainty", uncertainty_json(result)},
          {"no_uncertainty_because", result.value && !result.value->uncertainty().result()
                                         ? Json(result.value->uncertainty().why())
                                         : Json(nullptr)},
          {"decision", decision_json(result)}};
}

}  // namespace rondure::reports
