#include "evaluation/contour/internal/curve_model.h"

#include <utility>

#include "core/statistics.h"
#include "core/watch.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "evaluation/uncertainty/internal/chains.h"

namespace rondure::evaluation::contour_trials {

namespace {

constexpr int kBudgetDraws = 200;

/// The budget of every number. One draw of an influence serves all of them.
std::vector<std::vector<LinearTerm>> budgets_of(const CurveModel& model,
                                                const std::vector<Asked>& asked) {
  std::vector<std::vector<LinearTerm>> out(asked.size());
  for (const Effect& effect : model.effects) {
    const int draws = effect.at ? 2 : kBudgetDraws;
    std::vector<std::vector<double>> values(asked.size());
    for (int i = 0; i < draws; ++i) {
      Curves curves = model.measured;
      if (effect.at) {
        effect.at(i == 0 ? 1.0 : -1.0, curves);
      } else {
        effect.draw(i, curves);
      }
      for (std::size_t a = 0; a < asked.size(); ++a) {
        if (asked[a].has_budget) values[a].push_back(asked[a].value(curves));
      }
    }
    for (std::size_t a = 0; a < asked.size(); ++a) {
      if (!asked[a].has_budget) continue;
      const double per_u_mm = effect.at
                                  ? per_u([&](double z) { return values[a][z > 0.0 ? 0 : 1]; })
                                  : core::standard_deviation(values[a], core::mean(values[a]));
      out[a].push_back({effect.name, per_u_mm});
    }
  }
  return out;
}

}  // namespace

std::vector<UncertaintyStatus> states(const CurveModel& model, const std::vector<Asked>& asked,
                                      const UncertaintyOptions& options) {
  std::vector<TrialValues> found(asked.size());
  for (std::size_t a = 0; a < asked.size(); ++a) {
    found[a].as_measured_mm = asked[a].as_measured;
    found[a].signed_value = asked[a].is_signed;
    const auto count = static_cast<std::size_t>(options.least_trials);
    found[a].values_mm.resize(count);
    if (!model.core_draw || !asked[a].convex) continue;
    found[a].core_mm.resize(count);
    found[a].core_center_mm = asked[a].value(model.core_center);
  }
  core::watch().expect(static_cast<std::size_t>(options.least_trials));
  const auto run = [&](std::size_t index) {
    core::watch().drawn();
    const auto trial = static_cast<int>(index);
    Curves curves = model.draw(trial);
    Curves core = model.core_draw ? model.core_draw(trial) : Curves();
    for (const Effect& effect : model.effects) {
      if (effect.in_draws) continue;
      effect.draw(trial, curves);
      // What the truth holds and the estimate does not inflates nothing.
      if (!effect.berkson && model.core_draw) effect.draw(trial, core);
    }
    for (std::size_t a = 0; a < asked.size(); ++a) {
      found[a].values_mm[index] = asked[a].value(curves);
      if (!found[a].core_mm.empty()) found[a].core_mm[index] = asked[a].value(core);
    }
  };
  in_parallel(threads_of(options), static_cast<std::size_t>(options.least_trials),
              [&](std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) run(i);
              });
  auto budgets = budgets_of(model, asked);
  std::vector<UncertaintyStatus> out;
  for (std::size_t a = 0; a < asked.size(); ++a) {
    auto stated = statement_of_trials(std::move(found[a]), std::move(budgets[a]), model.declaration,
                                      options_of_line(options, asked[a].lines));
    if (!stated) {
      out.push_back(UncertaintyStatus::none(stated.error().said()));
      continue;
    }
    stated->notes.insert(stated->notes.end(), model.notes.begin(), model.notes.end());
    out.push_back(UncertaintyStatus::stated(*std::move(stated), options.coverage));
  }
  return out;
}

}  // namespace rondure::evaluation::contour_trials
