#include "render/path/veil.h"

#include "render/medium/medium.h"

namespace odis::render {

void Veil::add(const Path& path, int place, float length) {
  const Medium& medium = *path.medium;
  const MediumSegment segment{path.ray.origin, path.ray.direction, length};
  RandomStream random(path.sampler.streamSeed(place));
  Sampler sampler = path.sampler;
  sampler.startAt(place, kFlightNumber);
  const Flight flight = medium.fly(segment, Rgb(1.0f), sampler.get1D(), random);
  const float distance = flight.scattered ? flight.distance : length < kInfinity ? 0.5f * length : 0;
  const Rgb behind = m_passing * medium.transmittance(segment, random);
  m_albedo += (m_passing - behind) * medium.albedo(segment.at(distance));
  m_passing = behind;
}

void Veil::cover(Path& path) const {
  FirstHit& first = path.first;
  if (!first.valid) {
    if (isBlack(m_albedo)) return;
    first.valid = true;
    first.position = path.ray.origin;
    first.normal = first.geometricNormal = Vec3(0, 0, 0);
    first.albedo = Rgb(0.0f);
    first.roughness = 1;
  }
  first.albedo = first.albedo * m_passing + m_albedo;
  first.normal *= luminance(m_passing);
}

}  // namespace odis::render
