#include "mapper/io/map_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/io/file.h"
#include "mapper/io/pgm.h"
#include "mapper/io/png.h"
#include "tests/io/temporary_folder.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class MapFileTest : public TemporaryFolderTest {
 protected:
  MapFile Read(const std::string& image, const std::string& yaml) const {
    WriteFile(Path("m.pgm"), image);
    WriteFile(Path("m.yaml"), "image: m.pgm\n" + yaml);
    return ReadMap(Path("m.yaml"));
  }
  std::string ErrorOf(const std::string& image, const std::string& yaml) const {
    try {
      Read(image, yaml);
    } catch (const InputError& error) {
      return Short(error.what()).substr(2);
    }
    return "no error";
  }
};

constexpr const char* kYaml =
    "resolution: 0.5\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

std::vector<CellState> StatesIn(const MapFile& file) { return StatesOf(file.map).states; }

constexpr CellState kU = CellState::kUnknown;
constexpr CellState kF = CellState::kFree;
constexpr CellState kO = CellState::kOccupied;

TEST_F(MapFileTest, ReadsRowsFromTheTopAndTheOriginsCorner) {
  // Two rows of three; the lower row is stored first in memory.
  const MapFile file = Read("P2\n# comment\n3 2 # more\n255\n0 254 205\n254 254 0\n", kYaml);
  EXPECT_EQ(file.map.geometry, (GridGeometry{0.5, {-2, 4}, 3, 2}));
  EXPECT_EQ(StatesIn(file), (std::vector<CellState>{kF, kF, kO, kO, kF, kU}));
  EXPECT_EQ(file.world_from_grid, Pose2{});
}

TEST_F(MapFileTest, OneLineHeaderBinaryAndSixteenBits) {
  EXPECT_EQ(StatesIn(Read(std::string("P5 3 1 255 \x00\xFE\xCD", 14), kYaml)),
            (std::vector<CellState>{kO, kF, kU}));
  EXPECT_EQ(StatesIn(Read(std::string("P5 2 1 65535\n\x00\x00\xFF\xFF", 17), kYaml)),
            (std::vector<CellState>{kO, kF}));
}

TEST_F(MapFileTest, NegateTurnsTheShades) {
  const std::string yaml =
      "resolution: 1\norigin: [0, 0, 0]\nnegate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  EXPECT_EQ(StatesIn(Read("P2 3 1 255 0 254 100", yaml)), (std::vector<CellState>{kF, kO, kU}));
}

TEST_F(MapFileTest, ScaleStretchesBetweenTheThresholds) {
  const std::string yaml =
      "resolution: 1\norigin: [0, 0, 0]\nmode: scale\n"
      "occupied_thresh: 0.8\nfree_thresh: 0.2\n";
  const MapFile file = Read("P2 4 1 100 0 100 50 35", yaml);
  EXPECT_EQ(file.map.occupied_prob[0], 1.0F);
  EXPECT_EQ(file.map.occupied_prob[1], 0.0F);
  EXPECT_NEAR(file.map.occupied_prob[2], 0.5, 1e-6);
  EXPECT_NEAR(file.map.occupied_prob[3], 0.75, 1e-6);
}

TEST_F(MapFileTest, RawIsPercent) {
  const MapFile file = Read("P2 4 1 255 0 100 37 101", std::string(kYaml) + "mode: raw\n");
  EXPECT_EQ(file.map.occupied_prob[0], 0.0F);
  EXPECT_EQ(file.map.occupied_prob[1], 1.0F);
  EXPECT_EQ(file.map.occupied_prob[2], 0.37F);
  EXPECT_TRUE(std::isnan(file.map.occupied_prob[3]));
}

TEST_F(MapFileTest, YawAndOffLatticeOriginsArePoses) {
  const MapFile file =
      Read("P2 2 1 255 0 254", "resolution: 0.5\norigin: [2.1, 3.0, 1.5707963267948966]\n");
  // The first pixel's centre lies 0.25 along the rotated x axis and 0.25 along the rotated y axis.
  const Eigen::Vector2d centre = CellCentre(file.map.geometry.min_cell, 0.5);
  EXPECT_TRUE((file.world_from_grid * centre).isApprox(Eigen::Vector2d(1.85, 3.25), 1e-9));
  const OccupancyMap aligned = AlignedMap(file);
  EXPECT_EQ(aligned.At(CellOf({1.75, 3.25}, 0.5)), 1.0F);
  EXPECT_EQ(aligned.At(CellOf({1.75, 3.75}, 0.5)), 0.0F);
}

