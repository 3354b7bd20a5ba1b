#include "eval/agreement.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "eval/image_file.h"
#include "render/image/write.h"

namespace odis::eval {

using render::Rgb;
using render::Rgbd;

Estimate readEstimate(const std::string& path) {
  const render::ExrFile file = readChannels(path);
  const ColorImage color = colorOf(file, path);
  Estimate result{color.width, color.height, color.pixels, std::vector<Rgb>(color.pixels.size())};
  const std::array<const char*, 3> names{"stderr.R", "stderr.G", "stderr.B"};
  for (int c = 0; c < 3; ++c) {
    const auto found = file.channels.find(names[size_t(c)]);
    if (found == file.channels.end())
      throw ImageError(fmt::format("{}: no channel {}; expected the standard errors of R, G and B", path,
                                   names[size_t(c)]));
    for (size_t i = 0; i < result.mean.size(); ++i) result.standardError[i][c] = found->second[i];
  }
  return result;
}

namespace {

// Means over a set of pixels and the variance of their difference.
struct BlockSums {
  Rgbd image{0, 0, 0}, reference{0, 0, 0}, variance{0, 0, 0};

  void add(const Estimate& a, const Estimate& b, size_t pixel) {
    for (int c = 0; c < 3; ++c) {
      image[c] += a.mean[pixel][c];
      reference[c] += b.mean[pixel][c];
      variance[c] += double(a.standardError[pixel][c]) * a.standardError[pixel][c] +
                     double(b.standardError[pixel][c]) * b.standardError[pixel][c];
    }
  }
  // The largest difference of a channel over what is allowed, with its sign.
  float excess() const {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
      const double difference = image[c] - reference[c];
      const double allowed =
          kAgreementErrors * std::sqrt(variance[c]) + kAgreementShare * std::abs(reference[c]) + 1e-30;
      if (std::abs(difference / allowed) > std::abs(worst)) worst = difference / allowed;
    }
    return float(worst);
  }
};

double luminance(const Rgbd& c) {
  return render::luminance(Rgb(float(c.x), float(c.y), float(c.z)));
}

}  // namespace

Agreement agreement(const Estimate& image, const Estimate& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw std::invalid_argument(fmt::format("{} x {} pixels against {} x {}: they must be of one size",
                                            image.width, image.height, reference.width, reference.height));
  Agreement result;
  result.blocksX = (image.width + kAgreementBlock - 1) / kAgreementBlock;
  result.blocksY = (image.height + kAgreementBlock - 1) / kAgreementBlock;
  std::vector<BlockSums> blocks(size_t(result.blocksX) * size_t(result.blocksY));
  BlockSums all;
  size_t beyond = 0;
  for (size_t pixel = 0; pixel < image.mean.size(); ++pixel) {
    const size_t x = pixel % size_t(image.width), y = pixel / size_t(image.width);
    blocks[y / kAgreementBlock * size_t(result.blocksX) + x / kAgreementBlock].add(image, reference, pixel);
    all.add(image, reference, pixel);
    BlockSums one;
    one.add(image, reference, pixel);
    for (int c = 0; c < 3; ++c)
      if (std::abs(one.image[c] - one.reference[c]) > kAgreementErrors * std::sqrt(one.variance[c]) + 1e-30) {
        ++beyond;
        break;
      }
  }
  for (const BlockSums& block : blocks) {
    result.excess.push_back(block.excess());
    result.agreeing += std::abs(result.excess.back()) <= 1;
  }
  result.blocks = int(blocks.size());
  result.pixelsBeyond = double(beyond) / double(image.mean.size());
  const double mean = luminance(all.reference);
  result.meanRatio = luminance(all.image) / mean;
  // Channels mostly rise and fall together, so their errors are added and not their variances.
  const Rgbd errors(std::sqrt(all.variance.x), std::sqrt(all.variance.y), std::sqrt(all.variance.z));
  result.meanRatioError = luminance(errors) / mean;
  return result;
}

}  // namespace odis::eval
