// What --force may write, replace and remove: neither what the command reads nor what no earlier
// command of its kind wrote.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAreArray;

class KeptFiles : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("one.log", "FLASER 3 2 2 2 1.5 -2 0.25 1.5 -2 0.25 10.5 host 10.5\n");
  }

  // One line that says this, exit code 2, and every file of the test as it was.
  void ExpectRefusal(const std::string& arguments, const std::string& says) const {
    const std::vector<std::string> before = Contents();
    const Outcome outcome = Program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("depthgrid: " + says)) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(Contents() == before) << arguments;
  }
  std::vector<std::string> Contents() const {
    std::vector<std::string> contents;
    for (const std::string& file : FilesIn(".")) contents.push_back(file + ReadFile(Path(file)));
    return contents;
  }
  void MakeFolder(const std::string& name, const std::vector<std::string>& files) const {
    fs::create_directories(Path(name));
    for (const std::string& file : files) Write(name + "/" + file, "mine");
  }
};

constexpr const char* kIsOfNoResult =
    ": belongs to no depthgrid result there, and --force would overwrite it; choose another folder";
constexpr const char* kIsRead = ": is read by this command, and ";

TEST_F(KeptFiles, AMapInTheFolderOfItsInputsKeepsThem) {
  Succeed("render ./small.yaml --set frames=4 --no-colour -o s");
  Succeed("slam s -o s --force");
  const std::vector<std::string> inputs = FilesIn("s");
  ASSERT_THAT(inputs, Contains("loops.csv"));
  ASSERT_THAT(inputs, Contains("truth_map.pgm"));
  const std::string map = "map s --poses s/slam.txt --loops s/loops.csv -o s --force";
  Succeed(map);
  std::vector<std::string> expected = FilesIn("s");
  Succeed(map);
  EXPECT_EQ(FilesIn("s"), expected);
  for (const std::string& file : inputs) EXPECT_THAT(expected, Contains(file));
}

TEST_F(KeptFiles, AMapTakesAwayNothingThatNoMapWrites) {
  Succeed("map one.log -o m");
  const std::vector<std::string> own = FilesIn("m");
  const std::vector<std::string> others = {"truth_map.yaml", "observable.pgm",
                                           "loops.csv",      "metrics.json",
                                           "input_map.pgm",  "trajectory_truth.txt"};
  MakeFolder("m", others);
  Write("m/matched.bin", "of a map with a camera");
  Succeed("map one.log -o m --force");
  std::vector<std::string> expected = own;
  expected.insert(expected.end(), others.begin(), others.end());
  EXPECT_THAT(FilesIn("m"), UnorderedElementsAreArray(expected));
  // Nor does it take a run.yaml that no command wrote for the mark of a run.
  Write("m/run.yaml", "scene: ./room.yaml\n");
  ExpectRefusal("map one.log -o m --force", "m/frames.csv" + std::string(kIsOfNoResult));
}

// Names of a result's files are no mark of one.
TEST_F(KeptFiles, AUsersOwnFileIsNotReplaced) {
  MakeFolder("mine", {"notes", "loops.csv"});
  Succeed("map one.log -o mine --force");
  EXPECT_EQ(ReadFile(Path("mine/loops.csv")), "mine");
  ExpectRefusal("run ./small.yaml -o mine --force", "mine/loops.csv" + std::string(kIsOfNoResult));
  for (const std::string file :
       {"map.pgm", "warnings.txt", "run.yaml", "frames/000000_depth.png"}) {
    const std::string folder = "of_" + file.substr(0, 3);
    fs::create_directories(Path(folder + "/frames"));
    Write(folder + "/" + file, "mine");
    ExpectRefusal("map one.log -o " + folder + " --force", folder + "/" + file + kIsOfNoResult);
    ExpectRefusal("run ./small.yaml -o " + folder + " --force",
                  folder + "/" + file + kIsOfNoResult);
  }
}

