#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/compare/sweep_report.h"
#include "eval/files/one_result.h"
#include "eval/output/output_file.h"
#include "eval/output/output_folder.h"
#include "eval/output/result_files.h"
#include "eval/report/run_report.h"
#include "eval/study/ablation_report.h"
#include "eval/study/study_report.h"
#include "eval/sweep/sweep_database.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

void WriteReport(const std::string& folder, const ReportPlace& place) {
  if (SweepDatabase::Exists(folder)) {
    WriteSweepReport(folder, place);
  } else if (IsStudyFolder(folder)) {
    WriteStudyReport(folder, place);
  } else if (IsAblationFolder(folder)) {
    WriteAblationReport(folder, place);
  } else {
    WriteRunReport(folder, place);
  }
}

// The end of every page's title (eval/web).
constexpr std::string_view kEndOfTitle = " - depthgrid</title>";

// Only a report page may be overwritten; any other report.html may be the user's only copy.
void RequireNoneButAPage(const std::string& path) {
  if (!fs::exists(path)) return;
  if (ReadFile(path).find(kEndOfTitle) == std::string::npos) {
    throw InputError(
        path, "is not a page of depthgrid's, so it is kept; -o names another folder for the page");
  }
}

// The page's other files may overwrite only those of an earlier page.
void RequireNoneButItsFiles(const std::string& folder, const fs::path& written) {
  const std::string page = folder + "/report.html";
  const std::string text = fs::exists(page) ? ReadFile(page) : "";
  for (const auto& entry : fs::directory_iterator(written)) {
    const std::string name = entry.path().filename().string();
    const std::string path = folder + "/" + name;
    if (name == "report.html" || !fs::exists(path)) continue;
    if (text.find(name) == std::string::npos) {
      throw InputError(path, "belongs to no page there, so it is kept; choose another folder");
    }
  }
}

// Rejects links, which would themselves be replaced by files.
void RequireNoLinks(const std::string& folder) {
  const FileRule is_of_page = FilesOf(ResultKind::kPage);
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    if (!entry.is_symlink() || !is_of_page(entry.path().filename())) continue;
    throw InputError(folder + "/" + entry.path().filename().string(),
                     "is a link, so it is kept; -o names another folder for the page");
  }
}

void WriteInPlace(const std::string& folder) {
  RequireWritable(folder, "; -o names another folder for the page");
  RequireNoLinks(folder);
  RequireNoneButAPage(folder + "/report.html");
  WriteReport(folder, {folder});
}

void WriteElsewhere(const ReportArguments& arguments) {
  RequireReachable(arguments.output);
  RequireNoOtherResult(arguments.output, ResultKind::kPage);
  RequireNamesFree(arguments.output, ResultKind::kPage);
  RequireNoLinks(arguments.output);
  RequireNoneButAPage(arguments.output + "/report.html");
  OutputFolder output(arguments.output, arguments.force, {}, MarkOf(ResultKind::kPage));
  const auto plain = [](const std::string& path) { return fs::absolute(path).lexically_normal(); };
  const fs::path back = plain(arguments.folder).lexically_relative(plain(arguments.output));
  WriteReport(arguments.folder, {output.work().string(), back.string() + "/"});
  RequireNoneButItsFiles(arguments.output, output.work());
  output.Commit();
}

}  // namespace

void Report(const ReportArguments& arguments) {
  if (!fs::is_directory(arguments.folder)) {
    throw InputError(arguments.folder, fs::exists(arguments.folder)
                                           ? "is a file, must be the folder of a result"
                                           : "no such folder");
  }
  RequireOneResult(arguments.folder);
  std::error_code not_there;
  if (arguments.output.empty() || fs::equivalent(arguments.folder, arguments.output, not_there)) {
    if (arguments.force) {
      Warn({"--force: has no effect because the page goes into the result's own folder"});
    }
    WriteInPlace(arguments.folder);
  } else {
    WriteElsewhere(arguments);
  }
  SayReport(arguments.output.empty() ? arguments.folder : arguments.output);
}

}  // namespace depthgrid::cli
