#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/contour_files.h"
#include "app/verbs/verbs.h"
#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/contour/result.h"
#include "fit/contour/study.h"
#include "record/files.h"
#include "reports/data/contour.h"

namespace rondure::app {
namespace {

double um2(double mm2) { return mm2 / (core::kMicrometre * core::kMicrometre); }

std::string head(const fit::ContourStudy& study, const fit::ContourStudyOptions& options) {
  const fit::CrankGeometry& g = options.geometry;
  std::string out = fmt::format(
      "crank pins, {} part{}, method {}\n  crank radius {} mm, wheel radius {} mm, pin radius {} "
      "mm\n",
      study.parts.size(), study.parts.size() == 1 ? "" : "s", fit::name_of(options.method),
      g.crank_radius_mm, g.wheel_radius_mm, g.pin_radius_mm);
  if (options.error.filter.filter != fit::ProfileFilter::kNone) {
    out += fmt::format("  {} low pass, {} UPR, {} points{}\n",
                       fit::name_of(options.error.filter.filter), options.error.filter.cutoff_upr,
                       options.samples, options.prefiltered ? "; the gauge has filtered" : "");
  }
  return out;
}

std::string part_lines(const fit::ContourPartResult& part, const std::string& name) {
  const auto line = [](const char* what, const std::vector<double>& curve) {
    return fmt::format("    {:<26} PV {:9.4f} um   RMS {:8.4f} um\n", what,
                       core::micrometres(fit::peak_to_valley(curve)),
                       core::micrometres(core::root_mean_square(curve)));
  };
  std::string out = fmt::format("  part {}\n", name);
  out += line("t, total", part.pin.contour.error_mm);
  out += line(part.traced ? "f, following the axes" : "f, t less the main journal",
              part.following.error_mm);
  if (part.traced && part.axes.x_mm.empty()) {
    out.insert(out.size() - 1, "   stroke-unchecked: no positions of X");
  }
  out += line(part.traced ? "n, not following" : "n, the main journal", part.direct.rest_mm);
  if (part.traced && part.main) out += line("main journal", part.main->contour.error_mm);
  const fit::ContourSeparation& d = part.direct;
  out += fmt::format("    balance um^2: {:.4f} = {:.4f} + {:.4f} {} {:.4f}; n {} the total\n",
                     um2(d.total_mm2), um2(d.following_mm2), um2(d.rest_mm2),
                     d.cross_mm2 < 0.0 ? '-' : '+', std::abs(um2(d.cross_mm2)),
                     d.enlarges() ? "enlarges" : "reduces");
  if (part.indirect) {
    out += fmt::format("    indirect: correlation with f {:.4f}, rms difference {:.4f} um\n",
                       part.indirect->correlation,
                       core::micrometres(part.indirect->rms_difference_mm));
  }
  if (!part.traced) return out;
  return out + fmt::format("    {:.1f} samples a turn; correlation would turn f by {:.2f} deg\n",
                           part.axes.samples_per_turn, core::degrees(part.offset.angle_rad));
}

std::string stability_line(const char* what, const std::optional<fit::Repeatability>& found,
                           double scale) {
  if (!found) return {};
  const auto word = found->word();
  return fmt::format("    {:<14} {:>8} {:10.4f} {:10.4f} {:10.4f} {:10.4f}  {}\n", what,
                     found->index ? fmt::format("{:.4f}", *found->index) : "-",
                     found->mean_rms * scale, found->spread * scale, found->mean_correlation,
                     found->variation, word ? fit::name_of(*word) : "");
}

std::string stability_table(const fit::ContourStudy& study) {
  if (!study.total) return {};
  const double to_um = 1.0 / core::kMicrometre;
  return "  stability over the parts\n"
         "                          S   mean rms     spread  mean corr.  PV c.v.\n" +
         stability_line("t [um]", study.total, to_um) +
         stability_line("f [um]", study.following, to_um) +
         stability_line("n [um]", study.rest, to_um) +
         stability_line("mains [um]", study.main, to_um) +
         stability_line("error C [mdeg]", study.c_error, 1e3 / core::kDegree) +
         stability_line("error X [um]", study.x_error, to_um) +
         fmt::format("    rms(f) / rms(n) = {:.4f}\n", study.amplitude_ratio);
}

nlohmann::ordered_json contour_json(const fit::ContourStudy& study,
                                    const fit::ContourStudyOptions& options,
                                    std::span<const std::string> names) {
  nlohmann::ordered_json out = {{"shape", "contour"}};
  out.update(reports::contour_document(study, options, names));
  add_no_interval(out, "contour");
  return out;
}

std::string contour_table(const fit::ContourStudy& study, const fit::ContourStudyOptions& options,
                          std::span<const std::string> names) {
  std::string out = head(study, options);
  for (std::size_t i = 0; i < study.parts.size(); ++i) out += part_lines(study.parts[i], names[i]);
  out += stability_table(study);
  for (const core::Phrase& verdict : reports::contour_verdicts(study)) {
    out += fmt::format("  {}\n", verdict.english());
  }
  for (const core::Error& w : study.warnings) {
    out += fmt::format("  warning: {}{}{} [{}]\n", w.where, w.where.empty() ? "" : ": ", w.what,
                       core::code_name(w.code));
  }
  return out + no_interval_text("contour");
}

fit::ContourStudyOptions options_of(const ContourArguments& arguments) {
  record::ContourTask task = arguments.task;
  task.main_phase_offset_deg = arguments.main_phase_offset_deg.value_or(task.phase_offset_deg);
  return evaluation::contour_options(task);
}

core::Result<std::vector<record::ContourColumnTask>> mapping_of(const ContourArguments& arguments) {
  std::vector<record::ContourColumnTask> out;
  if (!arguments.mapping.empty()) {
    auto read = read_contour_mapping(arguments.mapping);
    if (!read) return read;
    out = *std::move(read);
  }
  for (const std::string& text : arguments.columns) {  // follow the files: the last one counts
    TRY(auto column, parse_contour_column(text));
    out.push_back(std::move(column));
  }
  return out;
}

core::Result<void> check_counts(const ContourArguments& arguments) {
  const std::size_t parts = arguments.pin.size();
  const auto fits = [&](const std::vector<std::string>& files) {
    return files.empty() || files.size() == parts;
  };
  const bool enough = !arguments.axes.empty() || !arguments.main.empty();
  if (enough && fits(arguments.axes) && fits(arguments.main)) return {};
  return core::fail_with(core::Code::kBadOption,
                         "{} files for --axes, {} for --pin and {} for --main; one of each a part; "
                         "--main may be left out, or --axes, not both",
                         arguments.axes.size(), parts, arguments.main.size());
}

/// The file of a part; empty: not given.
std::string file_of(const std::vector<std::string>& files, std::size_t part) {
  return files.empty() ? std::string() : files[part];
}

/// All parts of the command line.
struct Parts {
  std::vector<fit::ContourPart> parts;
  std::vector<std::string> names;
  bool positions = false;
};

core::Result<Parts> read_parts(const ContourArguments& arguments) {
  TRY_DO(check_counts(arguments));
  TRY(const auto mapping, mapping_of(arguments));
  Parts out;
  for (std::size_t i = 0; i < arguments.pin.size(); ++i) {
    const ContourFiles files = {file_of(arguments.axes, i), arguments.pin[i],
                                file_of(arguments.main, i)};
    TRY(auto part, read_contour_part(files, mapping));
    out.positions = out.positions || part.positions;
    out.parts.push_back(std::move(part.part));
    out.names.push_back(std::filesystem::path(files.pin).stem().string());
  }
  return out;
}

/// "parts/0/pin" with its file.
core::Error named(const core::Error& error, const ContourArguments& arguments) {
  for (std::size_t i = 0; i < arguments.pin.size(); ++i) {
    const auto place = [&](const char* what) { return fmt::format("parts/{}/{}", i, what); };
    if (error.where == place("axes")) return error.at(arguments.axes[i]);
    if (error.where == place("pin")) return error.at(arguments.pin[i]);
    if (error.where == place("main")) return error.at(arguments.main[i]);
  }
  return error;
}

}  // namespace

int contour(const ContourArguments& arguments) {
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
