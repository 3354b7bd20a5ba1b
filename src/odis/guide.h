// From path vertices to a guide: nested cells in world space, and in each a sampling map, BSDF sampling
// fractions, what roulette needs, and which lights matter. Frame builds guides by itself; a host that
// has no frame does this:
//
//   GuideBuilder builder(options);
//   builder.add(vertices);              // once, or as samples arrive
//   Guide guide = builder.build();
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

// What a builder takes of some vertices, so that those need not be kept: 72 bytes a vertex, and 120 for each
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
  // Lets go of what BSDF sampling fractions are not chosen by once `seen` vertices have been taken in all.
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
  // Whether there are maps that are worth sampling from: not where all is left to the BSDF.
  bool guidesDirections() const;
  // Whether any cell has learned which lights to choose.
  bool choosesLights() const;
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

// Gathers path vertices and builds guides from them. What it gathers itself is a part; merge() adds those of
// other builders, which stay apart. Results depend on what each call of add() is given, on the order of these
// calls and on the parts' ids, not on the order of the vertices of a call, on the order of merging or on
// threads.
class GuideBuilder {
 public:
  // Throws std::invalid_argument where an option is out of its range.
  explicit GuideBuilder(const GuideOptions& options = {},
                        std::shared_ptr<const Tasks> tasks = libraryTasks());
  ~GuideBuilder();
  GuideBuilder(GuideBuilder&&) noexcept;
  GuideBuilder& operator=(GuideBuilder&&) noexcept;

  // Adds vertices of unguided paths to the statistics of the cells, and some of them to what BSDF sampling
  // fractions are chosen by. The first call fixes the extent of the cells, so it should hold at least one
  // pass over the image. Vertices that can't be used are left out and counted.
  void add(VertexParts parts);
  void add(ArrayView<const PathVertex> vertices) { add(VertexParts(&vertices, 1)); }
  // The same of guided paths, whose `pdf` is the mixture's: they add to the cells alone.
  void addGuided(VertexParts parts);
  void addGuided(ArrayView<const PathVertex> vertices) { addGuided(VertexParts(&vertices, 1)); }
  // The same in steps: take...() may be called by many threads at once, for a part of the image each; what
  // adds uses the samples up. Empty samples are fine. Of unguided paths `seen` vertices have been taken by
  // now, these included: the more there are, the fewer of them are fractions chosen by.
  VertexSamples takeGuided(ArrayView<const PathVertex> vertices) const;
  VertexSamples takeUnguided(ArrayView<const PathVertex> vertices, uint64_t seen) const;
  void addToCells(ArrayView<VertexSamples> samples);
  void addToFractions(ArrayView<VertexSamples> samples);
  // From frame to frame (odis/odis.h), for all parts. fade() throws std::invalid_argument unless 0 <= weight
  // <= 1, setBounds() unless all is finite and lower <= upper. What fractions are chosen by can't fade: it is
  // forgotten where the weight is below 1. forget() lets go of other builders' parts.
  void fade(float weight);
  void forget();
  void forgetFractions();
  void setBounds(const Float3& lower, const Float3& upper);
  // Builds a guide from all that was added. `pixelValues`, indexed by PathVertex::pixel, are what the
  // vertices' contributions are divided by; without any, by those of an even image with the mean of paths.
  // Throws std::out_of_range where a vertex has a pixel beyond them.
  Guide build(ArrayView<const float> pixelValues = {}) const;
  // Builds all but BSDF sampling fractions and the prediction anew, from all that was added by now. Those are
  // taken from `previous`, whose cells must be of the same grid (else std::invalid_argument is thrown); cells
  // that are new have their parents' fractions.
  Guide rebuild(const Guide& previous) const;
  // Whether rebuild() takes that guide.
  bool canRebuild(const Guide& previous) const;

  // The id of what this builder gathers itself, 0 at first. Throws std::invalid_argument where a part that
  // was merged has it.
  void setPartId(uint64_t id);
  // Takes the parts of other builders in, which stay as they are. Throws std::invalid_argument, and changes
  // nothing, where builders differ in an option, the model or the grid, or where two parts have the same id;
  // parts that nothing was added to are passed over.
  void merge(ArrayView<const GuideBuilder* const> others);
  // How many parts there are that something was added to.
  size_t partCount() const;

  // Keeps the memory of building from so many vertices, and of two guides, below a limit, as well as can be
  // foreseen: the cells become as much larger as it takes, or samples without a cell are left out.
  void limitBytes(uint64_t most, uint64_t vertices);
  // How many times larger the cells' edges are for that, and how many samples were left out.
  int coarsening() const;
  uint64_t samplesLeftOut() const;
  // Writes the options and all that was added. Reads the latter into a builder with the same options that
  // nothing was added to, or makes a builder with the options that were saved. Reading throws FileError, also
  // where the model is not the one that there was.
  void save(ArchiveWriter& file) const;
  void load(const Archive& file);
  static GuideBuilder load(const Archive& file, std::optional<Model> model,
                           std::shared_ptr<const Tasks> tasks);
  // Tells of progress from now on.
  void setProgress(OdisProgressFunction function, void* user);

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
