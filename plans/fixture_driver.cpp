#include "plans/fixture_driver.h"

#include "plans/plan_reach.h"
#include "plans/thorlabs_driver.h"

namespace rondure::plans {
namespace {

core::Result<std::unique_ptr<fixture::Fixture>> open_manual(const FixturePlan& plan,
                                                            const CellOptions& options) {
  if (options.set_by_hand) {
    return std::make_unique<fixture::ManualFixture>(limits_of(plan), options.set_by_hand);
  }
  return core::fail(core::Code::kBadOption,
                    "the fixture is set by hand, and there is nobody to ask; run it from a "
                    "terminal",
                    "/fixture/driver");
}

}  // namespace

bool drives_fixture(const Plan& plan) {
  const std::string& driver = plan.fixture->driver;
  return driver == "thorlabs" || (driver == "manual" && plan.machine->driver != "simulated");
}

core::Result<std::unique_ptr<fixture::Fixture>> open_fixture(const FixturePlan& plan,
                                                             const CellOptions& options) {
  if (plan.driver == "thorlabs") return open_thorlabs(plan);
  return open_manual(plan, options);
}

}  // namespace rondure::plans
