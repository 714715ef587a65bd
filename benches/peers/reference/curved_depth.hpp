// Depth of overlapping round shapes: the least overlap over all directions, by search in 80-bit floats.
//
// Every direction tried gives an upper bound of the depth, so the result is one; that it is the least is not proved.
// On a kink of the overlap (the directions across a cylinder's side, along a cone's slope) the search runs along the
// kink; all others are searched from the best of 3000 directions by shrinking steps. Error about 1e-10 m.
#pragma once

#include <cmath>

#include "polytope_depth.hpp"

class DepthSearch {
 public:
  DepthSearch(const Body<Extended>& first, const Body<Extended>& second) : a(first), b(second) {}

  Extended run() {
    for (const Body<Extended>* body : {&a, &b}) search_kinks(*body);
    search_everywhere();
    return least;
  }

 private:
  Extended overlap(V n) {
    Extended value = overlap_along(a, b, n);
    least = std::min(least, value);
    return value;
  }

  void search_kinks(const Body<Extended>& body) {
    const double* p = body.shape->params;
    if (body.shape->kind == Kind::Ellipsoid) return;
    if (body.shape->kind == Kind::Cylinder) search_circle(body, 0);
    if (body.shape->kind == Kind::Cone) {
      Extended slope = p[0] / sqrtl(p[0] * p[0] + 4 * p[1] * p[1]);
      search_circle(body, slope);
      search_circle(body, -slope);
    }
    overlap(body.turned({0, 0, 1}));
    overlap(body.turned({0, 0, -1}));
  }

  // The directions whose component along the body's axis is `height`: sampled, then narrowed by the golden section.
  void search_circle(const Body<Extended>& body, Extended height) {
    const int samples = 720;
    const Extended golden = 0.6180339887498949L, step = 2 * M_PIl / samples;
    Extended across = sqrtl(1 - height * height);
    auto at = [&](Extended angle) {
      return overlap(body.turned({across * cosl(angle), across * sinl(angle), height}));
    };
    std::vector<Extended> sampled(samples);
    for (int i = 0; i < samples; i++) sampled[i] = at(i * step);
    for (int i = 0; i < samples; i++) {
      Extended before = sampled[(i + samples - 1) % samples], after = sampled[(i + 1) % samples];
      if (sampled[i] > before || sampled[i] > after || sampled[i] > least + 0.05L) continue;
      Extended low = (i - 1) * step, high = (i + 1) * step;
      for (int round = 0; round < 90; round++) {
        Extended left = high - golden * (high - low), right = low + golden * (high - low);
        bool least_is_left = at(left) < at(right);
        (least_is_left ? high : low) = least_is_left ? right : left;
      }
    }
  }

  void search_everywhere() {
    const int samples = 3000, starts = 8, apart = 3;
    std::vector<std::pair<Extended, V>> sampled;
    for (int i = 0; i < samples; i++) {  // a spiral of even spacing
      Extended z = 1 - (2 * i + 1) / Extended(samples), r = sqrtl(1 - z * z), angle = i * 2.399963229728653L;
      V n{r * cosl(angle), r * sinl(angle), z};
      sampled.push_back({overlap_along(a, b, n), n});
    }
    std::sort(sampled.begin(), sampled.end(), [](auto& x, auto& y) { return x.first < y.first; });
    for (int k = 0; k < starts; k++) descend(sampled[k * apart].second);
  }

  // Four steps across the direction, at a random turn; longer after a gain, shorter after some losses.
  void descend(V n) {
    Extended value = overlap(n), step = 0.05L;
    int losses = 0;
    while (step > 1e-12L) {
      V u = unit(cross(n, fabsl(n.x) < 0.6L ? V{1, 0, 0} : V{0, 1, 0})), w = cross(n, u);
      Extended angle = random_angle();
      bool gained = false;
      for (int quarter = 0; quarter < 4 && !gained; quarter++, angle += M_PIl / 2) {
        V next = unit(n + (step * cosl(angle)) * u + (step * sinl(angle)) * w);
        Extended there = overlap(next);
        if (there < value) {
          value = there;
          n = next;
          gained = true;
        }
      }
      losses = gained ? 0 : losses + 1;
      if (gained) step *= 1.3L;
      if (losses > 3) {
        step *= 0.5L;
        losses = 0;
      }
    }
  }

  Extended random_angle() {
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return (seed >> 11) * (2 * M_PIl / 9007199254740992.0L);
  }

  const Body<Extended>&a, &b;
  Extended least = 1e30L;
  uint64_t seed = 1;
};
