// Converts the pixels of some bearings and rows to samples (bearing_block.h). Included once per
// instruction set by bearing_block.cc, hence the special include guard.
#if defined(DEPTHGRID_BEARING_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_BEARING_TILE_INL_H
#undef DEPTHGRID_BEARING_TILE_INL_H
#else
#define DEPTHGRID_BEARING_TILE_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "mapper/scan/bearing_block.h"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBlockBearings>;
using Ints = hn::RebindToSigned<Floats>;
using Vec = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

// A tile: the lanes of one vector in a group of rows.
struct Tile {
  const ImageBands* bands;
  const BearingBlock* block;
  std::size_t lane;  // the first, in the block
  RowRange rows;
  // First column used by any sample, and number of contiguous columns; 0 if unknown.
  int start = 0;
  int columns = 0;
  bool inside = false;  // whether columns need no clamping to the image

  std::size_t RowCount() const { return static_cast<std::size_t>(rows.last - rows.first + 1); }
  // Pointers to the tile's samples and groups in the block.
  std::size_t AtRow() const {
    return static_cast<std::size_t>(rows.first - block->rows.first) * kBlockBearings + lane;
  }
  std::size_t AtGroup() const {
    const auto row = static_cast<std::size_t>(rows.first - block->rows.first);
    return row / kGroupRows * kBlockBearings + lane;
  }
};

// Content of a tile, which determines what is computed.
enum class Content : std::uint8_t {
  kAnything,
  kInSlice,  // all usable and in the band, some of it in the slice
  kNoSlice,  // nothing in the slice
  kUsable,   // ... and all usable
  kInBand,   // ... and in the band
  kSurface,  // ... and of one surface
  // For the following, which have nothing in the slice, only usability is computed.
  kPassing,       // all usable and outside the band
  kPassingHoles,  // some are missing
  kFar,           // all usable and too far away to matter
  kFarHoles,      // some are missing
  kUnusable,      // all unusable
};
constexpr bool IsFar(Content content) {
  return content == Content::kFar || content == Content::kFarHoles;
}

// How the two pixels around each lane's column are loaded.
enum class Fetch : std::uint8_t {
  kTwoVectors,  // from two vectors of neighbouring pixels
  kInside,      // the same, without clamping of columns
  kGather,      // from anywhere
};

struct Pixels {
  Vec z0, z1;
};

// Lanes `index` of two concatenated vectors.
HWY_INLINE Vec LookUp(Floats d, Vec left, Vec right, hn::Vec<Ints> index) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hn::MaxLanes(Floats()) == 16) {
    return Vec{_mm512_permutex2var_ps(left.raw, index.raw, right.raw)};
  }
#endif
  const Ints di;
  const auto lanes = hn::Set(di, static_cast<int>(hn::Lanes(d)));
  const auto within = hn::IndicesFromVec(d, hn::And(index, hn::Sub(lanes, hn::Set(di, 1))));
  return hn::IfThenElse(hn::RebindMask(d, hn::Lt(index, lanes)), hn::TableLookupLanes(left, within),
                        hn::TableLookupLanes(right, within));
}

// Integer part and fraction of a non-negative column.
struct Column {
  hn::Vec<Ints> whole;
  Vec share;
};
HWY_INLINE Column ColumnOf(Floats d, Vec u) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hn::MaxLanes(Floats()) == 16) {
    constexpr __mmask16 kAll = 0xFFFF;  // without masks g++ 12 warns of its own header
    const __m512i whole = _mm512_maskz_cvttps_epi32(kAll, u.raw);
    return {hn::Vec<Ints>{whole}, hn::Sub(u, Vec{_mm512_maskz_cvtepi32_ps(kAll, whole)})};
  }
#endif
  // An integer below 2^23 is the bits after adding 2^23, minus the bits of 2^23.
  constexpr float kTwoTo23 = 8388608.0F;
  constexpr int kBits = 0x4B000000;
  const Ints di;
  const Vec whole = hn::Floor(u);
  return {hn::Sub(hn::BitCast(di, hn::Add(whole, hn::Set(d, kTwoTo23))), hn::Set(di, kBits)),
          hn::Sub(u, whole)};
}

