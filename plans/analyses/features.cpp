#include "plans/analyses/features.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/analyses/internal/feature_references.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {

bool is_touched(const FeaturePlan& feature) {
  return !feature.source && analysis_kind(feature.type) == nullptr;
}

bool needs_machine(const FeaturePlan& feature) {
  return is_touched(feature) || measures_by_touch(feature);
}

bool is_fixed(const Plan& plan) {
  return plan.fixture && plan.fixture->driver == FixturePlan::Driver::kFixed;
}

std::size_t feature_index(const Plan& plan, std::string_view id) {
  const auto same = [&](const FeaturePlan& feature) { return feature.id == id; };
  return static_cast<std::size_t>(std::find_if(plan.features.begin(), plan.features.end(), same) -
                                  plan.features.begin());
}

std::size_t calibrating_feature(const Plan& plan) {
  const bool named = plan.fixture && plan.fixture->calibration;
  if (!named || plan.fixture->calibration->feature.empty()) return plan.features.size();
  return feature_index(plan, plan.fixture->calibration->feature);
}

bool touches_anything(const Plan& plan) {
  return std::any_of(plan.features.begin(), plan.features.end(), needs_machine);
}

bool simulates_anything(const Plan& plan) {
  return std::any_of(plan.features.begin(), plan.features.end(), [](const FeaturePlan& feature) {
    return !feature.source && !has_files(feature);
  });
}

bool simulates_analysis(const Plan& plan) {
  return std::any_of(plan.features.begin(), plan.features.end(), [](const FeaturePlan& feature) {
    return analysis_kind(feature.type) != nullptr && !has_files(feature) &&
           !measures_by_touch(feature);
  });
}

std::vector<record::Characteristic> characteristics_of(const Plan& plan,
                                                       const FeaturePlan& feature) {
  const std::array<record::CharacteristicLevel, 2> levels = {
      {{feature.defaults, feature.decision_rule}, {plan.defaults, std::nullopt}}};
  std::vector<record::Characteristic> out;
  for (const record::CharacteristicTask& task : feature.characteristics) {
    out.push_back(characteristic_of(task, feature.nominal.diameter_mm, levels));
  }
  return out;
}

std::string clamping_of(const Plan& plan, const FeaturePlan& feature) {
  if (!feature.source || analysis_kind(feature.type) != nullptr) return {};
  if (!feature.source->clamping.empty()) return feature.source->clamping;
  std::size_t sharing = 0;
  std::string named;
  for (const FeaturePlan& other : plan.features) {
    if (!other.source || other.source->file != feature.source->file) continue;
    ++sharing;
    const std::string& own = other.source->clamping;
    // A file of several clampings says of no other row where the part stood.
    if (!named.empty() && !own.empty() && own != named) return feature.source->file;
    if (named.empty()) named = own;
  }
  return named.empty() && sharing > 1 ? feature.source->file : named;
}

