#include "eval/sweep/slurm.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <thread>

#include "eval/files/shell_word.h"
#include "eval/sweep/sweep_progress.h"
#include "mapper/io/end_task.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// The parts' folders are read again after a wait that doubles from the first to the longest of
// these, so that the end of a short sweep is seen at once and hundreds of folders on a network's
// disk are not read all the time.
constexpr std::chrono::milliseconds kFirstWait{50};
constexpr std::chrono::milliseconds kLongestWait{2000};
// Slurm's controller, which serves the whole site, is not asked more often; so parts that end at
// once are not submitted more often either.
constexpr std::chrono::seconds kBetweenQueries{2};
constexpr std::chrono::minutes kLongestSilence{5};  // enough to restart Slurm's controller
constexpr int kMostFruitlessStarts = 3;

struct CommandOutput {
  bool succeeded = false;
  std::string text;  // standard output and error
};

CommandOutput OutputOf(const std::string& command) {
  CommandOutput output;
  FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.text.append(buffer.data(), count);
  }
  output.succeeded = ::pclose(pipe) == 0;
  return output;
}

// What sbatch --parsable prints, "ID" or "ID;CLUSTER", among lines of a site's plugins.
std::optional<std::string> JobIdIn(const std::string& text) {
  std::optional<std::string> id;
  for (const TextRow& row : SplitRows(text)) {
    if (row.fields.size() != 1) continue;
    const std::string_view word = row.fields[0].substr(0, row.fields[0].find(';'));
    if (ParseNumber(word)) id = std::string(word);
  }
  return id;
}

std::string JobList(const std::string& folder) { return folder + "/slurm/jobs.txt"; }

// Queries Slurm's queue; tolerates temporary failures.
class Queue {
 public:
  // Parts of these jobs that are queued or running. Empty when squeue fails temporarily, and within
  // kBetweenQueries after the last query.
  std::optional<std::set<int>> Parts(const std::set<std::string>& job_ids);

 private:
  std::optional<std::chrono::steady_clock::time_point> asked_;
  std::optional<std::chrono::steady_clock::time_point> answered_;
};

std::optional<std::set<int>> Queue::Parts(const std::set<std::string>& job_ids) {
  const auto now = std::chrono::steady_clock::now();
  if (asked_ && now - *asked_ < kBetweenQueries) return std::nullopt;
  asked_ = now;
  // One line per task: job id of the array and index in it. Completing tasks count as ended.
  const CommandOutput queue = OutputOf(
      "squeue --noheader --array --me --states=PENDING,RUNNING,CONFIGURING,SUSPENDED "
      "--format='%F %K'");
  if (!queue.succeeded) {
    if (answered_ && now - *answered_ < kLongestSilence) return std::nullopt;
    throw std::runtime_error("squeue failed: " + queue.text);
  }
  answered_ = now;
  std::set<int> parts;
  for (const TextRow& row : SplitRows(queue.text)) {
    if (row.fields.size() != 2 || !job_ids.contains(std::string(row.fields[0]))) continue;
    if (const auto part = ParseNumber(row.fields[1])) parts.insert(static_cast<int>(*part));
  }
  return parts;
}

class Submission {
 public:
  explicit Submission(const SlurmJob& job) : job_(job), folder_(job.folder + "/slurm") {
    fs::create_directories(folder_);
    fs::create_directories(job.folder + "/shards");
    WriteFile(Script(), fmt::format("#!/bin/sh\n"
                                    "#SBATCH --cpus-per-task={}\n"
                                    "exec {}\n",
                                    job.cpus_per_task, job.command));
    // Jobs submitted by an earlier, killed process may still be running.
    if (HasSlurmJobs(job.folder)) {
      const std::string text = ReadFile(JobList(job.folder));
      for (const TextRow& row : SplitRows(text)) job_ids_.emplace(row.fields[0]);
    }
  }

