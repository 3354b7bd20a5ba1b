// A host with a film of its own: samples that are splatted with the weights that a frame tells make the image
// that the film's filter says. docs/unbiasedness.md#films-that-splat
#include "frame/film.h"
#include "frame/run_frame.h"

namespace odis::test {

namespace {

TEST(OwnFilm, WithABoxFilterIsTheMean) {
  for (const double pilot : {0.25, 1.0, 2.0}) {
    FrameOptions options = toyOptions(24, 24, 8);
    options.set("pilot-spp=" + std::to_string(pilot));
    Frame frame(options);
    SplatFilm film(24, 24, kBox);
    const ToyHost host({}, 24, 24);
    renderInto(film, frame, 24 * 24, toyTrace(host));
    for (uint32_t pixel = 0; pixel < 24 * 24; ++pixel) {
      const double expected = frame.mean(pixel).color.y;
      EXPECT_NEAR(film.mean(pixel, SplatFilm::beauty), expected, 1e-5 * (1 + expected));
      const double parts = film.mean(pixel, SplatFilm::lamp0) + film.mean(pixel, SplatFilm::lamp1) +
                           film.mean(pixel, SplatFilm::otherLight);
      EXPECT_NEAR(parts, expected, 1e-5 * (1 + expected));
      EXPECT_GT(film.mean(pixel, SplatFilm::distance), 0);
    }
  }
}

// A wall that is black left of column kEdge and white right of it. The frame hears of noise that begins 12
// columns further to the right, as far as counts look around: black pixels get about half as many samples as
// were asked for, white ones three times as many, or nearly twice where few pilot samples tell of the noise.
constexpr uint32_t kWallWidth = 160, kWallHeight = 8, kEdge = 132;

FilmSample traceWall(const FramePass& pass, uint32_t pixel, uint32_t sample, PathRecorder&) {
  ToyNumbers numbers(pass.seed, pixel, sample);
  const uint32_t column = pixel % kWallWidth;
  FilmSample result;
  const float noise = column < kEdge + 12 ? 0 : sample % 2 == 0 ? -0.9f : 0.9f;
  result.sample = {pixel, sample, gray(1 + noise), 1};
  result.splat.x = float(column) + numbers.next();
  result.splat.y = float(pixel / kWallWidth) + numbers.next();
  result.splat.values[SplatFilm::beauty] = column < kEdge ? 0 : 1;
  return result;
}

// The integral of the Gaussian from `begin` on.
double gaussianFrom(double begin) {
  constexpr int kSteps = 3000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = -1.5 + 3 * (i + 0.5) / kSteps;
    if (x >= begin) sum += double(kGaussian.value(float(x))) * 3 / kSteps;
  }
  return sum;
}

// A column of the wall over many images: the mean of A / (N times the integral of f) over rows that f doesn't
// leave, and of A / B.
struct WallColumn {
  double truth = 0, sum = 0, squares = 0, ratios = 0;
  int images = 0;

