#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/schema/json_text.h"
#include "record/tasks/form_facts.h"

namespace rondure::plans {
namespace {

using core::Code;
using record::DatumNeed;
using record::Shape;

/// The feature of that letter or id.
std::optional<std::size_t> feature_named(const Plan& plan, std::string_view name) {
  for (std::size_t k = 0; k < plan.features.size(); ++k) {
    const FeaturePlan& feature = plan.features[k];
    if (!name.empty() && (feature.letter == name || feature.id == name)) return k;
  }
  return std::nullopt;
}

/// "A, C": the letters, of features without one the ids.
std::string names_of(const Plan& plan) {
  std::string out;
  for (const FeaturePlan& feature : plan.features) {
    if (!out.empty()) out += ", ";
    out += feature.letter.empty() ? feature.id : feature.letter;
  }
  return out;
}

/// The features of a datum. The whole text is looked up first: an id may hold a hyphen.
/// @return  Or the sentence about the name that no feature has.
tl::expected<std::vector<std::size_t>, std::string> features_of_datum(const Plan& plan,
                                                                      std::string_view text) {
  if (const auto whole = feature_named(plan, text)) return std::vector<std::size_t>{*whole};
  std::vector<std::size_t> out;
  std::string_view rest = text;
  while (true) {
    const std::size_t end = std::min(rest.find('-'), rest.size());
    const std::string_view name = rest.substr(0, end);
    const auto found = feature_named(plan, name);
    if (!found) {
      return tl::unexpected(
          fmt::format("datum {}: no feature has the letter or id {}; the plan "
                      "has {}",
                      in_quotes(text), in_quotes(name), names_of(plan)));
    }
    out.push_back(*found);
    if (end == rest.size()) return out;
    rest.remove_prefix(end + 1);
  }
}

/// Whether two features take the same rows of a file.
bool same_rows(const FeaturePlan& a, const FeaturePlan& b) {
  const auto path = [](const FeaturePlan& f) {
    return std::filesystem::path(f.source->file).lexically_normal();
  };
  return a.source && b.source && path(a) == path(b) && a.source->feature == b.source->feature;
}

/// Whether a touched feature is measured in the start pose that its plan states.
bool stays_in_start_pose(const FeaturePlan& feature) {
  using record::Strategy;
  const Strategy strategy = feature.pose_search.strategy;
  return feature.type != Shape::kCylinder || strategy == Strategy::kStartPose ||
         strategy == Strategy::kVirtual;
}

/// Why two touched features are certain to be measured in different poses; empty where they are
/// not.
std::string why_in_other_poses(const FeaturePlan& a, const FeaturePlan& b) {
  for (const FeaturePlan* merged : {&a, &b}) {
    if (merged->type != Shape::kCylinder ||
        merged->pose_search.strategy != record::Strategy::kMerged) {
      continue;
    }
    return fmt::format(
        "the cloud of {} is made of several poses, in a frame of its own; measure {} and {} with "
        "the strategy \"start-pose\"",
        in_quotes(merged->id), in_quotes(a.id), in_quotes(b.id));
  }
  const PoseSearchPlan& at = a.pose_search;
  const PoseSearchPlan& other = b.pose_search;
  const bool same =
      at.start_alpha_deg == other.start_alpha_deg && at.start_beta_deg == other.start_beta_deg;
  if (same || !stays_in_start_pose(a) || !stays_in_start_pose(b)) return {};
  return fmt::format(
      "{} is measured in pose ({}, {}) deg and {} in ({}, {}) deg, so nobody knows how they lie to "
      "each other; give both the same start_alpha_deg and start_beta_deg",
      in_quotes(a.id), plain(at.start_alpha_deg), plain(at.start_beta_deg), in_quotes(b.id),
      plain(other.start_alpha_deg), plain(other.start_beta_deg));
}

/// Why a feature is no datum, or part of no common datum; empty where it is.
/// @param common  Whether others make the datum with it: then a journal runs out about the axis
/// that
///                it shares.
std::string why_no_datum(const Plan& plan, std::size_t owner, std::size_t datum, bool common) {
  const FeaturePlan& feature = plan.features[datum];
  if (datum == owner) {
    if (common) return {};
    return "a feature alone is no datum of itself; name another, or a common datum, e.g. \"A-B\"";
  }
  if (same_rows(feature, plan.features[owner])) {
    return fmt::format(
        "{} and {} take the same rows of one file, and a feature is no datum of itself; name "
        "another",
        in_quotes(feature.id), in_quotes(plan.features[owner].id));
  }
  switch (feature.type) {
    case Shape::kCylinder:
    case Shape::kCircle:
    case Shape::kPlane:
      break;
    default:
      return fmt::format("a {} gives no datum here; name a cylinder or a plane",
                         name_of(feature.type));
  }
  const FeaturePlan& asked = plan.features[owner];
  const bool files = asked.source && feature.source;
  const std::string clamping = clamping_of(plan, asked);
  const bool together = asked.source.has_value() == feature.source.has_value() &&
                        (!files || (!clamping.empty() && clamping == clamping_of(plan, feature)));
  const std::size_t calibrated = calibrating_feature(plan);
  if (together && !files && (datum < calibrated) != (owner < calibrated)) {
    return fmt::format(
        "{} and {} stand on either side of the calibration of the fixture, for which the part is "
        "taken out; measure both in one clamping",
        in_quotes(feature.id), in_quotes(asked.id));
  }
  if (together) return files ? std::string() : why_in_other_poses(asked, feature);
  if (files && asked.source->file == feature.source->file) {
    return fmt::format(
        "{} and {} are of one file and of the clampings {} and {}, so nobody knows how they lie to "
        "each other; measure both in one clamping, and give both the same \"clamping\"",
        in_quotes(asked.id), in_quotes(feature.id), in_quotes(clamping),
        in_quotes(clamping_of(plan, feature)));
  }
  return files ? fmt::format(
                     "{} and {} are of different files, so nobody knows how they lie to "
                     "each other; give both sources the same \"clamping\" if they were "
                     "measured in one, or one file with a column feature",
                     in_quotes(asked.id), in_quotes(feature.id))
               : fmt::format(
                     "one of {} and {} is touched, the other comes from a file, so nobody "
                     "knows how they lie to each other; measure both in one way",
                     in_quotes(asked.id), in_quotes(feature.id));
}

/// Checks the features of one datum together.
std::string why_no_common_datum(const Plan& plan, std::string_view text,
                                const std::vector<std::size_t>& features) {
  const auto is_plane = [&](std::size_t k) { return plan.features[k].type == Shape::kPlane; };
  const bool any = std::any_of(features.begin(), features.end(), is_plane);
  if (any && !std::all_of(features.begin(), features.end(), is_plane)) {
    return fmt::format(
        "datum {} is made of an axis and a plane; give them as two datums, one "
        "after the other",
        in_quotes(text));
  }
  for (std::size_t k = 0; k < features.size(); ++k) {
    if (std::find(features.begin() + static_cast<std::ptrdiff_t>(k) + 1, features.end(),
                  features[k]) != features.end()) {
      return fmt::format("datum {} names a feature twice; remove one", in_quotes(text));
    }
  }
  if (features.size() == 1 && plan.features[features.front()].type == Shape::kCircle) {
    return fmt::format("datum {} has 1 section, an axis needs 2; name a common datum, e.g. \"A-B\"",
                       in_quotes(text));
  }
  return {};
}

}  // namespace

void check_datums(const Plan& plan, std::size_t index, const record::CharacteristicTask& asked,
                  const std::string& where, Findings& findings) {
  const record::FormFacts& facts = record::facts_of(asked.form);
  if (facts.datum == DatumNeed::kNone) return;
  const std::string place = where + "/datum";
  const std::vector<std::string>& datums = asked.indication.datum;
  constexpr std::size_t kMost = 3;
  if (datums.empty()) {
    if (findings.is_given(place)) return;
    return findings.meaning(
        Code::kMissingKey, place,
        fmt::format("this key is missing: {} needs a datum, e.g. [\"A-B\"]", name_of(asked.form)));
  }
  if (datums.size() > kMost) {
    return findings.meaning(Code::kMeaning, place,
                            fmt::format("{} datums, a drawing has at most 3", datums.size()));
  }
  bool axis = false;
  bool known = true;
  for (std::size_t k = 0; k < datums.size(); ++k) {
    const auto refuse = [&](std::string what) {
      known = false;
      findings.meaning(Code::kMeaning, item_pointer(place, k), std::move(what));
    };
    const auto features = features_of_datum(plan, datums[k]);
    if (!features) {
      refuse(features.error());
      continue;
    }
    std::string why = why_no_common_datum(plan, datums[k], *features);
    for (const std::size_t feature : *features) {
      std::string own = why_no_datum(plan, index, feature, features->size() > 1);
      if (!own.empty()) why = std::move(own);
      axis = axis || plan.features[feature].type != Shape::kPlane;
    }
    if (!why.empty()) refuse(std::move(why));
  }
  if (known && !axis && facts.datum == DatumNeed::kAxis) {
    findings.meaning(Code::kMeaning, place,
                     fmt::format("{} is about an axis, and the datum is a plane; name a cylinder",
                                 name_of(asked.form)));
  }
}

void measure_datums_in_one_pose(Plan& plan, const Findings& findings) {
  std::vector<bool> related(plan.features.size(), false);
  for (std::size_t k = 0; k < plan.features.size(); ++k) {
    for (const record::CharacteristicTask& asked : plan.features[k].characteristics) {
      for (const std::string& datum : asked.indication.datum) {
        const auto features = features_of_datum(plan, datum);
        if (!features) continue;
        related[k] = true;
        for (const std::size_t feature : *features) related[feature] = true;
      }
    }
  }
  for (std::size_t k = 0; k < plan.features.size(); ++k) {
    if (!related[k] || findings.is_given(feature_pointer(k) + "/pose_search/strategy")) continue;
    plan.features[k].pose_search.strategy = record::Strategy::kStartPose;
  }
}

void check_faces(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& plane = plan.features[index];
  const std::string where = feature_pointer(index) + "/nominal/faces";
  if (plane.type != Shape::kPlane || findings.is_given(where)) return;
  std::string why;
  for (const record::CharacteristicTask& own : plane.characteristics) {
    if (record::takes(own.form, "direction")) why = "the plane has a run-out";
  }
  for (const FeaturePlan& feature : plan.features) {
    for (const record::CharacteristicTask& asked : feature.characteristics) {
      for (const std::string& datum : asked.indication.datum) {
        const auto features = features_of_datum(plan, datum);
        const bool named =
            features && std::find(features->begin(), features->end(), index) != features->end();
        if (named) why = fmt::format("the plane is datum {}", in_quotes(datum));
      }
    }
  }
  if (why.empty()) return;
  findings.meaning(Code::kMissingKey, where,
                   fmt::format("this key is missing: {}; give \"up\" or \"down\", the side to "
                               "which the face looks out of the material",
                               why));
}

}  // namespace rondure::plans