  void Submit(const std::set<int>& parts) {
    const EndDelay whole;  // a job missing from the list would be submitted again
    // Names are given on the command line because #SBATCH lines in the script end at a space.
    const CommandOutput sbatch =
        OutputOf(fmt::format("sbatch --parsable --array={} --job-name={} --output={} {} {}",
                             ArrayText(parts), ShellWord("depthgrid-" + job_.title),
                             ShellWord(LogPattern()), job_.options, ShellWord(Script())));
    const std::optional<std::string> id = JobIdIn(sbatch.text);
    if (!sbatch.succeeded || !id) throw std::runtime_error("sbatch refused: " + sbatch.text);
    job_ids_.insert(*id);
    std::string list;
    for (const std::string& known : job_ids_) list += known + "\n";
    WriteFile(JobList(job_.folder), list);
  }

  const std::set<std::string>& job_ids() const { return job_ids_; }
  const std::string& folder() const { return folder_; }

 private:
  std::string Script() const { return folder_ + "/job.sh"; }
  // %A is the array's job id, %a the index in it; percent signs in the folder's name are escaped.
  std::string LogPattern() const {
    std::string pattern;
    for (const char c : folder_) pattern += c == '%' ? "%%" : std::string(1, c);
    return pattern + "/%A_%a.log";
  }

  const SlurmJob& job_;
  std::string folder_;
  std::set<std::string> job_ids_;
};

// Progress as read from the parts' folders.
struct State {
  SweepProgress sum;
  std::set<int> unfinished;
  std::map<int, int> done;  // runs of each part
};

State StateOf(const SlurmJob& job) {
  State state;
  for (int part = 1; part <= job.parts; ++part) {
    const auto progress = ReadProgress(PartFolder(job.folder, part));
    if (progress) {
      state.sum.done += progress->done;
      state.sum.total += progress->total;
      state.done[part] = progress->done;
    }
    if (!progress || !progress->Finished()) state.unfinished.insert(part);
  }
  return state;
}

// Counts the starts of each part since it last got on.
class Starts {
 public:
  // Counts another start of a part with this many finished runs; false if it is one too many.
  bool MayStart(int part, int done) {
    const bool got_on = done > done_at_start_[part];
    fruitless_[part] = got_on ? 1 : fruitless_[part] + 1;
    done_at_start_[part] = done;
    return fruitless_[part] <= kMostFruitlessStarts;
  }

 private:
  std::map<int, int> fruitless_;
  std::map<int, int> done_at_start_;
};

}  // namespace

std::string PartFolder(const std::string& folder, int part) {
  return fmt::format("{}/shards/{}", folder, part);
}

bool HasSlurmJobs(const std::string& folder) { return fs::exists(JobList(folder)); }

std::string ArrayText(const std::set<int>& parts) {
  std::string text;
  for (auto first = parts.begin(); first != parts.end();) {
    auto last = first;
    while (std::next(last) != parts.end() && *std::next(last) == *last + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", *first);
    if (last != first) text += fmt::format("-{}", *last);
    first = std::next(last);
  }
  return text;
}

void RunOnSlurm(const SlurmJob& job) {
  Submission submission(job);
  Queue queue;
  Starts starts;
  auto wait = kFirstWait;
  for (State state = StateOf(job); !state.unfinished.empty(); state = StateOf(job)) {
    if (const auto queued = queue.Parts(submission.job_ids())) {
      // Read the folders again: a part may have finished before squeue was called.
      std::set<int> ended = StateOf(job).unfinished;
      for (const int part : *queued) ended.erase(part);
      for (const int part : ended) {
        if (starts.MayStart(part, state.done[part])) continue;
        throw std::runtime_error(
            fmt::format("part {} ended {} times without a result; see {}/*_{}.log", part,
                        kMostFruitlessStarts, submission.folder(), part));
      }
      if (!ended.empty()) submission.Submit(ended);
    }
    job.progress(state.sum.done, state.sum.total);
    std::this_thread::sleep_for(wait);
    wait = std::min(2 * wait, kLongestWait);
  }
}

}  // namespace depthgrid
