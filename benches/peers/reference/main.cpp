// The reference signed distance of every pair, far more exact than any contender: `reference PAIRS DISTANCES GAPS`.
//
// Writes one f64 a pair, in the order of the file; NaN where there is none (costly sets have references for their first
// pairs only). The truth is within the gap of the distance, besides half a unit in the last place: proved for what is
// apart and for polytopes, an estimate (1e-9 m) for the depth of round shapes.
#include <chrono>

#include "apart.hpp"
#include "curved_depth.hpp"
#include "mesh_distance.hpp"
#include "polytope_depth.hpp"

static const double CURVED_GAP = 1e-9;

struct Reference {
  double distance = NAN, gap = NAN;
};

static bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

static uint32_t pairs_with_reference(const PairSet& set) {
  bool over = contains(set.name, "_over");
  if (over && contains(set.name, "ell940")) return 200;
  if (over && (contains(set.name, "cylcone") || contains(set.name, "ellell"))) return 300;
  return std::min(set.count, 1000u);
}

static bool is_polytope(const Body<Extended>& body) { return body.corners.size() >= 8; }

static Reference reference(const ShapeRecord& a, const ShapeRecord& b, const PairRecord& pair) {
  auto place = [&](auto number) {
    using T = decltype(number);
    return std::pair{Body<T>(a, pair.rotation_a, pair.translation_a), Body<T>(b, pair.rotation_b, pair.translation_b)};
  };
  if (a.kind == Kind::Mesh) {
    auto [x, y] = place(Extended());
    return {double(mesh_distance(x, y)), 0};
  }
  auto [x, y] = place(Quad());
  Certified found = distance_apart(x, y);
  if (found.apart) return {double(found.distance - x.radius - y.radius), double(found.gap)};
  auto [s, t] = place(Extended());
  Extended depth;
  double gap = 0;
  if (a.kind == Kind::Sphere) {
    depth = point_depth(s, t);
  } else if (a.kind == Kind::Capsule) {
    depth = 0;  // axes that cross
  } else if (is_polytope(s) && is_polytope(t)) {
    depth = polytope_depth(s, t);
  } else {
    depth = DepthSearch(s, t).run();
    gap = CURVED_GAP;
  }
  return {double(-depth - s.radius - t.radius), gap};
}

static void write(const char* path, const std::vector<Reference>& all, double Reference::*field) {
  FILE* out = fopen(path, "wb");
  if (!out) Reader::fail(path);
  for (const Reference& one : all) fwrite(&(one.*field), sizeof(double), 1, out);
  fclose(out);
}

int main(int, char** argv) {
  Pairs pairs = read_pairs(argv[1]);
  std::vector<Reference> all(pairs.pairs.size());
  for (const PairSet& set : pairs.sets) {
    auto began = std::chrono::steady_clock::now();
    uint32_t count = pairs_with_reference(set);
#pragma omp parallel for schedule(dynamic)
    for (uint32_t i = set.first; i < set.first + count; i++) {
      const PairRecord& pair = pairs.pairs[i];
      all[i] = reference(pairs.shapes[pair.a], pairs.shapes[pair.b], pair);
    }
    double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    fprintf(stderr, "%-24s %u references in %.1f s\n", set.name.c_str(), count, seconds);
  }
  write(argv[2], all, &Reference::distance);
  write(argv[3], all, &Reference::gap);
}
