// Speedup of depth rendering by a second core. Alternates one and two threads; prints wall-clock
// time and CPU time per second of it (below 2 with two threads: the cores were not free).
#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <vector>

#include "bench/command_line.h"
#include "bench/guarded_main.h"
#include "mapper/core/level.h"
#include "mapper/core/median.h"
#include "sim/depth/depth_camera.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

double Seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Taken {
  double wall_s = 0.0;
  double cpu_s = 0.0;
};

Taken Render(const DepthCamera& camera, int frames) {
  const double wall_s = Seconds(CLOCK_MONOTONIC);
  const double cpu_s = Seconds(CLOCK_PROCESS_CPUTIME_ID);
  for (int k = 0; k < frames; ++k) {
    camera.Render(CameraOf({2.0 + 0.05 * (k % 10), 2.0, 0.7 * k}, 1.15));
  }
  return {Seconds(CLOCK_MONOTONIC) - wall_s, Seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_s};
}

void PrintRow(int threads, int frames, const Taken& best, const Taken& one) {
  std::printf("| %d | %.2f | %.2f | %.2f | %.2f |\n", threads, 1e3 * best.wall_s / frames,
              1e3 * best.cpu_s / frames, best.cpu_s / best.wall_s, one.wall_s / best.wall_s);
}

void Compare(int triangles, int frames, int rounds) {
  const RayScene room(test::ClutteredRoom(triangles));
  const DepthCamera serial(room, PinholeCamera{}, 1), parallel(room, PinholeCamera{}, 2);
  Render(parallel, frames);  // warm-up: starts threads, allocates memory
  Taken one, two;
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const Taken a = Render(serial, frames);
    const Taken b = Render(parallel, frames);
    ratios.push_back(a.wall_s / b.wall_s);
    if (round == 0 || a.wall_s < one.wall_s) one = a;
    if (round == 0 || b.wall_s < two.wall_s) two = b;
  }
  std::printf("| threads | ms a frame, best of %d | of CPU | cores it had | times one thread |\n",
              rounds);
  std::printf("|--:|--:|--:|--:|--:|\n");
  PrintRow(1, frames, one, one);
  PrintRow(2, frames, two, one);
  std::printf("median of the pairs: %.2f\n", UpperMedian(ratios));
}

}  // namespace
}  // namespace depthgrid

namespace {
int Measure(int argc, char** argv) {
  using depthgrid::FromTo;
  int triangles = 100'000, frames = 9, rounds = 40;
  CLI::App app("Depth frames on one and on two threads");
  app.add_option("--triangles", triangles, "of the room")->check(FromTo(12, 1e7));
  app.add_option("--frames", frames, "between two looks at the clock")->check(FromTo(1, 1e6));
  app.add_option("--rounds", rounds, "of one and two threads each")->check(FromTo(1, 1e6));
  if (!depthgrid::ReadCommandLine(app, argc, argv)) return 0;
  depthgrid::Compare(triangles, frames, rounds);
  return 0;
}
}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
