#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/text/wheel.h"
#include "app/verbs/verbs.h"
#include "app/verbs/wheel_command.h"
#include "core/numbers.h"
#include "core/result.h"
#include "core/units.h"
#include "fit/wheel/surface.h"
#include "record/csv/series.h"
#include "record/files.h"
#include "reports/data/wheel.h"

namespace rondure::app {
namespace {

constexpr std::size_t kMostEvenTerms = 10;

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t comma = text.find(',');
    out.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return out;
    text.remove_prefix(comma + 1);
  }
}

core::Result<double> number(std::string_view text, std::string_view of) {
  if (const auto value = core::parse_number(text)) return *value;
  return core::fail(
      core::Code::kBadOption,
      fmt::format("--surface: {} is \"{}\"; a number such as 12.5 is expected", of, text));
}

core::Result<fit::WheelSurface> read_polynomial(std::string_view words) {
  fit::Polynomial out;
  for (const std::string_view word : split(words)) {
    const auto value = number(word, fmt::format("a{}", out.coefficients.size()));
    if (!value) return core::fail(value.error());
    out.coefficients.push_back(*value);
  }
  return fit::WheelSurface::polynomial(std::move(out));
}

/// 0 for A2, 1 for A4, ...; nothing for another name.
std::optional<std::size_t> even_term(std::string_view name) {
  for (std::size_t i = 0; i < kMostEvenTerms; ++i) {
    if (name == fmt::format("A{}", 2 * (i + 1))) return i;
  }
  return std::nullopt;
}

core::Result<void> set_term(std::string_view name, double value, fit::Asphere& out) {
  if (name == "R" && value != 0.0) {
    out.curvature_per_mm = 1.0 / value;
  } else if (name == "c") {
    out.curvature_per_mm = value;
  } else if (name == "K") {
    out.conic = value;
  } else if (const auto term = even_term(name)) {
    out.even_terms.resize(std::max(out.even_terms.size(), *term + 1));
    out.even_terms[*term] = value;
  } else {
    return core::fail(core::Code::kBadOption,
                      fmt::format("--surface: an asphere has R (not 0) or c, K, A2, A4, ... A{}; "
                                  "there is \"{}={}\"",
                                  2 * kMostEvenTerms, name, core::shortest(value)));
  }
  return {};
}

core::Result<fit::WheelSurface> read_asphere(std::string_view words) {
  fit::Asphere out;
  for (const std::string_view word : split(words)) {
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) {
      return core::fail(
          core::Code::kBadOption,
          fmt::format("--surface: \"{}\" has no =; write asphere:R=120,K=-1,A4=2e-8", word));
    }
    const auto value = number(word.substr(equals + 1), word.substr(0, equals));
    if (!value) return core::fail(value.error());
    if (auto set = set_term(word.substr(0, equals), *value, out); !set) {
      return core::fail(set.error());
    }
  }
  return fit::WheelSurface::asphere(std::move(out));
}

core::Result<record::Series> read_table(const std::string& file,
                                        const std::array<record::WantedColumn, 2>& columns) {
  const auto bytes = record::read_file(file);
  if (!bytes) return core::fail(bytes.error());
  return record::parse_series_csv(*bytes, std::filesystem::path(file).filename().string(), columns);
}

core::Error in_file(const core::Error& error, const std::string& file) {
  return error.at(std::filesystem::path(file).filename().string());
}

/// Parses a surface from one word of the command line:
///   polynomial:a0,a1,a2,...          z = a0 + a1 x + a2 x^2 + ... [mm^(1-j)]
///   asphere:R=120,K=-1,A4=2e-8,...   vertex radius [mm] (or c=1/mm), conic, even terms A2 to A20
///   table:FILE.csv                   columns x,z (mm)
/// @return kBadOption with the word; the errors of the file and of WheelSurface.
core::Result<fit::WheelSurface> read_surface(const std::string& word) {
  const std::string_view text = word;
  const std::size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  if (kind == "polynomial") return read_polynomial(rest);
  if (kind == "asphere") return read_asphere(rest);
  if (kind != "table") {
    return core::fail(core::Code::kBadOption,
                      fmt::format("--surface is \"{}\"; polynomial:a0,a1,..., asphere:R=..,K=..,"
                                  "A4=.. or table:FILE.csv are known",
                                  word));
  }
  const std::string file(rest);
  const auto table = read_table(file, {{{"x"}, {"z"}}});
  if (!table) return core::fail(table.error());
  auto surface = fit::WheelSurface::table(*table->column("x"), *table->column("z"));
  if (!surface) return core::fail(in_file(surface.error(), file));
  return surface;
}

/// The surface minus the removal in a file with the columns x,depth_um (mm, um).
core::Result<fit::WheelSurface> take_removal(const fit::WheelSurface& surface,
                                             const std::string& file) {
  const auto table = read_table(file, {{{"x"}, {"depth_um"}}});
  if (!table) return core::fail(table.error());
  std::vector<double> depth = *table->column("depth_um");
  for (double& d : depth) d *= core::kMicrometre;
  auto out = surface.less(*table->column("x"), std::move(depth));
  if (!out) return core::fail(in_file(out.error(), file));
  return out;
}

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

using Center = record::WheelTask::Center;
using Quadruples = record::WheelTask::Quadruples;

fit::WheelOptions measuring_options(const WheelArguments& a) {
  fit::WheelOptions out;
  out.mode = a.mode == record::WheelTask::Mode::kEnvelope ? fit::WheelMode::kEnvelope
                                                          : fit::WheelMode::kIndexed;
  if (a.center == Center::kAsPublished) out.mean = fit::WheelMean::kAsPublished;
  if (a.center == Center::kWeighted) out.mean = fit::WheelMean::kWeighted;
  if (a.quadruples == Quadruples::kBest) out.quadruples.choice = fit::QuadrupleChoice::kBest;
  if (a.quadruples == Quadruples::kRandom) out.quadruples.choice = fit::QuadrupleChoice::kRandom;
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
  if (a.center == Center::kLeastSquares && a.quadruples != Quadruples::kAll) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("--quadruples {} has no effect on a least-squares centre; add "
                                  "--center as-published or weighted",
                                  name_of(a.quadruples)));
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
  if (a.radius == record::GroundSurfaceTask::Radius::kEffective)
    path.radius = fit::RadiusChoice::kEffective;
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
