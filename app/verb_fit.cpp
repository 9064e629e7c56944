#include <filesystem>

#include <fmt/format.h>

#include "app/fit_text.h"
#include "app/terminal.h"
#include "app/verbs.h"
#include "record/points_csv.h"

namespace rondure::app {
namespace {

bool wants(const FitArguments& arguments, const char* reference) {
  return arguments.reference == "all" || arguments.reference == reference;
}

core::Result<record::PointTable> load(const FitArguments& arguments) {
  const auto bytes = record::read_file(arguments.file);
  if (!bytes) return core::fail(bytes.error());
  const std::string name = std::filesystem::path(arguments.file).filename().string();
  auto table = record::parse_points_csv(*bytes, name);
  if (!table) return table;
  const int needed = arguments.shape == "circle" ? 2 : 3;
  if (table->dimensions != needed) {
    return core::fail(core::Code::kSyntax,
                      fmt::format("a {} needs the columns {}, the file has {}", arguments.shape,
                                  needed == 2 ? "x,y" : "x,y,z", needed == 2 ? "x,y,z" : "x,y"),
                      name + ":1");
  }
  return table;
}

core::Result<void> fit_circle(const FitArguments& arguments,
                              const std::vector<Eigen::Vector3d>& points, FitOutcome& out) {
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& p : points) flat.emplace_back(p.head<2>());
  if (wants(arguments, "ls")) {
    const auto ls = fit::ls_circle(flat);
    if (!ls) return core::fail(ls.error());
    out.ls_circle = *ls;
  }
  if (wants(arguments, "mz")) {
    const auto mz = fit::min_zone_circle(flat);
    if (!mz) return core::fail(mz.error());
    out.mz_circle = *mz;
    if (mz->exact_fit) {
      out.warnings.push_back({core::Code::kExactFit,
                              "three different points lie on a circle exactly: the deviation "
                              "says nothing about form",
                              {}});
    }
  }
  return {};
}

core::Result<void> fit_cylinder(const FitArguments& arguments,
                                const std::vector<Eigen::Vector3d>& points, FitOutcome& out) {
  if (wants(arguments, "ls")) {
    const auto ls = fit::ls_cylinder(points);
    if (!ls) return core::fail(ls.error());
    out.ls_cylinder = *ls;
  }
  if (wants(arguments, "mz")) {
    const auto mz = fit::min_zone_cylinder(points);
    if (!mz) return core::fail(mz.error());
    out.mz_cylinder = *mz;
  }
  return {};
}

}  // namespace

int fit(const FitArguments& arguments) {
  const auto table = load(arguments);
  if (!table) {
    complain(table.error());
    return kBadInput;
  }
  FitOutcome outcome;
  outcome.shape = arguments.shape;
  outcome.points = table->points_mm.size();
  outcome.all_references = arguments.reference == "all";
  const auto fitted = arguments.shape == "circle"
                          ? fit_circle(arguments, table->points_mm, outcome)
                          : fit_cylinder(arguments, table->points_mm, outcome);
  if (!fitted) {
    complain(
        fitted.error().at(fitted.error().where.empty() ? arguments.file : fitted.error().where));
    return kBadInput;
  }
  const auto& certificate = outcome.mz_circle     ? &outcome.mz_circle->certificate
                            : outcome.mz_cylinder ? &outcome.mz_cylinder->certificate
                                                  : nullptr;
  if (certificate != nullptr && certificate->kind == fit::Certificate::Kind::kNone) {
    outcome.warnings.push_back({core::Code::kNoCertificate, certificate->reason, {}});
  }
  if (outcome.all_references) {
    outcome.warnings.push_back(
        {core::Code::kReferenceAbsent,
         "mc and mi (minimum circumscribed, maximum inscribed) are not computed by this version",
         {}});
  }
  say(arguments.json ? fit_json(outcome) : fit_table(outcome));
  return kAllWell;
}

}  // namespace rondure::app