// Half a cell off, every centre lies on a boundary: each takes the cell above, none twice.
TEST_F(MapFileTest, HalfACellOffNoCellIsLostOrDoubled) {
  std::string pgm = "P2 40 1 255";
  for (int i = 0; i < 40; ++i) pgm += i % 2 == 0 ? " 0" : " 254";
  for (const char* x : {"0.025", "-10.025", "7.325"}) {
    const MapFile file = Read(pgm, "resolution: 0.05\norigin: [" + std::string(x) + ", 0, 0]\n");
    const OccupancyMap aligned = AlignedMap(file);
    const Cell first = CellOf({std::stod(x) + 1e-6, 0.025}, 0.05);
    for (int i = 0; i < 40; ++i) {
      EXPECT_EQ(aligned.At({first.x + i, 0}), i % 2 == 0 ? 1.0F : 0.0F) << x << " " << i;
    }
  }
}

TEST_F(MapFileTest, AMapThatTurnsIntoTooManyCellsIsRefused) {
  const std::string row = "P5 65535 1 255\n" + std::string(65535, '\0');
  EXPECT_EQ(ErrorOf(row, "resolution: 0.5\norigin: [0, 0, 0]\n"), "no error");
  EXPECT_EQ(ErrorOf(row, "resolution: 0.5\norigin: [0, 0, 0.01]\n"), "no error");
  EXPECT_EQ(ErrorOf(row, "resolution: 0.5\norigin: [0, 0, 0.7853981633974483]\n"),
            "m.yaml: origin turns the map's 65535 x 1 cells by 0.785 rad, so that it spans 46342 x "
            "46341; a map may have 268435456");
}

OccupancyMap RandomMap() {
  OccupancyMap map(GridGeometry{0.05, {-7, 12}, 31, 17});
  RandomStream random(5, RandomStage::kTest);
  for (float& prob : map.occupied_prob) {
    prob = random.Uniform() < 0.3 ? kUnknownProb : static_cast<float>(random.Uniform());
  }
  return map;
}

TEST_F(MapFileTest, TrinaryRoundTripKeepsTheStates) {
  const OccupancyMap map = RandomMap();
  WriteMap(Path("map.yaml"), map);
  const MapFile read = ReadMap(Path("map.yaml"));
  EXPECT_EQ(read.map.geometry, map.geometry);
  EXPECT_EQ(StatesOf(read.map), StatesOf(map));
  EXPECT_EQ(read.world_from_grid, Pose2{});
  WriteMap(Path("states.yaml"), StatesOf(map));
  EXPECT_EQ(ReadFile(Path("states.pgm")), ReadFile(Path("map.pgm")));
  EXPECT_EQ(ReadFile(Path("map.yaml")),
            "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-0.35, 0.6, 0]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

// As a robot's before its first scan (IncrementalMapper::CurrentMap).
TEST_F(MapFileTest, AMapWithoutCellsIsWrittenAsAnUnknownOne) {
  for (const MapMode mode : {MapMode::kTrinary, MapMode::kScale, MapMode::kRaw}) {
    const std::string path = Path("empty.yaml");
    WriteMap(path, OccupancyMap{}, mode);
    EXPECT_EQ(ReadMap(path).map.geometry, OnlyCell({0, 0}, 0.05));
    EXPECT_EQ(ReadStates(path).states, std::vector<CellState>{kU});
  }
}

// In UTM coordinates a corner has seven digits before the point.
TEST_F(MapFileTest, AMapFarFromItsOriginKeepsItsLattice) {
  OccupancyMap map = RandomMap();
  map.geometry.resolution_m = 0.025;
  map.geometry.min_cell = {-18'765'433, 216'493'827};
  WriteMap(Path("map.yaml"), map);
  const MapFile read = ReadMap(Path("map.yaml"));
  EXPECT_EQ(read.map.geometry, map.geometry);
  EXPECT_EQ(read.world_from_grid, Pose2{});
  EXPECT_NE(ReadFile(Path("map.yaml")).find("origin: [-469135.825, 5412345.675, 0]"),
            std::string::npos);
}

TEST_F(MapFileTest, ScaleAndRawRoundTripKeepTheProbabilities) {
  const OccupancyMap map = RandomMap();
  for (const MapMode mode : {MapMode::kScale, MapMode::kRaw}) {
    WriteMap(Path("map.yaml"), map, mode);
    const OccupancyMap read = ReadMap(Path("map.yaml")).map;
    const double step = mode == MapMode::kScale ? 1.0 / 255.0 : 0.01;
    for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
      EXPECT_EQ(std::isnan(read.occupied_prob[i]), std::isnan(map.occupied_prob[i]));
      if (!std::isnan(map.occupied_prob[i])) {
        EXPECT_NEAR(read.occupied_prob[i], map.occupied_prob[i], step);
      }
    }
  }
}

// The shades do not fall on the thresholds: what is rounded over one would be another cell.
TEST_F(MapFileTest, EveryModeKeepsTheStates) {
  OccupancyMap map(GridGeometry{0.05, {0, 0}, 400, 250});
  const auto cells = static_cast<float>(map.occupied_prob.size());
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    map.occupied_prob[i] = static_cast<float>(i) / (cells - 1.0F);
  }
  for (const MapMode mode : {MapMode::kTrinary, MapMode::kScale, MapMode::kRaw}) {
    WriteMap(Path("map.yaml"), map, mode);
    const OccupancyMap read = ReadMap(Path("map.yaml")).map;
    EXPECT_EQ(StatesOf(read), StatesOf(map)) << static_cast<int>(mode);
    // Once read, it is written as it was.
    const std::string bytes = ReadFile(MapImageOf(Path("map.yaml"), mode));
    WriteMap(Path("again.yaml"), read, mode);
    EXPECT_EQ(ReadFile(MapImageOf(Path("again.yaml"), mode)), bytes);
  }
}

