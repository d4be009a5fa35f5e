// What a page that is written again leaves as it is, and what it is of.
#include <gmock/gmock.h>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class KeptPages : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("one.log", "FLASER 3 2 2 2 1.5 -2 0.25 1.5 -2 0.25 10.5 host 10.5\n");
    Write("sweep.yaml", "experiment: ./small.yaml\nset: {frames: 3}\naxes: {seed: [1, 2]}\n");
  }
};

TEST_F(KeptPages, APageElsewhereReplacesNothingButPages) {
  Succeed("map one.log -o m");
  Succeed("sweep ./sweep.yaml -o s");
  fs::create_directory(Path("mine"));
  Write("mine/report.html", "my notes");
  ExpectRefusal("report m -o mine --force", {"mine/report.html: is not a page of depthgrid's"});
  fs::remove(Path("mine/report.html"));
  for (const char* name : {"timing.js", "experiment.yaml", "sweep_again.yaml"}) {
    const std::string file = std::string("mine/") + name;
    Write(file, "mine");
    const std::string of = file.ends_with(".js") ? "m" : "s";
    ExpectRefusal("report " + of + " -o mine --force", {file + ": belongs to no page"});
    EXPECT_EQ(ReadFile(Path(file)), "mine");
    fs::remove(Path(file));
  }
  // A run's page brings no experiment.yaml, so that this one is somebody's own.
  Succeed("report m -o mine --force");
  Write("mine/experiment.yaml", "mine");
  ExpectRefusal("report s -o mine --force", {"mine/experiment.yaml: belongs to no page"});
  fs::remove(Path("mine/experiment.yaml"));
  // What a page came with goes with it.
  for (int i = 0; i < 2; ++i) Succeed("report s -o mine --force");
  EXPECT_THAT(FilesIn("mine"),
              ElementsAre("experiment.yaml", "report.html", "sweep_again.yaml", "timing.js"));
  fs::remove(Path("mine/experiment.yaml"));
  fs::create_symlink("../elsewhere.yaml", Path("mine/experiment.yaml"));
  ExpectRefusal("report s -o mine --force", {"mine/experiment.yaml: is a link, so it is kept"});
}

// Somebody's picture among those of a run is none of its frames.
TEST_F(KeptPages, OtherPicturesAreNotShown) {
  Succeed("run ./small.yaml --set frames=3 -o out");
  const std::string before = ReadFile(Path("out/report.html"));
  for (const char* name : {"best", "99999999999", "-1"}) {
    fs::copy_file(Path("out/frames/000000_depth.png"),
                  Path(std::string("out/frames/") + name + "_depth.png"));
  }
  Succeed("report out");
  EXPECT_EQ(ReadFile(Path("out/report.html")), before);
}

// The map that is handed on, in which somebody may have drawn, is the one that the page shows.
TEST_F(KeptPages, ThePageOfALocalisedRunIsOfTheMapBesideIt) {
  Succeed("map one.log -o m");
  std::string image = ReadFile(Path("m/map.pgm"));
  image.back() = static_cast<char>(image.back() == 0 ? 255 : 0);
  Write("m/map.pgm", image);
  Succeed("map one.log --map m --localise --start 0,0,0 -o out");
  EXPECT_EQ(ReadFile(Path("out/map.pgm")), image);
  const std::string page = ReadFile(Path("out/report.html"));
  Succeed("report out");
  EXPECT_EQ(ReadFile(Path("out/report.html")), page);
}

TEST_F(KeptPages, APageIsCalledAsItsInputIs) {
  fs::copy_file(Path("one.log"), Path("drive.2.log"));
  Succeed("map drive.2.log -o m");
  EXPECT_THAT(ReadFile(Path("m/report.html")), HasSubstr("<title>drive.2 - depthgrid</title>"));
  Succeed("render ./small.yaml --set frames=3 --no-colour -o seq.v1.5");
  Succeed("map seq.v1.5 -o n");
  EXPECT_THAT(ReadFile(Path("n/report.html")), HasSubstr("<title>seq.v1.5 - depthgrid</title>"));
}

}  // namespace
}  // namespace depthgrid
