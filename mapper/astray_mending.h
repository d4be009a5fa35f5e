// Puts a finished map right that something which moves along led astray (docs/math.md, "Led
// astray").
#pragma once

#include <vector>

#include "mapper/astray_parts.h"
#include "mapper/map_joining.h"

namespace depthgrid {

class AstrayMending {
 public:
  // `joining`, `options` and `reference`: of the same run.
  AstrayMending(const LoopOptions& options, const MapJoining& joining, ReferenceMap& reference)
      : options_(options), joining_(joining), reference_(reference) {}

  // The map with SLAM followed over the parts in which that contradicts nothing that was seen.
  JoinedMap Mended(JoinedMap map);
  // Parts of that map in which neither way contradicts what was seen, and it is not SLAM's.
  const std::vector<AstrayPart>& undecided() const { return undecided_; }

 private:
  enum class Verdict { kFollowSlam, kSlamIsWrong, kUndecided };
  // On kFollowSlam `map` is the mended one.
  Verdict Judge(const AstrayPart& part, JoinedMap& map) const;
  // The part across which most is apart, of those not examined yet.
  std::optional<AstrayPart> Next(const JoinedMap& map) const;

  const LoopOptions& options_;
  const MapJoining& joining_;
  ReferenceMap& reference_;
  std::vector<AstrayPart> examined_;
  std::vector<AstrayPart> undecided_;
};

}  // namespace depthgrid
