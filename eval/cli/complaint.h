// Exit codes, and the one-line error message.
#pragma once

#include <exception>
#include <string>

namespace depthgrid::cli {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadInput = 2;

// Prints the message as one line, whatever it contains. Returns the exit code.
int Complain(const std::string& message, int exit_code);
// Reports an exception of a command; returns the exit code for it.
int ComplainOf(const std::exception& error);

}  // namespace depthgrid::cli
