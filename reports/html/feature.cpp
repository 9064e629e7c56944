#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "evaluation/part/place.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/measured_cloud.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::f_um;
using core::fixed;
using core::signed_um;
using core::tiny_um;
using core::um;

/// Empty for a reference that does not exist: a warning gives the reason.
std::string one_sided_entry(const evaluation::FeatureResult& feature, record::Reference reference) {
  const auto found = one_sided_of(feature, reference);
  if (!found) return {};
  const record::Shape shape = feature.feature.shape;
  const fit::Certificate& certificate = found->certificate;
  std::string note =
      trf("as read; radius {} mm, {}, certificate {}", fixed(found->radius_mm, 4),
          count(found->contacts.size(), "contact", "contacts"), tr(fit::name_of(certificate.kind)));
  if (!certificate.reason.empty()) note += tr("; ") + in_sentence(certificate.reason);
  return entry(fmt::format("{} ({})", capitalised(tr(evaluation::words_of(reference, shape))),
                           evaluation::reference_of(reference, shape)),
               with_note(um(found->deviation_mm) + " µm", note));
}

std::string zone_entries(const evaluation::FeatureResult& feature, const evaluation::Zone& zone) {
  const bool cylinder = feature.feature.shape == record::Shape::kCylinder;
  const std::string kind =
      zone.of_surface
          ? trf("of the surface, tip radius {} mm {}", fixed(*feature.tip_radius_mm, 4),
                feature.feature.side == record::Side::kOutside ? tr("subtracted") : tr("added"))
          : tr("of the points as given; the tip radius is unknown");
  std::string html =
      entry(cylinder ? tr("Minimum zone CYLt (MZCY)") : tr("Minimum zone RONt (MZCI)"),
            with_note(um(zone.deviation_mm) + " µm", trf("as read; {} outer and {} inner contacts",
                                                         zone.outer.size(), zone.inner.size())));
  if (const auto ls = least_squares_of(feature)) {
    html += entry(
        cylinder ? tr("Least squares (LSCY)") : tr("Least squares (LSCI)"),
        with_note(um(ls->deviation_mm) + " µm", trf("as read; radius {} mm, rms {} µm",
                                                    fixed(ls->radius_mm, 4), um(ls->rms_mm))));
  }
  html += one_sided_entry(feature, record::Reference::kMinimumCircumscribed) +
          one_sided_entry(feature, record::Reference::kMaximumInscribed);
  html += entry(tr("Inner radius of the zone"),
                with_note(fixed(zone.inner_radius_mm, 4) + " mm", kind));
  html += entry(tr("Outer radius of the zone"),
                with_note(fixed(zone.outer_radius_mm, 4) + " mm", kind));
  return html;
}

std::string certificate_entry(const evaluation::Zone& zone) {
  const fit::Certificate& certificate = zone.certificate;
  std::string note;
  if (certificate.kind != fit::Certificate::Kind::kNone) {
    note = trf("Zone minus proven lower bound: {} µm.", tiny_um(certificate.gap_mm));
  }
  if (!certificate.reason.empty())
    note += trf(" Why not more: {}", in_sentence(certificate.reason));
  return entry(tr("Certificate of the minimum zone"),
               with_note(in_sentence(sentence_of(certificate)), note), "wide-key");
}

std::string axis_entry(const evaluation::FeatureResult& feature) {
  if (feature.mz_cylinder) {
    const fit::Axis& axis = feature.mz_cylinder->axis;
    const Eigen::Vector3d& d = axis.direction;
    const double tilt = std::atan2(std::hypot(d.x(), d.y()), std::abs(d.z()));
    return entry(
        feature.merged ? tr("Axis of the zone (body frame)")
                       : tr("Axis of the zone (machine frame)"),
        trf("through ({}, {}, {}) mm, direction ({}, {}, {}), {}° off machine z",
            fixed(axis.point_mm.x(), 6), fixed(axis.point_mm.y(), 6), fixed(axis.point_mm.z(), 6),
            fixed(d.x(), 8), fixed(d.y(), 8), fixed(d.z(), 8), deg(tilt, 6)),
        "wide-key");
  }
  if (feature.layers.empty() || !feature.layers.front().mz) return {};
  const Eigen::Vector2d& center = feature.layers.front().mz->center_mm;
  return entry(tr("Centre of the zone"),
               fmt::format("({}, {}) mm", fixed(center.x(), 6), fixed(center.y(), 6)), "wide-key");
}

