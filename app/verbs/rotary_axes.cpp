#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/rotary_axes.h"
#include "app/text/terminal.h"
#include "app/verbs/rotary_axes_command.h"
#include "app/verbs/rotary_axes_files.h"
#include "app/verbs/verbs.h"

namespace rondure::app {
namespace {

using core::Code;

fit::RotaryOptions options_of(const RotaryAxesArguments& a) {
  fit::RotaryOptions out;
  if (a.method == "linear") out.solver = fit::RotaryOptions::Solver::kLinear;
  if (a.method == "as-published") out.solver = fit::RotaryOptions::Solver::kAsPublished;
  if (a.curve == "fourier") out.curve = fit::RotaryCurve::kFourier;
  if (a.curve == "polynomial") out.curve = fit::RotaryCurve::kPolynomial;
  out.remove_outliers = !a.keep_outliers;
  return out;
}

core::Result<std::vector<RotaryFacts>> identify(const RotaryAxesArguments& arguments) {
  if (!arguments.place_mm.empty() && arguments.place_mm.size() != 3) {
    return core::fail(Code::kBadOption, "--at needs three numbers: X,Y,Z");
  }
  const auto axes = read_rotary_axes(arguments);
  if (!axes) return core::fail(axes.error());
  std::vector<RotaryFacts> out;
  for (const NamedAxis& axis : *axes) {
    auto study = fit::identify_rotary_axis(axis.measurement, options_of(arguments));
    if (!study) return core::fail(study.error().at(fmt::format("axis {}", axis.name)));
    RotaryFacts facts;
    facts.name = axis.name;
    facts.method = arguments.method;
    facts.place_mm = axis.measurement.axis.origin_mm;
    if (!arguments.place_mm.empty()) {
      facts.place_mm = {arguments.place_mm[0], arguments.place_mm[1], arguments.place_mm[2]};
    }
    auto model = fit::RotaryModel::of(study->table);
    if (model) {
      facts.model = *std::move(model);
    } else if (model.error().code == Code::kBadOption) {
      return core::fail(model.error().at(fmt::format("axis {}", axis.name)));
    } else {
      study->warnings.push_back(model.error());
    }
    facts.study = *std::move(study);
    out.push_back(std::move(facts));
  }
  return out;
}

}  // namespace

int rotary_axes(const RotaryAxesArguments& arguments) {
  const auto facts = identify(arguments);
  if (!facts) {
    print_error(facts.error());
    return kBadInput;
  }
  return answer(rotary_axes_json(*facts), arguments.json,
                [&] { return rotary_axes_table(*facts); });
}

}  // namespace rondure::app
