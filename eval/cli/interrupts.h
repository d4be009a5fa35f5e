// Handles Ctrl-C, `kill` and a closed terminal. The next progress report throws, so that partial
// output is removed during unwinding. If there is no report for a moment, the program is ended at
// once, after running all EndTasks (mapper/io/end_task.h).
#pragma once

#include <optional>
#include <string>

namespace depthgrid::cli {

void CatchInterrupts();
void ThrowIfInterrupted();
// A result that is already complete, such as "the run is in out"; reported when the program is
// interrupted.
void NoteResult(const std::string& what);
// The message of an interrupted program.
std::string InterruptText();
// 128 + the signal's number, as in shells; empty without a signal.
std::optional<int> InterruptExitCode();

}  // namespace depthgrid::cli
