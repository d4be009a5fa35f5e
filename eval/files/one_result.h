// Marks a folder while a command replaces the result in it: if the command does not come to the
// end, the folder has files of both results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace depthgrid {

// Results that others are read beside in one folder. A mark says which one it is of.
inline constexpr const char* kMarkOfRender = "render";
inline constexpr const char* kMarkOfSlam = "slam";
inline constexpr const char* kMarkOfStudy = "study";

// Throws std::runtime_error when the folder cannot be written.
void MarkAsReplaced(const std::string& folder, const std::string& what);
// Leaves a mark of another result.
void UnmarkAsReplaced(const std::string& folder, const std::string& what);
bool IsMarkedAsReplaced(const std::string& folder, const std::string& what);
// For a folder without any result, whose marks say nothing.
void RemoveMarks(const std::string& folder);
// Whether a file is one with marks.
bool IsMark(const std::filesystem::path& file);

// Throws InputError when the folder is marked, or is that of a case of a marked study. `of`: marks
// of these results alone; empty: any.
void RequireOneResult(const std::string& folder, const std::vector<std::string>& of = {});
// The same for the folder that a file is in. An empty path is no file.
void RequireOneResultAround(const std::string& file, const std::vector<std::string>& of = {});

}  // namespace depthgrid
