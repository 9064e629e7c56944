#include "evaluation/defect.h"

#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/version.h"
#include "record/files.h"

namespace rondure::evaluation {
namespace {

using core::printable;

/// Lines of "name = value", numbers with 17 digits.
class Lines {
 public:
  void title(const std::string& text) { out_ += "\n[" + text + "]\n"; }
  void text(const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(out_), "{} = {}\n", name, printable(value));
  }
  void number(const char* name, double value) {
    fmt::format_to(std::back_inserter(out_), "{} = {:.17g}\n", name, value);
  }
  template <int N>
  void vector(const char* name, const Eigen::Matrix<double, N, 1>& v) {
    fmt::format_to(std::back_inserter(out_), "{} =", name);
    for (const double value : v) fmt::format_to(std::back_inserter(out_), " {:.17g}", value);
    out_ += "\n";
  }
  void place(const fit::Axis& axis) {
    vector<3>("axis_point_mm", axis.point_mm);
    vector<3>("axis_direction", axis.direction);
  }
  void place(const Eigen::Vector2d& center) { vector<2>("center_mm", center); }
  void contacts(const char* name, const std::vector<fit::Contact>& contacts) {
    fmt::format_to(std::back_inserter(out_), "{} =", name);
    for (const fit::Contact& c : contacts)
      fmt::format_to(std::back_inserter(out_), " {}:{:.17g}", c.index, c.multiplier);
    out_ += "\n";
  }
  void certificate(const fit::Certificate& c) {
    text("certificate", fmt::format("{}; {}; gap {:.17g} mm; {}", fit::name_of(c.kind),
                                    c.scope.english(), c.gap_mm, c.reason.english()));
  }
  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

template <class Ls, class Place>
void add_least_squares(Lines& out, const Ls& ls, const Place& place) {
  out.place(place);
  out.number("radius_mm", ls.radius_mm);
  out.number("deviation_mm", ls.deviation_mm);
  out.number("rms_mm", ls.rms_mm);
}

template <class Zone, class Place>
void add_zone(Lines& out, const Zone& zone, const Place& place) {
  out.place(place);
  out.number("inner_radius_mm", zone.inner_radius_mm);
  out.number("outer_radius_mm", zone.outer_radius_mm);
  out.contacts("outer_contacts", zone.outer);
  out.contacts("inner_contacts", zone.inner);
  out.certificate(zone.certificate);
}

template <class OneSided, class Place>
void add_one_sided(Lines& out, const OneSided& fit, const Place& place) {
  out.place(place);
  out.number("radius_mm", fit.radius_mm);
  out.number("deviation_mm", fit.deviation_mm);
  out.contacts("contacts", fit.contacts);
  out.certificate(fit.certificate);
}

/// A section of the dump for a fit, or the reason why there is no fit.
template <class Fit, class Add>
void add_fit(Lines& out, const std::string& title, const core::Result<Fit>& fit, const Add& add) {
  out.title(title);
  if (fit) {
    add(*fit);
  } else {
    out.text("absent", core::to_line(fit.error()));
  }
}

void add_cylinder(Lines& out, const FeatureResult& result) {
  if (!result.mz_cylinder || !result.ls_cylinder) return;
  const auto one_sided = [&](const auto& fit) { add_one_sided(out, fit, fit.axis); };
  out.title("LSCY");
  add_least_squares(out, *result.ls_cylinder, result.ls_cylinder->axis);
  out.title("MZCY");
  add_zone(out, *result.mz_cylinder, result.mz_cylinder->axis);
  add_fit(out, "MCCY", result.mc_cylinder, one_sided);
  add_fit(out, "MICY", result.mi_cylinder, one_sided);
}

void add_section(Lines& out, const LayerResult& layer) {
  const auto title = [&](const char* name) {
    return fmt::format("layer {} {}", layer.layer + 1, name);
  };
  const auto one_sided = [&](const auto& fit) { add_one_sided(out, fit, fit.center_mm); };
  add_fit(out, title("LSCI"), layer.ls,
          [&](const auto& fit) { add_least_squares(out, fit, fit.center_mm); });
  add_fit(out, title("MZCI"), layer.mz,
          [&](const auto& fit) { add_zone(out, fit, fit.center_mm); });
  add_fit(out, title("MCCI"), layer.mc, one_sided);
  add_fit(out, title("MICI"), layer.mi, one_sided);
  out.title(title("points x,y mm"));
  for (std::size_t i = 0; i < layer.points_mm.size(); ++i)
    out.vector<2>(fmt::format("{}", i).c_str(), layer.points_mm[i]);
}

}  // namespace

core::Error error_of(const Defect& defect) {
  return {
      core::Code::kInternal,
      fmt::format("invariant \"{}\" does not hold for {} points: {}; this is a defect of the "
                  "program: no value is given, please report it with {} or the journal.db of "
                  "the run",
                  defect.broken.rule, defect.result.cloud.size(), defect.broken.found, kDefectFile),
      defect.result.feature.id};
}

std::string dump_of(const Defect& defect, const record::Header& header,
                    const std::string& processor) {
  const FeatureResult& result = defect.result;
  Lines out;
  out.text("rondure", "a defect of the program: attach this file to a bug report");
  out.text("version", std::string(core::kVersion));
  out.text("processor", processor);
  out.text("measured_by_version", header.version);
  out.text("measured_on_processor", header.processor);
  out.text("run", header.run_id);
  out.text("feature", result.feature.id);
  out.text("shape", std::string(record::name_of(result.feature.shape)));
  out.text("side", std::string(record::name_of(result.feature.side)));
  out.text("rule", defect.broken.rule);
  out.text("found", defect.broken.found);
  add_cylinder(out, result);
  for (const LayerResult& layer : result.layers) add_section(out, layer);
  out.title("points x,y,z mm (tip centres, machine frame)");
  for (std::size_t i = 0; i < result.cloud.size(); ++i)
    out.vector<3>(fmt::format("{}", i).c_str(), result.cloud[i].tip_mm);
  return out.take();
}

core::Result<void> keep_defects(const std::vector<Defect>& defects, const record::Header& header,
                                const std::filesystem::path& directory,
                                const std::string& processor) {
  if (defects.empty()) return {};
  std::string text;
  for (const Defect& defect : defects) text += dump_of(defect, header, processor);
  const auto file = directory / kDefectFile;
  const auto written = record::write_file(file, text);
  if (written) return {};
  const core::Error first = error_of(defects.front());
  return core::fail(core::Error{first.code,
                                fmt::format("{}; {} could not be written: {}", first.what,
                                            file.string(), written.error().what),
                                first.where});
}

}  // namespace rondure::evaluation
