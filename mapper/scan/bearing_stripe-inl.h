// Classifies all tiles of a stripe in a group of rows at once, one per SIMD lane (bearing_block.h).
// Included once per instruction set by bearing_block.cc, hence the special include guard.
#if defined(DEPTHGRID_BEARING_STRIPE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_BEARING_STRIPE_INL_H
#undef DEPTHGRID_BEARING_STRIPE_INL_H
#else
#define DEPTHGRID_BEARING_STRIPE_INL_H
#endif

#include <bit>

#include "mapper/scan/bearing_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

constexpr std::size_t kMostTiles = kMostStripeBlocks * kBlockBearings / hn::MaxLanes(Floats());

// One number per tile.
template <class T>
struct alignas(64) PerTile : std::array<T, kMostTiles> {};

// A linear function of the row.
struct AlongRows {
  float at_0 = 0.0F, per_row = 0.0F;
};
struct AllAlongRows {
  PerTile<float> at_0, per_row;
  void Put(std::size_t i, const AlongRows& line) {
    at_0[i] = line.at_0;
    per_row[i] = line.per_row;
  }
  HWY_INLINE Vec At(Floats d, std::size_t i, Vec row) const {
    return hn::Add(hn::Load(d, &at_0[i]), hn::Mul(hn::Load(d, &per_row[i]), row));
  }
  HWY_INLINE Vec LeastOf(Floats d, std::size_t i, Vec first, Vec last) const {
    return hn::Min(At(d, i, first), At(d, i, last));
  }
  HWY_INLINE Vec MostOf(Floats d, std::size_t i, Vec first, Vec last) const {
    return hn::Max(At(d, i, first), At(d, i, last));
  }
};

// The vectors of bearings of a stripe; each vector and group of rows form a tile.
struct StripeVectors {
  std::size_t count = 0;
  PerTile<std::size_t> of, lane;  // block, and first lane in it
  AllAlongRows left, right;       // columns of the first and last lane
  // Bounds of height and range per depth over all rays, rounding included.
  AllAlongRows lowest, highest, shortest;
  PerTile<float> rows_first, rows_last;      // of the block
  PerTile<float> shared_first, shared_last;  // rows used by all of its bearings
  PerTile<float> is_known;                   // 1 if the pixels of its tiles are contiguous, else 0
  PerTile<float> skip_from;                  // ranges from here on do not matter
  PerTile<float> skipped_from;               // skipped tiles hold nothing nearer
};

// Tiles of a group of rows. Padding repeats the last tile.
struct GroupTiles {
  int first_row = 0;
  int first_column = 0, end_column = 0;  // of all of them
  PerTile<float> last_row, is_shared;
  PerTile<int> rows;            // 0 if not in the group
  PerTile<int> start, columns;  // as in Tile
  PerTile<int> inside;          // whether columns need no clamping to the image
  PerTile<float> usable_from;   // no usable depth is smaller; 0 unless all are usable
  PerTile<float> range_from;    // no range is smaller
  PerTile<int> content;
};

