// The files of each kind of result, by their names: whose a folder is, what a command is about to
// write there and what an earlier one left.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace depthgrid {

// kPage: a result's page away from the result.
enum class ResultKind { kRun, kMap, kStudy, kAblation, kSweep, kRender, kSlam, kPage };

// Of files of a folder, by their paths relative to it.
using FileRule = std::function<bool(const std::filesystem::path& relative)>;

// What a result of this kind may have; what `regrid` draws is no part of it. A sweep's files are
// its own business (eval/sweep).
FileRule FilesOf(ResultKind kind);

// What an earlier result of this kind left in the folder and a new one shall not be mixed with.
// Nothing when the folder holds none: files of such names are somebody else's.
FileRule FilesLeftBy(ResultKind kind, const std::string& folder);

// Throws InputError when the folder has a file that such a result would overwrite and that no
// result of depthgrid there can have written: a user's own; also when a case of a study would take
// the place of a run that is none. `cases`: of a study.
void RequireOwnFiles(const std::string& folder, ResultKind kind,
                     const std::vector<std::string>& cases = {});

// Throws InputError when what lies there cannot be replaced by such a result: a folder where one of
// its files goes, or the other way round, or a link where a folder goes: what it links to is no
// part of the output. `cases`: of a study.
void RequireNamesFree(const std::string& folder, ResultKind kind,
                      const std::vector<std::string>& cases = {});

// Throws InputError when the folder holds a result of another kind with a report.html of its own:
// one of the two pages would take the other's place. Only a run is let in beside images and poses,
// and none beside rendered ones, whose true map it would replace, or the other way round.
void RequireNoOtherResult(const std::string& folder, ResultKind kind);

}  // namespace depthgrid
