#include "sim/scene.h"

#include <gtest/gtest.h>

#include <fstream>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

const std::string kScenes = std::string(DEPTHGRID_SOURCE_DIR) + "/scenes/";

TEST(Scene, LivingRoomHasFloorCeilingAndPaths) {
  const Scene scene = LoadScene(kScenes + "living_room.yaml");
  EXPECT_EQ(scene.name, "living_room");
  EXPECT_EQ(scene.floor_z_m, 0.0);
  ASSERT_TRUE(scene.ceiling_z_m.has_value());
  EXPECT_NEAR(*scene.ceiling_z_m, 2.5, 1e-6);
  EXPECT_TRUE(scene.trajectories.contains("handheld"));
  EXPECT_TRUE(scene.trajectories.contains("robot"));
}

}  // namespace
}  // namespace depthgrid
