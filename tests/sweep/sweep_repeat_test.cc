// A sweep's runs done again by the page's command, and sweeps that were killed before they began.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "eval/sweep/sweep_database.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

class SweepRepeat : public ProgramTest {
 protected:
  // What `folder`'s metrics.json has under each of the sweep's names is what the sweep's row has.
  void ExpectScoresOfRow(const std::string& folder, const SweepResults& results,
                         std::size_t row) const {
    const auto metrics = nlohmann::json::parse(ReadFile(Path(folder + "/metrics.json")));
    int compared = 0;
    for (const SweepColumn& column : results.metrics) {
      std::string pointer = "/" + column.name;
      std::replace(pointer.begin(), pointer.end(), '.', '/');
      const auto& value = metrics[nlohmann::json::json_pointer(pointer)];
      if (value.is_null()) continue;
      EXPECT_EQ(value.get<double>(), column.values[row]) << column.name;
      ++compared;
    }
    EXPECT_GT(compared, 40);
  }
  // Row by row what the axes say, put behind the experiment.yaml that lies beside the page.
  void ExpectEachRunCanBeRepeated(const std::string& sweep) const {
    const SweepResults results = ReadSweep(Path(sweep));
    for (std::size_t row = 0; row < results.rows(); ++row) {
      std::string command = "run " + sweep + "/experiment.yaml";
      for (const SweepParameter& axis : results.parameters) {
        command += " --set " + axis.key + "=" + axis.texts[row];
      }
      const std::string folder = sweep + "_again" + std::to_string(row);
      Succeed(command + " -o " + folder);
      ExpectScoresOfRow(folder, results, row);
    }
  }
  // The two files of its folder, taken elsewhere, make the sweep again: no other place, no other
  // sweep. Names of files on an axis are whole then.
  void ExpectSweepCanBeRepeated(const std::string& sweep) const {
    const std::string elsewhere = "taken_from_" + sweep;
    std::filesystem::create_directory(Path(elsewhere));
    for (const std::string file : {"/experiment.yaml", "/sweep_again.yaml"}) {
      std::filesystem::copy_file(Path(sweep + file), Path(elsewhere + file));
    }
    Succeed("sweep " + elsewhere + "/sweep_again.yaml -o " + elsewhere + "/out");
    const SweepResults there = ReadSweep(Path(sweep));
    const SweepResults here = ReadSweep(Path(elsewhere + "/out"));
    ASSERT_EQ(here.rows(), there.rows());
    EXPECT_EQ(here.environment.at("experiment"), there.environment.at("experiment"));
    EXPECT_EQ(here.environment.at("given"), there.environment.at("given"));
    for (std::size_t axis = 0; axis < there.parameters.size(); ++axis) {
      EXPECT_EQ(here.parameters[axis].key, there.parameters[axis].key);
      if (IsFileKey(there.parameters[axis].key)) continue;
      EXPECT_EQ(here.parameters[axis].texts, there.parameters[axis].texts);
    }
    ASSERT_EQ(here.metrics.size(), there.metrics.size());
    for (std::size_t metric = 0; metric < there.metrics.size(); ++metric) {
      for (std::size_t row = 0; row < there.rows(); ++row) {
        EXPECT_THAT(here.metrics[metric].values[row],
                    ::testing::NanSensitiveDoubleEq(there.metrics[metric].values[row]))
            << there.metrics[metric].name;
      }
    }
    EXPECT_EQ(ReadFile(Path(elsewhere + "/out/sweep_again.yaml")),
              ReadFile(Path(sweep + "/sweep_again.yaml")));
  }
};

// The experiment beside the sweep's file, in the working folder.
TEST_F(SweepRepeat, WithFilesOnAnAxisAndNamesWithoutAFolder) {
  Write("rooms.yaml", "experiment: small.yaml\naxes: {scene: [room.yaml, ./room2.yaml]}\n");
  Write("room2.yaml", kRoom);
  Succeed("sweep rooms.yaml -o out");
  EXPECT_EQ(ReadSweep(Path("out")).environment.at("files_from") + "/", Path(""));
  ExpectSweepCanBeRepeated("out");
}