// `row` begins at column `start`; at column 0 where pixels are gathered.
template <Fetch kFetch>
HWY_INLINE Pixels FetchPixels(Floats d, const float* HWY_RESTRICT row, hn::Vec<Ints> start,
                              hn::Vec<Ints> column) {
  const Ints di;
  if constexpr (kFetch == Fetch::kGather) {
    return {hn::GatherIndex(d, row, column), hn::GatherIndex(d, row + 1, column)};
  } else {
    const auto index = hn::Sub(column, start);
    const Vec left = hn::LoadU(d, row), right = hn::LoadU(d, row + hn::Lanes(d));
    return {LookUp(d, left, right, index), LookUp(d, left, right, hn::Add(index, hn::Set(di, 1)))};
  }
}

// Where a row's pixels are: `pixels` points to column `first_column`.
struct RowOfPixels {
  const float* HWY_RESTRICT pixels;
  int first_column;
  int width;
};

// The branch of DepthBetweenFew() of bearing_returns.h whose 1/z goes on; `otherwise` elsewhere.
HWY_NOINLINE Vec WhereSlopeGoesOn(Floats d, const RowOfPixels& row, const Pixels& pixels,
                                  hn::Vec<Ints> column, Vec share, Vec otherwise) {
  const Ints di;
  const auto at = [&](auto wanted) HWY_ATTR {
    return hn::GatherIndex(d, row.pixels, hn::Sub(wanted, hn::Set(di, row.first_column)));
  };
  const Vec before = at(hn::Max(hn::Sub(column, hn::Set(di, 1)), hn::Zero(di)));
  const Vec after = at(hn::Min(hn::Add(column, hn::Set(di, 2)), hn::Set(di, row.width - 1)));
  const Vec one = hn::Set(d, 1.0F);
  const Vec w0 = hn::Div(one, pixels.z0), w1 = hn::Div(one, pixels.z1);
  const Vec slope = hn::Sub(w1, w0);
  const Vec tolerance = hn::Mul(hn::Set(d, kSlopeShare), hn::Abs(slope));
  const Vec left = hn::Abs(hn::Sub(hn::Sub(w0, hn::Div(one, before)), slope));
  const Vec right = hn::Abs(hn::Sub(hn::Sub(hn::Div(one, after), w1), slope));
  const Mask goes_on = hn::Or(hn::Le(left, tolerance), hn::Le(right, tolerance));
  const Vec between = hn::Div(one, hn::Add(w0, hn::Mul(share, slope)));
  const Mask both_usable = hn::Gt(hn::Min(pixels.z0, pixels.z1), hn::Zero(d));
  return hn::IfThenElse(hn::And(both_usable, goes_on), between, otherwise);
}

// Vectorised DepthBetween() of bearing_returns.h, and DepthBetweenFew() in images of few columns.
template <bool kOneSurface>
HWY_INLINE Vec DepthBetweenLanes(Floats d, const RowOfPixels& row, const Pixels& pixels,
                                 const Column& column) {
  const Vec share = column.share;
  const auto [z0, z1] = pixels;
  const Vec difference = hn::Sub(z1, z0);
  const Vec between = hn::Add(z0, hn::Mul(share, difference));
  if constexpr (kOneSurface) return between;
  const Vec tolerance = hn::Mul(hn::Set(d, kSameSurfaceShare), hn::Min(z0, z1));
  const Mask same_surface = hn::Le(hn::Abs(difference), tolerance);
  if (HWY_LIKELY(hn::AllTrue(d, same_surface))) return between;
  const Vec nearer = hn::IfThenElse(hn::Lt(share, hn::Set(d, 0.5F)), z0, z1);
  Vec apart = hn::IfThenElse(hn::Gt(nearer, hn::Zero(d)), nearer, hn::Max(z0, z1));
  if (row.width <= kFewColumns) {
    apart = WhereSlopeGoesOn(d, row, pixels, column.whole, share, apart);
  }
  return hn::IfThenElse(same_surface, between, apart);
}

