// The network at pixels by oneDNN, 2.6 to 3.x: a library of its own, which the library loads. Values lie as
// [place][row][column][channel]. A map's wrap-around is no padding that oneDNN knows: every convolution gets
// its input with a border of one texel, filled here, and with what comes from the levels above and below.
#include "odis/pixels/pixel_convolutions.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <dnnl.hpp>
#include <unordered_map>

#include "odis/pixels/pixel_model.h"

namespace odis::core {

namespace {

using dnnl::memory;

// The texels of the border around a square, and which of its own texels each repeats; both are counted row by
// row, border included.
struct Border {
  struct Texel {
    uint16_t at, repeats;
  };
  std::vector<Texel> texels;

  explicit Border(int side) {
    const int width = side + 2;
    for (int y = -1; y <= side; ++y)
      for (int x = -1; x <= side; ++x) {
        int column = x, row = y;
        wrapTexel(column, row, side);
        if (column == x && row == y) continue;
        texels.push_back({uint16_t((y + 1) * width + x + 1), uint16_t((row + 1) * width + column + 1)});
      }
  }
};

memory::desc activations(size_t count, int side, uint32_t channels) {
  return {{memory::dim(count), memory::dim(channels), side, side},
          memory::data_type::f32,
          memory::format_tag::nhwc};
}

// A 3 x 3 convolution for kPixelBatch places at once, rectified if asked for.
class Convolution {
 public:
  Convolution(const dnnl::engine& engine, const PixelLayer& layer, int side, bool rectify)
      : m_side(side), m_inputs(layer.inputs), m_outputs(layer.outputs) {
    const memory::desc in = activations(kPixelBatch, side + 2, m_inputs);
    const memory::desc out = activations(kPixelBatch, side, m_outputs);
    const memory::dims shape{memory::dim(m_outputs), memory::dim(m_inputs), 3, 3}, step{1, 1}, none{0, 0};
    const memory::desc any(shape, memory::data_type::f32, memory::format_tag::any);
    const memory::desc bias({memory::dim(m_outputs)}, memory::data_type::f32, memory::format_tag::x);
    dnnl::primitive_attr attributes;
    attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
    dnnl::post_ops after;
#if DNNL_VERSION_MAJOR >= 3
    if (rectify) after.append_eltwise(dnnl::algorithm::eltwise_relu, 0, 0);
    attributes.set_post_ops(after);
    const dnnl::convolution_forward::primitive_desc described(engine, dnnl::prop_kind::forward_inference,
                                                              dnnl::algorithm::convolution_direct, in, any,
                                                              bias, out, step, none, none, attributes);
#else
    if (rectify) after.append_eltwise(1, dnnl::algorithm::eltwise_relu, 0, 0);
    attributes.set_post_ops(after);
    const dnnl::convolution_forward::primitive_desc described(
        {dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_direct, in, any, bias, out, step,
         none, none},
        attributes, engine);
#endif
    m_in = described.src_desc();
    m_out = described.dst_desc();
    m_scratch = described.scratchpad_desc();
    m_primitive = dnnl::convolution_forward(described);
    m_weight = memory(described.weights_desc(), engine);
    m_bias = memory(bias, engine);
    std::copy(layer.bias.begin(), layer.bias.end(), static_cast<float*>(m_bias.get_data_handle()));
    memory given({shape, memory::data_type::f32, memory::format_tag::oihw}, engine,
                 const_cast<float*>(layer.weight.data()));
    dnnl::stream stream(engine);
    dnnl::reorder(given, m_weight).execute(stream, given, m_weight);
    stream.wait();
  }

  int side() const {
    return m_side;
  }
  uint32_t inputs() const {
    return m_inputs;
  }
  uint32_t outputs() const {
    return m_outputs;
  }
  size_t scratchBytes() const {
    return m_scratch.get_size();
  }

  // `in` has a border, `out` has none.
  void run(const dnnl::engine& engine, dnnl::stream& stream, float* in, float* out,
           std::byte* scratch) const {
    memory source(m_in, engine, in), result(m_out, engine, out), space(m_scratch, engine, scratch);
    m_primitive.execute(stream, {{DNNL_ARG_SRC, source},
                                 {DNNL_ARG_WEIGHTS, m_weight},
                                 {DNNL_ARG_BIAS, m_bias},
                                 {DNNL_ARG_DST, result},
                                 {DNNL_ARG_SCRATCHPAD, space}});
  }

