// The grid spans what the pilot saw, not what the scene holds, and not all of that: a ground plane to the
// horizon, a sky, a distant tree must not make the cells huge.
//
// Which vertices lie far out is told from distances alone, whatever their share up to a third. Vertices of a
// room, a table, a car get few and then none as one goes outwards. Those that lie far out don't: there are
// about as many between two and four times the distance as between one and two. So the radius is looked for
// beyond which distances are spread most over their logarithm. In scenes without such vertices there is none.
#include "odis/cells/place_grid.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <span>

#include "odis/maps/fast_log2.h"

namespace odis::core {

namespace {

// A vertex beyond a radius counts for the logarithm of its distance over it, to the base 4 and at most 1,
// less this. A plane to the horizon has a mean of 0.54, a cluster 1, the outskirts of a room some 0.2.
constexpr double kCompact = 0.32;
// Vertices are left out only if they count for more than this share of all, or for more than half a vertex:
// fewer than 0.5 % are left out anyway.
constexpr double kLeastShare = 0.0033, kLeastCount = 0.5;
// At least this share of the vertices stays.
constexpr double kCore = 0.65;
// More may be left out of the vertices beyond this multiple of the radius of the densest share of all.
constexpr double kDensest = 0.4, kAbsurdlyFar = 128;
// So many vertices beyond this multiple of the core's radius are a horizon's, too.
constexpr double kHorizon = 12, kLeastOfHorizon = 2;
// What is far out lies apart from the rest, or a share of it lies many times as far: the end of a long room
// does neither. Where vertices are few it has to lie many times as far, since cells would know little of a
// wall beside the picture.
constexpr double kFarther = 10, kLeastShareFarther = 0.003;
constexpr size_t kFew = 1000;
// At most this share of the vertices is left out at an end of an axis because of a horizon.
constexpr double kMostLeftOut = 0.125;

struct Distant {
  double squared;
  Float3 position;
};

double squaredDistance(const Float3& a, const Float3& b) {
  const double x = double(a.x) - b.x, y = double(a.y) - b.y, z = double(a.z) - b.z;
  return x * x + y * y + z * z;
}

size_t shareOf(size_t count, double share) {
  return std::min(size_t(share * double(count)), count - 1);
}

template <class Values, class Less = std::less<>>
auto& nthOf(Values& values, size_t n, Less less = {}) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(n), values.end(), less);
  return values[n];
}

Float3 medianOf(std::span<const Float3> positions) {
  std::array<std::vector<float>, 3> axes;
  for (const Float3& p : positions) {
    axes[0].push_back(p.x);
    axes[1].push_back(p.y);
    axes[2].push_back(p.z);
  }
  const size_t half = positions.size() / 2;
  return {nthOf(axes[0], half), nthOf(axes[1], half), nthOf(axes[2], half)};
}

// Leaves out what is absurdly far from the densest part, so that the median lies within what remains even
// where that is a minority. The densest part is about one of a few vertices, by a thousand of them.
void leaveOutAbsurdlyFar(std::vector<Float3>& positions) {
  constexpr size_t kCentres = 32, kSeen = 1024;
  const size_t count = positions.size(), step = std::max<size_t>(1, count / kSeen);
  Float3 centre;
  double least = INFINITY;
  std::vector<double> distances;
  for (size_t c = 0; c < count; c += std::max<size_t>(1, count / kCentres)) {
    distances.clear();
    for (size_t i = 0; i < count; i += step) distances.push_back(squaredDistance(positions[i], positions[c]));
    const double radius = nthOf(distances, shareOf(distances.size(), kDensest));
    if (radius >= least) continue;
    least = radius;
    centre = positions[c];
  }
  if (!(least > 0)) return;
  const double most = least * kAbsurdlyFar * kAbsurdlyFar;
  std::erase_if(positions, [&](const Float3& p) { return squaredDistance(p, centre) > most; });
}

// Distances in order, as logarithms to the base 4 over the first of them, which is not zero.
std::vector<double> logarithmsOf(std::span<const Distant> sorted) {
  std::vector<double> logarithms;
  for (const Distant& d : sorted)
    logarithms.push_back(
        0.25 * fastLog2(float(std::clamp(d.squared / sorted.front().squared, 1.0, double(FLT_MAX)))));
  return logarithms;
}

