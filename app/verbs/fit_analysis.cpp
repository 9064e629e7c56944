// `rondure fit wheel|spindle|contour`: a plan in memory with one feature, evaluated as every run.

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/verbs/plan_in_memory.h"
#include "app/verbs/verbs.h"
#include "core/numbers.h"
#include "core/result.h"
#include "plans/plan.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Arguments = AnalysisArguments;

constexpr std::string_view kFeature = "/features/0/";

/// The file of a part; empty: not given.
std::string file_of(const std::vector<std::string>& files, std::size_t part,
                    const fs::path& folder) {
  return files.empty() ? std::string() : file_from(files[part], folder);
}

/// The ground parts of a contour, a gauge file each.
Json parts_of(const Arguments& a, const fs::path& folder) {
  Json out = Json::array();
  for (std::size_t i = 0; i < a.files.size(); ++i) {
    Json part = {{"name", fs::path(a.files[i]).stem().string()},
                 {"pin", file_from(a.files[i], folder)}};
    if (const auto axes = file_of(a.axes, i, folder); !axes.empty()) part["axes"] = axes;
    if (const auto main = file_of(a.main, i, folder); !main.empty()) part["main"] = main;
    out.push_back(std::move(part));
  }
  return out;
}

/// Puts VALUE of "KEY=VALUE" where KEY says: below the section of the feature, or, behind a slash,
/// anywhere in the plan. VALUE is JSON, and otherwise a text.
core::Result<void> apply(const std::string& setting, const std::string& type, Json& plan) {
  const auto refuse_it = [&](std::string_view why) {
    return core::fail_with(core::Code::kBadOption,
                           "--set {}: {}; KEY=VALUE is expected, as uncertainty.noise_um=0.05",
                           setting, why);
  };
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) return refuse_it("there is no key and no value");
  std::string key = setting.substr(0, equals);
  const std::string text = setting.substr(equals + 1);
  if (key.front() != '/') {
    std::ranges::replace(key, '.', '/');
    key = fmt::format("{}{}/{}", kFeature, type, key);
  }
  Json value = Json::parse(text, nullptr, false);
  if (value.is_discarded()) value = text;
  try {
    plan[Json::json_pointer(key)] = std::move(value);
  } catch (const Json::exception&) {
    return refuse_it("the plan has no such place");
  }
  return {};
}

/// What is asked for where the command line names nothing: what the keys that are there allow.
std::vector<std::string> usual_questions(const Arguments& a, const Json& section) {
  if (a.type == "spindle") {
    return {"roundness", "roundness-rms", "motion-total", "motion-synchronous"};
  }
  if (a.type == "contour") {
    if (a.files.size() < 2) return {"contour-deviation"};
    return {"contour-deviation", "contour-spread"};
  }
  std::vector<std::string> out = {"roundness"};
  if (section.contains("nominal_radius_mm")) out.emplace_back("radius");
  if (section.contains("axis_x_mm")) out.emplace_back("run-out");
  return out;
}

/// "run-out=20": the form, and its limit in um, if any.
core::Result<Json> characteristic_of(const std::string& asked) {
  const std::size_t equals = std::min(asked.find('='), asked.size());
  const std::string form = asked.substr(0, equals);
  Json out = {{"id", form}, {"form", form}};
  if (equals == asked.size()) return out;
  const auto limit = core::parse_number(asked.substr(equals + 1));
  if (!limit) {
    return core::fail_with(core::Code::kBadOption,
                           "--ask {}: FORM or FORM=LIMIT in um is expected, as run-out=20", asked);
  }
  out["tolerance_um"] = *limit;
  return out;
}

core::Result<Json> plan_of(const Arguments& a, const fs::path& folder) {
  const std::string part = fs::path(a.files.front()).stem().string();
  Json feature = {{"id", a.type}, {"type", a.type}, {a.type, Json::object()}};
  if (a.type == "contour") {
    feature[a.type]["parts"] = parts_of(a, folder);
  } else {
    feature["source"] = {{"file", file_from(a.files.front(), folder)}};
  }
  Json plan = {{"plan", {{"name", a.type + " of " + part}, {"revision", "1"}}},
               {"part", {{"id", part}}},
               {"features", Json::array({std::move(feature)})}};
  for (const std::string& setting : a.settings) TRY_DO(apply(setting, a.type, plan));
  const Json::json_pointer place(fmt::format("{}characteristics", kFeature));
  if (!plan.contains(place.parent_pointer()) || !plan[place.parent_pointer()].is_object())
    return plan;  // somebody set the features themselves
  Json& made = plan[place.parent_pointer()];
  Json& characteristics = made["characteristics"];
  if (!characteristics.is_null()) return plan;  // set one by one
  for (const std::string& asked : a.asked.empty() ? usual_questions(a, made[a.type]) : a.asked) {
    TRY(auto characteristic, characteristic_of(asked));
    characteristics.push_back(std::move(characteristic));
  }
  return plan;
}

/// The part of the command line that a place of the plan came from.
std::string place_name(const std::string& type, const std::string& pointer) {
  const std::string section = fmt::format("{}{}/", kFeature, type);
  if (pointer.ends_with("/source/file")) return "FILE";
  if (pointer.starts_with(section + "parts/")) {
    return pointer.ends_with("/pin") ? "FILE" : "--" + pointer.substr(pointer.rfind('/') + 1);
  }
  if (pointer.starts_with(section)) {
    std::string key = pointer.substr(section.size());
    std::ranges::replace(key, '/', '.');
    return "--set " + key;
  }
  if (pointer.find("/characteristics/") != std::string::npos) return "--ask";
  const bool in_file = pointer.find(':') != std::string::npos;  // "name.csv:3"
  return pointer.starts_with('/') && !in_file ? "--set " + pointer : pointer;
}

core::Result<void> check_counts(const Arguments& a) {
  for (const auto& [name, files] : {std::pair("--axes", &a.axes), std::pair("--main", &a.main)}) {
    if (files->empty() || files->size() == a.files.size()) continue;
    return core::fail_with(core::Code::kBadOption, "{} files for {}, {} pins; one of each a part",
                           files->size(), name, a.files.size());
  }
  return {};
}

}  // namespace

int fit_analysis(const AnalysisArguments& a) {
  if (auto good = check_counts(a); !good) return refuse(good.error());
  PlanInMemory plan;
  plan.name = "fit " + a.type;
  for (const auto* files : {&a.files, &a.axes, &a.main}) {
    for (const std::string& file : *files) plan.words.emplace_back("FILE", file);
  }
  for (const std::string& setting : a.settings) plan.words.emplace_back("--set", setting);
  for (const std::string& asked : a.asked) plan.words.emplace_back("--ask", asked);
  if (auto good = check_spelling(plan); !good) return refuse(good.error());
  if (const auto made = plan_of(a, {}); !made) return refuse(made.error());
  plan.text = [&](const fs::path& folder) { return plan_of(a, folder).value().dump(2) + "\n"; };
  plan.place_name = [&](const std::string& pointer) { return place_name(a.type, pointer); };
  plan.out = a.out;
  plan.save_plan = a.save_plan;
  plan.serial = a.serial;
  plan.operator_name = a.operator_name;
  if (a.out.empty() && a.save_plan.empty()) return run_in_passing(plan, a.json);
  if (auto sound = plans::parse_plan(plan.text({}), {}, plan.name); !sound) {
    for (core::Error& error : sound.error()) error.where = plan.place_name(error.where);
    return refuse(sound.error());
  }
  return save_or_run(plan);
}

}  // namespace rondure::app
