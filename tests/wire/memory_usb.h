#pragma once

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include "wire/usb.h"

namespace rondure::wire {

/// State of a USB device in memory: it keeps the bytes sent to it and answers from a queue of
/// packets. An empty packet stands for a time limit that passes.
struct MemoryUsbState {
  UsbDeviceInfo info;
  std::vector<UsbInterface> interfaces;
  std::vector<UsbSetup> requests;
  std::vector<std::string> control_data;
  std::string sent;
  std::deque<std::string> packets;
  std::string reply_to_command;  ///< Packet sent after a control request with data.
  int stalls_at_request = -1;    ///< Request that stalls, counted from 0; -1: never.
  bool busy = false;
  bool gone = false;
  int resets = 0;
  int closes = 0;
};

class MemoryUsb final : public UsbDevice {
 public:
  /// @param state  Must outlive the device.
  explicit MemoryUsb(MemoryUsbState& state) : state_(state) {}

  const UsbDeviceInfo& info() const override { return state_.info; }
  const std::vector<UsbInterface>& interfaces() const override { return state_.interfaces; }
  UsbResult<void> configure(int) override { return {}; }
  UsbResult<void> reset() override {
    ++state_.resets;
    return {};
  }
  UsbResult<void> claim(int) override {
    if (state_.busy) return fail(UsbFault::Kind::kBusy, "it is in use");
    return {};
  }
  UsbResult<void> control_out(const UsbSetup& setup, std::string_view bytes, Limit) override {
    if (state_.gone) return fail(UsbFault::Kind::kUnplugged, "it was unplugged");
    if (static_cast<int>(state_.requests.size()) == state_.stalls_at_request) {
      return fail(UsbFault::Kind::kStall, "it refused the request");
    }
    state_.requests.push_back(setup);
    state_.control_data.emplace_back(bytes);
    if (!bytes.empty() && !state_.reply_to_command.empty()) {
      state_.packets.push_back(state_.reply_to_command);
    }
    return {};
  }
  UsbResult<std::string> control_in(const UsbSetup& setup, std::size_t, Limit) override {
    state_.requests.push_back(setup);
    return std::string("\1");
  }
  UsbResult<void> bulk_out(std::uint8_t, std::string_view bytes, Limit) override {
    if (state_.gone) return fail(UsbFault::Kind::kUnplugged, "it was unplugged");
    state_.sent += bytes;
    return {};
  }
  UsbResult<std::string> bulk_in(std::uint8_t, std::size_t most, Limit) override {
    return next(most);
  }
  UsbResult<std::string> interrupt_in(std::uint8_t, std::size_t most, Limit) override {
    return next(most);
  }
  void close() override { ++state_.closes; }

 private:
  static tl::unexpected<UsbFault> fail(UsbFault::Kind kind, std::string what) {
    return tl::unexpected(UsbFault{kind, std::move(what)});
  }
  UsbResult<std::string> next(std::size_t most) {
    if (state_.gone) return fail(UsbFault::Kind::kUnplugged, "it was unplugged");
    if (state_.packets.empty()) return std::string();
    std::string out = state_.packets.front().substr(0, most);
    state_.packets.front().erase(0, out.size());
    if (state_.packets.front().empty()) state_.packets.pop_front();
    return out;
  }

  MemoryUsbState& state_;
};

}  // namespace rondure::wire
