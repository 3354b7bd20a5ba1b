#include "render/bsdf/rough_transmittance.h"

#include <vector>

#include "render/bsdf/fresnel.h"

namespace odis::render {
namespace {

struct Node {
  float x, weight;
};

// Gauss-Legendre quadrature on [0, 1]: roots of the Legendre polynomial by Newton's method.
std::vector<Node> gaussLegendre(int count) {
  std::vector<Node> nodes;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(M_PI * (i + 0.75) / (count + 0.5)), derivative = 1;
    for (int step = 0; step < 8; ++step) {
      double p = 1, previous = 0;
      for (int n = 0; n < count; ++n) {
        const double next = ((2 * n + 1) * x * p - n * previous) / (n + 1);
        previous = p;
        p = next;
      }
      derivative = count * (x * p - previous) / (x * x - 1);
      x -= p / derivative;
    }
    nodes.push_back({float(0.5 * (1 - x)), float(1 / ((1 - x * x) * derivative * derivative))});
  }
  return nodes;
}

// What becomes of light that meets the interface in direction w: how much enters from outside, and how much
// comes back from inside.
struct Shares {
  float entering, reflected;
};

// Visible normals are sampled with the quadrature's nodes, so the integrand is Fresnel's term and the masking
// of the direction that leaves.
Shares sharesOf(const Microfacet& facets, const Vec3& w, float eta, const std::vector<Node>& nodes) {
  double entering = 0, reflected = 0;
  for (const Node& a : nodes)
    for (const Node& b : nodes) {
      const Vec3 m = facets.sample(w, {a.x, b.x});
      const float weight = a.weight * b.weight;
      const float cosine = dot(w, m);
      const DielectricFresnel outside = fresnelDielectric(cosine, eta);
      if (const Vec3 in = refract(w, m, outside); !(in.z > 0))
        entering += weight * facets.g1(in, m) * (1 - outside.reflectance);
      if (const Vec3 back = reflect(w, m); back.z > 0)
        reflected += weight * facets.g1(back, m) * fresnelDielectric(cosine, 1 / eta).reflectance;
    }
  return {float(entering), float(reflected)};
}

}  // namespace

RoughTransmittance::RoughTransmittance(Microfacet::Type type, float alpha, float eta) {
  const Microfacet facets(type, alpha, alpha);
  const std::vector<Node> nodes = gaussLegendre(32);
  double reflectance = 0;
  for (int i = 0; i < kNodes; ++i) {
    const float mu = std::max(1e-6f, float(i) / (kNodes - 1));
    const Vec3 w(safeSqrt(1 - mu * mu), 0, mu);
    const Shares shares = sharesOf(facets, w, eta, nodes);
    m_external[i] = shares.entering;
    reflectance += 2 * mu * shares.reflected / kNodes;
  }
  m_internalReflectance = float(reflectance);
}

}  // namespace odis::render