/// The zone of a plane, a cone or a sphere.
std::optional<evaluation::Zone> form_zone(const evaluation::FeatureResult& feature) {
  evaluation::Zone zone;
  if (feature.mz_plane) {
    zone.deviation_mm = feature.mz_plane->width_mm;
    zone.outer = feature.mz_plane->top;
    zone.inner = feature.mz_plane->bottom;
    zone.certificate = feature.mz_plane->certificate;
  } else if (feature.mz_cone) {
    zone.deviation_mm = feature.mz_cone->width_mm;
    zone.outer = feature.mz_cone->outer;
    zone.inner = feature.mz_cone->inner;
    zone.certificate = feature.mz_cone->certificate;
  } else if (feature.mz_sphere) {
    zone.deviation_mm = feature.mz_sphere->width_mm();
    zone.outer = feature.mz_sphere->outer;
    zone.inner = feature.mz_sphere->inner;
    zone.certificate = feature.mz_sphere->certificate;
  } else {
    return {};
  }
  return zone;
}

std::string vector_words(const Eigen::Vector3d& v, int decimals) {
  return fmt::format("({}, {}, {})", fixed(v.x(), decimals), fixed(v.y(), decimals),
                     fixed(v.z(), decimals));
}

/// Form, certificate and place of a plane, a cone or a sphere.
std::string form_entries(const evaluation::FeatureResult& feature, const evaluation::Zone& zone) {
  const bool plane = feature.mz_plane.has_value();
  std::string html =
      entry(plane ? tr("Minimum zone FLTt (MZPL)") : tr("Form deviation, minimum zone"),
            with_note(um(zone.deviation_mm) + " µm", trf("as read; {} outer and {} inner contacts",
                                                         zone.outer.size(), zone.inner.size())));
  const auto least_squares = [&](double deviation_mm, double rms_mm) {
    html += entry(plane ? tr("Least squares (LSPL)") : tr("Form deviation, least squares"),
                  with_note(um(deviation_mm) + " µm", trf("as read; rms {} µm", um(rms_mm))));
  };
  std::string place;
  if (feature.ls_plane) {
    least_squares(feature.ls_plane->deviation_mm, feature.ls_plane->rms_mm);
    place = trf("through {} mm, normal {}", vector_words(feature.ls_plane->plane.point_mm, 6),
                vector_words(feature.ls_plane->plane.normal, 8));
  } else if (feature.ls_cone) {
    const fit::Cone& cone = feature.ls_cone->cone;
    least_squares(feature.ls_cone->deviation_mm, feature.ls_cone->rms_mm);
    html += entry(tr("Full angle of the cone"), core::deg(std::abs(cone.full_angle_rad), 5) + "°");
    place = trf("through {} mm, direction {}", vector_words(cone.axis.point_mm, 6),
                vector_words(cone.axis.direction, 8));
  } else if (feature.ls_sphere) {
    const double radius_mm = feature.ls_sphere->radius_mm + evaluation::surface_offset_mm(feature);
    least_squares(feature.ls_sphere->deviation_mm, feature.ls_sphere->rms_mm);
    html += entry(tr("Radius of the least-squares sphere"),
                  with_note(fixed(radius_mm, 4) + " mm",
                            feature.tip_radius_mm ? tr("of the surface")
                                                  : tr("of the points as given; the tip radius is "
                                                       "unknown")));
    place = vector_words(feature.ls_sphere->center_mm, 6) + " mm";
  }
  html += certificate_entry(zone);
  return html + entry(tr("Place of the least-squares feature (machine frame)"), place, "wide-key");
}

