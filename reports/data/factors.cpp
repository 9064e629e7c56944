#include "reports/data/analyses.h"
#include "reports/data/internal/json_parts.h"

namespace rondure::reports {
namespace {

Json names_of(const evaluation::FactorStudy& study, evaluation::Factor factor,
              const std::vector<std::size_t>& levels) {
  return list_json(levels, [&](std::size_t level) { return study.levels[at(factor)][level]; });
}

Json effect_json(const evaluation::FactorStudy& study, evaluation::Factor factor) {
  const evaluation::FactorEffect& effect = study.effects[at(factor)];
  const auto& names = study.levels[at(factor)];
  Json out = {{"factor", name_of(factor)},
              {"levels", names},
              {"reported", names[study.reported[at(factor)]]},
              {"levels_with_value", effect.levels}};
  out["least_change_um"] = in_um(effect.least_change_mm);
  out["greatest_change_um"] = in_um(effect.greatest_change_mm);
  out["range_um"] = in_um(effect.range_mm());
  out["strongest"] = names[effect.strongest];
  out["share"] = study.shares ? Json(study.shares->share_1[at(factor)]) : Json(nullptr);
  return out;
}

Json shares_json(const evaluation::FactorStudy& study) {
  if (!study.shares) return nullptr;
  const evaluation::FactorShares& shares = *study.shares;
  Json levels = Json::object();
  for (const evaluation::Factor factor : evaluation::kFactors)
    levels[std::string(name_of(factor))] = names_of(study, factor, shares.used[at(factor)]);
  return {{"values", shares.values},
          {"levels", std::move(levels)},
          {"mean_um", in_um(shares.mean)},
          {"variance_um2", in_um(in_um(shares.variance))},
          {"together_share", shares.together_1}};
}

Json cells_json(const evaluation::FactorStudy& study) {
  Json out = Json::array();
  evaluation::FactorTable table;
  for (const auto& levels : study.levels) table.levels.push_back(levels.size());
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    const auto combination = table.combination(i);
    const evaluation::FactorCell& cell = study.cells[i];
    Json one = Json::object();
    for (const evaluation::Factor factor : evaluation::kFactors)
      one[std::string(name_of(factor))] = study.levels[at(factor)][combination[at(factor)]];
    one["value_um"] = optional_um(cell.value_mm);
    one["points"] = cell.points;
    one["left_out"] = cell.left_out;
    one["why"] = cell.why;
    out.push_back(std::move(one));
  }
  return out;
}

Json study_json(const evaluation::FactorStudy& study) {
  return {{"feature", study.feature},
          {"characteristic", study.characteristic.id},
          {"symbol", study.symbol},
          {"answer", answer_of(study)},
          {"reported_um", in_um(study.reported_mm)},
          {"reported", study.value},
          {"operator", study.operator_words},
          {"factors", list_json(evaluation::kFactors,
                                [&](evaluation::Factor f) { return effect_json(study, f); })},
          {"factorial", shares_json(study)},
          {"cells", cells_json(study)}};
}

}  // namespace

std::string comparison_json(const std::string& run_id,
                            const evaluation::RunComparison& comparison) {
  const Json out = {{"run", run_id},
                    {"characteristics", list_json(comparison.studies, study_json)},
                    {"not_compared", list_json(comparison.without, error_json)}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace rondure::reports
