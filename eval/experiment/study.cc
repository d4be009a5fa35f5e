#include "eval/experiment/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "eval/experiment/camera_doubts.h"
#include "eval/experiment/idle_settings.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr double kLargestErrorM = 1000.0;
const std::vector<std::string> kHeadKeys = {"title", "headings"};
const std::vector<std::string> kCaseHeadKeys = {"name", "published_mean_m"};

struct StudyHead {
  std::string title;
  StudyHeadings headings;
  void Visit(OptionsVisitor& v) {
    v.Text("title", title, "of the page");
    v.Group("headings", headings, "of its parts");
  }
};

struct CaseHead {
  std::string name;
  double published_mean_m = 0.0;
  void Visit(OptionsVisitor& v) {
    v.Text("name", name, "of the case's folder");
    v.Number("published_mean_m", published_mean_m, {0.0, kLargestErrorM},
             "mean Euclidean error as published; 0 is none");
  }
};

struct NoteText {
  StudyNote note;
  void Visit(OptionsVisitor& v) {
    v.Text("title", note.title, "of the paragraph");
    v.Text("text", note.text, "plain text");
  }
};

// A copy without these of the top-level keys.
Config Without(const Config& config, const std::vector<std::string>& keys) {
  std::vector<std::string> kept;
  for (const std::string& key : config.Keys()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) kept.push_back(key);
  }
  return config.Only(kept);
}

StudyCase CaseOf(const Config& entry) {
  CaseHead head;
  entry.Only(kCaseHeadKeys).Read(head);
  // The name is used as a folder name.
  const bool plain = std::all_of(head.name.begin(), head.name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  if (head.name.empty() || !plain) {
    throw InputError(entry.Place(), "name of a case is '" + head.name +
                                        "', must be of letters, digits, '_' and '-'");
  }
  StudyCase study_case{head.name, std::nullopt};
  if (head.published_mean_m > 0.0) study_case.published_mean_m = head.published_mean_m;
  return study_case;
}

void WarnOfRepeats(Study& study) {
  std::map<std::string, std::string> known;
  for (std::size_t i = 0; i < study.experiments.size(); ++i) {
    const std::string& name = study.outline.cases[i].name;
    const auto [entry, is_new] =
        known.emplace(ToYaml(WithoutIdleSettings(study.experiments[i])), name);
    if (is_new) continue;
    study.warnings.push_back(fmt::format("case {}: is the same as case {}", name, entry->second));
  }
}

void WarnOfCameras(Study& study) {
  std::set<std::string> known;  // usually all cases have the same camera
  for (std::size_t i = 0; i < study.experiments.size(); ++i) {
    for (const std::string& doubt : DoubtsOfCamera(study.experiments[i].sensor)) {
      if (!known.insert(doubt).second) continue;
      study.warnings.push_back(fmt::format("case {}: {}", study.outline.cases[i].name, doubt));
    }
  }
}

// Warns of a case's own keys that are idle in it, and of shared keys that are idle in every case.
void WarnOfIdle(const Config& shared, const std::vector<Config>& cases, const Config& overrides,
                Study& study) {
  Study alone;  // without the overrides
  const auto is_overridden = [&](const std::string& key) { return overrides.Has(key); };
  const auto add = [&](const Config& file, const IdleSettingList& idle,
                       const ExperimentOptions& options, const IsOverridden& overridden) {
    const auto doubts = DoubtsOfFile(
        file, idle, [&] { return options; }, overridden);
    study.warnings.insert(study.warnings.end(), doubts.begin(), doubts.end());
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Config own = Without(cases[i], kCaseHeadKeys);
    alone.experiments.emplace_back();
    shared.Read(alone.experiments.back());
    own.Read(alone.experiments.back());
    add(own, IdleSettings(study.experiments[i]), alone.experiments.back(), is_overridden);
  }
  const IdleSettingList everywhere = InBoth(IdleInEveryCase(study), IdleInEveryCase(alone));
  add(shared, everywhere, alone.experiments.front(), is_overridden);
}

// `config`: the file without its notes and cases, which are passed separately because copies would
// not know their lines.
StudyOutline OutlineOf(const Config& config, const std::vector<Config>& notes,
                       const std::vector<Config>& cases) {
  StudyOutline outline;
  StudyHead head;
  config.Only(kHeadKeys).Read(head);
  outline.title = head.title;
  outline.headings = head.headings;
  for (const Config& entry : notes) {
    NoteText text;
    entry.Read(text);
    outline.notes.push_back(text.note);
  }
  for (const Config& entry : cases) {
    const StudyCase next = CaseOf(entry);
    for (const StudyCase& other : outline.cases) {
      if (other.name == next.name) {
        throw InputError(entry.Place(), "name '" + next.name + "' is given twice");
      }
    }
    outline.cases.push_back(next);
  }
  if (outline.cases.empty()) throw InputError(config.Place(), "'cases' must name at least one");
  return outline;
}

}  // namespace

void StudyHeadings::Visit(OptionsVisitor& v) {
  v.Text("table", table, "over the errors of the trajectories");
  v.Text("maps", maps, "over the maps");
  v.Text("paths", paths, "over the paths");
  v.Text("notes", notes, "over the notes");
  v.Text("published", published, "over the published figures in the table");
}

IdleSettingList IdleInEveryCase(const Study& study) {
  IdleSettingList idle;
  for (const ExperimentOptions& options : study.experiments) {
    const IdleSettingList here = IdleSettings(options);
    idle = &options == &study.experiments.front() ? here : InBoth(idle, here);
  }
  return idle;
}

bool IsStudy(const Config& config) { return config.Has("cases"); }

StudyOutline ReadStudyOutline(Config config) {
  const std::vector<Config> notes = config.TakeMaps("notes");
  const std::vector<Config> cases = config.TakeMaps("cases");
  return OutlineOf(config, notes, cases);
}

Study ReadStudy(Config config, const Config& overrides, const std::string& base_folder) {
  Study study;
  const std::vector<Config> notes = config.TakeMaps("notes");
  const std::vector<Config> cases = config.TakeMaps("cases");
  study.outline = OutlineOf(config, notes, cases);
  const Config shared = Without(config, kHeadKeys);
  for (const Config& entry : cases) {
    const Config own = Without(entry, kCaseHeadKeys);
    study.experiments.push_back(ReadExperiment({&shared, &own, &overrides}, base_folder));
    RequireSound(study.experiments.back(), {&shared, &own, &overrides});
  }
  WarnOfIdle(shared, cases, overrides, study);
  WarnOfRepeats(study);
  WarnOfCameras(study);
  return study;
}

}  // namespace depthgrid
