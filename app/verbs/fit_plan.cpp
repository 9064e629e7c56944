// `rondure fit SHAPE FILE --out DIR`: a plan in memory, run like any other.

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/plan_in_memory.h"
#include "app/verbs/verbs.h"
#include "record/tasks/form_facts.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The form of a shape that a drawing limits; only shapes of which check_fit() lets a plan pass.
record::Form form_of(std::string_view shape) {
  if (shape == "cylinder") return record::Form::kCylindricity;
  return shape == "plane" ? record::Form::kFlatness : record::Form::kRoundness;
}

Json source_of(const FitArguments& arguments, const fs::path& folder) {
  Json out = {{"file", file_from(arguments.file, folder)}};
  if (!arguments.points.feature.empty()) {
    out["feature"] = arguments.points.feature;
    out["others"] = name_of(record::UntakenRows::kLeftOut);
  }
  if (arguments.points_are != record::PointsAre::kTipCentres)
    out["points"] = name_of(arguments.points_are);
  if (arguments.tip_diameter_mm) out["tip_diameter_mm"] = *arguments.tip_diameter_mm;
  for (std::size_t i = 0; i < arguments.points.columns.size(); ++i) {
    out["columns"].push_back({{"column", std::string(1, static_cast<char>('x' + i))},
                              {"in_file", arguments.points.columns[i]}});
  }
  if (const auto unit = arguments.points.unit) out["unit"] = name_of(*unit);
  if (const auto layers = arguments.points.layers) out["layers"] = name_of(*layers);
  return out;
}

/// The plan of the command line, for a file in this folder.
std::string plan_text(const FitArguments& arguments, const fs::path& folder) {
  const record::FormFacts& facts = record::facts_of(form_of(arguments.shape));
  Json asked = {{"id", facts.symbol}, {"form", name_of(facts.form)}};
  if (arguments.reference != "all") asked["reference"] = arguments.reference;
  if (arguments.tolerance_um) {
    asked["id"] = fmt::format("{} {:g}", facts.symbol, *arguments.tolerance_um);
    asked["tolerance_um"] = *arguments.tolerance_um;
  }
  const std::string part =
      arguments.part.empty() ? fs::path(arguments.file).stem().string() : arguments.part;
  Json feature = {{"id", arguments.shape}, {"type", arguments.shape}};
  if (arguments.inside) feature["side"] = "inside";
  feature["source"] = source_of(arguments, folder);
  feature["characteristics"] = Json::array({std::move(asked)});
  Json of_part = {{"id", part}};
  if (!arguments.drawing.empty()) of_part["drawing"] = arguments.drawing;
  const Json plan = {{"plan", {{"name", arguments.shape + " of " + part}, {"revision", "1"}}},
                     {"part", std::move(of_part)},
                     {"features", Json::array({std::move(feature)})}};
  return plan.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The part of the command line that a place of the plan came from, which the person has not seen.
std::string place_name(const std::string& pointer) {
  for (const auto& [end, name] :
       {std::pair("/source/file", "FILE"), std::pair("/source/feature", "--feature"),
        std::pair("/source/unit", "--unit"), std::pair("/source/layers", "--layers"),
        std::pair("/source/tip_diameter_mm", "--tip-diameter-mm"),
        std::pair("/source/points", "--points"), std::pair("/side", "--inside"),
        std::pair("/reference", "--reference"), std::pair("/tolerance_um", "--tolerance-um")}) {
    if (pointer.ends_with(end)) return name;
  }
  return pointer.find("/source/columns") != std::string::npos ? "--columns" : pointer;
}

}  // namespace

int fit_or_run(const FitArguments& arguments) {
  if (arguments.out.empty() && arguments.save_plan.empty()) return fit(arguments);
  PlanInMemory plan;
  plan.name = "fit " + arguments.shape;
  plan.text = [&](const fs::path& folder) { return plan_text(arguments, folder); };
  plan.place_name = place_name;
  const fs::path folder =
      arguments.save_plan.empty() ? fs::path() : fs::absolute(arguments.save_plan).parent_path();
  plan.words = {{"FILE", file_from(arguments.file, folder)},
                {"--feature", arguments.points.feature}};
  for (const std::string& column : arguments.points.columns)
    plan.words.emplace_back("--columns", column);
  plan.out = arguments.out;
  plan.save_plan = arguments.save_plan;
  plan.serial = arguments.serial;
  plan.operator_name = arguments.operator_name;
  if (auto good = check_spelling(plan); !good) return refuse(good.error());
  // Before anything is written.
  const auto points = load_points(arguments);
  if (!points) return refuse(points.error());
  if (!arguments.out.empty()) say(wrapped(points->read, "Read as ", "  ") + "\n");
  return save_or_run(plan);
}

}  // namespace rondure::app
