// A scan as surfels, in base axes: what is matched and what is mapped.
#pragma once

#include <vector>

#include "mapper/core/options.h"
#include "mapper/surfel/scan_lines.h"
#include "mapper/surfel/surfel.h"

namespace depthgrid {

struct ScanSurfelOptions {
  // A surfel has the mean of so many beams at most; a line's normal comes from all of its beams.
  int beams = 8;
  // Nor is it longer than this, so that coarse scanners keep details.
  double max_length_m = 0.2;
  double jump_sigmas = 5.0;
  double split_chi2 = 12.0;
  int min_line_beams = 4;
  // Surfels of a line that fits its beams badly are believed less.
  bool judge_fit = true;
  // Of beams that err alike only every so many count (RangeNoise::stride).
  bool skip_alike = true;
  // Returns near the sensor's reach are corrected for those that noise pushed beyond it.
  bool correct_cutoff = true;

  void Visit(OptionsVisitor& v);
};

class ScanSurfelMaker {
 public:
  explicit ScanSurfelMaker(const ScanSurfelOptions& options)
      : options_(options),
        returns_(options.jump_sigmas),
        lines_(options.split_chi2, options.min_line_beams, options.correct_cutoff) {}

  // Of every `stride`-th beam: 1, or the noise's own. `memory`: of an earlier result, to be used
  // again.
  std::vector<Surfel> Make(const Scan& scan, const RangeNoise& noise, int stride,
                           std::vector<Surfel> memory = {});
  std::vector<Surfel> Make(const Scan& scan, const RangeNoise& noise) {
    return Make(scan, noise, noise.stride());
  }

 private:
  int BeamsAt(const ScanLine& line, int begin) const;
  Surfel SurfelOf(const ScanLine& line, Span span) const;

  ScanSurfelOptions options_;
  ScanReturns returns_;
  ScanLineFinder lines_;
};

}  // namespace depthgrid
