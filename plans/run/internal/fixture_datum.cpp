#include "plans/run/internal/fixture_datum.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/run/internal/qualification.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

constexpr const char* kDatumPointer = "/fixture/datum";

core::Result<Vector3d> center_near_nominal(const Plan& plan, std::size_t sphere,
                                           const std::vector<Vector3d>& tips) {
  const DatumPlan& datum = *plan.fixture->datum;
  const auto center =
      sphere_center(plan, tips, fmt::format("sphere {} of the fixture", sphere + 1));
  if (!center) return core::fail(center.error().at(kDatumPointer));
  const double off_mm = (*center - vector3(datum.spheres[sphere].center_mm)).norm();
  if (off_mm <= datum.uncertainty_mm) return *center;
  return core::fail(core::Code::kLocation,
                    fmt::format("sphere {} of the fixture stands {:.3f} mm from its nominal "
                                "place, the plan allows {:g} mm (uncertainty_mm); check where the "
                                "fixture is bolted",
                                sphere + 1, off_mm, datum.uncertainty_mm),
                    kDatumPointer);
}

}  // namespace

core::Message base_message(const fit::Registration& base) {
  const Vector3d shift = base.motion.translation();
  const Eigen::AngleAxisd turn(base.motion.rotation());
  const Vector3d angles = turn.angle() * turn.axis() / core::kDegree;
  return {core::MessageCode::kFixtureBaseFound,
          {shift.x(), shift.y(), shift.z(), angles.x(), angles.y(), angles.z(),
           base.largest_residual_mm / core::kMicrometre}};
}

core::Result<std::vector<TouchStep>> datum_steps(const Plan& plan) {
  std::vector<TouchStep> out;
  if (!plan.fixture->datum) return out;
  const DatumPlan& datum = *plan.fixture->datum;
  const auto clamped = std::find_if(plan.features.begin(), plan.features.end(), needs_machine);
  const Eigen::Isometry3d X_WB = fixture::body_to_machine(nominal_kinematics(*plan.fixture), {});
  for (std::size_t i = 0; i < datum.spheres.size(); ++i) {
    const SphereToTouch sphere = {vector3(datum.spheres[i].center_mm),
                                  0.5 * datum.sphere_diameter_mm,
                                  datum.points,
                                  datum.uncertainty_mm,
                                  record::Touch::Purpose::kLocate,
                                  static_cast<int>(i)};
    const auto steps = sphere_steps(plan, sphere);
    if (!steps) return core::fail(steps.error().at(kDatumPointer));
    if (auto clear = check_sphere_steps(plan, *clamped, X_WB, datum.spheres[i].center_mm,
                                        datum.uncertainty_mm, *steps,
                                        fmt::format("sphere {} of the fixture", i + 1));
        !clear) {
      return core::fail(clear.error().at(kDatumPointer));
    }
    out.insert(out.end(), steps->begin(), steps->end());
  }
  return out;
}

core::Result<fit::Registration> fixture_base(const Plan& plan,
                                             std::span<const std::vector<Vector3d>> tips_W_mm) {
  const DatumPlan& datum = *plan.fixture->datum;
  std::vector<Vector3d> nominal;
  std::vector<Vector3d> found;
  for (std::size_t i = 0; i < tips_W_mm.size(); ++i) {
    TRY(const auto center, center_near_nominal(plan, i, tips_W_mm[i]));
    nominal.push_back(vector3(datum.spheres[i].center_mm));
    found.push_back(center);
  }
  const auto base = fit::rigid_registration(nominal, found);
  if (!base) return core::fail(base.error().at(kDatumPointer));
  if (base->largest_residual_mm > datum.residual_limit_um * core::kMicrometre) {
    return core::fail(
        core::Code::kCalibration,
        fmt::format(
            "the spheres of the fixture fit their nominal places to {:.3f} um, the limit is "
            "{:g} um (residual_limit_um); check their certified centres and that none is "
            "loose",
            base->largest_residual_mm / core::kMicrometre, datum.residual_limit_um),
        kDatumPointer);
  }
  return *base;
}

core::Result<void> find_fixture_base(RunContext& context) {
  TRY(auto steps, datum_steps(context.plan));
  if (steps.empty()) return {};
  TRY(const auto tips, touch_spheres(context, steps, "sphere of the fixture"));
  TRY(const auto base, fixture_base(context.plan, tips));
  context.cell->set_base(base.motion);
  const core::Message found = base_message(base);
  if (context.recorded.has_decision(found)) return {};
  return context.journal.add(record::Decision{-1, context.cell->machine().time_s(), found});
}

}  // namespace rondure::plans
