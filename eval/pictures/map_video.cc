#include "eval/pictures/map_video.h"

#include "eval/pictures/map_picture.h"
#include "eval/pictures/video_writer.h"
#include "mapper/grid/map_drawing.h"

namespace depthgrid {
namespace {

constexpr int kFramesPerS = 30;
// 20 s; longer runs are shown faster.
constexpr std::size_t kMaxFrames = 600;
// Duration of the finished map at the end.
constexpr int kLastFrames = 2 * kFramesPerS;

}  // namespace

void WriteMapVideo(const std::string& path, const MappingRun& run, const GridOptions& options) {
  RequireVideo(path);
  const std::vector<MappedFrame>& mapped = run.result.mapped;
  if (mapped.empty() || run.reports.empty()) {
    throw std::runtime_error(path + ": nothing was mapped, there is nothing to show");
  }
  Path estimate{"estimate", palette::kEstimate, FinalTrajectory(run)};
  const GridGeometry part = ShownPart(StatesOf(run.result.map), {estimate});
  estimate.poses.clear();
  MapDrawing drawing(options);
  std::optional<VideoWriter> video;
  RgbImage picture;
  const std::size_t every = run.reports.size() / kMaxFrames + 1;
  auto next = mapped.begin();
  for (std::size_t i = 0; i < run.reports.size(); ++i) {
    // The first frame also adds the prior map, whose frames have negative numbers.
    for (; next != mapped.end() && next->frame <= run.reports[i].index; ++next) {
      drawing.Add(next->frame, *next->obstacles, next->map_from_base);
    }
    if (const auto& pose = run.result.map_from_camera[i]) {
      estimate.poses.push_back({run.reports[i].stamp_s, *pose});
    }
    if (i % every != 0 && i + 1 != run.reports.size()) continue;
    picture = AnnotatedMap(PictureOf(drawing.Map(), part), part, {estimate}, PathDot::kNow);
    if (!video) video.emplace(path, picture.width_px, picture.height_px, kFramesPerS);
    video->Add(picture);
  }
  for (int i = 0; i < kLastFrames; ++i) video->Add(picture);
  video->Finish();
}

}  // namespace depthgrid