// What a profile or a scenario presets is not to be held by what the sweep's base had of it.
TEST_F(SweepRepeat, AlongAPreset) {
  Write("profiles.yaml", R"(
experiment: ./small.yaml
set: {slam.drift_scale: 3}
axes:
  slam.profile: [ground_truth, orb_slam2, planar_slam]
)");
  Succeed("sweep ./profiles.yaml -o out");
  ExpectEachRunCanBeRepeated("out");
  ExpectSweepCanBeRepeated("out");
  Write("scenarios.yaml", R"(
experiment: ./small.yaml
set: {slam.loops.max_distance_m: 2, slam.loops.max_angle_deg: 90, slam.loops.min_gap_s: 0.1}
axes:
  slam.loops.scenario: [none, "true", late]
)");
  Succeed("sweep ./scenarios.yaml -o loops");
  ExpectEachRunCanBeRepeated("loops");
}

TEST_F(SweepRepeat, OfEveryKindOfAxis) {
  Write("zip.yaml", R"(
experiment: ./small.yaml
mode: zip
axes:
  "slam.profile, slam.drift_scale": [[orb_slam2, 48.4], [planar_slam, 37.5]]
  mapper.fusion.gain: [[1, 0.5, 0], 0.25]
  seed: {seeds: 2, first: 7}
)");
  Succeed("sweep ./zip.yaml -o zip");
  ExpectSweepCanBeRepeated("zip");
  Write("random.yaml", R"(
experiment: ./small.yaml
mode: random
samples: 3
sample_seed: 5
stop: {metric: trajectory.est.mean_euclidean_m, width: 9, min_seeds: 2}
axes:
  slam.drift_scale: {from: 0.1, to: 10, scale: log}
  mapper.fusion.gain: {from: 0, to: 1}
  seed: {seeds: 3}
)");
  Succeed("sweep ./random.yaml -o random");
  ExpectSweepCanBeRepeated("random");
}

// A key that has the preset's value makes another sweep where the preset is on an axis.
TEST_F(SweepRepeat, GivenKeysAreOfTheSweep) {
  Write("profiles.yaml",
        "experiment: ./small.yaml\naxes: {slam.profile: [orb_slam2, planar_slam]}\n");
  Succeed("sweep ./profiles.yaml --set slam.drift_scale=48.4 -o out");
  const Outcome other = Program("sweep ./profiles.yaml -o out");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(
      other.err,
      "depthgrid: out: holds a sweep with other keys given: 'slam.drift_scale: 48.4' there, '' "
      "here; choose another folder, or remove this one\n");
  Succeed("sweep ./profiles.yaml --set slam.drift_scale=48.40 -o out");
}

TEST_F(SweepRepeat, TheScaleOfARangeIsOfTheSweep) {
  const auto write = [&](const std::string& scale) {
    Write("random.yaml",
          "experiment: ./small.yaml\nmode: random\nsamples: 2\n"
          "axes: {slam.drift_scale: {from: 0.1, to: 10" +
              scale + "}}\n");
  };
  write("");
  Succeed("sweep ./random.yaml -o out");
  write(", scale: log");
  const Outcome other = Program("sweep ./random.yaml -o out");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("'  slam.drift_scale: 0.1 to 10' there, "
                                   "'  slam.drift_scale: 0.1 to 10, log' here"));
}

// A p-value of thousands of pairs, or a score, can be too small for a double in full.
TEST_F(SweepRepeat, ThePageTakesTheSmallestNumbers) {
  std::filesystem::create_directory(Path("out"));
  SweepDatabase::Create(Path("out"), {{"title", "small"}}, {"mapper.fusion.gain"}, {{0, 0, {"1"}}})
      .Record({0, "", {{"map.chamfer_m", 1e-310}}, {}});
  Succeed("report out");
  EXPECT_THAT(ReadFile(Path("out/report.html")), HasSubstr("\"mean\":[1e-310]"));
}

TEST_F(SweepRepeat, KilledWhileItsPlanIsWrittenItGoesOn) {
  std::filesystem::create_directory(Path("out"));
  for (const char* left : {".lock", "results.sqlite.partial", "results.sqlite.partial-journal"}) {
    Write(std::string("out/") + left, "");
  }
  Write("gains.yaml", "experiment: ./small.yaml\naxes: {mapper.fusion.gain: [0, 1]}\n");
  Succeed("sweep ./gains.yaml -o out");
  EXPECT_EQ(ReadSweep(Path("out")).rows(), 2U);
  for (const std::string& file : FilesIn("out")) EXPECT_THAT(file, Not(HasSubstr("partial")));
}

