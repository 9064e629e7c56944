#include "cmm/simulated/machine.h"
#include "machine_contract.h"

namespace rondure::cmm {

/// The simulated machine in this process.
class SimulatedRig {
 public:
  Machine& machine() { return machine_; }
  void place(bool inside) {
    machine_.place_part({kContractRadius_mm, 40.0, inside, {}}, Eigen::Isometry3d::Identity());
  }

 private:
  SimulatedMachine machine_{{}};
};

INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, MachineContract, SimulatedRig);

}  // namespace rondure::cmm