HWY_INLINE void StoreNearest(const Tile& tile, Vec nearest, Vec slice_nearest, BlockSamples& out) {
  const Floats d;
  hn::Store(nearest, d, out.band.samples.nearest + tile.AtGroup());
  hn::Store(slice_nearest, d, out.slice.samples.nearest + tile.AtGroup());
  float* const so_far = &out.band.nearest[tile.lane];
  hn::Store(hn::Min(hn::Load(d, so_far), nearest), d, so_far);
  float* const slice_so_far = &out.slice.nearest[tile.lane];
  hn::Store(hn::Min(hn::Load(d, slice_so_far), slice_nearest), d, slice_so_far);
}

// Computes the samples of a tile of content `kContent`.
template <Fetch kFetch, Content kContent>
HWY_NOINLINE void SampleTile(const Tile& tile, BlockSamples& out) {
  constexpr bool kHoles = kContent == Content::kPassingHoles;  // or kFarHoles
  constexpr bool kSlice = kContent == Content::kAnything || kContent == Content::kInSlice;
  constexpr bool kMixed = kContent == Content::kAnything || kContent == Content::kNoSlice ||
                          kContent == Content::kUsable;
  constexpr bool kAllUsable = kContent != Content::kAnything && kContent != Content::kNoSlice;
  const Floats d;
  const BearingBlock& block = *tile.block;
  const std::size_t i = tile.lane;
  const Vec u0 = hn::Load(d, &block.lines->u0[i]), u1 = hn::Load(d, &block.lines->u1[i]);
  const Vec h0 = hn::Load(d, &block.lines->h0[i]), h1 = hn::Load(d, &block.lines->h1[i]);
  const Vec g0 = hn::Load(d, &block.lines->g0[i]), g1 = hn::Load(d, &block.lines->g1[i]);
  const Vec first = hn::Load(d, &block.first[i]), last = hn::Load(d, &block.last[i]);
  const Vec min_depth = hn::Set(d, tile.bands->limits.min_depth_m);
  const Vec low = hn::Set(d, tile.bands->limits.low_m),
            high = hn::Set(d, tile.bands->limits.high_m);
  const Vec slice_low = hn::Set(d, tile.bands->slice.low_m),
            slice_high = hn::Set(d, tile.bands->slice.high_m);
  const Vec passing = hn::Set(d, kPassing), unusable = hn::Set(d, kUnusable);
  // Local copies, as vector stores may alias anything behind a pointer.
  const std::size_t rows = tile.RowCount();
  const std::ptrdiff_t width = tile.bands->image.width_px;
  const int first_column = kFetch == Fetch::kGather ? 0 : tile.start;
  const auto start = hn::Set(Ints(), first_column);
  const Vec max_column = hn::Set(d, LastColumn(tile.bands->image.width_px));
  Vec nearest = unusable, slice_nearest = passing;
  Vec row = hn::Set(d, static_cast<float>(tile.rows.first));
  const float* HWY_RESTRICT pixels = tile.bands->image.Row(tile.rows.first) + first_column;
  float* HWY_RESTRICT samples = out.band.samples.samples + tile.AtRow();
  float* HWY_RESTRICT slice = kSlice ? out.slice.samples.samples + tile.AtRow() : nullptr;
  for (std::size_t r = 0; r < rows; ++r) {
    Vec u = hn::Add(u0, hn::Mul(u1, row));
    if constexpr (kFetch != Fetch::kInside) u = hn::Min(hn::Max(u, hn::Zero(d)), max_column);
    const Column column = ColumnOf(d, u);
    const Pixels both = FetchPixels<kFetch>(d, pixels, start, column.whole);
    Vec sample;
    if constexpr (kHoles) {
      sample = hn::IfThenElse(hn::Gt(hn::Max(both.z0, both.z1), hn::Zero(d)), passing, unusable);
    } else {
      const Vec z = DepthBetweenLanes<kContent == Content::kSurface>(
          d, {pixels, first_column, static_cast<int>(width)}, both, column);
      const Vec range = hn::Mul(z, hn::Add(h0, hn::Mul(h1, row)));
      sample = range;
      if constexpr (kMixed || kSlice) {
        const Vec height = hn::Mul(z, hn::Add(g0, hn::Mul(g1, row)));
        Mask usable = hn::Ge(z, min_depth);
        if constexpr (kSlice) {
          Mask level = hn::And(hn::Ge(height, slice_low), hn::Le(height, slice_high));
          if constexpr (!kAllUsable) {
            usable = hn::And(usable, hn::And(hn::Ge(row, first), hn::Le(row, last)));
            level = hn::And(usable, level);
          }
          const Vec level_sample = hn::IfThenElse(level, range, passing);
          hn::Store(level_sample, d, slice);
          slice_nearest = hn::Min(slice_nearest, level_sample);
          slice += kBlockBearings;
        }
        if constexpr (kMixed) {
          const Mask marks = hn::And(hn::Ge(height, low), hn::Le(height, high));
          sample = hn::IfThenElse(marks, range, passing);
          if constexpr (!kAllUsable) sample = hn::IfThenElse(usable, sample, unusable);
        }
      }
    }
    hn::Store(sample, d, samples);
    nearest = hn::Min(nearest, sample);
    row = hn::Add(row, hn::Set(d, 1.0F));
    pixels += width;
    samples += kBlockBearings;
  }
  if constexpr (!kHoles) StoreNearest(tile, nearest, slice_nearest, out);
}

