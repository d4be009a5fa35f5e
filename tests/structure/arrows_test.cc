// Reads every #include and fails on one that points the wrong way (docs/conventions.md, "Rooms").
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/paths.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// A room's name from a path below the source root: the longest listed prefix.
std::string RoomOf(const std::string& path) {
  static const std::vector<std::string> kRooms = {
      "mapper/core/",  "mapper/io/",       "mapper/",   "sim/",
      "eval/metrics/", "eval/statistics/", "eval/cli/", "eval/"};
  for (const auto& room : kRooms) {
    if (path.starts_with(room)) return room;
  }
  return "";
}

const std::map<std::string, std::set<std::string>>& Allowed() {
  static const std::map<std::string, std::set<std::string>> kAllowed = {
      {"mapper/core/", {"mapper/core/"}},
      {"mapper/io/", {"mapper/core/", "mapper/io/"}},
      {"mapper/", {"mapper/core/", "mapper/"}},
      {"sim/", {"mapper/core/", "mapper/io/", "sim/"}},
      {"eval/metrics/", {"mapper/core/", "eval/metrics/"}},
      {"eval/statistics/", {"mapper/core/", "eval/metrics/", "eval/statistics/"}},
      {"eval/",
       {"mapper/core/", "mapper/io/", "mapper/", "sim/", "eval/metrics/", "eval/statistics/",
        "eval/"}},
      {"eval/cli/",
       {"mapper/core/", "mapper/io/", "mapper/", "sim/", "eval/metrics/", "eval/statistics/",
        "eval/", "eval/cli/"}},
  };
  return kAllowed;
}

// The folders from the ground up: a file includes those of its own and of the ones below.
const std::vector<std::string>& Floors() {
  static const std::vector<std::string> kFloors = {
      "mapper/core", "mapper/io",       "mapper/scan",  "mapper/grid",  "mapper/match",
      "mapper/fuse", "mapper/surfel",   "mapper/graph", "mapper",       "sim/mesh",
      "sim/shapes",  "sim/path",        "sim/depth",    "sim/scene",    "sim/colour",
      "sim/laser",   "sim/slam",        "sim/truth",    "eval/metrics", "eval/statistics",
      "eval/files",  "eval/experiment", "eval/run",     "eval/doubts",  "eval/pictures",
      "eval/report", "eval/output",     "eval/study",   "eval/sweep",   "eval/compare",
      "eval/cli"};
  return kFloors;
}

// Counted from the ground; -1 of a folder that is none of them.
int FloorOf(const std::string& path) {
  const auto found = std::find(Floors().begin(), Floors().end(), fs::path(path).parent_path());
  return found == Floors().end() ? -1 : static_cast<int>(found - Floors().begin());
}

// Libraries that are wrapped once: their headers may appear in .cc files only, and in *_impl.h,
// which only .cc files include.
const std::vector<std::string>& HiddenLibraries() {
  static const std::vector<std::string> kHidden = {
      "embree3/",  "GL/",      "SQLiteCpp/", "sqlite3",    "ceres/", "assimp/",
      "yaml-cpp/", "opencv2/", "nlohmann/",  "Random123/", "png.h"};
  return kHidden;
}

struct Include {
  std::string path;
  bool quoted = false;
};

std::vector<Include> IncludesOf(const fs::path& file) {
  std::vector<Include> includes;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const auto hash = line.find("#include");
    if (hash == std::string::npos || line.find_first_not_of(" \t") != hash) continue;
    const auto open = line.find_first_of("\"<", hash);
    const auto close = line.find_first_of("\">", open + 1);
    if (open == std::string::npos || close == std::string::npos) continue;
    includes.push_back({line.substr(open + 1, close - open - 1), line[open] == '"'});
  }
  return includes;
}

// What is wrong with one include, or "".
std::string Fault(const std::string& file, const Include& include) {
  if (include.quoted) {
    const std::string room = RoomOf(file);
    const std::string target = RoomOf(include.path);
    if (target.empty()) return "includes are written from the source root";
    if (!Allowed().at(room).contains(target)) return room + " may not include " + target;
    if (FloorOf(file) < 0 || FloorOf(include.path) < 0) return "stands in no folder that is listed";
    if (FloorOf(include.path) > FloorOf(file)) return "includes what stands above it";
    if (file.ends_with(".h") && include.path.ends_with("_impl.h")) {
      return "only .cc files may include *_impl.h";
    }
    return "";
  }
  if (!file.ends_with(".h") || file.ends_with("_impl.h")) return "";
  for (const auto& library : HiddenLibraries()) {
    if (include.path.starts_with(library)) return "headers may not show " + library;
  }
  return "";
}

