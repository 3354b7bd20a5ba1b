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

// Leaves out the positions that lie far out. Returns how many more to leave out at either end of each axis:
// what reaches far begins near, where it can't be told from the rest.
size_t leaveOutFar(std::vector<Float3>& positions) {
  leaveOutAbsurdlyFar(positions);
  // Some thousands of them tell as much as all.
  constexpr size_t kSeen = 16384;
  const size_t step = std::max<size_t>(1, positions.size() / kSeen);
  std::vector<Float3> seen;
  for (size_t i = 0; i < positions.size(); i += step) seen.push_back(positions[i]);
  const size_t count = seen.size(), core = shareOf(count, kCore);
  const Float3 centre = medianOf(seen);
  std::vector<Distant> distances;
  for (const Float3& p : seen) distances.push_back({squaredDistance(p, centre), p});
  const auto isNearer = [](const Distant& a, const Distant& b) { return a.squared < b.squared; };
  if (!(nthOf(distances, core, isNearer).squared > 0)) return 0;
  const std::span<Distant> outer = std::span(distances).subspan(core);
  std::sort(outer.begin(), outer.end(), isNearer);
  const Break far = findBreak(logarithmsOf(outer), std::max(kLeastCount, kLeastShare * double(count)));
  if (far.first == outer.size()) return 0;
  const double most = outer[far.first - 1].squared;
  std::erase_if(positions, [&](const Float3& p) { return squaredDistance(p, centre) > most; });
  return step * std::min(far.nextOctave / 2, count / 50);
}

double lengthOf(const Float3& extent) {
  const float squared = dot(extent, extent);
  if (std::isnormal(squared)) return std::sqrt(squared);
  return std::sqrt(squaredDistance(extent, {}));
}

}  // namespace

CellGrid gridAround(const Float3& low, const Float3& extent, int cellsPerDiagonal) {
  // An edge and its inverse are normal numbers.
  const auto diagonal = float(std::clamp(lengthOf(extent), 1e-36, double(FLT_MAX) / 8));
  const float edge = lengthOf(extent) > 0 ? std::max(diagonal / float(cellsPerDiagonal), 1e-37f) : 1.0f;
  // An odd offset keeps walls at the ends of the extent off the cells' faces.
  const float offset = 0.37f * edge;
  // From the middle of a cube that is as wide as the diagonal is long.
  const auto reach = float(cellsPerDiagonal);
  return CellGrid(low - Float3{offset, offset, offset}, edge,
                  reach <= CellGrid::kMostReach ? std::max(reach, CellGrid::kLeastReach) : 0);
}

CellGrid gridFor(std::vector<Float3> positions, int cellsPerDiagonal) {
  if (positions.empty()) return gridAround({}, {}, cellsPerDiagonal);
  const size_t more = leaveOutFar(positions);
  // 0.5 % of the vertices at either end of each axis don't count in any case.
  const size_t cut = positions.size() / 200 + more;
  std::array<std::vector<float>, 3> axes;
  for (const Float3& p : positions) {
    axes[0].push_back(p.x);
    axes[1].push_back(p.y);
    axes[2].push_back(p.z);
  }
  float low[3], extent[3];
  for (size_t a = 0; a < 3; ++a) {
    low[a] = nthOf(axes[a], cut);
    extent[a] = nthOf(axes[a], positions.size() - 1 - cut) - low[a];
  }
  return gridAround({low[0], low[1], low[2]}, {extent[0], extent[1], extent[2]}, cellsPerDiagonal);
}

}  // namespace odis::core
