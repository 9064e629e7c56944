#pragma once

#include <string>
#include <string_view>

#include "cmm/ipp_client/session.h"
#include "core/error.h"

namespace rondure::cmm::ipp::client {

/// Whether an error only says that the server did not accept or could not fulfil what was asked
/// (arguments, unknown tool, no contact, target out of limits): nothing is wrong with the machine,
/// so that the client may take the error back with ClearAllErrors() by itself. Everything else
/// waits until a person has looked.
[[nodiscard]] bool is_refusal(const ErrorReport& report);

/// Whether an error says that the tip met something in a move. The server's error is taken back, so
/// that it tells where the tip stands; nothing moves before a person has looked.
[[nodiscard]] bool is_contact(const ErrorReport& report);

/// Whether an error says that the server does not know a command, argument or property at all.
[[nodiscard]] bool is_unknown_here(const ErrorReport& report);

/// The failure of a transaction as the rest of the program knows errors: kNoTouch, kCollision,
/// kUnreachable, kPoseRange, kStopped, else kMachine. Its text holds what the machine said and what
/// to do.
/// @param doing  What was tried, e.g. "the move to (1, 2, 3) mm".
[[nodiscard]] core::Error error_of(const Failure& failure, std::string_view doing);

}  // namespace rondure::cmm::ipp::client
