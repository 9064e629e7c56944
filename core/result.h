#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

#include "core/error.h"

namespace rondure::core {

/// A value, or the reason why there is none. Whatever points, plans or hardware can cause travels
/// this way; asserts are for bugs.
template <class T>
using Result = tl::expected<T, Error>;

/// Shorthand for returning an error from a function that gives a Result.
[[nodiscard]] inline tl::unexpected<Error> fail(Code code, std::string what,
                                                std::string where = {}) {
  return tl::unexpected<Error>(Error{code, std::move(what), std::move(where)});
}

/// Hands an error on unchanged.
[[nodiscard]] inline tl::unexpected<Error> fail(Error error) {
  return tl::unexpected<Error>(std::move(error));
}

/// Shorthand for a fault of a machine, of a fixture or of the line to it (kMachine).
[[nodiscard]] inline tl::unexpected<Error> machine_fault(std::string what) {
  return fail(Code::kMachine, std::move(what));
}

}  // namespace rondure::core
