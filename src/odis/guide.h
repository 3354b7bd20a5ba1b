// From path vertices to a guide: nested cells in world space, and in each a sampling map, BSDF sampling
// fractions, what roulette needs, and which lights matter. Frame builds guides by itself; a host that
// has no frame does this:
//
//   GuideBuilder builder(options);
//   builder.add(vertices);              // once, or as samples arrive
//   Guide guide = builder.build(vertices);
//   ... look-ups in guide.view(): odis/guide_view.h
#pragma once

#include <memory>
#include <vector>

#include "odis/guide_view.h"
#include "odis/options/options.h"
#include "odis/path_vertex.h"
#include "odis/work/tasks.h"

namespace odis::core {

class Archive;
class ArchiveWriter;

// What a builder takes of some vertices, so that those need not be kept: 72 bytes a vertex, and 112 for each
// that the BSDF sampling fractions are chosen by (a quarter at most, of many vertices).
class VertexSamples {
 public:
  VertexSamples();
  ~VertexSamples();
  VertexSamples(VertexSamples&&) noexcept;
  VertexSamples& operator=(VertexSamples&&) noexcept;

  // How many vertices they were taken of, and how many of those can't be used.
  VertexCounts counts() const;
  uint64_t bytes() const;
  // Lets go of what build() does not need once `seen` vertices have been taken in all.
  void narrow(uint64_t seen);

 private:
  friend class GuideBuilder;
  friend struct SavedVertexSamples;
  struct Data;
  std::unique_ptr<Data> m_data;
};

// A set of cells, fixed once built; copies share it. Thread-safe. About 830 bytes a cell, and 4 bytes a cell
// and group of lights.
class Guide {
 public:
  Guide();
  ~Guide();
  Guide(const Guide&);
  Guide(Guide&&) noexcept;
  Guide& operator=(Guide) noexcept;

  // The guide as flat arrays, valid until the guide ends or is assigned to; without cells before it is built.
  GuideView view() const;
  uint64_t bytes() const;
  // The variance of a guided sample that the pilot predicts, as a ratio to an unguided one; 1 before build().
  float predictedVarianceRatio() const;
  // How many rays followed a first vertex of the pilot, on average; 0 before build().
  double raysPerPath() const;

  // Writes the guide, and reads one. The latter throws FileError.
  void save(ArchiveWriter& file) const;
  static Guide load(const Archive& file);

 private:
  friend class GuideBuilder;
  friend class PaperMethod;
  struct Data;
  std::shared_ptr<Data> m_data;
};

// Gathers path vertices and builds guides from them. Results depend on the order of the vertices, not on
// the number of threads.
class GuideBuilder {
 public:
  // Throws std::invalid_argument where an option is out of its range.
  explicit GuideBuilder(const GuideOptions& options = {},
                        std::shared_ptr<const Tasks> tasks = libraryTasks());
  ~GuideBuilder();
  GuideBuilder(GuideBuilder&&) noexcept;
  GuideBuilder& operator=(GuideBuilder&&) noexcept;

  // Adds to the statistics of the cells. The first call fixes the extent of the cells, so it should hold at
  // least one pass over the image. Vertices of guided paths may be added, too, their `pdf` being the
  // mixture's. Vertices that can't be used are left out and counted.
  void add(VertexParts parts);
  void add(ArrayView<const PathVertex> vertices) { add(VertexParts(&vertices, 1)); }
  // The same in two steps: take() may be called by many threads at once, for a part of the image each; add()
  // uses the samples up, but for what build() needs. Empty samples are fine.
  VertexSamples take(ArrayView<const PathVertex> vertices) const;
  void add(ArrayView<VertexSamples> samples);
  // The same of vertices of unguided paths, for build() as well. `seen` vertices have been taken by now,
  // these included: the more there are, the fewer of them does build() need.
  VertexSamples takeUnguided(ArrayView<const PathVertex> vertices, uint64_t seen) const;
  // From frame to frame (odis/odis.h). fade() throws std::invalid_argument unless 0 <= weight <= 1,
  // setBounds() unless all is finite and lower <= upper. Guides of before are not of this builder any more.
  void fade(float weight);
  void forget();
  void setBounds(const Float3& lower, const Float3& upper);
  // Builds maps from all that was added, and BSDF sampling fractions from vertices that should be (a part
  // of) the same, without those of guided paths. `pixelValues`, indexed by PathVertex::pixel, are what the
  // vertices' contributions are divided by; without any, by those of an even image. Throws std::out_of_range
  // where a vertex has a pixel beyond them.
  Guide build(VertexParts parts, ArrayView<const float> pixelValues = {}) const;
  Guide build(ArrayView<const PathVertex> vertices, ArrayView<const float> pixelValues = {}) const {
    return build(VertexParts(&vertices, 1), pixelValues);
  }
  // The same from what was taken of unguided paths, `seen` vertices in all.
  Guide build(ArrayView<const VertexSamples> unguided, uint64_t seen,
              ArrayView<const float> pixelValues = {}) const;
  // Builds all but BSDF sampling fractions and the prediction anew, from all that was added by now. Those are
  // taken from `previous`, which must come from this builder (else std::invalid_argument is thrown); cells
  // that are new have their parents' fractions.
  Guide rebuild(const Guide& previous) const;

  // Keeps the memory of building from so many vertices, and of two guides, below a limit, as well as can be
  // foreseen: the cells become as much larger as it takes, or samples without a cell are left out.
  void limitBytes(uint64_t most, uint64_t vertices);
  // How many times larger the cells' edges are for that, and how many samples were left out.
  int coarsening() const;
  uint64_t samplesLeftOut() const;
  // Writes all that was added, and reads it into a builder with the same options that nothing was added to.
  void save(ArchiveWriter& file) const;
  void load(const Archive& file);
  // Tells of progress from now on.
  void setProgress(OdisProgressFunction function, void* user);
  // Lets rebuild() take a guide that was built before this builder was saved.
  void adopt(Guide& guide) const;

  // As they hold, without the model.
  const GuideOptions& options() const;
  // That of its model (odis/models/model.h).
  uint64_t modelId() const;
  // How many of the vertices added were taken, and how many refused, by reason.
  VertexCounts vertexCounts() const;
  // How many cells the guide that was built last has that paths come to: one far out counts less than 1.
  double visitedCells() const;
  // Held at most, samples included while they are added, and held now.
  uint64_t bytes() const;
  uint64_t heldBytes() const;

 private:
  friend class PaperMethod;
  struct Data;
  std::unique_ptr<Data> m_data;
};

}  // namespace odis::core
