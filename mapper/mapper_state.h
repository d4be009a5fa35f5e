// State and steps of the mapper, for its own .cc files only.
#pragma once

#include <algorithm>
#include <utility>

#include "mapper/adjustment_rounds.h"
#include "mapper/astray_parts.h"
#include "mapper/beginning.h"
#include "mapper/frame_history.h"
#include "mapper/fuse/correction_filter.h"
#include "mapper/fuse/match_noise.h"
#include "mapper/fuse/pose_errors.h"
#include "mapper/graph/loop_search.h"
#include "mapper/graph/slide_search.h"
#include "mapper/incremental_mapper.h"
#include "mapper/loop_closing.h"
#include "mapper/mapped_frames.h"
#include "mapper/reference_factory.h"
#include "mapper/scan/frame_scans.h"
#include "mapper/scan/frozen_watch.h"
#include "mapper/scan/held_watch.h"
#include "mapper/scan/moving_objects.h"
#include "mapper/slip_search.h"

namespace depthgrid {

// Number of newest frames whose scans are stored even if tied: the relocation search (3 m of path)
// and loop tests need them.
constexpr int kRecentFrames = 400;

struct IncrementalMapper::State {
  MapperOptions options;
  std::optional<PinholeCamera> camera;
  FrameClocks clocks;
  GainOracle oracle;
  MatchOracle match_oracle;
  HeldWatch held;
  FrozenWatch frozen;
  std::vector<int> moved_on_frames;  // Frame::index of those whose pose was moved on
  FrameScanner scanner;
  MovingObjects moving;
  std::unique_ptr<ReferenceMap> reference;  // null when SLAM is trusted alone
  FrameHistory history;
  StandBlend stands;
  CorrectionFilter filter;
  PoseErrors errors;
  MatchNoise match_noise;
  std::optional<int> filter_epoch;  // SLAM epoch of the correction
  bool has_matched = false;         // a match was taken: the map says more than SLAM alone
  double gap_variance = 0.0;        // square of MappedFrame::gap_share since the last mapped frame
  LoopCloser loop_closer;
  std::optional<LoopSearch> loop_search;
  SlideSearch slides;
  Relocation relocation;
  SlipSearch slips;
  struct OffMap {
    int frames = 0;          // since the map explained a frame's scan
    int contradictions = 0;  // the last times it was looked, in a row
  };
  OffMap off_map;  // in a fixed map
  AdjustmentRounds rounds;
  MappedFrames mapped;
  FrameMoves moves;                          // of earlier frames, by the newest frame
  std::optional<MotionSpread> first_spread;  // that the first frames were mapped again with
  Beginning beginning;
  bool has_prior = false;  // a prior map, or only its frame
  int prior_frames = 0;    // the first of `mapped`, from a prior map
  bool fixed_map = false;  // only localise in the prior map: what follows it in `mapped` is a guess
  std::vector<GuessedFrames> given_up;  // in a fixed map: guesses that ended with the next loss
  std::optional<Pose2> prior_start;     // map_from_slam at the start in a prior map, until used

  State(const MapperOptions& opts, const std::optional<PinholeCamera>& cam, FrameClocks clks,
        GainOracle orc)
      : options(opts),
        camera(cam),
        clocks(std::move(clks)),
        oracle(std::move(orc)),
        scanner(cam, opts.scan),
        moving(opts.method == MapperMethod::kSurfel ? opts.surfel.moving_m : 0.0),
        stands(opts.scan.floor_z_m),
        filter(opts.fusion),
        errors(opts.submap.scans),
        loop_closer(opts.loops),
        slides(opts.loops.slide, opts.loops.search, opts.loops.overlap),
        relocation(opts.loops.relocation, opts.loops.search, opts.loops.overlap),
        slips(opts.loops.relocation.slip_deg),
        rounds(opts.method == MapperMethod::kSurfel ? opts.rounds
                                                    : RoundOptions{.first_frames = 0}),
        mapped(opts.keep, std::max(kRecentFrames, 2 * opts.submap.scans)),
        beginning(opts.method == MapperMethod::kSurfel && !opts.fusion.TrustsSlamAlone() &&
                  (AwaitsSpread() || opts.surfel.moving_m > 0.0)) {
    if (options.fusion.TrustsSlamAlone()) return;
    reference = MakeReference(options);
    if (options.SearchesLoops()) loop_search.emplace(options.loops.search, options.loops.overlap);
  }

