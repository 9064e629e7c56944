// Included by an instrumented copy of the sources alone (see README.md): the switch of its faults.
#pragma once

#include <atomic>
#include <cerrno>
#include <concepts>
#include <cstdio>
#include <cstdlib>
#include <string>

// Internal to every unit: some units are compiled for processors that a machine may not have, and
// the linker would keep one copy of an inline function for all.
namespace {

/// With RONDURE_FAULT_TRACE=DIR: makes an empty file there, which says that this test reaches this
/// fault.
[[maybe_unused]] void rondure_trace(int number) {
  static const char* const dir = std::getenv("RONDURE_FAULT_TRACE");
  static const char* const test = std::getenv("RONDURE_FAULT_TEST");
  static std::atomic<bool> told[10000];
  if (dir == nullptr || test == nullptr || told[number]) return;
  const int was = errno;
  std::string name = std::to_string(number) + " " + std::string(test).substr(0, 240);
  for (char& letter : name) letter = letter == '/' ? '|' : letter;
  if (std::FILE* file = std::fopen((dir + ("/" + name)).c_str(), "ae")) {
    told[number] = true;
    std::fclose(file);
  }
  errno = was;
}

/// Whether the environment asks for this fault: RONDURE_FAULT=17.
[[maybe_unused]] bool rondure_fault(int number) {
  rondure_trace(number);
  static const int active = [] {
    const char* asked = std::getenv("RONDURE_FAULT");
    return asked == nullptr ? 0 : std::atoi(asked);
  }();
  return active == number;
}

template <typename T>
concept RondureNumber = std::integral<T> || std::floating_point<T>;

/// The number, negated by the fault.
template <RondureNumber T>
[[maybe_unused]] auto rondure_signed(int number, T value) {
  return rondure_fault(number) ? -value : +value;
}

/// A matrix or an expression of Eigen, negated by the fault; refers to what `value` refers to.
template <typename T>
requires requires { typename T::PlainObject; }
[[maybe_unused]] auto rondure_signed(int number, const T& value) {
  return value * (rondure_fault(number) ? -1.0 : 1.0);
}

/// The first argument, or by the fault the other one. It compiles where both are of one type.
template <typename T>
[[maybe_unused]] const T& rondure_pick(int number, const T& own, const T& other) {
  return rondure_fault(number) ? other : own;
}

}  // namespace