// A text tool may have made each line end two bytes; the raster's own bytes are not moved by it.
TEST_F(MapFileTest, APgmWithLineEndsOfTwoBytesHasItsPixelsInTheirPlaces) {
  const auto values = [](const std::string& bytes) { return DecodePgm(bytes, "m.pgm").values; };
  const std::string four("\x01\xfe\xcd\x0a", 4);
  const std::vector<std::uint16_t> expected = {1, 254, 205, 10};
  EXPECT_EQ(values("P5\n2 2\n255\n" + four), expected);
  EXPECT_EQ(values("P5\r\n2 2\r\n255\r\n" + four), expected);
  EXPECT_EQ(values("P5\r\n2 2\r\n255\r\n" + four + "\r\n"), expected);
  EXPECT_EQ(values("P5\r2 2\r255\r" + four), expected);
  const std::string line_feed_first("\x0a\xfe\xcd\x01", 4);
  EXPECT_EQ(values("P5\r2 2\r255\r" + line_feed_first).front(), 10);
}

TEST_F(MapFileTest, WhatFollowsThePixelsOfAPgmIsALineEndOrAnImage) {
  const std::string pgm("P5\n2 2\n255\n\x01\xfe\xcd\x0a", 15);
  const auto error = [](const std::string& bytes) {
    try {
      DecodePgm(bytes, "m.pgm");
      return std::string("no error");
    } catch (const InputError& refused) {
      return std::string(refused.what());
    }
  };
  for (const std::string& rest : {std::string(), std::string("\n"), std::string("\r\n"), pgm}) {
    EXPECT_EQ(error(pgm + rest), "no error");
  }
  EXPECT_EQ(error(pgm + "abc"),
            "m.pgm: PGM has 3 bytes after its pixels, must end with them or with a line end");
  EXPECT_THAT(error("P5\n2 2\n255 \n\x01\xfe\xcd\xfe"), HasSubstr("has 1 byte after"));
  EXPECT_THAT(error("P2 2 1 255 1 2 3"), HasSubstr("has 2 bytes after"));
  EXPECT_EQ(error("P2 2 1 255 1 2\n# made by hand\n"), "no error");
}