// Fills in groups without a range.
HWY_INLINE void SampleNothing(const Tile& tile, float nearest, BlockSamples& out) {
  const Floats d;
  hn::Store(hn::Set(d, nearest), d, out.band.samples.nearest + tile.AtGroup());
  hn::Store(hn::Set(d, kPassing), d, out.slice.samples.nearest + tile.AtGroup());
}

void SampleUnusable(const Tile& tile, BlockSamples& out) {
  const Floats d;
  float* HWY_RESTRICT samples = out.band.samples.samples + tile.AtRow();
  for (std::size_t r = 0; r < tile.RowCount(); ++r, samples += kBlockBearings) {
    hn::Store(hn::Set(d, kUnusable), d, samples);
  }
  SampleNothing(tile, kUnusable, out);
}

template <Fetch kFetch>
HWY_INLINE void SampleTileAs(Content content, const Tile& tile, BlockSamples& out) {
  switch (content) {
    case Content::kAnything:
      return SampleTile<kFetch, Content::kAnything>(tile, out);
    case Content::kInSlice:
      return SampleTile<kFetch, Content::kInSlice>(tile, out);
    case Content::kNoSlice:
      return SampleTile<kFetch, Content::kNoSlice>(tile, out);
    case Content::kUsable:
      return SampleTile<kFetch, Content::kUsable>(tile, out);
    case Content::kInBand:
      return SampleTile<kFetch, Content::kInBand>(tile, out);
    case Content::kSurface:
      return SampleTile<kFetch, Content::kSurface>(tile, out);
    case Content::kPassingHoles:
    case Content::kFarHoles:
      SampleTile<kFetch, Content::kPassingHoles>(tile, out);
      return SampleNothing(tile, IsFar(content) ? kSkipped : kPassing, out);
    case Content::kPassing:
    case Content::kFar:
      return SampleNothing(tile, IsFar(content) ? kSkipped : kPassing, out);
    case Content::kUnusable:
      return SampleUnusable(tile, out);
  }
}

void SampleAs(Content content, const Tile& tile, BlockSamples& out) {
  if (tile.columns > 0 && tile.columns <= static_cast<int>(2 * hn::Lanes(Floats()))) {
    tile.inside ? SampleTileAs<Fetch::kInside>(content, tile, out)
                : SampleTileAs<Fetch::kTwoVectors>(content, tile, out);
  } else {
    SampleTileAs<Fetch::kGather>(content, tile, out);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();
#endif  // guard
