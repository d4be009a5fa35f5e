// File names of each kind of result: to recognise a result's folder, and to know which files a
// command will write and which an earlier one left.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace depthgrid {

// kPage: a report page in another folder than its result.
enum class ResultKind { kRun, kMap, kStudy, kAblation, kSweep, kRender, kSlam, kPage };

// Selects files of a folder by their paths relative to it.
using FileRule = std::function<bool(const std::filesystem::path& relative)>;

// What a mark says is replaced (eval/files/one_result.h). A map takes a run's place, and a run a
// map's.
const char* MarkOf(ResultKind kind);

// The files that a result of this kind may have, without those of `regrid`. Sweeps handle their own
// files (eval/sweep).
FileRule FilesOf(ResultKind kind);

// The files of an earlier result of this kind in the folder, which must not be mixed with a new
// one. None if the folder has no such result: then files with these names are the user's.
FileRule FilesLeftBy(ResultKind kind, const std::string& folder);

// Throws InputError when such a result would overwrite a file that no depthgrid result in the
// folder can have written, and when a study's case would replace a run that is not part of a study.
// `cases`: of a study.
void RequireOwnFiles(const std::string& folder, ResultKind kind,
                     const std::vector<std::string>& cases = {});

// Throws InputError when the folder has entries that such a result cannot replace: a folder in
// place of a file, a file in place of a folder, or a link in place of a folder, whose target is not
// part of the output. `cases`: of a study.
void RequireNamesFree(const std::string& folder, ResultKind kind,
                      const std::vector<std::string>& cases = {});

// Throws InputError when the folder has a result of another kind with a report.html, which would be
// overwritten. Only runs may share a folder with images and poses, except rendered ones, because
// both have a true map.
void RequireNoOtherResult(const std::string& folder, ResultKind kind);

}  // namespace depthgrid
