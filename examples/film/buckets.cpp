// A host in buckets of 64 x 64 pixels, each with a film of its own that reaches beyond it. Samples are splatted
// at once, and forgotten, but for those of the pass whose weights are settled by its end.
#include "film.h"

constexpr uint32_t kBucketTiles = 4;  // tiles across and down

struct Bucket {
  std::vector<uint32_t> tiles;
  Film film;
  std::vector<Traced> kept;  // until their weights are known
};

std::vector<Bucket> makeBuckets(const odis::TileGrid& tiles, const Settings& settings) {
  std::vector<Bucket> buckets;
  const auto end = [](uint32_t tile, uint32_t size) {
    return std::min(int((tile + kBucketTiles) * odis::kTileSize) + Film::kBorder, int(size));
  };
  for (uint32_t y = 0; y < tiles.rows(); y += kBucketTiles)
    for (uint32_t x = 0; x < tiles.columns(); x += kBucketTiles) {
      const Rectangle area{std::max(int(x * odis::kTileSize) - Film::kBorder, 0),
                           std::max(int(y * odis::kTileSize) - Film::kBorder, 0), end(x, settings.width),
                           end(y, settings.height)};
      Bucket& bucket = buckets.emplace_back(Bucket{{}, Film(area), {}});
      for (uint32_t v = y; v < std::min(y + kBucketTiles, tiles.rows()); ++v)
        for (uint32_t u = x; u < std::min(x + kBucketTiles, tiles.columns()); ++u)
          bucket.tiles.push_back(v * tiles.columns() + u);
    }
  return buckets;
}

int main(int count, char** arguments) try {
  const Settings settings = parseSettings(count, arguments);
  const Scene scene = makeScene(settings.scene);
  const odis::FrameOptions options = frameOptions(settings, scene);
  odis::Frame frame(options);
  const odis::TileGrid tiles(options.width, options.height);
  std::vector<Bucket> buckets = makeBuckets(tiles, settings);
  while (const odis::FramePass* pass = frame.beginPass()) {
    parallelFor(uint32_t(buckets.size()), settings.threads, [&](uint32_t index) {
      Bucket& bucket = buckets[index];
      for (const uint32_t tile : bucket.tiles)
        for (const Traced& s : traceTile(scene, settings, frame, *pass, tiles, tile)) {
          if (pass->weightsLater)
            bucket.kept.push_back(s);
          else
            bucket.film.splat(s, s.weight);
        }
    });
    frame.endPass();
    parallelFor(uint32_t(buckets.size()), settings.threads, [&](uint32_t index) {
      Bucket& bucket = buckets[index];
      for (const Traced& s : bucket.kept) bucket.film.splat(s, frame.sampleWeight(s.pixel, s.sample));
      bucket.kept = {};
    });
  }
  // Borders of neighbours overlap: sums are added, and divided in the end.
  Film film(wholeImage(settings));
  for (const Bucket& bucket : buckets) film.add(bucket.film);
  film.write(settings.output);
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
