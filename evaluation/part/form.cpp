#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/part/internal/asked_sections.h"
#include "evaluation/part/internal/associated.h"
#include "evaluation/part/internal/families.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/internal/deviation.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/plane.h"
#include "fit/profiles/form_parameters.h"
#include "fit/references/min_zone.h"
#include "record/tasks/form_facts.h"

namespace rondure::evaluation {
namespace {

using Indication = record::Indication;
using record::Form;
using record::Reference;

/// A form deviation with its evidence, as evaluation::Deviation is that of a whole feature.
struct SurfaceForm {
  double value_mm = 0.0;
  fit::FormParameters ls = {};  // about least squares only
  std::optional<fit::DeviationRange> range = {};
  bool certified = true;
  std::optional<core::Phrase> unseen = {};
};

double value_of_parameter(const fit::FormParameters& form, Indication::Parameter parameter) {
  switch (parameter) {
    case Indication::Parameter::kTotal:
      return form.total_mm;
    case Indication::Parameter::kPeak:
      return form.peak_mm;
    case Indication::Parameter::kValley:
      return form.valley_mm;
    case Indication::Parameter::kRms:
      return form.rms_mm;
  }
  return form.total_mm;
}

core::Result<void> check_parameter(const record::Characteristic& asked) {
  const bool total = asked.indication.parameter == Indication::Parameter::kTotal;
  if (total || asked.reference == Reference::kLeastSquares) return {};
  return core::fail(core::Code::kMeaning,
                    core::phrase("peak, valley and rms are defined about the least-squares "
                                 "reference; plan reference \"ls\""));
}

/// Value about least squares, with the other parameters beside it.
void add_parameters(const record::Characteristic& asked, const fit::FormParameters& form,
                    Finding& out) {
  const std::string symbol = symbol_of(asked);
  const std::array<std::pair<char, double>, 4> all = {
      {{'t', form.total_mm}, {'p', form.peak_mm}, {'v', form.valley_mm}, {'q', form.rms_mm}}};
  for (const auto& [letter, value] : all) {
    if (symbol.back() == letter) continue;
    out.numbers.push_back({symbol.substr(0, symbol.size() - 1) + letter, value});
  }
}

/// What a verdict needs beside the value, in the order of the evaluation of a feature.
void note_evidence(const record::Characteristic& asked, record::Shape about,
                   const SurfaceForm& found, Finding& out) {
  // A zone of some points is never wider than that of all: above the tolerance it is proof enough.
  const bool too_wide = asked.reference == Reference::kMinimumZone && asked.tolerance_mm &&
                        found.value_mm > *asked.tolerance_mm;
  out.unique = !found.range;
  if (!found.certified) {
    out.no_verdict = core::phrase("no certificate stands behind the {}",
                                  core::Phrase(words_of(asked.reference, about)));
  } else if (found.unseen && !too_wide) {
    out.no_verdict = found.unseen;
  } else if (found.range) {
    out.no_verdict = undecided_range(*found.range, asked.tolerance_mm);
  }
}

core::Result<Finding> find_cylindricity(const PreparedSurface& surface,
                                        const record::Characteristic& asked, Proof proof) {
  TRY(const auto cylinder, associated_cylinder(surface, asked.reference, proof));
  SurfaceForm found{.value_mm = cylinder.deviation_mm, .certified = cylinder.certified};
  Finding out;
  out.pivots = cylinder.pivots;
  if (asked.reference == Reference::kLeastSquares) {
    TRY(const auto form, fit::cylindricity_parameters(surface.points_mm, cylinder.axis,
                                                      cylinder.radius_mm, surface.material.inside));
    found.value_mm = value_of_parameter(form, asked.indication.parameter);
    add_parameters(asked, form, out);
    std::vector<double> distances_mm;
    for (const Eigen::Vector3d& p : surface.points_mm) {
      distances_mm.push_back(fit::distance_mm(cylinder.axis, p));
    }
    add_extreme_rows(surface, distances_mm, out);
  }
  add_rows(surface, cylinder.contacts, out);
  out.judged.push_back({symbol_of(asked), found.value_mm, limits_of(asked)});
  out.reference = core::as_it_is(reference_of(asked));
  if (proof == Proof::kNone) return out;
  found.unseen = unseen_part(surface);
  note_evidence(asked, record::Shape::kCylinder, found, out);
  return out;
}

/// Form of one section, with the points of the surface that carry it.
struct SectionForm {
  SurfaceForm form;
  std::vector<std::size_t> points;
};

/// The points of a section across the axis. One that is seen along the nominal axis has any height.
core::Result<std::vector<Eigen::Vector2d>> seen_along_axis(const PreparedSurface& surface,
                                                           const SurfaceSection& section) {
  if (stated_plane(surface.of->feature) != "nominal") {
    TRY(auto flat, projected(surface, std::span(&section, 1)));
    return std::move(flat.front().points_mm);
  }
  const auto frame = fit::across(surface.axis.direction);
  std::vector<Eigen::Vector2d> out;
  for (const std::size_t i : section.points) {
    out.emplace_back(frame.transpose() * (surface.points_mm[i] - surface.axis.point_mm));
  }
  return out;
}

core::Result<SectionForm> form_of_section(const PreparedSurface& surface,
                                          const SurfaceSection& section,
                                          const record::Characteristic& asked, Proof proof) {
  TRY(const auto points_mm, seen_along_axis(surface, section));
  const auto exact = [&] {
    return core::fail(core::Code::kTooFewPoints,
                      core::phrase("layer {}: a section of three different points has no "
                                   "roundness; plan at least 4 points a layer",
                                   section.layer + 1));
  };
  if (fit::distinct_points(points_mm, 4) < 4) return exact();
  const auto circle = associated_circle(points_mm, asked.reference, proof);
  if (!circle) return core::fail(in_layer(section, circle.error()));
  if (circle->exact_fit) return exact();
  SectionForm out;
  out.form = {.value_mm = circle->deviation_mm,
              .range = circle->range,
              .certified = circle->certified,
              .unseen = unseen_part(surface, std::span(&section, 1), surface.axis)};
  for (const std::size_t contact : circle->contacts) out.points.push_back(section.points[contact]);
  if (asked.reference != Reference::kLeastSquares) return out;
  std::vector<double> deviations_mm;
  for (const Eigen::Vector2d& p : points_mm) {
    deviations_mm.push_back(surface.material.sign() *
                            ((p - circle->center_mm).norm() - circle->radius_mm));
  }
  out.form.ls = fit::form_parameters(deviations_mm);
  out.form.value_mm = value_of_parameter(out.form.ls, asked.indication.parameter);
  const auto [low, high] = std::ranges::minmax_element(deviations_mm);
  for (const auto at : {high, low}) {
    out.points.push_back(section.points[static_cast<std::size_t>(at - deviations_mm.begin())]);
  }
  return out;
}

core::Result<Finding> find_roundness(const PreparedSurface& surface,
                                     const record::Characteristic& asked, Proof proof) {
  TRY(const auto sections, asked_sections(surface, asked.indication));
  Finding out;
  SurfaceForm found;
  fit::DeviationRange range;
  bool unique = true;
  std::vector<SectionForm> forms;
  for (const SurfaceSection& section : sections) {
    TRY(auto own, form_of_section(surface, section, asked, proof));
    const SurfaceForm& form = own.form;
    out.local.push_back(
        {.layer = section.layer, .position = section.height_mm, .value_mm = form.value_mm});
    found.certified = found.certified && form.certified;
    if (!found.unseen) found.unseen = form.unseen;
    const auto least_most = form.range.value_or(fit::DeviationRange{form.value_mm, form.value_mm});
    range.low_mm = std::max(range.low_mm, least_most.low_mm);
    range.high_mm = std::max(range.high_mm, least_most.high_mm);
    unique = unique && !form.range;
    forms.push_back(std::move(own));
  }
  const auto worst = std::ranges::max_element(
      forms, {}, [](const SectionForm& section) { return section.form.value_mm; });
  out.worst = static_cast<std::size_t>(worst - forms.begin());
  if (!unique && range.high_mm > range.low_mm) found.range = range;
  found.value_mm =
      found.range ? deciding_mm(*found.range, asked.tolerance_mm) : worst->form.value_mm;
  if (asked.reference == Reference::kLeastSquares) add_parameters(asked, worst->form.ls, out);
  add_rows(surface, worst->points, out);
  out.judged.push_back({symbol_of(asked), found.value_mm, limits_of(asked)});
  out.reference = of_sections(core::as_it_is(reference_of(asked)), asked.indication);
  if (proof == Proof::kFull) note_evidence(asked, record::Shape::kCircle, found, out);
  return out;
}

core::Result<Finding> find_flatness(const PreparedSurface& surface,
                                    const record::Characteristic& asked) {
  const auto& points_mm = surface.points_mm;
  const bool zone_asked = asked.reference == Reference::kMinimumZone;
  if (!zone_asked && asked.reference != Reference::kLeastSquares) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("a plane has no circumscribed and no inscribed reference; plan "
                                   "reference \"mz\" or \"ls\""));
  }
  constexpr std::size_t kFewest = 4;
  if (points_mm.size() < kFewest) {
    return core::fail(core::Code::kTooFewPoints,
                      core::phrase("{} points determine a plane and leave nothing to judge; plan "
                                   "at least {}",
                                   points_mm.size(), kFewest));
  }
  Finding out;
  SurfaceForm found;
  if (zone_asked) {
    TRY(const auto zone, fit::min_zone_plane(points_mm, surface.axis.direction));
    found.value_mm = zone.width_mm;
    found.certified = zone.certificate.kind != fit::Certificate::Kind::kNone;
    for (const auto* contacts : {&zone.top, &zone.bottom}) {
      for (const fit::Contact& contact : *contacts) out.rows.push_back(surface.rows[contact.index]);
    }
  } else {
    TRY(const auto plane, fit::ls_plane(points_mm, surface.axis.direction));
    TRY(const auto form, fit::flatness_parameters(points_mm, plane.plane));
    found.value_mm = value_of_parameter(form, asked.indication.parameter);
    add_parameters(asked, form, out);
    std::vector<double> heights_mm;
    for (const Eigen::Vector3d& p : points_mm) heights_mm.push_back(height_mm(plane.plane, p));
    add_extreme_rows(surface, heights_mm, out);
  }
  out.judged.push_back({symbol_of(asked), found.value_mm, limits_of(asked)});
  out.reference = core::as_it_is(reference_of(asked.reference, record::Shape::kPlane));
  found.unseen = unseen_of_face(surface);
  note_evidence(asked, record::Shape::kPlane, found, out);
  return out;
}

}  // namespace

core::Result<Finding> find_form(const PreparedSurface& surface, const record::Characteristic& asked,
                                Proof proof) {
  TRY_DO(check_parameter(asked));
  switch (asked.form) {
    case Form::kCylindricity:
      return find_cylindricity(surface, asked, proof);
    case Form::kRoundness:
      return find_roundness(surface, asked, proof);
    case Form::kFlatness:
      return find_flatness(surface, asked);
    default:
      return core::fail(
          core::Code::kMeaning,
          core::phrase("{} is not a form deviation of a surface", record::name_of(asked.form)));
  }
}

}  // namespace rondure::evaluation
