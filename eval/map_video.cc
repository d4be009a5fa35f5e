#include "eval/map_video.h"

#include "eval/map_picture.h"
#include "eval/video_writer.h"
#include "mapper/grid/map_drawing.h"

namespace depthgrid {
namespace {

constexpr int kFramesPerS = 30;
// 20 s: longer runs go faster.
constexpr std::size_t kMaxFrames = 600;
// The finished map stays in the picture this long.
constexpr int kLastFrames = 2 * kFramesPerS;
constexpr int kMarginCells = 4;

}  // namespace

void WriteMapVideo(const std::string& path, const MappingRun& run, const GridOptions& options) {
  RequireVideo(path);
  const std::vector<MappedFrame>& mapped = run.result.mapped;
  const GridGeometry part = KnownPart(StatesOf(run.result.map), kMarginCells);
  const std::size_t every = mapped.size() / kMaxFrames + 1;
  MapDrawing drawing(options);
  Path estimate{"estimate", palette::kEstimate, {}};
  std::optional<VideoWriter> video;
  RgbImage picture;
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    drawing.Add(*mapped[i].obstacles, mapped[i].map_from_base);
    const auto frame = static_cast<std::size_t>(mapped[i].frame);
    if (frame < run.result.map_from_camera.size() && run.result.map_from_camera[frame]) {
      estimate.poses.push_back({mapped[i].stamp_s, *run.result.map_from_camera[frame]});
    }
    if (i % every != 0 && i + 1 != mapped.size()) continue;
    picture = AnnotatedMap(PictureOf(drawing.Map(), part), part, {estimate});
    if (!video) video.emplace(path, picture.width_px, picture.height_px, kFramesPerS);
    video->Add(picture);
  }
  if (!video) throw std::runtime_error(path + ": nothing was mapped, there is nothing to show");
  for (int i = 0; i < kLastFrames; ++i) video->Add(picture);
  video->Finish();
}

}  // namespace depthgrid
