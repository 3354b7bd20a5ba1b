// An image wrapped around the scene. Manual page in environment_map.cpp.
#pragma once

#include <cassert>
#include <vector>

#include "render/emitter/emitter.h"
#include "render/math/distribution.h"

namespace odis::render {

class EnvironmentMap final : public EnvironmentEmitter {
 public:
  // width * height pixels, row 0 at the top; the linear part of toWorld must have an inverse. What is more
  // than `horizon` of the way from the upper pole to the lower one is black, with a sharp edge.
  EnvironmentMap(std::vector<Rgb> pixels, int width, int height, const Matrix4& toWorld, float horizon = 1);

  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  void sampleEach(std::span<const LightDraw> draws, std::span<EmitterSample> samples) const override;
  // A surface faces each direction with a mean cosine of 1/4, that of those behind it taken as zero.
  float meanIrradiance() const override { return average(m_integral) / 4; }
  Rgb radiance(const Vec3& wi) const override;
  float pdf(const Vec3& wi) const override;
  void view(std::span<EnvironmentView> views) const override;
  bool invertible() const override { return true; }
  Vec2 invert(const Vec3& wi) const override;
  // Places of the image, side by side.
  struct ImagePlaces {
    Column u, v;
  };
  // sampleEach() without radiances, and where the image has those.
  void sampleDirections(std::span<const LightDraw> draws, std::span<EmitterSample> samples,
                        ImagePlaces& at) const;
  // view() without radiances.
  void viewDensities(std::span<EnvironmentView> views) const;
  uint64_t bytes() const { return m_pixels.size() * sizeof(Rgb) + m_table.bytes(); }

 private:
  const Rgb& pixel(int x, int y) const {
    assert(x >= 0 && x < m_width && y >= 0 && y < m_height);
    return m_pixels[size_t(y) * size_t(m_width) + size_t(x)];
  }
  // A direction of the world as the image has it.
  struct Place {
    Vec2 uv;
    float sinTheta;  // of its angle to the pole
    float stretch;   // the length that it has in the image's space
  };
  Place placeOf(const Vec3& wi) const;
  struct Places : ImagePlaces {
    Column sinTheta, stretch;

    Place operator[](size_t lane) const { return {{u[lane], v[lane]}, sinTheta[lane], stretch[lane]}; }
  };
  static void findPlacesInLanes(const EnvironmentMap& map, size_t count, const Columns3& wi, Places& places);
  // Those of views; fetches what their densities are found from.
  void findPlaces(std::span<const EnvironmentView> views, Places& places) const;
  // The way back, for samples of the table.
  struct Directions {
    Columns3 wi;
    Column pdf;
  };
  static void findDirections(const EnvironmentMap& map, size_t count, const Column& tablePdf,
                             ImagePlaces& places, Directions& directions);
  // Where the table has a place of the image.
  Vec2 inTable(const Vec2& uv) const;
  // The pixels around a place of the image: the two columns and the upper of the two rows.
  struct Patch {
    int left, right, top;
    Vec2 within;  // of the way from the first pixel to the last
  };
  Patch patchAt(const Vec2& uv) const;
  struct Patches {
    IntColumn left, right, top;
    Column withinX, withinY;

    Patch operator[](size_t lane) const {
      return {left[lane], right[lane], top[lane], {withinX[lane], withinY[lane]}};
    }
  };
  // Finds those of several places, and fetches the pixels.
  void findPatches(size_t count, const ImagePlaces& places, Patches& patches) const;
  static void findPatchesInLanes(const EnvironmentMap& map, size_t count, const ImagePlaces& places,
                                 Patches& patches);
  Rgb lookUp(const Patch& patch, float v) const;
  float pdfAt(const Place& place) const;
  void findDensities(std::span<EnvironmentView> views, const Places& places) const;
  std::vector<float> patchWeights();

  int m_width, m_height;
  float m_horizon;
  std::vector<Rgb> m_pixels;
  Matrix4 m_toWorld, m_toLocal;
  float m_determinant;          // of m_toWorld's linear part, absolute
  Rgb m_integral{0, 0, 0};      // of the radiance over all directions
  PiecewiseConstant2D m_table;  // over the patches between four pixel centres
};

}  // namespace odis::render