// The first of these distances that is too far out, and how many lie up to twice as far.
struct Break {
  size_t first, nextOctave;
};
Break findBreak(std::span<const double> logarithms, double least) {
  const size_t count = logarithms.size();
  std::vector<double> sums(count + 1, 0.0), scores(count);
  for (size_t i = 0; i < count; ++i) sums[i + 1] = sums[i] + logarithms[i];
  size_t end = 0;  // of those up to four times as far
  for (size_t i = 0; i < count; ++i) {
    end = std::max(end, i + 1);
    while (end < count && logarithms[end] <= logarithms[i] + 1) ++end;
    const double within = sums[end] - sums[i + 1] - logarithms[i] * double(end - i - 1);
    scores[i] = within + double(count - end) - kCompact * double(count - i - 1);
  }
  // The outermost of those radii that are nearly as good as the best.
  const double enough = *std::max_element(scores.begin(), scores.end()) - least;
  size_t last = count - 1;
  while (scores[last] < enough) --last;
  size_t octave = last + 1;
  while (octave < count && logarithms[octave] <= logarithms[last] + 0.5) ++octave;
  return {last + 1, octave - last - 1};
}

// What lies far out.
struct FarOut {
  double squared = INFINITY;  // beyond this distance, squared
  // The vertices of a plane that runs to the horizon begin near, where they can't be told from the room's.
  // But between one and two times any distance there are this many times as many of them as between two and
  // four times. 0 where there is no horizon.
  double horizonGrowth = 0;
};

// Whether enough of the vertices from `first` on lie many times as far out as those before.
bool reachesFar(std::span<const Distant> sorted, size_t first) {
  const auto beyond = size_t(kLeastShareFarther * double(sorted.size() - first));
  return sorted[sorted.size() - 1 - beyond].squared > kFarther * kFarther * sorted[first - 1].squared;
}

FarOut findFarOut(std::span<const Float3> positions, const Float3& centre) {
  std::vector<Distant> distances;
  for (const Float3& p : positions) distances.push_back({squaredDistance(p, centre), p});
  const auto isNearer = [](const Distant& a, const Distant& b) { return a.squared < b.squared; };
  const size_t count = positions.size(), core = shareOf(count, kCore);
  const double coreSquared = nthOf(distances, core, isNearer).squared;
  FarOut result;
  if (!(coreSquared > 0)) return result;
  const std::span<Distant> outer = std::span(distances).subspan(core);
  std::sort(outer.begin(), outer.end(), isNearer);
  const Break far = findBreak(logarithmsOf(outer), std::max(kLeastCount, kLeastShare * double(count)));
  const auto beyond = [&](double squared) {
    return double(outer.end() - std::ranges::upper_bound(outer, squared, {}, &Distant::squared));
  };
  double nearest = 4 * coreSquared;  // of the distances that the horizon is looked for in
  bool isHorizon = beyond(kHorizon * kHorizon * coreSquared) >= kLeastOfHorizon;
  const bool isApart = far.nextOctave == 0;
  if (far.first < outer.size() && ((isApart && count >= kFew) || reachesFar(outer, far.first))) {
    nearest = result.squared = outer[far.first - 1].squared;
    isHorizon = !isApart;
  }
  if (!isHorizon) return result;
  const auto within = [&](double from, double to) {
    return beyond(from * from * nearest) - beyond(to * to * nearest);
  };
  // Densities of a plane's vertices fall with the third or fourth power of the distance, most of them.
  result.horizonGrowth = std::clamp(within(1, 4) / std::max(within(2, 8), 1.0), 1.5, 6.0);
  return result;
}

// The box of all but `cut` vertices at either end of each axis.
struct Box {
  Float3 low, extent;
};
constexpr float Float3::*kAxes[] = {&Float3::x, &Float3::y, &Float3::z};
Box boxOf(std::span<const Float3> vertices, size_t cut) {
  Box box;
  std::vector<float> values(vertices.size());
  for (float Float3::*const axis : kAxes) {
    for (size_t i = 0; i < values.size(); ++i) values[i] = vertices[i].*axis;
    box.low.*axis = nthOf(values, cut);
    box.extent.*axis = nthOf(values, values.size() - 1 - cut) - box.low.*axis;
  }
  return box;
}