std::string pose_entries(const evaluation::FeatureResult& feature) {
  std::string html;
  if (const evaluation::PoseValue* pose = final_pose_of(feature)) {
    const std::string angles =
        fmt::format("alpha {}°, beta {}°", deg(pose->pose.alpha_rad), deg(pose->pose.beta_rad));
    html += entry(tr("f of the final pose"),
                  pose->valid ? with_note(f_um(pose->f_mm) + " µm", angles)
                              : with_note(tr("none"), worded(core::Phrase(pose->ending))));
  }
  if (feature.levelling_pose) {
    html += entry(tr("Levelling pose"),
                  with_note(fmt::format("{}°, {}°", deg(feature.levelling_pose->alpha_rad, 6),
                                        deg(feature.levelling_pose->beta_rad, 6)),
                            tr("alpha and beta that would turn the axis found to machine z")));
  }
  return html;
}

/// The worst filtered section of dense layers, and the largest undulation of all.
std::string dense_entry(const evaluation::FeatureResult& feature) {
  double total_mm = -1.0;
  fit::Harmonic largest;
  for (const evaluation::LayerResult& layer : feature.layers) {
    if (!layer.filtered || layer.filtered->values.empty()) continue;
    total_mm = std::max(total_mm, layer.filtered->values.back().total_mm);
    for (const fit::Harmonic& harmonic : layer.filtered->harmonics.harmonics) {
      if (harmonic.number > 1 && harmonic.amplitude_mm > largest.amplitude_mm) largest = harmonic;
    }
  }
  if (total_mm < 0.0) return {};
  return entry(tr("Sections through a Gaussian filter, 50 UPR"),
               with_note(trf("{} µm, the worst (MZ)", um(total_mm)),
                         trf("largest undulation {} UPR, amplitude {} µm", largest.number,
                             um(largest.amplitude_mm))));
}

std::string data_entries(const evaluation::FeatureResult& feature) {
  std::string html;
  if (feature.repeat_sigma_mm) {
    html += entry(tr("Repeatability of one touch"),
                  with_note(um(*feature.repeat_sigma_mm) + " µm", tr("pooled standard deviation")));
  }
  if (feature.repeat_zone_mean_mm) {
    html += entry(tr("Zones of the single repeats"),
                  with_note(trf("{} µm mean", um(*feature.repeat_zone_mean_mm)),
                            feature.repeat_zone_sd_mm
                                ? trf("{} µm standard deviation", um(*feature.repeat_zone_sd_mm))
                                : std::string()));
  }
  html += dense_entry(feature);
  if (feature.thermal) {
    html += entry(tr("Brought to 20 °C"),
                  with_note(trf("{} µm a metre", fixed(1e6 * (feature.thermal->factor - 1.0), 2)),
                            trf("U = {} µm a metre (k = 2); part {} °C, scales {} °C",
                                fixed(2e6 * feature.thermal->factor_uncertainty, 2),
                                fixed(feature.thermal->part_degC, 2),
                                fixed(feature.thermal->scale_degC, 2))));
  }
  return html;
}

/// Empty for no text.
std::string truth_box(const std::string& text) {
  if (text.empty()) return {};
  return fmt::format(R"(<div class="truth"><b>{}</b> {}{}</div>)",
                     tr("Hidden truth of the simulation:"), text,
                     tr(". This is not part of the measurement: evaluation never reads it."));
}

/// "µm", "µrad", "mm".
std::string symbol_of(core::ValueUnit unit) {
  std::string out(core::name_of(unit));
  if (out.starts_with('u')) out.replace(0, 1, "µ");
  return out;
}

