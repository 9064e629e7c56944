#include "plans/cell/internal/open_cell.h"

#include <utility>

#include <fmt/format.h>

#include "plans/analyses/features.h"
#include "plans/cell/internal/fixture_driver.h"
#include "plans/cell/internal/ipp_cell.h"
#include "plans/cell/simulated_cell.h"

namespace rondure::plans {

core::Result<void> check_abilities(const Plan& plan, const cmm::Capabilities& machine) {
  if (machine.scans_circles) return {};
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const FeaturePlan& feature = plan.features[i];
    if (!is_touched(feature) || feature.sampling.method != record::SamplingMethod::kScan) continue;
    return core::fail(
        core::Code::kMachine,
        fmt::format("feature {} is to be scanned, and the machine, {}, does not scan circles{}; "
                    "give \"method\": \"touch\", or take a machine that scans; nothing has moved",
                    feature.id, machine.name,
                    machine.no_scans.empty() ? "" : fmt::format(" ({})", machine.no_scans)),
        fmt::format("/features/{}/sampling/method", i));
  }
  return {};
}

core::Result<std::unique_ptr<Cell>> open_cell(const Plan& plan, const CellOptions& options) {
  std::unique_ptr<fixture::Fixture> driven;
  if (drives_fixture(plan)) {
    TRY(driven, open_fixture(*plan.fixture, options));
  }
  if (plan.machine->driver != MachinePlan::Driver::kIppdme) {
    return std::make_unique<SimulatedCell>(plan, options.seed, options.resumed, std::move(driven));
  }
  auto cell = IppCell::open(plan, options, std::move(driven));
  if (!cell) return cell;
  TRY_DO(check_abilities(plan, (*cell)->machine().capabilities()));
  return cell;
}

}  // namespace rondure::plans
