// How the program ends: exit codes, and the one line that says why.
#pragma once

#include <exception>
#include <string>

namespace depthgrid::cli {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadInput = 2;

// Prints one line, whatever the message holds. Returns the exit code.
int Complain(const std::string& message, int exit_code);
// Of what a command threw, with the exit code that belongs to it.
int ComplainOf(const std::exception& error);

}  // namespace depthgrid::cli
