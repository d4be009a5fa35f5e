// A map whose save was killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::Not;

class HalfReplaced : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Succeed("render ./small.yaml --no-colour -o seq");
  }
};

// A map that a robot saved itself, killed before the last step of it: its matched scans are in
// matched.next.bin, beside those of the map before.
TEST_F(HalfReplaced, AMapOfAKilledSaveIsHandedOnWhole) {
  Succeed("map seq --up z -o m");
  Succeed("map seq --up z --set sequence.to_s=0.2 -o before");
  const auto localise = [&](const std::string& in) {
    Succeed("map seq --up z --map m --localise --start 1.5,1,90 -o " + in);
    const std::string settings = ReadFile(Path(in + "/run.yaml"));
    const std::size_t at = settings.find("map_hash");
    return settings.substr(at, settings.find('\n', at) - at);
  };
  const std::string hash = localise("whole");
  fs::rename(Path("m/matched.bin"), Path("m/matched.next.bin"));
  fs::copy_file(Path("before/matched.bin"), Path("m/matched.bin"));
  EXPECT_EQ(localise("kept"), hash);
  for (const char* name : {"/scans.bin", "/matched.bin"}) {
    EXPECT_TRUE(SameFile(std::string("kept") + name, std::string("whole") + name)) << name;
  }
  Succeed("map seq --up z -o m --force");
  EXPECT_THAT(FilesIn("m"), Not(Contains("matched.next.bin")));
}

}  // namespace
}  // namespace depthgrid
