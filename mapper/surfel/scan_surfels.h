// Converts a scan to surfels in base axes, for matching and mapping.
#pragma once

#include <vector>

#include "mapper/core/options.h"
#include "mapper/surfel/scan_lines.h"
#include "mapper/surfel/surfel.h"

namespace depthgrid {

struct ScanSurfelOptions {
  // Most beams averaged for a surfel's point; the normal comes from all beams of its line.
  int beams = 8;
  // Greatest length of a surfel, so that coarse scanners keep details.
  double max_length_m = 0.2;
  double jump_sigmas = 5.0;
  double split_chi2 = 12.0;
  int min_line_beams = 4;
  // Reduce the information of surfels whose line fits its beams badly.
  bool judge_fit = true;
  // Lines too short to be cut that run along the beams and misfit by more than this factor
  // (ScanLine::variance_factor) are edges, and left out; 0: none.
  double edge_misfit = 4.0;
  // Where neighbouring beams share their errors, use only every RangeNoise::stride()-th beam.
  bool skip_alike = true;
  // Correct returns near the sensor's reach for those that noise pushed beyond it.
  bool correct_cutoff = true;

  void Visit(OptionsVisitor& v);
};

class ScanSurfelMaker {
 public:
  explicit ScanSurfelMaker(const ScanSurfelOptions& options)
      : options_(options),
        returns_(options.jump_sigmas),
        lines_(options.split_chi2, options.min_line_beams, options.correct_cutoff) {}

  // Uses every `stride`-th beam: 1, or noise.stride(). `memory`: an earlier result whose memory is
  // reused.
  std::vector<Surfel> Make(const Scan& scan, const RangeNoise& noise, int stride,
                           std::vector<Surfel> memory = {});
  std::vector<Surfel> Make(const Scan& scan, const RangeNoise& noise) {
    return Make(scan, noise, noise.stride());
  }

 private:
  bool IsEdge(const ScanLine& line) const;
  int BeamsAt(const ScanLine& line, int begin) const;
  Surfel SurfelOf(const ScanLine& line, Span span) const;

  ScanSurfelOptions options_;
  ScanReturns returns_;
  ScanLineFinder lines_;
};

}  // namespace depthgrid
