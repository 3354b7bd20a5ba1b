#include "eval/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace odis::eval {

namespace {

bool sameWindow(const render::ImageWindow& a, const render::ImageWindow& b) {
  return a.fullWidth == b.fullWidth && a.fullHeight == b.fullHeight && a.x == b.x && a.y == b.y &&
         a.width == b.width && a.height == b.height;
}

void requireSameWindow(const LayeredImage& a, const LayeredImage& b) {
  if (sameWindow(a.window, b.window)) return;
  const auto text = [](const render::ImageWindow& w) {
    return fmt::format("{} x {} at {},{} of {} x {}", w.width, w.height, w.x, w.y, w.fullWidth, w.fullHeight);
  };
  throw ImageError(fmt::format("one image has {} pixels, another {}: they must be of one size and crop",
                               text(a.window), text(b.window)));
}

// "albedo" of "albedo.R", "" of "R".
std::string layerOf(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

// How the average of a channel is made from a sum over images.
enum class Kind { value, variance, standardError };
Kind kindOf(const std::string& channel) {
  const std::string layer = layerOf(channel);
  return layer == "variance" ? Kind::variance : layer == "stderr" ? Kind::standardError : Kind::value;
}

}  // namespace

ChannelSummary summarizeChannel(const std::vector<float>& values) {
  ChannelSummary result;
  uint64_t finite = 0;
  for (const float value : values) {
    if (!std::isfinite(value)) {
      ++result.nonFinite;
      continue;
    }
    result.least = finite == 0 ? value : std::min(result.least, double(value));
    result.most = finite == 0 ? value : std::max(result.most, double(value));
    result.mean += value;
    ++finite;
  }
  if (finite > 0) result.mean /= double(finite);
  return result;
}

std::vector<std::string> layerNames(const LayeredImage& image) {
  std::vector<std::string> names;
  for (const auto& [channel, values] : image.channels) names.push_back(layerOf(channel));
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

ColorImage layerColor(const LayeredImage& image, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  const std::vector<float>* only = nullptr;
  int count = 0;
  for (const auto& [channel, values] : image.channels)
    if (layerOf(channel) == layer) only = &values, ++count;
  std::array<const std::vector<float>*, 3> planes{};
  for (const std::array<const char*, 3>& names :
       {std::array{"R", "G", "B"}, std::array{"X", "Y", "Z"}, std::array{"Y", "Y", "Y"}}) {
    for (size_t c = 0; c < 3; ++c) {
      const auto found = image.channels.find(prefix + names[c]);
      planes[c] = found == image.channels.end() ? nullptr : &found->second;
    }
    if (planes[0] && planes[1] && planes[2]) break;
  }
  if (!planes[0] || !planes[1] || !planes[2]) {
    if (count != 1) {
      std::string there;
      for (const std::string& name : layerNames(image))
        there += (there.empty() ? "" : ", ") + (name.empty() ? "\"\"" : name);
      throw ImageError(
          fmt::format("no layer \"{}\" with R, G and B or a single channel; found layers {}", layer, there));
    }
    planes = {only, only, only};
  }
  ColorImage result{image.window.width, image.window.height, {}};
  for (size_t i = 0; i < planes[0]->size(); ++i)
    result.pixels.emplace_back((*planes[0])[i], (*planes[1])[i], (*planes[2])[i]);
  return result;
}

LayeredImage average(const std::vector<LayeredImage>& images) {
  if (images.empty()) throw std::invalid_argument("the average of no images");
  LayeredImage result;
  result.window = images.front().window;
  result.metadata = images.front().metadata;
  for (const LayeredImage& image : images) requireSameWindow(images.front(), image);
  const auto count = double(images.size());
  for (const auto& [channel, values] : images.front().channels) {
    if (!std::all_of(images.begin(), images.end(),
                     [&, name = channel](const LayeredImage& i) { return i.channels.count(name) == 1; }))
      continue;
    const Kind kind = kindOf(channel);
    std::vector<float>& out = result.channels[channel];
    out.resize(values.size());
    for (size_t i = 0; i < out.size(); ++i) {
      double sum = 0;
      for (const LayeredImage& image : images) {
        const double value = image.channels.at(channel)[i];
        sum += kind == Kind::standardError ? value * value : value;
      }
      out[i] = float(kind == Kind::variance        ? sum / (count * count)
                     : kind == Kind::standardError ? std::sqrt(sum) / count
                                                   : sum / count);
    }
  }
  return result;
}

LayeredImage merge(const std::vector<std::pair<std::string, LayeredImage>>& images) {
  if (images.empty()) throw std::invalid_argument("nothing to merge");
  LayeredImage result;
  result.window = images.front().second.window;
  result.metadata = images.front().second.metadata;
  for (const auto& [name, image] : images) {
    requireSameWindow(images.front().second, image);
    for (const auto& [channel, values] : image.channels) {
      const std::string full = name.empty() ? channel : name + "." + channel;
      if (!result.channels.emplace(full, values).second)
        throw ImageError(fmt::format("two images have a channel {}; name one of them: name=FILE", full));
    }
  }
  return result;
}

void writeLayered(const std::string& path, const LayeredImage& image) {
  std::vector<render::ImageChannel> channels;
  for (const auto& [name, values] : image.channels) channels.push_back({name, values.data()});
  render::writeExr(path, image.window, channels, image.metadata);
}

}  // namespace odis::eval
