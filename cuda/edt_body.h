// The distance transform of a tile in shared memory: all passes of Algorithm 1 (paper Sect. 5.2) in
// one launch. A pass carries sites by one pixel, so a tile with a margin of `passes` pixels holds
// all that its middle can see, and the result is that of passes over the whole image, bit for bit.
#pragma once

#include <cstdint>

#include "cuda/block.h"
#include "stages/edt_core.h"

namespace rangepose::cuda {

inline constexpr int kEdtTile = 32;
/// More passes than that do not fit into shared memory.
inline constexpr int kEdtTilePasses = 16;
inline constexpr int kEdtSide = kEdtTile + 2 * kEdtTilePasses;
/// Images for tiles are at most this wide and high, so that a coordinate fits into 16 bits.
inline constexpr int kEdtTileImage = 32767;

/// Shared by the threads of a block: 36 kB.
struct EdtShared {
  struct Site {
    std::int16_t x, y;  ///< x < 0: none found
  };
  Site sites[2][kEdtSide * kEdtSide];
  std::int8_t sides[kEdtSide * kEdtSide];  ///< 1 on the object and its edges, -1 on background
};

/// One tile of an image: its upper left pixel is (x0, y0).
struct EdtTileSetup {
  int x0, y0;
  int width, height;  ///< of the image [px]
  int passes;         ///< 1..kEdtTilePasses

  RP_HD int side() const { return kEdtTile + 2 * passes; }
  RP_HD int column(int cell) const { return x0 - passes + cell % side(); }
  RP_HD int row(int cell) const { return y0 - passes + cell / side(); }
  RP_HD bool inImage(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

/// What a whole image would hold at pixel (x, y).
RP_BODY EdtTexel edtCell(const EdtTileSetup& tile,
                         const EdtShared::Site* sites,
                         const std::int8_t* sides,
                         int x,
                         int y) {
  const int cell_x = x - tile.x0 + tile.passes;
  const int cell_y = y - tile.y0 + tile.passes;
  const int side = tile.side();
  EdtTexel texel{0.0f, 0.0f, 0.0f, 0.0f};
  if (cell_x < 0 || cell_y < 0 || cell_x >= side || cell_y >= side) return texel;
  const int cell = cell_y * side + cell_x;
  const float sign = static_cast<float>(sides[cell]);
  if (sites[cell].x < 0) {
    texel.signed_sq = sign * static_cast<float>((tile.passes + 1) * (tile.passes + 1));
    return texel;
  }
  const float site_x = static_cast<float>(sites[cell].x);
  const float site_y = static_cast<float>(sites[cell].y);
  const float ex = site_x - static_cast<float>(x);
  const float ey = site_y - static_cast<float>(y);
  return {site_x, site_y, sign * (ex * ex + ey * ey), 1.0f};
}

template <typename Block, typename Range, typename Edge>
RP_BODY void initEdtTile(Block& block,
                         EdtShared& shared,
                         const EdtTileSetup& tile,
                         const Range& range,
                         const Edge& edge) {
  const int cells = tile.side() * tile.side();
  block.forEachThread([&](int thread) {
    for (int cell = thread; cell < cells; cell += Block::kThreads) {
      const int x = tile.column(cell);
      const int y = tile.row(cell);
      EdtTexel texel{0.0f, 0.0f, 1.0f, 0.0f};
      if (tile.inImage(x, y)) texel = edtInit(x, y, range(x, y), edge(x, y), tile.passes);
      const bool found = texel.found != 0.0f;
      const EdtShared::Site site = {static_cast<std::int16_t>(found ? x : -1),
                                    static_cast<std::int16_t>(y)};
      shared.sites[0][cell] = site;
      shared.sites[1][cell] = site;
      shared.sides[cell] = texel.signed_sq < 0.0f ? -1 : 1;
    }
  });
  block.barrier();
}

/// `write(x, y, texel)` gets the tile's pixels as they are after all passes.
template <typename Block, typename Range, typename Edge, typename Write>
RP_BODY void edtTile(Block& block,
                     EdtShared& shared,
                     const EdtTileSetup& tile,
                     const Range& range,
                     const Edge& edge,
                     const Write& write) {
  initEdtTile(block, shared, tile, range, edge);
  const int side = tile.side();
  for (int pass = 0; pass < tile.passes; ++pass) {
    const EdtShared::Site* from = shared.sites[pass % 2];
    EdtShared::Site* into = shared.sites[1 - pass % 2];
    block.forEachThread([&](int thread) {
      for (int cell = thread; cell < side * side; cell += Block::kThreads) {
        const int x = tile.column(cell);
        const int y = tile.row(cell);
        if (!tile.inImage(x, y)) continue;
        const EdtTexel texel =
            edtStep(x, y, [&](int u, int v) { return edtCell(tile, from, shared.sides, u, v); });
        into[cell] = {static_cast<std::int16_t>(texel.found != 0.0f ? texel.site_x : -1.0f),
                      static_cast<std::int16_t>(texel.site_y)};
      }
    });
    block.barrier();
  }
  block.forEachThread([&](int thread) {
    for (int pixel = thread; pixel < kEdtTile * kEdtTile; pixel += Block::kThreads) {
      const int x = tile.x0 + pixel % kEdtTile;
      const int y = tile.y0 + pixel / kEdtTile;
      if (tile.inImage(x, y)) {
        write(x, y, edtCell(tile, shared.sites[tile.passes % 2], shared.sides, x, y));
      }
    }
  });
}

}  // namespace rangepose::cuda
