#pragma once

#include <string>
#include <string_view>

#include "cmm/ipp_client/session.h"
#include "core/error.h"

namespace rondure::cmm::ipp::client {

/// Whether an error only means that the server refused a request or could not fulfil it (arguments,
/// unknown tool, no contact, target out of limits). The machine itself is in order, so the client
/// may clear the error with ClearAllErrors(). Every other error requires a person.
[[nodiscard]] bool is_refusal(const ErrorReport& report);

/// Whether an error means that the tip touched something during a move. The error is cleared so
/// that the server reports the position of the tip; nothing moves before a person has checked.
[[nodiscard]] bool is_contact(const ErrorReport& report);

/// Whether an error means that the server does not know a command, argument or property.
[[nodiscard]] bool is_unknown_here(const ErrorReport& report);

/// Converts the failure of a transaction to an error of the program: kNoTouch, kCollision,
/// kUnreachable, kPoseRange, kStopped, otherwise kMachine. Its text contains the message of the
/// machine and the remedy.
/// @param doing  The action, e.g. "the move to (1, 2, 3) mm".
[[nodiscard]] core::Error error_of(const Failure& failure, std::string_view doing);

}  // namespace rondure::cmm::ipp::client