namespace {

using core::Code;
using record::WheelTask;

/// A value that a feature takes of another one.
struct TakenValue {
  std::string_view key;  ///< Where the plan says so, after the pointer of the feature.
  const std::string& feature;
  std::string_view value;  ///< What it takes.
  /// Why a feature gives no such value; empty where it does.
  std::string (*refused)(const FeaturePlan& producer);
};

std::string why_no_axis(const FeaturePlan& producer) {
  if (producer.type != record::Shape::kWheel) {
    return fmt::format("feature {} is a {}", in_quotes(producer.id), name_of(producer.type));
  }
  if (!producer.wheel || producer.wheel->mode != WheelTask::Mode::kEnvelope) {
    return fmt::format("feature {} is measured indexed: its centre is that of the profile",
                       in_quotes(producer.id));
  }
  if (producer.wheel->center != WheelTask::Center::kLeastSquares) {
    return fmt::format("the centre of feature {} is a mean of quadruples, which has no covariance",
                       in_quotes(producer.id));
  }
  return {};
}

std::string why_no_radius(const FeaturePlan& producer) {
  if (producer.type != record::Shape::kWheel) {
    return fmt::format("feature {} is a {}", in_quotes(producer.id), name_of(producer.type));
  }
  if (!producer.wheel || producer.wheel->mode != WheelTask::Mode::kEnvelope) {
    return fmt::format(
        "feature {} is measured indexed: its radius is without the run-out with "
        "which the wheel grinds",
        in_quotes(producer.id));
  }
  return producer.wheel->nominal_radius_mm
             ? std::string()
             : fmt::format("feature {} has no nominal_radius_mm", in_quotes(producer.id));
}

/// @param files  Whether readings of a file follow: theirs were taken before.
template <bool files>
std::string why_no_table(const FeaturePlan& producer) {
  if (!producer.five_axis) return fmt::format("feature {} is no head", in_quotes(producer.id));
  if (producer.five_axis->repeat) {
    return fmt::format("feature {} has a table loaded itself", in_quotes(producer.id));
  }
  return producer.source.has_value() == files
             ? std::string()
             : fmt::format("the readings of feature {} are {}, those of this one are not",
                           in_quotes(producer.id), files ? "simulated" : "of a file");
}

/// @param files  Whether parts of files follow: theirs were ground before.
template <bool files>
std::string why_no_correction(const FeaturePlan& producer) {
  if (!producer.contour) return fmt::format("feature {} is no contour", in_quotes(producer.id));
  if (producer.contour->repeat) {
    return fmt::format("feature {} has a correction loaded itself", in_quotes(producer.id));
  }
  return producer.contour->parts.empty() == !files
             ? std::string()
             : fmt::format("the parts of feature {} are {}, those of this one are not",
                           in_quotes(producer.id), files ? "simulated" : "files");
}

std::vector<TakenValue> references_of(const FeaturePlan& feature) {
  std::vector<TakenValue> out;
  if (feature.spindle && feature.spindle->wheel_radius_from) {
    out.push_back({"/spindle/wheel_radius_from/feature",
                   feature.spindle->wheel_radius_from->feature,
                   "the radius is that of a wheel of mode envelope with a nominal radius, on "
                   "which the probes were set",
                   why_no_radius});
  }
  if (feature.contour && feature.contour->wheel_radius_from) {
    out.push_back(
        {"/contour/wheel_radius_from/feature", feature.contour->wheel_radius_from->feature,
         "the radius is that of a wheel of mode envelope with a nominal radius", why_no_radius});
  }
  if (feature.contour && feature.contour->repeat) {
    out.push_back(
        {"/contour/repeat/with/feature", feature.contour->repeat->with.feature,
         "the correction is that of pins of the same plan",
         feature.contour->parts.empty() ? why_no_correction<false> : why_no_correction<true>});
  }
  if (feature.five_axis && feature.five_axis->repeat) {
    out.push_back({"/five_axis/repeat/with/feature", feature.five_axis->repeat->with.feature,
                   "the table is that of a feature of type five_axis",
                   feature.source ? why_no_table<true> : why_no_table<false>});
  }
  if (feature.wheel && feature.wheel->axis_from) {
    out.push_back({"/wheel/axis_from/feature", feature.wheel->axis_from->feature,
                   "the axis is that of a wheel of mode envelope with center least-squares",
                   why_no_axis});
  }
  return out;
}

std::optional<std::size_t> index_of(const Plan& plan, const std::string& id) {
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (plan.features[i].id == id) return i;
  }
  return std::nullopt;
}

/// Whether a feature takes a value, directly or over others, of feature `wanted`.
bool leads_to(const Plan& plan, std::size_t from, std::size_t wanted) {
  std::vector<bool> seen(plan.features.size(), false);
  std::vector<std::size_t> open = {from};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (at == wanted) return true;
    if (seen[at]) continue;
    seen[at] = true;
    for (const TakenValue& reference : references_of(plan.features[at])) {
      if (const auto next = index_of(plan, reference.feature)) open.push_back(*next);
    }
  }
  return false;
}

/// Why a feature cannot take this value; empty where it can.
std::string why_not_taken(const Plan& plan, std::size_t index, const TakenValue& reference) {
  const std::string named = in_quotes(reference.feature);
  const auto producer = index_of(plan, reference.feature);
  if (!producer) {
    return fmt::format("no feature has the id {}; name an earlier feature of this plan", named);
  }
  if (*producer == index) return "a feature takes no value of itself; name an earlier one";
  if (*producer > index) {
    if (leads_to(plan, *producer, index)) {
      return fmt::format(
          "feature {} itself takes a value that depends on this one: a circle has no "
          "beginning; remove one of the references",
          named);
    }
    return fmt::format(
        "feature {} comes later, and features are done in the order of the plan; "
        "move it before this one",
        named);
  }
  const std::string refused = reference.refused(plan.features[*producer]);
  if (refused.empty()) return {};
  return fmt::format("{}; {}", refused, reference.value);
}

}  // namespace

void check_references(const Plan& plan, std::size_t index, Findings& findings) {
  const std::string where = feature_pointer(index);
  for (const TakenValue& reference : references_of(plan.features[index])) {
    const std::string place = where + std::string(reference.key);
    if (!findings.sound(place)) continue;
    if (std::string fault = why_not_taken(plan, index, reference); !fault.empty()) {
      findings.meaning(Code::kMeaning, place, std::move(fault));
    }
  }
}

}  // namespace rondure::plans
