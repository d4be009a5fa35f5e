// A study: several experiments side by side, with published results.
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
  // Published mean Euclidean error of the trajectory, if any.
  std::optional<double> published_mean_m;
};

// A note for the comparison with published results.
struct StudyNote {
  std::string title;
  std::string text;
};

// Headings on the page: a study of a paper names the paper's tables and figures that the parts
// correspond to.
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
  std::vector<StudyCase> cases;  // at least one; names are distinct
};

struct Study {
  StudyOutline outline;
  std::vector<ExperimentOptions> experiments;  // one per case
  std::vector<std::string> overrides;          // as given on the command line, for the page
  std::vector<std::string> warnings;           // one line each
};

// Settings without effect in any case.
IdleSettingList IdleInEveryCase(const Study& study);

bool IsStudy(const Config& config);

// Does not read the experiments' keys. Throws InputError.
StudyOutline ReadStudyOutline(Config config);

// A case's keys override those at the top of the file, and `overrides` both. Throws InputError.
Study ReadStudy(Config config, const Config& overrides, const std::string& base_folder);

}  // namespace depthgrid
