// Distance of two convex cores that are apart: GJK in 113-bit floats, run until its duality gap closes.
//
// Supports look at every corner, and the nearest point of a simplex is found by trying all of its faces, so that
// nothing here depends on a tolerance. The gap is the certificate: distance - gap <= truth <= distance.
#pragma once

#include "bodies.hpp"

struct Certified {
  bool apart;
  Quad distance, gap;
};

// Coefficients of the point nearest to the origin in the plane through `count` points (a simplex); false when it is
// flat or the point lies outside of the simplex.
inline bool affine_nearest(const Vec<Quad>* points, int count, Quad* weights) {
  Quad rows[3][4];
  int n = count - 1;
  for (int i = 0; i < n; i++) {
    Vec<Quad> edge = points[i + 1] - points[0];
    for (int j = 0; j < n; j++) rows[i][j] = dot(edge, points[j + 1] - points[0]);
    rows[i][n] = -dot(edge, points[0]);
  }
  for (int column = 0; column < n; column++) {
    int pivot = column;
    for (int row = column; row < n; row++) {
      if (fabsq(rows[row][column]) > fabsq(rows[pivot][column])) pivot = row;
    }
    if (fabsq(rows[pivot][column]) < 1e-30Q) return false;
    for (int j = 0; j <= n; j++) std::swap(rows[column][j], rows[pivot][j]);
    for (int row = 0; row < n; row++) {
      if (row == column) continue;
      Quad factor = rows[row][column] / rows[column][column];
      for (int j = column; j <= n; j++) rows[row][j] -= factor * rows[column][j];
    }
  }
  weights[0] = 1;
  for (int i = 0; i < n; i++) {
    weights[i + 1] = rows[i][n] / rows[i][i];
    weights[0] -= weights[i + 1];
  }
  for (int i = 0; i < count; i++) {
    if (weights[i] < 0) return false;
  }
  return true;
}

// The point of the simplex nearest to the origin; the simplex shrinks to the face that holds it.
inline Vec<Quad> nearest(std::vector<Vec<Quad>>& simplex) {
  std::vector<Vec<Quad>> best_face;
  Vec<Quad> best{0, 0, 0};
  for (int mask = 1; mask < 1 << simplex.size(); mask++) {
    std::vector<Vec<Quad>> face;
    for (size_t i = 0; i < simplex.size(); i++) {
      if (mask >> i & 1) face.push_back(simplex[i]);
    }
    Quad weights[4];
    if (!affine_nearest(face.data(), int(face.size()), weights)) continue;
    Vec<Quad> point{0, 0, 0};
    for (size_t i = 0; i < face.size(); i++) point = point + weights[i] * face[i];
    if (best_face.empty() || dot(point, point) < dot(best, best)) {
      best = point;
      best_face = face;
    }
  }
  simplex = best_face;
  return best;
}

inline Certified distance_apart(const Body<Quad>& a, const Body<Quad>& b) {
  const Certified overlap{false, 0, 0};
  auto support = [&](Vec<Quad> d) { return a.support(d) - b.support(-d); };
  std::vector<Vec<Quad>> simplex{support({1, 0, 0})};
  Vec<Quad> v = simplex[0];
  Certified found{true, 0, 0};
  Quad lower = 0;
  for (int round = 0; round < 5000; round++) {
    found.distance = length(v);
    if (found.distance < 1e-17Q) return overlap;
    Vec<Quad> w = support(-v);
    Quad along = dot(v, w) / found.distance;
    if (along > lower) lower = along;
    found.gap = found.distance - lower;
    if (found.gap < 1e-20Q) return found;
    for (const Vec<Quad>& seen : simplex) {
      if (dot(seen - w, seen - w) < 1e-50Q) return found;
    }
    if (simplex.size() == 4) return overlap;
    simplex.push_back(w);
    Vec<Quad> next = nearest(simplex);
    if (simplex.size() == 4) return overlap;
    if (dot(next, next) >= dot(v, v)) return found;
    v = next;
  }
  return found;
}