 private:
  int m_side;
  uint32_t m_inputs, m_outputs;
  memory::desc m_in, m_out, m_scratch;
  dnnl::convolution_forward m_primitive;
  memory m_weight, m_bias;
};

// One thread for what oneDNN does on behalf of this one: tasks are shared out by the library. Convolutions
// are made for as many threads as there are when they are made, so this holds for that as well.
class OneThread {
 public:
  OneThread() : m_before(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(m_before); }
  OneThread(const OneThread&) = delete;

 private:
  int m_before;
};

class OneDnnConvolutions : public PixelConvolutions {
 public:
  explicit OneDnnConvolutions(const PixelWeights& w)
      : m_engine(dnnl::engine::kind::cpu, 0),
        m_width(w.width),
        m_encode0{{m_engine, w.encode0[0], 16, true}, {m_engine, w.encode0[1], 16, true}},
        m_encode1{{m_engine, w.encode1[0], 8, true}, {m_engine, w.encode1[1], 8, true}},
        m_middle{{m_engine, w.middle[0], 4, false}, {m_engine, w.middle[1], 4, true}},
        m_decode1(m_engine, w.decode1, 8, true),
        m_decode0(m_engine, w.decode0, 16, true),
        m_scalars(w.scalars),
        m_output(w.output) {
    for (const Convolution* c : {&m_encode0[0], &m_encode0[1], &m_encode1[0], &m_encode1[1], &m_middle[0],
                                 &m_middle[1], &m_decode1, &m_decode0})
      m_scratchBytes = std::max(m_scratchBytes, c->scratchBytes());
  }

  void run(size_t count, const float* maps, const float* scalars, float* logits) const override {
    const OneThread alone;
    thread_local Workspace space;
    space.prepare(*this);
    const uint32_t w = m_width;
    dnnl::stream stream(m_engine);
    const auto convolve = [&](const Convolution& c, std::vector<float>& out) {
      c.run(m_engine, stream, space.bordered.data(), out.data(), space.scratch.data());
    };
    border(space, {{maps, kPixelChannels, 0}}, 16, count);
    convolve(m_encode0[0], space.a);
    border(space, {{space.a.data(), w, 0}}, 16, count);
    convolve(m_encode0[1], space.skip0);
    border(space, {{space.skip0.data(), w, -1}}, 8, count);
    convolve(m_encode1[0], space.a);
    border(space, {{space.a.data(), 2 * w, 0}}, 8, count);
    convolve(m_encode1[1], space.skip1);
    border(space, {{space.skip1.data(), 2 * w, -1}}, 4, count);
    convolve(m_middle[0], space.a);
    addScalars(scalars, space.a.data(), count);
    border(space, {{space.a.data(), 4 * w, 0}}, 4, count);
    convolve(m_middle[1], space.b);
    border(space, {{space.b.data(), 4 * w, 1}, {space.skip1.data(), 2 * w, 0}}, 8, count);
    convolve(m_decode1, space.a);
    border(space, {{space.a.data(), 2 * w, 1}, {space.skip0.data(), w, 0}}, 16, count);
    convolve(m_decode0, space.b);
    finish(space.b.data(), maps, logits, count);
  }

 private:
  // What a thread computes in: about 4 MB for a width of 16.
  struct Workspace {
    std::vector<float> bordered, a, b, skip0, skip1;
    std::vector<std::byte> scratch;

    void prepare(const OneDnnConvolutions& network) {
      const size_t w = network.m_width, places = kPixelBatch;
      bordered.resize(places * 18 * 18 * std::max(3 * w, size_t(kPixelChannels)));
      for (std::vector<float>* values : {&a, &b, &skip0}) values->resize(places * 16 * 16 * w);
      skip1.resize(places * 8 * 8 * 2 * w);
      scratch.resize(network.m_scratchBytes);
    }
  };

  // Channels that a convolution's input is put together of: those of the same level (0), the mean over 2 x 2
  // texels of the level with twice the side (-1), or each texel four times from the one with half of it (1).
  struct Part {
    const float* values;
    uint32_t channels;
    int level;
  };

  // Puts the input of a convolution together: squares of this side, each with its border.
  static void border(Workspace& space, std::initializer_list<Part> parts, int side, size_t count) {
    static const std::unordered_map<int, Border> borders = {{16, Border(16)}, {8, Border(8)}, {4, Border(4)}};
    const std::vector<Border::Texel>& border = borders.at(side).texels;
    size_t channels = 0;
    for (const Part& part : parts) channels += part.channels;
    float* to = space.bordered.data();
    for (size_t place = 0; place < count; ++place, to += size_t(side + 2) * size_t(side + 2) * channels) {
      size_t first = 0;
      for (const Part& part : parts) {
        copyPart(part, side, place, to + first, channels);
        first += part.channels;
      }
      for (const Border::Texel& t : border) copy(to + t.repeats * channels, channels, to + t.at * channels);
    }
  }

