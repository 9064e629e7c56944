#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "cmm/ipp_server/backend.h"
#include "cmm/ipp_server/server.h"
#include "cmm/ipp_server/service.h"
#include "cmm/simulated/machine.h"
#include "wire/tcp_line.h"

namespace rondure::cmm {

/// Server backend of a simulated machine without a table.
class BareBackend final : public ipp::Backend {
 public:
  explicit BareBackend(const SimulatedMachineOptions& options = {}) : machine_(options) {}

  [[nodiscard]] SimulatedMachine& machine() override { return machine_; }
  [[nodiscard]] std::vector<double> table_angles_deg() const override { return {}; }
  [[nodiscard]] core::Result<void> home_table() override { return {}; }
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> align_part(
      std::span<const ipp::Alignment>) override {
    return core::fail(core::Code::kMachine, "there is no table");
  }
  [[nodiscard]] core::Result<void> choose_feature(int) override { return {}; }
  void set_next_turn(std::uint64_t) override {}

 private:
  SimulatedMachine machine_;
};

/// Serves a backend on a port of this computer, from a thread of its own, until it is destroyed.
class ServedMachine {
 public:
  explicit ServedMachine(ipp::Backend& backend, const ipp::ServerOptions& options = {})
      : listener_(*wire::TcpListener::open("127.0.0.1", 0)),
        port_(listener_.port()),
        thread_([this, &backend, options] {
          ipp::Server server(backend, options);
          (void)ipp::serve(listener_, server, {[this] { return ends_.load(); }, [](auto) {}, {}});
        }) {}
  ~ServedMachine() {
    ends_ = true;
    thread_.join();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  wire::TcpListener listener_;
  std::uint16_t port_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace rondure::cmm
