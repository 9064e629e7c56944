#include "reports/data/analyses.h"

#include <optional>

#include <fmt/format.h>

#include "core/statistics.h"
#include "core/units.h"
#include "reports/data/internal/json_parts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

constexpr int kHighestHarmonic = 50;

double in_um2(double mm2) { return mm2 / (core::kMicrometre * core::kMicrometre); }

Json harmonics_json(const std::vector<double>& error_mm) {
  Json out = Json::array();
  for (const fit::Harmonic& h : fit::contour_harmonics(error_mm, kHighestHarmonic)) {
    out.push_back({{"upr", h.number},
                   {"amplitude_um", in_um(h.amplitude_mm)},
                   {"phase_deg", h.phase_rad ? Json(in_deg(*h.phase_rad)) : Json(nullptr)}});
  }
  return out;
}

Json contour_json(const fit::ContourError& contour) {
  return {{"pv_um", in_um(contour.peak_to_valley_mm)},
          {"rms_um", in_um(contour.rms_mm)},
          {"crest_deg", in_deg(contour.crest_rad())},
          {"valley_deg", in_deg(contour.valley_rad())},
          {"base_radius_mm", contour.base_radius_mm},
          {"base_center_mm", {contour.base_center_mm.x(), contour.base_center_mm.y()}},
          {"harmonics", harmonics_json(contour.error_mm)}};
}

Json curve_json(const std::vector<double>& error_mm) {
  return {{"pv_um", in_um(fit::peak_to_valley(error_mm))},
          {"rms_um", in_um(core::root_mean_square(error_mm))},
          {"harmonics", harmonics_json(error_mm)}};
}

Json gauge_json(const fit::MeasuredContour& measured) {
  Json out = contour_json(measured.contour);
  out["rows"] = measured.rows;
  out["largest_gap_deg"] = in_deg(measured.largest_gap_rad);
  out["seems_filtered"] = measured.filter.filtered;
  return out;
}

Json part_json(const fit::ContourPartResult& part, const std::string& name) {
  Json out = {{"name", name},
              {"axes", nullptr},
              {"regularity", nullptr},
              {"undercut", nullptr},
              {"total", gauge_json(part.pin)},
              {"following",
               part.traced ? contour_json(part.following) : curve_json(part.following.error_mm)},
              {"rest", curve_json(part.direct.rest_mm)}};
  if (part.traced) {
    out["axes"] = {{"samples_per_turn", part.axes.samples_per_turn},
                   {"turns", part.axes.turns},
                   {"stroke_checked", !part.axes.x_mm.empty()}};
    out["regularity"] = part.ground.regularity;
    out["undercut"] = part.ground.undercut;
  }
  out["main"] = part.main ? gauge_json(*part.main) : Json(nullptr);
  out["balance_um2"] = {{"total", in_um2(part.direct.total_mm2)},
                        {"following", in_um2(part.direct.following_mm2)},
                        {"rest", in_um2(part.direct.rest_mm2)},
                        {"cross", in_um2(part.direct.cross_mm2)}};
  out["rest_enlarges_total"] = part.direct.enlarges();
  out["correlation_following_rest"] = part.direct.correlation;
  out["indirect"] = nullptr;
  if (part.indirect) {
    out["indirect"] = {{"correlation_with_direct", part.indirect->correlation},
                       {"rms_difference_um", in_um(part.indirect->rms_difference_mm)}};
  }
  out["correlation_offset_deg"] = part.traced ? Json(in_deg(part.offset.angle_rad)) : Json(nullptr);
  return out;
}

/// @param scale  Factor from the unit of the curves to that of the keys.
Json repeatability_json(const std::optional<fit::Repeatability>& found, double scale,
                        const std::string& unit) {
  if (!found) return nullptr;
  const auto scaled = [&](const std::vector<double>& values) {
    return list_json(values, [&](double value) { return value * scale; });
  };
  const auto word = found->word();
  Json out = {{"index", optional_json(found->index)},
              {"word", word ? Json(fit::name_of(*word)) : Json(nullptr)},
              {"mean_rms_" + unit, found->mean_rms * scale},
              {"spread_" + unit, found->spread * scale},
              {"pv_" + unit, scaled(found->peak_to_valley)},
              {"rms_" + unit, scaled(found->rms)},
              {"pv_variation", found->variation},
              {"mean_correlation", found->mean_correlation},
              {"least_correlation", found->least_correlation}};
  Json matrix = Json::array();
  for (Eigen::Index i = 0; i < found->correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < found->correlation.cols(); ++j) {
      row.push_back(found->correlation(i, j));
    }
    matrix.push_back(std::move(row));
  }
  out["correlation"] = std::move(matrix);
  return out;
}