  void add(const SplatFilm& film, uint32_t column, uint32_t samplesPerPixel) {
    double sums = 0, means = 0;
    for (uint32_t row = 1; row + 1 < kWallHeight; ++row) {
      sums += film.sum(row * kWallWidth + column, SplatFilm::beauty) / (kWallHeight - 2);
      means += film.mean(row * kWallWidth + column, SplatFilm::beauty) / (kWallHeight - 2);
    }
    const double all = gaussianFrom(-2), value = sums / (samplesPerPixel * all * all);
    truth = gaussianFrom(double(kEdge) - column - 0.5) / all;
    sum += value;
    squares += value * value;
    ratios += means;
    ++images;
  }
  double ratio() const { return ratios / images; }
  // In standard errors.
  double distance() const {
    const double mean = sum / images;
    return (mean - truth) / std::sqrt((squares / images - mean * mean) / (images - 1));
  }
};

// Means of 64 images, for the columns at the left and at the right of the edge. The last of the samples per
// pixel are those of the options; each other number begins a round.
std::vector<WallColumn> renderWalls(FrameOptions options, bool weightOne,
                                    const std::vector<uint32_t>& rounds = {}) {
  std::vector<WallColumn> columns(2);
  for (options.seed = 1; options.seed <= 64; ++options.seed) {
    SplatFilm film(kWallWidth, kWallHeight, kGaussian);
    Frame frame = renderRounds(film, options, rounds, traceWall, weightOne);
    const uint32_t middle = 4 * kWallWidth + kEdge;
    const double least = readSetting(options.settings, "pilot-spp") == "0.250000" ? 1.75 : 3;
    EXPECT_LE(frame.sampleCount(middle - 1), options.samplesPerPixel * 0.65);
    EXPECT_GE(frame.sampleCount(middle), options.samplesPerPixel * least);
    for (uint32_t i = 0; i < 2; ++i) columns[i].add(film, kEdge - 1 + i, options.samplesPerPixel);
  }
  return columns;
}

TEST(OwnFilm, SplatsAnEdgeBetweenFewSamplesAndMany) {
  const double significance = 1 - std::pow(0.99, 1.0 / 8);
  for (const double pilot : {0.0, 0.25, 1.0, 2.0}) {  // 0: nothing is guided
    FrameOptions options = toyOptions(kWallWidth, kWallHeight, 16);
    options.set(pilot > 0 ? "pilot-spp=" + std::to_string(pilot) : "guided=off samples=adaptive");
    for (const WallColumn& column : renderWalls(options, false)) {
      EXPECT_GT(std::erfc(std::abs(column.distance()) / std::sqrt(2.0)), significance)
          << column.truth << ", z = " << column.distance();
      EXPECT_NEAR(column.ratio(), column.truth, 0.01);
    }
  }
}

// The first round ends with the pilot, before counts are settled, or after.
TEST(OwnFilm, SplatsAnEdgeInRounds) {
  const double significance = 1 - std::pow(0.99, 1.0 / 12);
  for (const double pilot : {0.0, 0.25, 1.0})
    for (const std::vector<uint32_t>& rounds : {std::vector<uint32_t>{8}, {1, 2, 4}}) {
      FrameOptions options = toyOptions(kWallWidth, kWallHeight, 16);
      options.set(pilot > 0 ? "pilot-spp=" + std::to_string(pilot) : "guided=off samples=adaptive");
      for (const WallColumn& column : renderWalls(options, false, rounds)) {
        EXPECT_GT(std::erfc(std::abs(column.distance()) / std::sqrt(2.0)), significance)
            << column.truth << ", z = " << column.distance();
        EXPECT_NEAR(column.ratio(), column.truth, 0.01);
      }
    }
}

// The mistake that weights are there to avoid: a pixel that has many samples counts more in its neighbours.
TEST(OwnFilm, IsWrongAtAnEdgeIfSamplesWeighAsMuch) {
  FrameOptions options = toyOptions(kWallWidth, kWallHeight, 16);
  for (const uint32_t samplesPerPixel : {16, 128}) {
    options.samplesPerPixel = samplesPerPixel;
    for (const WallColumn& column : renderWalls(options, true)) EXPECT_GT(column.ratio(), column.truth + 0.1);
  }
}

// [image][layer][pixel] of many seeds, each divided by the number of samples per pixel.
using Films = std::vector<std::vector<double>>;
constexpr uint32_t kToySide = 16;
constexpr SplatFilm::Layer kCompared[] = {SplatFilm::beauty, SplatFilm::lamp0, SplatFilm::lamp1};

Films renderToyFilms(const FrameOptions& options, uint64_t firstSeed,
                     const std::vector<uint32_t>& rounds = {}) {
  Films films(static_cast<size_t>(imagesToCompare(64)));
  core::libraryTasks()->forEach(films.size(), [&](size_t i) {
    FrameOptions own = options;
    own.seed = firstSeed + i;
    const ToyHost host({}, kToySide, kToySide);
    SplatFilm film(kToySide, kToySide, kGaussian);
    renderRounds(film, own, rounds, toyTrace(host));
    for (const SplatFilm::Layer layer : kCompared)
      for (uint32_t pixel = 0; pixel < kToySide * kToySide; ++pixel)
        films[i].push_back(film.sum(pixel, layer) / options.samplesPerPixel);
  });
  return films;
}

// The mean over films, and the variance of that mean.
std::pair<double, double> meanOf(const Films& films, size_t value) {
  double sum = 0, squares = 0;
  for (const std::vector<double>& film : films) {
    sum += film[value];
    squares += film[value] * film[value];
  }
  const double count = double(films.size()), mean = sum / count;
  return {mean, (squares / count - mean * mean) / (count - 1)};
}

void expectSameFilm(const Films& a, const Films& b) {
  if (kThreadSanitized) return;
  const double significance = 1 - std::pow(0.99, 1.0 / double(a[0].size()));
  for (size_t i = 0; i < a[0].size(); ++i) {
    const auto [meanA, varianceA] = meanOf(a, i);
    const auto [meanB, varianceB] = meanOf(b, i);
    const double z = (meanA - meanB) / std::sqrt(varianceA + varianceB);
    EXPECT_GT(std::erfc(std::abs(z) / std::sqrt(2.0)), significance)
        << "layer " << i / (kToySide * kToySide) << ", pixel " << i % (kToySide * kToySide) << ": " << meanA
        << " and " << meanB << ", z = " << z;
  }
}

TEST(OwnFilm, OfGuidedSamplesHasTheExpectationOfUnguidedOnes) {
  FrameOptions guided = toyOptions(kToySide, kToySide, 16), path = guided;
  path.set("guided=off samples=even");
  path.samplesPerPixel = 64;
  const Films unguided = renderToyFilms(path, 1000);
  expectSameFilm(renderToyFilms(guided, 1), unguided);
  expectSameFilm(renderToyFilms(guided, 2000, {1, 3, 6, 7}), unguided);
}

}  // namespace

}  // namespace odis::test