/// What the judged values are without errors of measurement; empty where that is not known.
std::string truth_table(const evaluation::FeatureResult& feature) {
  TableRows rows;
  for (const HeldAgainstTruth& one : held_against_truth(feature)) {
    const auto over_u = one.difference_over_u();
    rows.push_back({isolated(one.name), symbol_of(one.found.unit()),
                    one.found.in_digits(one.found_mm()), one.found.in_digits(one.truth_mm),
                    fmt::format("{} {}", signed_um(one.difference_mm()),
                                symbol_of(core::unit_of_difference(one.found.unit()))),
                    over_u ? fixed(*over_u, 1) : "–"});
  }
  if (rows.empty()) return {};
  return fmt::format("<h3>{}</h3>", tr("Held against the truth of the simulation")) +
         note(tr("The truth is what the same touches or readings give without errors of machine, "
                 "probe, fixture and temperature. No verdict uses it.")) +
         scrolling(table("", "llrrrr",
                         spoken_caption(tr("Held against the truth of the simulation")),
                         {tr("Call-out"), tr("unit"), tr("found"), tr("truth"), tr("difference"),
                          tr("difference over u")},
                         rows));
}

/// Hidden truth of an analysis: the numbers from which its series were simulated.
std::string truth_text(const record::RunRecord& record, std::size_t index) {
  std::string text;
  for (const record::TruthValue& truth : record.truth_values) {
    if (static_cast<std::size_t>(truth.feature) != index) continue;
    text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ",
                        plain_words(core::Phrase(truth.name)), truth.value);
  }
  return text;
}

std::string key_numbers(const evaluation::FeatureResult& feature,
                        const std::optional<evaluation::Zone>& zone) {
  std::string html = R"(<dl class="keys">)";
  const auto form = form_zone(feature);
  if (zone) html += zone_entries(feature, *zone);
  if (form) html += form_entries(feature, *form);
  html += pose_entries(feature) + data_entries(feature);
  if (zone) html += certificate_entry(*zone) + axis_entry(feature);
  return html + "</dl>";
}

/// A kind of file for a machine in words.
std::string kind_in_words(const std::string& kind) {
  static const std::map<std::string, const char*> words = {
      {"x-of-c", translatable("X over C")},
      {"axis-table", translatable("errors over the angle")},
      {"spindle-table", translatable("form and motion over the angle")},
      {"wheel-path", translatable("path of the wheel")},
      {"program", translatable("program of the path")},
      {"fixture-calibration", translatable("calibration of the fixture")}};
  return tr(words.at(kind));
}

/// The files for machines by name, or why there is no table. It holds whichever formats are
/// written: a page does not know them.
std::string corrections_note(const FeatureCorrections& corrections) {
  std::string html;
  for (const CorrectionFile& one : corrections.files) {
    const auto mono = [](const std::string& text) {
      return fmt::format(R"(<span class="mono">{}</span>)", escaped(text));
    };
    html += note(trf("Correction: {} ({}), written by {}.", mono(one.file), kind_in_words(one.kind),
                     mono(fmt::format("--format {}", record::name_of(one.format)))));
  }
  if (!corrections.none_because.empty())
    html += note(trf("No correction for a machine: {}.", in_sentence(corrections.none_because)));
  return html;
}

