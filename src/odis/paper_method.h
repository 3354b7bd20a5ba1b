// The paper's method in a frame (Bako et al. 2019; docs/paper.md): maps at pixels, and an oracle that asks
// what a better guide would gain. It stands beside the guide of cells, behind this one interface: it is told
// of the vertices of unguided passes, and puts a cell for each map behind those of a guide.
#pragma once

#include <memory>

#include "odis/frame.h"
#include "odis/pixels/pixel_maps.h"

namespace odis::core {

struct Model;

class PaperMethod {
 public:
  // Null where the options of frame and builder ask for none of it.
  static std::unique_ptr<PaperMethod> of(const FrameOptions& options,
                                         std::shared_ptr<const GuideBuilder> builder,
                                         std::shared_ptr<const Tasks> tasks);
  // Throws std::invalid_argument where options ask for a network that is missing.
  static void check(const GuideOptions& options, const Model& model);

  // Whether maps are made of the pilot or of the oracle: of all pixels.
  bool hasMaps() const { return m_guide.pixelMaps != PixelMapKind::none; }
  // Passes of the oracle follow the pilot, each of one sample in every pixel that is no part of the image.
  // Guides are made of these instead of the pilot's.
  bool hasOracle() const { return m_passes > 0; }
  bool hasOraclePass() const { return m_passesDone < m_passes; }
  void describeOraclePass(FramePass& pass) const;
  SampleRange oracleSamples() const { return {m_passesDone, 1}; }
  // Whether BSDF sampling fractions are chosen by the pass, too.
  bool passIsForFractions() const;
  void endOraclePass() { ++m_passesDone; }

  // Vertices of an unguided pass, path by path, from the camera on, all of a pixel at once. Thread-safe for
  // different pixels.
  void take(OdisPassKind pass, ArrayView<const PathVertex> vertices);
  // A guide with a cell behind its own for each map; the guide itself where there are no maps.
  Guide over(const Guide& cells);
  // The guide that such a one was made of.
  static Guide cellsOf(const Guide& guide);

  uint64_t bytes() const;
  // Reading returns what the cells know of a guide that was made over them. Throws FileError.
  void save(ArchiveWriter& file) const;
  Guide load(const Archive& file, const Guide& guide);

  // over() for maps of one's own: with the decisions of the cell that a map's place lies in, and as much of
  // its map as the options say.
  static Guide over(const Guide& cells, const PixelMaps& maps, const GuideOptions& options,
                    const Tasks& tasks);

 private:
  PaperMethod(const FrameOptions& options, std::shared_ptr<const GuideBuilder> builder,
              std::shared_ptr<const Tasks> tasks);
  void makeMaps();
  static std::shared_ptr<Guide::Data> copyOf(const Guide::Data& guide, size_t more);

  size_t m_pixels;
  uint32_t m_passes, m_passesDone = 0;
  GuideOptions m_guide;
  std::shared_ptr<const GuideBuilder> m_builder;  // tells of progress
  std::shared_ptr<const Tasks> m_tasks;
  std::shared_ptr<const PixelModel> m_model;  // null: the oracle makes maps
  // What maps are made of, until they are.
  std::unique_ptr<FirstVertices> m_pilot;
  std::unique_ptr<PixelOracle> m_oracle;
  PixelMaps m_maps;
};

}  // namespace odis::core