// Columns are monotonic in the row, and in the bearing if all rays look ahead, so the corners bound
// them. Otherwise, and in images narrower than two vectors, the columns are unknown.
void LayOut(const StripeVectors& vectors, int width, const RowRange& rows, GroupTiles& tiles) {
  const Floats d;
  const Ints di;
  constexpr float kMargin = 0.01F;  // pixels, for rounding
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const Vec max_column = hn::Set(d, LastColumn(width));
  // Two vectors from `start` on are in the image.
  const Vec max_start = hn::Set(d, static_cast<float>(std::max(width - 2 * lanes, 0)));
  const Vec first = hn::Set(d, static_cast<float>(rows.first));
  const Vec whole_group = hn::Set(d, static_cast<float>(rows.last));
  Vec first_of_all = hn::Set(d, static_cast<float>(width)), end_of_all = zero;
  for (std::size_t i = 0; i < vectors.count; i += static_cast<std::size_t>(lanes)) {
    const Vec last = hn::Min(whole_group, hn::Load(d, &vectors.rows_last[i]));
    const Mask takes_part =
        hn::And(hn::Ge(first, hn::Load(d, &vectors.rows_first[i])), hn::Ge(last, first));
    const Mask is_shared = hn::And(hn::Ge(first, hn::Load(d, &vectors.shared_first[i])),
                                   hn::Le(last, hn::Load(d, &vectors.shared_last[i])));
    const Vec least =
        hn::Min(vectors.left.LeastOf(d, i, first, last), vectors.right.LeastOf(d, i, first, last));
    const Vec most =
        hn::Max(vectors.left.MostOf(d, i, first, last), vectors.right.MostOf(d, i, first, last));
    const Mask is_known = hn::And(takes_part, hn::Gt(hn::Load(d, &vectors.is_known[i]), zero));
    const Vec start = hn::IfThenElseZero(
        is_known, hn::Min(hn::Floor(hn::Min(hn::Max(least, zero), max_column)), max_start));
    const Vec end = hn::Add(hn::Floor(hn::Min(hn::Max(most, zero), max_column)), one);
    const Vec columns = hn::IfThenElseZero(
        is_known,
        hn::Max(hn::Add(hn::Sub(end, start), one), hn::Set(d, static_cast<float>(lanes))));
    const Mask inside = hn::And(hn::Ge(least, hn::Set(d, kMargin)),
                                hn::Le(most, hn::Set(d, LastColumn(width) - kMargin)));
    first_of_all = hn::Min(first_of_all, hn::IfThenElse(is_known, start, first_of_all));
    end_of_all = hn::Max(end_of_all, hn::Add(start, columns));
    const Vec count = hn::IfThenElseZero(takes_part, hn::Add(hn::Sub(last, first), one));
    hn::Store(last, d, &tiles.last_row[i]);
    hn::Store(hn::IfThenElseZero(is_shared, one), d, &tiles.is_shared[i]);
    hn::Store(hn::ConvertTo(di, count), di, &tiles.rows[i]);
    hn::Store(hn::ConvertTo(di, start), di, &tiles.start[i]);
    hn::Store(hn::ConvertTo(di, columns), di, &tiles.columns[i]);
    hn::Store(hn::VecFromMask(di, hn::RebindMask(di, inside)), di, &tiles.inside[i]);
  }
  tiles.first_row = rows.first;
  tiles.first_column = static_cast<int>(hn::GetLane(hn::MinOfLanes(d, first_of_all)));
  tiles.end_column = static_cast<int>(hn::GetLane(hn::MaxOfLanes(d, end_of_all)));
}

// The smallest or largest lane of each vector (a power of two of them), in order.
template <std::size_t kLanes, std::size_t kCount, class Choose>
HWY_INLINE Vec OfEach(Floats d, std::array<Vec, kCount> vectors, const Choose& choose) {
  if constexpr (kLanes == 1) {
    return vectors[0];
  } else {
    constexpr std::size_t kHalf = std::max<std::size_t>(kCount / 2, 1);
    std::array<Vec, kHalf> halves;
    for (std::size_t i = 0; i < kHalf; ++i) {
      const Vec a = vectors[std::min(2 * i, kCount - 1)],
                b = vectors[std::min(2 * i + 1, kCount - 1)];
      halves[i] = choose(hn::ConcatEven(d, b, a), hn::ConcatOdd(d, b, a));
    }
    return OfEach<kLanes / 2>(d, halves, choose);
  }
}

// The smallest or largest lane of `vector_of` each of `count` tiles, a power of two.
template <class VectorOf, class Choose>
HWY_INLINE Vec OfTiles(Floats d, std::size_t count, const VectorOf& vector_of,
                       const Choose& choose) {
  constexpr std::size_t kLanes = hn::MaxLanes(Floats());
  const auto of = [&](auto size) HWY_ATTR {
    std::array<Vec, size()> vectors;
    for (std::size_t k = 0; k < size(); ++k) vectors[k] = vector_of(k);
    return OfEach<kLanes>(d, vectors, choose);
  };
  if constexpr (kLanes >= 16) {
    if (count > 8) return of(std::integral_constant<std::size_t, 16>());
  }
  if (count > 4) return of(std::integral_constant<std::size_t, 8>());
  return of(std::integral_constant<std::size_t, 4>());
}