Json settings_json(const fit::ContourStudyOptions& options) {
  const fit::CrankGeometry& g = options.geometry;
  return {
      {"method", fit::name_of(options.method)},
      {"crank_radius_mm", g.crank_radius_mm},
      {"wheel_radius_mm", g.wheel_radius_mm},
      {"pin_radius_mm", g.pin_radius_mm},
      {"main_radius_mm", options.main_radius_mm},
      {"error_sign", options.axes.error_sign},
      {"c_direction", options.axes.c_direction},
      {"path_samples", options.axes.samples},
      {"samples", options.samples},
      {"filter", fit::name_of(options.error.filter.filter)},
      {"cutoff_upr", options.error.filter.cutoff_upr},
      {"base_circle", options.error.base == fit::BaseCircle::kLimacon ? "limacon" : "geometric"},
      {"prefiltered", options.prefiltered},
      {"phase_offset_deg", in_deg(options.phase_offset_rad)},
      {"main_phase_offset_deg", in_deg(options.main_phase_offset_rad)},
      {"gauge_direction", options.gauge_direction},
      {"stable_from", fit::kStableFrom},
      {"partly_from", fit::kPartlyFrom}};
}

}  // namespace

const char* separation_of(const fit::ContourStudy& study) {
  return study.traced() ? translatable("direct") : translatable("indirect");
}

std::vector<core::Phrase> contour_verdicts(const fit::ContourStudy& study) {
  std::vector<core::Phrase> out;
  if (study.parts.size() < 4) {
    const std::size_t parts = study.parts.size();
    out.push_back(core::phrase(
        "{}: stable and unstable sources are told apart from 4 parts on",
        parts == 1 ? core::phrase("{} part", parts) : core::phrase("{} parts", parts)));
    return out;
  }
  const auto say = [&](const core::Phrase& what, const std::optional<fit::Repeatability>& found) {
    if (!found) return;
    const auto word = found->word();
    if (word)
      out.push_back(core::phrase("{}: {} (S = {:.4f})", what, core::Phrase(fit::name_of(*word)),
                                 *found->index));
  };
  say(core::phrase("total"), study.total);
  say(core::phrase("following part"), study.following);
  say(core::phrase("non-following part"), study.rest);
  say(core::phrase("main journals"), study.main);
  say(core::phrase("axis error of C"), study.c_error);
  say(core::phrase("axis error of X"), study.x_error);
  const auto word_of = [&](const std::optional<fit::Repeatability>& found) {
    return found ? found->word() : std::nullopt;
  };
  if (word_of(study.following) == fit::StabilityWord::kStable) {
    out.push_back(
        study.amplitude_ratio >= 1.0
            ? core::phrase("the following part repeats and is the greater one: compensate it in X")
            : core::phrase(
                  "the following part repeats but is the smaller one: compensation gains little"));
  }
  if (word_of(study.rest) == fit::StabilityWord::kUnstable) {
    out.push_back(core::phrase(
        "the non-following part does not repeat: look for a mechanical cause (spindle, "
        "workhead, tailstock)"));
  }
  return out;
}

Json contour_document(const fit::ContourStudy& study, const fit::ContourStudyOptions& options,
                      std::span<const std::string> names) {
  Json out = {{"settings", settings_json(options)},
              {"separation", separation_of(study)},
              {"parts", Json::array()}};
  for (std::size_t i = 0; i < study.parts.size(); ++i) {
    out["parts"].push_back(part_json(study.parts[i], names[i]));
  }
  const double um = 1.0 / core::kMicrometre;
  out["stability"] = {{"total", repeatability_json(study.total, um, "um")},
                      {"following", repeatability_json(study.following, um, "um")},
                      {"rest", repeatability_json(study.rest, um, "um")},
                      {"main", repeatability_json(study.main, um, "um")},
                      {"c_error", repeatability_json(study.c_error, 1e3 / core::kDegree, "mdeg")},
                      {"x_error", repeatability_json(study.x_error, um, "um")}};
  out["amplitude_ratio_following_rest"] = study.amplitude_ratio;
  out["diagnosis"] = nullptr;
  if (study.traced())
    out["diagnosis"] = {{"correlation_offset_deg", in_deg(study.offset.angle_rad)},
                        {"correlation_offset_u_deg", in_deg(study.offset.u_rad)},
                        {"correlation_total_following", study.sense.as_given},
                        {"correlation_total_mirrored_following", study.sense.mirrored}};
  out["verdicts"] = contour_verdicts(study);
  out["warnings"] = list_json(study.warnings, error_json);
  return out;
}

}  // namespace rondure::reports
