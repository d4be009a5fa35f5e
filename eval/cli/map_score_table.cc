#include "eval/cli/map_score_table.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "eval/cli/console.h"
#include "mapper/core/angle.h"
#include "mapper/core/counted.h"

namespace depthgrid::cli {
namespace {

using Row = std::vector<std::string>;

void AddRows(const std::string& name, const CellScores& scores, std::vector<Row>& rows) {
  for (std::size_t tolerance = 0; tolerance < scores.occupied.size(); ++tolerance) {
    const StateScore& walls = scores.occupied[tolerance];
    const StateScore& free = scores.free[tolerance];
    rows.push_back({fmt::format("{}, {} tolerance", name, Counted(tolerance, "cell")),
                    Number(walls.precision, 4), Number(walls.recall, 4), Number(walls.f1, 4),
                    Number(walls.iou, 4), Number(free.precision, 4), Number(free.recall, 4),
                    Number(free.f1, 4), Number(free.iou, 4)});
  }
}

void AddDistanceRow(const std::string& name, const CellScores& scores, std::vector<Row>& rows) {
  rows.push_back({name, Number(scores.chamfer_m, 4), Number(scores.hausdorff95_m, 4),
                  Number(scores.coverage, 4)});
}

Row WallRow(const std::string& name, const WallDistanceScore& score) {
  return {name, Number(score.f1_5cm, 4), Number(score.f1_10cm, 4), Number(score.chamfer_m, 4),
          Number(score.hausdorff95_m, 4)};
}

void PrintWalls(const MapQuality& quality) {
  std::vector<Row> rows = {{"walls", "F1 5 cm", "F1 10 cm", "chamfer m", "Hausdorff 95 % m"},
                           WallRow("as they lie", quality.walls)};
  if (quality.registered) rows.push_back(WallRow("registered", *quality.registered));
  fmt::print("\n{}", Table(rows));
  if (quality.registration) {
    const Pose2& motion = quality.registration->truth_from_estimate;
    fmt::print("registered by x {:.4f} m, y {:.4f} m, yaw {:.3f} deg: {:.4f} m on average\n",
               motion.x_m, motion.y_m, DegFromRad(motion.yaw_rad),
               quality.registration->mean_shift_m);
  }
  if (FitsBetterAsItLies(quality)) {
    fmt::print("the walls fit better without that motion: it is no error of the map\n");
  }
}

std::optional<double> MeanOf(const std::optional<WallThickness>& thickness) {
  return thickness ? std::optional(thickness->mean_m) : std::nullopt;
}

void PrintShape(const MapQuality& quality) {
  const auto column = [](const std::string& name, const std::optional<WallThickness>& thickness,
                         const TruthlessScore& s) -> Row {
    return {name, Number(MeanOf(thickness), 4), Number(s.occupied_share, 4),
            std::to_string(s.corners), std::to_string(s.enclosed_areas)};
  };
  fmt::print("\n{}",
             Table({{"map", "wall thickness m", "occupied share", "corners", "enclosed areas"},
                    column("estimate", quality.thickness, quality.truthless),
                    column("truth", quality.true_thickness, quality.truthless_of_truth)}));
}

void PrintOthers(const MapQuality& quality) {
  std::vector<Row> rows = {{"double wall rate", Number(quality.double_wall_rate, 4)},
                           {"SSIM", Number(quality.ssim, 4)}};
  if (quality.calibration) {
    rows.push_back({"Brier score", Number(quality.calibration->brier, 4)});
    rows.push_back({"log loss", Number(quality.calibration->log_loss, 4)});
    rows.push_back({"calibration error", Number(quality.calibration->calibration_error, 4)});
  }
  if (quality.navigability) {
    const Navigability& drive = *quality.navigability;
    rows.push_back(
        {fmt::format("{}: success", Counted(drive.pairs, "plan")), Number(drive.success_rate, 4)});
    rows.push_back({"  falsely blocked", Number(drive.falsely_blocked_rate, 4)});
    rows.push_back({"  collisions of the planned", Number(drive.collision_rate, 4)});
    rows.push_back({"  length ratio", Number(drive.length_ratio, 4)});
  }
  fmt::print("\n{}", Table(rows));
}

}  // namespace

void PrintMapScore(const MapScore& score) {
  std::vector<Row> cells = {
      {"cells", "precision", "recall", "F1", "IoU", "free precision", "recall", "F1", "IoU"}};
  std::vector<Row> distances = {{"cells", "chamfer m", "Hausdorff 95 % m", "coverage"}};
  if (score.observable) {
    AddRows("observable", *score.observable, cells);
    AddDistanceRow("observable", *score.observable, distances);
  }
  AddRows("all", score.all, cells);
  AddDistanceRow("all", score.all, distances);
  fmt::print("{}\n{}", Table(cells), Table(distances));
  PrintWalls(*score.quality);
  PrintShape(*score.quality);
  PrintOthers(*score.quality);
}

}  // namespace depthgrid::cli
