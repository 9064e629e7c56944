#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "plans/checks/internal/plan_checks.h"
#include "plans/path/sampling.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

// Millimetres as messages print them: six digits.
std::string mm(double value_mm) { return fmt::format("{:.6g} mm", value_mm); }

bool check_nominal_given(const std::string& nominal, Findings& findings) {
  bool complete = true;
  const auto need = [&](std::string_view key, std::string_view meaning) {
    if (findings.is_given(member_pointer(nominal, key))) return;
    complete = false;
    findings.meaning(Code::kMissingKey, member_pointer(nominal, key),
                     fmt::format("this key is missing: {}", meaning));
  };
  need("diameter_mm", "the diameter on the drawing");
  need("from_mm", "the lower end of the surface, part z");
  need("to_mm", "the upper end of the surface, part z");
  return complete;
}

// Checks that the surface is long enough for the layers.
bool check_extent(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const NominalPlan& nominal = feature.nominal;
  const double length_mm = nominal.to_mm - nominal.from_mm;
  const auto refuse = [&](Code code, const char* key, std::string what) {
    findings.meaning(code, where + key, std::move(what));
    return false;
  };
  if (length_mm <= 0.0) {
    return refuse(
        Code::kMeaning, "/nominal/from_mm",
        fmt::format("the lower end {} is not below the upper end {}; exchange or correct them",
                    mm(nominal.from_mm), mm(nominal.to_mm)));
  }
  if (feature.type == record::Shape::kCircle) return true;  // one section, in the middle
  const double margin_mm = feature.sampling.margin_mm;
  if (2.0 * margin_mm >= length_mm) {
    return refuse(
        Code::kSampling, "/sampling/margin_mm",
        fmt::format("two margins of {} leave nothing of a surface {} long; it must be less than {}",
                    mm(margin_mm), mm(length_mm), mm(length_mm / 2.0)));
  }
  return true;
}

bool check_counts(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  constexpr std::int64_t kMaxPoints = 1'000'000;
  const SamplingPlan& sampling = feature.sampling;
  const bool circle = feature.type == record::Shape::kCircle;
  const auto refuse = [&](const char* key, std::string what) {
    findings.meaning(Code::kSampling, where + key, std::move(what));
    return false;
  };
  if (circle && sampling.layers != 1) {
    return refuse(
        "/sampling/layers",
        fmt::format("a circle is 1 layer, {} are asked for; make the feature a \"cylinder\" "
                    "or leave the key out",
                    sampling.layers));
  }
  if (circle && sampling.points_per_layer < 4) {
    return refuse(
        "/sampling/points_per_layer",
        fmt::format("{} points lie on a circle exactly, whatever the part; at least 4 are "
                    "needed",
                    sampling.points_per_layer));
  }
  if (!circle && sampling.layers < 2) {
    return refuse(
        "/sampling/layers",
        fmt::format("{} layer leaves the tilt of the cylinder undetermined; at least 2 are "
                    "needed",
                    sampling.layers));
  }
  const std::int64_t points = std::int64_t{sampling.layers} * sampling.points_per_layer;
  if (points > kMaxPoints) {
    return refuse("/sampling", fmt::format("{} x {} = {} points, the limit is {}", sampling.layers,
                                           sampling.points_per_layer, points, kMaxPoints));
  }
  return true;
}

void check_clamp(const FeaturePlan& feature, const FixturePlan& fixture, const std::string& where,
                 Findings& findings) {
  if (fixture.clamp_from_mm >= fixture.clamp_to_mm) return;
  const auto targets = sampling_targets(feature);
  if (!targets) return;  // check_counts() and check_extent() have reported this
  for (const Target& target : *targets) {
    const bool clamped = target.z_mm >= fixture.clamp_from_mm && target.z_mm <= fixture.clamp_to_mm;
    if (target.point != 0 || !clamped) continue;
    findings.meaning(
        Code::kSampling, where + "/sampling",
        fmt::format("layer {} of {} at z = {} lies in the clamped band {}..{}; move the "
                    "clamp, or change the layers or the margin",
                    target.layer + 1, feature.sampling.layers, mm(target.z_mm),
                    plain(fixture.clamp_from_mm), mm(fixture.clamp_to_mm)));
  }
}

// Checks that the search starts between the axis of a bore and its wall for any position of the
// part.
void check_bore(const Plan& plan, const FeaturePlan& feature, const std::string& where,
                Findings& findings) {
  const double bore_mm = feature.nominal.diameter_mm;
  const double tip_mm = plan.probe->tip_diameter_mm;
  const double room_mm = (bore_mm - tip_mm) / 2.0;
  const double needed_mm = plan.machine->approach_mm + plan.part.location_uncertainty_mm;
  if (room_mm <= 0.0) {
    findings.meaning(Code::kUnreachable, where + "/nominal/diameter_mm",
                     fmt::format("a tip of {} does not enter a bore of {}; take a smaller tip",
                                 mm(tip_mm), mm(bore_mm)));
  } else if (needed_mm > room_mm) {
    findings.meaning(Code::kUnreachable, where + "/nominal/diameter_mm",
                     fmt::format("a bore of {} leaves a tip of {} a way of {} from axis to wall; "
                                 "approach_mm and location_uncertainty_mm need {} together; lower "
                                 "them or take a smaller tip",
                                 mm(bore_mm), mm(tip_mm), mm(room_mm), mm(needed_mm)));
  }
}

}  // namespace

void check_sampling(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index);
  if (!findings.sound(where + "/type")) return;
  const bool counts = findings.sound(where + "/sampling") && check_counts(feature, where, findings);
  if (!findings.sound(where + "/nominal") || !check_nominal_given(where + "/nominal", findings)) {
    return;
  }
  const bool extent = findings.sound(where + "/sampling") && check_extent(feature, where, findings);
  if (counts && extent && plan.fixture && findings.sound("/fixture")) {
    check_clamp(feature, *plan.fixture, where, findings);
  }
  const bool known = plan.probe && plan.machine && findings.sound("/probe") &&
                     findings.sound("/machine") && findings.sound("/part") &&
                     findings.sound(where + "/side");
  if (feature.side == record::Side::kInside && known) check_bore(plan, feature, where, findings);
}

}  // namespace rondure::plans
