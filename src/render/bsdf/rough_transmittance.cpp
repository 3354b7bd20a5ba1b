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

// Visible normals are sampled with the quadrature's nodes, so the integrand is Fresnel's term and the masking
// of the direction that leaves.
float scattered(const Microfacet& facets, const Vec3& w, float eta, bool reflected,
                const std::vector<Node>& nodes) {
  double sum = 0;
  for (const Node& a : nodes)
    for (const Node& b : nodes) {
      const Vec3 m = facets.sample(w, {a.x, b.x});
      const DielectricFresnel f = fresnelDielectric(dot(w, m), eta);
      const Vec3 out = reflected ? reflect(w, m) : refract(w, m, f);
      if (reflected != (out.z > 0)) continue;
      sum += a.weight * b.weight * facets.g1(out, m) * (reflected ? f.reflectance : 1 - f.reflectance);
    }
  return float(sum);
}

}  // namespace

RoughTransmittance::RoughTransmittance(Microfacet::Type type, float alpha, float eta) {
  const Microfacet facets(type, alpha, alpha);
  const std::vector<Node> nodes = gaussLegendre(32);
  double reflectance = 0;
  for (int i = 0; i < kNodes; ++i) {
    const float mu = std::max(1e-6f, float(i) / (kNodes - 1));
    const Vec3 w(safeSqrt(1 - mu * mu), 0, mu);
    m_external[i] = scattered(facets, w, eta, false, nodes);
    reflectance += 2 * mu * scattered(facets, w, 1 / eta, true, nodes) / kNodes;
  }
  m_internalReflectance = float(reflectance);
}

}  // namespace odis::render
