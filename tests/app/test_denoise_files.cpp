// `odis denoise` of files as other programs write them: several parts, layers of Blender, types of channels.
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <half.h>

#include "command_runner.h"
#include "render/image/write.h"
#include "support/denoiser.h"

namespace {

using odis::render::readExr;
using odis::test::Outcome;

constexpr int kWidth = 12, kHeight = 8;

struct Part {
  std::string name;
  std::vector<std::string> channels;
  Imf::PixelType type = Imf::FLOAT;
  int width = kWidth;
};

// What channel `c` of part `p` holds: whole numbers, which all types hold.
uint32_t valueAt(size_t p, size_t c, int i) {
  return uint32_t(i * 7 + int(c) * 3) % 11 + uint32_t(p);
}

class DenoisedFiles : public odis::test::Odis {
 protected:
  void writeParts(const std::string& name, const std::vector<Part>& parts) const {
    std::vector<Imf::Header> headers;
    for (const Part& part : parts) {
      Imf::Header& header = headers.emplace_back(kWidth, kHeight);
      header.dataWindow().max.x = part.width - 1;
      if (parts.size() > 1) header.setName(part.name);
      header.setType(Imf::SCANLINEIMAGE);
      header.insert("exposure", Imf::FloatAttribute(float(part.width)));
      for (const std::string& channel : part.channels)
        header.channels().insert(channel, Imf::Channel(part.type));
    }
    Imf::MultiPartOutputFile file(this->file(name).c_str(), headers.data(), int(headers.size()));
    for (size_t p = 0; p < parts.size(); ++p) {
      std::vector<std::vector<uint32_t>> planes(parts[p].channels.size());
      std::vector<std::vector<float>> floats(planes.size());
      std::vector<std::vector<half>> halves(planes.size());
      Imf::FrameBuffer frame;
      for (size_t c = 0; c < planes.size(); ++c) {
        for (int i = 0; i < parts[p].width * kHeight; ++i) {
          planes[c].push_back(valueAt(p, c, i));
          floats[c].push_back(float(planes[c].back()));
          halves[c].push_back(half(floats[c].back()));
        }
        const void* data = parts[p].type == Imf::UINT   ? static_cast<void*>(planes[c].data())
                           : parts[p].type == Imf::HALF ? static_cast<void*>(halves[c].data())
                                                        : static_cast<void*>(floats[c].data());
        frame.insert(parts[p].channels[c], Imf::Slice::Make(parts[p].type, data, headers[p].dataWindow()));
      }
      Imf::OutputPart part(file, int(p));
      part.setFrameBuffer(frame);
      part.writePixels(kHeight);
    }
  }

