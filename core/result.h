#pragma once

#include <string>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "core/error.h"

namespace rondure::core {

/// A value, or the error that explains why there is none. Every failure that points, plans or
/// hardware can cause is returned as a Result; asserts are for bugs.
template <class T>
using Result = tl::expected<T, Error>;

/// Makes an error to return from a function that returns a Result.
[[nodiscard]] inline tl::unexpected<Error> fail(Code code, std::string what,
                                                std::string where = {}) {
  return tl::unexpected<Error>(Error{code, std::move(what), std::move(where)});
}

/// The same with a sentence made of a format and its arguments, as fmt::format() makes it.
template <class... Args>
[[nodiscard]] tl::unexpected<Error> fail_with(Code code, fmt::format_string<Args...> what,
                                              Args&&... args) {
  return fail(code, fmt::format(what, std::forward<Args>(args)...));
}

/// The same with a sentence that is data.
[[nodiscard]] inline tl::unexpected<Error> fail(Code code, Phrase said, std::string where = {}) {
  return tl::unexpected<Error>(error_of(code, std::move(said), std::move(where)));
}

/// Passes an error on unchanged.
[[nodiscard]] inline tl::unexpected<Error> fail(Error error) {
  return tl::unexpected<Error>(std::move(error));
}

/// Makes the error for a fault of a machine, of a fixture or of the connection to it (kMachine).
[[nodiscard]] inline tl::unexpected<Error> machine_fault(std::string what) {
  return fail(Code::kMachine, std::move(what));
}
template <class... Args>
[[nodiscard]] tl::unexpected<Error> machine_fault(fmt::format_string<Args...> what,
                                                  Args&&... args) {
  return fail(Code::kMachine, fmt::format(what, std::forward<Args>(args)...));
}

}  // namespace rondure::core

#define RONDURE_JOIN_(a, b) a##b
#define RONDURE_JOIN(a, b) RONDURE_JOIN_(a, b)
#define RONDURE_TRY(result, declaration, ...)                    \
  auto result = (__VA_ARGS__);                                   \
  if (!result) return tl::unexpected(std::move(result).error()); \
  declaration = *std::move(result)

/// TRY(const auto table, read(file)); declares or assigns the value of a Result, or returns its
/// error from the function in which it stands.
#define TRY(declaration, ...) \
  RONDURE_TRY(RONDURE_JOIN(tried_, __COUNTER__), declaration, __VA_ARGS__)

/// TRY_DO(check(table)); passes over a value, or returns the error likewise.
#define TRY_DO(...) \
  if (auto tried = (__VA_ARGS__); !tried) return tl::unexpected(std::move(tried).error())