  Frame Believed(const Frame& frame);
  void TakeBackSince(const FrameRecord& first);
  void InsertPrior();
  void Map(const Frame& frame, FrameReport& report);
  void Begin(const Frame& frame, FrameReport& report);
  FrameScans ScansOf(const Frame& frame, FrameReport& report);
  void MapScans(const Frame& frame, const FrameScans& scans, FrameReport& report);
  void CloseLoops(const Frame& frame, const FrameScans& scans, FrameReport& report);
  std::optional<MotionSpread> AdjustBetweenFrames();
  void GoThroughAgain(const Frame& newest, const std::optional<MotionSpread>& spread);
  void TakeOutMistaken(const Frame& newest, FrameReport& report);
  void FindLoops(const FrameScans& scans, FrameReport& report);
  struct FoundLoops {
    std::vector<PlanarLoop> loops;
    AdjustEffort effort = AdjustEffort::kCloseLoops;  // that they are worth
  };
  FoundLoops LoopsFound(const FrameScans& scans, const FrameReport& report);
  void DoubtGuess(const FrameReport& report);
  void Relocate(const FrameScans& scans, FrameReport& report);
  void RelocateAtLast();
  void MovePart(int first, const Pose2& motion);
  void SettleInFixed(const Pose2& motion);
  void GiveGuessUp();
  void ForgetGuess();
  // `covariance`: Adjustment::covariance for errors.Mapped(). `moved_apart`: if given, only the
  // frames from this index on were moved, rigidly.
  void MoveTo(const std::vector<Pose2>& map_from_base, const Eigen::MatrixXd& covariance,
              const std::optional<int>& moved_apart = {});
  FrameMoves MovesTo(const State& again) const;
  void TellCorrections(FrameReport& report) const;
  Prediction Predict(const std::shared_ptr<const Scan>& scan, FrameReport& report);
  void Match(const std::shared_ptr<const Scan>& scan, const Prediction& prediction,
             FrameReport& report);
  void MatchWhereMotionWentOn(const std::shared_ptr<const Scan>& scan, const Prediction& prediction,
                              FrameReport& report);
  std::optional<Pose2> WhereMotionWentOn() const;
  std::optional<Pose2> InMap(const FrameRecord& record, std::size_t back) const;
  OverlapEachWay SeenBeforeAt(const Pose2& map_from_base, const FrameScans& scans);
  std::optional<double> GapWithinEpoch() const;
  bool LooksForJumps(const FrameScans& scans) const;
  bool Contradicts(const Overlap& told, double least_agreement) const;
  double BeginAtJump(const FrameScans& scans, const Pose2& told);
  Prediction AfterGap(const FrameScans& scans, const Prediction& prediction, FrameReport& report);
  bool IsSuddenlyElsewhere(const FrameScans& scans, const Prediction& prediction, double share);
  bool IsElsewhereInFixed(const FrameScans& scans, const Prediction& prediction, double share);
  Prediction AfterCarrying(const FrameScans& scans, const Prediction& prediction,
                           FrameReport& report);
  Prediction MatchedAnew(const std::shared_ptr<const Scan>& scan, FrameReport& report);
  Prediction AfterSlip(const FrameScans& scans, const Prediction& prediction, FrameReport& report);
  void LookForSlide(const std::shared_ptr<const Scan>& scan, const Prediction& prediction,
                    FrameReport& report);
  FusedPose Fuse(const Prediction& prediction, FrameReport& report);
  void TellMotion(const FusedPose& fused, FrameReport& report);
  void Insert(const FrameScans& scans, const Prediction& prediction, const FusedPose& fused,
              FrameReport& report);

  // Whether the first frames are to be mapped again once an adjustment gives SLAM's noise.
  bool AwaitsSpread() const {
    return options.rounds.again && options.rounds.first_frames > 0 && filter.Learns() &&
           !first_spread;
  }
  bool SameEpoch() const;
  Pose2 CarriedOn() const;
  bool SearchesSlides() const;
  bool TellsSlips() const;
  bool SearchesSlips() const;
  std::optional<Pose2> TurnedTo(const std::shared_ptr<const Scan>& scan,
                                const Prediction& prediction, FrameReport& report);
  struct EpochStart {
    Pose2 map_from_base;
    double sigma_share = 0.0;  // added uncertainty, as a multiple of kEpochSigma
    double gap_share = 1.0;    // MappedFrame::gap_share
  };
  EpochStart BegunAt(const std::shared_ptr<const Scan>& scan);
  std::optional<Pose2> SlamsWord() const;
  void BeginEpoch(const std::shared_ptr<const Scan>& scan);
  void Anchor(const EpochStart& start);
  // `variance`: square of MappedFrame::gap_share if the motion of one frame went on, else 1 or
  // more.
  MappedFrame AsMapped(const Pose2& map_from_base, double variance) const;
  struct FinalEstimate {
    std::vector<Pose2> map_from_base;                   // of the mapped frames
    std::vector<std::optional<Pose3>> map_from_camera;  // of all frames
    std::vector<PlanarLoop> loops;                      // accepted, among the kept frames
    std::vector<GuessedPart> guessed;                   // joined to the rest by no loop
    std::vector<AstrayPart> astray;
    std::optional<OccupancyMap> map;  // drawn at these poses, if it was needed
  };
  FinalEstimate Final(const std::vector<std::optional<Pose3>>& slam_final) const;
  std::vector<MappedFrame> FramesOfMap() const;
  FinalEstimate FinalAsItIs() const;
  FinalEstimate FinalByAdjusting() const;
  // Follows SLAM where the map was led astray, and joins what it shows twice, if anything.
  void PutRight(FinalEstimate& final) const;
  FinalEstimate FinalOfSlam(const std::vector<std::optional<Pose3>>& slam_final) const;
  OccupancyMap Draw(const std::vector<MappedFrame>& frames) const;
};

}  // namespace depthgrid
