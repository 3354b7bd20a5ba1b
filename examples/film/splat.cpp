// A film that splats, with AOVs and groups of lights: the simplest way, which keeps the samples of a pass and
// splats them when it has ended. All weights are known by then.
#include "film.h"

int main(int count, char** arguments) try {
  const Settings settings = parseSettings(count, arguments);
  const Scene scene = makeScene(settings.scene);
  const odis::FrameOptions options = frameOptions(settings, scene);
  odis::Frame frame(options);
  Film film(wholeImage(settings));
  const odis::TileGrid tiles(options.width, options.height);
  while (const odis::FramePass* pass = frame.beginPass()) {
    std::vector<std::vector<Traced>> samples(tiles.tileCount());
    parallelFor(tiles.tileCount(), settings.threads, [&](uint32_t tile) {
      samples[tile] = traceTile(scene, settings, frame, *pass, tiles, tile);
    });
    frame.endPass();
    // One tile after another, so that the image has the same bits for any number of threads.
    for (const std::vector<Traced>& ofTile : samples)
      for (const Traced& s : ofTile) film.splat(s, frame.sampleWeight(s.pixel, s.sample));
  }
  film.write(settings.output);
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
