#include "eval/study/ablation_report.h"

#include <fmt/format.h>

#include <filesystem>

#include "eval/experiment/changed_settings.h"
#include "eval/files/json_text_impl.h"
#include "eval/files/run_files.h"
#include "eval/report/report_json_impl.h"
#include "eval/report/web_assets.h"
#include "eval/study/ablation.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using Json = ReportJson;

Json PageJson(const Json& ablation, const std::string& settings, const Config& config) {
  Json json;
  json["of"] = MeasuredSettings(config, {"seed"}, ablation.value("scene", ""));
  json["changed"] = fmt::format("{}", fmt::join(ChangedSettings(config), ", "));
  json["seeds"] = ablation.at("seeds");
  json["scores"] = ablation.at("scores");
  json["stages"] = Json::array();
  for (const AblationVariant& variant : AblationVariants()) {
    if (variant.against.empty()) continue;
    json["stages"].push_back(
        {{"name", variant.name}, {"meaning", variant.meaning}, {"against", variant.against}});
  }
  json["settings"] = settings;
  return json;
}

}  // namespace

bool IsAblationFolder(const std::string& folder) { return fs::exists(folder + "/ablation.json"); }

void WriteAblationReport(const std::string& folder, const ReportPlace& place) {
  const std::string path = folder + "/ablation.json";
  const std::string settings = ReadFile(folder + "/experiment.yaml");
  const Config config = Config::FromText(settings, folder + "/experiment.yaml");
  try {
    const Json ablation = Json::parse(ReadFile(path));
    const std::string file = fs::path(SettingOf(config, "scene")).stem().string();
    const std::string scene = ablation.value("scene", file);  // earlier versions have no name
    WriteFile(place.into + "/report.html",
              FillPage("ablation.html", "Ablation of " + scene,
                       JsonText(PageJson(ablation, settings, config))));
  } catch (const Json::exception&) {
    throw InputError(path, "is no ablation's result");
  }
}

}  // namespace depthgrid