/// Section of an analysed feature.
std::string analysis_section(const record::RunRecord& record, std::size_t index,
                             const evaluation::FeatureResult& feature, bool detail,
                             const FeatureCorrections& corrections) {
  const record::Feature& asked = feature.feature;
  std::string html = fmt::format(
      R"(<section><h2>{}</h2><p class="note">{}</p>)", feature_title(asked),
      trf("{}.", asked.shape == record::Shape::kRotaryAxes
                     ? tr("Calibration of the fixture with balls that it carried")
                     : trf("{}; data {}",
                           asked.shape == record::Shape::kFiveAxis
                               ? tr("Axes C and A of a head")
                               : capitalised(tr(record::name_of(asked.shape))),
                           asked.points_file.empty()
                               ? tr("simulated")
                               : trf("from the file {}", isolated(asked.points_file)))));
  html += messages(feature) + callouts_section(feature, record, true);
  std::string drawings;
  if (feature.analysis) {
    const auto number = static_cast<int>(index);
    const auto write = [&]<class Found>(const Found& found) {
      const Found* const exact =
          feature.exact ? std::get_if<Found>(&feature.exact->found) : nullptr;
      if constexpr (requires { analysis_part(found, record, number, exact); }) {
        return analysis_part(found, record, number, exact);
      } else {
        return analysis_part(found, record, number);
      }
    };
    drawings = std::visit(write, feature.analysis->found);
  }
  const bool passed = std::ranges::all_of(feature.gates, [](const evaluation::Gate& gate) {
    return gate.outcome == evaluation::Gate::Outcome::kPassed;
  });
  // Beside other features, one of which nothing has to be looked at takes no pages of its own.
  const auto conforms = [](const evaluation::CharacteristicResult& result) {
    return result.verdict == evaluation::Verdict::kConforms;
  };
  const bool quiet = record.features.size() > 1 && passed && !feature.characteristics.empty() &&
                     std::ranges::all_of(feature.characteristics, conforms);
  const std::string gates = gates_section(feature);
  return html + (quiet ? std::string() : drawings) + (passed ? std::string() : gates) +
         truth_box(truth_text(record, index)) + truth_table(feature) +
         corrections_note(corrections) +
         folded(quiet ? tr("Drawings, call-outs that conform, conditions")
                      : tr("Call-outs that conform, conditions"),
                callouts_section(feature, record, false) + (quiet ? drawings : std::string()) +
                    (passed ? gates : std::string()),
                detail) +
         "</section>";
}

}  // namespace

std::string feature_title(const record::Feature& feature) {
  const std::string name = isolated(feature.id);
  switch (feature.shape) {
    case record::Shape::kSpindle:
      return trf("Spindle {}: form of the part and motion of the axis", name);
    case record::Shape::kWheel:
      return trf("Grinding wheel {}: radius, run-out and edge", name);
    case record::Shape::kContour:
      return trf("Crank pin {}: contour error and how much of it follows the axes", name);
    case record::Shape::kRotaryAxes:
      return trf("Fixture {}: errors of its axes and what is left of them", name);
    case record::Shape::kFiveAxis:
      return trf("Head {}: errors of its axes and what is left of them", name);
    default:
      return trf("Feature {}", name);
  }
}

std::string with_note(const std::string& value, const std::string& note) {
  return note.empty() ? value : value + "<small>" + note + "</small>";
}

std::string as_read_note() {
  return note(
      tr("Numbers without an interval beside them are as read. Those that the plan asks for stand "
         "above, with their interval where influences are declared."));
}

std::string messages(const evaluation::FeatureResult& feature) {
  std::string html;
  if (feature.failure) {
    html += fmt::format(
        R"(<div class="banner alarm"><b>{}</b> {}{} <span class="code">{}</span></div>)",
        tr("No result."), titled(feature.failure->code), foreign(feature.failure->what),
        core::code_name(feature.failure->code));
  }
  if (feature.warnings.empty()) return html;
  html += R"(<ul class="warnings">)";
  for (const core::Error& warning : feature.warnings) {
    html += fmt::format(
        R"(<li><b>{}</b> {}{} <span class="code">{}</span>{}</li>)", tr("Warning:"),
        titled(warning.code), in_sentence(warning.said()), core::code_name(warning.code),
        warning.where.empty() ? std::string() : fmt::format(" {}", foreign(warning.where)));
  }
  return html + "</ul>";
}

std::optional<evaluation::Zone> zone_to_draw(const evaluation::FeatureResult& feature) {
  const auto zone = zone_of(feature);
  return zone || feature.mz_plane ? zone : form_zone(feature);
}