TEST_F(KeptFiles, NorByAStudyOrItsCases) {
  Write("cases.yaml", "frames: 3\ncases: [{name: a, scene: ./room.yaml}]\n");
  const std::string study = "run ./cases.yaml --force -o ";
  for (const std::string file : {"metrics.json", "report.html", "study.yaml", "overrides.txt",
                                 "a/map.yaml", "a/loops.csv", "a/frames/000000_depth.png"}) {
    std::string folder = "of_" + file;
    std::replace(folder.begin(), folder.end(), '/', '_');
    fs::create_directories(Path(folder + "/a/frames"));
    Write(folder + "/" + file, "mine");
    ExpectRefusal(study + folder, folder + "/" + file + kIsOfNoResult);
  }
  Succeed("run ./small.yaml --set frames=3 -o w/a");
  ExpectRefusal(study + "w", "w/a: holds a run that is no case of a study there; choose another");
  // What a user puts beside a study's files is his, in a new case's place too.
  Succeed(study + "out");
  Write("two.yaml",
        "frames: 3\ncases: [{name: a, scene: ./room.yaml}, {name: b, scene: "
        "./room.yaml, seed: 2}]\n");
  MakeFolder("out/b", {"map.pgm"});
  ExpectRefusal("run ./two.yaml --force -o out", std::string("out/b/map.pgm") + kIsOfNoResult);
  Succeed(study + "out");
  EXPECT_EQ(ReadFile(Path("out/b/map.pgm")), "mine");
}

TEST_F(KeptFiles, NorByImagesPosesOrAnAblation) {
  Succeed("render ./small.yaml --set frames=2 --no-colour -o seq");
  const auto refused = [&](const std::string& command, const std::string& file) {
    const std::string folder = "of_" + file;
    MakeFolder(folder, {file});
    ExpectRefusal(command + " --force -o " + folder, folder + "/" + file + kIsOfNoResult);
  };
  for (const std::string file : {"camera.yaml", "groundtruth.txt", "render.yaml"}) {
    refused("render ./small.yaml --no-colour", file);
  }
  for (const std::string file : {"slam.txt", "slam.yaml", "loops.csv"}) refused("slam seq", file);
  refused("ablate ./small.yaml", "ablation.csv");
  refused("ablate ./small.yaml", "experiment.yaml");
  for (int times = 0; times < 2; ++times) {
    Succeed("slam seq -o poses --force");
    Succeed("ablate ./small.yaml --set frames=3 --seeds 1 -o ablated --force");
  }
}

TEST_F(KeptFiles, AnInputIsNeitherOverwrittenNorRemoved) {
  Succeed("render ./small.yaml --set frames=4 --no-colour -o seq");
  Succeed("run ./small.yaml --set frames=4 -o m");
  fs::create_symlink("m/trajectory_est.txt", Path("link.txt"));
  const auto refused = [&](const std::string& command, const std::string& file) {
    ExpectRefusal(command + " -o m --force",
                  file + kIsRead + "-o m would overwrite or remove it; choose another folder");
  };
  refused("map seq --poses m/trajectory_est.txt", "m/trajectory_est.txt");
  refused("map seq --poses link.txt", "link.txt");
  refused("map seq --poses seq/groundtruth.txt --final-poses m/trajectory_est.txt",
          "m/trajectory_est.txt");
  refused("map seq --poses seq/groundtruth.txt --loops m/loops.csv", "m/loops.csv");
  refused("map m/frames", "m/frames/000000_colour.png");
  refused("map one.log --map m", "m/run.yaml");
  refused("map one.log --map m/. --localise", "m/./run.yaml");
  refused("run m/run.yaml", "m/run.yaml");
  fs::copy_file(Path("one.log"), Path("m/warnings.txt"), fs::copy_options::overwrite_existing);
  refused("map m/warnings.txt", "m/warnings.txt");
  refused("run ./small.yaml --set trajectory=./m/trajectory_truth.txt",
          Path("m/trajectory_truth.txt"));
  ExpectRefusal("render ./small.yaml --set trajectory=./seq/groundtruth.txt -o seq --force",
                Path("seq/groundtruth.txt") + kIsRead);
  ExpectRefusal("render seq/render.yaml -o seq --force", std::string("seq/render.yaml") + kIsRead);
  // It may be read from where it stays.
  Succeed("map seq --poses seq/groundtruth.txt -o seq --force");
}

// Both are called truth_map.pgm, and stand beside images or an estimate of their own room.
TEST_F(KeptFiles, ATrueMapIsNotReplacedByThatOfAnotherResult) {
  Succeed("render ./small.yaml --set frames=2 --no-colour -o seq");
  Succeed("run ./small.yaml --set frames=2 -o r");
  const std::string says = ", whose true map would be replaced; choose another folder\n";
  ExpectRefusal("run ./small.yaml --set frames=2 -o seq --force",
                "seq: holds a rendered sequence" + says);
  ExpectRefusal("render ./small.yaml --set frames=2 --no-colour -o r --force",
                "r: holds a run" + says);
  Succeed("run ./small.yaml --set frames=2 -o r --force");
  Succeed("render ./small.yaml --set frames=2 --no-colour -o seq --force");
}