TEST_F(MapFileTest, OneClearLineForEachFault) {
  const std::string image = "P2 1 1 255 0";
  EXPECT_EQ(ErrorOf(image, "origin: [0,0,0]\n"), "m.yaml: key 'resolution' is missing");
  EXPECT_EQ(ErrorOf(image, "resolution: 0\norigin: [0,0,0]\n"),
            "m.yaml:2: resolution is '0', must be from 1e-06 to 10000");
  EXPECT_EQ(ErrorOf(image, "resolution: 0.05\norigin: [400000, 5300000, 0]\n"), "no error");  // UTM
  EXPECT_EQ(ErrorOf(image, "resolution: 0.001\norigin: [0, 5300000, 0]\n"),
            "m.yaml: origin is 5.3e+09 cells of 0.001 m from zero, must be at most 2.1e+09");
  EXPECT_EQ(ErrorOf(image, "resolution: 1\norigin: [0]\n"),
            "m.yaml: origin has 1 number, must be [x, y, yaw]");
  EXPECT_EQ(ErrorOf(image, std::string(kYaml) + "mode: tertiary\n"),
            "m.yaml:7: mode is 'tertiary', must be one of trinary, scale, raw (did you mean "
            "'trinary'?)");
  EXPECT_EQ(ErrorOf(image, "resolution: 1\norigin: [0,0,0]\nnegate: 7\n"),
            "m.yaml: negate is '7', must be 0 or 1");
  EXPECT_EQ(ErrorOf(image, "resolution: 1\norigin: [0,0,0]\nfree_thresh: 0.9\n"),
            "m.yaml: free_thresh 0.9 is above occupied_thresh 0.65");
  EXPECT_EQ(ErrorOf("", kYaml), "m.pgm: is empty, must be a PGM or PNG image");
  EXPECT_EQ(ErrorOf("BM rest", kYaml), "m.pgm: is neither a PGM nor a PNG image");
  EXPECT_EQ(ErrorOf("P5 9 9 255\nabc", kYaml), "m.pgm: PGM is truncated: 3 of 81 bytes of pixels");
  EXPECT_EQ(ErrorOf("P2 2 1 255 0 x", kYaml),
            "m.pgm: PGM pixel is 'x', must be a whole number of at most 255");
  EXPECT_EQ(ErrorOf("P2 2 1 255\n0\n256\n", kYaml),
            "m.pgm: PGM pixel is '256', must be a whole number of at most 255");
  EXPECT_EQ(ErrorOf("P2 0 1 255 0", kYaml),
            "m.pgm: PGM width, height and maximum must be positive");
  EXPECT_EQ(ErrorOf("P2 99999999 1 255 0", kYaml),
            "m.pgm: PGM width is '99999999', must be a whole number of at most 65535");
  fs::remove(Path("m.pgm"));
  EXPECT_THROW(ReadMap(Path("m.yaml")), InputError);
}

TEST_F(MapFileTest, UnknownKeysOfOtherProgramsAreIgnored) {
  EXPECT_EQ(StatesIn(Read("P2 1 1 255 0", std::string(kYaml) + "map_type: occupancy\n")),
            (std::vector<CellState>{kO}));
}

// Nav2's own files.
TEST_F(MapFileTest, RealMapsReadOrFailWithOneLine) {
  const char* data = std::getenv("DEPTHGRID_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "DEPTHGRID_TEST_DATA is not set";
  int read = 0;
  int refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(data) / "maps")) {
    if (entry.path().extension() != ".yaml") continue;
    try {
      EXPECT_GT(ReadMap(entry.path().string()).map.geometry.size(), 0U);
      ++read;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  }
  EXPECT_EQ(read, 8);
  EXPECT_EQ(refused, 4);  // a missing image, a broken one, and two files of parameters
  // The same picture as PNG and as PGM (its maximum is 255, as the PNG's).
  const std::string test = std::string(data) + "/maps/nav2_map_server/test/";
  const std::string yaml = ReadFile(test + "testmap.yaml");
  const std::size_t name = yaml.find("testmap.png");
  WriteFile(Path("p.yaml"), std::string(yaml).replace(name, 11, "testmap.pgm"));
  fs::copy_file(test + "testmap.pgm", Path("testmap.pgm"));
  EXPECT_EQ(StatesOf(ReadMap(test + "testmap.yaml").map), StatesOf(ReadMap(Path("p.yaml")).map));
}

// As Nav2's map server: in trinary mode opacity is averaged with the colours, once any pixel has
// less than all of it, in scale mode what is not opaque is unknown.
TEST_F(MapFileTest, TransparentPixelsOfAPng) {
  const std::vector<std::uint8_t> rgba = {254, 254, 254, 255, 254, 254, 254, 0,
                                          0,   0,   0,   255, 0,   0,   0,   0};
  WriteFile(Path("m.png"), EncodeRgbaPng({4, 1, rgba}));
  const std::string yaml = "image: m.png\nresolution: 0.05\norigin: [0, 0, 0]\n";
  const auto states_in = [&](const std::string& mode) {
    WriteFile(Path("m.yaml"), yaml + "mode: " + mode + "\n");
    return StatesOf(ReadMap(Path("m.yaml")).map).states;
  };
  const auto free = CellState::kFree, occupied = CellState::kOccupied;
  const auto unknown = CellState::kUnknown;
  EXPECT_EQ(states_in("trinary"), (std::vector{free, unknown, occupied, occupied}));
  EXPECT_EQ(states_in("scale"), (std::vector{free, unknown, occupied, unknown}));
}

TEST_F(MapFileTest, TheImageIsNeverWrittenOver) {
  const OccupancyMap map(GridGeometry{0.05, {0, 0}, 2, 2});
  EXPECT_THROW(WriteMap(Path("m.pgm"), map), InputError);
  EXPECT_FALSE(fs::exists(Path("m.pgm")));
  EXPECT_NO_THROW(WriteMap(Path("m.png"), map));  // odd, but the image is m.pgm
}

}  // namespace
}  // namespace depthgrid