DrawnFeature drawn_of(const evaluation::FeatureResult& all, std::optional<std::size_t> worst) {
  DrawnFeature out{all, {}, {}};
  evaluation::FeatureResult& feature = out.feature;
  const record::Shape shape = all.feature.shape;
  if (shape == record::Shape::kCylinder || shape == record::Shape::kCone) {
    const auto places = evaluation::places_on_part(all);
    out.places.part_z = !places.empty() && places.front().z_mm;
    for (std::size_t row = 0; out.places.part_z && row < places.size(); ++row)
      feature.cloud[row].height_mm = *places[row].z_mm;
    for (evaluation::LayerResult& layer : feature.layers) {
      if (!out.places.part_z || layer.rows.empty()) continue;
      layer.height_mm = 0.0;
      for (const std::size_t row : layer.rows)
        layer.height_mm += feature.cloud[row].height_mm / static_cast<double>(layer.rows.size());
    }
  }
  if (worst && *worst < all.cloud.size() && !all.cloud[*worst].left_out) {
    const auto end = all.cloud.begin() + static_cast<std::ptrdiff_t>(*worst);
    out.places.worst = static_cast<std::size_t>(
        std::count_if(all.cloud.begin(), end, [](const auto& point) { return !point.left_out; }));
  }
  if (auto outside = evaluation::outside_windows(feature)) feature = *std::move(outside);
  out.zone = zone_to_draw(feature);
  return out;
}

std::string feature_section(const record::RunRecord& record, std::size_t index,
                            const evaluation::FeatureResult& all, bool detail, bool drawn_above,
                            const FeatureCorrections& corrections) {
  if (record::is_analysis(all.feature.shape))
    return analysis_section(record, index, all, detail, corrections);
  const auto outside = evaluation::outside_windows(all);
  const evaluation::FeatureResult& feature = outside ? *outside : all;
  const auto zone = zone_of(feature);
  const record::Feature& asked = feature.feature;
  std::string nominal;
  if (asked.nominal_diameter_mm > 0.0) {
    nominal = trf(", nominal diameter {:.10g} mm", asked.nominal_diameter_mm);
  }
  const std::string origin = asked.strategy == record::Strategy::kPointsFile
                                 ? tr("points from a file")
                             : evaluation::stands_still(asked)
                                 ? tr("touched where it stands, without a fixture")
                                 : trf("pose search: {}", tr(record::name_of(asked.strategy)));
  std::string html =
      fmt::format(R"(<section><h2>{}</h2><p class="note">{}</p>)", feature_title(asked),
                  asked.shape == record::Shape::kPlane
                      ? trf("{}; {}.", capitalised(tr(record::name_of(asked.shape))), origin)
                      : trf("{} {}{}; {}.", capitalised(tr(record::name_of(asked.side))),
                            tr(record::name_of(asked.shape)), nominal, origin));
  html += messages(feature) + callouts_section(feature, record, true);
  if (outside) {
    html += note(trf("{} of {} points lie in windows and take no part in what follows.",
                     all.cloud.size() - feature.cloud.size(), all.cloud.size()));
  }
  const DrawnFeature drawn = drawn_of(all);
  const bool one_section = asked.shape == record::Shape::kCircle || feature.layers.size() == 1;
  if (zone && !(drawn_above && one_section))
    html += polar_plots(drawn.feature, *zone, &all, drawn.places);
  if (feature.mz_plane && !drawn_above) html += face_map(feature);
  if (drawn.zone && !drawn_above) html += deviation_map(drawn.feature, *drawn.zone, drawn.places);
  if (zone) html += fmt::format(R"(<div class="screen-only">{}</div>)", solid_view(feature, *zone));
  if (feature.merged) html += merged_section(*feature.merged);
  std::string more = key_numbers(feature, zone) + truth_table(all) +
                     callouts_section(feature, record, false) + gates_section(feature) +
                     harmonics_section(feature);
  if (!feature.merged && !feature.poses.empty()) {
    more += fmt::format("<h3>{}</h3>", tr("Search for the pose")) +
            note(tr("f is the narrowest zone whose axis is held parallel to machine z, so it holds "
                    "the form of the part and its remaining tilt; the minimum zone above is free "
                    "of the tilt.")) +
            pose_plots(feature, zone) + pose_table(feature);
  }
  return html + folded(tr("Numbers, call-outs that conform, search"), more, detail) + "</section>";
}

}  // namespace rondure::reports