// How far the box reaches to one side of its centre, in front of a horizon. `offsets` are those of all
// vertices along an axis.
float reachBeforeHorizon(std::vector<float> offsets, const FarOut& far, size_t cut) {
  std::sort(offsets.begin(), offsets.end());
  const auto countUpTo = [&](float x) {
    return size_t(std::upper_bound(offsets.begin(), offsets.end(), x) - offsets.begin());
  };
  const auto most = size_t(kMostLeftOut * double(offsets.size()));
  for (size_t i = countUpTo(float(std::sqrt(far.squared))); i-- > 0 && offsets[i] > 0;) {
    const size_t beyond = offsets.size() - i;
    const size_t twice = countUpTo(2 * offsets[i]), fourTimes = countUpTo(4 * offsets[i]);
    // More vertices than the horizon's, by two standard errors.
    const double expected = far.horizonGrowth * double(fourTimes - twice);
    const double error = std::sqrt((1 + far.horizonGrowth) * expected);
    if (beyond > most || double(twice - i) > double(cut) + expected + 2 * error) return offsets[i];
  }
  return 0;
}

Box boxBeforeHorizon(std::span<const Float3> vertices, const Float3& centre, const FarOut& far, size_t cut) {
  Box box;
  std::vector<float> above(vertices.size()), below(vertices.size());
  for (float Float3::*const axis : kAxes) {
    for (size_t i = 0; i < vertices.size(); ++i) {
      above[i] = vertices[i].*axis - centre.*axis;
      below[i] = -above[i];
    }
    const float down = reachBeforeHorizon(below, far, cut), up = reachBeforeHorizon(above, far, cut);
    box.low.*axis = centre.*axis - down;
    box.extent.*axis = down + up;
  }
  return box;
}

double lengthOf(const Float3& extent) {
  const float squared = dot(extent, extent);
  if (std::isnormal(squared)) return std::sqrt(squared);
  return std::sqrt(squaredDistance(extent, {}));
}

// The finest cells are those within `reach` of their edges.
CellGrid gridReaching(const Float3& low, const Float3& extent, int cellsPerDiagonal, float reach) {
  // An edge and its inverse are normal numbers.
  const auto diagonal = float(std::clamp(lengthOf(extent), 1e-36, double(FLT_MAX) / 8));
  const float edge = lengthOf(extent) > 0 ? std::max(diagonal / float(cellsPerDiagonal), 1e-37f) : 1.0f;
  // An odd offset keeps walls at the ends of the extent off the cells' faces.
  const float offset = 0.37f * edge;
  return CellGrid(low - Float3{offset, offset, offset}, edge,
                  reach <= CellGrid::kMostReach ? std::max(reach, CellGrid::kLeastReach) : 0);
}

// The side, in edges of the finest cells, of the cube around a box where vertices lie beyond it: of those
// there are few in any one place near the box.
float reachOf(const Float3& extent, int cellsPerDiagonal) {
  const double side = std::max({extent.x, extent.y, extent.z});
  return float(side / lengthOf(extent) * cellsPerDiagonal) + 1;
}

}  // namespace

// A cube as wide as the diagonal is long.
CellGrid gridAround(const Float3& low, const Float3& extent, int cellsPerDiagonal) {
  return gridReaching(low, extent, cellsPerDiagonal, float(cellsPerDiagonal));
}

CellGrid gridFor(std::vector<Float3> positions, int cellsPerDiagonal) {
  if (positions.empty()) return gridAround({}, {}, cellsPerDiagonal);
  leaveOutAbsurdlyFar(positions);
  const Float3 centre = medianOf(positions);
  const FarOut far = findFarOut(positions, centre);
  const auto isNear = [&](const Float3& p) { return squaredDistance(p, centre) <= far.squared; };
  const auto nearCount =
      size_t(std::partition(positions.begin(), positions.end(), isNear) - positions.begin());
  // 0.5 % of the vertices at either end of each axis don't count in any case.
  const size_t cut = nearCount / 200;
  const Box box = far.horizonGrowth > 0 ? boxBeforeHorizon(positions, centre, far, cut)
                                        : boxOf(std::span(positions).first(nearCount), cut);
  if (nearCount == positions.size() && far.horizonGrowth == 0)
    return gridAround(box.low, box.extent, cellsPerDiagonal);
  return gridReaching(box.low, box.extent, cellsPerDiagonal, reachOf(box.extent, cellsPerDiagonal));
}

}  // namespace odis::core
