// Distance of two surfaces of triangles, in 80-bit floats: 0 when they touch. Every pair of triangles is looked at that
// two trees of boxes cannot rule out.
#pragma once

#include <algorithm>
#include <numeric>

#include "polytope_depth.hpp"

using Triangle = std::array<V, 3>;

inline Extended point_segment(V p, V a, V b) {
  V ab = b - a;
  Extended t = dot(p - a, ab) / dot(ab, ab);
  V nearest = a + std::clamp(t, 0.0L, 1.0L) * ab;
  return length(p - nearest);
}

// The least is between inner points of both, or at an end of one.
inline Extended segment_segment(V a, V b, V c, V d) {
  Extended of_first = std::min(point_segment(a, c, d), point_segment(b, c, d));
  Extended of_second = std::min(point_segment(c, a, b), point_segment(d, a, b));
  Extended ends = std::min(of_first, of_second);
  V u = b - a, v = d - c, w = a - c;
  Extended uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  Extended denominator = uu * vv - uv * uv;
  if (!(denominator > 0)) return ends;
  Extended s = (uv * vw - vv * uw) / denominator, t = (uu * vw - uv * uw) / denominator;
  if (s < 0 || s > 1 || t < 0 || t > 1) return ends;
  return std::min(ends, length(w + s * u - t * v));
}

// Distance to the inside of the triangle; its edges are looked at elsewhere.
inline Extended point_face(V p, const Triangle& t) {
  V n = cross(t[1] - t[0], t[2] - t[0]);
  for (int i = 0; i < 3; i++) {
    if (dot(cross(t[(i + 1) % 3] - t[i], p - t[i]), n) < 0) return INFINITY;
  }
  return fabsl(dot(unit(n), p - t[0]));
}

inline Extended volume(V a, V b, V c, V d) { return dot(cross(b - a, c - a), d - a); }

inline bool crosses(V p, V q, const Triangle& t) {
  if (volume(t[0], t[1], t[2], p) * volume(t[0], t[1], t[2], q) > 0) return false;
  Extended sides[3] = {volume(p, q, t[0], t[1]), volume(p, q, t[1], t[2]), volume(p, q, t[2], t[0])};
  auto [least, greatest] = std::minmax_element(sides, sides + 3);
  return *least >= 0 || *greatest <= 0;
}

inline Extended triangle_triangle(const Triangle& a, const Triangle& b) {
  Extended least = INFINITY;
  for (int i = 0; i < 3; i++) {
    V from = a[i], to = a[(i + 1) % 3];
    if (crosses(from, to, b) || crosses(b[i], b[(i + 1) % 3], a)) return 0;
    for (int j = 0; j < 3; j++) least = std::min(least, segment_segment(from, to, b[j], b[(j + 1) % 3]));
    least = std::min({least, point_face(a[i], b), point_face(b[i], a)});
  }
  return least;
}

struct Bounds {
  V low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  void add(V p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }

  Extended distance(const Bounds& other) const {
    auto between = [](Extended l, Extended h, Extended ol, Extended oh) { return std::max({0.0L, ol - h, l - oh}); };
    Extended x = between(low.x, high.x, other.low.x, other.high.x);
    Extended y = between(low.y, high.y, other.low.y, other.high.y);
    Extended z = between(low.z, high.z, other.low.z, other.high.z);
    return length(V{x, y, z});
  }
};

// A binary tree of boxes over the triangles, split at the median of the longest side.
class BoxTree {
 public:
  explicit BoxTree(const Body<Extended>& body) {
    const auto& corners = body.corners;
    for (auto& t : body.shape->triangles) triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    order.resize(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    build(0, order.size());
  }

  // The least distance of the two trees below these nodes and below `best`.
  static Extended distance(const BoxTree& a, size_t i, const BoxTree& b, size_t j, Extended best) {
    const Node &m = a.nodes[i], &n = b.nodes[j];
    if (best == 0 || m.bounds.distance(n.bounds) > best) return best;
    if (m.is_leaf() && n.is_leaf()) {
      for (size_t k = m.first; k < m.end; k++) {
        for (size_t l = n.first; l < n.end; l++) {
          best = std::min(best, triangle_triangle(a.triangles[a.order[k]], b.triangles[b.order[l]]));
        }
      }
      return best;
    }
    bool descend_a = n.is_leaf() || (!m.is_leaf() && m.end - m.first >= n.end - n.first);
    std::array<std::pair<size_t, size_t>, 2> next;
    if (descend_a) {
      next = {{{m.left, j}, {m.right, j}}};
    } else {
      next = {{{i, n.left}, {i, n.right}}};
    }
    auto gap = [&](auto& pair) { return a.nodes[pair.first].bounds.distance(b.nodes[pair.second].bounds); };
    if (gap(next[1]) < gap(next[0])) std::swap(next[0], next[1]);
    for (auto& [x, y] : next) best = distance(a, x, b, y, best);
    return best;
  }

 private:
  struct Node {
    Bounds bounds;
    size_t first, end;  // of `order`
    size_t left = 0, right = 0;
    bool is_leaf() const { return left == 0; }
  };

  size_t build(size_t first, size_t end) {
    size_t own = nodes.size();
    nodes.push_back({{}, first, end});
    Bounds bounds;
    for (size_t i = first; i < end; i++) {
      for (V corner : triangles[order[i]]) bounds.add(corner);
    }
    nodes[own].bounds = bounds;
    if (end - first <= 4) return own;
    V size = bounds.high - bounds.low;
    Extended V::*axis = size.x >= size.y && size.x >= size.z ? &V::x : size.y >= size.z ? &V::y : &V::z;
    auto centre = [&](size_t t) { return triangles[t][0].*axis + triangles[t][1].*axis + triangles[t][2].*axis; };
    size_t middle = (first + end) / 2;
    std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + end,
                     [&](size_t x, size_t y) { return centre(x) < centre(y); });
    size_t left = build(first, middle), right = build(middle, end);
    nodes[own].left = left;
    nodes[own].right = right;
    return own;
  }

  std::vector<Triangle> triangles;
  std::vector<size_t> order;
  std::vector<Node> nodes;
};

inline Extended mesh_distance(const Body<Extended>& a, const Body<Extended>& b) {
  return BoxTree::distance(BoxTree(a), 0, BoxTree(b), 0, INFINITY);
}
