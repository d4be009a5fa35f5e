// A study: several experiments side by side, with the figures that others published for them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "eval/experiment/idle_settings.h"
#include "mapper/io/config.h"

namespace depthgrid {

struct StudyCase {
  std::string name;  // of the case's folder
  // Mean Euclidean error of the trajectory as published; nothing for a case without.
  std::optional<double> published_mean_m;
};

// Something a reader must know to compare with what was published.
struct StudyNote {
  std::string title;
  std::string text;
};

// What the page calls its parts: a study of a paper's own says which of its tables and figures they
// stand against.
struct StudyHeadings {
  std::string table = "Errors of the trajectories";
  std::string maps = "Maps";
  std::string paths = "Trajectories";
  std::string notes = "Notes";
  std::string published = "published";  // the column of published figures

  void Visit(OptionsVisitor& v);
};

struct StudyOutline {
  std::string title;
  StudyHeadings headings;
  std::vector<StudyNote> notes;
  std::vector<StudyCase> cases;  // at least one; names differ
};

struct Study {
  StudyOutline outline;
  std::vector<ExperimentOptions> experiments;  // one a case
  std::vector<std::string> overrides;          // as given on the command line, for the page
  std::vector<std::string> warnings;           // what is likely not meant, a line each
};

// What has no effect in any case.
IdleSettingList IdleInEveryCase(const Study& study);

bool IsStudy(const Config& config);

// Without looking at the experiments' keys. Throws InputError.
StudyOutline ReadStudyOutline(Config config);

// A case's keys override those at the top of the file, and `overrides` both. Throws InputError.
Study ReadStudy(Config config, const Config& overrides, const std::string& base_folder);

}  // namespace depthgrid