  // Whether all channels of a file but those are in the copy as they were, with their types and attributes.
  void expectSame(const std::string& name, const std::string& copyName, const std::vector<Part>& parts,
                  const std::vector<std::string>& changed) const {
    Imf::MultiPartInputFile before(file(name).c_str()), after(file(copyName).c_str());
    ASSERT_EQ(after.parts(), before.parts());
    for (int p = 0; p < before.parts(); ++p) {
      const Imf::Header &was = before.header(p), &is = after.header(p);
      EXPECT_EQ(is.hasName(), was.hasName());
      if (was.hasName()) {
        EXPECT_EQ(is.name(), was.name());
      }
      EXPECT_EQ(is.dataWindow(), was.dataWindow());
      EXPECT_EQ(is.typedAttribute<Imf::FloatAttribute>("exposure").value(), float(parts[size_t(p)].width));
      for (size_t c = 0; c < parts[size_t(p)].channels.size(); ++c) {
        const std::string& channel = parts[size_t(p)].channels[c];
        const Imf::Channel* found = is.channels().findChannel(channel);
        ASSERT_TRUE(found) << channel;
        EXPECT_EQ(found->type, parts[size_t(p)].type) << channel;
        if (std::find(changed.begin(), changed.end(), channel) != changed.end()) continue;
        const std::vector<float> pixels = read(after, p, channel);
        for (size_t i = 0; i < pixels.size(); ++i)
          ASSERT_EQ(pixels[i], float(valueAt(size_t(p), c, int(i)))) << channel;
      }
    }
  }
  static std::vector<float> read(Imf::MultiPartInputFile& file, int p, const std::string& channel) {
    const Imath::Box2i window = file.header(p).dataWindow();
    std::vector<float> pixels(size_t(window.max.x + 1) * kHeight);
    Imf::FrameBuffer frame;
    frame.insert(channel, Imf::Slice::Make(Imf::FLOAT, pixels.data(), window));
    Imf::InputPart part(file, p);
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
    return pixels;
  }
  Outcome denoise(const std::string& arguments) const {
    const Outcome outcome = run("denoise " + arguments);
    EXPECT_EQ(outcome.code, 0) << arguments << "\n" << outcome.text;
    return outcome;
  }
};

// Each part stays one, also of another size and with numbers that are no colours.
TEST_F(DenoisedFiles, KeepTheirParts) {
  ODIS_NEEDS_DENOISER();
  const std::vector<Part> parts{{"beauty", {"R", "G", "B", "A"}, Imf::HALF},
                                {"albedo", {"R", "G", "B"}},
                                {"normal", {"normal.X", "normal.Y", "normal.Z"}},
                                {"id", {"object"}, Imf::UINT},
                                {"small", {"R", "G", "B"}, Imf::HALF, 5}};
  writeParts("in.exr", parts);
  const Outcome outcome = denoise("in.exr -o out.exr");
  EXPECT_EQ(outcome.text.find("found no albedo"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("out.exr: written after "), std::string::npos) << outcome.text;
  expectSame("in.exr", "out.exr", parts, {"R", "G", "B"});
  const auto before = readExr(file("in.exr").string()), after = readExr(file("out.exr").string());
  EXPECT_NE(after.channels.at("R"), before.channels.at("R"));
  EXPECT_EQ(after.channels.at("noisy.R"), before.channels.at("R"));
  EXPECT_EQ(after.channels.at("albedo.R"), before.channels.at("albedo.R"));
  EXPECT_EQ(after.metadata.at("odis:denoiserAuxiliaries"), "albedo and normal, prefiltered");
  // Once more comes to the same.
  denoise("out.exr -q -o again.exr");
  EXPECT_EQ(readExr(file("again.exr").string()).channels, after.channels);
  EXPECT_NE(denoise("in.exr -o out.exr").text.find("out.exr: replaced after "), std::string::npos);
}

TEST_F(DenoisedFiles, OfBlenderShowTheDenoisedColours) {
  ODIS_NEEDS_DENOISER();
  std::vector<std::string> channels;
  for (const std::string layer : {"ViewLayer.Combined", "ViewLayer.Denoising Albedo", "Second.Combined"})
    for (const char* component : {".R", ".G", ".B", ".A"}) channels.push_back(layer + component);
  channels.push_back("ViewLayer.Depth.Z");
  const std::vector<Part> parts{{"", channels, Imf::HALF}};
  writeParts("in.exr", parts);
  const Outcome outcome = denoise("in.exr -o out.exr");
  EXPECT_NE(outcome.text.find("Combined.R, G, B denoised"), std::string::npos) << outcome.text;
  const auto before = readExr(file("in.exr").string()), after = readExr(file("out.exr").string());
  EXPECT_EQ(after.channels.count("R"), 0u);
  EXPECT_EQ(after.channels.size(), before.channels.size() + 3);
  // The first of two layers of a name.
  const std::vector<std::string> changed{"Second.Combined.R", "Second.Combined.G", "Second.Combined.B"};
  expectSame("in.exr", "out.exr", parts, changed);
  for (const std::string& name : changed) {
    EXPECT_NE(after.channels.at(name), before.channels.at(name));
    EXPECT_EQ(after.channels.at("Second.noisy." + name.substr(name.size() - 1)), before.channels.at(name));
  }
  // Another one if asked for.
  denoise("in.exr -q -o other.exr --layer ViewLayer.Combined");
  const auto other = readExr(file("other.exr").string());
  EXPECT_EQ(other.channels.at("Second.Combined.R"), before.channels.at("Second.Combined.R"));
  EXPECT_NE(other.channels.at("ViewLayer.Combined.R"), before.channels.at("ViewLayer.Combined.R"));
}

// Cycles keeps the colours before its own denoiser.
TEST_F(DenoisedFiles, OfCyclesReplaceWhatItDenoised) {
  ODIS_NEEDS_DENOISER();
  std::vector<std::string> channels;
  for (const std::string layer : {"ViewLayer.Combined", "ViewLayer.Noisy Image"})
    for (const char* component : {".R", ".G", ".B"}) channels.push_back(layer + component);
  const std::vector<Part> parts{{"", channels}};
  writeParts("in.exr", parts);
  denoise("in.exr -q -o out.exr");
  const std::string shown = "ViewLayer.Combined.";
  expectSame("in.exr", "out.exr", parts, {shown + "R", shown + "G", shown + "B"});
  const auto before = readExr(file("in.exr").string()), after = readExr(file("out.exr").string());
  EXPECT_EQ(after.channels.size(), channels.size());
  EXPECT_NE(after.channels.at(shown + "R"), before.channels.at(shown + "R"));
}

TEST_F(DenoisedFiles, RefuseOptionsWithoutEffect) {
  writeParts("in.exr", {{"", {"R", "G", "B"}}});
  expectFailure("denoise in.exr -o out.exr --exposure 1", 2, "--exposure: is of PNGs");
  expectFailure("denoise in.exr -o out.exr --aux none --albedo-layer albedo", 2,
                "--albedo-layer: has no effect with --aux none");
  EXPECT_FALSE(exists("out.exr"));
}

}  // namespace