// For the tiles from `at` on, one per lane: the smallest or largest survey value of their columns;
// `unknown` if their columns are.
template <class Choose>
HWY_INLINE Vec OverColumns(Floats d, const GroupTiles& tiles, std::size_t at, std::size_t count,
                           const float* HWY_RESTRICT survey, float unknown, const Choose& choose) {
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto of_tile = [&](std::size_t k) HWY_ATTR {
    const float* HWY_RESTRICT from = survey + tiles.start[at + k];
    const int columns = tiles.columns[at + k];
    if (HWY_UNLIKELY(columns == 0)) return hn::Set(d, unknown);
    Vec found = choose(hn::LoadU(d, from), hn::LoadU(d, from + (columns - lanes)));
    for (int column = lanes; column + lanes < columns; column += lanes) {
      found = choose(found, hn::LoadU(d, from + column));
    }
    return found;
  };
  return OfTiles(d, count, of_tile, choose);
}

struct Smaller {
  HWY_INLINE Vec operator()(Vec a, Vec b) const { return hn::Min(a, b); }
};
struct Larger {
  HWY_INLINE Vec operator()(Vec a, Vec b) const { return hn::Max(a, b); }
};

// Skip limit by the noise window. Whether skipped groups were far enough is checked afterwards.
class SkipRule {
 public:
  SkipRule(const SkipWidths& widths, float max_range_m)
      : widths_(widths), max_range_m_(max_range_m) {}
  // The range beyond which samples do not matter once each lane has one as near as this: the second
  // mean reaches half a window beyond the first.
  HWY_INLINE Vec From(Floats d, Vec nearest_m) const {
    const Ints di;
    const Vec max_range = hn::Set(d, max_range_m_);
    // Rounding may give a negative range if the principal point is far outside the image.
    const Vec step = hn::Max(hn::Min(hn::Mul(nearest_m, hn::Set(d, 1.0F / SkipWidths::kStepM)),
                                     hn::Set(d, static_cast<float>(SkipWidths::kSteps - 1))),
                             hn::Zero(d));
    const Vec width = hn::GatherIndex(d, widths_.width_m.data(), hn::ConvertTo(di, step));
    const Vec from = hn::Add(nearest_m, hn::Mul(hn::Set(d, 1.5F), width));
    return hn::Min(from, max_range);
  }

 private:
  const SkipWidths& widths_;
  float max_range_m_;
};

void FindSkipFrom(const SkipRule& rule, std::span<const BlockSamples> found,
                  StripeVectors& vectors) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < vectors.count; i += lanes) {
    const std::size_t count = std::min(lanes, std::bit_ceil(vectors.count - i));
    const auto nearest = [&](std::size_t k) HWY_ATTR {
      return hn::Load(d, &found[vectors.of[i + k]].band.nearest[vectors.lane[i + k]]);
    };
    const Vec farthest = OfTiles(d, count, nearest, Larger());
    hn::Store(rule.From(d, farthest), d, &vectors.skip_from[i]);
  }
}

// Survey results of consecutive tiles, one per lane.
struct TileDepths {
  Vec near;     // no usable depth is smaller ...
  Vec most;     // ... and none greater
  Mask usable;  // all are usable
  Mask whole;   // no pixel is missing either
  Mask told;    // unusable pixels are missing, none is too near
};

TileDepths DepthsOf(const ImageBands& bands, const RowRange& rows, const GroupTiles& tiles,
                    std::size_t at, std::size_t count, Survey& survey) {
  constexpr float kFar = 1e30F;
  const Floats d;
  const Vec min_depth = hn::Set(d, bands.limits.min_depth_m);
  const Vec least = OverColumns(d, tiles, at, count, survey.least(), 0.0F, Smaller());
  const Mask whole = hn::Ge(least, min_depth);
  TileDepths depths{least, OverColumns(d, tiles, at, count, survey.most(), kFar, Larger()), whole,
                    whole, whole};
  if (!hn::AllTrue(d, whole)) {
    SurveyHoles(bands.image, rows, survey);
    depths.near = OverColumns(d, tiles, at, count, survey.least_there(), 0.0F, Smaller());
    const Vec nearer = OverColumns(d, tiles, at, count, survey.least_of_two(), 0.0F, Smaller());
    depths.told = hn::Ge(depths.near, min_depth);
    depths.usable = hn::And(depths.told, hn::Gt(nearer, hn::Zero(d)));
  }
  depths.near = hn::Max(depths.near, min_depth);
  return depths;
}