TEST_F(SweepRepeat, PartsAreJoinedByOneProgramAtATime) {
  Write("gains.yaml", "experiment: ./small.yaml\naxes: {mapper.fusion.gain: [0, 1]}\n");
  Succeed("sweep ./gains.yaml --shard 1/1 -o part");
  std::filesystem::create_directory(Path("joined"));
  Write("joined/.lock", "");
  const int lock = ::open(Path("joined/.lock").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  const Outcome second = Program("sweep --merge part -o joined");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_EQ(second.err, "depthgrid: joined: another program is working on this sweep\n");
  ::close(lock);
  Succeed("sweep --merge part -o joined");
}

// As a kill after the database, before the table, leaves them.
TEST_F(SweepRepeat, JoinedAgainTheTableIsWrittenAgain) {
  Write("gains.yaml", "experiment: ./small.yaml\naxes: {mapper.fusion.gain: [0, 1]}\n");
  Succeed("sweep ./gains.yaml --shard 1/2 -o part1");
  Succeed("sweep ./gains.yaml --shard 2/2 -o part2");
  Succeed("sweep --merge part1 part2 -o joined");
  const std::string table = ReadFile(Path("joined/results.csv"));
  const std::string page = ReadFile(Path("joined/report.html"));
  std::filesystem::remove(Path("joined/results.csv"));
  std::filesystem::remove(Path("joined/report.html"));
  Succeed("sweep --merge part2 part1 -o joined");
  EXPECT_EQ(ReadFile(Path("joined/results.csv")), table);
  EXPECT_EQ(ReadFile(Path("joined/report.html")), page);

  // The same sweep done anew has other times.
  Succeed("sweep ./gains.yaml -o whole");
  const std::string before = ReadFile(Path("whole/results.csv"));
  const Outcome other = Program("sweep --merge part1 part2 -o whole");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err,
            "depthgrid: whole: holds a sweep already, which is not the whole of these parts\n");
  EXPECT_EQ(ReadFile(Path("whole/results.csv")), before);
}

TEST_F(SweepRepeat, APartMustSayWhichItIs) {
  Write("gains.yaml", "experiment: ./small.yaml\naxes: {mapper.fusion.gain: [0, 1]}\n");
  Succeed("sweep ./gains.yaml --shard 1/1 -o part");
  for (const char* shard : {"1/x", "one", "2/1", "0/1", ""}) {
    SweepDatabase::Open(Path("part")).Note("shard", shard);
    const Outcome outcome = Program("sweep --merge part -o joined");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.err, std::string("depthgrid: part: its `shard` is '") + shard +
                               "', must be I/N with I from 1 to N\n");
  }
  std::filesystem::create_directory(Path("bare"));
  SweepDatabase::Create(Path("bare"), {}, {"seed"}, {{0, 0, {"1"}}}).Record({0, "", {}, {}});
  const Outcome outcome = Program("sweep --merge bare -o joined");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err,
            "depthgrid: bare: does not say which part it is: its `shard` is missing, must be I/N "
            "with I from 1 to N\n");
  EXPECT_FALSE(std::filesystem::exists(Path("joined")));
}

TEST_F(SweepRepeat, JoiningTakesNoOptionsOfARun) {
  Write("gains.yaml", "experiment: ./small.yaml\naxes: {mapper.fusion.gain: [0, 1]}\n");
  Succeed("sweep ./gains.yaml --shard 1/1 -o part");
  for (const std::string option :
       {"--dry-run", "--shard 1/2", "--set frames=3", "--executor slurm", "--jobs 2",
        "--slurm-tasks 2", "--slurm-options x", "--cache x", "--no-cache"}) {
    const Outcome refused = Program("sweep --merge part -o joined " + option);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.err, "depthgrid: " + option.substr(0, option.find(' ')) +
                               ": has no meaning with --merge, which runs nothing\n");
    EXPECT_FALSE(std::filesystem::exists(Path("joined")));
  }
}

}  // namespace
}  // namespace depthgrid