TEST(Arrows, EveryIncludePointsTheAllowedWay) {
  const fs::path root = kSourceFolder;
  int files = 0;
  int includes = 0;
  for (const std::string top : {"mapper", "sim", "eval"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cc") continue;
      ++files;
      const std::string file = fs::relative(entry.path(), root).string();
      for (const auto& include : IncludesOf(entry.path())) {
        ++includes;
        EXPECT_EQ(Fault(file, include), "") << file << " includes " << include.path;
      }
    }
  }
  EXPECT_GT(files, 20);
  EXPECT_GT(includes, 50);
}

TEST(Arrows, AWrongIncludeIsFound) {
  EXPECT_NE(Fault("mapper/core/a.h", {"mapper/io/b.h", true}), "");
  EXPECT_NE(Fault("mapper/io/a.cc", {"mapper/grid/b.h", true}), "");
  EXPECT_NE(Fault("mapper/grid/a.cc", {"mapper/io/b.h", true}), "");
  EXPECT_NE(Fault("mapper/match/a.cc", {"sim/b.h", true}), "");
  EXPECT_NE(Fault("eval/metrics/a.cc", {"mapper/grid/b.h", true}), "");
  EXPECT_NE(Fault("eval/run/a.cc", {"eval/cli/b.h", true}), "");
  EXPECT_NE(Fault("eval/run/a.cc", {"eval/report/b.h", true}), "");
  EXPECT_NE(Fault("mapper/fuse/a.h", {"mapper/surfel/b.h", true}), "");
  EXPECT_NE(Fault("sim/elsewhere/a.h", {"sim/mesh/b.h", true}), "");
  EXPECT_NE(Fault("sim/depth/a.h", {"embree3/rtcore.h", false}), "");
  EXPECT_NE(Fault("mapper/graph/a.h", {"ceres/ceres.h", false}), "");
  EXPECT_EQ(Fault("sim/depth/a.cc", {"embree3/rtcore.h", false}), "");
  EXPECT_EQ(Fault("eval/run/a.cc", {"sim/truth/b.h", true}), "");
  EXPECT_EQ(Fault("eval/report/a.cc", {"eval/run/b.h", true}), "");
}

TEST(Arrows, NoFileIsLongerThan400Lines) {
  const fs::path root = kSourceFolder;
  for (const std::string top : {"mapper", "sim", "eval", "tests", "bench"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cc") continue;
      std::ifstream stream(entry.path());
      int lines = 0;
      for (std::string line; std::getline(stream, line);) ++lines;
      EXPECT_LE(lines, 400) << entry.path() << " is to be divided by concept";
    }
  }
}

// Some lists are read by `./dev fuzz` alone, which nobody runs with each change.
TEST(Arrows, SourcesThatListsNameAreThere) {
  const fs::path root = kSourceFolder;
  const std::regex source(R"(\$\{CMAKE_SOURCE_DIR\}/([\w/.]+\.cc))");
  int named = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "tests")) {
    if (entry.path().filename() != "CMakeLists.txt") continue;
    std::ifstream stream(entry.path());
    for (std::string line; std::getline(stream, line);) {
      for (std::sregex_iterator match(line.begin(), line.end(), source), end; match != end;
           ++match) {
        ++named;
        EXPECT_TRUE(fs::exists(root / (*match)[1].str()))
            << entry.path() << " names " << (*match)[1];
      }
    }
  }
  EXPECT_GT(named, 0);
}

// The type that a line begins to define at a namespace's own level, nothing where it is a forward
// declaration or one of a specialisation.
std::string DefinedType(const std::string& line) {
  if (!line.starts_with("struct ") && !line.starts_with("class ")) return "";
  if (line.find(" {") == std::string::npos) return "";
  const std::size_t begin = line.find(' ') + 1;
  const std::size_t end = line.find(' ', begin);
  const std::string name = line.substr(begin, end - begin);
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0; })
             ? name
             : "";
}

// Two types of one name in one namespace share the instances of every template made with them
// (std::vector's, say): whichever the linker keeps is wrong for the other.
TEST(Names, NoTypeOfAHeaderSharesItsNameWithAnother) {
  const fs::path root = kSourceFolder;
  std::map<std::string, std::string> file_of_type;
  for (const std::string top : {"mapper", "sim", "eval"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() != ".h") continue;
      const std::string file = fs::relative(entry.path(), root).string();
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) {
        const std::string name = DefinedType(line);
        if (name.empty()) continue;
        const auto [known, is_new] = file_of_type.emplace(name, file);
        EXPECT_TRUE(is_new) << name << " in " << known->second << " and " << file;
      }
    }
  }
  EXPECT_GT(file_of_type.size(), 100U);
}

}  // namespace
}  // namespace depthgrid
