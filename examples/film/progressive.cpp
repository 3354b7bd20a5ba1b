// A progressive host: there is an image after every pass, and the rendering may end after any of them and go
// on another day, with the same bits as if it had not ended. It goes on in rounds of 1, 2, 4, ... samples per
// pixel in all, up to --spp, after each of which the film is right; another day that may be more. --passes
// ends it, --save names the file that it goes on from.
#include "film.h"

// A frame that was saved, with its film, or a new one.
odis::Frame openFrame(const Settings& settings, const odis::FrameOptions& options, Film& film) {
  std::FILE* file = settings.save.empty() ? nullptr : std::fopen(settings.save.c_str(), "rb");
  if (!file) return odis::Frame(options);
  std::fclose(file);
  odis::Frame frame = odis::Frame::load(settings.save, options.guide.model);
  film.restore(frame.hostData());
  return frame;
}

int main(int count, char** arguments) try {
  const Settings settings = parseSettings(count, arguments);
  const Scene scene = makeScene(settings.scene);
  odis::FrameOptions options = frameOptions(settings, scene);
  options.samplesPerPixel = 1;
  options.mostSamplesPerPixel = ODIS_UNLIMITED;
  Film film(wholeImage(settings));
  odis::Frame frame = openFrame(settings, options, film);
  const odis::TileGrid tiles(options.width, options.height);
  for (uint32_t passes = 0; passes < settings.passes; ++passes) {
    const odis::FramePass* pass = frame.beginPass();
    if (!pass) {  // a round is complete
      const uint32_t asked = frame.statistics().samplesPerPixel;
      if (asked >= settings.spp) break;
      frame.extend(std::min(2 * asked, settings.spp));
      pass = frame.beginPass();
    }
    const bool weightsLater = pass->weightsLater;
    std::vector<std::vector<Traced>> samples(tiles.tileCount());
    parallelFor(tiles.tileCount(), settings.threads, [&](uint32_t tile) {
      samples[tile] = traceTile(scene, settings, frame, *pass, tiles, tile);
    });
    // The library learns on a thread of its own while this one makes the image.
    frame.startEndPass();
    if (weightsLater) frame.waitForPass();
    for (const std::vector<Traced>& ofTile : samples)
      for (const Traced& s : ofTile)
        film.splat(s, weightsLater ? frame.sampleWeight(s.pixel, s.sample) : s.weight);
    film.write(settings.output);
    if (!weightsLater) frame.waitForPass();
    frame.setHostData(film.bytes());
    if (!settings.save.empty()) frame.save(settings.save);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
