#include <array>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/surface_words.h"
#include "app/text/terminal.h"
#include "app/text/wheel.h"
#include "app/verbs/verbs.h"
#include "app/verbs/wheel_command.h"
#include "core/units.h"
#include "record/csv/series.h"
#include "record/files.h"
#include "reports/data/wheel.h"
#include "reports/data/wheel_path.h"

namespace rondure::app {
namespace {

using Points = std::vector<Eigen::Vector2d>;

core::Result<Points> load_wheel(const std::string& file) {
  const auto bytes = record::read_file(file);
  if (!bytes) return core::fail(bytes.error());
  const std::string name = std::filesystem::path(file).filename().string();
  const std::array<record::WantedColumn, 3> columns = {{{"x"}, {"z", false}, {"y", false}}};
  const auto table = record::parse_series_csv(*bytes, name, columns);
  if (!table) return core::fail(table.error());
  const auto z = table->column("z");
  const auto y = table->column("y");
  if (z.has_value() == y.has_value()) {
    return core::fail(core::Code::kSyntax,
                      "a wheel needs the columns x,z or x,y (mm): one of z and y", name);
  }
  const auto x = table->column("x");
  Points out;
  for (std::size_t i = 0; i < x->size(); ++i) out.emplace_back((*x)[i], (z ? *z : *y)[i]);
  return out;
}

fit::WheelOptions measuring_options(const WheelArguments& a) {
  fit::WheelOptions out;
  out.mode = a.mode == "envelope" ? fit::WheelMode::kEnvelope : fit::WheelMode::kIndexed;
  for (const auto mean : {fit::WheelMean::kAsPublished, fit::WheelMean::kWeighted}) {
    if (fit::name_of(mean) == a.center) out.mean = mean;
  }
  using Choice = fit::QuadrupleChoice;
  for (const auto choice : {Choice::kAll, Choice::kBest, Choice::kRandom}) {
    if (fit::name_of(choice) == a.quadruples) out.quadruples.choice = choice;
  }
  out.quadruples.count = a.count;
  out.quadruples.seed = a.seed;
  out.quadruples.kappa_limit = a.kappa_limit;
  out.robust = a.robust;
  out.allow_short_arc = a.override_arc;
  out.nominal_radius_mm = a.nominal_radius_mm;
  if (!a.axis_mm.empty()) out.axis_mm = Eigen::Vector2d(a.axis_mm[0], a.axis_mm[1]);
  return out;
}

core::Result<fit::WheelPathOptions> path_options(const WheelArguments& a,
                                                 const fit::WheelSurface& surface) {
  fit::WheelPathOptions out;
  const auto whole = surface.range_mm();
  if (a.range_mm.empty() && !whole) {
    return core::fail(core::Code::kBadOption,
                      "--range-mm is missing: a formula does not say where the part ends");
  }
  out.from_mm = a.range_mm.empty() ? whole->first : a.range_mm[0];
  out.to_mm = a.range_mm.empty() ? whole->second : a.range_mm[1];
  if (!a.surface_range_mm.empty()) {
    out.surface_from_mm = a.surface_range_mm[0];
    out.surface_to_mm = a.surface_range_mm[1];
  } else if (whole) {
    out.surface_from_mm = whole->first;
    out.surface_to_mm = whole->second;
  }
  out.step_mm = a.step_mm;
  if (a.cusp_um) out.cusp_mm = *a.cusp_um * core::kMicrometre;
  if (!a.wheel_arc_deg.empty()) {
    out.least_contact_rad = a.wheel_arc_deg[0] * core::kDegree;
    out.greatest_contact_rad = a.wheel_arc_deg[1] * core::kDegree;
  }
  out.lowest_point = a.lowest_point;
  return out;
}

core::Result<fit::WheelTask> task_of(const WheelArguments& a) {
  fit::WheelTask out{measuring_options(a), {}};
  if (a.center == "least-squares" && a.quadruples != "all") {
    return core::fail(core::Code::kBadOption,
                      fmt::format("--quadruples {} has no effect on a least-squares centre; add "
                                  "--center as-published or weighted",
                                  a.quadruples));
  }
  if (a.surface.empty()) {
    if (a.path.empty() && a.gcode.empty() && a.removal.empty()) return out;
    return core::fail(core::Code::kBadOption,
                      "--path, --gcode and --removal need --surface: what is to be ground?");
  }
  auto surface = read_surface(a.surface);
  if (surface && !a.removal.empty()) surface = take_removal(*surface, a.removal);
  if (!surface) return core::fail(surface.error());
  const auto options = path_options(a, *surface);
  if (!options) return core::fail(options.error());
  fit::WheelPathTask path{*std::move(surface), *options, fit::RadiusChoice::kMean,
                          a.repeatability_um * core::kMicrometre, a.touch_off_mm};
  if (a.radius == "effective") path.radius = fit::RadiusChoice::kEffective;
  out.path = std::move(path);
  return out;
}

core::Result<void> write_files(const WheelArguments& a, const fit::WheelPath& path) {
  if (!a.path.empty()) {
    if (auto done = record::write_file(a.path, reports::wheel_path_csv(path)); !done) return done;
  }
  if (a.gcode.empty()) return {};
  return record::write_file(a.gcode, reports::wheel_gcode(path, {a.feed_mm_min, a.retract_mm}));
}

int refuse(const core::Error& error, const std::string& file) {
  const std::string name = std::filesystem::path(file).filename().string();
  print_error(error.where.empty() && !file.empty() ? error.at(name) : error);
  return kBadInput;
}

}  // namespace

int wheel(const WheelArguments& arguments) {
  const auto task = task_of(arguments);
  if (!task) return refuse(task.error(), {});
  const auto points = load_wheel(arguments.file);
  if (!points) return refuse(points.error(), arguments.file);
  const auto evaluation = fit::evaluate_wheel(*points, *task);
  if (!evaluation) return refuse(evaluation.error(), arguments.file);
  const auto found = reports::wheel_json(*evaluation, *task);
  if (const auto finite = check_finite(found); !finite) {
    return refuse(finite.error(), arguments.file);
  }
  if (evaluation->path) {
    if (auto written = write_files(arguments, *evaluation->path); !written) {
      return refuse(written.error(), {});
    }
  }
  // The wheel is measured even where the surface cannot be ground with it.
  const int status = answer(found, arguments.json, [&] { return wheel_table(*evaluation, *task); });
  return evaluation->refused ? refuse(*evaluation->refused, {}) : status;
}

}  // namespace rondure::app