TEST_F(KeptFiles, ASingleFileIsNoInputEither) {
  Write("gt.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  fs::create_symlink("gt.txt", Path("link.txt"));
  for (const std::string file : {"gt.txt", "./gt.txt", "link.txt"}) {
    ExpectRefusal("eval trajectory gt.txt gt.txt --force --errors " + file,
                  std::string("gt.txt") + kIsRead + "--errors " + file +
                      " would overwrite it; choose another name");
  }
  // Neither is a device, such as /dev/stdout, nor where a link points to.
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  fs::create_symlink("nowhere.csv", Path("dangling.csv"));
  for (const std::string file : {"pipe", "dangling.csv"}) {
    ExpectRefusal("eval trajectory gt.txt gt.txt --force --errors " + file,
                  file + ": is no regular file, and would be replaced by one; choose another name");
  }
  Write("log.mp4", ReadFile(Path("one.log")));
  ExpectRefusal("map log.mp4 --video log.mp4 -o out --force",
                std::string("log.mp4") + kIsRead + "--video log.mp4 would overwrite it");
}

TEST_F(KeptFiles, AFolderHoldsOneResultWithAPage) {
  MakeFolder("study", {"study.yaml", "report.html"});
  MakeFolder("ablation", {"ablation.json", "ablation.csv", "report.html"});
  MakeFolder("sweep", {"results.sqlite", "report.html"});
  Succeed("map one.log -o run");
  Write("cases.yaml", "cases: [{name: a, scene: ./room.yaml, frames: 3}]\n");
  Write("s.yaml", "experiment: ./small.yaml\naxes: {seed: [1]}\n");
  const auto refused = [&](const std::string& command, const std::string& folder,
                           const std::string& what) {
    ExpectRefusal(command + " -o " + folder + " --force",
                  folder + ": holds " + what + "; choose another folder");
  };
  for (const std::string command :
       {"map one.log", "run ./small.yaml", "render ./small.yaml", "ablate ./small.yaml"}) {
    refused(command, "study", "a study");
    refused(command, "sweep", "a sweep");
    if (command != "ablate ./small.yaml") refused(command, "ablation", "an ablation");
  }
  for (const std::string command : {"run ./cases.yaml", "sweep ./s.yaml"}) {
    refused(command, "ablation", "an ablation");
    refused(command, "run", "a run");
  }
  refused("ablate ./small.yaml", "run", "a run");
  refused("sweep ./s.yaml", "study", "a study");
  Succeed("map one.log -o other");
  refused("report other", "run", "a run");
  refused("report other", "sweep", "a sweep");
  const std::string page = ReadFile(Path("other/report.html"));
  fs::remove(Path("other/report.html"));
  Succeed("report other -o ./other");
  EXPECT_EQ(ReadFile(Path("other/report.html")), page);
}

TEST_F(KeptFiles, AFolderInTheWayOfAFileIsSaidBeforeTheWork) {
  fs::create_directories(Path("m/map.yaml"));
  Write("m/map.yaml/mine", "mine");
  ExpectRefusal("map one.log -o m --force", "m/map.yaml: is a folder, and a file of that name");
  MakeFolder("r", {"frames"});
  ExpectRefusal("run ./small.yaml -o r --force", "r/frames: is a file, and a folder of that name");
}

// What a link leads to is no part of the output.
TEST_F(KeptFiles, NothingIsWrittenThroughALinkedFolder) {
  MakeFolder("elsewhere", {"000000_colour.png", "run.yaml", "depth.png"});
  const auto linked = [&](const std::string& link) {
    fs::create_directories(Path(link).substr(0, Path(link).rfind('/')));
    fs::create_directory_symlink(Path("elsewhere"), Path(link));
    return link + ": is a link, and a folder of that name is to be written; choose another";
  };
  Succeed("render ./small.yaml --set frames=2 -o seq");
  fs::rename(Path("seq/rgb"), Path("elsewhere/rgb"));
  fs::create_directory_symlink(Path("elsewhere/rgb"), Path("seq/rgb"));
  ExpectRefusal("render ./small.yaml --set frames=2 -o seq --force", "seq/rgb: is a link, and a");
  ExpectRefusal("run ./small.yaml -o r --force", linked("r/frames"));
  ExpectRefusal("map one.log -o m --force", linked("m/frames"));
  Write("cases.yaml", "cases: [{name: a, scene: ./room.yaml, frames: 3}]\n");
  ExpectRefusal("run ./cases.yaml -o study --force", linked("study/a"));
  ExpectRefusal("run ./cases.yaml -o deep --force", linked("deep/a/frames"));
  // Of another name it stays, and the folder itself may be one.
  linked("mine/album");
  Succeed("map one.log -o mine --force");
  EXPECT_TRUE(fs::is_symlink(Path("mine/album")));
  fs::create_directory_symlink(Path("mine"), Path("link"));
  Succeed("map one.log -o link --force");
}

TEST_F(KeptFiles, AStudyGoesOnInItsOwnFolder) {
  const std::string head = "frames: 3\ncases:\n  - {name: a, scene: ./room.yaml}\n";
  Write("one.yaml", head);
  Write("two.yaml", head + "  - {name: b, scene: ./room.yaml, seed: 2}\n");
  Succeed("run ./one.yaml -o fresh");
  Succeed("run ./two.yaml -o out");
  MakeFolder("out/mine", {"map.pgm"});
  Succeed("run ./one.yaml -o out --force");
  std::vector<std::string> expected = FilesIn("fresh");
  expected.emplace_back("mine/map.pgm");
  EXPECT_THAT(FilesIn("out"), UnorderedElementsAreArray(expected));
  EXPECT_FALSE(fs::exists(Path("out/b")));
}

TEST_F(KeptFiles, ARenderTakesTheEarlierOnesImagesAway) {
  Succeed("render ./small.yaml --set frames=2 -o fresh");
  Succeed("render ./small.yaml -o images");
  MakeFolder("images", {"notes.txt", "depth/mine.png", "rgb/9.500000.png"});
  Succeed("render ./small.yaml --set frames=2 -o images --force");
  std::vector<std::string> expected = FilesIn("fresh");
  expected.insert(expected.end(), {"notes.txt", "depth/mine.png", "rgb/9.500000.png"});
  EXPECT_THAT(FilesIn("images"), UnorderedElementsAreArray(expected));
  fs::remove(Path("images/rgb/9.500000.png"));
  Succeed("render ./small.yaml --set frames=2 --no-colour -o images --force");
  EXPECT_THAT(FilesIn("images"), Not(Contains("rgb.txt")));
  EXPECT_FALSE(fs::exists(Path("images/rgb")));
}

TEST_F(KeptFiles, ARenderKeepsTheImagesOfNoRender) {
  Succeed("render ./small.yaml --set frames=4 -o images");
  // A list to which somebody added an image; a folder that render did not write.
  Write("images/rgb.txt", ReadFile(Path("images/rgb.txt")) + "7.5 rgb/7.png\n");
  Write("images/rgb/7.png", "mine");
  Succeed("render ./small.yaml --set frames=2 --no-colour -o images --force");
  EXPECT_THAT(FilesIn("images"), Contains("rgb.txt"));
  EXPECT_EQ(ReadFile(Path("images/rgb/7.png")), "mine");
  // A folder that render did not write is not written into, whatever the frames' stamps.
  MakeFolder("tum", {"depth.txt"});
  const std::string render = "render ./small.yaml --set frames=2 --no-colour -o tum --force";
  ExpectRefusal(render, std::string("tum/depth.txt") + kIsOfNoResult);
  fs::remove(Path("tum/depth.txt"));
  MakeFolder("tum/depth", {"5.000000.png", "mine.png"});
  ExpectRefusal(render, std::string("tum/depth/5.000000.png") + kIsOfNoResult);
  fs::remove(Path("tum/depth/5.000000.png"));
  Succeed(render);
  EXPECT_EQ(ReadFile(Path("tum/depth/mine.png")), "mine");
}

TEST_F(KeptFiles, ASweepTakesNoNameThatIsTaken) {
  Write("s.yaml", "experiment: ./small.yaml\nset: {frames: 3}\naxes: {seed: [1]}\n");
  for (const std::string name : {"results.csv", "report.html", "experiment.yaml",
                                 "sweep_again.yaml", "progress.txt", "cache", "slurm"}) {
    MakeFolder(name + "_", {name});
    ExpectRefusal(
        "sweep ./s.yaml -o " + name + "_ --force",
        name + "_/" + name + ": is there already and belongs to no sweep; choose another folder");
  }
  MakeFolder("mine", {"notes.txt"});
  Succeed("sweep ./s.yaml -o mine --force");
  Succeed("sweep ./s.yaml -o mine");  // its own names
}

TEST_F(KeptFiles, ASweepRemovesNothingFromItsCacheThatIsAUsers) {
  Write("s.yaml", "experiment: ./small.yaml\nset: {frames: 3}\naxes: {seed: [1]}\n");
  Succeed("sweep ./s.yaml -o out");
  EXPECT_FALSE(fs::exists(Path("out/cache")));
  const std::string hex = "0123456789abcdef";
  fs::create_directories(Path("disk/scans"));
  fs::create_directories(Path("disk/" + hex));
  for (const std::string& own :
       {"scans/" + hex + ".scans", "scans/" + hex + ".scans.12.0.tmp",
        hex + "/" + hex + "-incidence.depth", hex + "/" + hex + ".depth.12-34"}) {
    Write("disk/" + own, "");
  }
  Write("disk/notes", "mine");
  Write("disk/scans/mine.scans", "mine");
  fs::create_directory_symlink("../disk", Path("out/cache"));
  Succeed("sweep ./s.yaml -o out");
  EXPECT_TRUE(fs::is_symlink(Path("out/cache")));
  EXPECT_THAT(FilesIn("disk"), ElementsAre("notes", "scans/mine.scans"));
  EXPECT_FALSE(fs::exists(Path("disk/" + hex)));
}

TEST_F(KeptFiles, RegridReplacesTheImageOfAnotherMode) {
  Succeed("map one.log -o m");
  const auto drawn = [&](const std::string& mode) {
    Succeed("regrid m --resolution 0.02 --force --map-mode " + mode);
    std::vector<std::string> files = FilesIn("m");
    std::erase_if(files, [](const std::string& file) { return !file.starts_with("map_"); });
    return files;
  };
  EXPECT_THAT(drawn("raw"), ElementsAre("map_0.02.pgm", "map_0.02.yaml"));
  EXPECT_THAT(drawn("scale"), ElementsAre("map_0.02.scale.png", "map_0.02.yaml"));
  EXPECT_THAT(drawn("trinary"), ElementsAre("map_0.02.pgm", "map_0.02.yaml"));
  // An image that the map does not name is somebody else's.
  Write("m/map_0.02.scale.png", "mine");
  EXPECT_THAT(drawn("trinary"), ElementsAre("map_0.02.pgm", "map_0.02.scale.png", "map_0.02.yaml"));
}

TEST_F(KeptFiles, RegridReplacesAMapWithForceOnly) {
  Succeed("map one.log -o m");
  for (const char* name : {"m/map_0.02.yaml", "m/map_0.04.pgm", "m/map_0.06.scale.png"}) {
    Write(name, "mine");
  }
  ExpectRefusal("regrid m --resolution 0.02", "m/map_0.02.yaml: is there already");
  ExpectRefusal("regrid m --resolution 0.04", "m/map_0.04.pgm: is there already");
  ExpectRefusal("regrid m --resolution 0.06 --map-mode scale", "m/map_0.06.scale.png: is there");
  EXPECT_EQ(ReadFile(Path("m/map_0.04.pgm")), "mine");
  Succeed("regrid m --resolution 0.02 --force");
}

TEST_F(KeptFiles, ReportReplacesNothingButAPage) {
  Succeed("map one.log -o m");
  Succeed("report m");
  Write("m/report.html", "<title>my notes on depthgrid</title>");
  ExpectRefusal("report m", "m/report.html: is not a page of depthgrid's");
  EXPECT_EQ(ReadFile(Path("m/report.html")), "<title>my notes on depthgrid</title>");
  fs::remove(Path("m/report.html"));
  fs::create_symlink("../elsewhere.html", Path("m/report.html"));
  ExpectRefusal("report m", "m/report.html: is a link, so it is kept");
  EXPECT_TRUE(fs::is_symlink(Path("m/report.html")));
}

}  // namespace
}  // namespace depthgrid