  // Writes a part of the channels of a place's texels, which lie `stride` apart, into the square in a border.
  static void copyPart(const Part& part, int side, size_t place, float* to, size_t stride) {
    const auto width = size_t(side), n = size_t(part.channels);
    const size_t from = part.level > 0 ? width / 2 : part.level < 0 ? 2 * width : width;
    const float* values = part.values + place * from * from * n;
    const size_t below = from * n;
    for (size_t y = 0; y < width; ++y) {
      float* texel = to + ((y + 1) * (width + 2) + 1) * stride;
      for (size_t x = 0; x < width; ++x, texel += stride)
        if (part.level < 0)
          mean(values + 2 * (y * from + x) * n, below, n, texel);
        else if (part.level > 0)
          copy(values + (y / 2 * from + x / 2) * n, n, texel);
        else
          copy(values + (y * from + x) * n, n, texel);
    }
  }

  // The mean of four texels of which two lie `below` the other two.
  [[gnu::always_inline]] static void mean(const float* texel, size_t below, size_t n, float* to) {
    for (size_t c = 0; c < n; ++c)
      to[c] = 0.25f * ((texel[c] + texel[n + c]) + (texel[below + c] + texel[below + n + c]));
  }

  // Fits loops over few channels better than a call does.
  [[gnu::always_inline]] static void copy(const float* from, size_t count, float* to) {
    constexpr size_t kAtOnce = 8;
    for (; count >= kAtOnce; count -= kAtOnce, from += kAtOnce, to += kAtOnce)
      std::memcpy(to, from, kAtOnce * sizeof(float));
    if (count > 0) std::copy_n(from, count, to);
  }

  // Adds the layer of the scalars to all texels, and rectifies.
  void addScalars(const float* scalars, float* values, size_t count) const {
    std::array<float, 4 * 64> added;
    for (size_t place = 0; place < count; ++place) {
      const float* x = scalars + place * kPixelScalars;
      for (uint32_t o = 0; o < m_scalars.outputs; ++o) {
        added[o] = m_scalars.bias[o];
        for (uint32_t i = 0; i < kPixelScalars; ++i)
          added[o] += m_scalars.weight[o * kPixelScalars + i] * x[i];
      }
      for (int texel = 0; texel < 4 * 4; ++texel, values += m_scalars.outputs)
        for (uint32_t o = 0; o < m_scalars.outputs; ++o) values[o] = std::max(values[o] + added[o], 0.0f);
    }
  }

  // The output layer, over the decoder's channels and then those of the input.
  void finish(const float* decoded, const float* maps, float* logits, size_t count) const {
    for (size_t t = 0; t < count * kMapTexels; ++t) {
      float sum = m_output.bias[0];
      const float* weight = m_output.weight.data();
      for (uint32_t c = 0; c < m_width; ++c) sum += weight[c] * decoded[t * m_width + c];
      for (uint32_t c = 0; c < uint32_t(kPixelChannels); ++c)
        sum += weight[m_width + c] * maps[t * kPixelChannels + c];
      logits[t] = sum;
    }
  }

  dnnl::engine m_engine;
  uint32_t m_width;
  Convolution m_encode0[2], m_encode1[2], m_middle[2], m_decode1, m_decode0;
  PixelLayer m_scalars, m_output;
  size_t m_scratchBytes = 0;
};

}  // namespace

std::string_view paperWeights();
std::string_view fastWeights();
std::string_view paperGanWeights();
std::string_view fastGanWeights();

extern "C" __attribute__((visibility("default"))) PixelConvolutions* odisMakePixelConvolutions(
    const PixelWeights& weights) {
  const OneThread alone;
  return new OneDnnConvolutions(weights);
}

// Empty where there are none of that name.
extern "C" __attribute__((visibility("default"))) std::string_view odisPixelWeights(std::string_view name) {
  if (name == "paper") return paperWeights();
  if (name == "fast") return fastWeights();
  if (name == "paper-gan") return paperGanWeights();
  if (name == "fast-gan") return fastGanWeights();
  return {};
}

}  // namespace odis::core