void FindContents(const ImageBands& bands, const StripeVectors& vectors, const RowRange& rows,
                  Survey& survey, GroupTiles& tiles) {
  const Floats d;
  const Ints di;
  const ReturnLimits& limits = bands.limits;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < vectors.count; i += lanes) {
    const std::size_t count = std::min(lanes, std::bit_ceil(vectors.count - i));
    const auto [near, most, usable, whole, told] = DepthsOf(bands, rows, tiles, i, count, survey);
    const Vec first = hn::Set(d, static_cast<float>(rows.first));
    const Vec last = hn::Load(d, &tiles.last_row[i]);
    const Vec low = vectors.lowest.LeastOf(d, i, first, last);
    const Vec high = vectors.highest.MostOf(d, i, first, last);
    const Vec bottom = hn::Min(hn::Mul(near, low), hn::Mul(most, low));
    const Vec top = hn::Max(hn::Mul(near, high), hn::Mul(most, high));
    const Vec range_from = hn::Mul(near, vectors.shortest.LeastOf(d, i, first, last));
    const auto above = [&](Vec a, float b) HWY_ATTR { return hn::Gt(a, hn::Set(d, b)); };
    const auto below = [&](Vec a, float b) HWY_ATTR { return hn::Lt(a, hn::Set(d, b)); };
    const Mask is_shared = hn::Gt(hn::Load(d, &tiles.is_shared[i]), hn::Zero(d));
    const Mask off_slice = hn::Or(below(top, bands.slice.low_m), above(bottom, bands.slice.high_m));
    const Mask off_band = hn::Or(below(top, limits.low_m), above(bottom, limits.high_m));
    const Mask is_mixed = hn::Or(below(bottom, limits.low_m), above(top, limits.high_m));
    const Mask is_plain = hn::And(is_shared, off_slice);
    const Mask is_far = hn::Gt(range_from, hn::Load(d, &vectors.skip_from[i]));
    // Slightly reduced for the rounding of DepthBetween.
    constexpr float kSurfaceShare = 0.999F * kSameSurfaceShare;
    const Mask is_surface =
        hn::And(whole, hn::Le(hn::Sub(most, near), hn::Mul(hn::Set(d, kSurfaceShare), near)));
    // The last true condition applies.
    auto content = hn::Set(di, static_cast<int>(Content::kAnything));
    const auto set = [&](Mask where, Content what) HWY_ATTR {
      content =
          hn::IfThenElse(hn::RebindMask(di, where), hn::Set(di, static_cast<int>(what)), content);
    };
    const Mask in_band = hn::AndNot(is_mixed, usable);
    set(hn::And(is_shared, in_band), Content::kInSlice);
    set(is_plain, Content::kNoSlice);
    set(hn::And(is_plain, usable), Content::kUsable);
    set(hn::And(is_plain, in_band), Content::kInBand);
    set(hn::And(is_plain, hn::And(in_band, is_surface)), Content::kSurface);
    set(hn::And(is_plain, hn::And(told, is_far)), Content::kFarHoles);
    set(hn::And(is_plain, hn::And(told, off_band)), Content::kPassingHoles);
    set(hn::And(is_plain, hn::And(usable, is_far)), Content::kFar);
    set(hn::And(is_plain, hn::And(usable, off_band)), Content::kPassing);
    set(below(most, limits.min_depth_m), Content::kUnusable);
    hn::Store(content, di, &tiles.content[i]);
    hn::Store(range_from, d, &tiles.range_from[i]);
    hn::Store(hn::IfThenElseZero(usable, near), d, &tiles.usable_from[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();
#endif  // guard
