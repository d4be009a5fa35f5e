// Ctrl-C, `kill` and a closed terminal. The next progress report throws, so that half-written
// output is removed on the way out. A step that reports nothing for longer than a moment is ended
// where it is, after what EndTasks are to do (mapper/io/end_task.h).
#pragma once

#include <optional>
#include <string>

namespace depthgrid::cli {

void CatchInterrupts();
void ThrowIfInterrupted();
// What is there whatever comes, such as "the run is in out": said when the program is ended.
void NoteResult(const std::string& what);
// The line of a program that was ended.
std::string InterruptText();
// 128 and the signal's number, as shells count; nothing when no signal came.
std::optional<int> InterruptExitCode();

}  // namespace depthgrid::cli
