#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/contour.h"
#include "app/text/terminal.h"
#include "app/verbs/contour_files.h"
#include "app/verbs/verbs.h"
#include "core/units.h"
#include "fit/contour/study.h"
#include "record/files.h"
#include "reports/data/contour.h"

namespace rondure::app {
namespace {

fit::ContourStudyOptions options_of(const ContourArguments& arguments) {
  fit::ContourStudyOptions out;
  out.geometry = {arguments.crank_radius_mm, arguments.wheel_radius_mm, arguments.pin_radius_mm};
  out.main_radius_mm = arguments.main_radius_mm;
  out.method = arguments.method == record::ContourTask::Method::kAsPublished
                   ? fit::ContourMethod::kAsPublished
                   : fit::ContourMethod::kCorrected;
  out.axes.error_sign = arguments.error_sign;
  out.axes.c_direction = arguments.c_direction;
  out.axes.samples = arguments.path_samples;
  out.samples = arguments.samples;
  out.pre_filter_upr = arguments.pre_filter_upr;
  out.error.filter.cutoff_upr = arguments.cutoff_upr;
  out.error.base = arguments.base == record::ContourTask::BaseCircle::kGeometric
                       ? fit::BaseCircle::kGeometric
                       : fit::BaseCircle::kLimacon;
  out.prefiltered = arguments.prefiltered;
  out.phase_offset_rad = arguments.phase_offset_deg * core::kDegree;
  out.main_phase_offset_rad =
      arguments.main_phase_offset_deg.value_or(arguments.phase_offset_deg) * core::kDegree;
  out.gauge_direction = arguments.gauge_direction;
  out.map_main = arguments.map_main;
  return out;
}

core::Result<std::vector<ContourColumn>> mapping_of(const ContourArguments& arguments) {
  std::vector<ContourColumn> out;
  if (!arguments.mapping.empty()) {
    auto read = read_contour_mapping(arguments.mapping);
    if (!read) return read;
    out = *std::move(read);
  }
  for (const std::string& text : arguments.columns) {  // behind the file: the last one counts
    auto column = parse_contour_column(text);
    if (!column) return core::fail(column.error());
    out.push_back(*std::move(column));
  }
  return out;
}

core::Result<void> check_counts(const ContourArguments& arguments) {
  const std::size_t parts = arguments.axes.size();
  if (arguments.pin.size() == parts && (arguments.main.empty() || arguments.main.size() == parts)) {
    return {};
  }
  return core::fail(
      core::Code::kBadOption,
      fmt::format("{} files for --axes, {} for --pin and {} for --main; one of each a "
                  "part, or no main journals",
                  parts, arguments.pin.size(), arguments.main.size()));
}

/// All parts of the command line.
struct Parts {
  std::vector<fit::ContourPart> parts;
  std::vector<std::string> names;
  bool positions = false;
};

core::Result<Parts> read_parts(const ContourArguments& arguments) {
  if (auto checked = check_counts(arguments); !checked) return core::fail(checked.error());
  const auto mapping = mapping_of(arguments);
  if (!mapping) return core::fail(mapping.error());
  Parts out;
  for (std::size_t i = 0; i < arguments.axes.size(); ++i) {
    const ContourFiles files = {arguments.axes[i], arguments.pin[i],
                                arguments.main.empty() ? std::string() : arguments.main[i]};
    auto part = read_contour_part(files, *mapping);
    if (!part) return core::fail(part.error());
    out.positions = out.positions || part->positions;
    out.parts.push_back(std::move(part->part));
    out.names.push_back(std::filesystem::path(files.pin).stem().string());
  }
  return out;
}

/// "parts/0/pin" with the file it came from.
core::Error named(const core::Error& error, const ContourArguments& arguments) {
  for (std::size_t i = 0; i < arguments.axes.size(); ++i) {
    const auto place = [&](const char* what) { return fmt::format("parts/{}/{}", i, what); };
    if (error.where == place("axes")) return error.at(arguments.axes[i]);
    if (error.where == place("pin")) return error.at(arguments.pin[i]);
    if (error.where == place("main")) return error.at(arguments.main[i]);
  }
  return error;
}

}  // namespace

int contour(const ContourArguments& arguments) {
  const auto refuse = [](const core::Error& error) {
    print_error(error);
    return kBadInput;
  };
  const auto input = read_parts(arguments);
  if (!input) return refuse(input.error());
  auto options = options_of(arguments);
  if (input->positions) options.axes.error_sign = 1;
  auto study = fit::contour_study(input->parts, options);
  if (!study) return refuse(named(study.error(), arguments));
  for (core::Error& warning : study->warnings) warning = named(warning, arguments);
  const auto found = contour_json(*study, options, input->names);
  if (const auto finite = check_finite(found); !finite) return refuse(finite.error());
  if (!arguments.curves.empty()) {
    const auto written = record::write_file(arguments.curves, reports::contour_curves_csv(*study));
    if (!written) return refuse(written.error());
  }
  return answer(found, arguments.json,
                [&] { return contour_table(*study, options, input->names); });
}

}  // namespace rondure::app
