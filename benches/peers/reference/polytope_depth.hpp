// Depth of overlapping polytopes: the exact minimum over the facets of their Minkowski difference, in 80-bit floats.
//
// A facet is a face of A, a face of B, or spanned by an edge of each whose arcs on the Gauss map cross.
#pragma once

#include <algorithm>
#include <cmath>

#include "bodies.hpp"

using V = Vec<Extended>;

// How far B reaches into A along the unit vector n, were it moved out along n.
inline Extended overlap_along(const Body<Extended>& a, const Body<Extended>& b, V n) {
  return dot(n, a.support(n)) - dot(n, b.support(-n));
}

// An edge with the outward normals of the faces that meet in it.
struct Edge {
  V point, direction, normal0, normal1;
};

struct Polytope {
  std::vector<V> normals;
  std::vector<Edge> edges;
};

inline std::vector<std::array<uint32_t, 3>> triangles_of(const ShapeRecord& shape) {
  if (shape.kind != Kind::Box) return shape.triangles;
  const uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::vector<std::array<uint32_t, 3>> triangles;
  for (auto& s : sides) {
    triangles.push_back({s[0], s[1], s[2]});
    triangles.push_back({s[0], s[2], s[3]});
  }
  return triangles;
}

inline Polytope polytope(const Body<Extended>& body) {
  Polytope found;
  V centre{0, 0, 0};
  for (const V& corner : body.corners) centre = centre + corner;
  centre = (1 / Extended(body.corners.size())) * centre;
  auto triangles = triangles_of(*body.shape);
  std::vector<std::array<uint32_t, 3>> sides;  // lower corner, higher corner, triangle
  for (uint32_t i = 0; i < triangles.size(); i++) {
    const V &p = body.corners[triangles[i][0]], &q = body.corners[triangles[i][1]], &r = body.corners[triangles[i][2]];
    V normal = unit(cross(q - p, r - p));
    found.normals.push_back(dot(normal, p - centre) < 0 ? -normal : normal);
    for (int k = 0; k < 3; k++) {
      uint32_t from = triangles[i][k], to = triangles[i][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), i});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (size_t i = 0; i + 1 < sides.size(); i += 2) {
    V normal0 = found.normals[sides[i][2]], normal1 = found.normals[sides[i + 1][2]];
    if (dot(normal0, normal1) > 1 - 1e-14L) continue;  // inside a flat side
    V from = body.corners[sides[i][0]], to = body.corners[sides[i][1]];
    found.edges.push_back({from, to - from, normal0, normal1});
  }
  return found;
}

// In doubles, for the millions of pairs of edges most of which span no facet.
struct Arc {
  double normal0[3], normal1[3], across[3];
};

inline Arc arc(const Edge& edge, double sign) {
  V across = cross(edge.normal1, edge.normal0);
  Arc found;
  auto store = [](double* to, V v, double factor) {
    to[0] = factor * double(v.x);
    to[1] = factor * double(v.y);
    to[2] = factor * double(v.z);
  };
  store(found.normal0, edge.normal0, sign);
  store(found.normal1, edge.normal1, sign);
  store(found.across, across, 1);
  return found;
}

// Whether two arcs of the unit sphere cross, or nearly do: too many cost time, too few would cost the exact minimum.
inline bool arcs_may_cross(const Arc& a, const Arc& b) {
  const double slack = 1e-18;
  auto times = [](const double* u, const double* v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  double b0 = times(b.normal0, a.across), b1 = times(b.normal1, a.across);
  if (b0 * b1 > slack) return false;
  double a0 = times(a.normal0, b.across), a1 = times(a.normal1, b.across);
  return a0 * a1 <= slack && b0 * a1 >= -slack;
}

inline Extended polytope_depth(const Body<Extended>& a, const Body<Extended>& b) {
  Polytope of_a = polytope(a), of_b = polytope(b);
  Extended least = 1e30L;
  for (const V& n : of_a.normals) least = std::min(least, overlap_along(a, b, n));
  for (const V& n : of_b.normals) least = std::min(least, overlap_along(a, b, -n));
  std::vector<Arc> arcs_a, arcs_b;
  for (const Edge& edge : of_a.edges) arcs_a.push_back(arc(edge, 1));
  for (const Edge& edge : of_b.edges) arcs_b.push_back(arc(edge, -1));
  for (size_t i = 0; i < arcs_a.size(); i++) {
    for (size_t j = 0; j < arcs_b.size(); j++) {
      if (!arcs_may_cross(arcs_a[i], arcs_b[j])) continue;
      const Edge &edge_a = of_a.edges[i], &edge_b = of_b.edges[j];
      V normal = cross(edge_a.direction, edge_b.direction);
      if (length(normal) < 1e-12L) continue;
      normal = unit(normal);
      if (dot(normal, edge_a.normal0 + edge_a.normal1) < 0) normal = -normal;
      // Only a facet lower than the least so far is worth the two supports.
      if (dot(normal, edge_a.point - edge_b.point) < least) least = std::min(least, overlap_along(a, b, normal));
    }
  }
  return least;
}

// A ball around `centre` against a polytope that holds the centre: the nearest face decides.
inline Extended point_depth(const Body<Extended>& centre, const Body<Extended>& hull) {
  Extended least = 1e30L;
  for (const V& n : polytope(hull).normals) least = std::min(least, overlap_along(centre, hull, -n));
  return least;
}
