#include "plans/run/internal/part_place.h"

#include <vector>

#include <fmt/format.h>

#include "core/shortest_turn.h"
#include "fit/geometry/registration.h"
#include "fixture/kinematics.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_reach.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/run/internal/fixture_base.h"
#include "plans/run/internal/inspection.h"
#include "plans/run/internal/qualification.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

/// A display of the position shows micrometres; other systems differ by far more.
constexpr double kSameSystem_mm = 0.01;

core::Result<fit::Registration> part_system(RunContext& context) {
  TRY(const auto steps, qualification_steps(context.plan));
  std::vector<Vector3d> in_part;
  std::vector<Vector3d> in_machine;
  context.doing = fmt::format("around the {}, to read the part system of the control",
                              context.plan.probe->qualification.name());
  for (const TouchStep& step : steps) {
    auto moved = context.follow(step.way_W);
    if (!moved && !context.retreating) return core::fail(moved.error());
    const auto tip = moved ? context.cell->tip_in_part_system_mm() : core::fail(moved.error());
    if (!tip) {
      (void)context.rise();
      return core::fail(tip.error());
    }
    in_part.push_back(*tip);
    in_machine.push_back(context.cell->machine().position_W_mm());
  }
  TRY_DO(context.rise());
  TRY(const auto place, fit::rigid_registration(in_part, in_machine));
  if (place.largest_residual_mm <= kSameSystem_mm) return place;
  return core::fail(
      core::Code::kMachine,
      fmt::format("the part system of the control differs from that of the machine by more than a "
                  "turn and a shift, {:.3f} mm are left; align the part in the control again",
                  place.largest_residual_mm),
      "/part/system");
}

core::Result<fit::Registration> aligned(RunContext& context) {
  const Plan& plan = context.plan;
  const std::size_t face = feature_index(plan, plan.part.alignment->face);
  const std::size_t cylinder = feature_index(plan, plan.part.alignment->axis);
  // The face first: it is met also where the part stands beside its place, and its height is that
  // of the sections.
  Eigen::Isometry3d X_WP = standing_part(*plan.fixture);
  context.cell->mount(plan.features[face]);
  TRY(const double up_mm, FeatureSession(context, static_cast<int>(face), {}).locate_height());
  X_WP.translate(Vector3d(0.0, 0.0, up_mm));
  context.cell->set_base(X_WP * standing_part(*plan.fixture).inverse());
  context.cell->mount(plan.features[cylinder]);
  TRY(const auto axis, FeatureSession(context, static_cast<int>(cylinder), {}).locate({}));
  const Vector3d expected = X_WP.linear().col(2);
  const Vector3d z =
      axis.direction.dot(expected) < 0.0 ? Vector3d(-axis.direction) : Vector3d(axis.direction);
  const double face_mm = plan.features[face].nominal.z_mm;
  const Vector3d on_face = X_WP * Vector3d(0.0, 0.0, face_mm);
  fit::Registration out;
  out.motion.linear() = core::shortest_turn(expected, z) * X_WP.linear();
  out.motion.translation() = axis.point_mm + z * ((on_face - axis.point_mm).dot(z) - face_mm);
  return out;
}

}  // namespace

core::Result<void> find_part_place(RunContext& context) {
  const PartPlan& part = context.plan.part;
  const bool control = part.system == PartPlan::System::kControl;
  if (!is_fixed(context.plan) || (!control && !part.alignment)) return {};
  const Eigen::Isometry3d planned = standing_part(*context.plan.fixture);
  const core::Message* known = context.recorded.decided(core::MessageCode::kFixtureBaseFound);
  core::Message found = known != nullptr ? *known : core::Message();
  if (known == nullptr && control && context.replaying()) {
    return core::fail(core::Code::kJournal,
                      "the journal has touches of the part, but not where it stands");
  }
  // The touches of an alignment are on record. A run that goes on before its first touch of the
  // part goes around the sphere again: its clock is then that of a run without interruption.
  if (!control || !context.replaying()) {
    TRY(auto place, control ? part_system(context) : aligned(context));
    place.motion = place.motion * planned.inverse();
    if (known == nullptr) {
      found = base_message(place);
      TRY_DO(context.journal.add(record::Decision{-1, context.cell->machine().time_s(), found}));
    }
  }
  context.aligned = part.alignment.has_value();
  context.cell->set_base(fixture::base_found(found));
  return check_room_at(context.plan, fixture::base_found(found) * planned);
}

}  // namespace rondure::plans
